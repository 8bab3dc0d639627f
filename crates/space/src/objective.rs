//! Grasp quality as a function of contacts on one surface, under one convention.

mod pyramids;
mod realised;
mod slopes;

use grasp::{
    ActiveFacet, Contact, Convention, Epsilon, FrameRule, Gradient, GraspModel, Margin,
    QualityError, Workspace,
};
use nalgebra::Point3;
use shape::Surface;
use sph::Direction;

use self::pyramids::Pyramids;
use self::realised::Realised;
use crate::resolved::ResolvedConvention;

/// Facets that are linearised, the weakest first.
const FACETS: usize = 40;

/// How far above Q facets are linearised: the others are found by rejected steps.
fn band(quality: f64) -> f64 {
    0.06 * quality.max(0.0) + 1e-3
}

/// Q of contacts on a surface: the convention with everything the surface decides filled in.
#[derive(Clone, Debug)]
pub struct Objective {
    evaluator: Evaluator,
    /// For round cones.
    pyramids: Option<Pyramids>,
    realised: Realised,
    /// The margin computed last, and where.
    last: Option<Margin>,
    at: Vec<Direction>,
    /// Scratch of linearisations.
    facets: Vec<ActiveFacet>,
}

/// A resolved convention with the workspace in which qualities under it are computed and counted.
#[derive(Clone, Debug)]
struct Evaluator {
    resolved: ResolvedConvention,
    workspace: Workspace,
    evaluations: usize,
}

impl Evaluator {
    fn margin(&mut self, contacts: &[Contact]) -> Result<Margin, QualityError> {
        self.evaluations += 1;
        let centre = self.resolved.centre();
        let model = GraspModel::new(contacts, &centre, self.resolved.convention());
        grasp::margin(&model, &mut self.workspace)
    }

    fn epsilon(&mut self, contacts: &[Contact]) -> Result<Epsilon, QualityError> {
        self.evaluations += 1;
        let centre = self.resolved.centre();
        let model = GraspModel::new(contacts, &centre, self.resolved.convention());
        grasp::epsilon(&model, &mut self.workspace)
    }

    fn near_active_facets(
        &mut self,
        contacts: &[Contact],
        band: f64,
        facets: &mut Vec<ActiveFacet>,
    ) -> Result<(), QualityError> {
        self.evaluations += 1;
        let centre = self.resolved.centre();
        let model = GraspModel::new(contacts, &centre, self.resolved.convention());
        grasp::near_active_facets(&model, band, &mut self.workspace, facets)
    }
}

impl Objective {
    /// Resolves a convention on a surface; see [`ResolvedConvention::new`].
    pub fn new(
        convention: &Convention,
        surface: &impl Surface,
        object_origin: &Point3<f64>,
    ) -> Self {
        Self::of(ResolvedConvention::new(convention, surface, object_origin))
    }

    /// Q under a convention that is resolved already.
    pub fn of(resolved: ResolvedConvention) -> Self {
        Self {
            pyramids: Pyramids::of(resolved.convention()),
            evaluator: Evaluator {
                resolved,
                workspace: Workspace::with_warm_start(),
                evaluations: 0,
            },
            realised: Realised::default(),
            last: None,
            at: Vec::new(),
            facets: Vec::new(),
        }
    }

    /// The same quality with another friction coefficient: what is still closed under a smaller one
    /// has that much of its friction cones to spare.
    pub fn with_friction(&self, friction: f64) -> Self {
        Self::of(self.evaluator.resolved.with_friction(friction))
    }

    /// The convention with its torque length resolved.
    pub fn convention(&self) -> &Convention {
        self.evaluator.resolved.convention()
    }

    /// The point about which torques are taken, centred frame, metres.
    pub fn centre(&self) -> Point3<f64> {
        self.evaluator.resolved.centre()
    }

    /// How many qualities have been computed so far.
    pub fn evaluations(&self) -> usize {
        self.evaluator.evaluations
    }

    /// Forgets the grasps before: the answers that follow do not depend on them, to the last bit.
    ///
    /// Otherwise a search goes on from the last one ([`Workspace::with_warm_start`]).
    pub fn forget(&mut self) {
        self.evaluator.workspace.forget();
        if let Some(pyramids) = &mut self.pyramids {
            pyramids.forget();
        }
        self.last = None;
    }

    /// The full answer for a list of contacts.
    ///
    /// # Errors
    /// As [`grasp::epsilon`].
    pub fn epsilon(&mut self, contacts: &[Contact]) -> Result<Epsilon, QualityError> {
        self.evaluator.epsilon(contacts)
    }

    /// Q, or minus the distance from force closure, with the facet that decides.
    ///
    /// # Errors
    /// As [`grasp::margin`].
    pub fn margin(&mut self, contacts: &[Contact]) -> Result<Margin, QualityError> {
        self.evaluator.margin(contacts)
    }

    /// The facets whose offset is within `band` of Q, the nearest first; none for an open grasp.
    ///
    /// # Errors
    /// As [`grasp::near_active_facets`].
    pub fn near_active_facets(
        &mut self,
        contacts: &[Contact],
        band: f64,
        facets: &mut Vec<ActiveFacet>,
    ) -> Result<(), QualityError> {
        self.evaluator.near_active_facets(contacts, band, facets)
    }

    /// How a facet's offset changes with the contacts and their normals.
    ///
    /// # Errors
    /// As [`grasp::facet_gradient`].
    pub fn facet_gradient(
        &self,
        contacts: &[Contact],
        facet: &ActiveFacet,
        frame: FrameRule,
        gradient: &mut Gradient,
    ) -> Result<(), QualityError> {
        let centre = self.centre();
        let model = GraspModel::new(contacts, &centre, self.convention());
        Ok(grasp::facet_gradient(&model, facet, frame, gradient)?)
    }

    /// Q ≥ 0 of contacts; 0 when they are not force-closed, whatever the convention prints then.
    ///
    /// # Errors
    /// As [`Objective::epsilon`].
    pub fn quality(&mut self, contacts: &[Contact]) -> Result<f64, QualityError> {
        Ok(self.epsilon(contacts)?.quality)
    }

    /// Q at directions of a surface.
    ///
    /// # Errors
    /// As [`Objective::epsilon`].
    pub fn quality_at(
        &mut self,
        surface: &impl Surface,
        directions: &[Direction],
    ) -> Result<f64, QualityError> {
        self.realised.place(surface, directions);
        Ok(self.evaluator.epsilon(&self.realised.contacts)?.quality)
    }
}
