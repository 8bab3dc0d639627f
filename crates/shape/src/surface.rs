//! The interface of every parametrised surface f: S² → R³.

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
    /// df(p), the derivative of the point, metres per radian.
    pub position_slope: Matrix3<f64>,
    /// dn(p), the derivative of the inward normal, per radian.
    pub normal_slope: Matrix3<f64>,
}

impl Differential {
    /// The two principal curvatures at `p`, 1/m, the larger first.
    ///
    /// They are the eigenvalues of the shape operator of the outward normal N, dN = df ∘ S: 1/R on a
    /// sphere of radius R, positive where the solid is convex. `p` is the direction at which the
    /// differential was taken.
    pub fn principal_curvatures(&self, p: &Direction) -> [f64; 2] {
        let (u, v) = sph::direction::tangent_frame(p);
        let (fu, fv) = (self.position_slope * u, self.position_slope * v);
        let (nu, nv) = (-(self.normal_slope * u), -(self.normal_slope * v));
        let (e, f, g) = (fu.dot(&fu), fu.dot(&fv), fv.dot(&fv));
        let (l, m, n) = (nu.dot(&fu), 0.5 * (nu.dot(&fv) + nv.dot(&fu)), nv.dot(&fv));
        let area = e * g - f * f;
        let mean = 0.5 * (e * n - 2.0 * f * m + g * l) / area;
        let gauss = (l * n - m * m) / area;
        let half_difference = (mean * mean - gauss).max(0.0).sqrt();
        [mean + half_difference, mean - half_difference]
    }
}

/// A smooth closed surface f: S² → R³ in its centred frame, metres.
pub trait Surface {
    /// f(p).
    fn point(&self, p: &Direction) -> Point3<f64>;

    /// f(p) and the inward unit normal there.
    fn contact(&self, p: &Direction) -> (Point3<f64>, UnitVector3<f64>);

    /// f, the inward normal and their derivatives along the sphere.
    fn differential(&self, p: &Direction) -> Differential;

    /// Centroid of the enclosed solid at uniform density.
    fn centre_of_mass(&self) -> Point3<f64>;
}
