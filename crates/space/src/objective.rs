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

/// Largest number of linearised facets; those with the smallest offset come first.
const FACETS: usize = 40;

/// Facets with an offset up to this much above Q are linearised; rejected steps find the others.
fn band(quality: f64) -> f64 {
    0.06 * quality.max(0.0) + 1e-3
}

/// Q of contacts on a surface, under a convention resolved on that surface.
#[derive(Clone, Debug)]
pub struct Objective {
    evaluator: Evaluator,
    /// The pyramids that linearise Q under round cones; `None` for other conventions.
    pyramids: Option<Pyramids>,
    realised: Realised,
    /// The margin computed last and its arguments.
    last: Option<Margin>,
    at: Vec<Direction>,
    /// Memory for linearisations.
    facets: Vec<ActiveFacet>,
}

/// A resolved convention, and the workspace that computes and counts qualities under it.
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

    /// Q under a convention that is already resolved.
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

    /// The same quality with another friction coefficient. A grasp that is closed under a smaller
    /// coefficient keeps a margin to its friction cones.
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

    /// Discards the warm start, so that later results do not depend on earlier grasps, to the last
    /// bit.
    ///
    /// Without this call a search continues from the last grasp ([`Workspace::with_warm_start`]).
    pub fn forget(&mut self) {
        self.evaluator.workspace.forget();
        if let Some(pyramids) = &mut self.pyramids {
            pyramids.forget();
        }
        self.last = None;
    }

    /// Q of a list of contacts, with its certificate.
    ///
    /// # Errors
    /// As [`grasp::epsilon`].
    pub fn epsilon(&mut self, contacts: &[Contact]) -> Result<Epsilon, QualityError> {
        self.evaluator.epsilon(contacts)
    }

    /// Q, or minus the distance from force closure, with the facet that attains it.
    ///
    /// # Errors
    /// As [`grasp::margin`].
    pub fn margin(&mut self, contacts: &[Contact]) -> Result<Margin, QualityError> {
        self.evaluator.margin(contacts)
    }

    /// The facets whose offset is within `band` of Q, the smallest offset first; empty for an open
    /// grasp.
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

    /// Derivatives of a facet's offset by the positions and normals of the contacts.
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

    /// Q ≥ 0 of contacts; 0 if they are not force-closed, whatever value the convention has for
    /// that case.
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
