//! Distances between the parts of a hand and to the object; the only user of parry.

mod extent;
mod gap;
mod line;
mod object;
mod piece;
mod piece_frame;
mod self_distance;
mod surroundings;
mod tree;

pub use gap::Gap;
pub(crate) use line::Crossing;
pub use object::{CollisionObject, ObjectError, Precision};
pub use piece::GeometryError;
pub(crate) use piece::{ConvexPiece, LinkShape, check_hull};
pub(crate) use self_distance::{all_close_pairs, first_close_pair};
pub use surroundings::{PointTree, Surroundings};
