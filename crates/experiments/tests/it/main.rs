//! The tests of `experiments` that use it from outside, as one program.

mod library;
mod program;
mod sections;
