//! From a cloud to a proved member of M^rad.

use std::borrow::Cow;
use std::time::Instant;

use nalgebra::Point3;
use sph::regression::{Gram, Penalty, RegressionError, Samples};
use sph::rotation::heat_flow;

use crate::hole_filling::fill_holes;
use crate::opening::{OpenContainer, Opening};
use crate::outliers::{isolated_points, outlying_points};
use crate::point_cloud::{CloudError, PointCloud, RadialSamples};
use crate::radial::{RadialError, RadialShape};
use crate::visibility::{Crossing, Visibility, measure_visibility};

/// How a cloud is turned into a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitSettings {
    /// Highest degree L; the paper uses 50.
    pub degree: usize,
    /// λ of the penalty λ Σ (l(l+1))² β²; chosen from the data when absent.
    pub lambda: Option<f64>,
}

/// Exponent of l(l+1) in the penalty: the spherical thin-plate spline.
pub const PENALTY_POWER: i32 = 2;

/// [`Visibility::multiple`] above which a cloud is refused. Scans that a radius can describe, with ears
/// and handles, stay below 0.05; of the real objects in the tests a drill has 0.12, a mug 0.65 (with
/// 2 mm of noise still more than 0.2) and a bowl with its thin wall 0.71.
pub const MAX_MULTIPLE: f64 = 0.2;

/// The same for a cloud with an opening, through which the inside of a wall can be seen. A mug's is
/// above 0.1 with 2 mm of noise from 12,000 points on, with 1 mm from 5,000.
pub const MAX_MULTIPLE_OPEN: f64 = 0.1;

/// [`Visibility::unobserved`] above which a cloud is refused: a line, a sheet or a handful of points. A
/// single view of a solid object leaves about a quarter of the directions open.
pub const MAX_UNOBSERVED: f64 = 0.4;

/// The λ of the marginal likelihood times this.
///
/// The likelihood treats edges and steps, which degree 50 cannot represent, as white noise and
/// smooths a little too much. Fitted to one half, the error on the other is least for a factor of
/// 0.05 to 0.5 on scans with hard edges and of 1 to 3 on smooth or noisy ones, and it is flat: a
/// factor of 0.5 costs at most 1 % over the best one on 28 scans, clean and noisy (3 % on a smooth
/// apple), and beats plain least squares in 83 of 84 halves of the 14 objects of the tests, where a
/// factor of 1 does in 79. Against the true surface of modelled objects, which had no part in the
/// choice, 0.5 is up to 12 % above the best, 0.3 4 to 22 %, 1 up to 3 % (two nearly round ones 41
/// to 53, 59 to 73 and 21 to 29 %).
const LIKELIHOOD_FACTOR: f64 = 0.5;
/// Fewer points than coefficients resolve degrees up to about this times √N.
const RESOLVED: f64 = 2.0 / 3.0;

/// A chosen λ is raised until the surface stays below this many times the largest observed radius.
const MOST_OVERSHOOT: f64 = 1.25;
/// A chosen λ is raised until the surface stays above this part of the least observed radius.
const LEAST_UNDERSHOOT: f64 = 0.25;
/// The factor by which λ is raised, and the largest number of times.
const RAISE_FACTOR: f64 = 10.0;
const MAX_RAISES: usize = 6;
/// Largest number of fits of a cloud with outliers.
const ROUNDS: usize = 4;
/// Outliers with less than this share of the squared residuals do not move the surface: no
/// further fit. Normal noise has far less.
const INFLUENTIAL: f64 = 0.1;

