//! Points of the unit sphere: the paper's chart, tangent frames, geodesics and retraction.

use nalgebra::{UnitVector3, Vector3};

/// A point p of S², as a unit vector of R³.
pub type Direction = UnitVector3<f64>;

/// The paper's chart p(θ,φ) = (sin θ cos φ, sin θ sin φ, cos θ) (Sec. II-C).
///
/// Radians; θ ∈ [0, π] is measured from +z, φ ∈ [0, 2π) from +x towards +y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphericalCoords {
    /// Polar angle θ from +z, in radians.
    pub theta: f64,
    /// Azimuth φ from +x towards +y, in radians.
    pub phi: f64,
}

impl SphericalCoords {
    /// p(θ,φ). Any finite pair is accepted, also outside the chart's rectangle.
    pub fn direction(self) -> Direction {
        let (sin_theta, cos_theta) = self.theta.sin_cos();
        let (sin_phi, cos_phi) = self.phi.sin_cos();
        Direction::new_unchecked(Vector3::new(
            sin_theta * cos_phi,
            sin_theta * sin_phi,
            cos_theta,
        ))
    }

    /// The coordinates of a direction, φ in [0, 2π); φ is 0 at the poles.
    pub fn from_direction(p: &Direction) -> Self {
        let theta = p.x.hypot(p.y).atan2(p.z);
        let phi = p.y.atan2(p.x);
        let phi = if phi < 0.0 {
            phi + std::f64::consts::TAU
        } else {
            phi
        };
        Self { theta, phi }
    }
}

/// The direction of a vector and its length; `None` at the origin and for vectors that are not finite.
pub fn direction_and_radius(v: &Vector3<f64>) -> Option<(Direction, f64)> {
    let radius = v.norm();
    (radius > 0.0 && radius.is_finite()).then(|| (Direction::new_unchecked(v / radius), radius))
}

/// Two orthonormal tangents (e₁, e₂) at p with e₁ × e₂ = p.
///
/// Defined and accurate everywhere, including the poles. It is not continuous over the whole
/// sphere, since no tangent frame is.
pub fn tangent_frame(p: &Direction) -> (Vector3<f64>, Vector3<f64>) {
    // Duff et al. 2017: one branch on the sign of z, no cancellation.
    let sign = 1.0_f64.copysign(p.z);
    let a = -1.0 / (sign + p.z);
    let b = p.x * p.y * a;
    (
        Vector3::new(1.0 + sign * p.x * p.x * a, sign * b, -sign * p.x),
        Vector3::new(b, sign + p.y * p.y * a, -p.y),
    )
}

/// The part of v that is tangent to the sphere at p.
pub fn project_tangent(p: &Direction, v: &Vector3<f64>) -> Vector3<f64> {
    v - p.into_inner() * p.dot(v)
}

/// Angle between two directions, radians; accurate also near 0 and near π.
pub fn angle(p: &Direction, q: &Direction) -> f64 {
    p.cross(q).norm().atan2(p.dot(q))
}

/// The point at arc length |v| along the great circle that leaves p along the tangent v.
///
/// v is in the units of the sphere (radians); its normal part is ignored. The exponential map of S².
///
/// ```
/// use nalgebra::Vector3;
/// use sph::Direction;
/// use sph::direction::{angle, log, retract};
///
/// // A quarter of a turn from +x along +y ends at +y; the logarithm finds the way again.
/// let (x, y) = (Direction::new_normalize(Vector3::x()), Direction::new_normalize(Vector3::y()));
/// let quarter = std::f64::consts::FRAC_PI_2 * Vector3::y();
/// assert!(angle(&retract(&x, &quarter), &y) < 1e-15);
/// assert!((log(&x, &y) - quarter).norm() < 1e-15);
/// ```
pub fn retract(p: &Direction, v: &Vector3<f64>) -> Direction {
    let tangent = project_tangent(p, v);
    let length = tangent.norm();
    if length == 0.0 {
        return *p;
    }
    let (sin, cos) = length.sin_cos();
    Direction::new_normalize(p.into_inner() * cos + tangent * (sin / length))
}

/// The tangent at p that [`retract`] takes to q along the shorter great circle.
///
/// At antipodes every great circle is shortest; the first tangent of [`tangent_frame`] is taken.
pub fn log(p: &Direction, q: &Direction) -> Vector3<f64> {
    let tangent = project_tangent(p, &q.into_inner());
    let sin = tangent.norm();
    let angle = angle(p, q);
    if sin > 1e-300 {
        tangent * (angle / sin)
    } else if p.dot(q) > 0.0 {
        Vector3::zeros()
    } else {
        tangent_frame(p).0 * std::f64::consts::PI
    }
}

/// The point at parameter 0 ≤ t ≤ 1 of the shorter great circle from p to q.
pub fn geodesic(p: &Direction, q: &Direction, t: f64) -> Direction {
    retract(p, &(log(p, q) * t))
}

/// `count` directions spread evenly over the sphere (a Fibonacci lattice); deterministic.
pub fn even_directions(count: usize) -> Vec<Direction> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    (0..count)
        .map(|i| {
            let z = 1.0 - (2 * i + 1) as f64 / count as f64;
            let s = ((1.0 - z) * (1.0 + z)).sqrt();
            let (sin, cos) = (golden * i as f64).sin_cos();
            Direction::new_normalize(Vector3::new(s * cos, s * sin, z))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_right_handed_everywhere() {
        let mut all = even_directions(500);
        all.extend([Vector3::z_axis(), -Vector3::z_axis(), Vector3::x_axis()]);
        for p in all {
            let (e1, e2) = tangent_frame(&p);
            assert!((e1.cross(&e2) - p.into_inner()).norm() < 1e-14);
            assert!((e1.norm() - 1.0).abs() < 1e-14 && e1.dot(&p).abs() < 1e-14);
        }
    }

    #[test]
    fn retract_undoes_log() {
        let all = even_directions(60);
        for p in &all {
            for q in &all {
                let back = retract(p, &log(p, q));
                assert!((back.into_inner() - q.into_inner()).norm() < 1e-13);
                let half = geodesic(p, q, 0.5);
                assert!((angle(p, &half) - 0.5 * angle(p, q)).abs() < 1e-13);
            }
        }
        let p = all[7];
        assert!((angle(&retract(&p, &log(&p, &-p)), &-p)).abs() < 1e-12);
    }

    #[test]
    fn chart_and_direction_agree() {
        for p in even_directions(200) {
            let c = SphericalCoords::from_direction(&p);
            assert!((0.0..std::f64::consts::TAU).contains(&c.phi));
            assert!((c.direction().into_inner() - p.into_inner()).norm() < 1e-14);
        }
        let pole = SphericalCoords::from_direction(&Vector3::z_axis());
        assert_eq!((pole.theta, pole.phi), (0.0, 0.0));
    }
}
