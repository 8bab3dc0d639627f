//! The settings of one run of an experiment.

use std::path::Path;

use clap::ValueEnum;
use grasp::Convention;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use serde::Serialize;
use shape::FitSettings;

use crate::objects::ObjectSource;
use crate::paper;

/// How much is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Scale {
    /// The same computation on fewer objects, poses, grasps or steps; seconds.
    Small,
    /// The numbers of the paper.
    Full,
}

impl Scale {
    /// As on the command line.
    pub fn name(self) -> &'static str {
        self.pick("small", "full")
    }

    /// The value for this scale.
    pub fn pick<T>(self, small: T, full: T) -> T {
        match self {
            Scale::Small => small,
            Scale::Full => full,
        }
    }
}

/// The settings of a run, for every section.
pub struct Run<'a> {
    /// Where the objects come from.
    pub objects: ObjectSource,
    /// Ids of those that are used; all when empty.
    pub only: &'a [String],
    /// How much is computed.
    pub scale: Scale,
    /// The seed of every random number.
    pub seed: u64,
    /// How quality is measured.
    pub convention: Convention,
    /// How clouds become surfaces.
    pub fit: FitSettings,
    /// Folder where long computations keep what is done, see [`crate::ledger`].
    pub keep: Option<&'a Path>,
    /// Is called with a line of text when a step begins.
    pub progress: &'a (dyn Fn(&str) + Sync),
}

/// L and λ as settings of a fit; λ is chosen from the data when absent.
pub fn fit_settings(degree: usize, lambda: Option<f64>) -> FitSettings {
    FitSettings { degree, lambda }
}

impl<'a> Run<'a> {
    /// A run on the built-in objects under the paper's degree and the given convention.
    pub fn builtin(
        scale: Scale,
        seed: u64,
        convention: Convention,
        progress: &'a (dyn Fn(&str) + Sync),
    ) -> Self {
        Self {
            objects: ObjectSource::Builtin,
            only: &[],
            scale,
            seed,
            convention,
            fit: fit_settings(paper::DEGREE, None),
            keep: None,
            progress,
        }
    }

    /// Reports that a step begins.
    pub fn say(&self, what: &str) {
        (self.progress)(what);
    }
}

/// The purpose of random numbers; no two purposes share any.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Hand poses around an object.
    Poses = 1,
    /// Points of a sphere.
    Spheres = 2,
    /// Which points of a cloud are held out.
    Halves = 3,
    /// Noise on coefficients, and contacts.
    Noise = 4,
    /// The same, in pictures.
    Drawn = 5,
    /// Which transfers are measured against scattered starts, and those starts.
    Starts = 6,
}

/// The stream of a seed that one purpose uses for the object (or sphere) of a number.
///
/// Streams of the catalogue's scans are below 2³², those of purposes above.
pub fn stream(purpose: Purpose, number: usize) -> u64 {
    ((purpose as u64) << 32) | number as u64
}

/// The generator of one purpose for the object (or sphere) of a number.
pub fn generator(seed: u64, purpose: Purpose, number: usize) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(stream(purpose, number));
    rng
}
