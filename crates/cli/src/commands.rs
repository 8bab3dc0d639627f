//! One module per command.

pub(crate) mod ascend;
pub(crate) mod distance;
pub(crate) mod eval;
pub(crate) mod export;
pub(crate) mod fit;
pub(crate) mod grasp;
pub(crate) mod hand_check;
pub(crate) mod hand_init;
pub(crate) mod info;
pub(crate) mod library;
pub(crate) mod manual;
pub(crate) mod mesh;
pub(crate) mod quality;
pub(crate) mod synthesize;
pub(crate) mod transfer;