/// Why a cloud has no surface in M^rad.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FitError {
    /// The regression failed.
    #[error(transparent)]
    Regression(#[from] RegressionError),
    /// The fitted function is not a positive radius.
    #[error(transparent)]
    Radial(#[from] RadialError),
    /// No radius over the directions can describe the cloud.
    #[error(
        "not star-shaped: in {percent:.0} % of the directions the surface is met twice (limit {limit_percent:.0} %), most clearly along ({x:.3}, {y:.3}, {z:.3}) from the mean, at {inner:.4} m and {outer:.4} m, and {unobserved_percent:.0} % of the directions hold no point; scan it closed, cut it into parts, or choose another object",
        percent = 100.0 * visibility.multiple,
        limit_percent = 100.0 * limit,
        unobserved_percent = 100.0 * visibility.unobserved,
        x = worst.direction.x,
        y = worst.direction.y,
        z = worst.direction.z,
        inner = worst.inner,
        outer = worst.outer,
    )]
    NotStarShaped {
        /// The measure, with all directions concerned.
        visibility: Box<Visibility>,
        /// The limit of [`Visibility::multiple`] that it exceeds.
        limit: f64,
        /// The clearest of them.
        worst: Crossing,
    },
    /// The cloud is an open container whose walls the noise hides.
    #[error(
        "not star-shaped: an open container; around ({x:.3}, {y:.3}, {z:.3}) from the mean {percent:.0} % of the directions hold no point, and {why}; scan it closed, cut it into parts, or choose another object",
        x = opening.axis.x,
        y = opening.axis.y,
        z = opening.axis.z,
        percent = 100.0 * opening.share,
        why = match container {
            OpenContainer::TwoWalls => "the scatter of the points is that of two walls",
            OpenContainer::EvenDensity => "the points are spread as evenly as if seen from all sides",
        },
    )]
    OpenContainer {
        /// Its opening.
        opening: Opening,
        /// The evidence against a solid seen from one side.
        container: OpenContainer,
    },
    /// Most of the surface was not seen.
    #[error(
        "{percent:.0} % of the directions from the mean hold no point (limit {limit_percent:.0} %): the points surround nothing; a scan from more sides is needed",
        percent = 100.0 * unobserved,
        limit_percent = 100.0 * MAX_UNOBSERVED,
    )]
    Unobserved {
        /// Share of the directions without a point.
        unobserved: f64,
    },
    /// The surface deviates far from the data under every penalty tried.
    #[error(
        "the surface runs from {:.4} to {:.4} m where the data run from {:.4} to {:.4} m; a lower degree or a more complete scan may help",
        reached.0, reached.1, seen.0, seen.1,
    )]
    Overshoot {
        /// Certified bounds of the radius, metres.
        reached: (f64, f64),
        /// Least and largest radius among the points, metres.
        seen: (f64, f64),
    },
    /// The time σ of the heat flow is negative or not a number.
    #[error("heat for a time of {sigma}: expected a number, at least 0")]
    Heat {
        /// The time σ that was given.
        sigma: f64,
    },
    /// The cloud given for the residuals is not the fitted one.
    #[error("the cloud is not the one that was fitted")]
    OtherCloud,
    /// Too few points remain.
    #[error(transparent)]
    Cloud(#[from] CloudError),
}

/// A fitted surface and its residuals.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The surface, in the centred frame.
    pub shape: RadialShape,
    /// Origin of the centred frame in the frame of the cloud: the mean of the points used. Metres.
    pub centre_in_cloud: Point3<f64>,
    /// λ used.
    pub lambda: f64,
    /// Root mean square of |rᵢ − r(pᵢ)| over the points used, metres.
    pub rms: f64,
    /// Largest |rᵢ − r(pᵢ)| over the points used, metres.
    pub max_abs: f64,
    /// Condition number of the penalised regression.
    pub condition: f64,
    /// Wall-clock time of the last regression, seconds: the normal equations, the choice of λ and their
    /// solution, without the tests of the cloud and the proof.
    pub regression_seconds: f64,
    /// How close the cloud is to star-shaped, and where it has holes.
    pub visibility: Visibility,
    /// Points not used, as indices into the cloud: far from the surface and from other points.
    pub outliers: Vec<usize>,
}

impl Fit {
    /// The surface after heat has flowed on the sphere for a time σ, β_{lm} e^{−l(l+1)σ}: the weighted
    /// harmonics of the paper's reference 13, which damp the ringing at edges.
    ///
    /// Details narrower than about √σ radians vanish. Residuals are those of the smoothed surface,
    /// which is certified again; λ and the condition number are those of the fit. `cloud` is the
    /// fitted cloud.
    ///
    ///
    /// # Errors
    ///
    /// σ is negative or not a number; the cloud is another one; there is no proof that the radius
    /// stays positive.
    pub fn smoothed(&self, cloud: &PointCloud, sigma: f64) -> Result<Self, FitError> {
        if !(sigma.is_finite() && sigma >= 0.0) {
            return Err(FitError::Heat { sigma });
        }
        let points = cloud.points().len();
        if self.outliers.last().is_some_and(|last| *last >= points) {
            return Err(FitError::OtherCloud);
        }
        let view = View::new(cloud, &self.outliers)?;
        if view.centre != self.centre_in_cloud {
            return Err(FitError::OtherCloud);
        }
        let solved = Solved {
            shape: RadialShape::new(heat_flow(self.shape.coefficients(), sigma))?,
            lambda: self.lambda,
            condition: self.condition,
            seconds: self.regression_seconds,
        };
        let residuals = view.residuals(&solved.shape);
        Ok(solved.report(
            &view,
            &residuals,
            self.visibility.clone(),
            self.outliers.clone(),
        ))
    }
}

