//! The primitives of solids, each with its implicit function and gradient.

use crate::field::Field;
use nalgebra::{Point3, Vector2, Vector3};

/// Length below which a direction is undefined and its gradient zero, metres.
const TINY: f64 = 1e-12;

/// x / |x|, or zero where x vanishes (only on an axis or at a centre, never on a surface).
fn direction(x: Vector3<f64>) -> Vector3<f64> {
    let norm = x.norm();
    if norm > TINY {
        x / norm
    } else {
        Vector3::zeros()
    }
}

/// Ellipsoid about the origin: s (|p / a| − 1) with s the smallest semi-axis.
///
/// The factor s bounds the slope by one, like that of a distance.
pub(crate) fn ellipsoid(p: &Point3<f64>, semi_axes: &Vector3<f64>) -> Field {
    let scaled = p.coords.component_div(semi_axes);
    let shortest = semi_axes.min();
    Field {
        value: shortest * (scaled.norm() - 1.0),
        gradient: direction(scaled).component_div(semi_axes) * shortest,
    }
}

/// Box about the origin with rounded edges; exact distance outside the core.
pub(crate) fn round_box(p: &Point3<f64>, half: &Vector3<f64>, round: f64) -> Field {
    let q = p.coords.abs() - half.add_scalar(-round);
    let sign = p.coords.map(|x| if x < 0.0 { -1.0 } else { 1.0 });
    let outside = q.sup(&Vector3::zeros());
    let distance = outside.norm();
    if distance > TINY {
        return Field {
            value: distance - round,
            gradient: outside.component_mul(&sign) / distance,
        };
    }
    let axis = q.imax();
    let mut gradient = Vector3::zeros();
    gradient[axis] = sign[axis];
    Field {
        value: q[axis] - round,
        gradient,
    }
}

/// Half-space of the points with n·p ≤ offset, n a unit vector.
pub(crate) fn half_space(p: &Point3<f64>, normal: &Vector3<f64>, offset: f64) -> Field {
    Field {
        value: normal.dot(&p.coords) - offset,
        gradient: *normal,
    }
}

/// Truncated cone about the z axis with rounded rims, stored as a core that is offset by `round`.
#[derive(Clone, Debug)]
pub(crate) struct Frustum {
    bottom: Vector2<f64>,
    top: Vector2<f64>,
    round: f64,
}

impl Frustum {
    /// The frustum with radius r0 at height z0 and r1 at z1 > z0, rims rounded with radius `round`.
    pub(crate) fn new((r0, z0): (f64, f64), (r1, z1): (f64, f64), round: f64) -> Self {
        let height = z1 - z0;
        let slope = (r1 - r0) / height;
        // Moving the slanted side inwards by `round` shortens every radius by this much.
        let inset = round * (1.0 + slope * slope).sqrt();
        let radius_at = |z: f64| r0 + slope * (z - z0) - inset;
        Self {
            bottom: Vector2::new(radius_at(z0 + round), z0 + round),
            top: Vector2::new(radius_at(z1 - round), z1 - round),
            round,
        }
    }

    /// Exact signed distance and its gradient.
    pub(crate) fn field(&self, p: &Point3<f64>) -> Field {
        let radius = p.x.hypot(p.y);
        let q = Vector2::new(radius, p.z);
        let axis_bottom = Vector2::new(0.0, self.bottom.y);
        let axis_top = Vector2::new(0.0, self.top.y);
        let offset = [
            (self.bottom, self.top),
            (axis_bottom, self.bottom),
            (self.top, axis_top),
        ]
        .map(|(a, b)| offset_from_segment(&q, &a, &b))
        .into_iter()
        .min_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))
        .unwrap_or_else(Vector2::zeros);
        let side = self.top - self.bottom;
        let across = Vector2::new(side.y, -side.x).dot(&(q - self.bottom));
        let inside = across < 0.0 && q.y > self.bottom.y && q.y < self.top.y;
        let sign = if inside { -1.0 } else { 1.0 };
        let distance = offset.norm();
        let in_plane = if distance > TINY {
            offset * (sign / distance)
        } else {
            Vector2::zeros()
        };
        let outwards = direction(Vector3::new(p.x, p.y, 0.0));
        Field {
            value: sign * distance - self.round,
            gradient: outwards * in_plane.x + Vector3::z() * in_plane.y,
        }
    }
}

/// q minus its closest point on the segment from a to b.
fn offset_from_segment(q: &Vector2<f64>, a: &Vector2<f64>, b: &Vector2<f64>) -> Vector2<f64> {
    let along = b - a;
    let from_a = q - a;
    let t = (from_a.dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    from_a - along * t
}

/// Ball about the origin with the groove of a sewn ball: |p| − R + depth / (1 + (s/width)²)².
///
/// s(u) = u_x² − u_y² + 0.8 u_z of the unit direction u vanishes on one closed curve that winds
/// like the seam of a tennis ball or softball.
pub(crate) fn seamed_ball(p: &Point3<f64>, radius: f64, depth: f64, width: f64) -> Field {
    const LIFT: f64 = 0.8;
    let distance = p.coords.norm();
    let u = direction(p.coords);
    let s = (u.x * u.x - u.y * u.y + LIFT * u.z) / width;
    let bell = 1.0 / (1.0 + s * s);
    let ds_du = Vector3::new(2.0 * u.x, -2.0 * u.y, LIFT) / width;
    let tangential = ds_du - u * u.dot(&ds_du);
    Field {
        value: distance - radius + depth * bell * bell,
        gradient: u - tangential * (4.0 * depth * s * bell * bell * bell / distance.max(TINY)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gradients agree with central differences away from creases.
    fn check(f: impl Fn(&Point3<f64>) -> Field) {
        for p in [
            Point3::new(0.031, 0.012, 0.017),
            Point3::new(-0.012, 0.033, 0.071),
            Point3::new(0.004, -0.041, 0.002),
        ] {
            let h = 1e-6;
            for axis in 0..3 {
                let mut step = Vector3::zeros();
                step[axis] = h;
                let difference = (f(&(p + step)).value - f(&(p - step)).value) / (2.0 * h);
                assert!((difference - f(&p).gradient[axis]).abs() <= 1e-6);
            }
        }
    }

    #[test]
    fn gradients_match_differences() {
        check(|p| ellipsoid(p, &Vector3::new(0.03, 0.02, 0.05)));
        check(|p| round_box(p, &Vector3::new(0.02, 0.03, 0.05), 0.004));
        let frustum = Frustum::new((0.03, 0.0), (0.02, 0.06), 0.004);
        check(|p| frustum.field(p));
        check(|p| seamed_ball(p, 0.04, 0.001, 0.1));
    }

    #[test]
    fn frustum_has_the_given_extents() {
        let frustum = Frustum::new((0.03, 0.01), (0.02, 0.06), 0.004);
        let at = |r: f64, z: f64| frustum.field(&Point3::new(0.0, r, z)).value;
        assert!(at(0.0, 0.01).abs() <= 1e-15);
        assert!(at(0.0, 0.06).abs() <= 1e-15);
        // At half the height the slanted side coincides with that of the sharp cone.
        assert!(at(0.025, 0.035).abs() <= 1e-15);
        assert!(at(0.0, 0.035) < -0.02);
    }
}
