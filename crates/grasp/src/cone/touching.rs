//! The exact face where the largest ball touches the hull of round cones, by Newton's method.
//!
//! There ν u = Σ λ_i p_i with p_i on the ellipsoid of contact i and u·p_i = ν for every contact that
//! takes part. A contact takes part either with its one support point p_i(u), smooth in u, or, where
//! u is orthogonal to its axes, with its whole flat ellipsoid: then p_i = base + Σ m_k/λ_i axis_k with
//! unknown m and the conditions axis_k·u = 0. Minima of Q favour these kinks.
//!
//! In symmetric grasps the weights λ are not unique; a small multiple of the identity in their rows
//! makes every step choose the smallest change.

use super::Cone;
use super::balance::balanced;
use crate::hull::cap::{MOST_PARTS, Part, Touching};
use crate::hull::plane::{V6, add_scaled, dot, norm, scale};

/// Unknowns: u, ν, and for each contact λ and up to three m.
const SIZE: usize = 7 + 4 * MOST_SHARES;
/// Contacts that a facet of six points can have.
const MOST_SHARES: usize = 6;
const STEPS: usize = 24;
/// Steps beside a minimum, and their damping: of weights relative to the longest wrench, of the
/// direction to the offset.
const SLIDES: usize = 4;
const WEIGHTS: f64 = 1e-6;
const DAMPED: f64 = 0.2;
/// A mean position inside the ellipsoid, rather than on its rim, means that all of it takes part.
const RIM: f64 = 0.98;
/// Keeps the rows of dependent weights solvable, relative to the size of the wrenches.
const REGULAR: f64 = 1e-11;

/// A contact that takes part: its cone, where its unknowns begin, and whether all of it does.
#[derive(Clone, Copy, Default)]
struct Share {
    cone: usize,
    first: usize,
    whole: bool,
}

impl Share {
    /// The axes that carry an unknown m, and its place.
    fn unknown_axes<'a>(&self, cone: &'a Cone) -> impl Iterator<Item = (usize, &'a V6)> + use<'a> {
        let axes = if self.whole { 3 } else { 0 };
        let first = self.first + 1;
        let used = cone.axes[..axes].iter().filter(|a| dot(a, a) > 0.0);
        used.enumerate().map(move |(k, axis)| (first + k, axis))
    }
}

#[derive(Clone)]
struct Face<'a> {
    cones: &'a [Cone],
    shares: [Share; MOST_SHARES],
    count: usize,
    size: usize,
    x: [f64; SIZE],
    unit: f64,
}

/// The touching face near a facet of points of the cones, or None where Newton's method does not
/// lead to one.
pub(super) fn touching(cones: &[Cone], normal: &V6, points: &[(u32, V6, f64)]) -> Option<Touching> {
    let first = Face::near(cones, normal, points)?;
    let found = [[0.0; 2], [0.1, 0.0], [0.1, 1.0]]
        .into_iter()
        .find_map(|damping| first.clone().solve(normal, damping))?;
    Some(balanced(cones, &found).unwrap_or(found))
}

/// A face near a facet that is nearly one that a ball touches: stationary in the directions in which
/// the support function curves, and near the facet's normal in those in which it does not.
///
/// Around a minimum in a long valley of the support function no proof at the minimum reaches far along
/// the valley; proofs at points beside it do.
pub(super) fn beside(cones: &[Cone], normal: &V6, points: &[(u32, V6, f64)]) -> Option<Touching> {
    let mut face = Face::near(cones, normal, points)?;
    for _ in 0..SLIDES {
        let mut step = [0.0; SIZE];
        let damping = [WEIGHTS * face.unit, DAMPED * face.x[6]];
        face.newton_step(&mut step, damping)?;
        face.take(&step);
        face.drop_negative();
    }
    face.accept(normal)
}

impl<'a> Face<'a> {
    fn near(cones: &'a [Cone], normal: &V6, points: &[(u32, V6, f64)]) -> Option<Self> {
        let unit = cones.iter().map(Cone::reach).fold(0.0, f64::max);
        let mut face = Face {
            cones,
            shares: [Share::default(); MOST_SHARES],
            count: 0,
            size: 7,
            x: [0.0; SIZE],
            unit,
        };
        face.x[..6].copy_from_slice(normal);
        let foot = points
            .iter()
            .fold([0.0; 6], |s, (_, p, w)| add_scaled(&s, *w, p));
        face.x[6] = dot(&foot, normal);
        for at in 0..cones.len() {
            face.take_part(at, points)?;
        }
        (face.count > 0).then_some(face)
    }

