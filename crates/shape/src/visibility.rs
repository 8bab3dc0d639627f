//! Whether a cloud is star-shaped about a centre: directions with two sheets, and directions
//! without points.

use sph::Direction;

use crate::opening::{Opening, opening};
use crate::patch::{LEAST_GAP, Patch, members};
use crate::point_cloud::RadialSamples;
use crate::sphere_partition::SpherePartition;

/// Number of cells in which two sheets are looked for; in cells this small a quadratic fits the
/// surface.
const CELLS: usize = 150;
/// Mean number of points per cell, in sparse and in dense clouds.
const POINTS_PER_CELL: (usize, usize) = (32, 96);
/// A cell with less than this share of them is ignored.
const LEAST_FILLED: f64 = 0.25;
/// Share of the variance that two sheets must explain. The two halves of a normal distribution
/// explain 0.64 of it, those of a uniform one 0.75.
const TWO_SHEETS: f64 = 0.8;
/// Each sheet has at least this share of a cell's points, so that outliers do not count as a sheet.
const LEAST_SHARE: f64 = 0.15;

/// A direction along which the surface is met at two radii.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The direction from the centre.
    pub direction: Direction,
    /// Mean radius of the inner sheet, metres.
    pub inner: f64,
    /// Mean radius of the outer sheet, metres.
    pub outer: f64,
}

/// A measure of how far a cloud is from the graph of one radius over the sphere.
#[derive(Clone, Debug, PartialEq)]
pub struct Visibility {
    /// Share of the directions that hold enough points in which two sheets are met; 0 to 1.
    pub multiple: f64,
    /// Share of the sphere in which there is no point; 0 to 1.
    pub unobserved: f64,
    /// Directions with two sheets, the widest gap relative to the radius first.
    pub crossings: Vec<Crossing>,
    /// Centres of the cells without points.
    pub unobserved_directions: Vec<Direction>,
    /// The widest opening, if there is one.
    pub opening: Option<Opening>,
}

/// Looks for two sheets and for holes, cell by cell.
///
/// The sphere has about 150 cells of equal area; in a dense cloud there is one for every 96 points.
/// In each cell a quadratic is fitted to the radii and subtracted, and the residuals are split in
/// two (Otsu). With one mode the split explains little of the variance: noise. With two modes it
/// explains most: two walls. A single steep wall has one mode, since the quadratic contains its
/// slope. Costs about 100 flops per point, and 600 if there is an opening.
pub fn measure_visibility(samples: &RadialSamples) -> Visibility {
    let count = samples.radii.len();
    let filled = (count / CELLS).clamp(POINTS_PER_CELL.0, POINTS_PER_CELL.1);
    let mut members = members(&SpherePartition::new(count / filled), &samples.directions);
    members.retain(|m| m.len() as f64 >= LEAST_FILLED * filled as f64);
    let mut crossings: Vec<Crossing> = members
        .iter()
        .filter_map(|members| crossing(samples, members))
        .collect();
    let gap = |c: &Crossing| (c.outer - c.inner) / c.outer;
    crossings.sort_by(|a, b| gap(b).total_cmp(&gap(a)));
    let views = SpherePartition::for_views(count);
    let mut seen = vec![false; views.count()];
    for p in &samples.directions {
        seen[views.index(p)] = true;
    }
    let unobserved_directions: Vec<Direction> = (0..views.count())
        .filter(|cell| !seen[*cell])
        .map(|cell| views.centre(cell))
        .collect();
    Visibility {
        multiple: crossings.len() as f64 / members.len().max(1) as f64,
        unobserved: unobserved_directions.len() as f64 / views.count() as f64,
        crossings,
        opening: opening(samples),
        unobserved_directions,
    }
}

/// The two modes of the residuals in one cell, if there are two.
fn crossing(samples: &RadialSamples, members: &[usize]) -> Option<Crossing> {
    let patch = Patch::new(samples, members)?;
    let radii = members.iter().map(|i| samples.radii[*i]);
    let mut rest: Vec<(f64, f64)> = patch.rest.iter().copied().zip(radii).collect();
    rest.sort_by(|a, b| a.0.total_cmp(&b.0));
    let split = best_split(&rest)?;
    let mean = |part: &[(f64, f64)]| part.iter().map(|x| x.1).sum::<f64>() / part.len() as f64;
    let (inner, outer) = (mean(&rest[..split]), mean(&rest[split..]));
    (outer - inner >= LEAST_GAP * outer).then_some(Crossing {
        direction: patch.middle,
        inner,
        outer,
    })
}

/// Where to cut a sorted list in two so that the halves' means explain most of the variance (Otsu
/// 1979), if they explain enough of it.
fn best_split(sorted: &[(f64, f64)]) -> Option<usize> {
    let n = sorted.len();
    let least = ((LEAST_SHARE * n as f64).ceil() as usize).max(2);
    let total: f64 = sorted.iter().map(|x| x.0).sum();
    let mean = total / n as f64;
    let scatter: f64 = sorted.iter().map(|x| (x.0 - mean).powi(2)).sum();
    let mut below = 0.0;
    let mut best = (0.0, 0);
    for (k, x) in sorted.iter().enumerate() {
        if k >= least && n - k >= least {
            let (left, right) = (below / k as f64, (total - below) / (n - k) as f64);
            let between = (k * (n - k)) as f64 / n as f64 * (right - left).powi(2);
            if between > best.0 {
                best = (between, k);
            }
        }
        below += x.0;
    }
    (best.0 >= TWO_SHEETS * scatter && scatter > 0.0).then_some(best.1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sph::direction::even_directions;

    fn wavy_noise(i: usize) -> f64 {
        // Sum of four uniform numbers: close to normal, deviation 0.58.
        (0..4)
            .map(|k| ((i * 4 + k) as f64 * 12.9898).sin() * 43758.5453)
            .map(|x| x - x.floor() - 0.5)
            .sum()
    }

    #[test]
    fn noise_has_one_sheet_and_two_walls_have_two() {
        let directions = even_directions(20_000);
        let wall = |gap: f64| RadialSamples {
            radii: (0..directions.len())
                .map(|i| 0.05 + 0.002 * wavy_noise(i) + gap * (i % 3 / 2) as f64)
                .collect(),
            directions: directions.clone(),
        };
        let one = measure_visibility(&wall(0.0));
        assert!(one.multiple <= 0.01 && one.unobserved == 0.0);
        let two = measure_visibility(&wall(0.01));
        assert!(two.multiple >= 0.95, "{}", two.multiple);
        let first = two.crossings[0];
        assert!((first.inner - 0.05).abs() <= 1e-3 && (first.outer - 0.06).abs() <= 1e-3);
    }

    #[test]
    fn the_unobserved_half_is_named() {
        let directions: Vec<Direction> = even_directions(20_000)
            .into_iter()
            .filter(|p| p.x > 0.0)
            .collect();
        let samples = RadialSamples {
            radii: vec![0.05; directions.len()],
            directions,
        };
        let half = measure_visibility(&samples);
        assert!((half.unobserved - 0.5).abs() <= 0.12 && half.multiple == 0.0);
        assert!(half.unobserved_directions.iter().all(|p| p.x < 0.1));
    }
}
