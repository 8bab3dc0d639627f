//! Points and anchors on the sphere, and the coordinates that fit them.

use std::sync::Arc;

use nalgebra::{Point3, UnitVector3, Vector3};
use rayon::prelude::*;
use sph::batch::values_and_gradients;
use sph::direction::{even_directions, retract};
use sph::regression::{Gram, Penalty, RegressionError, Samples};
use sph::{Coefficients, Direction, Field};
use sphere_map::{SphereMap, Tree, Wrap};

use crate::fit::PENALTY_POWER;

/// Anchors per coefficient, and the share of the weight that all anchors have together.
const ANCHORS: usize = 4;
const ANCHOR_WEIGHT: f64 = 0.15;
/// A point farther than this many spacings from the wrap is not part of the surface.
const FARTHEST: f64 = 4.0;
/// Steps of Gauss and Newton towards the nearest point, and the longest step in radians.
const STEPS: usize = 4;
const LONGEST: f64 = 0.1;

/// What the coordinates are fitted to.
#[derive(Clone)]
pub(crate) struct Rows {
    /// Directions of the points, then of the anchors.
    pub(crate) directions: Vec<Direction>,
    /// Where they should go, in the centred frame.
    targets: Vec<Vector3<f64>>,
    /// How many are points.
    pub(crate) points: usize,
    /// Which points of the cloud they are.
    pub(crate) indices: Arc<[usize]>,
}

impl Rows {
    /// The points of a cloud at the images of the nearest points of the wrap, and anchors that keep the
    /// surface near the wrap where it has no points.
    pub(crate) fn new(
        points: &[Point3<f64>],
        wrap: &Wrap,
        map: &SphereMap,
        centre: &Point3<f64>,
        degree: usize,
    ) -> Self {
        let tree = Tree::new(&map.mesh);
        let limit = FARTHEST * wrap.spacing;
        let placed: Vec<Option<Direction>> = points
            .par_iter()
            .zip(&wrap.normals)
            .map(|(p, n)| {
                let facing = tree.closest_facing(p, n).filter(|at| at.distance <= limit);
                let found = facing.or_else(|| tree.closest(p).filter(|at| at.distance <= limit));
                found.map(|at| map.image(&at))
            })
            .collect();
        let kept = placed.iter().enumerate();
        let kept = kept.filter_map(|(i, at)| at.map(|at| (i, at)));
        let (indices, mut directions): (Vec<usize>, Vec<Direction>) = kept.unzip();
        let mut targets: Vec<Vector3<f64>> = indices.iter().map(|i| points[*i] - centre).collect();
        let count = directions.len();
        let anchors = even_directions(ANCHORS * (degree + 1) * (degree + 1));
        let places: Vec<Vector3<f64>> = anchors
            .par_iter()
            .map(|p| map.preimage(p) - centre)
            .collect();
        directions.extend(anchors);
        targets.extend(places);
        Self {
            directions,
            targets,
            points: count,
            indices: indices.into(),
        }
    }

    /// The rows along a surface: the points at the given directions, the anchors at the points of the
    /// wrap that are nearest to the surface and face along it.
    pub(crate) fn along(
        &self,
        coordinates: &[Coefficients; 3],
        directions: Vec<Direction>,
        tree: &Tree,
        centre: &Point3<f64>,
        limit: f64,
    ) -> Self {
        let anchors = &self.directions[self.points..];
        let jets = coordinates
            .each_ref()
            .map(|c| values_and_gradients(c, anchors));
        let mut targets = self.targets.clone();
        targets[self.points..]
            .par_iter_mut()
            .enumerate()
            .for_each(|(i, target)| {
                let jets = jets.each_ref().map(|j| &j[i]);
                let at = Vector3::from(jets.map(|j| j.value));
                let (u, v) = sph::direction::tangent_frame(&anchors[i]);
                let along = |w: &Vector3<f64>| Vector3::from(jets.map(|j| j.gradient.dot(w)));
                let normal = along(&u).cross(&along(&v));
                let found = tree.closest_facing(&(centre + at), &normal);
                if let Some(found) = found.filter(|found| found.distance <= limit) {
                    *target = tree.place(&found) - centre;
                }
            });
        let mut all = directions;
        all.extend_from_slice(anchors);
        Self {
            directions: all,
            targets,
            points: self.points,
            indices: Arc::clone(&self.indices),
        }
    }

