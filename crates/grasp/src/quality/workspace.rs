//! Caller-owned scratch: a grasp laid out as cones and points, and the search over them.

use super::facet::ActiveFacet;
use crate::cone::{Cone, RoundSource, toward};
use crate::convention::{Convention, Edges};
use crate::friction::angle;
use crate::grasp_model::GraspModel;
use crate::hull::min_norm::{Effort, Nearest};
use crate::hull::plane::V6;
use crate::hull::search::{Ball, RELATIVE_TOLERANCE, Search};
use crate::hull::support::{Extent, PointSet, Support};
use crate::wrench::{Wrench, WrenchError};

/// Scratch of quality computations: make one for each thread and pass it to every call.
///
/// It grows to the largest grasp seen and then no call allocates.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    pub(crate) cones: Vec<Cone>,
    /// The cones at a friction coefficient of one, and their number of edges, 0 for round ones.
    unit_cones: Vec<Cone>,
    edges: usize,
    pub(crate) points: PointSet,
    /// The contact of each point.
    pub(crate) owners: Vec<u32>,
    pub(crate) search: Search,
    order: Vec<u32>,
    circle: Vec<(f64, f64)>,
    pub(crate) round: bool,
    /// How far any computed wrench may be from the exact one.
    wrench_rounding: f64,
    warm_start: bool,
    /// Whether the polytope of the last search belongs to the points as they were then.
    fits: bool,
    owners_before: Vec<u32>,
    /// Facets up to some level, and those of them that were taken.
    pub(crate) near: Vec<u32>,
    pub(crate) taken: Vec<u32>,
    /// The vertices of one plane, and their tags.
    pub(crate) flat: Vec<V6>,
    pub(crate) flat_tags: Vec<u32>,
}

impl Workspace {
    /// Empty scratch.
    pub fn new() -> Self {
        Self::default()
    }

    /// Scratch for one grasp that moves: each search of a pyramid's epsilon, margin or near-active
    /// facets goes on from where the last one ended.
    ///
    /// Answers agree with those of [`Workspace::new`] to rounding, not to the last bit: they depend
    /// on the grasps before. The nearer those are the less is computed, next to nothing for the steps
    /// of differences; far ones cost a new search.
    pub fn with_warm_start() -> Self {
        Self {
            warm_start: true,
            ..Self::default()
        }
    }

    /// Forgets the last grasp: what comes next does not depend on what was before.
    pub fn forget(&mut self) {
        self.fits = false;
    }

    /// The facets that the last search made: what its cost is proportional to.
    pub fn facets_made(&self) -> usize {
        self.search.polytope.created
    }

    /// [`Workspace::load`], in the last grasp's order of contacts where its polytope may serve again.
    pub(crate) fn load_next(&mut self, model: &GraspModel<'_>) -> Result<(), WrenchError> {
        let Edges::Polygon(count) = model.convention.edges else {
            return self.load(model);
        };
        if !(self.warm_start && self.fits && self.order.len() == model.contacts.len()) {
            return self.load(model);
        }
        self.fits = false;
        let length = model.validate()?;
        self.lay_out_cones(model, length);
        std::mem::swap(&mut self.owners, &mut self.owners_before);
        self.lay_out_points(count);
        if self.owners != self.owners_before {
            return self.load(model);
        }
        self.fits = true;
        Ok(())
    }

    /// Lays out a grasp. Contacts are taken in the order of their coordinates, so that results are
    /// the same to the last bit in whatever order they come.
    pub(crate) fn load(&mut self, model: &GraspModel<'_>) -> Result<(), WrenchError> {
        self.fits = false;
        let length = model.validate()?;
        self.order.clear();
        self.order.extend(0..model.contacts.len() as u32);
        let key = |&i: &u32| {
            let c = &model.contacts[i as usize];
            let (p, n) = (&c.position, &c.inward_normal);
            [p.x, p.y, p.z, n.x, n.y, n.z]
        };
        self.order.sort_unstable_by(|a, b| {
            let pairs = key(a).into_iter().zip(key(b));
            pairs.fold(std::cmp::Ordering::Equal, |o, (x, y)| {
                o.then(x.total_cmp(&y))
            })
        });
        self.lay_out_cones(model, length);
        self.round = match model.convention.edges {
            Edges::Round { .. } => true,
            Edges::Polygon(count) => {
                self.lay_out_points(count);
                false
            }
        };
        Ok(())
    }

