//! Fits that samples which contradict their neighbours do not spoil.

use super::{Fitted, RegressionError, Samples, Settings};
use crate::direction::Direction;
use crate::index;
use crate::scattered::Scattered;

/// How samples lose weight: full weight up to `full` deviations from their neighbours, none from
/// `none` deviations on, falling linearly in between (a redescending loss).
///
/// The fit is repeated only when what changes weight carries a hundredth of the squared residuals.
/// A deviation is 1.4826 times the median absolute difference of the residuals in the sample's
/// cell from the cell's median, at least that of all samples. Since it is judged within a cell, an
/// edge or a part that degree L cannot follow, where whole neighbourhoods lie off the fit, keeps its
/// weight; so does a part smaller than a cell (the tip of a handle, a spout), where two of a sample's six
/// neighbours lie off the fit as it does. A stray point does not. Fewer samples than coefficients leave
/// no residuals to judge by, and all keep their weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Robust {
    /// Deviations up to which a sample counts in full.
    pub full: f64,
    /// Deviations from which on it does not count.
    pub none: f64,
    /// Most repetitions of the fit.
    pub rounds: usize,
}

impl Default for Robust {
    /// 5 and 8 deviations: samples with normal noise keep all their weight, and cost no second fit.
    fn default() -> Self {
        Self {
            full: 5.0,
            none: 8.0,
            rounds: 3,
        }
    }
}

/// Least members of a cell.
const CELL: usize = 32;
/// Neighbours that are asked, and how many of them must lie off alike to make a part of the surface.
/// One sample in five astray leaves about one in twenty of those such company by chance.
const ASKED: usize = 6;
const COMPANY: usize = 2;
/// Off alike: to the same side, by at least this part.
const ALIKE: f64 = 0.5;
/// Share of the sum of squared residuals whose weight may change without another fit.
const SETTLED: f64 = 0.01;

/// Reweighted least squares; each round chooses the penalty anew when it is automatic.
pub(super) fn fit(
    samples: Samples,
    settings: &Settings,
    robust: &Robust,
) -> Result<Fitted, RegressionError> {
    let plain = Settings {
        robust: None,
        ..*settings
    };
    let mut fitted = super::fit(samples, &plain)?;
    if samples.values.len() < index::count(settings.degree) {
        return Ok(fitted);
    }
    let cells = cells(samples.directions);
    let points = Scattered::new(samples.directions);
    let given = |i: usize| settings.weights.map_or(1.0, |w| w[i]);
    let mut factors = vec![1.0; samples.values.len()];
    for round in 1..=robust.rounds {
        let heights = points.evaluate(&fitted.coefficients);
        let residuals: Vec<f64> = samples
            .values
            .iter()
            .zip(&heights)
            .map(|(f, h)| f - h)
            .collect();
        let next = weigh(samples.directions, &residuals, &cells, robust);
        let squares = |weight: &dyn Fn(usize) -> f64| -> f64 {
            (0..).zip(&residuals).map(|(i, r)| weight(i) * r * r).sum()
        };
        let changed = squares(&|i| given(i) * (next[i] - factors[i]).abs());
        if changed <= SETTLED * squares(&|i| given(i) * next[i]) {
            break;
        }
        factors = next;
        let weights: Vec<f64> = factors
            .iter()
            .enumerate()
            .map(|(i, f)| f * given(i))
            .collect();
        let reweighted = Settings {
            weights: Some(&weights),
            ..plain
        };
        fitted = super::fit(samples, &reweighted)?;
        fitted.rounds = round;
    }
    Ok(fitted)
}

/// The weight of every sample, from the residuals in its cell.
fn weigh(
    directions: &[Direction],
    residuals: &[f64],
    cells: &[Vec<u32>],
    robust: &Robust,
) -> Vec<f64> {
    let all: Vec<f64> = residuals.to_vec();
    let (_, least_deviation) = centre_and_deviation(all);
    let mut weights = vec![1.0; residuals.len()];
    for cell in cells {
        let members = cell.iter().map(|&i| residuals[i as usize]).collect();
        let (centre, deviation) = centre_and_deviation(members);
        let deviation = deviation.max(least_deviation);
        for &i in cell {
            let off = residuals[i as usize] - centre;
            // Exact data have deviation zero; nothing contradicts them but a finite difference.
            if off.abs() <= robust.full * deviation {
                continue;
            }
            let alike =
                |j: u32| (residuals[j as usize] - centre) * off.signum() >= ALIKE * off.abs();
            if company(directions, cell, i, alike) < COMPANY {
                let beyond = (robust.none * deviation - off.abs())
                    / ((robust.none - robust.full) * deviation);
                weights[i as usize] = if beyond.is_finite() {
                    beyond.max(0.0)
                } else {
                    0.0
                };
            }
        }
    }
    weights
}

/// How many of a member's nearest neighbours in its cell are alike.
fn company(
    directions: &[Direction],
    cell: &[u32],
    member: u32,
    alike: impl Fn(u32) -> bool,
) -> usize {
    let p = directions[member as usize];
    let near = |j: &u32| p.dot(&directions[*j as usize]);
    let mut others: Vec<u32> = cell.iter().copied().filter(|j| *j != member).collect();
    if others.len() > ASKED {
        others.select_nth_unstable_by(ASKED, |a, b| near(b).total_cmp(&near(a)));
        others.truncate(ASKED);
    }
    others.into_iter().filter(|j| alike(*j)).count()
}

