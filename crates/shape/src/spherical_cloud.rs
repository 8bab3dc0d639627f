//! A surface in M^sph from a cloud alone: wrap, map, fit.

use std::sync::Arc;

use nalgebra::Point3;
use rayon::prelude::*;
use sph::regression::RegressionError;
use sph::{Coefficients, Direction};
use sphere_map::{
    ClosedHole, MapError, MapSettings, Tree, Wrap, WrapError, WrapSettings, sphere_map, wrap,
};

use crate::acceptance::{Acceptance, Verdict, noise};
use crate::crossing::crossing;
use crate::immersion::SphericalError;
use crate::injectivity::Embedding;
use crate::open_sheet::Walls;
use crate::point_cloud::PointCloud;
use crate::spherical::SphericalShape;
use crate::spherical_field::SphericalField;
use crate::spherical_rows::{Equations, Rows, reproject};

/// Penalties that the search for an embedded start goes through, from detailed to smooth.
const STARTS: [f64; 5] = [3e-8, 1e-6, 3e-5, 3e-4, 2e-3];
/// The continuation never goes below this penalty.
const LEAST_LAMBDA: f64 = 1e-8;
/// Steps of the continuation at most, the factor of λ in the first one, and the one that ends it.
const ROUNDS: usize = 10;
const FIRST_FACTOR: f64 = 0.3;
const LAST_FACTOR: f64 = 0.85;
/// It also ends when a step lowers the residual by less than this share.
const GAIN: f64 = 0.01;
/// The maps that are tried: weight of areas and barrier. The second pair is for clouds for which the
/// first gives nothing.
const MAPS: [[(f64, f64); 2]; 2] = [[(3.0, 0.3), (3.0, 0.05)], [(10.0, 0.05), (1.0, 0.05)]];
/// A cloud of which a larger share of the points lies on a single sheet shows one side of its object.
const MOST_SINGLE_SHEET: f64 = 0.25;
/// An object with a larger share of its points at thin walls is a shell. Where these are thinner than so
/// many spacings, one noisy sheet looks the same.
const MOSTLY: f64 = 0.9;
const THIN: f64 = 1.5;
/// A coarse surface is accepted if its residual is at most this share of volume over area, a third of the
/// radius of a ball: a share of the diameter would be generous to a needle.
const MOST_COARSE: f64 = 0.15;
/// Circles of latitude, and points on each, of the mesh whose area is taken for that.
const AREA_GRID: (usize, usize) = (60, 120);
/// So many surfaces of a continuation are tried for a proof.
const PROOFS: usize = 3;
/// Anchors move to places of the wrap within so many spacings.
const REACH: f64 = 2.0;

/// How a cloud is fitted without given directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphericalSettings {
    /// Degree L of the coordinates.
    pub degree: usize,
    /// λ; chosen if it is not given.
    pub lambda: Option<f64>,
    /// Whether a surface is kept that does not explain its points, or that is a shell around the scan of
    /// one side of an object.
    pub accept_misfit: bool,
}

impl SphericalSettings {
    /// λ is chosen, and a surface that does not explain its points is refused.
    pub fn new(degree: usize) -> Self {
        Self {
            degree,
            lambda: None,
            accept_misfit: false,
        }
    }
}

