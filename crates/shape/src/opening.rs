//! Is a cloud with an opening a container, or a solid whose far side was not seen?
//!
//! If the noise is as large as the thickness of a wall, no direction shows two separate sheets, and
//! a cup looks like a solid with an unobserved part. Two properties still distinguish the two
//! cases: the distribution of the residuals, which is flatter than normal for two walls, and the
//! density of the points. The test cannot distinguish a deep container whose wall is thinner than
//! about 1.5 standard deviations of the noise from a solid that stands on an unobserved side.

use nalgebra::Vector3;
use sph::Direction;
use sph::direction::{even_directions, retract, tangent_frame};

use crate::patch::{LEAST_GAP, Patch, members};
use crate::point_cloud::RadialSamples;
use crate::sphere_partition::SpherePartition;

/// Openings of a smaller share of the sphere than this are holes of a scan.
const MIN_OPENING: f64 = 0.05;
/// A scan from all sides leaves an opening of at most this share below an object on a table, unless
/// the object is as flat as an inverted bowl. Half a hollow ball, seen from its mean, has 0.25.
const WIDE_OPENING: f64 = 0.2;

/// Directions tried as the middle of the opening.
const AXES: usize = 300;
/// At most one of this many points may lie in the opening, because rims are noisy and clouds
/// contain outliers.
const OUTLIER_DIVISOR: usize = 5000;

/// Points per cell needed to judge the distribution of the residuals, and to judge their density.
const POINTS_PER_SCATTER: usize = 64;
const POINTS_PER_DENSITY: usize = 24;
/// Geary's ratio (mean absolute deviation over standard deviation) of a normal distribution,
/// √(2/π), and the standard error of that ratio for n values, times √n.
const NORMAL_RATIO: f64 = 0.797_884_560_8;
const RATIO_DEVIATION: f64 = 0.212;
/// Least excess of Geary's ratio over its normal value (two walls 1.5 standard deviations apart),
/// and its required significance in standard errors.
const LEAST_EXCESS: f64 = 0.012;
const LEAST_CERTAINTY: f64 = 4.0;
/// Neighbours have equal residuals where the quadratic misfits, and different ones under noise or
/// with two walls. In the second case half their mean squared difference is at least this part of
/// the variance.
const UNSHARED: f64 = 0.75;
/// Least share of the points in such cells.
const LEAST_PART: f64 = 0.25;
/// View axes tried.
const VIEWS: usize = 200;
/// Least |n·a| of a surface that is seen at all.
const GRAZING: f64 = 0.05;
/// Least log-likelihood ratio per point of a uniform density against one view.
const LEAST_EVIDENCE: f64 = 0.01;

/// The widest round opening of a cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opening {
    /// Direction of its middle from the centre.
    pub axis: Direction,
    /// Share of the sphere, 0 to 1.
    pub share: f64,
    /// The evidence for a container; `None` if the cloud may be a solid that was not observed from
    /// there.
    pub container: Option<OpenContainer>,
}

/// The evidence for a container.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OpenContainer {
    /// The residuals about the surface are distributed as those of two walls.
    TwoWalls,
    /// The opening is wide, and the density of the points is that of views from all sides, none of
    /// which observed a point in the opening.
    EvenDensity,
}

/// The widest opening of at least `MIN_OPENING`, if any, and whether the cloud is a container.
///
/// About N operations where there is none, some 300 N otherwise.
pub(crate) fn opening(samples: &RadialSamples) -> Option<Opening> {
    let (axis, share) = widest_opening(&samples.directions)?;
    let container = if scatter_of_two_walls(samples) {
        Some(OpenContainer::TwoWalls)
    } else if share > WIDE_OPENING && seen_from_all_sides(samples) {
        Some(OpenContainer::EvenDensity)
    } else {
        None
    };
    Some(Opening {
        axis,
        share,
        container,
    })
}

