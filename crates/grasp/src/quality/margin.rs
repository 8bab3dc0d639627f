//! The signed margin of a grasp and the facets that decide it.

use super::epsilon::QualityError;
use super::facet::ActiveFacet;
use super::workspace::{Workspace, requested_gap};
use crate::grasp_model::GraspModel;
use crate::hull::min_norm::{Corral, Effort, Nearest};
use crate::hull::plane::{V6, norm, scale, sub};
use crate::hull::search::Ball;
use crate::hull::support::PointList;
use nalgebra::{Matrix6, Vector6};

/// How far a grasp is from losing, or from gaining, force closure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margin {
    /// The epsilon quality of a closed grasp; minus the distance of the origin from the hull of an
    /// open one.
    pub value: f64,
    /// No larger than the true margin.
    pub lower: f64,
    /// No smaller than the true margin.
    pub upper: f64,
    /// Whether the origin lies strictly inside.
    pub closed: bool,
    /// The facet (of an open grasp: the face) nearest to the origin.
    pub facet: ActiveFacet,
}

/// The signed margin: epsilon inside, minus the distance outside, with the nearest facet.
///
/// An optimiser can start from an open grasp and cross into closure: the margin is continuous and
/// its gradient follows from the facet on both sides (`facet_gradient`). For round cones the facet is
/// the face that the ball touches, found to rounding by Newton's method where the touching point is
/// regular, whatever the width of the interval.
pub fn margin(model: &GraspModel<'_>, workspace: &mut Workspace) -> Result<Margin, QualityError> {
    workspace.load_next(model)?;
    let ball = workspace.ball(requested_gap(model.convention.edges));
    if !ball.closed {
        return Ok(outside(workspace, &ball));
    }
    let facet = match workspace.touching(&ball) {
        Some(touching) => touching,
        None if !workspace.search.domain.is_empty() => {
            // Some vertices of the nearest facet may be no wrenches: a search without symmetries.
            workspace.search.whole = true;
            let ball = workspace.ball(requested_gap(model.convention.edges));
            workspace.search.whole = false;
            closest(workspace, ball.facet)
        }
        None => closest(workspace, ball.facet),
    };
    Ok(Margin {
        value: ball.quality,
        lower: ball.lower,
        upper: ball.upper,
        closed: true,
        facet,
    })
}

/// The facets within `band` of the nearest one, that one first, then by their offsets; nothing for an
/// open grasp.
///
/// Q is the least of all facet offsets, so these are what a step of that size can bring into play.
/// Simplices of one plane are one facet where a whole pyramid's base makes them several; where points
/// of different contacts happen to lie in one plane they appear each, since they will part.
pub fn near_active_facets(
    model: &GraspModel<'_>,
    band: f64,
    workspace: &mut Workspace,
    out: &mut Vec<ActiveFacet>,
) -> Result<(), QualityError> {
    out.clear();
    workspace.search.whole = true;
    let found = margin(model, workspace);
    workspace.search.whole = false;
    let Margin { closed, facet, .. } = found?;
    if !closed {
        return Ok(());
    }
    out.push(facet);
    let gap = requested_gap(model.convention.edges);
    let level = facet.offset + band;
    let nearest = workspace.finish(level, gap);
    let mut near = std::mem::take(&mut workspace.near);
    let mut taken = std::mem::take(&mut workspace.taken);
    workspace.search.polytope.up_to(level, &mut near);
    taken.clear();
    taken.push(nearest as u32);
    for &at in &near {
        let offset = workspace.search.polytope.bound(at as usize);
        // Simplices of one plane follow one another in the order of offsets.
        let beside = |t: &u32| {
            let before = workspace.search.polytope.bound(*t as usize);
            offset - before <= ONE_PLANE * workspace.reach()
        };
        let mut before = taken
            .iter()
            .enumerate()
            .rev()
            .take_while(|(_, t)| beside(t));
        let same = before.find(|(_, t)| same_facet(workspace, **t as usize, at as usize));
        match same.map(|(place, _)| place) {
            Some(place) if holds_its_foot(&out[place]) => {}
            Some(place) => {
                // Of one facet's simplices the one that holds the foot, if any does.
                if let Some(facet) = simplex_facet(workspace, at as usize)
                    && holds_its_foot(&facet)
                {
                    out[place] = facet;
                }
            }
            None => {
                if let Some(facet) = simplex_facet(workspace, at as usize) {
                    taken.push(at);
                    out.push(facet);
                }
            }
        }
    }
    (workspace.near, workspace.taken) = (near, taken);
    Ok(())
}

/// Whether the point of a facet's plane nearest to the origin lies in the facet.
fn holds_its_foot(facet: &ActiveFacet) -> bool {
    facet.carriers().iter().all(|c| c.weight >= -1e-9)
}