/// Why a cloud has no surface in M^sph.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SphericalCloudError {
    /// The cloud could not be wrapped.
    #[error(transparent)]
    Wrap(#[from] WrapError),
    /// No setting gave a bijective map.
    #[error("no map of the wrapped cloud onto the sphere is one to one: {0}")]
    Map(#[from] MapError),
    /// A regression failed.
    #[error(transparent)]
    Regression(#[from] RegressionError),
    /// No fit is an immersion.
    #[error(transparent)]
    Spherical(#[from] SphericalError),
    /// The points lie on one side of a surface.
    #[error(
        "{:.0} % of the points lie on a single sheet without an inside, as in the scan of one side of an object; a closed surface would be a shell of {:.1} mm around them: scan the object from all sides",
        100.0 * share,
        1e3 * thickness
    )]
    OneSide {
        /// Share of the points, 0 to 1.
        share: f64,
        /// Thickness of the shell, metres.
        thickness: f64,
    },
    /// The surface is no description of its points.
    #[error("{0}")]
    Unexplained(Acceptance),
    /// Every fit cuts itself.
    #[error(
        "every fitted surface cuts itself, the smoothest near ({x:.4}, {y:.4}, {z:.4}) m; parts of the object may be thinner than the scan resolves"
    )]
    Crossing {
        /// Where, in the frame of the cloud, metres.
        x: f64,
        /// The same, y.
        y: f64,
        /// The same, z.
        z: f64,
    },
}

/// A surface fitted to a cloud, and how well.
#[derive(Clone, Debug)]
pub struct SphericalCloudFit {
    /// The surface, in the centred frame.
    pub shape: SphericalShape,
    /// Origin of the centred frame in the frame of the cloud: the mean of the cloud. Metres.
    pub centre_in_cloud: Point3<f64>,
    /// λ used for all coordinates, for weights that add up to 4π.
    pub lambda: f64,
    /// Root mean square of the distances from the points to the surface, metres.
    pub surface_rms: f64,
    /// Largest distance of a point from the surface, metres.
    pub surface_max: f64,
    /// Number of points that the surface was fitted to.
    pub points: usize,
    /// Whether the surface is proved not to touch itself.
    pub embedding: Embedding,
    /// Handles and tunnels that were closed, in the frame of the cloud.
    pub closed_holes: Vec<ClosedHole>,
    /// Number of points that were not fitted because they are too far from the wrap.
    pub left_out: usize,
    /// Number of different points that were not seen from outside when the cloud was wrapped.
    pub hidden: usize,
    /// How well the surface explains all points of the cloud, those included that it was not fitted to.
    pub acceptance: Acceptance,
    /// The thin walls of the object.
    pub walls: Walls,
}

impl SphericalCloudFit {
    /// What the user should know about the fit, a sentence each.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.acceptance.verdict() != Verdict::Explained {
            notes.push(self.acceptance.to_string());
        }
        let walls = &self.walls;
        if walls.single_sheet_share > MOST_SINGLE_SHEET {
            notes.push(format!(
                "{:.0} % of the points lie on a single sheet without an inside; the surface is a shell around them",
                100.0 * walls.single_sheet_share
            ));
        } else if walls.thin_share > MOSTLY && walls.in_spacings < THIN {
            notes.push(format!(
                "the surface is a shell with walls of about {:.1} mm; if the object is solid, the scan shows one side of it only",
                1e3 * walls.median_thickness_m
            ));
        }
        for hole in &self.closed_holes {
            let c = hole.centre;
            notes.push(format!(
                "a hole of {:.1} cm² around ({:.3}, {:.3}, {:.3}) m was closed; the object has no surface there",
                1e4 * hole.area,
                c.x,
                c.y,
                c.z
            ));
        }
        if self.left_out > 0 {
            notes.push(format!(
                "{} points are too far from the wrapped object and had no influence on its surface",
                self.left_out
            ));
        }
        notes
    }
}

/// A surface on the way.
#[derive(Clone)]
struct Candidate {
    coordinates: [Coefficients; 3],
    lambda: f64,
    rms: f64,
    max: f64,
    /// Directions of the points that were fitted.
    directions: Vec<Direction>,
}

/// The surfaces of one continuation, the most detailed last, and the points that were fitted.
struct Continuation {
    candidates: Vec<Candidate>,
    indices: Arc<[usize]>,
}

/// What does not change while one cloud is fitted.
struct Work<'a> {
    points: &'a [Point3<f64>],
    centre: Point3<f64>,
    wrap: &'a Wrap,
    tree: Tree,
    walls: Walls,
    settings: SphericalSettings,
}

