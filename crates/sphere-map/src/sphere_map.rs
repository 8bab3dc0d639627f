//! A bijective map from a mesh of genus zero onto the sphere.

use nalgebra::{Point3, UnitVector3, Vector3};

use crate::decimate::to_tetrahedron;
use crate::energy::Weights;
use crate::mesh::Mesh;
use crate::placement::Placement;
use crate::rings::Collapse;
use crate::tree::{Closest, Tree};

/// Kernels thinner than this are made thicker before a vertex goes in.
const LEAST_THICKNESS: f64 = 1e-6;
/// Attempts at that.
const RESCUES: usize = 6;
/// All vertices are relaxed whenever their number has grown by this factor, so often.
const GROWTH: f64 = 1.3;
const SWEEPS: usize = 6;
/// A new vertex and its ring are relaxed so often.
const LOCAL: usize = 3;
/// The barrier of the last sweeps.
const LAST_BARRIER: f64 = 0.02;
/// The last sweeps end when they lower the energy by less than this share.
const GAIN: f64 = 1e-5;

/// How a map is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapSettings {
    /// Weight of the distortion of areas against that of angles.
    pub area_weight: f64,
    /// Weight of even triangles while vertices are inserted.
    pub barrier: f64,
    /// Most sweeps over all vertices at the end.
    pub sweeps: usize,
}

impl Default for MapSettings {
    fn default() -> Self {
        Self {
            area_weight: 3.0,
            barrier: 0.3,
            sweeps: 40,
        }
    }
}

/// A bijection between a mesh and the sphere: linear on triangles, then projected.
#[derive(Clone, Debug)]
pub struct SphereMap {
    /// The mesh.
    pub mesh: Mesh,
    /// Where its vertices go.
    pub images: Vec<UnitVector3<f64>>,
    /// Mean distortion of the map: 1 + the weight of areas for an isometry.
    pub energy: f64,
    tree: Tree,
}

/// Why there is no map.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MapError {
    /// The mesh is not closed, not oriented, or not of genus zero.
    #[error("the mesh is no closed, oriented surface of genus zero (Euler characteristic {euler})")]
    NotASphere {
        /// χ.
        euler: i64,
    },
    /// Images of triangles are turned over.
    #[error("{count} of {triangles} triangles are turned over on the sphere")]
    Flipped {
        /// How many.
        count: usize,
        /// Of how many.
        triangles: usize,
    },
    /// The images cover the sphere more than once.
    #[error("the images of the triangles cover the sphere {degree:.3} times, not once")]
    Degree {
        /// Sum of the solid angles over 4π.
        degree: f64,
    },
}

/// Maps a closed mesh of genus zero onto the sphere, one to one.
///
/// Edges are collapsed down to a tetrahedron, which goes to a regular one. The vertices come back in
/// reverse order, each into the kernel of its ring (Praun and Hoppe 2003), and are moved to lower the sum
/// of MIPS energy (Hormann and Greiner 2000) and distortion of areas, never through an edge. At the end
/// det(a, b, c) > 0 is checked for every triangle, and that the solid angles add up to 4π: together they
/// make the map a bijection.
///
/// # Errors
/// [`MapError`]; other settings may succeed where some fail.
pub fn sphere_map(mesh: &Mesh, settings: &MapSettings) -> Result<SphereMap, MapError> {
    let not_a_sphere = MapError::NotASphere {
        euler: mesh.euler_characteristic(),
    };
    if mesh.euler_characteristic() != 2 {
        return Err(not_a_sphere);
    }
    let (rings, collapses) = to_tetrahedron(mesh).ok_or(not_a_sphere)?;
    let scale = (4.0 * std::f64::consts::PI / mesh.area()).sqrt();
    let scaled: Vec<Vector3<f64>> = mesh.vertices.iter().map(|p| p.coords * scale).collect();
    let mut placement = Placement::new(&scaled, rings);
    let mut order = start(&mut placement);
    insert(&mut placement, &collapses, &mut order, settings);
    let weights = Weights {
        angle: 1.0,
        area: settings.area_weight,
        barrier: LAST_BARRIER * 12.0 / mesh.triangles.len() as f64,
    };
    let mut total = placement.total(&weights);
    for _ in 0..settings.sweeps {
        let gain: f64 = order.iter().map(|v| placement.relax(*v, &weights)).sum();
        total -= gain;
        if !(gain > GAIN * total) {
            break;
        }
    }
    let images = placement.images;
    check(mesh, &images)?;
    let sphere = Mesh {
        vertices: images.iter().map(|x| Point3::from(*x)).collect(),
        triangles: mesh.triangles.clone(),
    };
    Ok(SphereMap {
        mesh: mesh.clone(),
        images: images.into_iter().map(UnitVector3::new_unchecked).collect(),
        energy: total / (4.0 * std::f64::consts::PI),
        tree: Tree::new(&sphere),
    })
}

