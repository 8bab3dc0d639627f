//! Solids as trees of smooth primitives, and the exit points of rays from inside.

use crate::field::Field;
use crate::primitive::{Frustum, ellipsoid, half_space, round_box, seamed_ball};
use nalgebra::{Point3, UnitQuaternion, Vector3};

/// Largest length of a ray, metres; every object of the catalogue is smaller.
const REACH: f64 = 0.4;

/// A solid given by an implicit function; metres, z upright.
#[derive(Clone, Debug)]
pub(crate) enum Solid {
    Ellipsoid(Vector3<f64>),
    RoundBox {
        half: Vector3<f64>,
        round: f64,
    },
    HalfSpace {
        normal: Vector3<f64>,
        offset: f64,
    },
    Frustum(Frustum),
    SeamedBall {
        radius: f64,
        depth: f64,
        width: f64,
    },
    Moved {
        solid: Box<Solid>,
        by: Vector3<f64>,
    },
    Turned {
        solid: Box<Solid>,
        by: UnitQuaternion<f64>,
    },
    Stretched {
        solid: Box<Solid>,
        factors: Vector3<f64>,
    },
    Union {
        parts: Box<[Solid; 2]>,
        fillet: f64,
    },
    Intersection {
        parts: Box<[Solid; 2]>,
        fillet: f64,
    },
    Difference {
        parts: Box<[Solid; 2]>,
        fillet: f64,
    },
}

impl Solid {
    pub(crate) fn ellipsoid(a: f64, b: f64, c: f64) -> Self {
        Self::Ellipsoid(Vector3::new(a, b, c))
    }

    pub(crate) fn ball(radius: f64) -> Self {
        Self::ellipsoid(radius, radius, radius)
    }

    /// Box with the given full side lengths, centred in x and y, standing on z = 0.
    pub(crate) fn standing_box(x: f64, y: f64, z: f64, round: f64) -> Self {
        let half = Vector3::new(x, y, z) * 0.5;
        Self::RoundBox { half, round }.at(0.0, 0.0, half.z)
    }

    /// Truncated cone about the z axis between (radius, height) pairs, rims rounded.
    pub(crate) fn frustum(bottom: (f64, f64), top: (f64, f64), round: f64) -> Self {
        Self::Frustum(Frustum::new(bottom, top, round))
    }

    /// All points below the plane through `point`, whose normal points up or outwards.
    pub(crate) fn below(point: [f64; 3], normal: [f64; 3]) -> Self {
        let normal = Vector3::from(normal).normalize();
        let offset = normal.dot(&Vector3::from(point));
        Self::HalfSpace { normal, offset }
    }

    pub(crate) fn at(self, x: f64, y: f64, z: f64) -> Self {
        let by = Vector3::new(x, y, z);
        let solid = Box::new(self);
        Self::Moved { solid, by }
    }

    /// The solid rotated about the origin by roll, pitch and yaw in radians, applied in this order.
    pub(crate) fn turned(self, roll: f64, pitch: f64, yaw: f64) -> Self {
        let by = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        let solid = Box::new(self);
        Self::Turned { solid, by }
    }

    pub(crate) fn stretched(self, x: f64, y: f64, z: f64) -> Self {
        let factors = Vector3::new(x, y, z);
        let solid = Box::new(self);
        Self::Stretched { solid, factors }
    }

    pub(crate) fn with(self, other: Self, fillet: f64) -> Self {
        let parts = Box::new([self, other]);
        Self::Union { parts, fillet }
    }

    pub(crate) fn within(self, other: Self, fillet: f64) -> Self {
        let parts = Box::new([self, other]);
        Self::Intersection { parts, fillet }
    }

    pub(crate) fn without(self, other: Self, fillet: f64) -> Self {
        let parts = Box::new([self, other]);
        Self::Difference { parts, fillet }
    }

    /// The solid cut off at z = 0 with a rounded rim, so that it can stand.
    pub(crate) fn standing(self, fillet: f64) -> Self {
        let table = Self::below([0.0; 3], [0.0, 0.0, -1.0]);
        self.within(table, fillet)
    }

