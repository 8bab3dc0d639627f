//! Is a cloud star-shaped from a centre? Where it is seen twice, and where not at all.

use nalgebra::{SMatrix, SVector, Vector3};
use sph::Direction;
use sph::direction::{retract, tangent_frame};

use crate::point_cloud::RadialSamples;

/// Points a cell should hold, on the sphere's average, to look for two sheets in it.
const POINTS_PER_CELL: usize = 96;
/// Points a cell must hold before anything is said about it.
const LEAST_POINTS: usize = 24;
/// Points a coarser cell should hold, on average; an empty one is then no accident.
const POINTS_PER_VIEW: usize = 160;
/// Share of the scatter that two sheets must explain. Two halves of a normal distribution explain
/// 0.64 of it, of a uniform one 0.75.
const TWO_SHEETS: f64 = 0.8;
/// Each sheet holds at least this share of a cell's points: stray points make no sheet.
const LEAST_SHARE: f64 = 0.15;
/// Sheets closer than this part of the radius count as one.
const LEAST_GAP: f64 = 0.01;

/// A direction along which the surface is met at two radii.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The direction, seen from the centre.
    pub direction: Direction,
    /// Mean radius of the inner sheet, metres.
    pub inner: f64,
    /// Mean radius of the outer sheet, metres.
    pub outer: f64,
}

/// How far a cloud is from the graph of one radius over the sphere.
#[derive(Clone, Debug, PartialEq)]
pub struct StarShape {
    /// Share of the directions that hold enough points in which two sheets are met; 0 to 1.
    pub multiple: f64,
    /// Share of the sphere in which there is no point; 0 to 1.
    pub unseen: f64,
    /// Where two sheets are met, widest gap relative to the radius first.
    pub crossings: Vec<Crossing>,
    /// Centres of the cells without points.
    pub unseen_directions: Vec<Direction>,
}

/// Looks for two sheets and for holes, cell by cell.
///
/// In each of N/96 cells of equal area the radii are freed from slope and curvature (a quadratic
/// over the cell) and split in two where the split explains most of what is left. Noise has one
/// heap and is explained badly, two walls have two heaps; a steep wall is no crossing, since the
/// quadratic takes its slope. Costs about 100 flops a point.
pub fn star_shape(samples: &RadialSamples) -> StarShape {
    let count = samples.radii.len();
    let cells = Cells::new(count / POINTS_PER_CELL);
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); cells.count()];
    for (i, p) in samples.directions.iter().enumerate() {
        members[cells.index(p)].push(i);
    }
    members.retain(|m| m.len() >= LEAST_POINTS);
    let mut crossings: Vec<Crossing> = members
        .iter()
        .filter_map(|members| crossing(samples, members))
        .collect();
    let gap = |c: &Crossing| (c.outer - c.inner) / c.outer;
    crossings.sort_by(|a, b| gap(b).total_cmp(&gap(a)));
    let views = Cells::for_views(count);
    let mut seen = vec![false; views.count()];
    for p in &samples.directions {
        seen[views.index(p)] = true;
    }
    let unseen_directions: Vec<Direction> = (0..views.count())
        .filter(|cell| !seen[*cell])
        .map(|cell| views.centre(cell))
        .collect();
    StarShape {
        multiple: crossings.len() as f64 / members.len().max(1) as f64,
        unseen: unseen_directions.len() as f64 / views.count() as f64,
        crossings,
        unseen_directions,
    }
}

/// Two heaps among the radii of one cell, if there are.
fn crossing(samples: &RadialSamples, members: &[usize]) -> Option<Crossing> {
    let sum: Vector3<f64> = members.iter().map(|i| *samples.directions[*i]).sum();
    let middle = Direction::new_normalize(sum);
    let mut rest = without_trend(samples, members, &middle)?;
    rest.sort_by(|a, b| a.0.total_cmp(&b.0));
    let split = best_split(&rest)?;
    let mean = |part: &[(f64, f64)]| part.iter().map(|x| x.1).sum::<f64>() / part.len() as f64;
    let (inner, outer) = (mean(&rest[..split]), mean(&rest[split..]));
    (outer - inner >= LEAST_GAP * outer).then_some(Crossing {
        direction: middle,
        inner,
        outer,
    })
}

