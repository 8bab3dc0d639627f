//! The integration tests of `report`, as one program.

mod pages;
