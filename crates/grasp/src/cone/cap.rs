//! A proof that the support function of round cones stays above a level around a direction.
//!
//! Let p_i = base_i + A_i m_i with |m_i| ≤ 1 be points of the ellipsoids, λ_i ≥ 0 their weights with
//! sum one, g = Σ λ_i p_i, and u = u₀ cos β + v sin β with v a unit vector orthogonal to u₀ and β ≤ α.
//! With s_i = A_iᵀ u and S_i an upper bound of |s_i| in the cap,
//!
//!   h_i(u) = base_i·u + |s_i| ≥ p_i·u + ½ s_iᵀ N_i s_i,
//!   N_i = 2 (1 − |m_i|)/S_i · I + |m_i|/S_i · (I − m̂_i m̂_iᵀ),
//!
//! because |s| − m·s = (1 − |m|)|s| + |m|(|s| − m̂·s) and |s| − m̂·s ≥ |s_⊥|²/(2|s|). The support
//! function of the hull is at least any convex combination of the h_i. With d_i = p_i − g orthogonal to
//! u₀ the weights λ_i (1 + c sin β d_i·v) are such a combination as long as c sin α |d_i| ≤ 1, and give
//!
//!   h(u) ≥ ν cos β + ½ κ′ sin² β − ρ sin β − δ,
//!
//! with ν = g·u₀, κ the least eigenvalue of T = Σ λ_i (A_i N_i A_iᵀ + c d_i d_iᵀ) on the complement of
//! u₀, κ′ = κ − c sin² α Σ λ_i |A_i N_i A_iᵀ|²/4, and ρ, δ what is left of stationarity. (The cubic
//! terms ½ sin³ β c Σ λ_i |d_i·v| vᵀ A_i N_i A_iᵀ v are met by half of c sin² β Σ λ_i (d_i·v)².) But for
//! ρ the bound is concave in sin² β, so that it holds in the whole cap if it holds at β = 0 and β = α.
//! Whether κ′ suffices is decided by a Cholesky factorisation.

use super::Cone;
use crate::hull::cap::{MOST_PARTS, Part, Touching};
use crate::hull::plane::{V6, add_scaled, dot, norm, scale};

type M6 = [V6; 6];

/// The widest cap that is tried, its successors' ratio, and how many are tried.
const WIDEST: f64 = 0.9;
const RATIO: f64 = 0.87;
const TRIED: usize = 36;
/// Rates c of the shift of weights that are tried, relative to the largest.
const SHIFTS: [f64; 5] = [0.5, 0.2, 0.07, 0.02, 1.0];
/// Directions in which the points p differ by less than this (squared, relative) are left out.
const SPANNED: f64 = 1e-4;
/// Rounding of the bound, relative to the longest wrench.
const ROUNDING: f64 = 4e-15;

/// One part with everything that does not depend on the angle.
#[derive(Clone, Copy, Default)]
struct Item {
    weight: f64,
    /// p − g orthogonal to u₀.
    d: V6,
    /// The length of the shift of this part's weight, relative to it, of either kind.
    shifts: [f64; 2],
    /// |s(u₀)| and the norm of A on the complement of u₀ (or more).
    start: f64,
    slope: f64,
    /// A (I − m̂ m̂ᵀ) Aᵀ |m| + 2 (1 − |m|) A Aᵀ, to be divided by S.
    matrix: M6,
    norm: f64,
    /// |matrix · u₀|.
    rest: f64,
    /// Whether p lies inside the ellipsoid.
    flat: bool,
}

/// See [`crate::hull::support::Support::cap`].
pub(super) fn cap(cones: &[Cone], touching: &Touching, level: f64) -> f64 {
    let u = touching.direction;
    let size = cones.iter().map(Cone::reach).fold(0.0, f64::max);
    let point = |part: &Part| cones[part.cone].at(&part.place);
    let g = touching.parts().iter().fold([0.0; 6], |g, part| {
        add_scaled(&g, part.weight, &point(part))
    });
    let nu = dot(&g, &u);
    let rest = norm(&add_scaled(&g, -nu, &u));
    let mut items = [Item::default(); MOST_PARTS];
    let mut delta = ROUNDING * size;
    for (item, part) in items.iter_mut().zip(touching.parts()) {
        let apart = add_scaled(&point(part), -1.0, &g);
        let along = dot(&apart, &u);
        delta += part.weight * along.abs();
        *item = Item::of(&cones[part.cone], part, &u, &add_scaled(&apart, -along, &u));
    }
    let face = Face::of(&mut items[..touching.count], &u, nu, rest, delta);
    let mut angle = WIDEST;
    for _ in 0..TRIED {
        if face.holds(level, angle) {
            return angle;
        }
        angle *= RATIO;
    }
    0.0
}

/// What does not depend on the angle.
struct Face<'a> {
    items: &'a [Item],
    u: V6,
    nu: f64,
    rest: f64,
    delta: f64,
    /// The projection onto the span of all p − g.
    span: M6,
    /// Σ λ d dᵀ.
    gram: M6,
    /// The length of the longest `e`, and of the longest `d`.
    longest: [f64; 2],
}

