//! Grasp quality as a function of contacts on one surface, under one convention.

use grasp::{
    ActiveFacet, Contact, Convention, Edges, Epsilon, FrameRule, Gradient, GraspModel, Margin,
    QualityError, TangentRule, Workspace,
};
use nalgebra::{Point3, Vector3};
use shape::{Differential, Surface};
use sph::Direction;

use crate::point::contact_on;
use crate::quality::{LinearPieces, Quality, in_frame};
use crate::resolved::ResolvedConvention;

/// Facets up to this share of Q above Q are linearised: the others are learnt from rejected steps.
const BAND: f64 = 0.06;
/// A facet with a weight below this has the foot of its plane far outside.
const FAR_FROM_FOOT: f64 = -0.3;
/// Edges of the pyramids that model round cones.
const PYRAMID_EDGES: usize = 24;
/// Facets that are linearised, the weakest first.
const FACETS: usize = 40;

/// Q of contacts on a surface: the convention with everything the surface decides filled in.
#[derive(Clone, Debug)]
pub struct Objective {
    resolved: ResolvedConvention,
    workspace: Workspace,
    /// For round cones.
    pyramids: Option<Pyramids>,
    contacts: Vec<Contact>,
    evaluations: usize,
    scratch: Scratch,
}

/// What stands for round cones in the model of a step: their hull has no facets, and the one face
/// that the ball touches slides along it as the grasp moves. The facets of inscribed pyramids that
/// are nearly the nearest show how far, to the 1 per cent that they cut off.
#[derive(Clone, Debug)]
struct Pyramids {
    convention: Convention,
    workspace: Workspace,
}

impl Pyramids {
    /// None for a convention that has pyramids itself.
    fn of(convention: &Convention) -> Option<Self> {
        matches!(convention.edges, Edges::Round { .. }).then(|| Self {
            convention: Convention {
                edges: Edges::Polygon(PYRAMID_EDGES),
                ..convention.clone()
            },
            workspace: Workspace::with_warm_start(),
        })
    }

    /// The facets near the nearest one; returns the offset of that one.
    fn near_facets(
        &mut self,
        contacts: &[Contact],
        centre: &Point3<f64>,
        facets: &mut Vec<ActiveFacet>,
    ) -> Result<f64, QualityError> {
        // Edges that turn with the grasp: no direction of space is preferred.
        let along = contacts
            .iter()
            .enumerate()
            .fold(Vector3::zeros(), |sum, (k, c)| {
                sum + (c.position - contacts[0].position) * k as f64
            });
        self.convention.tangent = match along.try_normalize(0.0) {
            Some(axis) => TangentRule::Projected(axis),
            None => TangentRule::LeastAligned,
        };
        let model = GraspModel::new(contacts, centre, &self.convention);
        let nearest = grasp::margin(&model, &mut self.workspace)?.value;
        let band = BAND * nearest.max(0.0) + 1e-3;
        grasp::near_active_facets(&model, band, &mut self.workspace, facets)?;
        // Whether a facet far from its own foot is found depends on the way of the search.
        facets.retain(|f| f.carriers().iter().all(|c| c.weight >= FAR_FROM_FOOT));
        Ok(nearest)
    }
}

