//! The plane on which an object stands, if the cloud shows it.

use nalgebra::{Matrix3, Point3, SymmetricEigen, UnitVector3, Vector3};

use rayon::prelude::*;

use super::Support;
use super::footprint::{Evidence, Footprint};
use crate::voxel_grid::{VoxelGrid, median, subset};

/// Points on which planes are looked for.
const SAMPLE: usize = 3000;
/// Points from which planes are grown.
const SEEDS: usize = 120;
/// Radius of the first patch of a plane, in spacings of the sample.
const SEED_RADIUS: f64 = 3.0;
/// The patch grows by this factor; the third time it has no limit.
const GROWTH: f64 = 3.0;
/// Standard deviations of its points within which a point belongs to a plane, while it grows and in
/// the end.
const BELONGS: (f64, f64) = (3.0, 4.0);
/// Least of that distance, in spacings.
const LEAST_TOLERANCE: f64 = 0.3;
/// Largest of that distance while a plane grows, in spacings of the sample.
const MOST_TOLERANCE: f64 = 2.0;
/// The standard deviation along the plane is at least this many times that across it, which
/// excludes curved sheets.
const FLAT: f64 = 20.0;
/// Share of the points that a support holds at least, and share that stands on it.
const LEAST_SHARE: f64 = 0.04;
const LEAST_ABOVE: f64 = 0.05;
/// Points on the far side of a support, as a share of those that stand on it.
const MOST_BELOW: f64 = 0.03;
/// Cosine of the largest angle between the normal of a support and the upward direction; a plane at a
/// larger angle needs stronger evidence.
const UPWARD: f64 = 0.64;
/// Points away from the object to which its support is fitted again.
const LEAST_OPEN: usize = 30;
/// Different planes tried.
const TRIED: usize = 6;
/// Planes whose normals have a larger cosine are one.
const SAME_NORMAL: f64 = 0.996;
/// Median absolute deviation to standard deviation.
const NORMAL: f64 = 1.4826;

/// A support and the points that are left of the object.
pub(super) struct Found {
    pub(super) plane: Support,
    pub(super) object: Vec<usize>,
}

struct Candidate {
    plane: Support,
    tolerance: f64,
    inliers: usize,
}

/// The support that some points of a cloud of spacing `step` show.
pub(super) fn visible_support(
    places: &[Point3<f64>],
    members: &[usize],
    step: f64,
    up: &UnitVector3<f64>,
) -> Option<Found> {
    let points: Vec<Point3<f64>> = members.iter().map(|i| places[*i]).collect();
    let sample: Vec<Point3<f64>> = subset(&points, SAMPLE).iter().map(|i| points[*i]).collect();
    let coarse = step * (points.len() as f64 / sample.len() as f64).sqrt();
    let grid = VoxelGrid::new(&sample, SEED_RADIUS * coarse);
    let seeds = sample.iter().take(SEEDS);
    let grown = |seed| grow(seed, &sample, &grid, coarse, step);
    let seeds: Vec<&Point3<f64>> = seeds.collect();
    let mut candidates: Vec<Candidate> = seeds
        .into_par_iter()
        .filter_map(|seed| one_sided(grown(seed)?, &sample))
        .collect();
    candidates.sort_by_key(|c| std::cmp::Reverse(c.inliers));
    let mut tried: Vec<Candidate> = Vec::new();
    for candidate in candidates {
        if tried.iter().any(|other| same(other, &candidate)) {
            continue;
        }
        let evidence = if candidate.plane.normal.dot(up) >= UPWARD {
            Evidence::Beyond
        } else {
            Evidence::BeyondAllRound
        };
        if let Some(found) = separated(&points, &candidate, step, evidence) {
            return Some(Found {
                object: found.object.into_iter().map(|i| members[i]).collect(),
                ..found
            });
        }
        tried.push(candidate);
        if tried.len() == TRIED {
            break;
        }
    }
    None
}

/// The object above a candidate, after the plane has been fitted again to its points away from the
/// object, because points of the foot would raise it.
fn separated(
    points: &[Point3<f64>],
    candidate: &Candidate,
    step: f64,
    evidence: Evidence,
) -> Option<Found> {
    let first = Footprint::new(points, &candidate.plane, candidate.tolerance, step)?;
    let object = first.object(points, evidence)?;
    let open: Vec<Point3<f64>> = first.open().map(|i| points[i]).collect();
    if open.len() < LEAST_OPEN {
        return Some(Found {
            plane: candidate.plane,
            object,
        });
    }
    let (mut plane, _, _) = fitted(&open)?;
    if plane.normal.dot(&candidate.plane.normal) < 0.0 {
        plane = plane.flipped();
    }
    let sizes = open.iter().map(|p| plane.height(p).abs()).collect();
    let tolerance = tolerance(NORMAL * median(sizes), step);
    let object = Footprint::new(points, &plane, tolerance, step)?.object(points, evidence)?;
    Some(Found { plane, object })
}

