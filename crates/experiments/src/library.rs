//! The library that grasps are transferred from: the twelve objects with their best hand grasps.

use grasp::Convention;
use moduli::{Grasps, Hand, Kept};
use record::{LibraryEntry, LibraryRecord};
use shape::FitSettings;

use crate::error::ExperimentError;
use crate::objects::{ObjectSource, Objects};
use crate::paper;
use crate::pipeline::{FittedScan, fit_all, synthesize};
use crate::run::fit_settings;

/// Settings of a library.
#[derive(Clone, Debug, PartialEq)]
pub struct LibrarySettings {
    /// Seed of the scans and of the hand's poses.
    pub seed: u64,
    /// Settings of the fits.
    pub fit: FitSettings,
    /// Convention by which grasps are ranked.
    pub convention: Convention,
    /// Number of hand poses around each object.
    pub poses: usize,
    /// Which grasps of each object are kept.
    pub kept: Kept,
}

impl LibrarySettings {
    /// The seed of the library under `fixtures/`.
    pub const SEED: u64 = 2014;

    /// The settings of the library under `fixtures/`, with grasps ranked under a convention.
    pub fn standard(convention: Convention) -> Self {
        Self {
            seed: Self::SEED,
            fit: fit_settings(paper::DEGREE, None),
            convention,
            poses: paper::HAND_POSES,
            kept: Kept::default(),
        }
    }
}

/// Fits S1 to S12 of the catalogue and keeps the best hand grasps on each, at a least separation.
///
/// Uses the current thread pool; the result does not depend on the number of threads.
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
        entries.extend(entry(fitted, &found, settings));
    }
    Ok(LibraryRecord {
        seed: settings.seed,
        convention: settings.convention.name.clone(),
        hand: hand.name().to_owned(),
        entries,
    })
}

fn entry(fitted: &FittedScan, ranked: &Grasps, settings: &LibrarySettings) -> Option<LibraryEntry> {
    let name = &fitted.scan.name;
    fitted
        .object
        .library_entry(fitted.id(), name, ranked, &settings.kept)
}
