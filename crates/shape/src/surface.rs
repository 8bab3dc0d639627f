//! What every parametrised surface f: S² → R³ can answer.

use nalgebra::{Matrix3, Point3, UnitVector3};
use sph::Direction;

/// First and second order geometry of a surface at one point of the sphere.
///
/// The matrices act on tangent vectors v of S² at p (v·p = 0) and have p in their kernel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Differential {
    /// f(p), metres.
    pub position: Point3<f64>,
    /// Inward unit normal n(p).
    pub inward_normal: UnitVector3<f64>,
    /// df(p): moves of the point, metres a radian.
    pub position_slope: Matrix3<f64>,
    /// dn(p): turns of the inward normal, a radian.
    pub normal_slope: Matrix3<f64>,
}

/// A smooth closed surface f: S² → R³ in its centred frame, metres.
pub trait Surface {
    /// f(p).
    fn point(&self, p: &Direction) -> Point3<f64>;

    /// f(p) and the inward unit normal there.
    fn contact(&self, p: &Direction) -> (Point3<f64>, UnitVector3<f64>);

    /// f, the inward normal and how both change along the sphere.
    fn differential(&self, p: &Direction) -> Differential;

    /// Centroid of the enclosed solid at uniform density.
    fn centre_of_mass(&self) -> Point3<f64>;
}
