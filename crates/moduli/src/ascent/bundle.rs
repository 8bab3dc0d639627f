//! The step of a proximal bundle method: raise the least of several linear functions.

use crate::quality::{LinearPieces, dot, norm};

/// max over u of min_j (excess_j + g_j·u) − |u|²/2ρ, with slack_k + a_k·u ≥ 0 for every limit.
///
/// Its dual is min over λ in the simplex and ν ≥ 0 of
/// Σ λ_j excess_j + Σ ν_k slack_k + ρ/2 |Σ λ_j g_j + Σ ν_k a_k|², and u = ρ (Σ λ_j g_j + Σ ν_k a_k).
#[derive(Clone, Debug, Default)]
pub(super) struct Bundle {
    weights: Vec<f64>,
    forces: Vec<f64>,
    costs: Vec<f64>,
    mixed: Vec<f64>,
    moves: Vec<f64>,
}

/// What the best move promises.
#[derive(Clone, Copy, Debug)]
pub(super) struct Promise {
    /// min_j (excess_j + g_j·u) at the move.
    pub(super) gain: f64,
    /// |Σ λ_j g_j + Σ ν_k a_k|: the slope that all deciding pieces and limits allow; 0 at a maximum.
    pub(super) slope: f64,
}

/// Rounds of the dual; each exchange is exact, a few dozen suffice in six dimensions.
const ROUNDS: usize = 400;
/// The dual is solved when its gap is this share of its value.
const GAP: f64 = 1e-4;

impl Bundle {
    /// The maximiser, shortened to `reach` if it is longer. One piece or more.
    pub(super) fn solve(
        &mut self,
        pieces: &LinearPieces,
        limits: &LinearPieces,
        rho: f64,
        reach: f64,
    ) -> Promise {
        self.mix(pieces, limits, rho);
        let slope = norm(&self.mixed);
        let length = (rho * slope).min(reach);
        let factor = if slope > 0.0 { length / slope } else { 0.0 };
        self.moves.clear();
        self.moves.extend(self.mixed.iter().map(|g| factor * g));
        let gain = (0..pieces.len())
            .map(|j| pieces.at(j, &self.moves))
            .fold(f64::INFINITY, f64::min);
        Promise { gain, slope }
    }

    /// u of the last solution, radians, two numbers a contact.
    pub(super) fn moves(&self) -> &[f64] {
        &self.moves
    }

    /// Σ λ_j g_j + Σ ν_k a_k at the minimum of the dual, by exchanging weight between the best and
    /// the worst piece and by one limit at a time, until they agree.
    fn mix(&mut self, pieces: &LinearPieces, limits: &LinearPieces, rho: f64) {
        self.weights.clear();
        self.weights.resize(pieces.len(), 0.0);
        self.weights[0] = 1.0;
        self.forces.clear();
        self.forces.resize(limits.len(), 0.0);
        self.mixed.clear();
        self.mixed.extend_from_slice(pieces.get(0).1);
        for _ in 0..ROUNDS {
            let pushed = self.push_back(limits, rho);
            let exchanged = self.exchange(pieces, rho);
            if !(pushed || exchanged) {
                break;
            }
        }
    }

    /// Sets every ν_k to its best value; whether any changed.
    fn push_back(&mut self, limits: &LinearPieces, rho: f64) -> bool {
        let mut changed = false;
        for k in 0..limits.len() {
            let (slack, slope) = limits.get(k);
            let curvature = rho * dot(slope, slope);
            if curvature <= 0.0 {
                continue;
            }
            let excess = slack + rho * dot(slope, &self.mixed);
            let force = (self.forces[k] - excess / curvature).max(0.0);
            let shift = force - self.forces[k];
            if shift * shift * curvature <= 1e-14 {
                continue;
            }
            changed = true;
            self.forces[k] = force;
            for (m, a) in self.mixed.iter_mut().zip(slope) {
                *m += shift * a;
            }
        }
        changed
    }

    /// Moves weight from the costliest piece that has any to the cheapest; whether that helped.
    fn exchange(&mut self, pieces: &LinearPieces, rho: f64) -> bool {
        self.costs.clear();
        for j in 0..pieces.len() {
            let (excess, slope) = pieces.get(j);
            self.costs.push(excess + rho * dot(slope, &self.mixed));
        }
        let (mut to, mut from, mut mean) = (0, None, 0.0);
        for (j, c) in self.costs.iter().enumerate() {
            mean += self.weights[j] * c;
            if *c < self.costs[to] {
                to = j;
            }
            if self.weights[j] > 0.0 && from.is_none_or(|k: usize| *c > self.costs[k]) {
                from = Some(j);
            }
        }
        let Some(from) = from else { return false };
        let drop = self.costs[from] - self.costs[to];
        let gap = mean - self.costs[to];
        if drop.is_nan() || drop <= 1e-12 || gap <= GAP * mean.abs().min(self.costs[to].abs()) {
            return false;
        }
        let (a, b) = (pieces.get(to).1, pieces.get(from).1);
        let apart: f64 = a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum();
        let curvature = rho * apart;
        let exact = if curvature > 0.0 {
            drop / curvature
        } else {
            f64::INFINITY
        };
        let shift = exact.min(self.weights[from]);
        self.weights[to] += shift;
        self.weights[from] -= shift;
        for (m, (x, y)) in self.mixed.iter_mut().zip(a.iter().zip(b)) {
            *m += shift * (x - y);
        }
        true
    }
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
        reach: f64,
    ) -> (Promise, Vec<f64>) {
        let mut bundle = Bundle::default();
        let promise = bundle.solve(&pieces(list), &pieces(limits), rho, reach);
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
