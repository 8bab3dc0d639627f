//! Small statistics of lists of numbers.

use serde::Serialize;

/// Number, mean and spread of a list.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Number of values.
    pub count: usize,
    /// Mean.
    pub mean: f64,
    /// Median.
    pub median: f64,
    /// Least value.
    pub least: f64,
    /// Greatest value.
    pub greatest: f64,
}

/// A summary; `None` for an empty list.
pub fn summary(values: &[f64]) -> Option<Summary> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (least, greatest) = (*sorted.first()?, *sorted.last()?);
    let upper = sorted[sorted.len() / 2];
    let lower = sorted[(sorted.len() - 1) / 2];
    Some(Summary {
        count: sorted.len(),
        mean: mean(values)?,
        median: 0.5 * (lower + upper),
        least,
        greatest,
    })
}

/// The mean; `None` for an empty list.
pub fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// √(mean of squares); 0 for an empty list.
pub fn root_mean_square(values: impl IntoIterator<Item = f64>) -> f64 {
    let (squares, count) = values
        .into_iter()
        .fold((0.0, 0_usize), |(sum, n), v| (sum + v * v, n + 1));
    (squares / count.max(1) as f64).sqrt()
}

/// The share part / whole; `None` when the whole is 0.
pub fn share(part: usize, whole: usize) -> Option<f64> {
    (whole > 0).then(|| part as f64 / whole as f64)
}

/// Spearman's rank correlation, with mean ranks for ties; `None` if a list is constant or empty.
///
/// ```
/// use experiments::statistics::rank_correlation;
///
/// assert_eq!(rank_correlation(&[1.0, 2.0, 9.0], &[0.1, 0.3, 0.4]), Some(1.0));
/// ```
pub fn rank_correlation(a: &[f64], b: &[f64]) -> Option<f64> {
    let (a, b) = (ranks(a), ranks(b));
    let (mean_a, mean_b) = (mean(&a)?, mean(&b)?);
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (x, y) in a.iter().zip(&b) {
        ab += (x - mean_a) * (y - mean_b);
        aa += (x - mean_a) * (x - mean_a);
        bb += (y - mean_b) * (y - mean_b);
    }
    (aa > 0.0 && bb > 0.0).then(|| ab / (aa * bb).sqrt())
}

fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&i, &j| values[i].total_cmp(&values[j]));
    let mut ranks = vec![0.0; values.len()];
    let mut start = 0;
    while start < order.len() {
        let tied = order[start..]
            .iter()
            .take_while(|&&i| values[i] == values[order[start]])
            .count();
        for &i in &order[start..start + tied] {
            ranks[i] = start as f64 + 0.5 * (tied as f64 - 1.0);
        }
        start += tied;
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn summaries_of_even_and_odd_lists() {
        let even = summary(&[4.0, 1.0, 3.0, 2.0]).unwrap();
        assert_eq!((even.median, even.mean), (2.5, 2.5));
        assert_eq!((even.least, even.greatest, even.count), (1.0, 4.0, 4));
        assert_eq!(summary(&[3.0, 1.0, 9.0]).unwrap().median, 3.0);
        assert_eq!(summary(&[]), None);
        assert_eq!(root_mean_square([3.0, 4.0, 5.0, 0.0]), 12.5_f64.sqrt());
        assert_eq!((share(1, 4), share(0, 0)), (Some(0.25), None));
    }

    #[test]
    fn rank_correlation_sees_order_alone() {
        let a = [1.0, 2.0, 3.0, 10.0];
        let same = rank_correlation(&a, &[0.1, 0.2, 0.9, 1.0]).unwrap();
        let turned = rank_correlation(&a, &[4.0, 3.0, 2.0, 1.0]).unwrap();
        assert!((same - 1.0).abs() <= 1e-15 && (turned + 1.0).abs() <= 1e-15);
        assert_eq!(rank_correlation(&a, &[1.0; 4]), None);
        // Computed by hand: ranks (0,1,2,3) and (0.5,0.5,2,3) have correlation √0.9.
        let tied = rank_correlation(&a, &[1.0, 1.0, 2.0, 3.0]).unwrap();
        assert!((tied - 0.9_f64.sqrt()).abs() <= 1e-15);
    }
}
