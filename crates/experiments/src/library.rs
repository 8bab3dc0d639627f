//! The library that grasps are transferred from: the twelve objects with their best hand grasps.

use grasp::{Contact, Convention};
use moduli::records::library_grasp;
use moduli::{Grasp, Grasps, Hand};
use nalgebra::Point3;
use record::{LibraryEntry, LibraryRecord};
use shape::FitSettings;

use crate::error::ExperimentError;
use crate::objects::{ObjectSource, Objects};
use crate::paper;
use crate::pipeline::{FittedScan, fit_all, synthesize};
use crate::run::fit_settings;

/// How a library is built.
#[derive(Clone, Debug, PartialEq)]
pub struct LibrarySettings {
    /// The seed of the scans and of the hand's poses.
    pub seed: u64,
    /// How scans become surfaces.
    pub fit: FitSettings,
    /// How grasps are ranked.
    pub convention: Convention,
    /// Hand poses around each object.
    pub poses: usize,
    /// Grasps kept of each object, at most.
    pub grasps: usize,
    /// Two grasps of one object are at least this far apart ([`separation`]).
    pub separation: f64,
}

impl LibrarySettings {
    /// The seed of the library under `fixtures/`.
    pub const SEED: u64 = 2014;

    /// The library under `fixtures/`, with grasps ranked under a convention.
    pub fn standard(convention: Convention) -> Self {
        Self {
            seed: Self::SEED,
            fit: fit_settings(paper::DEGREE, None),
            convention,
            poses: paper::HAND_POSES,
            grasps: 12,
            separation: 0.25,
        }
    }
}

/// Fits S1 to S12 of the catalogue and keeps the best hand grasps on each, spread out.
///
/// Uses the current pool of threads; the result does not depend on their number.
///
/// # Errors
/// An object cannot be fitted, or the hand or the convention cannot be used.
pub fn build(settings: &LibrarySettings) -> Result<LibraryRecord, ExperimentError> {
    let set = fit_all(
        Objects::load(&ObjectSource::Builtin, settings.seed)?,
        &settings.fit,
    );
    if !set.refused.is_empty() {
        let reason = |r: &crate::objects::Refused| format!("\n  {}: {}", r.id, r.reason);
        return Err(ExperimentError::TooFewObjects {
            fitted: set.objects.len(),
            given: set.objects.len() + set.refused.len(),
            needed: paper::OBJECTS,
            source_name: set.source.to_string(),
            reasons: set.refused.iter().map(reason).collect(),
        });
    }
    let hand = Hand::schunk_sdh()?;
    let mut entries = Vec::with_capacity(set.objects.len());
    for fitted in &set.objects {
        let found = synthesize(
            fitted,
            &hand,
            &settings.convention,
            settings.poses,
            settings.seed,
        )?;
        entries.push(entry(fitted, &found, settings));
    }
    Ok(LibraryRecord {
        seed: settings.seed,
        convention: settings.convention.name.clone(),
        hand: hand.name().to_owned(),
        entries,
    })
}

fn entry(fitted: &FittedScan, ranked: &Grasps, settings: &LibrarySettings) -> LibraryEntry {
    let radius = fitted.shape().mean_radius();
    let spread = spread_out(ranked, radius, settings.separation, settings.grasps);
    LibraryEntry {
        id: fitted.id().to_owned(),
        name: fitted.scan.name.clone(),
        shape: fitted.object.to_record(),
        grasps: spread.into_iter().filter_map(library_grasp).collect(),
    }
}

/// The first grasps of a ranked list, at most `count`, without those nearer than `least` to an
/// earlier one.
fn spread_out(ranked: &Grasps, radius: f64, least: f64, count: usize) -> Vec<&Grasp> {
    let mut kept: Vec<&Grasp> = Vec::with_capacity(count);
    for grasp in ranked.iter() {
        if kept.len() == count {
            break;
        }
        let near = |other: &&Grasp| {
            separation(grasp.contacts(), other.contacts(), radius).is_some_and(|d| d < least)
        };
        if !kept.iter().any(near) {
            kept.push(grasp);
        }
    }
    kept
}

/// The least d(g, g′) of Sec. III-C over all orders of the contacts, with lengths divided by
/// `radius`; `None` for different numbers of contacts.
///
/// Grasps that differ only in the order of the fingers are the same to an object.
pub fn separation(a: &[Contact], b: &[Contact], radius: f64) -> Option<f64> {
    let scaled = |order: &mut dyn Iterator<Item = &Contact>| grasp::Grasp {
        contacts: order
            .map(|c| Contact {
                position: c.position / radius,
                ..*c
            })
            .collect(),
        centre: Point3::origin(),
    };
    let first = scaled(&mut a.iter());
    let distances = orders(b.len())
        .into_iter()
        .map(|order| grasp::distance(&first, &scaled(&mut order.iter().map(|&k| &b[k]))))
        .collect::<Result<Vec<f64>, _>>()
        .ok()?;
    distances.into_iter().min_by(f64::total_cmp)
}

/// All permutations of 0 … count−1.
fn orders(count: usize) -> Vec<Vec<usize>> {
    let mut all = vec![Vec::new()];
    for last in 0..count {
        all = all
            .into_iter()
            .flat_map(|order: Vec<usize>| {
                (0..=order.len()).map(move |place| {
                    let mut longer = order.clone();
                    longer.insert(place, last);
                    longer
                })
            })
            .collect();
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{UnitVector3, Vector3};

    fn contact(x: f64, y: f64) -> Contact {
        let position = Point3::new(x, y, 0.01);
        Contact {
            position,
            inward_normal: UnitVector3::new_normalize(-position.coords),
        }
    }

    #[test]
    fn the_order_of_fingers_and_the_unit_of_length_do_not_matter() {
        let a = [
            contact(0.03, 0.0),
            contact(0.0, 0.04),
            contact(-0.03, -0.01),
        ];
        let turned = [a[2], a[0], a[1]];
        assert_eq!(separation(&a, &turned, 0.04), Some(0.0));
        let mut moved = a;
        moved[1].position.z += 0.02;
        assert!((separation(&a, &moved, 0.04).unwrap() - 0.5).abs() <= 1e-12);
        assert_eq!(separation(&a, &a[..2], 0.04), None);
        let mut tilted = a;
        tilted[0].inward_normal = Vector3::z_axis();
        assert!(separation(&a, &tilted, 0.04).unwrap() > 1.0);
    }

    #[test]
    fn there_are_six_orders_of_three() {
        let mut all = orders(3);
        all.sort();
        all.dedup();
        assert_eq!(all.len(), 6);
        assert_eq!(orders(0), [Vec::<usize>::new()]);
    }
}
