//! Why bytes are not a PLY cloud or mesh.

/// Why bytes are not a usable PLY file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlyError {
    /// The file is not PLY, or is damaged.
    #[error("not a readable PLY file: {reason}")]
    Parse {
        /// What the parser found.
        reason: String,
    },
    /// There is no vertex element.
    #[error("the PLY file has no element `vertex`")]
    NoVertices,
    /// A vertex lacks a coordinate.
    #[error("vertex {index} of the PLY file has no number `{property}`")]
    Coordinate {
        /// Which vertex.
        index: usize,
        /// x, y or z.
        property: &'static str,
    },
    /// A face names a vertex that the file does not have.
    #[error("face {index} of the PLY file has corner {corner}; expected numbers below {vertices}")]
    Corner {
        /// Which face.
        index: usize,
        /// The number it names.
        corner: u32,
        /// Vertices in the file.
        vertices: usize,
    },
}
