//! Why a page was refused.

use thiserror::Error;

/// Why a page was refused: each variant names the part of the input and the value.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ReportError {
    /// A number is NaN or infinite.
    #[error("{place}: entry {index} is {value}, expected a finite number")]
    NotFinite {
        /// Which part of the input.
        place: String,
        /// Position of the entry in that part.
        index: usize,
        /// The value found.
        value: f64,
    },
    /// A value on a logarithmic axis is zero or negative.
    #[error("{place}: entry {index} is {value}, a logarithmic axis needs values above zero")]
    NotPositive {
        /// Which part of the input.
        place: String,
        /// Position of the entry in that part.
        index: usize,
        /// The value found.
        value: f64,
    },
    /// A triangle names a vertex that the mesh does not have.
    #[error("{place}: triangle {index} names vertex {vertex}, the mesh has {vertices}")]
    NoSuchVertex {
        /// Which mesh.
        place: String,
        /// Position of the triangle.
        index: usize,
        /// The vertex it names.
        vertex: u32,
        /// Number of vertices of the mesh.
        vertices: usize,
    },
    /// Two lists that belong together have different lengths.
    #[error("{place}: {found} entries, expected {expected}")]
    LengthMismatch {
        /// Which list.
        place: String,
        /// Number of entries it should have.
        expected: usize,
        /// Number of entries it has.
        found: usize,
    },
    /// A part that must hold something is empty.
    #[error("{place}: empty")]
    Empty {
        /// Which part.
        place: String,
    },
    /// A parameter lies outside its range.
    #[error("{place}: {value} is out of range, expected {expected}")]
    OutOfRange {
        /// Which parameter.
        place: String,
        /// The value found.
        value: f64,
        /// The range in words.
        expected: &'static str,
    },
}
