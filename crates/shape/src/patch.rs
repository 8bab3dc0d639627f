//! A small piece of a cloud and its residuals about a fitted quadratic.

use nalgebra::{SMatrix, SVector, UnitVector3, Vector3};
use sph::Direction;
use sph::direction::tangent_frame;

use crate::point_cloud::RadialSamples;
use crate::sphere_partition::SpherePartition;

/// Two sheets of points closer than this share of the radius count as one.
pub(crate) const LEAST_GAP: f64 = 0.01;

/// The least-squares quadratic r(u, v) over the tangent plane for some samples, and its residuals.
pub(crate) struct Patch {
    /// Mean direction of the samples.
    pub(crate) middle: Direction,
    /// Radius of the quadratic there, metres.
    pub(crate) radius: f64,
    /// Outward normal of the quadratic's surface there.
    pub(crate) normal: UnitVector3<f64>,
    /// Radius − quadratic, sample by sample, metres.
    pub(crate) rest: Vec<f64>,
}

impl Patch {
    /// The patch of the samples with the given indices; `None` where they determine no quadratic.
    pub(crate) fn new(samples: &RadialSamples, members: &[usize]) -> Option<Self> {
        let sum: Vector3<f64> = members.iter().map(|i| *samples.directions[*i]).sum();
        let middle = Direction::new_normalize(sum);
        let (e1, e2) = tangent_frame(&middle);
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
        // A small ridge term keeps the system regular for points on one line.
        gram += SMatrix::identity() * (1e-9 * gram.trace());
        let trend = gram.cholesky()?.solve(&right);
        let rest = |i: &usize| samples.radii[*i] - row(*i).dot(&trend);
        let outward = middle.into_inner() * trend[0] - e1 * trend[1] - e2 * trend[2];
        Some(Self {
            middle,
            radius: trend[0],
            normal: UnitVector3::new_normalize(outward),
            rest: members.iter().map(rest).collect(),
        })
    }
}

/// Indices of the samples in every cell.
pub(crate) fn members(cells: &SpherePartition, directions: &[Direction]) -> Vec<Vec<usize>> {
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); cells.count()];
    for (i, p) in directions.iter().enumerate() {
        members[cells.index(p)].push(i);
    }
    members
}
