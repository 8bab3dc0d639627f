//! The step of a proximal bundle method: raise the least of several linear functions.

/// excess + gradient·u: one facet's offset above the least one, and how a move changes it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LinearPiece {
    pub(super) excess: f64,
    pub(super) gradient: Vec<f64>,
}

impl LinearPiece {
    /// Length of the gradient.
    pub(super) fn slope(&self) -> f64 {
        norm(&self.gradient)
    }

    fn at(&self, moves: &[f64]) -> f64 {
        self.excess + dot(&self.gradient, moves)
    }
}

/// max over u of min_j (excess_j + g_j·u) − |u|²/2ρ.
///
/// Its dual is min over the simplex of Σ λ_j excess_j + ρ/2 |Σ λ_j g_j|², and u = ρ Σ λ_j g_j.
pub(super) struct BundleModel<'a> {
    pieces: &'a [LinearPiece],
    rho: f64,
}

/// The best move of a model.
pub(super) struct BundleMove {
    /// u, radians, two numbers a contact.
    pub(super) moves: Vec<f64>,
    /// min_j (excess_j + g_j·u): what the model promises.
    pub(super) gain: f64,
    /// |Σ λ_j g_j|: the slope that all deciding pieces allow; 0 at a maximum.
    pub(super) slope: f64,
}

/// Pair exchanges of the dual; each is exact, a few dozen suffice in six dimensions.
const EXCHANGES: usize = 400;

impl<'a> BundleModel<'a> {
    /// A model with one piece or more.
    pub(super) fn new(pieces: &'a [LinearPiece], rho: f64) -> Self {
        Self { pieces, rho }
    }

    /// The maximiser, shortened to `reach` if it is longer.
    pub(super) fn best_move(&self, reach: f64) -> BundleMove {
        let mixed = self.mixed_gradient();
        let slope = norm(&mixed);
        let length = (self.rho * slope).min(reach);
        let factor = if slope > 0.0 { length / slope } else { 0.0 };
        let moves: Vec<f64> = mixed.iter().map(|g| factor * g).collect();
        let gain = self
            .pieces
            .iter()
            .map(|piece| piece.at(&moves))
            .fold(f64::INFINITY, f64::min);
        BundleMove { moves, gain, slope }
    }

    /// Σ λ_j g_j at the minimum of the dual, by exchanging weight between the best and the worst
    /// piece until they agree.
    fn mixed_gradient(&self) -> Vec<f64> {
        let mut weights = vec![0.0; self.pieces.len()];
        weights[0] = 1.0;
        let mut mixed = self.pieces[0].gradient.clone();
        for _ in 0..EXCHANGES {
            let cost = |piece: &LinearPiece| piece.excess + self.rho * dot(&piece.gradient, &mixed);
            let costs: Vec<f64> = self.pieces.iter().map(cost).collect();
            let (mut to, mut from) = (0, None);
            for (j, c) in costs.iter().enumerate() {
                if *c < costs[to] {
                    to = j;
                }
                if weights[j] > 0.0 && from.is_none_or(|k: usize| *c > costs[k]) {
                    from = Some(j);
                }
            }
            let Some(from) = from else { break };
            let drop = costs[from] - costs[to];
            if !(drop > 1e-12) {
                break;
            }
            let apart: Vec<f64> = self.pieces[to]
                .gradient
                .iter()
                .zip(&self.pieces[from].gradient)
                .map(|(a, b)| a - b)
                .collect();
            let curvature = self.rho * dot(&apart, &apart);
            let exact = if curvature > 0.0 {
                drop / curvature
            } else {
                f64::INFINITY
            };
            let shift = exact.min(weights[from]);
            weights[to] += shift;
            weights[from] -= shift;
            for (m, a) in mixed.iter_mut().zip(&apart) {
                *m += shift * a;
            }
        }
        mixed
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piece(excess: f64, gradient: [f64; 2]) -> LinearPiece {
        LinearPiece {
            excess,
            gradient: gradient.to_vec(),
        }
    }

    #[test]
    fn one_piece_moves_along_its_gradient() {
        let pieces = [piece(0.0, [3.0, 4.0])];
        let best = BundleModel::new(&pieces, 0.1).best_move(10.0);
        assert!((best.moves[0] - 0.3).abs() < 1e-15 && (best.moves[1] - 0.4).abs() < 1e-15);
        assert!((best.gain - 2.5).abs() < 1e-14 && (best.slope - 5.0).abs() < 1e-14);
        let short = BundleModel::new(&pieces, 0.1).best_move(0.05);
        assert!((norm(&short.moves) - 0.05).abs() < 1e-15);
    }

    #[test]
    fn two_tied_pieces_rise_together() {
        let pieces = [piece(0.0, [1.0, 2.0]), piece(0.0, [1.0, -2.0])];
        let best = BundleModel::new(&pieces, 1.0).best_move(10.0);
        assert!((best.moves[0] - 1.0).abs() < 1e-12 && best.moves[1].abs() < 1e-12);
        assert!((best.gain - 1.0).abs() < 1e-12);
    }

    #[test]
    fn opposite_pieces_are_stationary() {
        let pieces = [piece(0.0, [1.0, 0.0]), piece(0.0, [-2.0, 0.0])];
        let best = BundleModel::new(&pieces, 1.0).best_move(10.0);
        assert!(best.slope < 1e-12 && best.gain.abs() < 1e-12);
    }

    #[test]
    fn the_move_is_the_best_of_many() {
        let pieces = [
            piece(0.0, [1.0, 0.3]),
            piece(0.05, [-0.4, 1.2]),
            piece(0.1, [0.2, -1.5]),
            piece(0.3, [-2.0, 0.1]),
        ];
        let rho = 0.4;
        let value = |u: &[f64]| {
            let least = pieces.iter().map(|p| p.at(u)).fold(f64::INFINITY, f64::min);
            least - dot(u, u) / (2.0 * rho)
        };
        let best = BundleModel::new(&pieces, rho).best_move(10.0);
        for i in -50..=50 {
            for j in -50..=50 {
                let u = [0.01 * f64::from(i), 0.01 * f64::from(j)];
                assert!(value(&u) <= value(&best.moves) + 1e-9);
            }
        }
    }
}
