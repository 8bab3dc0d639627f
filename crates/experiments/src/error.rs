//! Errors of experiments.

use std::path::PathBuf;

/// Why an experiment has no result.
#[derive(Debug, thiserror::Error)]
pub enum ExperimentError {
    /// A folder of clouds cannot be listed.
    #[error("cannot read the folder {path}: {reason}")]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The error of the operating system.
        reason: std::io::Error,
    },
    /// No object has the requested id.
    #[error("no object `{id}` in {source_name}; there are {known}")]
    UnknownObject {
        /// The id.
        id: String,
        /// Where the id was searched.
        source_name: String,
        /// The ids that exist.
        known: String,
    },
    /// Too few objects are usable.
    #[error(
        "{fitted} of {given} objects of {source_name} can be used; expected at least {needed}{reasons}"
    )]
    TooFewObjects {
        /// Objects with a fitted surface.
        fitted: usize,
        /// Objects found.
        given: usize,
        /// Least number of objects.
        needed: usize,
        /// Origin of the objects.
        source_name: String,
        /// Why the others were refused, one line each.
        reasons: String,
    },
    /// No stable grasp was found, and the experiment needs one.
    #[error("no stable grasp of {poses} poses on any object; more poses may help")]
    NoGrasps {
        /// Poses tried on each object.
        poses: usize,
    },
    /// No convention has this name.
    #[error(transparent)]
    Convention(#[from] grasp::UnknownConvention),
    /// A fit failed.
    #[error("{id}: {source}")]
    Fit {
        /// The object.
        id: String,
        /// The cause.
        source: shape::FitError,
    },
    /// Points that are not a usable cloud.
    #[error(transparent)]
    Cloud(#[from] shape::CloudError),
    /// A regression failed.
    #[error(transparent)]
    Regression(#[from] sph::regression::RegressionError),
    /// The built-in hand could not be loaded.
    #[error(transparent)]
    Hand(#[from] hand::LoadError),
    /// A step from scans to grasps failed.
    #[error(transparent)]
    Grasps(#[from] moduli::Error),
    /// A quality could not be computed.
    #[error(transparent)]
    Quality(#[from] grasp::QualityError),
    /// Shapes could not be combined.
    #[error(transparent)]
    Space(#[from] shape::algebra::SpaceError),
    /// A transfer failed.
    #[error(transparent)]
    Transfer(#[from] space::TransferError),
    /// A result could not be written.
    #[error(transparent)]
    Write(#[from] run::WriteError),
    /// Completed jobs could not be stored.
    #[error(transparent)]
    Ledger(#[from] run::ledger::LedgerError),
    /// The file of the running program could not be read.
    #[error("cannot read this program, whose digest marks unfinished results: {0}")]
    Program(std::io::Error),
    /// A page was refused.
    #[error(transparent)]
    Report(#[from] report::ReportError),
    /// A surface is not in M^rad.
    #[error(transparent)]
    Radial(#[from] shape::RadialError),
    /// The library could not be encoded.
    #[error(transparent)]
    Record(#[from] record::EnvelopeError),
    /// A result could not be converted to JSON.
    #[error("cannot write JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// Threads could not be started.
    #[error(transparent)]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

impl ExperimentError {
    /// 3 for bad input, 4 for a numerical refusal, 1 for anything else.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Folder { .. }
            | Self::UnknownObject { .. }
            | Self::TooFewObjects { .. }
            | Self::Cloud(_) => 3,
            Self::Write(_)
            | Self::Ledger(_)
            | Self::Program(_)
            | Self::Report(_)
            | Self::Record(_)
            | Self::Json(_)
            | Self::Hand(_)
            | Self::Threads(_) => 1,
            _ => 4,
        }
    }
}