    /// Adds the contact of a cone if it carries any of the facet; None if there is no room left.
    fn take_part(&mut self, at: usize, points: &[(u32, V6, f64)]) -> Option<()> {
        let cone = &self.cones[at];
        let own = || points.iter().filter(|(tag, ..)| *tag as usize == at);
        let weight: f64 = own().map(|(.., w)| w).sum();
        if weight <= 1e-6 {
            return Some(());
        }
        // Σ λ of the points' places inside the ellipsoid.
        let place = cone.axes.map(|axis| {
            let square = dot(&axis, &axis).max(f64::MIN_POSITIVE);
            own()
                .map(|(_, p, w)| w * dot(&add_scaled(p, -1.0, &cone.base), &axis) / square)
                .sum::<f64>()
        });
        let radius = place.iter().map(|m| m * m).sum::<f64>().sqrt() / weight;
        let share = Share {
            cone: at,
            first: self.size,
            whole: radius < RIM,
        };
        *self.shares.get_mut(self.count)? = share;
        self.count += 1;
        self.x[share.first] = weight;
        let used = cone.axes.iter().zip(place).filter(|(a, _)| dot(a, a) > 0.0);
        self.size += 1;
        for ((row, _), (_, m)) in share.unknown_axes(cone).zip(used) {
            self.x[row] = m;
            self.size += 1;
        }
        Some(())
    }

    /// The face after Newton's steps, without the contacts whose weights become negative.
    fn solve(mut self, normal: &V6, damping: [f64; 2]) -> Option<Touching> {
        for _ in 0..MOST_SHARES {
            self.converge(damping)?;
            if !self.drop_negative() {
                break;
            }
        }
        self.accept(normal)
    }

    /// Newton's steps until they are rounding; None where they do not become so.
    ///
    /// `damping` keeps the weights of contacts whose points depend on each other from running away, and
    /// the direction where it can slide along a curve of minima: it is in proportion to the last step,
    /// so that the steps still end fast.
    fn converge(&mut self, damping: [f64; 2]) -> Option<()> {
        let mut last = f64::INFINITY;
        for round in 0..STEPS {
            let mut step = [0.0; SIZE];
            let [by_weights, by_direction] = damping.map(|d| self.unit * d * last.min(0.1));
            let regular = [by_weights + self.unit * REGULAR, by_direction];
            let length = self.newton_step(&mut step, regular)?;
            self.take(&step);
            if length <= 1e-12 || (length <= 1e-9 && length >= last) {
                return Some(());
            }
            if round >= 8 && length >= last {
                return None;
            }
            last = length;
        }
        None
    }

    /// Takes a step and makes the direction a unit vector again.
    fn take(&mut self, step: &[f64; SIZE]) {
        for (x, s) in self.x.iter_mut().zip(step) {
            *x -= s;
        }
        let size = norm(&self.direction());
        self.x[..6].iter_mut().for_each(|x| *x /= size);
    }

    /// Leaves out the contact with the most negative weight; false if there is none.
    fn drop_negative(&mut self) -> bool {
        let weight = |s: &Share| self.x[s.first];
        let least = (0..self.count)
            .min_by(|&a, &b| weight(&self.shares[a]).total_cmp(&weight(&self.shares[b])));
        let Some(at) = least.filter(|&at| weight(&self.shares[at]) < -1e-9) else {
            return false;
        };
        let gone = self.shares[at];
        let unknowns = 1 + gone.unknown_axes(&self.cones[gone.cone]).count();
        self.x
            .copy_within(gone.first + unknowns..self.size, gone.first);
        self.size -= unknowns;
        self.shares.copy_within(at + 1..self.count, at);
        self.count -= 1;
        for share in &mut self.shares[at..self.count] {
            share.first -= unknowns;
        }
        true
    }

    fn direction(&self) -> V6 {
        std::array::from_fn(|k| self.x[k])
    }

    /// λ times the point with which a contact takes part.
    fn point(&self, share: &Share, u: &V6) -> V6 {
        let cone = &self.cones[share.cone];
        let weight = self.x[share.first];
        if !share.whole {
            return scale(&cone.farthest(u).0, weight);
        }
        share
            .unknown_axes(cone)
            .fold(scale(&cone.base, weight), |p, (row, axis)| {
                add_scaled(&p, self.x[row], axis)
            })
    }

