//! Where a ball touches a curved hull, and how far around that direction nothing is nearer.

use super::plane::V6;

/// Contacts that can take part in a touching face at once.
pub(crate) const MOST_PARTS: usize = 12;

/// One ellipsoid's part in a touching face.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Part {
    /// The number of the ellipsoid.
    pub(crate) cone: usize,
    /// Its weight; all of a face sum to one.
    pub(crate) weight: f64,
    /// Where on the ellipsoid: coordinates along its axes, of length one at most.
    pub(crate) place: [f64; 3],
}

/// A convex combination of points of the set that is (nearly) a multiple of `direction`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touching {
    pub(crate) direction: V6,
    /// The length of the combination.
    pub(crate) offset: f64,
    pub(crate) parts: [Part; MOST_PARTS],
    pub(crate) count: usize,
}

impl Touching {
    pub(crate) fn parts(&self) -> &[Part] {
        &self.parts[..self.count]
    }
}

/// A cap of the sphere of directions within which the support function is `level` or more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cap {
    pub(crate) touching: Touching,
    /// Whether a ball touches the hull at the face, and not only nearly so.
    pub(crate) touches: bool,
    /// The angle of the cap.
    pub(crate) angle: f64,
    pub(crate) level: f64,
}
