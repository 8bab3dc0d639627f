//! How quality is measured on one object, and when a grasp is stable.

use grasp::{Contact, Convention, Epsilon, GraspModel, QualityError, Uncertainty, Workspace};
use hand::{Hand, TipModel};
use nalgebra::Point3;
use shape::{Evidence, PAD_RADIUS, PointCloud, Support};
use space::point::contacts_on;
use space::{Constraints, MonotoneAscent, Objective, ResolvedConvention};
use sph::Direction;

use crate::error::Error;
use crate::grasp::{Grasp, Source};
use crate::object::Object;

/// A convention resolved on one object.
///
/// It owns the centre of torques, the torque length, and the threshold from which a grasp is stable.
/// The threshold belongs to the convention: 0.01 under `paper`, and under every other one a grasp is
/// stable when its proved lower bound is positive.
#[derive(Clone, Debug)]
pub struct Measure<'a> {
    object: &'a Object,
    rule: Convention,
    resolved: ResolvedConvention,
    tips: Option<TipModel>,
    support: Option<Support>,
}

/// What the evidence of a cloud leaves uncertain about a contact: the distance of the data is the error
/// of the position, and the spread of its normals that of the normal.
pub fn uncertainty(evidence: &Evidence) -> Uncertainty {
    Uncertainty {
        position: evidence.distance,
        normal: evidence.normal_spread,
    }
}

impl Object {
    /// Resolves a convention on this object.
    ///
    /// # Errors
    /// A number of the convention is out of range.
    pub fn measure(&self, rule: &Convention) -> Result<Measure<'_>, Error> {
        Measure::new(self, rule)
    }
}

impl<'a> Measure<'a> {
    /// Resolves a rule on an object.
    ///
    /// # Errors
    /// A number of the convention is out of range.
    pub fn new(object: &'a Object, rule: &Convention) -> Result<Self, Error> {
        rule.validate()?;
        let origin = object.frame().cloud_origin();
        Ok(Self {
            object,
            rule: rule.clone(),
            resolved: ResolvedConvention::new(rule, object.shape(), &origin),
            tips: None,
            support: object.support().map(|s| object.frame().plane_to_centred(s)),
        })
    }

    /// The same on another plane than the object's own, given in the frame of the cloud, or on none: hands
    /// stay above it.
    #[must_use]
    pub fn with_support(self, support: Option<Support>) -> Self {
        let centred = |plane| self.object.frame().plane_to_centred(&plane);
        Self {
            support: support.map(centred),
            ..self
        }
    }

    /// The plane on which the object stands, in the centred frame.
    pub fn support(&self) -> Option<Support> {
        self.support
    }

    /// The same with contacts of this model. Without it contacts are points, and those of a hand what
    /// [`Hand::tip_model`] says; ascents and transfers take all contacts for points.
    #[must_use]
    pub fn with_tips(self, tips: TipModel) -> Self {
        Self {
            tips: Some(tips),
            ..self
        }
    }

    /// The measure of a hand's grasps: contacts as the hand has them where none were given.
    pub(crate) fn for_hand(&self, hand: &Hand) -> Self {
        let tips = self.tips.unwrap_or_else(|| hand.tip_model());
        self.clone().with_tips(tips)
    }

    /// What contacts transmit, apart from friction.
    pub fn tips(&self) -> TipModel {
        self.tips.unwrap_or_default()
    }

