//! From a scan of an object to ranked grasps that a robot hand can execute.
//!
//! An [`Object`] is a smooth surface, fitted to a point cloud and proved valid. A [`Measure`] is a
//! convention of grasp quality resolved on that object. With a [`Hand`] it synthesizes grasps by
//! closing the hand from sampled poses. A [`Library`] of known objects provides grasps that are
//! transferred to the object. A [`Plan`] does both and ranks the results.
//!
//! ```
//! use moduli::{Convention, Format, Hand, Library, Object, Poses};
//!
//! # let scan = catalogue::by_id("U1").unwrap().scan(0);
//! # let lines = scan.iter().map(|p| format!("{} {} {}\n", p.x, p.y, p.z));
//! # let bytes = lines.collect::<String>().into_bytes();
//! # let format = Format::Xyz;
//! # /*
//! let (bytes, format) = (std::fs::read("scan.ply")?, Format::Ply);
//! # */
//! let object = Object::from_bytes(&bytes, format)?; // fitted, and proved positive everywhere
//! let measure = object.measure(&Convention::paper())?; // centre, torque length and threshold
//! let hand = Hand::schunk_sdh()?;
//! let mut grasps = measure.synthesize(&hand, &Poses { count: 200, ..Poses::default() })?;
//! grasps.extend(Library::builtin().transfer_to(&measure, &hand)?);
//! for grasp in grasps.best(10) {
//!     println!("{:.3} {:?}", grasp.quality(), grasp.contacts_in_cloud());
//! }
//! # assert_eq!(grasps.best(10).len(), 10);
//! # Ok::<(), moduli::Error>(())
//! ```
//!
//! Lengths are metres and angles radians. Arguments and results are in the frame of the *cloud*.
//! Computation happens in the *centred* frame, whose origin is the mean of the cloud;
//! [`CloudFrame`] converts between the two.

mod carried;
mod error;
mod foot;
mod frame;
mod grasp;
pub mod grasps_file;
mod hand_contacts;
mod hands;
mod library;
mod library_entry;
mod measure;
mod metrics;
mod object;
mod plan;
pub mod records;
mod synthesis;

pub use crate::error::Error;
pub use crate::frame::CloudFrame;
pub use crate::grasp::{Grasp, Grasps, HandPlacement, Source, ranked};
pub use crate::hand_contacts::{FoundContacts, HandContacts, NoContact};
pub use crate::hands::HandSearch;
pub use crate::library::{Library, Neighbour, TransferOptions};
pub use crate::library_entry::{Kept, separation};
pub use crate::measure::{Measure, uncertainty};
pub use crate::metrics::Metrics;
pub use crate::object::{
    FitReport, Fitted, Model, Object, Reconstruction, ReconstructionSettings, SurfacePoint,
    object_points, reconstruct, scene_notes,
};
pub use crate::plan::{Plan, Planned, Progress, Stage, TransferCounts};
pub use crate::synthesis::Poses;

pub use ::grasp::{
    CentreRule, Contact, Convention, EdgeNorm, Edges, Epsilon, GraspModel, Resistance, TangentRule,
    TorqueLength, Uncertainty, Wrench,
};
pub use ::hand::{Hand, OutcomeCounts, TipModel};
pub use ::record;
pub use ::shape::io::Format;
pub use ::shape::{
    Acceptance, AnyField, AnyShape, ClosedPatch, Embedding, Evidence, Fit, FitSettings, PointCloud,
    RadialShape, Scene, SceneSettings, SphericalSettings, SphericalShape, Support, SupportRule,
    SupportSource, Surface, Verdict,
};
pub use ::sph::Direction;
pub use nalgebra;

/// What most programs want.
pub mod prelude {
    pub use crate::{
        Convention, Format, Grasp, Grasps, Hand, Library, Measure, Object, Plan, Poses,
    };
}
