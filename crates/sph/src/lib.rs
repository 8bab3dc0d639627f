//! Real functions on the unit sphere: evaluation, transforms and regression.
//!
//! The basis is the paper's: real, orthonormal spherical harmonics without the Condon–Shortley
//! phase (Sec. II-C), stored at position l² + l + m. See `CONVENTIONS.md`.
//!
//! - [`Coefficients`] are the numbers β_{l,m} of a function; [`Basis`] evaluates them exactly.
//! - [`Field`] evaluates one function very often, from a table, with a stated error.
//! - [`scattered`] evaluates a function at many points at once; [`regression`] is the way back, from
//!   values at points to coefficients.
//! - [`bounds`] proves a lower and an upper bound of a function over the whole sphere.
//!
//! ```
//! use nalgebra::Vector3;
//! use sph::{Coefficients, Direction, index, scattered::Scattered};
//!
//! // f(p) = 1 + z / 2, written in harmonics: Y_{1,0} = √(3 / 4π) z.
//! let mut beta = Coefficients::constant(1, 1.0);
//! beta.as_mut_slice()[index::position(1, 0)] = 0.5 * (4.0 * std::f64::consts::PI / 3.0).sqrt();
//!
//! let points = [Vector3::z(), Vector3::x(), -Vector3::z()].map(Direction::new_normalize);
//! let values = Scattered::new(&points).evaluate(&beta);
//! for (value, expected) in values.iter().zip([1.5, 1.0, 0.5]) {
//!     assert!((value - expected).abs() < 1e-12);
//! }
//! ```

#![allow(
    clippy::needless_range_loop,
    reason = "loops over lanes go by index, so that they become vector instructions"
)]

pub mod basis;
pub mod batch;
pub mod bounds;
pub mod coefficients;
pub mod direction;
mod double_fourier;
mod fft;
pub mod field;
pub mod grid;
pub mod index;
mod kernel;
mod lanes;
mod legendre;
mod multiply_add;
pub mod regression;
mod ring_pairs;
pub mod rotation;
pub mod scattered;
mod transform;
mod two_step;

pub use basis::{Basis, Harmonic, Jet};
pub use coefficients::{Coefficients, CoefficientsError};
pub use direction::{Direction, SphericalCoords};
pub use field::Field;
