//! The min-weight quality: how evenly the wrenches can balance each other.

use super::epsilon::QualityError;
use crate::grasp_model::GraspModel;
use crate::linear::{Outcome, Programme};
use crate::wrench::Wrench;
use crate::wrenches::wrenches;

/// n·ℓ* with ℓ* the largest ℓ such that Σ α_i w_i = 0, Σ α_i = 1 and all α_i ≥ ℓ (FRoGGeR's metric).
///
/// 1 where equal weights balance, positive exactly for balanced grasps, negative for open ones; None
/// where no weights of any sign balance. Polygonal cones only. Independent of the torque length.
pub fn min_weight(model: &GraspModel<'_>) -> Result<Option<f64>, QualityError> {
    Ok(min_weight_of(&wrenches(model)?))
}

/// The same for a plain list of wrenches.
pub(crate) fn min_weight_of(wrenches: &[Wrench]) -> Option<f64> {
    // α_i = s_i + ℓ⁺ − ℓ⁻ with all three ≥ 0; wrenches scaled to a common size.
    let n = wrenches.len();
    let reach = wrenches.iter().map(|w| w.norm()).fold(0.0, f64::max);
    let mut rows: Vec<Vec<f64>> = (0..6)
        .map(|k| wrenches.iter().map(|w| w[k] / reach).collect())
        .collect();
    rows.push(vec![1.0; n]);
    for row in &mut rows {
        let total: f64 = row.iter().sum();
        row.extend([total, -total]);
    }
    let mut right = vec![0.0; 7];
    right[6] = 1.0;
    let mut cost = vec![0.0; n];
    cost.extend([-1.0, 1.0]);
    match (Programme { rows, right, cost }).solve() {
        Outcome::Optimal { value, .. } => Some(-value * n as f64),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_wrenches_weigh_one_and_one_sided_ones_are_negative() {
        let mut cross: Vec<Wrench> = (0..6)
            .flat_map(|k| {
                let e = Wrench::from_fn(|i, _| if i == k { 1.0 } else { 0.0 });
                [e, -e]
            })
            .collect();
        assert!((min_weight_of(&cross).unwrap() - 1.0).abs() <= 1e-12);
        cross.iter_mut().for_each(|w| w[0] += 1.5);
        assert!(min_weight_of(&cross).unwrap() < -1e-3);
        assert_eq!(min_weight_of(&[cross[0]]), None);
    }
}
