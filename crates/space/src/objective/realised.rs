//! The contacts at given directions, and derivatives by those directions.

use grasp::{ActiveFacet, Contact, Edges, FrameRule, Gradient, GraspModel, QualityError};
use shape::{Differential, Surface};
use sph::Direction;

use crate::point::contact_on;
use crate::quality::in_frame;
use crate::resolved::ResolvedConvention;

/// The contacts at some directions, with their derivatives if those were requested.
#[derive(Clone, Debug, Default)]
pub(super) struct Realised {
    pub(super) contacts: Vec<Contact>,
    slopes: Vec<Differential>,
    gradient: Gradient,
}

impl Realised {
    /// Computes f and n at the directions.
    pub(super) fn place(&mut self, surface: &impl Surface, directions: &[Direction]) {
        self.contacts.clear();
        self.contacts
            .extend(directions.iter().map(|p| contact_on(surface, p)));
    }

    /// Computes f, n and their derivatives at the directions.
    pub(super) fn differentiate(&mut self, surface: &impl Surface, directions: &[Direction]) {
        self.slopes.clear();
        self.contacts.clear();
        for p in directions {
            let at = surface.differential(p);
            self.contacts.push(Contact {
                position: at.position,
                inward_normal: at.inward_normal,
            });
            self.slopes.push(at);
        }
    }

    /// The slope of one facet's offset in the tangent frames of the directions at which the
    /// contacts were differentiated last.
    pub(super) fn chain(
        &mut self,
        resolved: &ResolvedConvention,
        directions: &[Direction],
        facet: &ActiveFacet,
        slope: &mut [f64],
    ) -> Result<(), QualityError> {
        // The pyramids that model round cones have no tangent frame.
        let frame = match resolved.convention().edges {
            Edges::Polygon(_) => FrameRule::Tangent,
            Edges::Round { .. } => FrameRule::Transported,
        };
        let centre = resolved.centre();
        let model = GraspModel::new(&self.contacts, &centre, resolved.convention());
        grasp::facet_gradient(&model, facet, frame, &mut self.gradient)?;
        for (i, at) in self.slopes.iter().enumerate() {
            let by_move = at.position_slope.transpose() * self.gradient.positions[i]
                + at.normal_slope.transpose() * self.gradient.normals[i];
            slope[2 * i..2 * i + 2].copy_from_slice(&in_frame(&directions[i], &by_move));
        }
        Ok(())
    }
}
