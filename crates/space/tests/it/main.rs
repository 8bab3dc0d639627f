//! The integration tests of `space`, as one program.

mod allocation;
mod ascent;
mod common;
mod maps;
mod monotone;
mod pairs;
mod paper_schemes;
mod space;
