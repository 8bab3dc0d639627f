//! A closed surface of genus zero around a cloud.

use nalgebra::{Matrix3, Point3, UnitVector3, Vector3};

use crate::carve::{self, Carving};
use crate::decimate::decimate;
use crate::holes::{ClosedHole, Membranes};
use crate::lattice::Lattice;
use crate::march::march;
use crate::mesh::Mesh;
use crate::orient;
use crate::points::{Points, bounds};
use crate::project::{Sheet, project};

/// Radius of the probe that carves, in spacings: it falls through an even cloud of 25,000 points
/// somewhere with probability 1e-2.
const PROBE: f64 = 2.4;
/// Half the thickness that a membrane is given, in spacings.
const MEMBRANE: f64 = 2.2;
/// Step of the lattice, in spacings.
const STEP: f64 = 1.0;
/// Most vertices of the lattice.
const MOST_VERTICES: usize = 3_000_000;
/// Fewer distinct points than this are no surface.
const LEAST_POINTS: usize = 50;

/// A cloud thinner than this share of its width is flat.
const LEAST_THICKNESS: f64 = 1e-3;

/// How a cloud is wrapped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrapSettings {
    /// Vertices of the mesh, about.
    pub vertices: usize,
}

impl Default for WrapSettings {
    fn default() -> Self {
        Self { vertices: 4000 }
    }
}

/// A closed surface of genus zero around a cloud, and what was changed to make it one.
#[derive(Clone, Debug)]
pub struct Wrap {
    /// The surface.
    pub mesh: Mesh,
    /// Typical distance between neighbouring points, 1/√density.
    pub spacing: f64,
    /// Radius of the ball that carved the outside away; gaps narrower than twice this are closed.
    pub probe: f64,
    /// Handles and tunnels that were closed by a slab, the largest first.
    pub closed_holes: Vec<ClosedHole>,
    /// Number of different points that were not seen from outside and had no influence.
    pub hidden: usize,
    /// The outward unit normal of every point of the cloud, by the plane through its neighbours.
    pub normals: Vec<UnitVector3<f64>>,
}

/// Why there is no wrap.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WrapError {
    /// A coordinate is NaN or infinite.
    #[error("point {index} is not finite")]
    NotFinite {
        /// Which point.
        index: usize,
    },
    /// There are too few different points.
    #[error("{count} different points; a surface needs at least 50")]
    TooFew {
        /// How many there are.
        count: usize,
    },
    /// The points lie in a plane or on a line.
    #[error("the cloud is flat: its deviation is {thickness:.3e} across and {width:.3e} along")]
    Flat {
        /// Standard deviation along the thinnest direction.
        thickness: f64,
        /// The same along the widest one.
        width: f64,
    },
    /// The mesh is no closed surface of genus zero.
    #[error(
        "the wrap is no closed surface of genus zero: its Euler characteristic is {euler}, not 2"
    )]
    Topology {
        /// χ.
        euler: i64,
    },
}

