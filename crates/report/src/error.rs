//! Errors of pages.

use thiserror::Error;

/// Why a page cannot be made. Each variant names the part of the input and the value.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ReportError {
    /// A number is NaN or infinite.
    #[error("{place}: entry {index} is {value}, expected a finite number")]
    NotFinite {
        /// The part of the input.
        place: String,
        /// Position of the entry in that part.
        index: usize,
        /// The value found.
        value: f64,
    },
    /// A value on a logarithmic axis is zero or negative.
    #[error("{place}: entry {index} is {value}, a logarithmic axis needs values above zero")]
    NotPositive {
        /// The part of the input.
        place: String,
        /// Position of the entry in that part.
        index: usize,
        /// The value found.
        value: f64,
    },
    /// A triangle refers to a vertex that the mesh does not have.
    #[error("{place}: triangle {index} names vertex {vertex}, the mesh has {vertices}")]
    NoSuchVertex {
        /// The mesh.
        place: String,
        /// Index of the triangle.
        index: usize,
        /// Index of the missing vertex.
        vertex: u32,
        /// Number of vertices of the mesh.
        vertices: usize,
    },
    /// Two lists that belong together have different lengths.
    #[error("{place}: {found} entries, expected {expected}")]
    LengthMismatch {
        /// The list.
        place: String,
        /// Expected number of entries.
        expected: usize,
        /// Number of entries found.
        found: usize,
    },
    /// A part that must not be empty is empty.
    #[error("{place}: empty")]
    Empty {
        /// The part.
        place: String,
    },
    /// A parameter lies outside its range.
    #[error("{place}: {value} is out of range, expected {expected}")]
    OutOfRange {
        /// The parameter.
        place: String,
        /// The value found.
        value: f64,
        /// The allowed range.
        expected: &'static str,
    },
}
