//! The point of a convex hull nearest to the origin (Wolfe 1976), from a support function alone.

use super::plane::{V6, add_scaled, dot, norm, scale};
use super::support::Support;

/// What the search found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Nearest {
    /// The origin lies outside (or, within rounding, on the boundary): the nearest point, and how
    /// far a hyperplane orthogonal to it keeps the hull from the origin.
    Outside { point: V6, floor: f64 },
    /// The origin lies in the hull of the corral, up to rounding.
    Inside,
}

/// How far to go when the origin lies outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Effort {
    /// Stop at the first hyperplane that separates the origin.
    Separate,
    /// Go on to the nearest point.
    Converge,
}

const MOST: usize = 7;
const ROUNDS: usize = 500;

/// At most seven affinely independent points with convex weights.
#[derive(Clone, Debug, Default)]
pub(crate) struct Corral {
    pub(crate) points: [V6; MOST],
    pub(crate) tags: [u32; MOST],
    pub(crate) weights: [f64; MOST],
    pub(crate) len: usize,
    gram: [[f64; MOST]; MOST],
}

impl Corral {
    /// A corral of one point.
    pub(crate) fn single(point: &V6, tag: u32) -> Self {
        let mut corral = Corral::default();
        corral.add(point, tag);
        corral
    }

    /// Runs Wolfe's algorithm from the support point against `start`.
    ///
    /// `tolerance` is the length below which the nearest point counts as the origin.
    pub(crate) fn nearest(
        &mut self,
        source: &mut impl Support,
        start: &V6,
        effort: Effort,
        tolerance: f64,
    ) -> Nearest {
        self.len = 0;
        let (first, tag) = source.support(&scale(start, -1.0));
        let floor = dot(start, &first) / norm(start);
        if effort == Effort::Separate && floor > tolerance {
            let point = scale(start, floor / norm(start));
            return Nearest::Outside { point, floor };
        }
        self.add(&first, tag);
        self.weights[0] = 1.0;
        let mut x = first;
        for _ in 0..ROUNDS {
            let length = norm(&x);
            if length <= tolerance {
                return Nearest::Inside;
            }
            let (p, tag) = source.support(&scale(&x, -1.0));
            let floor = dot(&x, &p) / length;
            let separated = effort == Effort::Separate && floor > tolerance;
            let nearest = separated || length - floor <= 1e-14 * length || self.has(&p);
            if nearest || self.len == MOST || !self.add(&p, tag) || !self.descend() {
                return Nearest::Outside { point: x, floor };
            }
            let next = self.combination();
            // Progress that rounding eats is no progress.
            if norm(&next) >= length {
                return Nearest::Outside { point: x, floor };
            }
            x = next;
        }
        Nearest::Outside {
            point: x,
            floor: 0.0,
        }
    }

    fn has(&self, p: &V6) -> bool {
        self.points[..self.len].contains(p)
    }

    /// The point that the weights make.
    pub(crate) fn combination(&self) -> V6 {
        let pairs = self.points[..self.len].iter().zip(&self.weights);
        pairs.fold([0.0; 6], |x, (p, &w)| add_scaled(&x, w, p))
    }

    fn add(&mut self, p: &V6, tag: u32) -> bool {
        let n = self.len;
        self.points[n] = *p;
        self.tags[n] = tag;
        self.weights[n] = 0.0;
        self.len = n + 1;
        for i in 0..=n {
            let g = dot(&self.points[i], p);
            self.gram[i][n] = g;
            self.gram[n][i] = g;
        }
        self.len <= MOST
    }

    fn remove(&mut self, at: usize) {
        self.len -= 1;
        let n = self.len;
        self.points.copy_within(at + 1..n + 1, at);
        self.tags.copy_within(at + 1..n + 1, at);
        self.weights.copy_within(at + 1..n + 1, at);
        self.gram.copy_within(at + 1..n + 1, at);
        for row in &mut self.gram[..n] {
            row.copy_within(at + 1..n + 1, at);
        }
    }

