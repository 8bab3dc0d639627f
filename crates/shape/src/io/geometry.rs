//! The result of reading a file: points or a mesh, with warnings.

use std::fmt;

use nalgebra::Point3;
use rand::Rng;

use super::error::LoadError;
use super::format::Format;
use super::polygon;
use crate::point_cloud::{CloudError, PointCloud};
use crate::triangle_mesh::TriangleMesh;

/// Extents, in metres, outside of which a unit other than metres is likely.
const PLAUSIBLE_EXTENT: (f64, f64) = (0.005, 2.0);

/// Points, or a surface to take points from. Coordinates are finite.
#[derive(Clone, Debug, PartialEq)]
pub enum Geometry {
    /// Points in the order of the file.
    Points(Vec<Point3<f64>>),
    /// Triangles; polygons of the file were cut into triangles. Every vertex belongs to one.
    Mesh(TriangleMesh),
}

/// A warning about a file that was read.
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
    /// Vertices that no triangle of the mesh uses were left out.
    Unused {
        /// How many.
        vertices: usize,
    },
    /// The content has another format than the name of the file says; the format of the content was
    /// used.
    Content {
        /// The format of the name.
        named: Format,
        /// The format of the content.
        read: Format,
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
            Self::Unused { vertices } => {
                write!(f, "{vertices} vertices that no face uses were left out")
            }
            Self::Content { named, read } => write!(
                f,
                "the name of the file says {named}, but its content is {read}; it was read as {read}"
            ),
        }
    }
}

/// An extent that no object for a hand has, if the file is in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImplausibleExtent {
    /// Largest side of the bounding box, taken as metres.
    pub extent: f64,
}

impl fmt::Display for ImplausibleExtent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (least, most) = PLAUSIBLE_EXTENT;
        let extent = Metres(self.extent);
        write!(
            f,
            "the largest extent is {extent} m, and objects for a hand have {least} to {most} m"
        )?;
        let likely = [("millimetres", 1e-3), ("centimetres", 1e-2)];
        let fits = |(_, factor): &&(&str, f64)| (0.02..=most).contains(&(self.extent * factor));
        match likely.iter().find(fits) {
            Some((unit, _)) => write!(f, "; the file is likely in {unit}"),
            None => write!(f, "; the file is likely not in metres"),
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
    /// Vertices of a mesh left out because no triangle uses them.
    unused: usize,
    /// The format that the name of the file says.
    named: Format,
    /// Warnings, for the caller to display.
    pub warnings: Vec<Warning>,
}

/// Vertices as they stand in a file, finite or not, and triangles with indices that exist.
#[derive(Default)]
pub(super) struct Raw {
    pub(super) vertices: Vec<Point3<f64>>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Raw {
    /// Adds a polygon whose corners exist.
    pub(super) fn polygon(&mut self, format: Format, corners: &[u32]) -> Result<(), LoadError> {
        if polygon::cut(corners, &self.vertices, &mut self.triangles) {
            return Ok(());
        }
        let what = format!("a concave polygon of {} corners", corners.len());
        let expected = format!("at most {} corners", polygon::MAX_CONCAVE);
        Err(LoadError::content(format, what, &expected))
    }

    /// Adds a strip of triangles, every second one turned so that all face the same way.
    pub(super) fn strip(&mut self, corners: &[u32]) {
        let triangles = corners.windows(3).enumerate();
        self.triangles.extend(triangles.map(|(i, c)| match i % 2 {
            0 => [c[0], c[1], c[2]],
            _ => [c[1], c[0], c[2]],
        }));
    }
}

impl Loaded {
    /// Default number of points sampled on a mesh.
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
        let mut unused = 0;
        let geometry = if triangles.is_empty() {
            Geometry::Points(points)
        } else {
            let all = points.len();
            let mesh = used_part(points, triangles);
            unused = all - mesh.vertices.len();
            Geometry::Mesh(mesh)
        };
        let mut loaded = Self {
            format,
            geometry,
            dropped,
            unused,
            named: format,
            warnings: Vec::new(),
        };
        loaded.warn();
        Ok(loaded)
    }

