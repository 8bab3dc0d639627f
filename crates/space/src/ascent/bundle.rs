//! The step of a proximal bundle method: maximises the least of several linear functions.

use crate::quality::{LinearPieces, dot, norm};

/// Maximises min_j (excess_j + g_j·u) − |u|²/2ρ over u, subject to slack_k + a_k·u ≥ 0 for every
/// limit.
///
/// The dual minimises Σ λ_j excess_j + Σ ν_k slack_k + ρ/2 |Σ λ_j g_j + Σ ν_k a_k|² over λ in the
/// simplex and ν ≥ 0; then u = ρ (Σ λ_j g_j + Σ ν_k a_k).
///
/// Solved by an active-set method, as in Wolfe's algorithm for the nearest point. In n dimensions at
/// most n + 1 pieces and limits have positive weight. The best weights of a given set solve a linear
/// system. Each exchange lowers the dual, so the method terminates.
#[derive(Clone, Debug, Default)]
pub(super) struct Bundle {
    active: Vec<Active>,
    system: Vec<f64>,
    target: Vec<f64>,
    mixed: Vec<f64>,
    moves: Vec<f64>,
}

/// A piece or a limit with positive weight.
#[derive(Clone, Copy, Debug)]
struct Active {
    limit: bool,
    index: usize,
    weight: f64,
}

/// The functions, the limits and the step parameter ρ of one step.
#[derive(Clone, Copy)]
struct Problem<'a> {
    pieces: &'a LinearPieces,
    limits: &'a LinearPieces,
    rho: f64,
}

impl<'a> Problem<'a> {
    fn get(&self, limit: bool, index: usize) -> (f64, &'a [f64]) {
        if limit {
            self.limits.get(index)
        } else {
            self.pieces.get(index)
        }
    }
}

/// The gain that the model predicts, and its slope.
#[derive(Clone, Copy, Debug)]
pub(super) struct Promise {
    /// min_j (excess_j + g_j·u) at the move.
    pub(super) gain: f64,
    /// |Σ λ_j g_j + Σ ν_k a_k|: the slope that the active pieces and limits allow; 0 at a maximum.
    pub(super) slope: f64,
}

/// Largest number of exchanges; a dozen suffice in six dimensions.
const ROUNDS: usize = 200;
/// Relative tolerance of costs: a cost less than this share below the active ones counts as equal.
const EQUAL: f64 = 1e-9;
/// Ridge on the diagonal, relative to it. It gives a set with one weight too many a solution (far
/// away).
const RIDGE: f64 = 1e-12;

impl Bundle {
    /// Reserves memory for moves of `dimension` numbers. At most `dimension` + 1 weights are
    /// positive.
    pub(super) fn reserve(&mut self, dimension: usize) {
        let most = dimension + 8;
        self.active.reserve(most);
        self.target.reserve(most + 1);
        self.system.reserve((most + 1) * (most + 2));
        self.mixed.reserve(dimension);
        self.moves.reserve(dimension);
    }

    /// Solves for the maximiser, shortens it to `largest_move` if it is longer, and returns the
    /// predicted gain. Needs at least one piece.
    pub(super) fn solve(
        &mut self,
        pieces: &LinearPieces,
        limits: &LinearPieces,
        rho: f64,
        largest_move: f64,
    ) -> Promise {
        self.mix(&Problem {
            pieces,
            limits,
            rho,
        });
        let slope = norm(&self.mixed);
        let length = (rho * slope).min(largest_move);
        let factor = if slope > 0.0 { length / slope } else { 0.0 };
        self.moves.clear();
        self.moves.extend(self.mixed.iter().map(|g| factor * g));
        let gain = (0..pieces.len())
            .map(|j| pieces.at(j, &self.moves))
            .fold(f64::INFINITY, f64::min);
        Promise { gain, slope }
    }

    /// u of the last solution, radians, two numbers per contact.
    pub(super) fn moves(&self) -> &[f64] {
        &self.moves
    }

    /// The same numbers, for the caller to overwrite.
    pub(super) fn moves_mut(&mut self) -> &mut Vec<f64> {
        &mut self.moves
    }

    /// Σ λ_j g_j + Σ ν_k a_k at the minimum of the dual.
    fn mix(&mut self, problem: &Problem) {
        self.active.clear();
        self.active.push(Active {
            limit: false,
            index: 0,
            weight: 1.0,
        });
        self.sum_up(problem);
        for _ in 0..ROUNDS {
            let Some(entering) = self.cheapest(problem) else {
                break;
            };
            self.active.push(entering);
            self.settle(problem);
            self.sum_up(problem);
        }
    }

    fn sum_up(&mut self, problem: &Problem) {
        self.mixed.clear();
        self.mixed.resize(problem.pieces.dimension(), 0.0);
        for a in &self.active {
            let (_, slope) = problem.get(a.limit, a.index);
            for (m, x) in self.mixed.iter_mut().zip(slope) {
                *m += a.weight * x;
            }
        }
    }

