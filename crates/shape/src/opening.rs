//! Is a cloud with an opening a container, or a solid whose far side was not seen?
//!
//! Where noise is as large as a wall is thick, no direction shows two sheets any more, and a cup looks
//! like a solid with a part missing. Two things still tell them apart: the shape of the scatter, which
//! two walls make flatter than a normal distribution, and how the points are spread. What nothing tells
//! apart is a deep container, its wall thinner than some 1.5 deviations of the noise, and a solid that
//! stands on an unobserved side.

use nalgebra::Vector3;
use sph::Direction;
use sph::direction::{even_directions, retract, tangent_frame};

use crate::patch::{LEAST_GAP, Patch, members};
use crate::point_cloud::RadialSamples;
use crate::sphere_partition::SpherePartition;

/// Openings of a smaller share of the sphere than this are holes of a scan.
const MIN_OPENING: f64 = 0.05;
/// An opening of a larger share than this is wider than what a scan from all sides leaves below an
/// object on a table, unless that is as flat as a bowl upside down; half a hollow ball, seen from its
/// mean, has 0.25.
const WIDE_OPENING: f64 = 0.2;

/// Directions tried as the middle of the opening.
const AXES: usize = 300;
/// One point in so many may lie in the opening: rims are noisy, and points are mislaid.
const OUTLIER_DIVISOR: usize = 5000;

/// Points a cell should hold for the shape of their scatter, and for their density.
const POINTS_PER_SCATTER: usize = 64;
const POINTS_PER_DENSITY: usize = 24;
/// Mean distance from the mean over standard deviation of a normal distribution, √(2/π), and the
/// deviation of that ratio for n values, times √n.
const NORMAL_RATIO: f64 = 0.797_884_560_8;
const RATIO_DEVIATION: f64 = 0.212;
/// The ratio of two walls exceeds the normal one by this much if they are 1.5 deviations of the noise
/// apart, and it must be known to so many of its deviations.
const LEAST_EXCESS: f64 = 0.012;
const LEAST_CERTAINTY: f64 = 4.0;
/// Neighbours share what a quadratic cannot follow, and differ by noise or walls: half their mean
/// squared difference is at least this part of the scatter where it is one of the latter.
const UNSHARED: f64 = 0.75;
/// Share of the points that must scatter so.
const LEAST_PART: f64 = 0.25;
/// View axes tried.
const VIEWS: usize = 200;
/// Least |n·a| of a surface that is seen at all.
const GRAZING: f64 = 0.05;
/// log likelihood a point by which an even spread must explain the points better than one view.
const LEAST_EVIDENCE: f64 = 0.01;

/// The widest round opening of a cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opening {
    /// Its middle, seen from the centre.
    pub axis: Direction,
    /// Share of the sphere, 0 to 1.
    pub share: f64,
    /// What makes the cloud a container; `None` if it may be a solid that was not seen from there.
    pub container: Option<OpenContainer>,
}

/// Why an opening is taken for that of a container.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OpenContainer {
    /// The scatter about the surface is that of two walls.
    TwoWalls,
    /// The opening is wide, and the points are spread over the surface as no single view spreads
    /// them: whoever saw the surface from all sides saw nothing in the opening.
    EvenDensity,
}

/// The widest opening of at least `MIN_OPENING`, if any, and whether it is that of a container.
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

/// Middle and share of the largest cap that holds at most one point in [`OUTLIER_DIVISOR`], if it is an opening.
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

/// Cells with enough points whose surroundings hold points too, away from the rim of the opening.
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

/// Geary's ratio of the scatter (mean size over standard deviation), pooled over the inner cells.
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
        // Two walls scatter by half the gap.
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

/// Half the mean squared difference between each member's rest and its nearest neighbour's.
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

/// Whether the density of the points is better explained as even over the surface than as one view's.
///
/// From far away along a, a camera finds |n·a| points on a unit of area with normal n. With N_k points
/// on area A_k, log likelihood of a view less that of an even spread is
/// Σ N_k log w_k − N log(Σ A_k w_k / Σ A_k), w_k = |n_k·a|; the best of many views is taken. A surface
/// of one slope could be either, and counts as a view.
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