/// The points on a given plane that are not the object's, if it shows any.
pub(super) fn given_support(
    places: &[Point3<f64>],
    members: &[usize],
    step: f64,
    plane: &Support,
) -> Option<Found> {
    let points: Vec<Point3<f64>> = members.iter().map(|i| places[*i]).collect();
    let sizes = points.iter().map(|p| plane.height(p).abs());
    let near = sizes.filter(|h| *h <= 3.0 * step).collect();
    let tolerance = tolerance(NORMAL * median(near), step);
    let footprint = Footprint::new(&points, plane, tolerance, step)?;
    let object = footprint.object(&points, Evidence::Beyond)?;
    Some(Found {
        plane: *plane,
        object: object.into_iter().map(|i| members[i]).collect(),
    })
}

fn tolerance(deviation: f64, step: f64) -> f64 {
    (BELONGS.1 * deviation).max(LEAST_TOLERANCE * step)
}

/// A plane through a patch of the sample, fitted again to its points in ever wider surroundings.
fn grow(
    seed: &Point3<f64>,
    sample: &[Point3<f64>],
    grid: &VoxelGrid<'_>,
    coarse: f64,
    step: f64,
) -> Option<Candidate> {
    let mut reach = SEED_RADIUS * coarse;
    let patch: Vec<Point3<f64>> = grid.within(seed, reach).map(|(i, _)| sample[i]).collect();
    let (mut plane, mut deviation, mut spread) = fitted(&patch)?;
    for round in 0..4 {
        reach = if round < 2 {
            reach * GROWTH
        } else {
            f64::INFINITY
        };
        let limit = (BELONGS.0 * deviation).clamp(LEAST_TOLERANCE * step, MOST_TOLERANCE * coarse);
        let inside = |p: &&Point3<f64>| {
            plane.height(p).abs() <= limit && (*p - seed).norm_squared() <= reach * reach
        };
        let patch: Vec<Point3<f64>> = sample.iter().filter(inside).copied().collect();
        (plane, _, spread) = fitted(&patch)?;
        deviation = NORMAL * median(patch.iter().map(|p| plane.height(p).abs()).collect());
    }
    if spread < FLAT * deviation {
        return None;
    }
    let tolerance = tolerance(deviation, step);
    let inliers = sample.iter().filter(|p| plane.height(p).abs() <= tolerance);
    Some(Candidate {
        inliers: inliers.count(),
        plane,
        tolerance,
    })
}

/// The plane of least squares, and the standard deviations of the points across it and along it, in the
/// direction in which they spread less.
fn fitted(points: &[Point3<f64>]) -> Option<(Support, f64, f64)> {
    if points.len() < 6 {
        return None;
    }
    let first = points[0];
    let sum: Vector3<f64> = points.iter().map(|p| p - first).sum();
    let mean = first + sum / points.len() as f64;
    let mut spread = Matrix3::zeros();
    for p in points {
        spread += (p - mean) * (p - mean).transpose();
    }
    let eigen = SymmetricEigen::new(spread / points.len() as f64);
    let least = eigen.eigenvalues.imin();
    let normal = UnitVector3::try_new(eigen.eigenvectors.column(least).into_owned(), 1e-12)?;
    let plane = Support {
        normal,
        offset_m: normal.dot(&mean.coords),
    };
    let mut values: Vec<f64> = eigen
        .eigenvalues
        .iter()
        .map(|x| x.max(0.0).sqrt())
        .collect();
    values.sort_by(f64::total_cmp);
    Some((plane, values[0], values[1]))
}

/// The candidate with its normal towards the rest, if it holds enough and the rest is on one side.
fn one_sided(mut candidate: Candidate, sample: &[Point3<f64>]) -> Option<Candidate> {
    let heights = || sample.iter().map(|p| candidate.plane.height(p));
    let mut above = heights().filter(|h| *h > candidate.tolerance).count();
    let mut below = heights().filter(|h| *h < -candidate.tolerance).count();
    if below > above {
        candidate.plane = candidate.plane.flipped();
        (above, below) = (below, above);
    }
    let share = |count: usize| count as f64 / sample.len() as f64;
    let enough = share(candidate.inliers) >= LEAST_SHARE && share(above) >= LEAST_ABOVE;
    (enough && below as f64 <= MOST_BELOW * above as f64).then_some(candidate)
}

fn same(a: &Candidate, b: &Candidate) -> bool {
    let near = (a.plane.offset_m - b.plane.offset_m).abs() <= 2.0 * a.tolerance.max(b.tolerance);
    a.plane.normal.dot(&b.plane.normal) >= SAME_NORMAL && near
}
