//! Our ascent: never down, no poles, aware of every facet that is about to decide.
//!
//! Q is the least of many smooth facet offsets, so at a maximum several tie and a step along the
//! gradient of one lowers another. Each step therefore maximises the least of the near-active
//! facets' linear models, less |u|²/2ρ (a proximal bundle step), over all contacts' tangent
//! moves u; a move is taken only if Q rises, and ρ follows how well the model did.

use grasp::{ActiveFacet, Contact, FrameRule, Gradient, Margin, QualityError};
use nalgebra::Vector3;
use shape::{Differential, Surface};
use sph::Direction;
use sph::direction::{retract, tangent_frame};

use super::bundle::{BundleModel, LinearPiece};
use super::{Ascent, Step};
use crate::objective::Objective;
use crate::point::contacts_on;

/// Settings of the monotone ascent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MonotoneAscent {
    /// Most steps tried, taken or not.
    pub steps: usize,
    /// Longest move of all contacts together in one step, radians.
    pub reach: f64,
    /// Stop when no direction promises a slope above this, per radian.
    pub stationarity: f64,
    /// Stop when the model promises less than this.
    pub least_gain: f64,
}

impl Default for MonotoneAscent {
    /// Converges to about 1e-5 of Q on household objects.
    fn default() -> Self {
        Self {
            steps: 200,
            reach: 0.3,
            stationarity: 1e-4,
            least_gain: 1e-7,
        }
    }
}

/// Share of the promised gain that a step must bring.
const ACCEPT: f64 = 0.1;
/// Facets that one step looks at, the weakest first.
const FACETS: usize = 48;
/// First move, radians.
const FIRST_MOVE: f64 = 0.1;

/// Where the ascent stands.
struct State {
    directions: Vec<Direction>,
    contacts: Vec<Contact>,
    margin: Margin,
}

impl MonotoneAscent {
    /// Climbs from `start`; `trace` sees every state taken. The quality of the result is never
    /// below that of the start.
    ///
    /// Works from grasps that are not force-closed too: there the signed margin rises first. The
    /// qualities reported are 0 for open grasps.
    pub fn climb(
        &self,
        surface: &impl Surface,
        start: &[Direction],
        objective: &mut Objective,
        mut trace: impl FnMut(&Step),
    ) -> Result<Ascent, QualityError> {
        let before = objective.evaluations();
        let mut here = State::new(surface, start.to_vec(), objective)?;
        let start_quality = here.quality();
        let mut pieces = Vec::new();
        let mut fresh = true;
        let mut damping: Option<f64> = None;
        for _ in 0..self.steps {
            if fresh {
                self.linearise(surface, &here, objective, &mut pieces)?;
            }
            let steepest = pieces.first().map_or(0.0, LinearPiece::slope);
            if !(steepest > self.stationarity) {
                break;
            }
            let rho = damping.unwrap_or(FIRST_MOVE / steepest);
            let step = BundleModel::new(&pieces, rho).best_move(self.reach);
            if fresh {
                trace(&Step {
                    contacts: &here.directions,
                    quality: here.quality(),
                    stationarity: step.slope,
                });
            }
            if !(step.gain > self.least_gain && step.slope > self.stationarity) {
                // Nothing to gain with this much freedom; with more there may be.
                if rho >= 1.0 || step.slope <= self.stationarity {
                    break;
                }
                damping = Some(8.0 * rho);
                fresh = false;
                continue;
            }
            let moved = here.moved(&step.moves);
            let there = State::new(surface, moved, objective)?;
            let gain = there.margin.value - here.margin.value;
            let kept_promise = gain / step.gain;
            fresh = kept_promise >= ACCEPT && gain > 0.0;
            damping = Some(match kept_promise {
                k if k > 0.75 => 2.0 * rho,
                k if k > 0.3 => rho,
                k if k > 0.0 => 0.5 * rho,
                _ => 0.25 * rho,
            });
            if fresh {
                here = there;
            }
        }
        trace(&Step {
            contacts: &here.directions,
            quality: here.quality(),
            stationarity: 0.0,
        });
        Ok(Ascent {
            quality: here.quality(),
            contacts: here.directions,
            start_quality,
            evaluations: objective.evaluations() - before,
        })
    }

    /// The near-active facets as linear functions of the contacts' tangent moves.
    fn linearise(
        &self,
        surface: &impl Surface,
        here: &State,
        objective: &mut Objective,
        pieces: &mut Vec<LinearPiece>,
    ) -> Result<(), QualityError> {
        pieces.clear();
        let slopes: Vec<Differential> = here
            .directions
            .iter()
            .map(|p| surface.differential(p))
            .collect();
        let mut facets = Vec::new();
        if here.margin.closed {
            let band = 0.25 * here.margin.value + 1e-3;
            objective.near_active_facets(&here.contacts, band, &mut facets)?;
            facets.sort_by(|a, b| a.offset.total_cmp(&b.offset));
            facets.truncate(FACETS);
        } else {
            facets.push(here.margin.facet);
        }
        let mut gradient = Gradient::default();
        for facet in &facets {
            objective.facet_gradient(&here.contacts, facet, FrameRule::Tangent, &mut gradient)?;
            pieces.push(piece(here, facet, &gradient, &slopes));
        }
        Ok(())
    }
}

/// Chain rule: dQ = Σᵢ (df(pᵢ)ᵀ ∂Q/∂cᵢ + dn(pᵢ)ᵀ ∂Q/∂nᵢ) · uᵢ.
fn piece(
    here: &State,
    facet: &ActiveFacet,
    gradient: &Gradient,
    slopes: &[Differential],
) -> LinearPiece {
    let mut slope = Vec::with_capacity(2 * slopes.len());
    for (i, at) in slopes.iter().enumerate() {
        let by_move = at.position_slope.transpose() * gradient.positions[i]
            + at.normal_slope.transpose() * gradient.normals[i];
        let (e1, e2) = tangent_frame(&here.directions[i]);
        slope.extend([e1.dot(&by_move), e2.dot(&by_move)]);
    }
    LinearPiece {
        excess: facet.offset - here.margin.value,
        gradient: slope,
    }
}

impl State {
    fn new(
        surface: &impl Surface,
        directions: Vec<Direction>,
        objective: &mut Objective,
    ) -> Result<Self, QualityError> {
        let contacts = contacts_on(surface, &directions);
        let margin = objective.margin(&contacts)?;
        Ok(Self {
            directions,
            contacts,
            margin,
        })
    }

    fn quality(&self) -> f64 {
        self.margin.value.max(0.0)
    }

    /// The directions after tangent moves, two numbers a contact in the frame of its direction.
    fn moved(&self, moves: &[f64]) -> Vec<Direction> {
        self.directions
            .iter()
            .zip(moves.chunks_exact(2))
            .map(|(p, u)| {
                let (e1, e2) = tangent_frame(p);
                let v: Vector3<f64> = e1 * u[0] + e2 * u[1];
                retract(p, &v)
            })
            .collect()
    }
}
