//! Starts of a multistart search: a deterministic low-discrepancy sequence around a grasp.

use sph::Direction;
use std::f64::consts::TAU;

use crate::quality::moved;

/// The k-th of a sequence of grasps around a given one; each contact moves by at most `spread`
/// radians.
///
/// The R₂ sequence (powers of the plastic number) fills the discs evenly.
pub(crate) fn nearby(directions: &[Direction], k: usize, spread: f64) -> Vec<Direction> {
    const PLASTIC: f64 = 1.324_717_957_244_746;
    let place = |i: usize, step: f64| (0.5 + (k * directions.len() + i + 1) as f64 * step).fract();
    directions
        .iter()
        .enumerate()
        .map(|(i, p)| {
            let turn = TAU * place(i, 1.0 / PLASTIC);
            let length = spread * place(i, 1.0 / (PLASTIC * PLASTIC)).sqrt();
            moved(p, &[length * turn.cos(), length * turn.sin()])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sph::direction::{angle, even_directions};

    #[test]
    fn starts_are_near_and_differ() {
        let directions = even_directions(3);
        let all: Vec<_> = (0..50).map(|k| nearby(&directions, k, 0.4)).collect();
        for (k, start) in all.iter().enumerate() {
            for (p, q) in start.iter().zip(&directions) {
                assert!(angle(p, q) <= 0.4 + 1e-12);
            }
            for other in &all[..k] {
                assert!(start.iter().zip(other).any(|(p, q)| angle(p, q) > 1e-3));
            }
        }
    }
}