/// Fits r(p) = Σ β Y to the cloud seen from its mean (Sec. III-B and IV-A of the paper), with a
/// penalty, and proves the result positive.
///
/// A cloud whose surface is met twice in more than [`MAX_MULTIPLE`] of the directions is refused,
/// and one that leaves more than [`MAX_UNOBSERVED`] of them open, and an open container, see
/// [`OpenContainer`]. Points that are both far from the surface and isolated are outliers: they
/// lose their weight and the fit is repeated, at most four times. A cloud without outliers is
/// fitted once. Directions without points get a value by harmonic continuation of the radii around
/// them. A λ chosen from the data is raised if the surface is not proved positive or deviates far
/// from the data; a given λ is not.
pub fn fit(cloud: &PointCloud, settings: &FitSettings) -> Result<Fit, FitError> {
    let mut outliers: Vec<usize> = Vec::new();
    let mut round = 0;
    loop {
        let view = View::new(cloud, &outliers)?;
        let visibility = measure_visibility(&view.samples);
        if let Some(error) = refusal(&visibility) {
            // A cluster of outliers looks like a second sheet, so the test is repeated without it.
            let outlying = isolated_points(&view.points);
            if round > 0 || outlying.is_empty() {
                return Err(error);
            }
            outliers.extend(outlying.iter().map(|i| view.place(*i)));
            round += 1;
            continue;
        }
        round += 1;
        let solved = view.solve(settings, &visibility)?;
        let residuals = view.residuals(&solved.shape);
        let outlying = outlying_points(&view.points, &residuals);
        if round >= ROUNDS || !influential(&outlying, &residuals) {
            outliers.sort_unstable();
            return Ok(solved.report(&view, &residuals, visibility, outliers));
        }
        outliers.extend(outlying.iter().map(|i| view.place(*i)));
    }
}

/// The reason why a cloud is not the graph of a radius, if it is not.
fn refusal(visibility: &Visibility) -> Option<FitError> {
    let limit = visibility
        .opening
        .map_or(MAX_MULTIPLE, |_| MAX_MULTIPLE_OPEN);
    // A share above the limit has crossings; the clearest is the first.
    if visibility.multiple > limit {
        return Some(FitError::NotStarShaped {
            worst: visibility.crossings[0],
            visibility: Box::new(visibility.clone()),
            limit,
        });
    }
    if let Some(opening) = visibility.opening
        && let Some(container) = opening.container
    {
        return Some(FitError::OpenContainer { opening, container });
    }
    (visibility.unobserved > MAX_UNOBSERVED).then_some(FitError::Unobserved {
        unobserved: visibility.unobserved,
    })
}

/// Whether outliers have pulled the surface.
fn influential(outlying: &[usize], residuals: &[f64]) -> bool {
    let theirs: f64 = outlying.iter().map(|i| residuals[*i].powi(2)).sum();
    let all: f64 = residuals.iter().map(|e| e * e).sum();
    theirs > INFLUENTIAL * all
}

/// The points in use, seen from their mean. The points of a cloud of which all are in use are not
/// copied: a cloud may have millions.
struct View<'a> {
    centre: Point3<f64>,
    /// Position of each point in the cloud, where not all are in use.
    index: Option<Vec<usize>>,
    points: Cow<'a, [Point3<f64>]>,
    samples: RadialSamples,
}

/// A regression that led to a shape.
struct Solved {
    shape: RadialShape,
    lambda: f64,
    condition: f64,
    seconds: f64,
}

impl<'a> View<'a> {
    fn new(cloud: &'a PointCloud, outliers: &[usize]) -> Result<Self, FitError> {
        let at = |i: usize| cloud.points()[i];
        let mut used = vec![true; cloud.points().len()];
        for &i in outliers {
            used[i] = false;
        }
        let all = (0..used.len()).filter(|i| used[*i]);
        let centre = match outliers {
            [] => cloud.mean(),
            _ => PointCloud::new(all.clone().map(at).collect())?.mean(),
        };
        if outliers.is_empty() && !cloud.points().contains(&centre) {
            return Ok(Self {
                centre,
                index: None,
                points: Cow::Borrowed(cloud.points()),
                samples: cloud.seen_from(&centre),
            });
        }
        // A point at the centre has no direction.
        let index: Vec<usize> = all.filter(|i| at(*i) != centre).collect();
        let points: Vec<Point3<f64>> = index.iter().map(|i| at(*i)).collect();
        let samples = PointCloud::new(points.clone())?.seen_from(&centre);
        Ok(Self {
            centre,
            index: Some(index),
            points: Cow::Owned(points),
            samples,
        })
    }

