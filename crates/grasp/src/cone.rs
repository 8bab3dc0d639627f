//! The wrenches of one contact as an ellipsoid, and their support function.

mod balance;
mod cap;
mod symmetry;
mod touching;

use crate::contact::Contact;
use crate::grasp_model::GraspModel;
use crate::hull::cap::Touching;
use crate::hull::plane::{V6, add_scaled, dot, norm, scale};
use crate::hull::support::{Support, Symmetries};
use nalgebra::Vector3;

/// The wrenches of one contact at unit normal force: the ellipsoid base + Σ a_k axis_k, |a| ≤ 1,
/// with two axes of friction and one of torsion (zero where there is none).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cone {
    pub(crate) contact: u32,
    pub(crate) base: V6,
    pub(crate) axes: [V6; 3],
    /// The position from the centre and the inward normal.
    arm: Vector3<f64>,
    normal: Vector3<f64>,
    /// What else decides the ellipsoid: the edge scale, μ, γ and the torque length.
    limits: [f64; 4],
    /// How far a computed point may be from the exact one.
    pub(crate) rounding: f64,
}

/// What decides an ellipsoid beside its place: the length of the normal force, μ and γ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    pub(crate) unit: f64,
    pub(crate) friction: f64,
    pub(crate) torsion: f64,
}

/// Rounding errors of a wrench, relative to |f| (1 + |arm|/length), stay below this: a tangent (4 ulps,
/// more where the rule's vector is nearly parallel to the normal), a cosine (1), the sum of an edge (3),
/// the arm (1), the cross product (3) and the quotient (1) each add a few ulps.
const WRENCH_ROUNDING: f64 = 16.0 * f64::EPSILON;

impl Cone {
    /// The ellipsoids of one contact, one per point of its contact model.
    pub(crate) fn all(
        model: &GraspModel<'_>,
        contact: usize,
        length: f64,
    ) -> impl Iterator<Item = Self> {
        let points = model.contact_model(contact).points();
        (0..points).map(move |point| Self::new(model, contact, point, length))
    }

    fn new(model: &GraspModel<'_>, contact: usize, point: usize, length: f64) -> Self {
        let contact_model = model.contact_model(contact);
        let (friction, torsion) = contact_model.limits();
        let limits = Limits {
            unit: model.edge_scale(contact),
            friction,
            torsion,
        };
        Self::with_limits(model, contact, contact_model.place(point), limits, length)
    }

    /// The ellipsoid of a point beside a contact, with limits of its own.
    pub(crate) fn with_limits(
        model: &GraspModel<'_>,
        contact: usize,
        place: [f64; 2],
        limits: Limits,
        length: f64,
    ) -> Self {
        let Contact {
            position,
            inward_normal,
        } = &model.contacts[contact];
        let Limits {
            unit,
            friction,
            torsion,
        } = limits;
        let mut arm = position - model.centre;
        let n = inward_normal.into_inner() * unit;
        let t = model.convention.tangent.tangent(inward_normal).into_inner();
        let b = inward_normal.cross(&t);
        if place != [0.0, 0.0] {
            arm += t * place[0] + b * place[1];
        }
        let of_force = |f: Vector3<f64>| {
            let t = arm.cross(&f) / length;
            [f.x, f.y, f.z, t.x, t.y, t.z]
        };
        let tangent = friction * model.convention.tangent.condition(inward_normal);
        let size = unit * ((1.0 + tangent) * (1.0 + arm.norm() / length) + torsion / length);
        let twist = n * (torsion / length);
        Cone {
            contact: contact as u32,
            base: of_force(n),
            axes: [
                of_force(t * (unit * friction)),
                of_force(b * (unit * friction)),
                [0.0, 0.0, 0.0, twist.x, twist.y, twist.z],
            ],
            arm,
            normal: inward_normal.into_inner(),
            limits: [unit, friction, torsion, length],
            rounding: WRENCH_ROUNDING * size,
        }
    }

    /// The farthest point of the ellipsoid along `direction`, and its height.
    #[inline]
    pub(crate) fn farthest(&self, direction: &V6) -> (V6, f64) {
        let slopes = self.axes.map(|axis| dot(&axis, direction));
        let length = (slopes[0] * slopes[0] + slopes[1] * slopes[1] + slopes[2] * slopes[2]).sqrt();
        let height = dot(&self.base, direction) + length;
        if length == 0.0 {
            return (self.base, height);
        }
        let mut point = self.base;
        for (axis, slope) in self.axes.iter().zip(slopes) {
            point = add_scaled(&point, slope / length, axis);
        }
        (point, height)
    }

    /// The height of the farthest point alone.
    #[inline]
    fn height(&self, direction: &V6) -> f64 {
        let slopes = self.axes.map(|axis| dot(&axis, direction));
        let square = slopes[0] * slopes[0] + slopes[1] * slopes[1] + slopes[2] * slopes[2];
        dot(&self.base, direction) + square.sqrt()
    }

