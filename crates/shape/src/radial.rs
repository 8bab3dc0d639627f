//! Members of M^rad: surfaces f(p) = r(p) p with r > 0 everywhere.

use nalgebra::{Matrix3, Point3, UnitVector3, Vector3};
use sph::bounds::{Range, certified_range, tight_range};
use sph::grid::RingGrid;
use sph::{Basis, Coefficients, Direction};

use crate::mass::{self, MassProperties};
use crate::surface::{Differential, Surface};
use crate::triangle_mesh::TriangleMesh;

/// Points per half wave in the certificate; the coarsest grid that decides is used.
const OVERSAMPLING: [usize; 2] = [8, 16];

/// Why a function is not the radius of a surface in M^rad.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RadialError {
    /// Somewhere the radius is not positive.
    #[error(
        "the radial function reaches {seen:.6} m, so it is not in M^rad; a larger penalty, a lower degree or a better centre may help"
    )]
    NotPositive {
        /// A value it takes.
        seen: f64,
    },
    /// The radius was positive wherever it was evaluated, but this was not proved.
    #[error(
        "cannot prove the radial function positive: at least {seen:.6} m on a grid, but only above {lower:.6} m for certain"
    )]
    Undecided {
        /// Least value seen.
        seen: f64,
        /// Certified lower bound, not positive.
        lower: f64,
    },
}

/// A proved member of M^rad (Definition 3.1 of the paper): f(p) = r(p) p, r = Σ β_{lm} Y_{lm} > 0.
///
/// r is in metres, in the centred frame. A value of this type whose radius is not positive
/// everywhere cannot be made.
#[derive(Clone, Debug)]
pub struct RadialShape {
    coefficients: Coefficients,
    basis: Basis,
    range: Range,
    mass: MassProperties,
}

impl RadialShape {
    /// Certifies r > 0 on the whole sphere ([`certified_range`]) and computes the mass properties.
    ///
    /// ```
    /// use shape::RadialShape;
    /// use sph::Coefficients;
    ///
    /// // The sphere of 3 cm is a member of M^rad, and a negative radius is not.
    /// let ball = RadialShape::new(Coefficients::constant(4, 0.03))?;
    /// let volume = 4.0 / 3.0 * std::f64::consts::PI * 0.03_f64.powi(3);
    /// assert!((ball.mass_properties().volume / volume - 1.0).abs() < 1e-9);
    /// assert!(RadialShape::new(Coefficients::constant(4, -0.03)).is_err());
    /// # Ok::<(), shape::RadialError>(())
    /// ```
    pub fn new(coefficients: Coefficients) -> Result<Self, RadialError> {
        let range = certify(&coefficients)?;
        Ok(Self::with_range(coefficients, range))
    }

    /// A shape whose range is already known, from the convexity of M^rad.
    pub(crate) fn with_range(coefficients: Coefficients, range: Range) -> Self {
        Self {
            basis: Basis::new(coefficients.degree()),
            mass: mass::radial(&coefficients),
            coefficients,
            range,
        }
    }

    /// The round sphere of a radius in metres.
    pub fn sphere(degree: usize, radius: f64) -> Result<Self, RadialError> {
        Self::new(Coefficients::constant(degree, radius))
    }

    /// The coefficients β of the radius, metres.
    pub fn coefficients(&self) -> &Coefficients {
        &self.coefficients
    }

    /// The degree L of the coefficients.
    pub fn degree(&self) -> usize {
        self.coefficients.degree()
    }

    /// Mean of the radius over all directions, metres.
    pub fn mean_radius(&self) -> f64 {
        self.coefficients.get(0, 0) / (4.0 * std::f64::consts::PI).sqrt()
    }

    /// Certified bounds (r_min, r_max): r_min ≤ r(p) ≤ r_max for every p, r_min > 0. Metres.
    pub fn radius_bounds(&self) -> (f64, f64) {
        (self.range.lower, self.range.upper)
    }

    /// Tighter bounds than [`RadialShape::radius_bounds`]: each is within `share` times half the
    /// range of attained radii. Cost: about 30 ms at L = 50. The bounds of `radius_bounds` are
    /// known already and are about 2 % of that range wider.
    ///
    /// ```
    /// let shape = shape::RadialShape::sphere(8, 0.04)?;
    /// let (low, high) = shape.tight_radius_bounds(1e-3);
    /// assert!(low <= 0.04 && 0.04 <= high && high - low < 1e-12);
    /// # Ok::<(), shape::RadialError>(())
    /// ```
    pub fn tight_radius_bounds(&self, share: f64) -> (f64, f64) {
        let tight = tight_range(&self.coefficients, share);
        (
            tight.lower.max(self.range.lower),
            tight.upper.min(self.range.upper),
        )
    }

    pub(crate) fn range(&self) -> Range {
        self.range
    }

    /// Volume, centroid and inertia of the enclosed solid.
    pub fn mass_properties(&self) -> &MassProperties {
        &self.mass
    }

    /// r(p), metres. About 3 L² flops.
    pub fn radius(&self, p: &Direction) -> f64 {
        let mut work = self.basis.workspace();
        self.basis.sum(&self.coefficients, p, &mut work)
    }

