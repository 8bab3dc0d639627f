//! The integration tests of `experiments`, as one program.

mod library;
mod program;
mod sections;
