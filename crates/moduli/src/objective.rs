//! Grasp quality as a function of contacts on one surface, under one convention.

use grasp::{
    ActiveFacet, CentreRule, Contact, Convention, Epsilon, FrameRule, Gradient, Margin,
    QualityError, Setup, TorqueLength, Workspace,
};
use nalgebra::Point3;
use shape::Surface;
use sph::Direction;
use sph::direction::even_directions;

use crate::point::contact_on;

/// Points of the surface among which the farthest from the centre is sought.
const EXTENT_DIRECTIONS: usize = 2_000;

/// Q of contacts on a surface: the convention with everything the surface decides filled in.
#[derive(Clone, Debug)]
pub struct Objective {
    convention: Convention,
    centre: Point3<f64>,
    workspace: Workspace,
    contacts: Vec<Contact>,
    evaluations: usize,
}

impl Objective {
    /// Resolves the convention on a surface.
    ///
    /// `object_origin` is the origin of the user's frame in the centred frame; conventions with
    /// [`CentreRule::ObjectOrigin`] and [`CentreRule::Given`] take torques about it. The cloud mean
    /// is the origin of the centred frame. A torque length of `MaxContactDistance` becomes the
    /// largest distance of the surface from the centre, as the systems that use it define it.
    pub fn new(
        convention: &Convention,
        surface: &impl Surface,
        object_origin: &Point3<f64>,
    ) -> Self {
        let centre = match convention.centre {
            CentreRule::CloudMean => Point3::origin(),
            CentreRule::CentreOfMass => surface.centre_of_mass(),
            CentreRule::ObjectOrigin | CentreRule::Given => *object_origin,
        };
        let mut convention = convention.clone();
        if convention.torque_length == TorqueLength::MaxContactDistance {
            let reach = even_directions(EXTENT_DIRECTIONS)
                .iter()
                .map(|p| (surface.point(p) - centre).norm())
                .fold(0.0, f64::max);
            convention.torque_length = TorqueLength::Metres(reach);
        }
        Self {
            convention,
            centre,
            workspace: Workspace::new(),
            contacts: Vec::new(),
            evaluations: 0,
        }
    }

    /// The convention with its torque length resolved.
    pub fn convention(&self) -> &Convention {
        &self.convention
    }

    /// The point about which torques are taken, centred frame, metres.
    pub fn centre(&self) -> Point3<f64> {
        self.centre
    }

    /// How many qualities have been computed so far.
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// The full answer for a list of contacts.
    pub fn epsilon(&mut self, contacts: &[Contact]) -> Result<Epsilon, QualityError> {
        self.evaluations += 1;
        grasp::epsilon(
            contacts,
            &self.centre,
            &self.convention,
            &mut self.workspace,
        )
    }

    /// Q, or minus the distance from force closure, with the facet that decides.
    pub fn margin(&mut self, contacts: &[Contact]) -> Result<Margin, QualityError> {
        self.evaluations += 1;
        let setup = setup(contacts, &self.centre, &self.convention);
        grasp::margin(&setup, &mut self.workspace)
    }

    /// The facets whose offset is within `band` of Q, the nearest first; none for an open grasp.
    pub fn near_active_facets(
        &mut self,
        contacts: &[Contact],
        band: f64,
        facets: &mut Vec<ActiveFacet>,
    ) -> Result<(), QualityError> {
        self.evaluations += 1;
        let setup = setup(contacts, &self.centre, &self.convention);
        grasp::near_active_facets(&setup, band, &mut self.workspace, facets)
    }

    /// How a facet's offset changes with the contacts and their normals.
    pub fn facet_gradient(
        &self,
        contacts: &[Contact],
        facet: &ActiveFacet,
        frame: FrameRule,
        gradient: &mut Gradient,
    ) -> Result<(), QualityError> {
        let setup = setup(contacts, &self.centre, &self.convention);
        Ok(grasp::facet_gradient(&setup, facet, frame, gradient)?)
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

/// A grasp of the convention's own hard fingers.
fn setup<'a>(
    contacts: &'a [Contact],
    centre: &'a Point3<f64>,
    convention: &'a Convention,
) -> Setup<'a> {
    Setup {
        contacts,
        centre,
        convention,
        fingers: &[],
    }
}