    /// r at many directions, metres.
    pub fn radii(&self, directions: &[Direction]) -> Vec<f64> {
        sph::batch::evaluate(&self.coefficients, directions)
    }

    /// r(p) and ∇_S r(p).
    pub fn radius_and_gradient(&self, p: &Direction) -> (f64, Vector3<f64>) {
        let jet = self.jet(p);
        (jet.value, jet.gradient)
    }

    /// The paper's regular (θ,φ) mesh: `rows` circles of latitude from pole to pole, `columns`
    /// points each. 100 × 100 is the paper's mesh of 10,000 vertices (Sec. IV-C).
    ///
    /// The poles appear once per column, as on the paper's regular grid; triangles without area at
    /// the poles are omitted. Triangles are counter-clockwise seen from outside.
    pub fn mesh(&self, rows: usize, columns: usize) -> TriangleMesh {
        let grid = RingGrid::equiangular(rows, columns);
        let radii = grid.synthesis(&self.coefficients).values;
        TriangleMesh::from_rings(grid.rings(), columns, &radii)
    }

    fn jet(&self, p: &Direction) -> sph::Jet {
        let mut work = self.basis.workspace();
        self.basis.jet(&self.coefficients, p, &mut work)
    }
}

fn certify(coefficients: &Coefficients) -> Result<Range, RadialError> {
    let mut undecided = RadialError::NotPositive { seen: f64::NAN };
    for oversampling in OVERSAMPLING {
        let range = certified_range(coefficients, oversampling);
        if range.lower > 0.0 {
            return Ok(range);
        }
        let seen = range.seen_lower;
        if seen.is_nan() || seen <= 0.0 {
            return Err(RadialError::NotPositive { seen });
        }
        undecided = RadialError::Undecided {
            seen,
            lower: range.lower,
        };
    }
    Err(undecided)
}

/// Inward unit normal ∝ ∇_S r − r p: outward it is r p − ∇_S r. This is the one place of that sign.
fn inward_normal(p: &Direction, radius: f64, gradient: &Vector3<f64>) -> (UnitVector3<f64>, f64) {
    UnitVector3::new_and_get(gradient - p.into_inner() * radius)
}

/// Position and inward normal from r and ∇_S r.
pub(crate) fn contact_of(
    p: &Direction,
    radius: f64,
    gradient: &Vector3<f64>,
) -> (Point3<f64>, UnitVector3<f64>) {
    let normal = inward_normal(p, radius, gradient).0;
    (Point3::from(p.into_inner() * radius), normal)
}

/// The whole differential from r, ∇_S r and Hess_S r.
pub(crate) fn differential_of(p: &Direction, jet: &sph::Jet) -> Differential {
    let direction = p.into_inner();
    let tangent = Matrix3::identity() - direction * direction.transpose();
    let (normal, length) = inward_normal(p, jet.value, &jet.gradient);
    // N = ∇r − r p. Along v: dN = Hess v − p (∇r·v) − p (∇r·v) − r v. The first term with p is due
    // to the rotation of the tangent plane, the second to the change of r; n = N/|N|.
    let raw = jet.hessian - direction * jet.gradient.transpose() * 2.0 - tangent * jet.value;
    let unit = normal.into_inner();
    let across = Matrix3::identity() - unit * unit.transpose();
    Differential {
        position: Point3::from(direction * jet.value),
        inward_normal: normal,
        position_slope: direction * jet.gradient.transpose() + tangent * jet.value,
        normal_slope: across * raw / length,
    }
}

impl Surface for RadialShape {
    fn point(&self, p: &Direction) -> Point3<f64> {
        Point3::from(p.into_inner() * self.radius(p))
    }

    fn contact(&self, p: &Direction) -> (Point3<f64>, UnitVector3<f64>) {
        let (radius, gradient) = self.radius_and_gradient(p);
        contact_of(p, radius, &gradient)
    }

    fn differential(&self, p: &Direction) -> Differential {
        differential_of(p, &self.jet(p))
    }

    fn centre_of_mass(&self) -> Point3<f64> {
        self.mass_properties().centroid
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sph::direction::even_directions;

    #[test]
    fn a_radius_that_turns_negative_is_refused() {
        let mut beta = Coefficients::constant(4, 0.03);
        beta.as_mut_slice()[2] = 0.2;
        assert!(matches!(
            RadialShape::new(beta),
            Err(RadialError::NotPositive { .. })
        ));
        assert!(RadialShape::sphere(3, 0.0).is_err());
    }

    #[test]
    fn the_sphere_has_its_radius_and_normals() {
        let shape = RadialShape::sphere(5, 0.04).unwrap();
        for p in even_directions(50) {
            let (c, n) = shape.contact(&p);
            assert!((c.coords - p.into_inner() * 0.04).norm() <= 1e-15);
            assert!((n.into_inner() + p.into_inner()).norm() <= 1e-13);
        }
        let (low, high) = shape.radius_bounds();
        assert!((low - 0.04).abs() < 1e-12 && (high - 0.04).abs() < 1e-12);
    }
}
