//! Inscribed pyramids that linearise the quality under round cones.

use grasp::{
    ActiveFacet, Contact, Convention, Edges, GraspModel, QualityError, TangentRule, Workspace,
};
use nalgebra::{Point3, Vector3};

/// Number of edges of the pyramids that model round cones; they cut off about 1 % of the cone.
const PYRAMID_EDGES: usize = 24;
/// Least weight of a facet's carriers. Below it the foot of the facet's plane lies far outside the
/// facet.
const FAR_FROM_FOOT: f64 = -0.3;

/// Inscribed pyramids in place of round cones, used only in the linear model of a step.
///
/// The hull of round cones has no facets: the face that the ball touches moves along the hull with
/// the grasp. The nearest facets of inscribed pyramids linearise that motion. The error is the 1 %
/// that the pyramids cut off.
#[derive(Clone, Debug)]
pub(super) struct Pyramids {
    convention: Convention,
    workspace: Workspace,
}

impl Pyramids {
    /// `None` for a convention that has pyramids itself.
    pub(super) fn of(convention: &Convention) -> Option<Self> {
        matches!(convention.edges, Edges::Round { .. }).then(|| Self {
            convention: Convention {
                edges: Edges::Polygon(PYRAMID_EDGES),
                ..convention.clone()
            },
            workspace: Workspace::with_warm_start(),
        })
    }

    /// Writes the facets near the nearest one to `facets`; returns the offset of the nearest.
    pub(super) fn near_facets(
        &mut self,
        contacts: &[Contact],
        centre: &Point3<f64>,
        facets: &mut Vec<ActiveFacet>,
    ) -> Result<f64, QualityError> {
        // The edges turn with the grasp, so that no direction of space is preferred.
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
        // Whether such a facet is found depends on the path of the search, so all of them are
        // removed.
        facets.retain(|f| f.carriers().iter().all(|c| c.weight >= FAR_FROM_FOOT));
        Ok(nearest)
    }

    pub(super) fn forget(&mut self) {
        self.workspace.forget();
    }
}