    /// Notes the format that the name of the file says.
    pub(super) fn named(mut self, format: Option<Format>) -> Self {
        self.named = format.unwrap_or(self.format);
        self.warn();
        self
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
    pub fn cloud(self, mesh_samples: usize, rng: &mut impl Rng) -> Result<PointCloud, CloudError> {
        match self.geometry {
            Geometry::Points(points) => PointCloud::new(points),
            Geometry::Mesh(mesh) => PointCloud::new(mesh.sample(mesh_samples, rng)),
        }
    }

    /// The reason why the coordinates are probably not metres: the largest extent of all points is
    /// below 5 mm, or that of the middle nine tenths along each axis is above 2 m. The outer tenth
    /// is excluded so that a few distant points do not decide. Clouds that [`PointCloud::new`]
    /// refuses are not reported here.
    pub fn implausible(&self) -> Option<ImplausibleExtent> {
        let points = self.vertices();
        let (least, most) = PLAUSIBLE_EXTENT;
        let extent = largest_extent(points);
        let typical = (0..3).map(|axis| typical_extent(points, axis));
        let small = (PointCloud::LEAST_EXTENT..least).contains(&extent);
        let large = extent <= PointCloud::FARTHEST && typical.fold(0.0, f64::max) > most;
        (small || large).then_some(ImplausibleExtent { extent })
    }

    fn warn(&mut self) {
        let extent = largest_extent(self.vertices());
        let plausible = (PLAUSIBLE_EXTENT.0..=PLAUSIBLE_EXTENT.1).contains(&extent);
        let rows = self.dropped;
        self.warnings = [
            (rows > 0).then_some(Warning::Dropped { rows }),
            (!plausible).then_some(Warning::Unit { extent }),
            (self.unused > 0).then_some(Warning::Unused {
                vertices: self.unused,
            }),
            (self.named != self.format).then_some(Warning::Content {
                named: self.named,
                read: self.format,
            }),
        ]
        .into_iter()
        .flatten()
        .collect();
    }
}

/// Largest side of the bounding box.
fn largest_extent(points: &[Point3<f64>]) -> f64 {
    let side = |axis: usize| {
        let values = points.iter().map(|p| p[axis]);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
            (a.min(x), b.max(x))
        });
        high - low
    };
    (0..3).map(side).fold(0.0, f64::max)
}

/// Extent along an axis without the outer twentieth at either end, from at most 10,000 points.
fn typical_extent(points: &[Point3<f64>], axis: usize) -> f64 {
    const LOOKED_AT: usize = 10_000;
    let step = points.len().div_ceil(LOOKED_AT).max(1);
    let mut values: Vec<f64> = points.iter().step_by(step).map(|p| p[axis]).collect();
    values.sort_unstable_by(f64::total_cmp);
    let outer = values.len() / 20;
    match (values.get(outer), values.len().checked_sub(outer + 1)) {
        (Some(low), Some(high)) => values[high] - low,
        _ => 0.0,
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

/// The mesh without vertices that no triangle uses.
fn used_part(mut vertices: Vec<Point3<f64>>, mut triangles: Vec<[u32; 3]>) -> TriangleMesh {
    let mut new_index = vec![u32::MAX; vertices.len()];
    for corner in triangles.iter().flatten() {
        new_index[*corner as usize] = 0;
    }
    let mut next = 0;
    for index in new_index.iter_mut().filter(|i| **i == 0) {
        *index = next;
        next += 1;
    }
    if (next as usize) < vertices.len() {
        let mut index = new_index.iter();
        vertices.retain(|_| index.next().is_some_and(|i| *i != u32::MAX));
        for corner in triangles.iter_mut().flatten() {
            *corner = new_index[*corner as usize];
        }
    }
    TriangleMesh {
        vertices,
        triangles,
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
        let rest = [
            Warning::Dropped { rows: 1 },
            Warning::Unit { extent: 0.0 },
            Warning::Unused { vertices: 1 },
        ];
        assert_eq!(loaded.warnings, rest);
        let Geometry::Mesh(mesh) = &loaded.geometry else {
            panic!("a mesh");
        };
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
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
        let why = loaded.implausible().unwrap().to_string();
        assert!(
            why.contains("75.000 m") && why.contains("millimetres"),
            "{why}"
        );
        let scaled = loaded.scaled(1e-3);
        assert_eq!((scaled.implausible(), scaled.warnings), (None, vec![]));
    }

    #[test]
    fn one_point_far_away_does_not_decide_on_the_unit() {
        let at = |i: usize| Point3::new(0.001 * i as f64, 0.0, 0.0);
        let mut vertices: Vec<_> = (0..100).map(at).collect();
        vertices[50].y = 1000.0;
        let triangles = Vec::new();
        let raw = Raw {
            vertices,
            triangles,
        };
        let loaded = Loaded::new(Format::Xyz, raw).unwrap();
        assert_eq!(loaded.warnings, [Warning::Unit { extent: 1000.0 }]);
        assert_eq!(loaded.implausible(), None);
    }
}
