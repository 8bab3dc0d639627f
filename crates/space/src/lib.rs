//! The grasp moduli space M^rad × (S²)^m: points, metrics, curves, ascent and transfer.
//!
//! Implements Sec. III-C, IV-B, IV-D and IV-E of the paper. Surfaces and contacts are in the
//! centred frame of `shape`.

pub mod ascent;
pub mod chart;
pub mod constraints;
pub mod gradient;
pub mod metric;
pub mod objective;
pub mod path;
pub mod point;
pub mod quality;
pub mod resolved;
pub mod sample;
mod scatter;
pub mod transfer;

pub use ascent::{Ascent, AscentError, MonotoneAscent, PaperAscent, Step};
pub use constraints::{Cap, ConstraintError, Constraints};
pub use metric::MetricError;
pub use objective::Objective;
pub use path::Path;
pub use point::ModuliPoint;
pub use quality::{ByDifferences, LinearPieces, Quality};
pub use resolved::ResolvedConvention;
pub use transfer::{
    Continuation, PaperTransfer, Recovery, Transfer, TransferEnd, TransferError, Transferred,
};