impl<'a> Face<'a> {
    fn of(items: &'a mut [Item], u: &V6, nu: f64, rest: f64, delta: f64) -> Self {
        let mut gram = nalgebra::Matrix6::zeros();
        for item in items.iter() {
            let d = nalgebra::Vector6::from(item.d);
            gram += d * d.transpose() * item.weight;
        }
        let parts = gram.symmetric_eigen();
        let most = parts.eigenvalues.max();
        let mut span = nalgebra::Matrix6::zeros();
        let mut inverse = nalgebra::Matrix6::zeros();
        for (k, &value) in parts.eigenvalues.iter().enumerate() {
            if value > SPANNED * most {
                let axis = parts.eigenvectors.column(k);
                span += axis * axis.transpose();
                inverse += axis * axis.transpose() / value;
            }
        }
        let mut longest = [0.0_f64; 2];
        for item in items.iter_mut() {
            item.shifts = [
                (inverse * nalgebra::Vector6::from(item.d)).norm(),
                norm(&item.d),
            ];
            longest = std::array::from_fn(|k| longest[k].max(item.shifts[k]));
        }
        Face {
            items,
            u: *u,
            nu,
            rest,
            delta,
            span: std::array::from_fn(|i| std::array::from_fn(|j| span[(i, j)])),
            gram: std::array::from_fn(|i| std::array::from_fn(|j| gram[(i, j)])),
            longest,
        }
    }

    fn holds(&self, level: f64, angle: f64) -> bool {
        let (sin, cos) = angle.sin_cos();
        let bent = self.items.iter().map(|i| 2.0 * i.share(sin) * i.rest);
        let loss = self.delta + sin * (self.rest + bent.sum::<f64>());
        if self.nu - loss < level {
            return false;
        }
        let needed = 2.0 * (level + loss - self.nu * cos) / (sin * sin);
        [0, 1].into_iter().any(|kind| {
            let longest: f64 = self.longest[kind];
            let most = if longest > 0.0 {
                1.0 / (sin * longest)
            } else {
                0.0
            };
            let definite = |part: &f64| self.definite(kind, sin, most * part, needed);
            SHIFTS.iter().any(definite)
        })
    }

    /// Whether T − κ is positive definite on the complement of u, for one kind of shift of weights and
    /// its rate c.
    fn definite(&self, kind: usize, sin: f64, c: f64, needed: f64) -> bool {
        let u = &self.u;
        let gain = if kind == 0 { &self.span } else { &self.gram };
        let mut a = gain.map(|row| scale(&row, c));
        let (mut first, mut second) = (0.0, 0.0);
        for item in self.items {
            let share = item.share(sin);
            let keep = if item.flat {
                1.0 - c * sin * item.shifts[kind]
            } else {
                let size = share * item.norm;
                if kind == 0 {
                    first += size * item.shifts[0];
                } else {
                    second += size * size / item.weight;
                }
                1.0
            };
            for (row, with) in a.iter_mut().zip(&item.matrix) {
                *row = add_scaled(row, share * keep, with);
            }
        }
        let kappa = needed + c * sin * sin * (first * first + second) / 4.0;
        let trace: f64 = (0..6).map(|k| a[k][k]).sum();
        let slack = 1e-13 * (trace + kappa.abs());
        let lift = trace + 2.0 * kappa.abs();
        for i in 0..6 {
            a[i] = add_scaled(&a[i], lift * u[i], u);
            a[i][i] -= kappa + slack;
        }
        positive(&mut a)
    }
}

/// Whether a symmetric matrix is positive definite, by Cholesky's factorisation.
fn positive(a: &mut M6) -> bool {
    for k in 0..6 {
        // Zero, negative or not a number: the root is no positive number.
        let root = a[k][k].sqrt();
        if root.total_cmp(&0.0).is_le() || root.is_nan() {
            return false;
        }
        let row: V6 = std::array::from_fn(|j| a[k][j] / root);
        for i in k + 1..6 {
            a[i] = add_scaled(&a[i], -row[i], &row);
        }
    }
    true
}

impl Item {
    fn of(cone: &Cone, part: &Part, u: &V6, d: &V6) -> Item {
        let length = part
            .place
            .iter()
            .map(|m| m * m)
            .sum::<f64>()
            .sqrt()
            .min(1.0);
        let inverse = if length > 0.0 { 1.0 / length } else { 0.0 };
        // A m̂.
        let along = (0..3).fold([0.0; 6], |s, k| {
            add_scaled(&s, part.place[k] * inverse, &cone.axes[k])
        });
        let (free, rim) = (2.0 * (1.0 - length), length);
        let matrix: M6 = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let all: f64 = cone.axes.iter().map(|a| a[i] * a[j]).sum();
                free * all + rim * (all - along[i] * along[j])
            })
        });
        let slopes = cone.axes.map(|a| dot(&a, u));
        let start = slopes.iter().map(|s| s * s).sum::<f64>().sqrt();
        let rest = norm(&std::array::from_fn(|i| dot(&matrix[i], u)));
        Item {
            weight: part.weight,
            d: *d,
            shifts: [0.0; 2],
            start,
            slope: cone.spread(u),
            norm: (0..6).map(|i| matrix[i][i]).sum(),
            matrix,
            rest,
            flat: length < 0.999,
        }
    }

    /// λ/S.
    fn share(&self, sin: f64) -> f64 {
        let bound = self.start + sin * self.slope;
        if bound > 0.0 {
            self.weight / bound
        } else {
            0.0
        }
    }
}