    /// The inactive piece or limit whose weight lowers the dual at the highest rate, if one lowers
    /// it.
    fn cheapest(&self, problem: &Problem) -> Option<Active> {
        let cost = |limit: bool, index: usize| {
            let (constant, slope) = problem.get(limit, index);
            constant + problem.rho * dot(slope, &self.mixed)
        };
        let carried: f64 = self
            .active
            .iter()
            .filter(|a| !a.limit)
            .map(|a| a.weight * cost(false, a.index))
            .sum();
        let scale = carried.abs() + problem.rho * dot(&self.mixed, &self.mixed);
        let mut best = (-(EQUAL * scale + 1e-15), None);
        let pieces = (0..problem.pieces.len()).map(|j| (cost(false, j) - carried, false, j));
        let limits = (0..problem.limits.len()).map(|k| (cost(true, k), true, k));
        for (drop, limit, index) in pieces.chain(limits) {
            if drop < best.0 && !self.is_active(limit, index) {
                best = (drop, Some((limit, index)));
            }
        }
        best.1.map(|(limit, index)| Active {
            limit,
            index,
            weight: 0.0,
        })
    }

    fn is_active(&self, limit: bool, index: usize) -> bool {
        let same = |a: &Active| a.limit == limit && a.index == index;
        self.active.iter().any(same)
    }

    /// Moves the weights to the best ones of the active set and removes those that reach zero on
    /// the way.
    fn settle(&mut self, problem: &Problem) {
        while self.best_weights(problem) {
            let (mut step, mut out) = (1.0, None);
            for (i, (a, &goal)) in self.active.iter().zip(&self.target).enumerate() {
                if goal <= 0.0 {
                    let share = a.weight / (a.weight - goal).max(f64::MIN_POSITIVE);
                    if share <= step {
                        (step, out) = (share, Some(i));
                    }
                }
            }
            for (a, &goal) in self.active.iter_mut().zip(&self.target) {
                a.weight += step * (goal - a.weight);
            }
            match out {
                Some(i) => self.active.remove(i),
                None => return,
            };
        }
    }

    /// Solves for the weights at which active pieces have equal cost, active limits have zero cost,
    /// and the weights of the pieces sum to one. Returns false if rounding makes the system
    /// unsolvable.
    fn best_weights(&mut self, problem: &Problem) -> bool {
        let count = self.active.len();
        let width = count + 2;
        self.system.clear();
        self.system.resize((count + 1) * width, 0.0);
        let mut ridge = f64::MIN_POSITIVE;
        for (i, a) in self.active.iter().enumerate() {
            let (constant, slope) = problem.get(a.limit, a.index);
            for (j, b) in self.active.iter().enumerate() {
                let product = problem.rho * dot(slope, problem.get(b.limit, b.index).1);
                self.system[i * width + j] = product;
            }
            ridge = ridge.max(RIDGE * self.system[i * width + i]);
            let one = if a.limit { 0.0 } else { 1.0 };
            self.system[i * width + count] = -one;
            self.system[count * width + i] = one;
            self.system[i * width + count + 1] = -constant;
        }
        for i in 0..count {
            self.system[i * width + i] += ridge;
        }
        self.system[count * width + count + 1] = 1.0;
        solve_in_place(&mut self.system, count + 1, &mut self.target)
    }
}

