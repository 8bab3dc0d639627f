//! Proved bounds on a distance.

use nalgebra::Point3;

/// Bounds on a distance to the mesh, metres; 0 where the bodies overlap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// The distance is at least this.
    pub lower: f64,
    /// The distance is at most this; infinite beyond the cutoff.
    pub upper: f64,
    /// A point of the mesh at distance `upper`, in the centred frame, if one was found.
    pub on_object: Option<Point3<f64>>,
    /// A vertex of the grid next to that point: its row and column.
    pub(crate) near: Option<Vertex>,
}

/// Row and column of a vertex of the grid.
pub(crate) type Vertex = (u32, u32);

impl Gap {
    pub(super) const TOUCHING: Gap = Gap {
        lower: 0.0,
        upper: 0.0,
        on_object: None,
        near: None,
    };
    pub(super) const FAR: Gap = Gap {
        lower: f64::INFINITY,
        upper: f64::INFINITY,
        on_object: None,
        near: None,
    };

    /// The bounds on the smaller of two distances.
    pub(super) fn min(self, other: Gap) -> Gap {
        Gap {
            lower: self.lower.min(other.lower),
            ..if other.upper < self.upper {
                other
            } else {
                self
            }
        }
    }
}
