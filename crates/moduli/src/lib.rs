//! The grasp moduli space M^rad × (S²)^m: points, metrics, curves, ascent and transfer.
//!
//! Implements Sec. III-C, IV-B, IV-D and IV-E of the paper. Surfaces and contacts are in the
//! centred frame of `shape`.

pub mod ascent;
pub mod chart;
pub mod gradient;
pub mod metric;
pub mod objective;
pub mod path;
pub mod point;
pub mod sample;
pub mod transfer;

pub use ascent::{Ascent, MonotoneAscent, PaperAscent, Step};
pub use metric::MetricError;
pub use objective::Objective;
pub use path::Path;
pub use point::ModuliPoint;
pub use transfer::{Continuation, PaperTransfer, TransferError, Transferred};