/// Puts the four vertices of the tetrahedron in place, and lists them.
fn start(placement: &mut Placement) -> Vec<u32> {
    let count = placement.images.len() as u32;
    let order: Vec<u32> = (0..count)
        .filter(|v| !placement.rings.ring(*v).is_empty())
        .collect();
    let corners = [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)];
    for (v, (x, y, z)) in order.iter().zip(corners) {
        let corner = Vector3::new(x, y, z).map(f64::from);
        placement.images[*v as usize] = corner.normalize();
    }
    let ring = placement.rings.ring(order[0]);
    let at = |w: u32| placement.images[w as usize];
    if at(order[0]).dot(&at(ring[0]).cross(&at(ring[1]))) < 0.0 {
        placement.images.swap(order[0] as usize, order[1] as usize);
    }
    order
}

/// Undoes the collapses and places the vertices that come back.
fn insert(
    placement: &mut Placement,
    collapses: &[Collapse],
    order: &mut Vec<u32>,
    settings: &MapSettings,
) {
    let mut next = 8;
    for collapse in collapses.iter().rev() {
        widen(placement, collapse);
        placement.rings.split(collapse);
        let v = collapse.gone;
        let kept = placement.images[collapse.kept as usize];
        placement.images[v as usize] = placement.kernel(v, &collapse.ring).map_or(kept, |(x, _)| x);
        order.push(v);
        let weights = Weights {
            angle: 1.0,
            area: settings.area_weight,
            barrier: settings.barrier * 6.0 / order.len() as f64,
        };
        for _ in 0..LOCAL {
            placement.relax(v, &weights);
            for w in &collapse.ring {
                placement.relax(*w, &weights);
            }
        }
        if order.len() >= next {
            for _ in 0..SWEEPS {
                for w in order.iter() {
                    placement.relax(*w, &weights);
                }
            }
            next = (next as f64 * GROWTH) as usize + 1;
        }
    }
}

/// Relaxes the neighbourhood by shape alone until the ring that a vertex comes back into has a kernel of
/// some thickness.
fn widen(placement: &mut Placement, collapse: &Collapse) {
    let shape = Weights {
        angle: 0.0,
        area: 0.0,
        barrier: 1.0,
    };
    for _ in 0..RESCUES {
        let thickness = placement
            .kernel(collapse.gone, &collapse.ring)
            .map_or(0.0, |(_, t)| t);
        if thickness > LEAST_THICKNESS {
            return;
        }
        let mut around: Vec<u32> = placement.rings.ring(collapse.kept).to_vec();
        let more: Vec<u32> = around
            .iter()
            .flat_map(|w| placement.rings.ring(*w).to_vec())
            .collect();
        around.extend(more);
        around.push(collapse.kept);
        around.sort_unstable();
        around.dedup();
        for _ in 0..LOCAL {
            for w in &around {
                placement.relax(*w, &shape);
            }
        }
    }
}

/// det > 0 on every triangle, and degree 1.
fn check(mesh: &Mesh, images: &[Vector3<f64>]) -> Result<(), MapError> {
    let mut flipped = 0;
    let mut angle = 0.0;
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| images[v as usize]);
        let determinant = a.dot(&b.cross(&c));
        if !(determinant > 0.0) {
            flipped += 1;
        }
        // Van Oosterom and Strackee 1983.
        angle += 2.0 * determinant.atan2(1.0 + a.dot(&b) + b.dot(&c) + c.dot(&a));
    }
    if flipped > 0 {
        return Err(MapError::Flipped {
            count: flipped,
            triangles: mesh.triangles.len(),
        });
    }
    let degree = angle / (4.0 * std::f64::consts::PI);
    if (degree - 1.0).abs() < 1e-6 {
        Ok(())
    } else {
        Err(MapError::Degree { degree })
    }
}

impl SphereMap {
    /// The image of a point of the mesh.
    pub fn image(&self, at: &Closest) -> UnitVector3<f64> {
        let corners = self.mesh.triangles[at.triangle].map(|v| self.images[v as usize]);
        let sum = corners[0].into_inner() * at.weights[0]
            + corners[1].into_inner() * at.weights[1]
            + corners[2].into_inner() * at.weights[2];
        UnitVector3::new_normalize(sum)
    }

    /// The point of the mesh that goes to a direction.
    pub fn preimage(&self, direction: &UnitVector3<f64>) -> Point3<f64> {
        let p = Point3::from(direction.into_inner());
        let Some(found) = self.tree.closest(&p) else {
            return Point3::origin();
        };
        let triangle = &self.mesh.triangles[found.triangle];
        let [a, b, c] = triangle.map(|v| self.images[v as usize].into_inner());
        // Where the ray through the direction meets the triangle, if it does.
        let heights = [b.cross(&c), c.cross(&a), a.cross(&b)].map(|n| n.dot(direction));
        let sum: f64 = heights.iter().sum();
        let weights = if heights.iter().all(|h| *h >= 0.0) && sum > 0.0 {
            heights.map(|h| h / sum)
        } else {
            found.weights
        };
        let corners = self.mesh.corners(triangle);
        let at = corners[0].coords * weights[0]
            + corners[1].coords * weights[1]
            + corners[2].coords * weights[2];
        Point3::from(at)
    }
}