/// What linearisations reuse.
#[derive(Clone, Debug, Default)]
struct Scratch {
    /// The margin computed last, and where.
    last: Option<Margin>,
    at: Vec<Direction>,
    facets: Vec<ActiveFacet>,
    slopes: Vec<Differential>,
    gradient: Gradient,
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
            resolved,
            workspace: Workspace::with_warm_start(),
            contacts: Vec::new(),
            evaluations: 0,
            scratch: Scratch::default(),
        }
    }

    /// The same quality with another friction coefficient: what is still closed under a smaller one
    /// has that much of its friction cones to spare.
    pub fn with_friction(&self, friction: f64) -> Self {
        Self::of(self.resolved.with_friction(friction))
    }

    /// The convention with its torque length resolved.
    pub fn convention(&self) -> &Convention {
        self.resolved.convention()
    }

    /// The point about which torques are taken, centred frame, metres.
    pub fn centre(&self) -> Point3<f64> {
        self.resolved.centre()
    }

    /// How many qualities have been computed so far.
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// Forgets the grasps before: the answers that follow do not depend on them, to the last bit.
    ///
    /// Otherwise a search goes on from the last one ([`Workspace::with_warm_start`]).
    pub fn forget(&mut self) {
        self.workspace.forget();
        if let Some(pyramids) = &mut self.pyramids {
            pyramids.workspace.forget();
        }
        self.scratch.last = None;
    }

    /// The full answer for a list of contacts.
    pub fn epsilon(&mut self, contacts: &[Contact]) -> Result<Epsilon, QualityError> {
        self.evaluations += 1;
        let centre = self.resolved.centre();
        let model = GraspModel::new(contacts, &centre, self.resolved.convention());
        grasp::epsilon(&model, &mut self.workspace)
    }

    /// Q, or minus the distance from force closure, with the facet that decides.
    pub fn margin(&mut self, contacts: &[Contact]) -> Result<Margin, QualityError> {
        self.evaluations += 1;
        let centre = self.resolved.centre();
        let model = GraspModel::new(contacts, &centre, self.resolved.convention());
        grasp::margin(&model, &mut self.workspace)
    }

    /// The facets whose offset is within `band` of Q, the nearest first; none for an open grasp.
    pub fn near_active_facets(
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

    /// How a facet's offset changes with the contacts and their normals.
    pub fn facet_gradient(
        &self,
        contacts: &[Contact],
        facet: &ActiveFacet,
        frame: FrameRule,
        gradient: &mut Gradient,
    ) -> Result<(), QualityError> {
        let centre = self.resolved.centre();
        let model = GraspModel::new(contacts, &centre, self.resolved.convention());
        Ok(grasp::facet_gradient(&model, facet, frame, gradient)?)
    }

    /// Q ≥ 0 of contacts; 0 when they are not force-closed, whatever the convention prints then.
    pub fn quality(&mut self, contacts: &[Contact]) -> Result<f64, QualityError> {
        Ok(self.epsilon(contacts)?.quality)
    }

    /// Q at directions of a surface.
    pub fn quality_at(
        &mut self,
        surface: &impl Surface,
        directions: &[Direction],
    ) -> Result<f64, QualityError> {
        let mut contacts = std::mem::take(&mut self.contacts);
        contacts.clear();
        contacts.extend(directions.iter().map(|p| contact_on(surface, p)));
        let quality = self.quality(&contacts);
        self.contacts = contacts;
        quality
    }
}

/// The epsilon quality, and minus the distance from closure of open grasps; slopes by the chain rule
/// dQ = Σᵢ (df(pᵢ)ᵀ ∂Q/∂cᵢ + dn(pᵢ)ᵀ ∂Q/∂nᵢ) · uᵢ through the facets that are nearly the nearest.
///
/// An objective belongs to the surface that it was made on.
impl<S: Surface> Quality<S> for Objective {
    fn value(&mut self, surface: &S, contacts: &[Direction]) -> Result<f64, QualityError> {
        self.margin_at(surface, contacts).map(|margin| margin.value)
    }

    fn linearise(
        &mut self,
        surface: &S,
        contacts: &[Direction],
        pieces: &mut LinearPieces,
    ) -> Result<(), QualityError> {
        pieces.reset(contacts.len());
        let margin = match self.scratch.last {
            Some(margin) if self.scratch.at == contacts => margin,
            _ => self.margin_at(surface, contacts)?,
        };
        self.differentiate(surface, contacts);
        let mut facets = std::mem::take(&mut self.scratch.facets);
        facets.clear();
        let mut floor = margin.value;
        if !margin.closed {
            facets.push(margin.facet);
        } else if let Some(mut pyramids) = self.pyramids.take() {
            let found = pyramids.near_facets(&self.contacts, &self.resolved.centre(), &mut facets);
            self.pyramids = Some(pyramids);
            floor = found?;
            self.chain(contacts, &margin.facet, pieces.push(0.0))?;
        } else {
            let band = BAND * margin.value + 1e-3;
            let realised = std::mem::take(&mut self.contacts);
            let found = self.near_active_facets(&realised, band, &mut facets);
            self.contacts = realised;
            found?;
        }
        facets.truncate(FACETS);
        for facet in &facets {
            self.chain(contacts, facet, pieces.push(facet.offset - floor))?;
        }
        self.scratch.facets = facets;
        Ok(())
    }

