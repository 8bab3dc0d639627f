//! The L^∞ quality: every contact may press with its own unit normal force.

use super::epsilon::{Epsilon, QualityError};
use super::workspace::{Workspace, requested_gap};
use crate::cone::Cone;
use crate::grasp_model::GraspModel;
use crate::hull::plane::{V6, add_scaled, dot};
use crate::hull::support::{Extent, Support};

/// The radius of the largest origin-centred ball in the Minkowski sum over contacts of
/// Conv({0} ∪ {w_ij}_j) (Ferrari and Canny's L^∞), for polygonal and round cones alike.
///
/// The support function of a sum is the sum of the support functions, so the (k+1)^m sums are never
/// listed: an expansion costs no more than for the L¹ hull, though more of them are needed.
pub fn epsilon_linf(
    model: &GraspModel<'_>,
    workspace: &mut Workspace,
) -> Result<Epsilon, QualityError> {
    workspace.load(model)?;
    let gap = requested_gap(model.convention.edges);
    let reach: f64 = workspace.cones.iter().map(Cone::reach).sum();
    let toward = workspace
        .cones
        .iter()
        .fold([0.0; 6], |s, c| add_scaled(&s, 1.0, &c.base));
    let extent = Extent {
        toward,
        reach,
        rounding: workspace.cones.len() as f64 * workspace.rounding(),
    };
    let ball = if workspace.round {
        let mut source = RoundSum(&workspace.cones);
        workspace.search.ball(&mut source, &extent, gap)
    } else {
        workspace.flat.clear();
        workspace.flat_tags.clear();
        for (index, &owner) in workspace.owners.iter().enumerate() {
            workspace.flat.push(workspace.points.get(index));
            workspace.flat_tags.push(owner);
        }
        let mut source = PolygonSum {
            points: &workspace.flat,
            owners: &workspace.flat_tags,
        };
        workspace.search.ball(&mut source, &extent, gap)
    };
    Ok(Epsilon::from_ball(&ball))
}

struct RoundSum<'a>(&'a [Cone]);

impl Support for RoundSum<'_> {
    fn support(&mut self, direction: &V6) -> (V6, u32) {
        let mut sum = [0.0; 6];
        for cone in self.0 {
            let (point, height) = cone.farthest(direction);
            if height > 0.0 {
                sum = add_scaled(&sum, 1.0, &point);
            }
        }
        (sum, 0)
    }
}

/// Points grouped by owner.
struct PolygonSum<'a> {
    points: &'a [V6],
    owners: &'a [u32],
}

impl Support for PolygonSum<'_> {
    fn support(&mut self, direction: &V6) -> (V6, u32) {
        let mut sum = [0.0; 6];
        let mut at = 0;
        while at < self.points.len() {
            let owner = self.owners[at];
            let mut best: Option<usize> = None;
            let mut high = 0.0;
            while at < self.points.len() && self.owners[at] == owner {
                let height = dot(&self.points[at], direction);
                if height > high {
                    (high, best) = (height, Some(at));
                }
                at += 1;
            }
            if let Some(best) = best {
                sum = add_scaled(&sum, 1.0, &self.points[best]);
            }
        }
        (sum, 0)
    }
}
