//! The grasp moduli space M × (S²)^m, M being M^rad or M^sph: points, metrics, curves, ascent and
//! transfer.
//!
//! Implements Sec. III-C, IV-B, IV-D and IV-E of the paper. Surfaces and contacts are in the
//! centred frame of `shape`.
//!
//! A grasp of three contacts on a ball is made better; the quality never falls on the way:
//!
//! ```
//! use grasp::Convention;
//! use nalgebra::{Point3, Vector3};
//! use shape::RadialShape;
//! use space::{MonotoneAscent, Objective};
//! use sph::Direction;
//!
//! let ball = RadialShape::sphere(4, 0.04)?;
//! let mut quality = Objective::new(&Convention::paper(), &ball, &Point3::origin());
//! let start = [
//!     Vector3::new(1.0, 0.0, 0.1),
//!     Vector3::new(-0.5, 0.7, 0.0),
//!     Vector3::new(-0.3, -1.0, 0.2),
//! ]
//! .map(Direction::new_normalize);
//!
//! let ascent = MonotoneAscent::default().climb(&ball, &start, &mut quality, |_| {})?;
//! assert!(ascent.start_quality > 0.0);
//! assert!(ascent.quality > ascent.start_quality);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod ascent;
pub mod chart;
pub mod constraints;
pub mod gradient;
pub mod metric;
mod multistart;
pub mod objective;
pub mod path;
pub mod point;
pub mod quality;
pub mod resolved;
pub mod sample;
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
    Continuation, Correspondence, PaperTransfer, Recovery, Transfer, TransferEnd, TransferError,
    Transferred, distance_of,
};