    pub(crate) fn places(&self) -> &[Vector3<f64>] {
        &self.targets[..self.points]
    }
}

/// The normal equations of x, y and z: one matrix, three right-hand sides.
pub(crate) struct Equations {
    gram: Gram,
    rights: [Vec<f64>; 3],
}

impl Equations {
    pub(crate) fn new(rows: &Rows, degree: usize) -> Result<Self, RegressionError> {
        let (points, anchors) = (rows.points, rows.directions.len() - rows.points);
        // The weights add up to the area of the sphere, so that λ means the same for every cloud.
        let whole = 4.0 * std::f64::consts::PI / (1.0 + ANCHOR_WEIGHT);
        let mut weights = vec![whole / points.max(1) as f64; points];
        weights.resize(points + anchors, whole * ANCHOR_WEIGHT / anchors as f64);
        let axis = |k: usize| -> Vec<f64> { rows.targets.iter().map(|x| x[k]).collect() };
        let values = [axis(0), axis(1), axis(2)];
        let samples = |k: usize| Samples {
            directions: &rows.directions,
            values: &values[k],
        };
        let gram = Gram::weighted(samples(0), &weights, degree)?;
        let rights = [0, 1, 2].map(|k| gram.right_hand_side(samples(k)));
        let [x, y, z] = rights;
        Ok(Self {
            gram,
            rights: [x?, y?, z?],
        })
    }

    /// x, y and z for a penalty, starting from those of a similar one.
    pub(crate) fn solve(
        &self,
        lambda: f64,
        start: Option<&[Coefficients; 3]>,
    ) -> Result<[Coefficients; 3], RegressionError> {
        let penalty = Penalty {
            lambda,
            power: PENALTY_POWER,
        };
        let solve = |k: usize| {
            self.gram
                .continued(&self.rights[k], penalty, start.map(|s| &s[k]))
        };
        let (x, (y, z)) = rayon::join(|| solve(0), || rayon::join(|| solve(1), || solve(2)));
        Ok([x?, y?, z?])
    }
}

/// Directions of the points of a surface nearest to the given ones, near where they were, and the
/// distances in metres, negative for points inside.
pub(crate) fn reproject(
    coordinates: &[Coefficients; 3],
    rows: &Rows,
) -> (Vec<Direction>, Vec<f64>) {
    let fields = coordinates.each_ref().map(Field::new);
    rows.directions[..rows.points]
        .par_iter()
        .zip(rows.places())
        .map(|(p, x)| nearest(&fields, *p, x))
        .unzip()
}

/// Gauss–Newton steps on |f(p) − x|², each only if it gets nearer. The distance is negative inside.
fn nearest(fields: &[Field; 3], start: Direction, x: &Vector3<f64>) -> (Direction, f64) {
    let mut p = start;
    let mut distance = f64::INFINITY;
    let mut inside = false;
    let mut step = Vector3::zeros();
    let mut tries = 0;
    while tries < STEPS {
        tries += 1;
        let candidate = if step == Vector3::zeros() {
            p
        } else {
            retract(&p, &step)
        };
        let jets = fields.each_ref().map(|f| f.jet(&candidate));
        let gap = x - Vector3::new(jets[0].value, jets[1].value, jets[2].value);
        if gap.norm() >= distance {
            step *= 0.3;
            continue;
        }
        let gain = distance - gap.norm();
        distance = gap.norm();
        p = candidate;
        let (u, v) = sph::direction::tangent_frame(&p);
        let along = |w: &Vector3<f64>| Vector3::from(jets.each_ref().map(|j| j.gradient.dot(w)));
        let (fu, fv) = (along(&u), along(&v));
        inside = gap.dot(&fu.cross(&fv)) < 0.0;
        let (e, f, g) = (fu.norm_squared(), fu.dot(&fv), fv.norm_squared());
        let (a, b) = (fu.dot(&gap), fv.dot(&gap));
        let determinant = e * g - f * f;
        if !(determinant > 1e-12 * (e + g) * (e + g)) || gain < 1e-6 * distance {
            break;
        }
        step = u * ((g * a - f * b) / determinant) + v * ((e * b - f * a) / determinant);
        step *= (LONGEST / step.norm().max(f64::MIN_POSITIVE)).min(1.0);
    }
    let signed = if inside { -distance } else { distance };
    (UnitVector3::new_normalize(p.into_inner()), signed)
}
