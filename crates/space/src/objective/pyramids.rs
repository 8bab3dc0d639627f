//! Inscribed pyramids that linearise the quality under round cones.

use grasp::{
    ActiveFacet, Contact, Convention, Edges, GraspModel, QualityError, TangentRule, Workspace,
};
use nalgebra::{Point3, Vector3};

/// Edges of the pyramids that model round cones.
const PYRAMID_EDGES: usize = 24;
/// A facet with a weight below this has the foot of its plane far outside.
const FAR_FROM_FOOT: f64 = -0.3;

/// Inscribed pyramids in place of round cones in the model of a step.
///
/// The hull of round cones has no facets: the one face that the ball touches moves along it with the
/// grasp. The facets of inscribed pyramids that are nearly the nearest linearise that move, with an
/// error of the 1 per cent that the pyramids cut off.
#[derive(Clone, Debug)]
pub(super) struct Pyramids {
    convention: Convention,
    workspace: Workspace,
}

impl Pyramids {
    /// None for a convention that has pyramids itself.
    pub(super) fn of(convention: &Convention) -> Option<Self> {
        matches!(convention.edges, Edges::Round { .. }).then(|| Self {
            convention: Convention {
                edges: Edges::Polygon(PYRAMID_EDGES),
                ..convention.clone()
            },
            workspace: Workspace::with_warm_start(),
        })
    }

    /// The facets near the nearest one; returns the offset of that one.
    pub(super) fn near_facets(
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
        let band = super::band(nearest);
        grasp::near_active_facets(&model, band, &mut self.workspace, facets)?;
        // Whether a facet far from its own foot is found depends on the way of the search.
        facets.retain(|f| f.carriers().iter().all(|c| c.weight >= FAR_FROM_FOOT));
        Ok(nearest)
    }

    pub(super) fn forget(&mut self) {
        self.workspace.forget();
    }
}
