//! Candidates carried over from the nearest library objects.

use hand::{HandState, carried_pose};
use indicatif::ProgressBar;
use moduli::records::{StoredShapeError, stored_coefficients, stored_shape};
use nalgebra::Point3;
use rayon::prelude::*;
use record::{LibraryEntry, LibraryGrasp, LibraryRecord};
use shape::RadialField;
use space::Continuation;
use space::point::contacts_on;
use space::{Transfer, TransferEnd};
use sph::Direction;

use super::{Candidate, Source, Target};
use crate::failure::Failure;

/// A library object near the target.
pub(crate) struct Neighbour<'a> {
    pub(crate) entry: &'a LibraryEntry,
    /// Metres.
    pub(crate) distance: f64,
    surface: RadialField,
}

/// What a transferred grasp brings along.
#[derive(Clone, Debug)]
pub(crate) struct Carried {
    /// The hand on the library object, moved rigidly with its contacts; none of another hand.
    pub(crate) hand: Option<HandState>,
    /// Quality on the target of the same directions, not improved.
    pub(crate) naive: f64,
}

/// The library objects nearest to the target by d (Sec. III-A), the nearest first.
pub(crate) fn neighbours<'a>(
    target: &Target,
    library: &'a LibraryRecord,
    count: usize,
) -> Result<Vec<Neighbour<'a>>, Failure> {
    let beta = target.fit.shape.coefficients();
    let broken = |entry: &LibraryEntry, e: StoredShapeError| {
        Failure::other(format!("library object {}: {e}", entry.id))
    };
    let mut order = Vec::new();
    for entry in &library.entries {
        let other = stored_coefficients(&entry.shape).map_err(|e| broken(entry, e))?;
        order.push((entry, beta.distance(&other)));
    }
    order.sort_by(|a, b| a.1.total_cmp(&b.1));
    order
        .into_par_iter()
        .take(count)
        .map(|(entry, distance)| {
            Ok(Neighbour {
                entry,
                distance,
                surface: RadialField::new(
                    stored_shape(&entry.shape).map_err(|e| broken(entry, e))?,
                ),
            })
        })
        .collect()
}

/// The best `grasps` grasps of every neighbour, carried to the target.
///
/// What ends open is kept as a candidate of quality 0, so that it is counted.
pub(crate) fn candidates(
    target: &Target,
    neighbours: &[Neighbour],
    grasps: usize,
    progress: &ProgressBar,
) -> Result<Vec<Candidate>, Failure> {
    let surface = RadialField::new(target.fit.shape.clone());
    let to = TransferEnd {
        surface: &surface,
        object_origin: target.object_origin(),
    };
    let transfers: Vec<Transfer> = neighbours
        .iter()
        .map(|n| {
            let from = TransferEnd {
                surface: &n.surface,
                object_origin: Point3::from(-n.entry.shape.centre_in_cloud().coords),
            };
            Transfer::new(from, to, target.rule)
        })
        .collect();
    let mut jobs = Vec::new();
    for (neighbour, transfer) in neighbours.iter().zip(&transfers) {
        for grasp in neighbour.entry.grasps.iter().take(grasps) {
            let directions = grasp.directions().ok_or_else(|| {
                Failure::other(format!(
                    "library object {}: a contact is no unit vector",
                    neighbour.entry.id
                ))
            })?;
            jobs.push((neighbour, transfer, grasp, directions));
        }
    }
    progress.set_length(jobs.len() as u64);
    jobs.into_par_iter()
        .map(|(neighbour, transfer, grasp, directions)| {
            let candidate = carry(transfer, neighbour, grasp, &directions)?;
            progress.inc(1);
            Ok(candidate)
        })
        .collect()
}

fn carry(
    transfer: &Transfer,
    neighbour: &Neighbour,
    grasp: &LibraryGrasp,
    directions: &[Direction],
) -> Result<Candidate, Failure> {
    let failed = |e: space::TransferError| {
        Failure::refused(format!("transfer from {}: {e}", neighbour.entry.id))
    };
    let arrived = Continuation::default()
        .carry(transfer, directions)
        .map_err(failed)?;
    let naive = transfer.naive(directions).map_err(failed)?.quality;
    let contacts = contacts_on(transfer.target(), &arrived.contacts);
    let held = contacts_on(&neighbour.surface, directions);
    let hand = HandState {
        object_from_palm: carried_pose(&grasp.centred_from_palm(), &held, &contacts),
        joints: grasp.joints_rad.clone(),
    };
    Ok(Candidate {
        directions: arrived.contacts,
        contacts,
        quality: arrived.quality,
        source: Source::Transfer {
            from: format!("{} {}", neighbour.entry.id, neighbour.entry.name),
            shape_distance: neighbour.distance,
            source_quality: grasp.quality,
        },
        hand: None,
        carried: Some(Carried {
            hand: Some(hand),
            naive,
        }),
    })
}
