//! The rules of the house, checked on the sources of the whole workspace.
//!
//! Which crate may use which, which foreign crate has which door, no circle of modules but parent
//! and child, short files and functions, and a first page with a program for every crate.
//! ARCHITECTURE.md states the same rules for people.

mod circles;
mod crates;
mod imports;
mod sizes;
mod sources;