    /// Empties the layout for cones that the caller adds one by one.
    pub(crate) fn start_cones(&mut self, model: &GraspModel<'_>) -> Result<(), WrenchError> {
        model.validate()?;
        self.fits = false;
        self.round = true;
        self.cones.clear();
        self.wrench_rounding = 0.0;
        Ok(())
    }

    /// Lays out a grasp whose friction is changed by [`Workspace::set_friction`].
    pub(crate) fn load_for_friction(&mut self, model: &GraspModel<'_>) -> Result<(), WrenchError> {
        self.load(model)?;
        let unit = Convention {
            friction: 1.0,
            ..model.convention.clone()
        };
        self.load(&GraspModel {
            convention: &unit,
            ..*model
        })?;
        self.unit_cones.clone_from(&self.cones);
        self.edges = match unit.edges {
            Edges::Polygon(count) => count,
            Edges::Round { .. } => 0,
        };
        Ok(())
    }

    /// Gives all cones that were laid out a friction coefficient.
    pub(crate) fn set_friction(&mut self, friction: f64) {
        self.fits = false;
        for (cone, unit) in self.cones.iter_mut().zip(&self.unit_cones) {
            *cone = unit.with_friction(friction);
        }
        let roundings = self.cones.iter().map(|c| c.rounding);
        self.wrench_rounding = roundings.fold(0.0, f64::max);
        if !self.round {
            self.lay_out_points(self.edges);
        }
    }

    /// The friction up to which no wrench reaches farther than 0 along a direction, infinite where none
    /// ever does. Contacts whose wrenches are orthogonal to it up to rounding are left out.
    pub(crate) fn separates_until(&self, direction: &V6) -> f64 {
        let ratio = |cone: &Cone| {
            let along = cone.height_of_normal(direction);
            let across = match self.round {
                true => cone.slope(direction),
                false => cone.largest_edge(direction, &self.circle),
            };
            if along.abs().max(across) <= ORTHOGONAL * cone.reach() {
                f64::INFINITY
            } else if along > 0.0 {
                0.0
            } else {
                -along / across
            }
        };
        self.unit_cones
            .iter()
            .map(ratio)
            .fold(f64::INFINITY, f64::min)
    }

    pub(crate) fn add_cone(&mut self, cone: Cone) {
        self.wrench_rounding = self.wrench_rounding.max(cone.rounding);
        self.cones.push(cone);
    }

    /// The largest ball in the hull of the cones that were added.
    pub(crate) fn round_ball(&mut self, gap: f64) -> Ball {
        self.ball_anew(gap)
    }

    fn lay_out_cones(&mut self, model: &GraspModel<'_>, length: f64) {
        self.cones.clear();
        for &contact in &self.order {
            self.cones
                .extend(Cone::all(model, contact as usize, length));
        }
        let roundings = self.cones.iter().map(|c| c.rounding);
        self.wrench_rounding = roundings.fold(0.0, f64::max);
    }

    /// Lays out a plain list of wrenches, each its own owner.
    pub(crate) fn load_wrenches(&mut self, wrenches: &[Wrench]) {
        self.fits = false;
        self.round = false;
        self.wrench_rounding = 0.0;
        self.points.clear();
        self.owners.clear();
        for (index, wrench) in wrenches.iter().enumerate() {
            self.points.push(&(*wrench).into());
            self.owners.push(index as u32);
        }
    }

    fn lay_out_points(&mut self, count: usize) {
        if self.circle.len() != count {
            self.circle.clear();
            self.circle.extend((0..count).map(|j| {
                let (sin, cos) = angle(j, count).sin_cos();
                (cos, sin)
            }));
        }
        self.points.clear();
        self.owners.clear();
        for cone in &self.cones {
            for point in cone.corners(&self.circle) {
                self.points.push(&point);
                self.owners.push(cone.contact);
            }
        }
    }

    /// The largest ball about the origin in what was laid out.
    pub(crate) fn ball(&mut self, gap: f64) -> Ball {
        let rounding = self.rounding();
        if self.fits
            && let Some(ball) = self.search.ball_again(&self.points, rounding)
        {
            return ball;
        }
        self.ball_anew(gap)
    }

