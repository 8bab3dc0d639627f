//! Real functions on the unit sphere: evaluation, transforms and regression.
//!
//! The basis is the paper's: real, orthonormal spherical harmonics without the Condon–Shortley
//! phase (Sec. II-C), stored at position l² + l + m. See `CONVENTIONS.md`.

#![allow(
    clippy::needless_range_loop,
    reason = "loops over lanes go by index, so that they become vector instructions"
)]

pub mod basis;
pub mod batch;
pub mod bounds;
pub mod coefficients;
pub mod direction;
mod fft;
pub mod field;
mod fused;
pub mod grid;
pub mod index;
mod kernel;
mod ladder;
mod legendre;
pub mod regression;
mod rings;
pub mod rotation;
pub mod scattered;
mod torus;
mod transform;

pub use basis::{Basis, Harmonic, Jet};
pub use coefficients::{Coefficients, CoefficientsError};
pub use direction::{Direction, SphericalCoords};
pub use field::Field;
