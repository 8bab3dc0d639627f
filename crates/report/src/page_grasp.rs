//! The content of the page of one object.

use crate::check;
use crate::error::ReportError;
use crate::mesh::Mesh;

/// The content of the page of one object. All points are in one frame, in metres.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GraspPage {
    /// Name of the object: title and heading.
    pub title: String,
    /// Lines below the heading: size, certified radius bounds, convention, time.
    pub subtitle_lines: Vec<String>,
    /// The surface of the object.
    pub mesh: Mesh,
    /// The parts of the surface that close holes of the object, in another colour; not part of `mesh`. May be
    /// empty.
    pub closed_holes: Mesh,
    /// The measured cloud (n × 3); at most 4,000 of its points are drawn. May be empty.
    pub cloud: Vec<[f64; 3]>,
    /// Coefficient of friction μ ≥ 0; the friction cones have half angle atan μ, and 0 draws none.
    pub friction: f64,
    /// The grasps, best first: rank 1 is entry 0. May be empty.
    pub grasps: Vec<PageGrasp>,
}

/// One grasp on a [`GraspPage`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PageGrasp {
    /// A short name; may be empty.
    pub label: String,
    /// The quality by which the grasps are ranked.
    pub quality: f64,
    /// Proved lower bound of the quality.
    pub lower: f64,
    /// Origin of the grasp, such as `"transfer from S5"` or `"synthesis"`.
    pub source: String,
    /// Contact points (m × 3), metres.
    pub contacts: Vec<[f64; 3]>,
    /// Inward normals at the contacts (m × 3), of any positive length.
    pub inward_normals: Vec<[f64; 3]>,
    /// Distances of the contacts from the nearest point of the cloud, metres; empty without a cloud.
    pub distances_to_cloud: Vec<f64>,
    /// The unit wrench that the grasp resists least.
    pub weakest: Option<WeakestWrench>,
    /// The pose of the palm and the joints as text to copy; empty without a hand.
    pub pose: String,
    /// Further facts as name and value, such as the joint angles of a hand.
    pub details: Vec<(String, String)>,
    /// The hand at the grasp, metres. It enlarges the page, so give it for the best few grasps
    /// only.
    pub hand: Option<Mesh>,
}

/// The unit wrench normal to the facet nearest to the origin: what the grasp resists least.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeakestWrench {
    /// Force part.
    pub force: [f64; 3],
    /// Torque part, divided by the torque length.
    pub torque: [f64; 3],
}

impl GraspPage {
    pub(crate) fn check(&self) -> Result<(), ReportError> {
        self.mesh.check("mesh")?;
        if !self.closed_holes.triangles.is_empty() {
            self.closed_holes.check("closed holes")?;
        }
        check::finite_points("cloud", &self.cloud)?;
        if !(self.friction.is_finite() && self.friction >= 0.0) {
            return Err(ReportError::OutOfRange {
                place: "friction".to_owned(),
                value: self.friction,
                expected: "a finite number, at least 0",
            });
        }
        for (index, grasp) in self.grasps.iter().enumerate() {
            grasp.check(&format!("grasp {index}"))?;
        }
        Ok(())
    }
}

impl PageGrasp {
    fn check(&self, place: &str) -> Result<(), ReportError> {
        check::finite(&format!("{place}: quality"), &[self.quality, self.lower])?;
        check::finite(
            &format!("{place}: distances to the cloud"),
            &self.distances_to_cloud,
        )?;
        if let Some(weakest) = &self.weakest {
            let parts = [weakest.force, weakest.torque];
            check::finite_points(&format!("{place}: weakest wrench"), &parts)?;
        }
        check::finite_points(&format!("{place}: contacts"), &self.contacts)?;
        let normals = format!("{place}: normals");
        check::same_length(&normals, self.contacts.len(), self.inward_normals.len())?;
        check::finite_points(&normals, &self.inward_normals)?;
        if self.inward_normals.contains(&[0.0; 3]) {
            return Err(ReportError::OutOfRange {
                place: normals,
                value: 0.0,
                expected: "a length above zero",
            });
        }
        match &self.hand {
            None => Ok(()),
            Some(hand) => hand.check(&format!("{place}: hand")),
        }
    }
}