/// Fits a surface to a cloud of any closed object; handles are closed and reported.
///
/// The cloud is wrapped in a mesh of genus zero, and the mesh is mapped onto the sphere, which gives every
/// point a direction. From the first penalty that gives a surface whose mesh does not cut itself a
/// continuation goes to smaller penalties. In every step the points move to the nearest places of the
/// surface before, and so do anchors on the wrap, which keep the surface in place where there are no
/// points. The last surface that does not cut itself is kept; of several maps the one with the least
/// residual.
///
/// # Errors
/// [`SphericalCloudError`].
pub fn fit_spherical_cloud(
    cloud: &PointCloud,
    settings: &SphericalSettings,
) -> Result<SphericalCloudFit, SphericalCloudError> {
    let wrap = wrap(cloud.points(), &WrapSettings::default())?;
    let tree = Tree::new(&wrap.mesh);
    let walls = Walls::new(cloud.points(), &wrap, &tree);
    if walls.single_sheet_share > MOST_SINGLE_SHEET && !settings.accept_misfit {
        return Err(SphericalCloudError::OneSide {
            share: walls.single_sheet_share,
            thickness: walls.median_thickness_m,
        });
    }
    let work = Work {
        points: cloud.points(),
        centre: cloud.mean(),
        tree,
        walls,
        wrap: &wrap,
        settings: *settings,
    };
    let mut error = SphericalCloudError::Regression(RegressionError::Empty);
    let mut immersed = None;
    for maps in MAPS {
        let tried: Vec<Result<Continuation, SphericalCloudError>> =
            maps.par_iter().map(|map| work.over_map(*map)).collect();
        let mut found = Vec::new();
        for result in tried {
            match result {
                Ok(continuation) => {
                    let last = continuation.candidates.into_iter().rev().take(PROOFS);
                    found.extend(last.map(|found| (found, Arc::clone(&continuation.indices))));
                }
                Err(e) => error = e,
            }
        }
        found.sort_by(|a, b| a.0.rms.total_cmp(&b.0.rms));
        for (candidate, indices) in found {
            match work.proved(candidate, &indices) {
                Ok(fit) if matches!(fit.embedding, Embedding::Proved { .. }) => {
                    return work.accepted(fit);
                }
                Ok(fit) => immersed = immersed.or(Some(fit)),
                Err(e) => error = e.into(),
            }
        }
    }
    immersed.ok_or(error).and_then(|fit| work.accepted(fit))
}

