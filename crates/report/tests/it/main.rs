//! The tests of `report` that use it from outside, as one program.

mod pages;
