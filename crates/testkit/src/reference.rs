//! Results of independent programs; the scripts that computed them are in `reference/`.

/// Grasp quality of 409 grasps from Qhull, as CSV.
///
/// A row holds the contacts, inward normals and tangents (vectors as three numbers each, all
/// separated by `;`), the centre of torques, μ, the number of edges, the length of edges (`normal`
/// for a unit normal component, `length` for unit length), the torque length, the radius of the
/// largest origin-centred ball in the hull of all wrenches, the volume of that hull, and the radius
/// for the sums over contacts, which is empty where it was not computed. Made by
/// `generate_quality.py` with SciPy.
pub const QUALITY: &str = include_str!("../reference/quality.csv");

/// Real orthonormal spherical harmonics and their gradients to 25 digits, as CSV.
///
/// A row holds l, m, θ, φ, Y_{l,m}, ∂Y/∂θ and (1/sin θ) ∂Y/∂φ, without the Condon–Shortley phase.
/// Made by `generate_ylm.py` with mpmath.
pub const YLM: &str = include_str!("../reference/ylm.csv");