    /// The object.
    pub fn object(&self) -> &'a Object {
        self.object
    }

    /// The convention as it was given, which holds on any object.
    pub fn rule(&self) -> &Convention {
        &self.rule
    }

    /// The convention resolved on the object.
    pub fn convention(&self) -> &Convention {
        self.resolved.convention()
    }

    /// The point about which torques are taken, centred frame, metres.
    pub fn centre(&self) -> Point3<f64> {
        self.resolved.centre()
    }

    /// The quality above which a grasp is stable.
    pub fn stable_above(&self) -> f64 {
        self.convention().stable_above
    }

    /// Whether a quality, or a proved lower bound of one, is stable.
    pub fn is_stable(&self, quality: f64) -> bool {
        self.convention().is_stable(quality)
    }

    /// Quality as a function of contacts, for ascents.
    pub fn objective(&self) -> Objective {
        Objective::of(self.resolved.clone())
    }

    /// The epsilon quality of contacts in the centred frame, as a proved interval.
    ///
    /// # Errors
    /// A contact is not finite, or there are too few.
    pub fn epsilon(&self, contacts: &[Contact]) -> Result<Epsilon, Error> {
        Ok(self.epsilon_of(contacts)?)
    }

    fn epsilon_of(&self, contacts: &[Contact]) -> Result<Epsilon, QualityError> {
        self.with_model(contacts, |model| {
            grasp::epsilon(model, &mut Workspace::new())
        })
    }

    /// Calls a function with contacts in the centred frame as the grasp model of this measure, with its
    /// centre, its convention and its contact models.
    pub(crate) fn with_model<T>(
        &self,
        contacts: &[Contact],
        of: impl FnOnce(&GraspModel<'_>) -> T,
    ) -> T {
        let centre = self.centre();
        let friction = self.convention().friction;
        let models = self.tips().of_contacts(friction, contacts.len());
        let model = GraspModel::new(contacts, &centre, self.convention());
        of(&model.with_contact_models(&models))
    }

    /// The grasp with contacts in the given directions.
    ///
    /// # Errors
    /// A quality cannot be computed.
    pub fn grasp(&self, directions: &[Direction], source: Source) -> Result<Grasp, Error> {
        let contacts = contacts_on(self.object.field(), directions);
        let epsilon = self.epsilon_of(&contacts)?;
        let frame = *self.object.frame();
        Ok(Grasp::new(
            directions.to_vec(),
            contacts,
            epsilon,
            source,
            frame,
        ))
    }

    /// The grasp with these contacts, centred frame, in these directions.
    ///
    /// `quality` is what the search that found it reported, and what it is ranked by: a search that
    /// goes on from grasp to grasp differs from this one in the last digits.
    pub(crate) fn grasp_of(
        &self,
        directions: Vec<Direction>,
        contacts: Vec<Contact>,
        quality: f64,
        source: Source,
    ) -> Result<Grasp, QualityError> {
        let epsilon = Epsilon {
            quality,
            ..self.epsilon_of(&contacts)?
        };
        let frame = *self.object.frame();
        Ok(Grasp::new(directions, contacts, epsilon, source, frame))
    }

    /// The grasp with contacts at the surface points nearest in direction to the given points, in the
    /// frame of the cloud, metres.
    ///
    /// # Errors
    /// A point is not finite or lies at the centre of the object.
    pub fn grasp_at(&self, points: &[[f64; 3]]) -> Result<Grasp, Error> {
        let (directions, _) = self.object.directions_of(points)?;
        self.grasp(&directions, Source::Given)
    }

    /// What a cloud, in its own frame, says of the surface at each contact of a grasp, within a pad of
    /// 5 mm radius.
    pub fn evidence(&self, grasp: &Grasp, cloud: &PointCloud) -> Vec<Evidence> {
        let normals = grasp.contacts().iter().map(|c| c.inward_normal);
        let places = grasp.contacts_in_cloud().into_iter();
        places
            .zip(normals)
            .map(|(place, normal)| shape::evidence(cloud.points(), &place, &normal, PAD_RADIUS))
            .collect()
    }

    /// A proved lower bound of the epsilon quality on every surface whose contacts and normals agree with
    /// the evidence, one entry per contact: [`grasp::robust_quality`] with the [`uncertainty`] of each and
    /// the contact model of this measure. An unseen contact carries nothing; a grasp on edges has 0.
    ///
    /// # Errors
    /// There is another number of entries than of contacts, or the quality cannot be computed.
    pub fn robust(&self, grasp: &Grasp, evidence: &[Evidence]) -> Result<f64, Error> {
        let known: Vec<Uncertainty> = evidence.iter().map(uncertainty).collect();
        let robust = self.with_model(grasp.contacts(), |model| {
            grasp::robust_quality(model, &known, &mut Workspace::new())
        });
        Ok(robust?)
    }

    /// Raises the quality of a grasp by moving its contacts over the surface; never lowers it. The
    /// result has no hand. No contact goes to where the surface closes a hole.
    ///
    /// # Errors
    /// A quality cannot be computed.
    pub fn ascend(&self, grasp: &Grasp) -> Result<Grasp, Error> {
        let mut objective = self.objective();
        let start = grasp.directions();
        let field = self.object.field();
        let limits = Constraints {
            closed_holes: field.closed_patches().to_vec(),
            ..Constraints::default()
        };
        let climber = MonotoneAscent::default();
        let end = climber.climb_within(field, start, &mut objective, &limits, |_| {})?;
        self.grasp(&end.directions, grasp.source().clone())
    }
}