    fn ball_anew(&mut self, gap: f64) -> Ball {
        let ball = self.search_ball(gap);
        self.fits = self.warm_start && !self.round && ball.closed;
        ball
    }

    fn search_ball(&mut self, gap: f64) -> Ball {
        let (reach, rounding) = (self.reach(), self.rounding());
        let extent = |toward: V6| Extent {
            toward,
            reach,
            rounding,
        };
        if self.round {
            let mut source = RoundSource(&self.cones);
            let extent = extent(toward(&self.cones));
            self.search.ball(&mut source, &extent, gap)
        } else {
            let extent = extent(*self.points.sum());
            self.search.ball(&mut &self.points, &extent, gap)
        }
    }

    /// How far a computed height along a computed unit vector may be from the exact one: the error of
    /// the wrench, of six products and five sums, and of the vector's length.
    pub(crate) fn rounding(&self) -> f64 {
        self.wrench_rounding + HEIGHT_ROUNDING * self.reach()
    }

    /// The point nearest to the origin of what was laid out.
    pub(crate) fn nearest(&mut self) -> Nearest {
        let tolerance = 1e-14 * self.reach();
        let corral = &mut self.search.corral;
        if self.round {
            let start = toward(&self.cones);
            corral.nearest(
                &mut RoundSource(&self.cones),
                &start,
                Effort::Converge,
                tolerance,
            )
        } else {
            let start = *self.points.sum();
            corral.nearest(&mut &self.points, &start, Effort::Converge, tolerance)
        }
    }

    /// The face of round cones that the ball of the last search touches, if one was found.
    pub(crate) fn touching(&self, ball: &Ball) -> Option<ActiveFacet> {
        if !self.round {
            return None;
        }
        let polytope = &self.search.polytope;
        let normal = polytope.facets[ball.facet].plane.normal;
        let shares = polytope.shares(ball.facet);
        let here = shares.and_then(|s| RoundSource(&self.cones).touching(&normal, &s));
        let caps = self.search.caps.iter().filter(|cap| cap.touches);
        let caps = caps.map(|cap| cap.touching);
        let nearest = caps
            .chain(here)
            .filter(|t| (ball.lower..=ball.upper).contains(&t.offset))
            .min_by(|a, b| a.offset.total_cmp(&b.offset))?;
        let carriers = nearest.parts().iter().map(|part| {
            let cone = &self.cones[part.cone];
            (cone.contact as usize, cone.at(&part.place), part.weight)
        });
        Some(ActiveFacet::new(
            nearest.offset,
            &nearest.direction,
            carriers,
        ))
    }

    /// Goes on until every facet up to `level` is final; returns the nearest.
    pub(crate) fn finish(&mut self, level: f64, gap: f64) -> usize {
        let tolerance = self.reach() * RELATIVE_TOLERANCE;
        let search = &mut self.search;
        let done = if self.round {
            search.polytope.uncover();
            search.finish(&mut RoundSource(&self.cones), level, gap, tolerance)
        } else {
            search.finish(&mut &self.points, level, gap, tolerance)
        };
        if !done && self.ball_anew(gap).closed {
            return self.finish(level, gap);
        }
        self.search.polytope.nearest()
    }

    /// The length of the longest wrench, or a little more.
    pub(crate) fn reach(&self) -> f64 {
        if self.round {
            self.cones.iter().map(Cone::reach).fold(0.0, f64::max)
        } else {
            self.points.reach()
        }
    }

    /// The contact that a vertex belongs to.
    pub(crate) fn owner(&self, tag: u32) -> usize {
        if self.round {
            self.cones[tag as usize].contact as usize
        } else {
            self.owners[tag as usize] as usize
        }
    }
}

/// Wrenches reach this far, relative to the longest, along directions that are orthogonal to them.
const ORTHOGONAL: f64 = 1e-12;

/// Rounding of a height, relative to the longest wrench.
const HEIGHT_ROUNDING: f64 = 12.0 * f64::EPSILON;

/// The width of interval that a convention asks for.
pub(crate) fn requested_gap(edges: Edges) -> f64 {
    match edges {
        Edges::Polygon(_) => 0.0,
        Edges::Round { tolerance } => tolerance,
    }
}