    /// Moves to the point of the corral's hull nearest to the origin, dropping points on the way.
    fn descend(&mut self) -> bool {
        while self.len > 0 {
            let Some(target) = self.affine_minimiser() else {
                return false;
            };
            let n = self.len;
            let (mut step, mut out) = (1.0, None);
            for (i, (&goal, &weight)) in target.iter().zip(&self.weights).take(n).enumerate() {
                if goal <= 1e-12 {
                    // At most 1; a weight that is zero already leaves at once.
                    let share = if weight > goal {
                        weight / (weight - goal)
                    } else {
                        0.0
                    };
                    if share <= step {
                        (step, out) = (share, Some(i));
                    }
                }
            }
            for (weight, &goal) in self.weights.iter_mut().zip(&target).take(n) {
                *weight += step * (goal - *weight);
            }
            match out {
                None => return true,
                Some(i) => self.remove(i),
            }
        }
        false
    }

    /// Weights, of sum one, of the point of the affine hull nearest to the origin: the solution of
    /// (PᵀP + s eeᵀ) v = e, normalised, with s the mean squared length.
    fn affine_minimiser(&self) -> Option<[f64; MOST]> {
        let n = self.len;
        let mut l = self.gram;
        let s = (0..n).map(|i| l[i][i]).sum::<f64>() / n as f64;
        for row in &mut l[..n] {
            row[..n].iter_mut().for_each(|x| *x += s);
        }
        let mut v = [1.0; MOST];
        for j in 0..n {
            let (above, below) = l.split_at_mut(j + 1);
            let row = &mut above[j];
            let pivot = row[j] - row[..j].iter().map(|x| x * x).sum::<f64>();
            if pivot <= 1e-15 * s {
                return None;
            }
            row[j] = pivot.sqrt();
            for lower in &mut below[..n - j - 1] {
                let known: f64 = row[..j].iter().zip(&*lower).map(|(a, b)| a * b).sum();
                lower[j] = (lower[j] - known) / row[j];
            }
            let known: f64 = row[..j].iter().zip(&v).map(|(a, b)| a * b).sum();
            v[j] = (v[j] - known) / row[j];
        }
        for j in (0..n).rev() {
            for k in j + 1..n {
                v[j] -= l[k][j] * v[k];
            }
            v[j] /= l[j][j];
        }
        let sum: f64 = v[..n].iter().sum();
        v[..n].iter_mut().for_each(|x| *x /= sum);
        Some(v)
    }
}

#[cfg(test)]
mod tests {
    use super::super::support::PointList;
    use super::*;

    fn run(points: &[V6]) -> (Nearest, Corral) {
        let mut corral = Corral::default();
        let found = corral.nearest(&mut PointList(points), &points[0], Effort::Converge, 1e-12);
        (found, corral)
    }

    #[test]
    fn finds_the_distance_of_a_triangle() {
        let a = [1.0, 3.0, 0.0, 0.0, 0.0, 0.0];
        let b = [1.0, -1.0, 2.0, 0.0, 0.0, 0.0];
        let c = [1.0, -1.0, -2.0, 0.0, 0.0, 0.0];
        let (Nearest::Outside { point, floor }, _) = run(&[a, b, c]) else {
            panic!("the origin lies outside");
        };
        assert!((norm(&point) - 1.0).abs() <= 1e-14);
        assert!((floor - 1.0).abs() <= 1e-13);
    }

    #[test]
    fn finds_the_origin_inside_a_simplex() {
        let mut points = vec![[-0.3; 6]];
        for k in 0..6 {
            let mut p = [0.0; 6];
            p[k] = 1.0;
            points.push(p);
        }
        let (found, corral) = run(&points);
        assert_eq!(found, Nearest::Inside);
        assert_eq!(corral.len, 7);
        assert!(norm(&corral.combination()) <= 1e-12);
    }
}