    /// The step of all unknowns; returns how long it is, wrenches measured by the longest. `regular` and
    /// `bent` damp the weights and the direction.
    fn newton_step(&self, step: &mut [f64; SIZE], [regular, bent]: [f64; 2]) -> Option<f64> {
        let (u, offset, n) = (self.direction(), self.x[6], self.size);
        let mut a = [[0.0; SIZE]; SIZE];
        for k in 0..6 {
            step[k] = -offset * u[k];
            a[k][k] = bent - offset;
            a[k][6] = -u[k];
            a[6][k] = 2.0 * u[k];
        }
        step[6] = dot(&u, &u) - 1.0;
        for share in &self.shares[..self.count] {
            let cone = &self.cones[share.cone];
            let part = self.point(share, &u);
            let point = if share.whole {
                cone.base
            } else {
                add_curvature(cone, &u, self.x[share.first], &mut a);
                cone.farthest(&u).0
            };
            let row = share.first;
            step[row] = dot(&point, &u) - offset;
            a[row][row] = -regular;
            a[row][6] = -1.0;
            for k in 0..6 {
                step[k] += part[k];
                a[k][row] = point[k];
                a[row][k] = point[k];
            }
            for (row, axis) in share.unknown_axes(cone) {
                step[row] = dot(axis, &u);
                a[row][row] = -regular;
                for k in 0..6 {
                    a[k][row] = axis[k];
                    a[row][k] = axis[k];
                }
            }
        }
        solve(&mut a, step, n)?;
        let square: f64 = (0..n)
            .map(|k| if k == 6 { step[k] / self.unit } else { step[k] })
            .map(|x| x * x)
            .sum();
        square.is_finite().then_some(square.sqrt())
    }

    /// A stationary point counts if it is near and made of points of the cones.
    fn accept(&self, from: &V6) -> Option<Touching> {
        let direction = self.direction();
        let mut touching = Touching {
            direction,
            offset: self.x[6],
            parts: [Part::default(); MOST_PARTS],
            count: 0,
        };
        if dot(&direction, from) <= 0.5 {
            return None;
        }
        let total: f64 = self.shares[..self.count]
            .iter()
            .map(|s| self.x[s.first])
            .sum();
        for share in &self.shares[..self.count] {
            let weight = self.x[share.first];
            if weight < -1e-9 {
                return None;
            }
            if weight <= 1e-13 {
                continue;
            }
            let cone = &self.cones[share.cone];
            let mut place = [0.0; 3];
            if share.whole {
                let used = (0..3).filter(|&k| dot(&cone.axes[k], &cone.axes[k]) > 0.0);
                for ((row, _), k) in share.unknown_axes(cone).zip(used) {
                    place[k] = self.x[row] / weight;
                }
                let length = place.iter().map(|m| m * m).sum::<f64>().sqrt();
                if length > 1.0 + 1e-9 {
                    return None;
                }
                if length > 1.0 {
                    place.iter_mut().for_each(|m| *m /= length);
                }
            } else {
                place = cone.place(&direction);
            }
            touching.parts[touching.count] = Part {
                cone: share.cone,
                weight: weight / total,
                place,
            };
            touching.count += 1;
        }
        (touching.count > 0).then_some(touching)
    }
}

/// Adds weight·∂p/∂u, the second derivative of the support function of an ellipsoid.
fn add_curvature(cone: &Cone, u: &V6, weight: f64, jacobian: &mut [[f64; SIZE]; SIZE]) {
    let (point, height) = cone.farthest(u);
    let rise = height - dot(&cone.base, u);
    if rise <= 0.0 {
        return;
    }
    let factor = weight / rise;
    for i in 0..6 {
        for j in 0..6 {
            let axes: f64 = cone.axes.iter().map(|a| a[i] * a[j]).sum();
            let along = (point[i] - cone.base[i]) * (point[j] - cone.base[j]);
            jacobian[i][j] += factor * (axes - along);
        }
    }
}

/// Solves the first n equations by elimination with row pivots; the solution replaces `b`.
fn solve(a: &mut [[f64; SIZE]; SIZE], b: &mut [f64; SIZE], n: usize) -> Option<()> {
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()))?;
        a.swap(k, pivot);
        b.swap(k, pivot);
        let (above, below) = a.split_at_mut(k + 1);
        let row = &above[k];
        if row[k].abs() <= f64::MIN_POSITIVE {
            return None;
        }
        for (i, other) in below[..n - k - 1].iter_mut().enumerate() {
            let factor = other[k] / row[k];
            if factor != 0.0 {
                for j in k + 1..n {
                    other[j] -= factor * row[j];
                }
                b[k + 1 + i] -= factor * b[k];
            }
        }
    }
    for k in (0..n).rev() {
        let tail: f64 = (k + 1..n).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - tail) / a[k][k];
    }
    Some(())
}