impl Work<'_> {
    /// A candidate with what can be proved about it.
    fn proved(
        &self,
        candidate: Candidate,
        indices: &[usize],
    ) -> Result<SphericalCloudFit, SphericalError> {
        let [x, y, z] = candidate.coordinates;
        let shape = SphericalShape::new(x, y, z)?;
        let acceptance = self.explained(&shape, indices, &candidate.directions);
        Ok(SphericalCloudFit {
            embedding: shape.embedding(),
            shape,
            centre_in_cloud: self.centre,
            lambda: candidate.lambda,
            surface_rms: candidate.rms,
            surface_max: candidate.max,
            points: indices.len(),
            closed_holes: self.wrap.closed_holes.clone(),
            left_out: self.points.len() - indices.len(),
            hidden: self.wrap.hidden,
            acceptance,
            walls: self.walls,
        })
    }

    /// How well a surface explains all points; those with the given indices have directions.
    fn explained(
        &self,
        shape: &SphericalShape,
        indices: &[usize],
        directions: &[Direction],
    ) -> Acceptance {
        let mut starts = vec![None; self.points.len()];
        for (i, p) in indices.iter().zip(directions) {
            starts[*i] = Some(*p);
        }
        let (field, noise) = (SphericalField::new(shape), noise(self.points));
        Acceptance::measure(&field, &self.centre, self.points, |i| starts[i], noise)
    }

    /// The fit, if it explains its points or need not.
    fn accepted(&self, fit: SphericalCloudFit) -> Result<SphericalCloudFit, SphericalCloudError> {
        let explained = match fit.acceptance.verdict() {
            Verdict::Explained => true,
            Verdict::Coarse => {
                let area = fit.shape.mesh(AREA_GRID.0, AREA_GRID.1).area();
                let thickness = fit.shape.mass_properties().volume / area;
                fit.acceptance.surface_rms_m <= MOST_COARSE * thickness
            }
            Verdict::Unexplained => false,
        };
        if !explained && !self.settings.accept_misfit {
            return Err(SphericalCloudError::Unexplained(fit.acceptance));
        }
        Ok(fit)
    }

    /// The fits over one map.
    fn over_map(
        &self,
        (area_weight, barrier): (f64, f64),
    ) -> Result<Continuation, SphericalCloudError> {
        let map = MapSettings {
            area_weight,
            barrier,
            ..MapSettings::default()
        };
        let map = sphere_map(&self.wrap.mesh, &map)?;
        let degree = self.settings.degree;
        let rows = Rows::new(self.points, self.wrap, &map, &self.centre, degree);
        let (coordinates, lambda) = self.start(&rows)?;
        self.continued(&rows, coordinates, lambda)
    }

    /// The first fit that does not cut itself, from detailed to smooth.
    fn start(&self, rows: &Rows) -> Result<([Coefficients; 3], f64), SphericalCloudError> {
        let equations = Equations::new(rows, self.settings.degree)?;
        let given = self.settings.lambda.map(|l| vec![l]);
        let mut place = self.centre;
        let mut last: Option<[Coefficients; 3]> = None;
        for lambda in given.unwrap_or_else(|| STARTS.to_vec()) {
            let next = equations.solve(lambda, last.as_ref())?;
            match crossing(&next) {
                None => return Ok((next, lambda)),
                Some(at) => place = self.centre + at.coords,
            }
            last = Some(next);
        }
        let Point3 { coords: at } = place;
        Err(SphericalCloudError::Crossing {
            x: at.x,
            y: at.y,
            z: at.z,
        })
    }

    /// From an embedded surface to more detailed ones.
    fn continued(
        &self,
        rows: &Rows,
        start: [Coefficients; 3],
        lambda: f64,
    ) -> Result<Continuation, SphericalCloudError> {
        let limit = REACH * self.wrap.spacing;
        let measured =
            |coordinates, lambda, (directions, gaps): (Vec<Direction>, Vec<f64>)| Candidate {
                coordinates,
                lambda,
                rms: root_mean_square(&gaps),
                max: gaps.iter().fold(0.0, |a: f64, b| a.max(*b)),
                directions,
            };
        let found = reproject(&start, rows);
        let mut kept = measured(start, lambda, found);
        let mut candidates = Vec::new();
        let mut factor = if self.settings.lambda.is_some() {
            1.0
        } else {
            FIRST_FACTOR
        };
        for _ in 0..ROUNDS {
            let before = &kept.coordinates;
            let along = rows.along(
                before,
                kept.directions.clone(),
                &self.tree,
                &self.centre,
                limit,
            );
            let smaller = (kept.lambda * factor).max(LEAST_LAMBDA.min(kept.lambda));
            let equations = Equations::new(&along, self.settings.degree)?;
            let next = equations.solve(smaller, Some(before))?;
            let found = reproject(&next, &along);
            let next = measured(next, smaller, found);
            if !(next.rms < kept.rms) || crossing(&next.coordinates).is_some() {
                factor = factor.sqrt();
                if factor > LAST_FACTOR {
                    break;
                }
                continue;
            }
            let gain = 1.0 - next.rms / kept.rms;
            candidates.push(std::mem::replace(&mut kept, next));
            if gain < GAIN {
                break;
            }
        }
        candidates.push(kept);
        Ok(Continuation {
            candidates,
            indices: Arc::clone(&rows.indices),
        })
    }
}

fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt()
}