    /// Implicit function and gradient at p.
    pub(crate) fn field(&self, p: &Point3<f64>) -> Field {
        match self {
            Self::Ellipsoid(semi_axes) => ellipsoid(p, semi_axes),
            Self::RoundBox { half, round } => round_box(p, half, *round),
            Self::HalfSpace { normal, offset } => half_space(p, normal, *offset),
            Self::Frustum(frustum) => frustum.field(p),
            Self::SeamedBall {
                radius,
                depth,
                width,
            } => seamed_ball(p, *radius, *depth, *width),
            Self::Moved { solid, by } => solid.field(&(p - by)),
            Self::Turned { solid, by } => {
                let inner = solid.field(&by.inverse_transform_point(p));
                Field {
                    value: inner.value,
                    gradient: by * inner.gradient,
                }
            }
            Self::Stretched { solid, factors } => {
                let inner = solid.field(&p.coords.component_div(factors).into());
                let shortest = factors.min();
                Field {
                    value: inner.value * shortest,
                    gradient: inner.gradient.component_div(factors) * shortest,
                }
            }
            Self::Union { parts, fillet } => parts[0].field(p).blend(parts[1].field(p), *fillet),
            Self::Intersection { parts, fillet } => {
                parts[0].field(p).intersect(parts[1].field(p), *fillet)
            }
            Self::Difference { parts, fillet } => parts[0]
                .field(p)
                .intersect(parts[1].field(p).complement(), *fillet),
        }
    }

    /// The exit point of the ray from the inner point `from` along the unit vector `direction`.
    ///
    /// Newton's method safeguarded by a shrinking bracket, started at the distance `guess`. The
    /// result is on the surface to about 1e-13 m.
    pub(crate) fn leave(&self, from: &Point3<f64>, direction: &Vector3<f64>, guess: f64) -> Hit {
        let (mut inner, mut outer) = (0.0, REACH);
        let mut distance = guess.clamp(0.0, REACH);
        let mut field = self.field(&(from + direction * distance));
        // Bisection alone would need about 45 halvings of the bracket.
        for _ in 0..60 {
            if field.value.abs() <= 1e-13 {
                break;
            }
            if field.value < 0.0 {
                inner = distance;
            } else {
                outer = distance;
            }
            let newton = distance - field.value / field.gradient.dot(direction);
            // A NaN or infinite step fails this comparison and is replaced by bisection.
            distance = if newton > inner && newton < outer {
                newton
            } else {
                0.5 * (inner + outer)
            };
            field = self.field(&(from + direction * distance));
        }
        Hit {
            distance,
            point: from + direction * distance,
            normal: field.gradient.normalize(),
        }
    }
}

/// The exit point of a ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    /// Length of the ray, metres.
    pub(crate) distance: f64,
    /// Its end, on the surface.
    pub(crate) point: Point3<f64>,
    /// Outward unit normal there.
    pub(crate) normal: Vector3<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_leaves_a_ball_at_its_radius() {
        let ball = Solid::ball(0.04).at(0.0, 0.0, 0.04);
        let up = ball.leave(&Point3::new(0.0, 0.0, 0.03), &Vector3::z(), 0.1);
        assert!((up.distance - 0.05).abs() <= 1e-12);
        assert!((up.normal - Vector3::z()).norm() <= 1e-12);
    }

    #[test]
    fn turned_and_then_moved() {
        let solid = Solid::ellipsoid(0.01, 0.02, 0.03)
            .turned(std::f64::consts::FRAC_PI_2, 0.0, 0.0)
            .at(0.1, 0.0, 0.0);
        for (p, n) in [
            (Point3::new(0.1, 0.03, 0.0), Vector3::y()),
            (Point3::new(0.1, 0.0, -0.02), -Vector3::z()),
        ] {
            let field = solid.field(&p);
            assert!(field.value.abs() <= 1e-15);
            assert!((field.gradient.normalize() - n).norm() <= 1e-12);
        }
    }
}
