//! Double-double arithmetic and what is computed with it: wrenches, heights and hulls of few points,
//! all written down from the definitions, without a line of the crate.

use std::ops::{Add, Div, Mul, Neg, Sub};

use grasp::{Contact, Convention, EdgeNorm, Edges, TorqueLength};
use nalgebra::{Point3, Vector3};

/// An unevaluated sum of two numbers: 106 bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Dd(pub(crate) f64, pub(crate) f64);

pub(crate) type D6 = [Dd; 6];

fn two_sum(a: f64, b: f64) -> Dd {
    let s = a + b;
    let t = s - a;
    Dd(s, (a - (s - t)) + (b - t))
}

impl Dd {
    pub(crate) const ZERO: Dd = Dd(0.0, 0.0);

    pub(crate) fn of(x: f64) -> Dd {
        Dd(x, 0.0)
    }

    pub(crate) fn sqrt(self) -> Dd {
        if self.0 <= 0.0 {
            return Dd::ZERO;
        }
        let x = Dd::of(self.0.sqrt());
        let y = (x + self / x) * Dd::of(0.5);
        (y + self / y) * Dd::of(0.5)
    }

    pub(crate) fn abs(self) -> Dd {
        if self.0 < 0.0 { -self } else { self }
    }

    pub(crate) fn above(self, other: Dd) -> bool {
        (self - other).0 > 0.0
    }
}

impl Add for Dd {
    type Output = Dd;
    fn add(self, o: Dd) -> Dd {
        let s = two_sum(self.0, o.0);
        let t = two_sum(self.1, o.1);
        let u = two_sum(s.0, s.1 + t.0);
        two_sum(u.0, u.1 + t.1)
    }
}

impl Neg for Dd {
    type Output = Dd;
    fn neg(self) -> Dd {
        Dd(-self.0, -self.1)
    }
}

impl Sub for Dd {
    type Output = Dd;
    fn sub(self, o: Dd) -> Dd {
        self + -o
    }
}

impl Mul for Dd {
    type Output = Dd;
    fn mul(self, o: Dd) -> Dd {
        let p = self.0 * o.0;
        let e = self.0.mul_add(o.0, -p);
        two_sum(p, e + (self.0 * o.1 + self.1 * o.0))
    }
}

impl Div for Dd {
    type Output = Dd;
    fn div(self, o: Dd) -> Dd {
        let q = Dd::of(self.0 / o.0);
        let r = self - q * o;
        let q = q + Dd::of(r.0 / o.0);
        let r = self - q * o;
        q + Dd::of(r.0 / o.0)
    }
}

pub(crate) fn dot<const N: usize>(a: &[Dd; N], b: &[Dd; N]) -> Dd {
    a.iter().zip(b).fold(Dd::ZERO, |s, (x, y)| s + *x * *y)
}

fn cross(a: &[Dd; 3], b: &[Dd; 3]) -> [Dd; 3] {
    let part = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [part(1, 2), part(2, 0), part(0, 1)]
}

fn lift(v: &Vector3<f64>) -> [Dd; 3] {
    [Dd::of(v.x), Dd::of(v.y), Dd::of(v.z)]
}

/// base + a₁ cos + a₂ sin: the wrenches of one contact with friction.
pub(crate) struct ExactCone {
    pub(crate) base: D6,
    pub(crate) axes: [D6; 2],
}

/// The cones of a grasp of point contacts with a fixed torque length and the least aligned tangent.
pub(crate) fn cones(contacts: &[Contact], centre: &Point3<f64>, c: &Convention) -> Vec<ExactCone> {
    let TorqueLength::Metres(length) = c.torque_length else {
        panic!("a fixed torque length");
    };
    let mu = Dd::of(c.friction);
    let scale = match c.edge_norm {
        EdgeNorm::UnitNormalComponent => Dd::of(1.0),
        EdgeNorm::UnitLength => Dd::of(1.0) / (Dd::of(1.0) + mu * mu).sqrt(),
    };
    contacts
        .iter()
        .map(|contact| {
            let n = lift(&contact.inward_normal);
            let mut e = [Dd::ZERO; 3];
            e[contact.inward_normal.iamin()] = Dd::of(1.0);
            let along = dot(&n, &e);
            let t: [Dd; 3] = std::array::from_fn(|k| e[k] - n[k] * along);
            let size = dot(&t, &t).sqrt();
            let t = t.map(|x| x / size);
            let b = cross(&n, &t);
            let position = lift(&contact.position.coords);
            let z = lift(&centre.coords);
            let arm: [Dd; 3] = std::array::from_fn(|k| position[k] - z[k]);
            let wrench = |f: [Dd; 3]| {
                let torque = cross(&arm, &f).map(|x| x / Dd::of(length));
                [f[0], f[1], f[2], torque[0], torque[1], torque[2]]
            };
            ExactCone {
                base: wrench(n.map(|x| x * scale)),
                axes: [
                    wrench(t.map(|x| x * scale * mu)),
                    wrench(b.map(|x| x * scale * mu)),
                ],
            }
        })
        .collect()
}

