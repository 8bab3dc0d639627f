//! Candidates in order, written in the frame of the user's cloud.

use std::collections::BTreeMap;

use hand::{Hand, ReachParams};
use moduli::records::{convention_record, joint_record};
use nalgebra::{Isometry3, Point3, Translation3};
use record::grasps::{
    AssessmentRecord, ExecutionRecord, GRASPS_VERSION, HandRecord, JointRecord, ObjectRecord,
    PoseRecord, SourceRecord,
};
use record::{GraspRecord, GraspsFile};
use shape::Surface;

use super::{Candidate, HandPlacement, Source, Target};

/// Force-closed candidates, the best first; equal ones stay in the order they were found.
pub(crate) fn rank(mut candidates: Vec<Candidate>) -> Vec<Candidate> {
    candidates.retain(|c| c.quality > 0.0);
    candidates.sort_by(|a, b| b.quality.total_cmp(&a.quality));
    candidates
}

/// The file that `grasp` writes.
pub(crate) fn grasps_file(target: &Target, hand: &Hand, ranked: &[Candidate]) -> GraspsFile {
    let shape = &target.fit.shape;
    let centre = target.fit.centre_in_cloud;
    let (r_min, r_max) = shape.radius_bounds();
    GraspsFile {
        version: GRASPS_VERSION,
        object: ObjectRecord {
            name: target.name.to_owned(),
            centre_m: centre.into(),
            r_min_certified_m: r_min,
            r_max_certified_m: r_max,
            centre_of_mass_m: in_cloud(&shape.centre_of_mass(), &centre),
            volume_m3: shape.mass_properties().volume,
            ..ObjectRecord::default()
        },
        convention: convention_record(&target.convention),
        grasps: ranked
            .iter()
            .enumerate()
            .map(|(i, c)| grasp_record(i + 1, c, hand, &centre))
            .collect(),
    }
}

/// A point of the centred frame in the frame of the cloud.
pub(crate) fn in_cloud(p: &Point3<f64>, centre: &Point3<f64>) -> [f64; 3] {
    (p + centre.coords).into()
}

fn grasp_record(
    rank: usize,
    candidate: &Candidate,
    hand: &Hand,
    centre: &Point3<f64>,
) -> GraspRecord {
    GraspRecord {
        rank,
        quality: candidate.quality,
        contacts_m: candidate
            .contacts
            .iter()
            .map(|c| in_cloud(&c.position, centre))
            .collect(),
        inward_normals: candidate
            .contacts
            .iter()
            .map(|c| c.inward_normal.into_inner().into())
            .collect(),
        source: source_record(&candidate.source),
        hand: candidate
            .hand
            .as_ref()
            .map(|placement| hand_record(candidate, placement, hand, centre)),
        directions: candidate
            .directions
            .iter()
            .map(|p| p.into_inner().into())
            .collect(),
        assessment: AssessmentRecord::default(),
    }
}

fn source_record(source: &Source) -> SourceRecord {
    match source {
        Source::Synthesis { .. } => SourceRecord::Synthesis,
        Source::Transfer {
            from,
            shape_distance,
            source_quality,
        } => SourceRecord::Transfer {
            from: Some(from.clone()),
            shape_distance_m: Some(*shape_distance),
            source_quality: Some(*source_quality),
        },
    }
}

/// The palm's pose in the frame of the cloud.
pub(crate) fn cloud_from_palm(placement: &HandPlacement, centre: &Point3<f64>) -> Isometry3<f64> {
    Translation3::from(centre.coords) * placement.object_from_palm
}

fn hand_record(
    candidate: &Candidate,
    placement: &HandPlacement,
    hand: &Hand,
    centre: &Point3<f64>,
) -> HandRecord {
    let pose = cloud_from_palm(placement, centre);
    let before = match candidate.source {
        Source::Synthesis { preshape } => hand.preshapes()[preshape].joints.clone(),
        Source::Transfer { .. } => opened(hand, &placement.joints),
    };
    HandRecord {
        name: hand.name().to_owned(),
        palm_link: hand.model().links()[0].name.clone(),
        cloud_from_palm: PoseRecord::from(&pose),
        joints: by_name(hand, &placement.joints),
        pregrasp_joints: by_name(hand, &before),
        contact_error_m: placement.contact_error,
        execution: ExecutionRecord::default(),
    }
}

fn by_name(hand: &Hand, joints: &[f64]) -> BTreeMap<String, JointRecord> {
    let driven = hand.model().driven_joints().zip(joints);
    driven
        .map(|(joint, value)| (joint.name.clone(), joint_record(joint.kind, *value)))
        .collect()
}

/// The joints with every finger opened by as much as the search for a hand opens it.
fn opened(hand: &Hand, joints: &[f64]) -> Vec<f64> {
    let mut open = joints.to_vec();
    let opening = ReachParams::default().opening;
    for &(driven, ratio) in hand.fingers().iter().flat_map(|f| &f.closing) {
        open[driven] -= opening * ratio;
    }
    hand.model().clamp_to_limits(&mut open);
    open
}
