//! The rules of the workspace, checked on its sources.
//!
//! They cover which crate may use which, which module may use which foreign crate, cycles of
//! modules, the lengths of files and functions, and the first page of every crate. ARCHITECTURE.md
//! states the same rules in prose.

mod circles;
mod crates;
mod imports;
mod sizes;
mod sources;