/// cos and sin of 2πj/k: powers of a root of unity that Newton's method has made exact.
fn circle(k: usize) -> Vec<[Dd; 2]> {
    let times = |a: [Dd; 2], b: [Dd; 2]| [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
    let (sin, cos) = (std::f64::consts::TAU / k as f64).sin_cos();
    let mut z = [Dd::of(cos), Dd::of(sin)];
    for _ in 0..2 {
        let mut power = [Dd::of(1.0), Dd::ZERO];
        for _ in 0..k {
            power = times(power, z);
        }
        // z − (zᵏ − 1) z / k, since zᵏ⁻¹ is 1/z to first order.
        let error = [
            (power[0] - Dd::of(1.0)) / Dd::of(k as f64),
            power[1] / Dd::of(k as f64),
        ];
        let step = times(error, z);
        z = [z[0] - step[0], z[1] - step[1]];
    }
    let mut all = vec![[Dd::of(1.0), Dd::ZERO]];
    for j in 1..k {
        all.push(times(all[j - 1], z));
    }
    all
}

/// The wrenches of all edges.
pub(crate) fn edges(cones: &[ExactCone], k: usize) -> Vec<D6> {
    let circle = circle(k);
    let edge = |cone: &ExactCone, [cos, sin]: &[Dd; 2]| {
        std::array::from_fn(|i| cone.base[i] + cone.axes[0][i] * *cos + cone.axes[1][i] * *sin)
    };
    cones
        .iter()
        .flat_map(|cone| circle.iter().map(move |at| edge(cone, at)))
        .collect()
}

/// The support function of the hull along u/|u|.
pub(crate) fn support(cones: &[ExactCone], edges_of: Edges, u: &[f64; 6]) -> Dd {
    let u = u.map(Dd::of);
    let size = dot(&u, &u).sqrt();
    let high = |best: Dd, x: Dd| if x.above(best) { x } else { best };
    let least = Dd::of(f64::MIN / 4.0);
    let height = match edges_of {
        Edges::Polygon(k) => edges(cones, k).iter().map(|w| dot(w, &u)).fold(least, high),
        Edges::Round { .. } => cones
            .iter()
            .map(|cone| {
                let (a, b) = (dot(&cone.axes[0], &u), dot(&cone.axes[1], &u));
                dot(&cone.base, &u) + (a * a + b * b).sqrt()
            })
            .fold(least, high),
    };
    height / size
}

/// Solves a square system with full pivots; None if a pivot is zero to 90 bits.
pub(crate) fn solve<const N: usize>(mut a: [[Dd; N]; N], mut b: [Dd; N]) -> Option<[Dd; N]> {
    let scale = a.iter().flatten().map(|x| x.0.abs()).fold(0.0, f64::max);
    let mut column: [usize; N] = std::array::from_fn(|k| k);
    for k in 0..N {
        let (mut row, mut col) = (k, k);
        for i in k..N {
            for j in k..N {
                if a[i][j].abs().above(a[row][col].abs()) {
                    (row, col) = (i, j);
                }
            }
        }
        if a[row][col].0.abs() <= 1e-27 * scale {
            return None;
        }
        a.swap(k, row);
        b.swap(k, row);
        column.swap(k, col);
        a.iter_mut().for_each(|r| r.swap(k, col));
        for i in k + 1..N {
            let factor = a[i][k] / a[k][k];
            let pivot = a[k];
            for (x, p) in a[i].iter_mut().zip(pivot).skip(k) {
                *x = *x - factor * p;
            }
            b[i] = b[i] - factor * b[k];
        }
    }
    let mut x = [Dd::ZERO; N];
    for k in (0..N).rev() {
        let tail = (k + 1..N).fold(Dd::ZERO, |s, j| s + a[k][j] * x[column[j]]);
        x[column[k]] = (b[k] - tail) / a[k][k];
    }
    Some(x)
}

/// The radius of the largest ball around the origin in the hull of a few points, 0 if the origin is
/// not inside: the least offset of all hyperplanes through six points that have all others below.
pub(crate) fn ball_radius(points: &[D6]) -> f64 {
    let reach = points
        .iter()
        .map(|p| dot(p, p).sqrt().0)
        .fold(0.0, f64::max);
    let mut least = f64::INFINITY;
    let mut choice = [0, 1, 2, 3, 4, 5];
    loop {
        if let Some(offset) = offset(points, &choice, reach) {
            least = least.min(offset);
        }
        let n = points.len();
        let Some(at) = (0..6).rev().find(|&k| choice[k] < n - 6 + k) else {
            break;
        };
        choice[at] += 1;
        for k in at + 1..6 {
            choice[k] = choice[k - 1] + 1;
        }
    }
    if least == f64::INFINITY {
        0.0
    } else {
        least.max(0.0)
    }
}

/// The distance of the plane through six points if it supports all; the lesser of both sides if all
/// points lie in it.
fn offset(points: &[D6], choice: &[usize; 6], reach: f64) -> Option<f64> {
    // n with n·(p_k − p_0) = 0 and one component fixed at one: try them all.
    for fixed in 0..6 {
        let mut a = [[Dd::ZERO; 6]; 6];
        for k in 1..6 {
            a[k - 1] = std::array::from_fn(|i| {
                (points[choice[k]][i] - points[choice[0]][i]) / Dd::of(reach)
            });
        }
        a[5][fixed] = Dd::of(1.0);
        let mut b = [Dd::ZERO; 6];
        b[5] = Dd::of(1.0);
        let Some(n) = solve(a, b) else { continue };
        let size = dot(&n, &n).sqrt();
        let level = dot(&n, &points[choice[0]]) / size;
        let slack = Dd::of(1e-24 * reach);
        let height = |p: &D6| dot(&n, p) / size - level;
        let above = points.iter().any(|p| height(p).above(slack));
        let below = points.iter().any(|p| (-height(p)).above(slack));
        return match (above, below) {
            (true, true) => None,
            (false, true) => Some(level.0),
            (true, false) => Some(-level.0),
            (false, false) => Some(-level.0.abs()),
        };
    }
    None
}
