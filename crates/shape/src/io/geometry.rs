//! What was read: points or a mesh, and what about them looks wrong.

use std::fmt;

use nalgebra::Point3;
use rand::Rng;

use super::error::{Format, LoadError};
use crate::point_cloud::{CloudError, PointCloud};
use crate::triangle_mesh::TriangleMesh;

/// Extents, in metres, outside of which a unit other than metres is likely.
const PLAUSIBLE_EXTENT: (f64, f64) = (0.005, 2.0);

/// Points, or a surface to take points from. Coordinates are finite.
#[derive(Clone, Debug, PartialEq)]
pub enum Geometry {
    /// Points in the order of the file.
    Points(Vec<Point3<f64>>),
    /// Triangles; polygons of the file were split into fans.
    Mesh(TriangleMesh),
}

/// Something about a file that its user should know, though it was read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Warning {
    /// Rows with NaN or infinite coordinates were left out.
    Dropped {
        /// How many.
        rows: usize,
    },
    /// The largest extent is below 5 mm or above 2 m if the file is in metres.
    Unit {
        /// Largest side of the bounding box, taken as metres.
        extent: f64,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Dropped { rows } => {
                write!(f, "{rows} rows with NaN or infinite numbers were dropped")
            }
            Self::Unit { extent } => write!(
                f,
                "the largest extent is {} m; is the file in metres?",
                Metres(*extent)
            ),
        }
    }
}

/// A length in metres, short whatever its size.
struct Metres(f64);

impl fmt::Display for Metres {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if (1e-3..1e6).contains(&self.0) {
            write!(f, "{:.3}", self.0)
        } else {
            write!(f, "{:.3e}", self.0)
        }
    }
}

/// A file's points or mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The format it was read as.
    pub format: Format,
    /// Points or mesh, in the file's unit and frame.
    pub geometry: Geometry,
    /// Rows left out because of NaN or infinite numbers.
    pub dropped: usize,
    /// What looks wrong, for the caller to show.
    pub warnings: Vec<Warning>,
}

/// Vertices as they stand in a file, finite or not, and triangles with indices that exist.
#[derive(Default)]
pub(super) struct Raw {
    pub(super) vertices: Vec<Point3<f64>>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Loaded {
    /// Points that a mesh is sampled with unless the user says otherwise.
    pub const MESH_SAMPLES: usize = 25_000;

    /// Drops vertices that are not finite, and the triangles that use them.
    pub(super) fn new(format: Format, raw: Raw) -> Result<Self, LoadError> {
        let read = raw.vertices.len();
        let (points, triangles) = if raw.vertices.iter().all(is_finite) {
            (raw.vertices, raw.triangles)
        } else {
            finite_part(raw)
        };
        let dropped = read - points.len();
        if points.is_empty() {
            return Err(LoadError::NoPoints { format, dropped });
        }
        let geometry = if triangles.is_empty() {
            Geometry::Points(points)
        } else {
            Geometry::Mesh(TriangleMesh {
                vertices: points,
                triangles,
            })
        };
        let mut loaded = Self {
            format,
            geometry,
            dropped,
            warnings: Vec::new(),
        };
        loaded.warn();
        Ok(loaded)
    }

    /// The points, or the corners of the mesh.
    pub fn vertices(&self) -> &[Point3<f64>] {
        match &self.geometry {
            Geometry::Points(points) => points,
            Geometry::Mesh(mesh) => &mesh.vertices,
        }
    }

    /// Every coordinate times a factor, such as 0.001 for millimetres; warnings are looked for again.
    pub fn scaled(mut self, factor: f64) -> Self {
        let points = match &mut self.geometry {
            Geometry::Points(points) => points,
            Geometry::Mesh(mesh) => &mut mesh.vertices,
        };
        for p in points {
            *p *= factor;
        }
        self.warn();
        self
    }

    /// The cloud: the points themselves, or `mesh_samples` points spread over the mesh by area.
    pub fn cloud(&self, mesh_samples: usize, rng: &mut impl Rng) -> Result<PointCloud, CloudError> {
        match &self.geometry {
            Geometry::Points(points) => PointCloud::new(points.clone()),
            Geometry::Mesh(mesh) => PointCloud::new(mesh.sample(mesh_samples, rng)),
        }
    }

    fn warn(&mut self) {
        let points = self.vertices();
        let extent = (0..3)
            .map(|axis| {
                let values = points.iter().map(|p| p[axis]);
                let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
                    (a.min(x), b.max(x))
                });
                high - low
            })
            .fold(0.0, f64::max);
        let plausible = (PLAUSIBLE_EXTENT.0..=PLAUSIBLE_EXTENT.1).contains(&extent);
        let rows = self.dropped;
        self.warnings = [
            (rows > 0).then_some(Warning::Dropped { rows }),
            (!plausible).then_some(Warning::Unit { extent }),
        ]
        .into_iter()
        .flatten()
        .collect();
    }
}

fn is_finite(p: &Point3<f64>) -> bool {
    p.iter().all(|x| x.is_finite())
}

fn finite_part(raw: Raw) -> (Vec<Point3<f64>>, Vec<[u32; 3]>) {
    let mut kept = Vec::with_capacity(raw.vertices.len());
    let mut new_index = Vec::with_capacity(raw.vertices.len());
    for p in raw.vertices {
        new_index.push(is_finite(&p).then_some(kept.len() as u32));
        if is_finite(&p) {
            kept.push(p);
        }
    }
    let renamed = |&[a, b, c]: &[u32; 3]| {
        let at = |i: u32| new_index[i as usize];
        Some([at(a)?, at(b)?, at(c)?])
    };
    let triangles = raw.triangles.iter().filter_map(renamed).collect();
    (kept, triangles)
}

/// Splits a polygon into the fan of its first corner.
pub(super) fn fan(corners: &[u32], triangles: &mut Vec<[u32; 3]>) {
    if let [first, rest @ ..] = corners {
        triangles.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_of_dropped_vertices_go_with_them() {
        let mut vertices = vec![Point3::new(0.1, 0.0, 0.0); 5];
        vertices[1].z = f64::NAN;
        let raw = Raw {
            vertices,
            triangles: vec![[0, 1, 2], [0, 2, 4]],
        };
        let loaded = Loaded::new(Format::Ply, raw).unwrap();
        assert_eq!(loaded.dropped, 1);
        assert_eq!(loaded.warnings[0], Warning::Dropped { rows: 1 });
        let Geometry::Mesh(mesh) = &loaded.geometry else {
            panic!("a mesh");
        };
        assert_eq!(mesh.triangles, [[0, 1, 3]]);
    }

    #[test]
    fn a_unit_other_than_metres_is_noticed_until_scaled() {
        let vertices = vec![Point3::new(0.0, 0.0, 0.0), Point3::new(75.0, 1.0, 1.0)];
        let raw = Raw {
            vertices,
            triangles: Vec::new(),
        };
        let loaded = Loaded::new(Format::Stl, raw).unwrap();
        assert_eq!(loaded.warnings, [Warning::Unit { extent: 75.0 }]);
        assert_eq!(loaded.scaled(1e-3).warnings, []);
    }
}
