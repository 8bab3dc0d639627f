//! Reading clouds and writing meshes. Bytes in, values out; no file is opened here.

pub mod ply;

pub use ply::{PlyError, read_ply, write_ply};