/// Median, and 1.4826 times the median absolute difference from it.
fn centre_and_deviation(mut values: Vec<f64>) -> (f64, f64) {
    let middle = values.len() / 2;
    let centre = *values.select_nth_unstable_by(middle, f64::total_cmp).1;
    for v in &mut values {
        *v = (*v - centre).abs();
    }
    (
        centre,
        1.4826 * *values.select_nth_unstable_by(middle, f64::total_cmp).1,
    )
}

/// Groups of neighbouring directions, all of at least [`CELL`] members if there are so many.
///
/// Directions are halved along the longest side of their box until a half would be too small.
fn cells(directions: &[Direction]) -> Vec<Vec<u32>> {
    let mut done = Vec::new();
    let mut open = vec![(0..directions.len() as u32).collect::<Vec<u32>>()];
    while let Some(mut group) = open.pop() {
        if group.len() < 2 * CELL {
            done.push(group);
            continue;
        }
        let axis = longest_side(directions, &group);
        let middle = group.len() / 2;
        group.select_nth_unstable_by(middle, |&a, &b| {
            directions[a as usize][axis].total_cmp(&directions[b as usize][axis])
        });
        open.push(group.split_off(middle));
        open.push(group);
    }
    done
}

fn longest_side(directions: &[Direction], group: &[u32]) -> usize {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for &i in group {
        for axis in 0..3 {
            let x = directions[i as usize][axis];
            low[axis] = low[axis].min(x);
            high[axis] = high[axis].max(x);
        }
    }
    let side = |axis: usize| high[axis] - low[axis];
    (0..3).fold(
        0,
        |best, axis| if side(axis) > side(best) { axis } else { best },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::direction::{SphericalCoords, even_directions};

    #[test]
    fn cells_hold_every_direction_once() {
        let directions = even_directions(1000);
        let cells = cells(&directions);
        let mut seen = vec![0; 1000];
        for cell in &cells {
            assert!(cell.len() >= CELL && cell.len() < 2 * CELL);
            for &i in cell {
                seen[i as usize] += 1;
            }
        }
        assert!(seen.iter().all(|&n| n == 1));
    }

    #[test]
    fn only_what_contradicts_its_neighbours_loses_weight() {
        let directions = even_directions(2000);
        let cells = cells(&directions);
        let mut residuals: Vec<f64> = (0..2000)
            .map(|i| {
                1e-3 * (i as f64 * 12.9898).sin() + if directions[i].z > 0.5 { 0.1 } else { 0.0 }
            })
            .collect();
        residuals[100] = 0.5;
        let weights = weigh(&directions, &residuals, &cells, &Robust::default());
        assert_eq!(weights[100], 0.0);
        let lost = weights.iter().filter(|&&w| w < 1.0).count();
        assert!(lost < 200, "{lost}");
    }

    #[test]
    fn a_part_smaller_than_a_cell_keeps_its_weight_and_scattered_samples_lose_theirs() {
        let directions = even_directions(4000);
        let cells = cells(&directions);
        let tip = SphericalCoords {
            theta: 1.1,
            phi: 2.3,
        }
        .direction();
        let height = |p: &Direction| {
            let angle = p.dot(&tip).min(1.0).acos();
            0.02 * (1.0 - (angle / 0.09).powi(2)).max(0.0)
        };
        for share in [0.0, 0.05, 0.2] {
            let mut stray = vec![false; directions.len()];
            let residuals: Vec<f64> = (0..directions.len())
                .map(|i| {
                    let random = |k: f64| ((i as f64 + k) * 12.9898).sin() * 43_758.545_3;
                    let unit = |k: f64| random(k).rem_euclid(1.0);
                    stray[i] = unit(0.3) < share;
                    let noise = 2e-4 * (unit(0.1) + unit(0.7) - 1.0);
                    let astray = if stray[i] {
                        0.08 * (unit(0.5) - 0.5)
                    } else {
                        0.0
                    };
                    height(&directions[i]) + noise + astray
                })
                .collect();
            let weights = weigh(&directions, &residuals, &cells, &Robust::default());
            let kept = |wanted: &dyn Fn(usize) -> bool| -> f64 {
                let all: Vec<usize> = (0..weights.len()).filter(|i| wanted(*i)).collect();
                all.iter().map(|i| weights[*i]).sum::<f64>() / all.len() as f64
            };
            let tip = kept(&|i| !stray[i] && height(&directions[i]) > 0.0);
            assert!(tip >= 0.9, "{share}: {tip}");
            let rest = kept(&|i| !stray[i] && height(&directions[i]) == 0.0);
            assert!(rest >= 0.99, "{share}: {rest}");
            if share > 0.0 {
                let stray = kept(&|i| stray[i]);
                assert!(stray <= 0.12, "{share}: {stray}");
            }
        }
    }
}
