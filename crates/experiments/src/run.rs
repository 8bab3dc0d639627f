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

/// Amount of computation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Scale {
    /// The same computation on fewer objects, poses, grasps or steps; takes seconds.
    Small,
    /// The numbers of the paper.
    Full,
}

impl Scale {
    /// The name on the command line.
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
    /// Origin of the objects.
    pub objects: ObjectSource,
    /// Ids of the objects to use; all if empty.
    pub only: &'a [String],
    /// Amount of computation.
    pub scale: Scale,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Convention of grasp quality.
    pub convention: Convention,
    /// Settings of the fits.
    pub fit: FitSettings,
    /// Folder in which long computations store completed jobs, see [`crate::ledger`].
    pub keep: Option<&'a Path>,
    /// Called with a line of text when a step begins.
    pub progress: &'a (dyn Fn(&str) + Sync),
}

/// Fit settings from L and λ; if λ is absent it is chosen from the data.
pub fn fit_settings(degree: usize, lambda: Option<f64>) -> FitSettings {
    FitSettings { degree, lambda }
}

impl<'a> Run<'a> {
    /// A run on the built-in objects with the paper's degree and the given convention.
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

/// Purpose of random numbers; every purpose has its own streams.
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
    /// Noise and contacts of samples in figures.
    Drawn = 5,
    /// Which transfers are measured against scattered starts, and those starts.
    Starts = 6,
}

/// The stream of the seed for one purpose and the object (or sphere) of this number.
///
/// The catalogue's scans use streams below 2³²; those of purposes are above.
pub fn stream(purpose: Purpose, number: usize) -> u64 {
    ((purpose as u64) << 32) | number as u64
}

/// The generator for one purpose and the object (or sphere) of this number.
pub fn generator(seed: u64, purpose: Purpose, number: usize) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(stream(purpose, number));
    rng
}