/// (radius − quadratic over the cell, radius) of each member.
fn without_trend(
    samples: &RadialSamples,
    members: &[usize],
    middle: &Direction,
) -> Option<Vec<(f64, f64)>> {
    let (e1, e2) = tangent_frame(middle);
    let row = |i: usize| {
        let p = &samples.directions[i];
        let (u, v) = (p.dot(&e1), p.dot(&e2));
        SVector::<f64, 6>::new(1.0, u, v, u * u, u * v, v * v)
    };
    let mut gram = SMatrix::<f64, 6, 6>::zeros();
    let mut right = SVector::<f64, 6>::zeros();
    for &i in members {
        let row = row(i);
        gram += row * row.transpose();
        right += row * samples.radii[i];
    }
    // A whiff of ridge keeps points on one line solvable.
    gram += SMatrix::identity() * (1e-9 * gram.trace());
    let trend = gram.cholesky()?.solve(&right);
    let rest = |&i: &usize| (samples.radii[i] - row(i).dot(&trend), samples.radii[i]);
    Some(members.iter().map(rest).collect())
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

/// Cells of nearly equal area: bands of latitude, each cut into sectors.
pub(crate) struct Cells {
    /// Index of each band's first cell, and at the end the number of cells.
    starts: Vec<usize>,
}

impl Cells {
    /// About `count` cells, at least 8.
    pub(crate) fn new(count: usize) -> Self {
        let bands = ((count.max(8) as f64 * std::f64::consts::PI).sqrt() / 2.0).round() as usize;
        let height = std::f64::consts::PI / bands as f64;
        let mut starts = vec![0];
        for band in 0..bands {
            let sine = ((band as f64 + 0.5) * height).sin();
            let sectors = (std::f64::consts::TAU * sine / height).round().max(1.0) as usize;
            starts.push(starts[band] + sectors);
        }
        Self { starts }
    }

    /// Cells coarse enough for an empty one to mean that nothing was seen there.
    pub(crate) fn for_views(points: usize) -> Self {
        Self::new(points / POINTS_PER_VIEW)
    }

    /// The cells that share an edge with a cell, from points just outside its four sides.
    pub(crate) fn neighbours(&self, cell: usize) -> Vec<usize> {
        let step = std::f64::consts::PI / self.bands() as f64;
        let p = self.centre(cell);
        let (north, east) = compass(&p);
        let mut around: Vec<usize> = [north, -north, east, -east]
            .iter()
            .map(|v| self.index(&retract(&p, &(v * step))))
            .filter(|k| *k != cell)
            .collect();
        around.dedup();
        around
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        self.starts[self.bands()]
    }

    fn bands(&self) -> usize {
        self.starts.len() - 1
    }

    /// The cell of a direction.
    pub(crate) fn index(&self, p: &Direction) -> usize {
        let part = |x: f64, n: usize| ((x * n as f64).max(0.0) as usize).min(n - 1);
        let theta = p.x.hypot(p.y).atan2(p.z);
        let band = part(theta / std::f64::consts::PI, self.bands());
        let turn = p.y.atan2(p.x) / std::f64::consts::TAU + 0.5;
        self.starts[band] + part(turn, self.starts[band + 1] - self.starts[band])
    }

    /// A direction in the middle of a cell.
    pub(crate) fn centre(&self, cell: usize) -> Direction {
        let band = self.starts.partition_point(|start| *start <= cell) - 1;
        let sectors = self.starts[band + 1] - self.starts[band];
        let theta = std::f64::consts::PI * (band as f64 + 0.5) / self.bands() as f64;
        let turn = ((cell - self.starts[band]) as f64 + 0.5) / sectors as f64 - 0.5;
        let phi = std::f64::consts::TAU * turn;
        sph::SphericalCoords { theta, phi }.direction()
    }
}

/// Unit tangents towards larger z and along increasing azimuth; any two at the poles.
fn compass(p: &Direction) -> (Vector3<f64>, Vector3<f64>) {
    let up = Vector3::z() - p.into_inner() * p.z;
    match up.try_normalize(1e-9) {
        Some(north) => (north, north.cross(p)),
        None => tangent_frame(p),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sph::direction::even_directions;

    #[test]
    fn every_cell_holds_its_centre_and_its_share() {
        for count in [8, 30, 500] {
            let cells = Cells::new(count);
            let mut hits = vec![0_usize; cells.count()];
            for p in even_directions(100 * cells.count()) {
                hits[cells.index(&p)] += 1;
            }
            assert!(hits.iter().all(|h| (30..300).contains(h)), "{hits:?}");
            for cell in 0..cells.count() {
                assert_eq!(cells.index(&cells.centre(cell)), cell);
            }
        }
    }

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
        let one = star_shape(&wall(0.0));
        assert!(one.multiple <= 0.01 && one.unseen == 0.0);
        let two = star_shape(&wall(0.01));
        assert!(two.multiple >= 0.95, "{}", two.multiple);
        let first = two.crossings[0];
        assert!((first.inner - 0.05).abs() <= 1e-3 && (first.outer - 0.06).abs() <= 1e-3);
    }

    #[test]
    fn the_unseen_half_is_named() {
        let directions: Vec<Direction> = even_directions(20_000)
            .into_iter()
            .filter(|p| p.x > 0.0)
            .collect();
        let samples = RadialSamples {
            radii: vec![0.05; directions.len()],
            directions,
        };
        let half = star_shape(&samples);
        assert!((half.unseen - 0.5).abs() <= 0.12 && half.multiple == 0.0);
        assert!(half.unseen_directions.iter().all(|p| p.x < 0.1));
    }
}