/// Middle and share of the largest cap that contains at most one point in [`OUTLIER_DIVISOR`], if
/// it is an opening.
fn widest_opening(directions: &[Direction]) -> Option<(Direction, f64)> {
    let allowed = directions.len() / OUTLIER_DIVISOR;
    let away = |axis: &Direction, p: &Direction| 0.5 * (1.0 - axis.dot(p));
    let open = |axis: &Direction| {
        let inside = directions.iter().filter(|p| away(axis, p) < MIN_OPENING);
        inside.take(allowed + 1).count() <= allowed
    };
    let share = |axis: Direction| {
        let mut near: Vec<f64> = directions.iter().map(|p| away(&axis, p)).collect();
        let at = *near.select_nth_unstable_by(allowed, f64::total_cmp).1;
        (axis, at)
    };
    let gaps = even_directions(AXES).into_iter().filter(open).map(share);
    gaps.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Cells with enough points, with points in all neighbouring cells, away from the rim of the
/// opening.
fn inner_cells(
    samples: &RadialSamples,
    points: usize,
) -> (SpherePartition, Vec<(usize, Vec<usize>)>) {
    let cells = SpherePartition::new(samples.radii.len() / points);
    let members = members(&cells, &samples.directions);
    let reach = 1.2 * (4.0 * std::f64::consts::PI / cells.count() as f64).sqrt();
    let inside = |cell: usize| {
        let p = cells.centre(cell);
        let (e1, e2) = tangent_frame(&p);
        (0..8).all(|k| {
            let (sin, cos) = (0.25 * std::f64::consts::PI * f64::from(k)).sin_cos();
            let beside = cells.index(&retract(&p, &((e1 * cos + e2 * sin) * reach)));
            members[beside].len() >= points / 8
        })
    };
    let inner = (0..cells.count())
        .filter(|cell| members[*cell].len() >= points / 3 && inside(*cell))
        .map(|cell| (cell, members[cell].clone()))
        .collect();
    (cells, inner)
}

/// Geary's ratio of the residuals (mean absolute deviation over standard deviation), pooled over
/// the inner cells.
///
/// Two walls d apart under noise of deviation σ exceed the normal ratio by 0.006 at d = 1.2 σ, by
/// 0.027 at 2 σ and by 0.10 at 4 σ; edges, steps and outliers stay below it.
fn scatter_of_two_walls(samples: &RadialSamples) -> bool {
    let (_, inner) = inner_cells(samples, POINTS_PER_SCATTER);
    let (mut excess, mut count) = (0.0, 0.0);
    for (_, members) in inner {
        let Some(patch) = Patch::new(samples, &members) else {
            continue;
        };
        let n = members.len() as f64;
        let variance = patch.rest.iter().map(|e| e * e).sum::<f64>() / n;
        let deviation = variance.sqrt();
        // The standard deviation of two walls is half their gap.
        let told_apart = deviation >= 0.5 * LEAST_GAP * patch.radius;
        if told_apart && unshared(samples, &members, &patch.rest) >= UNSHARED * variance {
            let size = patch.rest.iter().map(|e| e.abs()).sum::<f64>() / n;
            excess += n * (size / deviation - NORMAL_RATIO * (1.0 + 0.25 / n));
            count += n;
        }
    }
    let certain = LEAST_CERTAINTY * RATIO_DEVIATION / f64::sqrt(count);
    count >= LEAST_PART * samples.radii.len() as f64 && excess / count >= certain.max(LEAST_EXCESS)
}

/// Half the mean squared difference between the residuals of nearest neighbours.
fn unshared(samples: &RadialSamples, members: &[usize], rest: &[f64]) -> f64 {
    let nearest = |a: usize| {
        let p = samples.directions[members[a]];
        let near = |b: &usize| p.dot(&samples.directions[members[*b]]);
        let others = (0..members.len()).filter(|b| *b != a);
        others.max_by(|b, c| near(b).total_cmp(&near(c)))
    };
    let differences = (0..members.len()).filter_map(|a| Some(rest[a] - rest[nearest(a)?]));
    0.5 * differences.map(|d| d * d).sum::<f64>() / members.len() as f64
}

/// Whether the density of the points is better explained by a uniform density over the surface than
/// by one view.
///
/// A distant camera in the direction a observes |n·a| points per unit of area with normal n. With
/// N_k points on area A_k, the log likelihood of a view minus that of a uniform density is Σ N_k
/// log w_k − N log(Σ A_k w_k / Σ A_k), w_k = |n_k·a|; the best of many views is taken. A flat
/// surface fits both and counts as one view.
fn seen_from_all_sides(samples: &RadialSamples) -> bool {
    let (cells, inner) = inner_cells(samples, POINTS_PER_DENSITY);
    let pieces: Vec<(f64, f64, Vector3<f64>)> = inner
        .iter()
        .filter_map(|(cell, members)| {
            let patch = Patch::new(samples, members)?;
            let slant = patch.normal.dot(&patch.middle);
            let area = cells.solid_angle(*cell) * patch.radius * patch.radius / slant;
            let seen = slant > 4.0 * GRAZING && patch.radius > 0.0;
            seen.then(|| (members.len() as f64, area, patch.normal.into_inner()))
        })
        .collect();
    let points: f64 = pieces.iter().map(|x| x.0).sum();
    let area: f64 = pieces.iter().map(|x| x.1).sum();
    let gain = |axis: &Direction| {
        let weight = |normal: &Vector3<f64>| normal.dot(axis).abs().max(GRAZING);
        let each: f64 = pieces.iter().map(|(n, _, v)| n * weight(v).ln()).sum();
        let whole: f64 = pieces.iter().map(|(_, a, v)| a * weight(v)).sum();
        each - points * (whole / area).ln()
    };
    let views = even_directions(VIEWS);
    !pieces.is_empty()
        && views
            .iter()
            .all(|axis| gain(axis) < -LEAST_EVIDENCE * points)
}
