//! Triangle meshes.

use crate::check;
use crate::error::ReportError;

/// A triangle mesh: any number of closed or open pieces.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mesh {
    /// Vertices (n × 3), in the unit of the figure (metres in a [`GraspPage`](crate::GraspPage)).
    pub vertices: Vec<[f64; 3]>,
    /// Three vertex indices per triangle, with either orientation.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Appends another mesh as a separate piece.
    ///
    /// For example to join the boxes and cylinders of a hand into one mesh. Cost O(other).
    ///
    /// ```
    /// let triangle = report::Mesh {
    ///     vertices: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    ///     triangles: vec![[0, 1, 2]],
    /// };
    /// let mut both = triangle.clone();
    /// both.append(&triangle);
    /// assert_eq!(both.triangles, [[0, 1, 2], [3, 4, 5]]);
    /// ```
    pub fn append(&mut self, other: &Mesh) {
        let offset = self.vertices.len() as u32;
        self.vertices.extend_from_slice(&other.vertices);
        self.triangles
            .extend(other.triangles.iter().map(|t| t.map(|v| v + offset)));
    }

    pub(crate) fn check(&self, place: &str) -> Result<(), ReportError> {
        check::not_empty(&format!("{place}: vertices"), self.vertices.len())?;
        check::not_empty(&format!("{place}: triangles"), self.triangles.len())?;
        check::finite_points(&format!("{place}: vertices"), &self.vertices)?;
        for (index, triangle) in self.triangles.iter().enumerate() {
            for &vertex in triangle {
                if vertex as usize >= self.vertices.len() {
                    return Err(ReportError::NoSuchVertex {
                        place: place.to_owned(),
                        index,
                        vertex,
                        vertices: self.vertices.len(),
                    });
                }
            }
        }
        Ok(())
    }
}

/// The axis-aligned box of a set of points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Extent {
    pub(crate) low: [f64; 3],
    pub(crate) high: [f64; 3],
}

impl Extent {
    /// The box of no points; its union with any box is that box.
    pub(crate) const EMPTY: Extent = Extent {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    pub(crate) fn grow(&mut self, points: &[[f64; 3]]) {
        for point in points {
            for (axis, &value) in point.iter().enumerate() {
                self.low[axis] = self.low[axis].min(value);
                self.high[axis] = self.high[axis].max(value);
            }
        }
    }

    pub(crate) fn of(points: &[[f64; 3]]) -> Extent {
        let mut extent = Extent::EMPTY;
        extent.grow(points);
        extent
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.low[0] > self.high[0]
    }

    pub(crate) fn size(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.high[i] - self.low[i])
    }

    pub(crate) fn centre(&self) -> [f64; 3] {
        std::array::from_fn(|i| 0.5 * (self.high[i] + self.low[i]))
    }

    pub(crate) fn longest(&self) -> f64 {
        self.size().into_iter().fold(0.0, f64::max)
    }

    pub(crate) fn diagonal(&self) -> f64 {
        self.size().iter().map(|s| s * s).sum::<f64>().sqrt()
    }

    /// The box enlarged by `margin` on every side.
    pub(crate) fn padded(&self, margin: f64) -> Extent {
        Extent {
            low: self.low.map(|v| v - margin),
            high: self.high.map(|v| v + margin),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> Mesh {
        Mesh {
            vertices: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0]],
            triangles: vec![[0, 1, 2]],
        }
    }

    #[test]
    fn append_shifts_the_indices() {
        let mut mesh = triangle();
        mesh.append(&triangle());
        assert_eq!(mesh.triangles, vec![[0, 1, 2], [3, 4, 5]]);
        assert!(mesh.check("mesh").is_ok());
    }

    #[test]
    fn a_missing_vertex_is_named() {
        let mut mesh = triangle();
        mesh.triangles.push([0, 1, 7]);
        assert_eq!(
            mesh.check("m"),
            Err(ReportError::NoSuchVertex {
                place: "m".into(),
                index: 1,
                vertex: 7,
                vertices: 3
            })
        );
    }

    #[test]
    fn extent_of_points() {
        let extent = Extent::of(&triangle().vertices);
        assert_eq!(extent.size(), [1.0, 2.0, 0.0]);
        assert_eq!(extent.centre(), [0.5, 1.0, 0.0]);
        assert!(Extent::EMPTY.is_empty() && !extent.is_empty());
    }
}
