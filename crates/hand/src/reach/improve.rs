//! The best grasp near wanted contacts that a hand can execute.
//!
//! Where no hand pose brings the tips to the contacts (a valley narrower than a tip, a span wider
//! than the hand), the contacts that the closed hand makes are a grasp of lower quality. The search
//! improves the quality from there. Each trial displaces the wanted contacts a little, moves the
//! hand towards them, closes it by the closing rules and measures the quality of its contacts.

use grasp::{Contact, Convention, GraspModel, QualityError, Workspace, epsilon};
use nalgebra::{DVector, Point3};
use rand::{Rng, RngExt};
use shape::{Surface, SurfaceRef};
use sph::Direction;
use sph::direction::{log, retract, tangent_frame};

use super::problem::{Task, state};
use super::{ReachParams, Reached, Reacher};
use crate::contact::even_axes;
use crate::tip_model::TipModel;

/// Settings of the search for a better grasp of a hand.
#[derive(Debug, Clone, PartialEq)]
pub struct ImproveParams {
    /// Number of closings tried.
    pub trials: usize,
    /// Length of the first displacement of the contacts, metres. It grows after a success and
    /// shrinks after a failure.
    pub spread: f64,
    /// How quality is measured.
    pub convention: Convention,
    /// The point about which torques are taken, centred frame, metres.
    pub centre: Point3<f64>,
    /// What the contacts transmit, apart from friction.
    pub tips: TipModel,
}

/// A grasp that the hand makes.
#[derive(Debug, Clone, PartialEq)]
pub struct Improvement {
    /// The hand and its contacts; the errors are distances from the wanted contacts.
    pub reached: Reached,
    /// Quality of the hand's contacts.
    pub quality: f64,
    /// The quality before the search.
    pub start_quality: f64,
}

/// The state of the search.
struct Standing {
    x: DVector<f64>,
    hand: Reached,
    quality: f64,
}

impl Reacher<'_> {
    /// Improves the quality from a hand that is near the wanted contacts, among hands that satisfy
    /// every rule. The result is never worse than the start. The same generator state gives the
    /// same result.
    ///
    ///
    /// Cost: about two milliseconds per trial.
    ///
    /// # Errors
    ///
    /// The convention cannot be used.
    pub fn improve<R: Rng + ?Sized>(
        &self,
        wanted: &[Contact],
        near: Reached,
        reach: &ReachParams,
        params: &ImproveParams,
        rng: &mut R,
    ) -> Result<Improvement, QualityError> {
        let measure = |contacts: &[Contact]| {
            let models = params
                .tips
                .of_contacts(params.convention.friction, contacts.len());
            let model = GraspModel::new(contacts, &params.centre, &params.convention);
            let model = model.with_contact_models(&models);
            epsilon(&model, &mut Workspace::new()).map(|found| found.value(&params.convention))
        };
        let start_quality = measure(&near.contacts)?;
        let targets: Vec<_> = wanted
            .iter()
            .filter_map(|c| Direction::try_new(c.position.coords, 0.0))
            .collect();
        let mut best = Standing {
            x: state(&near.object_from_palm, &near.joints),
            hand: near,
            quality: start_quality,
        };
        let mut spread = params.spread;
        let mut way: Option<Vec<Direction>> = None;
        for trial in 0..params.trials {
            let aims = match way.take() {
                // Repeat a displacement that raised the quality.
                Some(ahead) => ahead,
                None if trial < 3 => {
                    towards(&best.hand.directions, &targets, 0.5_f64.powi(trial as i32))
                }
                None => self.aside(&best.hand.directions, spread, rng),
            };
            let found = self.trial(&best, &aims, reach, measure)?;
            match found {
                Some(next) if next.quality > best.quality => {
                    spread = (1.6 * spread).min(4.0 * params.spread);
                    way = Some(ahead(&best.hand.directions, &next.hand.directions));
                    best = next;
                }
                _ => spread = (0.88 * spread).max(0.02 * params.spread),
            }
        }
        let mut reached = best.hand;
        reached.measure_errors(wanted);
        Ok(Improvement {
            reached,
            quality: best.quality,
            start_quality,
        })
    }

    /// Moves the hand towards contacts at `aims` and closes it; `None` if a rule is broken.
    fn trial(
        &self,
        from: &Standing,
        aims: &[Direction],
        reach: &ReachParams,
        measure: impl Fn(&[Contact]) -> Result<f64, QualityError>,
    ) -> Result<Option<Standing>, QualityError> {
        let wanted: Vec<_> = aims
            .iter()
            .map(|p| {
                let (position, inward_normal) = self.problem.object.surface().contact(p);
                Contact {
                    position,
                    inward_normal,
                }
            })
            .collect();
        let fingers = from.hand.finger_of_contact.clone();
        let task = Task {
            wanted: &wanted,
            fingers: &fingers,
            params: reach,
        };
        let mut x = from.x.clone();
        self.problem.settle(&mut x, &task);
        let Some(hand) = self.problem.close(&x, &task, from.hand.starts) else {
            return Ok(None);
        };
        let quality = measure(&hand.contacts)?;
        Ok(Some(Standing { x, hand, quality }))
    }

    /// Every contact moved at random by about `spread` metres.
    fn aside<R: Rng + ?Sized>(
        &self,
        contacts: &[Direction],
        spread: f64,
        rng: &mut R,
    ) -> Vec<Direction> {
        let surface = self.problem.object.surface();
        contacts
            .iter()
            .map(|p| {
                let (a, b) = tangent_frame(p);
                let (angle, (a, b)) = match surface {
                    SurfaceRef::Radial(shape) => (spread / shape.radius(p), (a, b)),
                    SurfaceRef::Spherical(field) => {
                        let slope = field.differential(p).position_slope;
                        (spread, even_axes(&(slope * a), &(slope * b), (a, b), 1.0))
                    }
                };
                let mut draw = || angle * rng.random_range(-1.0..1.0);
                let way = a * draw() + b * draw();
                retract(p, &way)
            })
            .collect()
    }
}

/// Linear interpolation between two sets of contacts.
fn towards(from: &[Direction], to: &[Direction], share: f64) -> Vec<Direction> {
    let pairs = from.iter().zip(to);
    pairs
        .map(|(p, q)| retract(p, &(log(p, q) * share)))
        .collect()
}

/// Extrapolation: the second contacts plus their difference from the first.
fn ahead(from: &[Direction], to: &[Direction]) -> Vec<Direction> {
    let pairs = from.iter().zip(to);
    pairs.map(|(p, q)| retract(q, &-log(q, p))).collect()
}