/// Normals nearer than this belong to one plane.
const ONE_PLANE: f64 = 1e-9;

/// Whether two simplices lie in one plane and will go on doing so: what they have of each contact is
/// the same, or spans the same base of a pyramid.
fn same_facet(workspace: &Workspace, a: usize, b: usize) -> bool {
    let polytope = &workspace.search.polytope;
    let (one, other) = (&polytope.facets[a], &polytope.facets[b]);
    if norm(&sub(&one.plane.normal, &other.plane.normal)) > ONE_PLANE || workspace.round {
        return a == b;
    }
    let (one, other) = (one.vertices, other.vertices);
    let owner = |v: &u16| workspace.owner(polytope.tags[*v as usize]);
    let of = |list: &[u16; 6], contact| list.iter().filter(|v| owner(v) == contact).count();
    // A base is flat where there is no torsion: three of its points are as good as any.
    workspace.cones.iter().all(|cone| {
        let contact = cone.contact as usize;
        let flat = cone.axes[2] == [0.0; 6];
        let mine = |v: &&u16| owner(v) == contact;
        flat && of(&one, contact) >= 3 && of(&other, contact) >= 3
            || one.iter().filter(mine).eq(other.iter().filter(mine))
    })
}

/// The nearest face of a hull that does not hold the origin inside.
fn outside(workspace: &mut Workspace, ball: &Ball) -> Margin {
    let tolerance = 1e-12 * workspace.reach();
    let (point, floor) = match workspace.nearest() {
        Nearest::Outside { point, floor } => (point, floor.max(0.0)),
        Nearest::Inside => ([0.0; 6], 0.0),
    };
    let distance = norm(&point);
    let normal = if distance > tolerance {
        scale(&point, -1.0 / distance)
    } else {
        ball.direction
    };
    let corral = &workspace.search.corral;
    let carriers = corral_carriers(corral, |tag| workspace.owner(tag));
    Margin {
        value: -distance,
        lower: -distance,
        upper: if ball.upper > 0.0 {
            ball.upper
        } else {
            -floor.min(distance)
        },
        closed: false,
        facet: ActiveFacet::new(-distance, &normal, carriers),
    }
}

fn corral_carriers<'a>(
    corral: &'a Corral,
    owner: impl Fn(u32) -> usize + 'a,
) -> impl Iterator<Item = (usize, V6, f64)> + 'a {
    (0..corral.len).map(move |i| (owner(corral.tags[i]), corral.points[i], corral.weights[i]))
}

/// The nearest facet with convex weights, also where it has more than six vertices.
fn closest(workspace: &mut Workspace, facet: usize) -> ActiveFacet {
    if let Some(found) = simplex_facet(workspace, facet)
        && found.carriers().iter().all(|c| c.weight >= -1e-9)
    {
        return found;
    }
    // The foot lies in another simplex of the same plane: look over all its vertices.
    let plane = workspace.search.polytope.facets[facet].plane;
    let band = 1e-9 * workspace.reach();
    workspace.flat.clear();
    workspace.flat_tags.clear();
    let polytope = &workspace.search.polytope;
    for (vertex, &tag) in polytope.vertices.iter().zip(&polytope.tags) {
        if plane.height(vertex) >= -band {
            workspace.flat.push(*vertex);
            workspace.flat_tags.push(tag);
        }
    }
    let mut corral = Corral::default();
    let start = workspace.flat.first().copied().unwrap_or(plane.normal);
    corral.nearest(
        &mut PointList(&workspace.flat),
        &start,
        Effort::Converge,
        1e-14 * workspace.reach(),
    );
    let carriers = corral_carriers(&corral, |at| {
        workspace.owner(workspace.flat_tags[at as usize])
    });
    ActiveFacet::new(plane.offset, &plane.normal, carriers)
}

/// A facet with the barycentric coordinates of its plane's foot point; None if it is too thin to
/// have any.
fn simplex_facet(workspace: &Workspace, at: usize) -> Option<ActiveFacet> {
    let polytope = &workspace.search.polytope;
    let facet = &polytope.facets[at];
    let corners = polytope.corners(at);
    let matrix = Matrix6::from_fn(|i, j| corners[j][i]);
    let foot = Vector6::from(facet.plane.normal) * facet.plane.offset;
    let weights = matrix.lu().solve(&foot)?;
    // Too thin a simplex shows in weights that do not add up (or are not numbers at all).
    if (weights.sum() - 1.0).abs().total_cmp(&1e-6).is_gt() {
        return None;
    }
    let owners = facet
        .vertices
        .map(|v| workspace.owner(polytope.tags[v as usize]));
    let carriers = (0..6).map(|i| (owners[i], corners[i], weights[i]));
    Some(ActiveFacet::new(
        facet.plane.offset,
        &facet.plane.normal,
        carriers,
    ))
}
