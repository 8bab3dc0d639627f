//! The normal f_u × f_v of a map S² → R³ as a function on the sphere, and a proof that it never
//! vanishes.

use nalgebra::Vector3;
use sph::bounds::certified_range;
use sph::grid::{GridValues, RingGrid};
use sph::{Coefficients, Direction, SphericalCoords};

use crate::rotation_field::rotational_gradient;

/// Points per half wave of the certificate; the first that decides is used.
const OVERSAMPLING: [usize; 2] = [3, 6];
/// A normal shorter than this part of the longest one is taken for zero.
const VANISHING: f64 = 1e-6;

/// Bounds of |f_u × f_v|, the area of the surface per area of the sphere, m².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Immersion {
    /// Proved: nowhere below this.
    pub lower: f64,
    /// Least value seen on a grid.
    pub seen_lower: f64,
    /// Largest value seen on a grid.
    pub seen_upper: f64,
}

/// Why three functions are no surface in M^sph.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SphericalError {
    /// The normal vanishes, or nearly: the map is no immersion.
    #[error(
        "not an immersion: the area element falls to {seen:.3e} m² along ({x:.3}, {y:.3}, {z:.3}), where the largest is {largest:.3e} m²"
    )]
    NotImmersed {
        /// |f_u × f_v| there.
        seen: f64,
        /// Direction, x.
        x: f64,
        /// Direction, y.
        y: f64,
        /// Direction, z.
        z: f64,
        /// Largest |f_u × f_v|.
        largest: f64,
    },
    /// The normal was nowhere zero on the grid, but that is no proof.
    #[error(
        "cannot prove the map an immersion: area element at least {seen:.3e} m² on a grid, but the certificate ends at {certificate:.3} (needs > 0); a lower degree or more penalty may help"
    )]
    Undecided {
        /// Least value seen.
        seen: f64,
        /// Certified lower bound of the product that should be positive.
        certificate: f64,
    },
    /// f_u × f_v points inward.
    #[error("the surface is inside out (volume {volume:.3e} m³); mirror the sphere coordinates")]
    InsideOut {
        /// Signed volume, m³.
        volume: f64,
    },
}

/// Directions of a grid's points, ring after ring.
pub(crate) fn grid_directions(grid: &RingGrid) -> Vec<Vector3<f64>> {
    let step = std::f64::consts::TAU / grid.longitudes() as f64;
    let turns: Vec<(f64, f64)> = (0..grid.longitudes())
        .map(|k| (step * k as f64).sin_cos())
        .collect();
    let ring = |&(s, z): &(f64, f64)| turns.iter().map(move |(sin, cos)| [s * cos, s * sin, z]);
    grid.rings()
        .iter()
        .flat_map(ring)
        .map(Vector3::from)
        .collect()
}

/// f_u × f_v on a grid: N_x = p·(∇y × ∇z) = p·((p×∇y) × (p×∇z)), and so on round.
///
/// Nine syntheses; exact, poles included.
pub(crate) fn normals(coordinates: &[Coefficients; 3], grid: &RingGrid) -> Vec<Vector3<f64>> {
    let fields = coordinates.each_ref().map(|c| {
        let parts = rotational_gradient(c);
        parts.map(|part| grid.synthesis(&part).values)
    });
    let at = |axis: usize, i: usize| {
        let [x, y, z] = &fields[axis];
        Vector3::new(x[i], y[i], z[i])
    };
    grid_directions(grid)
        .iter()
        .enumerate()
        .map(|(i, p)| {
            let [a, b, c] = [at(0, i), at(1, i), at(2, i)];
            Vector3::new(
                p.dot(&b.cross(&c)),
                p.dot(&c.cross(&a)),
                p.dot(&a.cross(&b)),
            )
        })
        .collect()
}

/// Proves that N = f_u × f_v vanishes nowhere.
///
/// N is a spherical polynomial of degree at most 2L+1. W, of degree L, approximates N/|N|², so that
/// g = N·W is close to 1, with a degree of at most 3L+1; a certified g > 0 leaves no zero to N, and
/// |N| ≥ min g / max |W|.
pub(crate) fn certify(coordinates: &[Coefficients; 3]) -> Result<Immersion, SphericalError> {
    let degree = coordinates[0].degree();
    let multiplier = multiplier(coordinates, degree)?;
    let longest = multiplier
        .iter()
        .map(|w| certified_range(w, 8))
        .map(|range| range.lower.abs().max(range.upper).powi(2))
        .sum::<f64>()
        .sqrt();
    let mut undecided = SphericalError::InsideOut { volume: 0.0 };
    for oversampling in OVERSAMPLING {
        let rings = oversampling * (3 * degree + 1) + 1;
        let grid = RingGrid::equiangular(rings, 2 * (rings - 1));
        let normals = normals(coordinates, &grid);
        let [x, y, z] = multiplier.each_ref().map(|w| grid.synthesis(w).values);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut lengths = (f64::INFINITY, 0.0_f64);
        for (i, n) in normals.iter().enumerate() {
            let product = n.x * x[i] + n.y * y[i] + n.z * z[i];
            (low, high) = (low.min(product), high.max(product));
            lengths = (lengths.0.min(n.norm()), lengths.1.max(n.norm()));
        }
        // The bound of sph::bounds for a polynomial known by its values.
        let widening = (0.5 * std::f64::consts::PI / oversampling as f64)
            .cos()
            .powi(-2);
        let rounding = 1e-12 * (longest * lengths.1 + 1.0);
        let certified = 0.5 * (low + high) - 0.5 * (high - low) * widening - rounding;
        if certified > 0.0 {
            return Ok(Immersion {
                lower: certified / longest,
                seen_lower: lengths.0,
                seen_upper: lengths.1,
            });
        }
        undecided = SphericalError::Undecided {
            seen: lengths.0,
            certificate: certified,
        };
    }
    Err(undecided)
}

/// W ≈ N/|N|² of the given degree, or the place where N vanishes.
fn multiplier(
    coordinates: &[Coefficients; 3],
    degree: usize,
) -> Result<[Coefficients; 3], SphericalError> {
    let rings = 3 * degree + 4;
    let grid = RingGrid::gauss_legendre(rings, 2 * rings);
    let normals = normals(coordinates, &grid);
    let length = |n: &Vector3<f64>| n.norm();
    let largest = normals.iter().map(length).fold(0.0, f64::max);
    let least = normals.iter().map(length).enumerate();
    let least = least.min_by(|a, b| a.1.total_cmp(&b.1));
    match least {
        Some((_, seen)) if seen > VANISHING * largest => {}
        other => {
            let (index, seen) = other.unwrap_or((0, f64::NAN));
            let p = direction(&grid, index);
            return Err(SphericalError::NotImmersed {
                seen,
                x: p.x,
                y: p.y,
                z: p.z,
                largest,
            });
        }
    }
    Ok(std::array::from_fn(|axis| {
        let values = GridValues {
            longitudes: grid.longitudes(),
            values: normals.iter().map(|n| n[axis] / n.norm_squared()).collect(),
        };
        grid.analysis(&values, degree)
    }))
}

fn direction(grid: &RingGrid, index: usize) -> Direction {
    let (sin, cos) = grid.rings()[index / grid.longitudes()];
    let turn = (index % grid.longitudes()) as f64 / grid.longitudes() as f64;
    SphericalCoords {
        theta: sin.atan2(cos),
        phi: std::f64::consts::TAU * turn,
    }
    .direction()
}
