//! Stored types of `record` made from the types of computation, and turned back into them.

use grasp::{CentreRule, Convention, ConventionError, EdgeNorm, Edges, TangentRule, TorqueLength};
use hand::{JointKind, TipModel};
use nalgebra::{UnitVector3, Vector3};
use record::grasps::{
    CentreRecord, ContactModelRecord, ConventionRecord, DroppedRecord, EdgeNormRecord, EdgesRecord,
    JointRecord, JointUnit, PieceRecord, SceneRecord, SceneSupport, SupportOrigin, SupportRecord,
    TangentRecord,
};
use record::{LibraryGrasp, ShapeRecord};
use shape::scene::Piece;
use shape::{RadialError, RadialShape, Scene, Support, SupportSource};
use sph::{Coefficients, CoefficientsError};

use crate::grasp::Grasp;

/// Why a stored shape cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StoredShapeError {
    /// The numbers are not a coefficient vector.
    #[error(transparent)]
    Coefficients(#[from] CoefficientsError),
    /// The radius is not proved positive.
    #[error(transparent)]
    Radial(#[from] RadialError),
    /// The map of a spherical shape is not proved an immersion.
    #[error(transparent)]
    Spherical(shape::SphericalError),
    /// A closed hole is damaged.
    #[error("a closed hole of the stored shape has a number that is not finite")]
    Hole,
    /// The support plane is damaged.
    #[error("the support plane of the stored shape has no unit normal or no finite offset")]
    Support,
    /// The centre is not finite.
    #[error("the centre of the stored shape is not finite")]
    Centre,
}

/// The record of a support plane.
pub fn support_record(support: &Support) -> SupportRecord {
    SupportRecord {
        normal: support.normal.into_inner().into(),
        offset_m: support.offset_m,
    }
}

/// The support plane of a record.
///
/// # Errors
/// The normal is not a unit vector, or the offset is not finite.
pub(crate) fn stored_support(
    record: Option<&SupportRecord>,
) -> Result<Option<Support>, StoredShapeError> {
    let Some(record) = record else {
        return Ok(None);
    };
    let normal = Vector3::from(record.normal);
    // Written so that NaN fails too.
    if !((normal.norm() - 1.0).abs() <= 1e-6 && record.offset_m.is_finite()) {
        return Err(StoredShapeError::Support);
    }
    Ok(Some(Support {
        normal: UnitVector3::new_normalize(normal),
        offset_m: record.offset_m,
    }))
}

/// The record of a scene.
pub fn scene_record(scene: &Scene) -> SceneRecord {
    let piece = |piece: &Piece| PieceRecord {
        points: piece.count,
        share: piece.share,
        centre_m: piece.centre.into(),
        extent_m: piece.extent.into(),
        taken: piece.taken,
    };
    SceneRecord {
        support: scene.support.as_ref().map(|(plane, source)| SceneSupport {
            normal: plane.normal.into_inner().into(),
            offset_m: plane.offset_m,
            source: match source {
                SupportSource::Visible => SupportOrigin::Visible,
                SupportSource::Foot => SupportOrigin::Foot,
                SupportSource::Given => SupportOrigin::Given,
            },
        }),
        pieces: scene.pieces.iter().map(piece).collect(),
        dropped: DroppedRecord {
            repeated: scene.dropped.repeated,
            sentinels: scene.dropped.sentinels,
            support: scene.dropped.support,
            isolated: scene.dropped.isolated,
            other_pieces: scene.dropped.other_pieces,
        },
    }
}

/// The coefficients β of a stored shape; the radius is not proved positive.
///
/// # Errors
/// The number of coefficients is not a square, or one of them is not finite.
pub fn stored_coefficients(record: &ShapeRecord) -> Result<Coefficients, StoredShapeError> {
    Ok(Coefficients::new(record.coefficients.clone())?)
}

/// The shape of a record. Its radius is proved positive again, because a stored claim is no proof.
///
/// # Errors
/// The centre or a coefficient is not finite, or the radius is not proved positive.
pub fn stored_shape(record: &ShapeRecord) -> Result<RadialShape, StoredShapeError> {
    if !record.centre_in_cloud_m.iter().all(|x| x.is_finite()) {
        return Err(StoredShapeError::Centre);
    }
    Ok(RadialShape::new(stored_coefficients(record)?)?)
}

/// The record of a grasp in a library; `None` for a grasp without a hand.
pub fn library_grasp(grasp: &Grasp) -> Option<LibraryGrasp> {
    let hand = grasp.hand()?;
    let pose = &hand.centred_from_palm;
    Some(LibraryGrasp {
        directions: grasp
            .directions()
            .iter()
            .map(|p| p.into_inner().into())
            .collect(),
        quality: grasp.quality(),
        palm_translation_m: pose.translation.vector.into(),
        palm_quaternion_xyzw: pose.rotation.coords.into(),
        joints_rad: hand.joints.clone(),
    })
}

/// The value of a joint with its unit.
pub fn joint_record(kind: JointKind, value: f64) -> JointRecord {
    let unit = match kind {
        JointKind::Prismatic => JointUnit::Metres,
        JointKind::Fixed | JointKind::Revolute => JointUnit::Radians,
    };
    JointRecord {
        value,
        unit: Some(unit),
        follows: None,
    }
}

/// The record of a convention; [`convention`] is the way back.
pub fn convention_record(convention: &Convention) -> ConventionRecord {
    ConventionRecord {
        name: convention.name.clone(),
        edge_norm: match convention.edge_norm {
            EdgeNorm::UnitNormalComponent => EdgeNormRecord::UnitNormalComponent,
            EdgeNorm::UnitLength => EdgeNormRecord::UnitLength,
        },
        torque_length_m: match convention.torque_length {
            TorqueLength::Metres(length) => Some(length),
            TorqueLength::MaxContactDistance => None,
        },
        centre: match convention.centre {
            CentreRule::CloudMean => CentreRecord::CloudMean,
            CentreRule::CentreOfMass => CentreRecord::CentreOfMass,
            CentreRule::ObjectOrigin => CentreRecord::ObjectOrigin,
            CentreRule::Given => CentreRecord::Given,
        },
        friction: convention.friction,
        edges: match convention.edges {
            Edges::Polygon(count) => EdgesRecord::Polygon(count),
            Edges::Round { tolerance } => EdgesRecord::Round { tolerance },
        },
        not_closed: convention.not_closed,
        tangent: match convention.tangent {
            TangentRule::LeastAligned => TangentRecord::LeastAligned,
            TangentRule::Projected(axis) => TangentRecord::Projected(axis.into()),
        },
        stable_above: Some(convention.stable_above),
        contact: None,
    }
}

/// What contacts transmit, as it is stored; none for points.
pub fn contact_model_record(tips: TipModel) -> Option<ContactModelRecord> {
    match tips {
        TipModel::Point => None,
        TipModel::Soft { radius } => Some(ContactModelRecord::Soft { radius_m: radius }),
        TipModel::Patch { radius } => Some(ContactModelRecord::Patch { radius_m: radius }),
    }
}

/// What contacts transmit, from a record.
pub fn tip_model(record: Option<ContactModelRecord>) -> TipModel {
    match record {
        None => TipModel::Point,
        Some(ContactModelRecord::Soft { radius_m: radius }) => TipModel::Soft { radius },
        Some(ContactModelRecord::Patch { radius_m: radius }) => TipModel::Patch { radius },
    }
}

/// The convention of a record.
///
/// # Errors
/// A number of the record is outside its range.
pub fn convention(record: &ConventionRecord) -> Result<Convention, ConventionError> {
    let convention = Convention {
        name: record.name.clone(),
        edge_norm: match record.edge_norm {
            EdgeNormRecord::UnitNormalComponent => EdgeNorm::UnitNormalComponent,
            EdgeNormRecord::UnitLength => EdgeNorm::UnitLength,
        },
        torque_length: match record.torque_length_m {
            Some(length) => TorqueLength::Metres(length),
            None => TorqueLength::MaxContactDistance,
        },
        centre: match record.centre {
            CentreRecord::CloudMean => CentreRule::CloudMean,
            CentreRecord::CentreOfMass => CentreRule::CentreOfMass,
            CentreRecord::ObjectOrigin => CentreRule::ObjectOrigin,
            CentreRecord::Given => CentreRule::Given,
        },
        friction: record.friction,
        edges: match record.edges {
            EdgesRecord::Polygon(count) => Edges::Polygon(count),
            EdgesRecord::Round { tolerance } => Edges::Round { tolerance },
        },
        tangent: match record.tangent {
            TangentRecord::LeastAligned => TangentRule::LeastAligned,
            TangentRecord::Projected(axis) => TangentRule::Projected(axis.into()),
        },
        not_closed: record.not_closed,
        stable_above: record
            .stable_above
            .unwrap_or_else(|| stable_above(&record.name)),
    };
    convention.validate()?;
    Ok(convention)
}

/// The threshold of a convention in a file that does not state it: that of its name.
fn stable_above(name: &str) -> f64 {
    Convention::named(name).map_or(0.0, |known| known.stable_above)
}

#[cfg(test)]
mod tests {
    use super::*;
    use record::ShapeNotes;

    #[test]
    fn every_convention_comes_back_from_its_record() {
        let named = Convention::NAMES.map(|name| Convention::named(name).unwrap());
        let round = Convention {
            edges: Edges::Round { tolerance: 3e-7 },
            tangent: TangentRule::Projected([1.2, 2.3, 3.4].into()),
            ..named[3].clone()
        };
        for original in named.iter().chain([&round]) {
            assert_eq!(&convention(&convention_record(original)).unwrap(), original);
        }
        let mut bad = convention_record(&round);
        bad.friction = f64::NAN;
        assert!(convention(&bad).is_err());
    }

    fn ball() -> ShapeRecord {
        ShapeRecord {
            name: "ball".to_owned(),
            coefficients: Coefficients::constant(3, 0.04).as_slice().to_vec(),
            centre_in_cloud_m: [0.1, 0.2, 0.3],
            lambda: 1e-3,
            rms_m: 1e-4,
            points: 25_000,
            notes: ShapeNotes::default(),
        }
    }

    #[test]
    fn a_stored_shape_is_certified_again() {
        let stored = ShapeRecord::from_bytes(&ball().to_bytes().unwrap()).unwrap();
        assert!(stored_shape(&stored).unwrap().radius_bounds().0 > 0.039);
    }

    #[test]
    fn stored_nonsense_is_refused() {
        let mut bad = ball();
        bad.coefficients[2] = 1.0;
        assert!(matches!(
            stored_shape(&bad),
            Err(StoredShapeError::Radial(_))
        ));
        bad.coefficients[2] = f64::NAN;
        let coefficients =
            |bad: &ShapeRecord| matches!(stored_shape(bad), Err(StoredShapeError::Coefficients(_)));
        assert!(coefficients(&bad));
        bad.coefficients.pop();
        assert!(coefficients(&bad));
        let mut lost = ball();
        lost.centre_in_cloud_m[1] = f64::INFINITY;
        assert_eq!(stored_shape(&lost).unwrap_err(), StoredShapeError::Centre);
    }
}
