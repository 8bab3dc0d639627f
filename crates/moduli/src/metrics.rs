//! Quality metrics of one grasp: size, isotropy and robustness of its set of wrenches.

use grasp::hull::HullError;
use grasp::{
    Contact, Convention, Edges, Epsilon, GraspModel, QualityError, Resistance, Workspace, Wrench,
    WrenchError,
};
use nalgebra::Point3;

use crate::error::Error;
use crate::grasp::Grasp;
use crate::measure::Measure;

/// Largest friction coefficient in the search for the least one.
const MOST_FRICTION: f64 = 100.0;

/// All metrics of one grasp under one convention.
///
/// The unit of wrenches is that of the convention: a force, and a torque divided by the torque
/// length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metrics {
    /// Epsilon quality: the radius of the largest ball about 0 in the hull of the wrenches, with its
    /// proved interval (Ferrari and Canny 1992).
    pub epsilon: Epsilon,
    /// Volume of the hull of the wrenches, in the sixth power of the wrench unit; `None` for round
    /// cones, whose hull is not a polytope, and for hulls that are too large or that rounding does not let end.
    pub volume: Option<f64>,
    /// Epsilon quality when each contact force is bounded by itself (the L∞ norm of the forces)
    /// instead of their sum.
    pub linf: f64,
    /// The largest weight ℓ such that the edges balance with every weight at least ℓ, times their
    /// number; 1 when equal weights balance. `None` where no weights balance, and for round cones.
    pub min_weight: Option<f64>,
    /// The least friction coefficient at which the grasp is force-closed; `None` when it is open even
    /// at 100.
    pub least_friction: Option<f64>,
    /// Smallest singular value of the grasp map: 0 when some wrench cannot be made at all.
    pub smallest_singular_value: f64,
    /// The largest normal force among the contacts, per newton of load, when the grasp resists the
    /// worst of the six forces ±x, ±y, ±z through the centre; `None` when one of them cannot be
    /// resisted.
    pub normal_force_per_load: Option<f64>,
}

impl Metrics {
    /// Names of the columns of [`Metrics::row`].
    pub const COLUMNS: [&'static str; 9] = [
        "quality",
        "lower",
        "upper",
        "volume",
        "linf",
        "min_weight",
        "least_friction",
        "smallest_singular_value",
        "normal_force_per_load",
    ];

    /// Measures contacts about a centre. A torque length that is the largest contact distance is
    /// resolved on these contacts.
    ///
    /// # Errors
    /// A contact is not finite, a normal is not a unit vector, or there are fewer than two contacts.
    pub fn of(
        contacts: &[Contact],
        centre: &Point3<f64>,
        convention: &Convention,
    ) -> Result<Self, Error> {
        Self::of_model(&GraspModel::new(contacts, centre, convention))
    }

    /// Measures a grasp with the contact models that it names. The least friction is that of point
    /// contacts whatever the models.
    ///
    /// # Errors
    /// As [`Metrics::of`], and if a number of a contact model is out of range.
    pub fn of_model(model: &GraspModel<'_>) -> Result<Self, Error> {
        let polygonal = matches!(model.convention.edges, Edges::Polygon(_));
        let mut workspace = Workspace::new();
        let epsilon = grasp::epsilon(model, &mut workspace)?;
        Ok(Self {
            epsilon,
            volume: if polygonal { volume(model)? } else { None },
            linf: grasp::epsilon_linf(model, &mut workspace)?.quality,
            min_weight: if polygonal {
                grasp::min_weight(model)?
            } else {
                None
            },
            least_friction: grasp::friction_needed(model, MOST_FRICTION, &mut workspace)?.closure,
            smallest_singular_value: grasp::smallest_singular_value(model)?,
            normal_force_per_load: normal_force_per_load(model)?,
        })
    }

    /// The numbers in the order of [`Metrics::COLUMNS`]; an open grasp has the convention's quality
    /// for open grasps.
    pub fn row(&self, convention: &Convention) -> [Option<f64>; 9] {
        [
            Some(self.epsilon.value(convention)),
            Some(self.epsilon.lower),
            Some(self.epsilon.upper),
            self.volume,
            Some(self.linf),
            self.min_weight,
            self.least_friction,
            Some(self.smallest_singular_value),
            self.normal_force_per_load,
        ]
    }
}

impl Measure<'_> {
    /// All metrics of a grasp on this object, with the contact model of this measure.
    ///
    /// # Errors
    /// The grasp has fewer than two contacts, or a measure cannot be computed.
    pub fn metrics(&self, grasp: &Grasp) -> Result<Metrics, Error> {
        self.with_model(grasp.contacts(), Metrics::of_model)
    }

    /// Contact forces inside the friction cones that balance an external wrench, with the least
    /// largest normal force; or a proof that there are none.
    ///
    /// `external` is (force, torque about the centre / torque length), centred axes.
    ///
    /// # Errors
    /// The grasp has fewer than two contacts.
    pub fn resist(&self, grasp: &Grasp, external: &Wrench) -> Result<Resistance, Error> {
        let resistance = self.with_model(grasp.contacts(), |model| grasp::resist(model, external));
        Ok(resistance?)
    }
}

/// The volume of the hull, unless it has too many facets.
fn volume(model: &GraspModel<'_>) -> Result<Option<f64>, QualityError> {
    match grasp::volume(model) {
        Err(QualityError::Hull(HullError::TooLarge { .. })) => Ok(None),
        found => found.map(Some),
    }
}

/// The worst of the six axis-parallel unit forces through the centre.
fn normal_force_per_load(model: &GraspModel<'_>) -> Result<Option<f64>, WrenchError> {
    let mut worst = 0.0_f64;
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let mut load = Wrench::zeros();
            load[axis] = sign;
            match grasp::resist(model, &load)? {
                Resistance::Holds {
                    largest_normal_force,
                    ..
                } => worst = worst.max(largest_normal_force),
                Resistance::Fails { .. } => return Ok(None),
            }
        }
    }
    Ok(Some(worst))
}