/// Gaussian elimination with partial pivoting of `size` rows of `size` + 1 numbers. Returns false
/// for a singular or overflowing system.
fn solve_in_place(rows: &mut [f64], size: usize, out: &mut Vec<f64>) -> bool {
    let width = size + 1;
    for k in 0..size {
        let lower = |r: &usize, s: &usize| {
            let at = |r: &usize| rows[r * width + k].abs();
            at(r).total_cmp(&at(s))
        };
        let pivot = (k..size).max_by(lower).unwrap_or(k);
        if rows[pivot * width + k] == 0.0 {
            return false;
        }
        if pivot != k {
            for c in k..width {
                rows.swap(k * width + c, pivot * width + c);
            }
        }
        let (above, below) = rows.split_at_mut((k + 1) * width);
        let top = &above[k * width..];
        for row in below.chunks_exact_mut(width) {
            let factor = row[k] / top[k];
            for c in k..width {
                row[c] -= factor * top[c];
            }
        }
    }
    out.clear();
    out.resize(size, 0.0);
    for k in (0..size).rev() {
        let known: f64 = (k + 1..size).map(|c| rows[k * width + c] * out[c]).sum();
        out[k] = (rows[k * width + size] - known) / rows[k * width + k];
    }
    out.iter().all(|x| x.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pieces(list: &[(f64, [f64; 2])]) -> LinearPieces {
        let mut pieces = LinearPieces::default();
        pieces.reset(1);
        for (excess, slope) in list {
            pieces.push(*excess).copy_from_slice(slope);
        }
        pieces
    }

    fn solve(
        list: &[(f64, [f64; 2])],
        limits: &[(f64, [f64; 2])],
        rho: f64,
        largest_move: f64,
    ) -> (Promise, Vec<f64>) {
        let mut bundle = Bundle::default();
        let promise = bundle.solve(&pieces(list), &pieces(limits), rho, largest_move);
        (promise, bundle.moves().to_vec())
    }

    #[test]
    fn one_piece_moves_along_its_gradient() {
        let one = [(0.0, [3.0, 4.0])];
        let (best, moves) = solve(&one, &[], 0.1, 10.0);
        assert!((moves[0] - 0.3).abs() < 1e-15 && (moves[1] - 0.4).abs() < 1e-15);
        assert!((best.gain - 2.5).abs() < 1e-14 && (best.slope - 5.0).abs() < 1e-14);
        let (_, short) = solve(&one, &[], 0.1, 0.05);
        assert!((norm(&short) - 0.05).abs() < 1e-15);
    }

    #[test]
    fn two_tied_pieces_rise_together() {
        let tied = [(0.0, [1.0, 2.0]), (0.0, [1.0, -2.0])];
        let (best, moves) = solve(&tied, &[], 1.0, 10.0);
        assert!((moves[0] - 1.0).abs() < 1e-12 && moves[1].abs() < 1e-12);
        assert!((best.gain - 1.0).abs() < 1e-12);
    }

    #[test]
    fn opposite_pieces_are_stationary() {
        let opposite = [(0.0, [1.0, 0.0]), (0.0, [-2.0, 0.0])];
        let (best, _) = solve(&opposite, &[], 1.0, 10.0);
        assert!(best.slope < 1e-12 && best.gain.abs() < 1e-12);
    }

    #[test]
    fn many_pieces_and_limits_are_solved_to_rounding() {
        // Active pieces and limits have equal cost; the others cost more.
        for seed in 0..200 {
            let number = |i: usize, k: usize| ((seed * 97 + i * 13 + k * 7 + i * k) as f64).sin();
            let mut pieces = LinearPieces::default();
            let mut limits = LinearPieces::default();
            pieces.reset(3);
            limits.reset(3);
            for i in 0..40 {
                let excess = if i == 0 {
                    0.0
                } else {
                    0.05 * number(i, 9).abs()
                };
                let slope: Vec<f64> = (0..6).map(|k| number(i, k)).collect();
                pieces.push(excess).copy_from_slice(&slope);
                // Duplicate pieces.
                if i % 5 == 0 {
                    pieces.push(excess).copy_from_slice(&slope);
                }
            }
            for i in 0..6 {
                let slope: Vec<f64> = (0..6).map(|k| number(i + 60, k)).collect();
                limits
                    .push(0.01 * number(i, 3).abs())
                    .copy_from_slice(&slope);
            }
            let rho = 10.0_f64.powi(seed as i32 % 7 - 4);
            let mut bundle = Bundle::default();
            let best = bundle.solve(&pieces, &limits, rho, f64::INFINITY);
            let u = bundle.moves().to_vec();
            for k in 0..limits.len() {
                assert!(limits.at(k, &u) >= -1e-8, "seed {seed}");
            }
            // Strong duality: the dual's value equals that of the move.
            let weighted: f64 = bundle
                .active
                .iter()
                .map(|a| {
                    a.weight
                        * if a.limit {
                            limits.get(a.index).0
                        } else {
                            pieces.get(a.index).0
                        }
                })
                .sum();
            let dual = weighted + 0.5 * rho * best.slope * best.slope;
            let primal = best.gain - dot(&u, &u) / (2.0 * rho);
            assert!(
                (dual - primal).abs() <= 1e-7 * dual.abs().max(1e-3),
                "seed {seed}: {dual} {primal}"
            );
        }
    }

    #[test]
    fn limits_stop_the_move() {
        let (best, moves) = solve(&[(0.0, [1.0, 1.0])], &[(0.2, [-1.0, 0.0])], 1.0, 10.0);
        assert!((moves[0] - 0.2).abs() < 1e-6 && (moves[1] - 1.0).abs() < 1e-6);
        assert!((best.gain - 1.2).abs() < 1e-6);
        let (held, _) = solve(&[(0.0, [1.0, 0.0])], &[(0.0, [-1.0, 0.0])], 1.0, 10.0);
        assert!(held.slope < 1e-6);
    }

    #[test]
    fn the_move_is_the_best_of_many() {
        let four = [
            (0.0, [1.0, 0.3]),
            (0.05, [-0.4, 1.2]),
            (0.1, [0.2, -1.5]),
            (0.3, [-2.0, 0.1]),
        ];
        let (rho, model) = (0.4, pieces(&four));
        let value = |u: &[f64]| {
            let least = (0..4).map(|j| model.at(j, u)).fold(f64::INFINITY, f64::min);
            least - dot(u, u) / (2.0 * rho)
        };
        let (_, best) = solve(&four, &[], rho, 10.0);
        for i in -50..=50 {
            for j in -50..=50 {
                let u = [0.01 * f64::from(i), 0.01 * f64::from(j)];
                assert!(value(&u) <= value(&best) + 1e-4);
            }
        }
    }
}