/// Wraps a cloud in a closed surface of genus zero.
///
/// A ball with a radius of 2.4 spacings carves a block of lattice vertices from outside; a vertex goes
/// only if that keeps the topology of a ball. Then the surface moves to the points, by the planes
/// through their neighbours. A handle keeps a membrane across, which becomes a slab
/// ([`Wrap::closed_holes`]). Inner walls are hidden by outer ones ([`Wrap::hidden`]).
///
/// # Errors
/// [`WrapError`].
pub fn wrap(points: &[Point3<f64>], settings: &WrapSettings) -> Result<Wrap, WrapError> {
    if let Some(index) = points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        return Err(WrapError::NotFinite { index });
    }
    let (distinct, firsts) = distinct(points);
    if distinct.len() < LEAST_POINTS {
        return Err(WrapError::TooFew {
            count: distinct.len(),
        });
    }
    let cloud: Vec<Point3<f64>> = distinct.iter().map(|i| points[*i as usize]).collect();
    check_extent(&cloud)?;
    let grid = Points::new(&cloud);
    let spacing = grid.spacing();
    let probe = PROBE * spacing;
    let (low, high) = bounds(&cloud);
    let lattice = Lattice::covering(&low, &high, 1.5 * probe, STEP * spacing, MOST_VERTICES);
    let probe = probe.max(2.0 * lattice.step);
    let (distances, nearest) = carve::distances(&lattice, &cloud);
    let mut carving = Carving::solid(&lattice);
    carving.flip(true, |at| distances[at] - probe as f32);
    let membranes = Membranes::find(&carving, &distances, probe);

    let mut normals = grid.normals();
    let sight = 2.0 * probe;
    let seen = orient::orient(&lattice, &carving, &cloud, &mut normals, probe, sight);
    let mut field = orient::signed_distances(&lattice, &cloud, &normals, &nearest, &seen, spacing);
    let slab = MEMBRANE * spacing;
    let membrane = if membranes.is_empty() {
        Vec::new()
    } else {
        membranes.distances(&lattice, slab + 2.0 * lattice.step)
    };
    fill_in(&mut field, &carving, &distances, probe, &membrane, slab);
    carving.flip(true, |at| field[at]);
    carving.flip(false, |at| -field[at]);

    let fine = march(&lattice, &carving.inside, &field);
    let closed_holes = membranes.holes(&lattice, &fine, &distances, probe, slab);
    let broken = || WrapError::Topology {
        euler: fine.euler_characteristic(),
    };
    let sheet = Sheet {
        grid: &grid,
        normals: &normals,
        seen: &seen,
        spacing,
    };
    let mut middle = decimate(&fine, 3 * settings.vertices).ok_or_else(broken)?;
    project(&mut middle, &sheet);
    let mut mesh = decimate(&middle, settings.vertices).ok_or_else(broken)?;
    project(&mut mesh, &sheet);
    let euler = mesh.euler_characteristic();
    if euler != 2 {
        return Err(WrapError::Topology { euler });
    }
    Ok(Wrap {
        mesh,
        spacing,
        probe,
        closed_holes,
        hidden: seen.iter().filter(|s| !**s).count(),
        normals: firsts
            .iter()
            .map(|k| UnitVector3::new_unchecked(normals[*k as usize]))
            .collect(),
    })
}

/// Whether the cloud has an extent in all three dimensions, whatever its pose.
fn check_extent(cloud: &[Point3<f64>]) -> Result<(), WrapError> {
    let count = cloud.len() as f64;
    let mean = cloud.iter().map(|p| p.coords).sum::<Vector3<f64>>() / count;
    let spread = cloud
        .iter()
        .map(|p| (p.coords - mean) * (p.coords - mean).transpose())
        .sum::<Matrix3<f64>>();
    let deviations = (spread / count)
        .symmetric_eigenvalues()
        .map(|v| v.max(0.0).sqrt());
    let (thickness, width) = (deviations.min(), deviations.max());
    if thickness > LEAST_THICKNESS * width {
        Ok(())
    } else {
        Err(WrapError::Flat { thickness, width })
    }
}

/// Gives the field a sign and a size where no point is near, and thickens the membranes.
fn fill_in(
    field: &mut [f32],
    carving: &Carving,
    distances: &[f32],
    probe: f64,
    membrane: &[f32],
    slab: f64,
) {
    for (at, value) in field.iter_mut().enumerate() {
        if value.is_nan() {
            let gap = (distances[at] - probe as f32).abs().max(f32::MIN_POSITIVE);
            *value = if carving.inside[at] { -gap } else { gap };
        }
        if let Some(gap) = membrane.get(at) {
            *value = value.min(gap - slab as f32);
        }
    }
}

/// Indices of the points without repetitions, in the order of the points, and for every point which of
/// these it is.
fn distinct(points: &[Point3<f64>]) -> (Vec<u32>, Vec<u32>) {
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    let compare = |a: &u32, b: &u32| {
        let (p, q) = (&points[*a as usize], &points[*b as usize]);
        let by = |axis: usize| p[axis].total_cmp(&q[axis]);
        by(0).then(by(1)).then(by(2)).then(a.cmp(b))
    };
    order.sort_unstable_by(compare);
    let mut first: Vec<u32> = (0..points.len() as u32).collect();
    for pair in order.windows(2) {
        let (a, b) = (pair[0] as usize, pair[1] as usize);
        if points[a] == points[b] {
            first[b] = first[a];
        }
    }
    let mut kept = Vec::with_capacity(points.len());
    let mut place = vec![0; points.len()];
    for i in 0..points.len() {
        let at = first[i] as usize;
        if at == i {
            place[i] = kept.len() as u32;
            kept.push(i as u32);
        } else {
            place[i] = place[at];
        }
    }
    (kept, place)
}