    /// The same with another friction coefficient than one, and without torsion.
    pub(crate) fn with_friction(&self, friction: f64) -> Self {
        let [t, b, twist] = self.axes;
        Cone {
            axes: [scale(&t, friction), scale(&b, friction), twist],
            rounding: self.rounding * friction.max(1.0),
            limits: [self.limits[0], friction, self.limits[2], self.limits[3]],
            ..*self
        }
    }

    /// How far the normal force alone reaches along a direction.
    pub(crate) fn height_of_normal(&self, direction: &V6) -> f64 {
        dot(&self.base, direction)
    }

    /// How much farther the round cone reaches along a direction than the normal force.
    pub(crate) fn slope(&self, direction: &V6) -> f64 {
        norm(&[
            dot(&self.axes[0], direction),
            dot(&self.axes[1], direction),
            dot(&self.axes[2], direction),
            0.0,
            0.0,
            0.0,
        ])
    }

    /// How much farther the edges of `circle` reach along a direction than the normal force.
    pub(crate) fn largest_edge(&self, direction: &V6, circle: &[(f64, f64)]) -> f64 {
        let [t, b] = [0, 1].map(|k| dot(&self.axes[k], direction));
        let heights = circle.iter().map(|&(cos, sin)| t * cos + b * sin);
        heights.fold(f64::NEG_INFINITY, f64::max)
    }

    /// The farthest point along `direction` as coordinates along the axes; all zero where every point
    /// is as far.
    pub(crate) fn place(&self, direction: &V6) -> [f64; 3] {
        let slopes = self.axes.map(|axis| dot(&axis, direction));
        let length = (slopes[0] * slopes[0] + slopes[1] * slopes[1] + slopes[2] * slopes[2]).sqrt();
        if length == 0.0 {
            [0.0; 3]
        } else {
            slopes.map(|s| s / length)
        }
    }

    /// The point with these coordinates along the axes.
    pub(crate) fn at(&self, place: &[f64; 3]) -> V6 {
        let pairs = self.axes.iter().zip(place);
        pairs.fold(self.base, |p, (axis, &m)| add_scaled(&p, m, axis))
    }

    /// An upper bound of |Aᵀ v| over unit vectors v orthogonal to `u`, A the matrix of the axes.
    fn spread(&self, u: &V6) -> f64 {
        let [t, b, twist] = self.axes.map(|a| add_scaled(&a, -dot(&a, u), u));
        let (tt, tb, bb) = (dot(&t, &t), dot(&t, &b), dot(&b, &b));
        let friction = 0.5 * (tt + bb) + (0.25 * (tt - bb) * (tt - bb) + tb * tb).sqrt();
        (friction + dot(&twist, &twist)).sqrt()
    }

    /// No point of the ellipsoid is longer.
    pub(crate) fn reach(&self) -> f64 {
        let square: f64 = self.axes.iter().map(|a| dot(a, a)).sum();
        norm(&self.base) + square.sqrt()
    }

    /// The corners of the inscribed polytope: an edge for each pair (cos, sin) of `circle`, and the
    /// two poles of torsion.
    pub(crate) fn corners<'a>(&'a self, circle: &'a [(f64, f64)]) -> impl Iterator<Item = V6> + 'a {
        let [t, b, twist] = &self.axes;
        let no_friction = dot(t, t) == 0.0;
        let edges = circle
            .iter()
            .take(if no_friction { 1 } else { circle.len() })
            .map(move |&(cos, sin)| add_scaled(&add_scaled(&self.base, cos, t), sin, b));
        let poles = [1.0, -1.0]
            .into_iter()
            .take(if dot(twist, twist) == 0.0 { 0 } else { 2 })
            .map(move |sign| add_scaled(&self.base, sign, twist));
        edges.chain(poles)
    }
}

/// The hull of several round cones; a point is called by the number of its cone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RoundSource<'a>(pub(crate) &'a [Cone]);

impl Support for RoundSource<'_> {
    fn support(&mut self, direction: &V6) -> (V6, u32) {
        let mut best = (0, f64::NEG_INFINITY);
        for (i, cone) in self.0.iter().enumerate() {
            let height = cone.height(direction);
            if height > best.1 {
                best = (i, height);
            }
        }
        let cone = &self.0[best.0];
        (cone.farthest(direction).0, best.0 as u32)
    }

    fn is_curved(&self) -> bool {
        true
    }

    fn symmetries(&self, out: &mut Symmetries) {
        symmetry::symmetries(self.0, out);
    }

    fn touching(&self, normal: &V6, shares: &[(u32, V6, f64)]) -> Option<Touching> {
        touching::touching(self.0, normal, shares)
    }

    fn beside(&self, normal: &V6, shares: &[(u32, V6, f64)]) -> Option<Touching> {
        touching::beside(self.0, normal, shares)
    }

    fn cap(&self, touching: &Touching, level: f64) -> f64 {
        cap::cap(self.0, touching, level)
    }
}

/// A direction in which points of round cones lie.
pub(crate) fn toward(cones: &[Cone]) -> V6 {
    cones
        .iter()
        .fold([0.0; 6], |s, c| add_scaled(&s, 1.0, &scale(&c.base, 1.0)))
}
