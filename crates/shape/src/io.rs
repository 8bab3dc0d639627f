//! Reading clouds and meshes, and writing meshes. Bytes in, values out; no file is opened here.

mod array;
mod content;
mod error;
mod format;
mod geometry;
mod gltf;
mod gltf_buffers;
mod load;
mod lzf;
mod obj;
mod off;
mod pcd;
mod ply;
mod ply_body;
mod ply_header;
mod polygon;
mod stl;
mod table_header;
mod text;
mod write;
mod xyz;
mod zip;

pub use error::LoadError;
pub use format::Format;
pub use geometry::{Geometry, ImplausibleExtent, Loaded, Warning};
pub use load::{foreign_kind, read_cloud};
pub use ply::{PlyPoints, read_ply};
pub use write::{MeshFormat, write_mesh, write_ply};