    fn slope(
        &mut self,
        surface: &S,
        contacts: &[Direction],
        slope: &mut [f64],
    ) -> Result<(), QualityError> {
        let margin = match self.scratch.last {
            Some(margin) if self.scratch.at == contacts => margin,
            _ => self.margin_at(surface, contacts)?,
        };
        self.differentiate(surface, contacts);
        self.chain(contacts, &margin.facet, slope)
    }

    fn walls(
        &mut self,
        surface: &S,
        side: &[Direction],
        contacts: &[Direction],
        walls: &mut LinearPieces,
    ) {
        walls.reset(contacts.len());
        if !matches!(self.resolved.convention().edges, Edges::Polygon(_)) {
            return;
        }
        let rule = self.resolved.convention().tangent;
        for (i, (s, p)) in side.iter().zip(contacts).enumerate() {
            let at = surface.differential(p);
            let side = if s == p {
                at.inward_normal
            } else {
                surface.contact(s).1
            };
            for (slack, by_normal) in rule.discontinuities(&side, &at.inward_normal) {
                let slope = in_frame(p, &(at.normal_slope.transpose() * by_normal));
                walls.push(slack)[2 * i..2 * i + 2].copy_from_slice(&slope);
            }
        }
    }

    fn forget(&mut self) {
        Objective::forget(self);
    }

    fn evaluations(&self) -> usize {
        self.evaluations
    }

    fn stable_above(&self) -> f64 {
        self.resolved.convention().stable_above
    }
}

impl Objective {
    fn margin_at(
        &mut self,
        surface: &impl Surface,
        directions: &[Direction],
    ) -> Result<Margin, QualityError> {
        let mut contacts = std::mem::take(&mut self.contacts);
        contacts.clear();
        contacts.extend(directions.iter().map(|p| contact_on(surface, p)));
        let margin = self.margin(&contacts);
        self.contacts = contacts;
        self.scratch.last = margin.as_ref().ok().copied();
        self.scratch.at.clear();
        self.scratch.at.extend_from_slice(directions);
        margin
    }

    /// f, n and their derivatives at the contacts.
    fn differentiate(&mut self, surface: &impl Surface, directions: &[Direction]) {
        self.scratch.slopes.clear();
        self.contacts.clear();
        for p in directions {
            let at = surface.differential(p);
            self.contacts.push(Contact {
                position: at.position,
                inward_normal: at.inward_normal,
            });
            self.scratch.slopes.push(at);
        }
    }

    /// The slope of one facet's offset along the contacts' tangent frames.
    fn chain(
        &mut self,
        directions: &[Direction],
        facet: &ActiveFacet,
        slope: &mut [f64],
    ) -> Result<(), QualityError> {
        let mut gradient = std::mem::take(&mut self.scratch.gradient);
        // The pyramids in round cones have no frames of their own.
        let frame = match self.resolved.convention().edges {
            Edges::Polygon(_) => FrameRule::Tangent,
            Edges::Round { .. } => FrameRule::Transported,
        };
        let result = self.facet_gradient(&self.contacts, facet, frame, &mut gradient);
        if result.is_ok() {
            for (i, at) in self.scratch.slopes.iter().enumerate() {
                let by_move = at.position_slope.transpose() * gradient.positions[i]
                    + at.normal_slope.transpose() * gradient.normals[i];
                slope[2 * i..2 * i + 2].copy_from_slice(&in_frame(&directions[i], &by_move));
            }
        }
        self.scratch.gradient = gradient;
        result
    }
}
