//! Grasps as `grasps.json` stores them, in the frame of the user's cloud.

use std::collections::BTreeMap;

use hand::{CollisionObject, Drive, Hand, Joint, touching_joints};
use record::grasps::ObjectRecord;
use record::grasps::{
    AssessmentRecord, ContactRecord, ConventionRecord, ExecutionRecord, GRASPS_VERSION, HandRecord,
    JointRecord, PoseRecord, SourceRecord,
};
use record::{GraspRecord, GraspsFile};
use shape::PointCloud;

use crate::error::Error;
use crate::grasp::{Grasp, HandPlacement, Source};
use crate::measure::Measure;
use crate::records::{contact_model_record, convention_record, joint_record, support_record};

impl Measure<'_> {
    /// The file of ranked grasps of a hand; ranks follow the order of the list.
    pub fn grasps_file(&self, hand: &Hand, ranked: &[Grasp]) -> GraspsFile {
        // A surface that hands cannot meet has no grasps with a hand.
        let collision = CollisionObject::new(self.object().field()).ok();
        let record = |(i, grasp): (usize, &Grasp)| {
            let hand = grasp
                .hand()
                .map(|placement| hand_record(grasp, placement, hand, collision.as_ref()));
            grasp_record(i + 1, grasp, source_record(grasp.source()), hand)
        };
        self.for_hand(hand)
            .file_of(ranked.iter().enumerate().map(record).collect())
    }

    /// Adds to the records of a hand's grasps, in the same order, their robust quality and what a cloud says of
    /// each contact ([`Measure::evidence`]).
    ///
    /// # Errors
    /// A robust quality cannot be computed.
    pub fn add_evidence(
        &self,
        hand: &Hand,
        records: &mut [GraspRecord],
        grasps: &[Grasp],
        cloud: &PointCloud,
    ) -> Result<(), Error> {
        let measure = self.for_hand(hand);
        for (record, grasp) in records.iter_mut().zip(grasps) {
            let evidence = measure.evidence(grasp, cloud);
            record.assessment.robust_quality = Some(measure.robust(grasp, &evidence)?);
            let contacts = evidence.iter().enumerate().map(|(i, found)| ContactRecord {
                point_m: record.contacts_m[i],
                inward_normal: record.inward_normals[i],
                direction: record.directions[i],
                distance_to_cloud_m: Some(found.distance),
                normal_spread_deg: found.seen.then(|| found.normal_spread.to_degrees()),
                seen: Some(found.seen),
            });
            record.assessment.contacts = contacts.collect();
        }
        Ok(())
    }

    /// The file of grasps that are records already.
    pub fn file_of(&self, grasps: Vec<GraspRecord>) -> GraspsFile {
        GraspsFile {
            version: GRASPS_VERSION,
            object: ObjectRecord {
                support: self
                    .support()
                    .map(|s| support_record(&self.object().frame().plane_to_cloud(&s))),
                ..self.object().object_record()
            },
            convention: ConventionRecord {
                contact: contact_model_record(self.tips()),
                ..convention_record(self.convention())
            },
            grasps,
        }
    }
}

/// One grasp as it is stored.
pub fn grasp_record(
    rank: usize,
    grasp: &Grasp,
    source: SourceRecord,
    hand: Option<HandRecord>,
) -> GraspRecord {
    let in_cloud = grasp.contacts_in_cloud();
    let normals = grasp.inward_normals();
    GraspRecord {
        rank,
        quality: grasp.quality(),
        contacts_m: in_cloud.into_iter().map(Into::into).collect(),
        inward_normals: normals.iter().map(|n| n.into_inner().into()).collect(),
        directions: grasp
            .directions()
            .iter()
            .map(|p| p.into_inner().into())
            .collect(),
        source,
        hand,
        assessment: AssessmentRecord {
            lower: Some(grasp.epsilon().lower),
            upper: Some(grasp.epsilon().upper),
            ..AssessmentRecord::default()
        },
    }
}

/// Where a grasp comes from, as it is stored.
pub fn source_record(source: &Source) -> SourceRecord {
    match source {
        Source::Synthesis { .. } | Source::Given => SourceRecord::Synthesis,
        Source::Transfer {
            from,
            shape_distance,
            source_quality,
            ..
        } => SourceRecord::Transfer {
            from: Some(from.clone()),
            shape_distance_m: Some(*shape_distance),
            source_quality: Some(*source_quality),
        },
    }
}

fn hand_record(
    grasp: &Grasp,
    placement: &HandPlacement,
    hand: &Hand,
    object: Option<&CollisionObject<'_>>,
) -> HandRecord {
    let touching = object.map_or_else(
        || placement.joints.clone(),
        |o| touching_joints(o, hand, &placement.centred_from_palm, &placement.joints),
    );
    let pose = grasp.palm_in_cloud().unwrap_or(placement.centred_from_palm);
    HandRecord {
        name: hand.name().to_owned(),
        palm_link: hand.model().links()[0].name.clone(),
        cloud_from_palm: PoseRecord::from(&pose),
        joints: by_name(hand, &placement.joints),
        pregrasp_joints: by_name(hand, &placement.pregrasp_joints),
        contact_error_m: placement.contact_error,
        execution: ExecutionRecord {
            grasp_joints: by_name(hand, &touching),
            approach_direction: Some((pose * hand.approach_axis()).into_inner().into()),
            clearance_to_support_m: placement.clearance_to_support,
            ..ExecutionRecord::default()
        },
    }
}

/// All joints that move, those that follow others too.
fn by_name(hand: &Hand, joints: &[f64]) -> BTreeMap<String, JointRecord> {
    let model = hand.model();
    let driven = model.driven_names();
    let record = |joint: &Joint| {
        let follows = match joint.drive {
            Drive::Fixed => return None,
            Drive::Driven(_) => None,
            Drive::Mimic { driven: index, .. } => Some(driven[index].to_owned()),
        };
        let plain = joint_record(joint.kind, joint.value(joints));
        Some((joint.name.clone(), JointRecord { follows, ..plain }))
    };
    model.joints().iter().filter_map(record).collect()
}
