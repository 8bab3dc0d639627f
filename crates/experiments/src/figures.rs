//! Pictures of what the sections found; nothing is measured here.

pub mod eigenfunctions;
pub mod gradient_ascent;
pub mod initial_grasps;
pub mod reconstruction;
pub mod sampling;
pub mod scattered_starts;
pub mod shape_space;
pub mod surfaces;
pub mod transfer;

use report::{Block, Section};

/// A section of figures with a line of text.
fn section(heading: &str, text: &str, blocks: Vec<Block>) -> Section {
    Section {
        heading: heading.to_owned(),
        text: text.to_owned(),
        blocks,
    }
}