    /// Position of a point in the cloud.
    fn place(&self, point: usize) -> usize {
        self.index.as_ref().map_or(point, |index| index[point])
    }

    fn solve(&self, settings: &FitSettings, visibility: &Visibility) -> Result<Solved, FitError> {
        let filled = fill_holes(&self.samples, &visibility.unobserved_directions);
        let samples = Samples {
            directions: &filled.directions,
            values: &filled.radii,
        };
        let begin = Instant::now();
        let gram = Gram::new(samples, settings.degree)?;
        let chosen = settings.lambda.is_none();
        let mut penalty = match settings.lambda {
            Some(lambda) => Penalty {
                lambda,
                power: PENALTY_POWER,
            },
            None => choose_penalty(&gram, filled.radii.len(), settings.degree)?,
        };
        let mut raises = if chosen { MAX_RAISES } else { 0 };
        loop {
            let solution = gram.solve(samples, penalty)?;
            let seconds = begin.elapsed().as_secs_f64();
            let shape = RadialShape::new(solution.coefficients).map_err(FitError::from);
            match shape.and_then(|shape| self.not_too_far(shape, chosen)) {
                Ok(shape) => {
                    return Ok(Solved {
                        shape,
                        lambda: penalty.lambda,
                        condition: solution.condition,
                        seconds,
                    });
                }
                Err(error) if raises == 0 => return Err(error),
                Err(_) => {
                    raises -= 1;
                    penalty.lambda *= RAISE_FACTOR;
                }
            }
        }
    }

    fn not_too_far(&self, shape: RadialShape, chosen: bool) -> Result<RadialShape, FitError> {
        let radii = self.samples.radii.iter();
        let (least, most) =
            radii.fold((f64::INFINITY, 0.0_f64), |(a, b), r| (a.min(*r), b.max(*r)));
        let (lower, upper) = shape.radius_bounds();
        if chosen && (upper > MOST_OVERSHOOT * most || lower < LEAST_UNDERSHOOT * least) {
            return Err(FitError::Overshoot {
                reached: (lower, upper),
                seen: (least, most),
            });
        }
        Ok(shape)
    }

    /// r(pᵢ) − rᵢ.
    fn residuals(&self, shape: &RadialShape) -> Vec<f64> {
        let mut residuals = shape.radii(&self.samples.directions);
        for (fitted, radius) in residuals.iter_mut().zip(&self.samples.radii) {
            *fitted -= radius;
        }
        residuals
    }
}

/// The λ of the marginal likelihood, reduced by a factor, but not below the least λ that the number
/// of samples supports.
///
/// With fewer samples than coefficients the likelihood may estimate no noise at all. Then λ is at
/// least the one that halves the highest degree that N samples resolve: N/4π samples per steradian
/// have the weight λ(l(l+1))².
pub(crate) fn choose_penalty(
    gram: &Gram,
    samples: usize,
    degree: usize,
) -> Result<Penalty, RegressionError> {
    let mut penalty = gram.choose_penalty(PENALTY_POWER)?;
    penalty.lambda *= LIKELIHOOD_FACTOR;
    if samples < (degree + 1) * (degree + 1) {
        let n = samples as f64;
        let l = (RESOLVED * n.sqrt()).max(1.0);
        let floor = n / (4.0 * std::f64::consts::PI * (l * (l + 1.0)).powi(PENALTY_POWER));
        penalty.lambda = penalty.lambda.max(floor);
    }
    Ok(penalty)
}

impl Solved {
    fn report(
        self,
        view: &View,
        residuals: &[f64],
        visibility: Visibility,
        outliers: Vec<usize>,
    ) -> Fit {
        let squares: f64 = residuals.iter().map(|e| e * e).sum();
        Fit {
            shape: self.shape,
            centre_in_cloud: view.centre,
            lambda: self.lambda,
            rms: (squares / residuals.len() as f64).sqrt(),
            max_abs: residuals.iter().fold(0.0, |worst, e| e.abs().max(worst)),
            condition: self.condition,
            regression_seconds: self.seconds,
            visibility,
            outliers,
        }
    }
}
