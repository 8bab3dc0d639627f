//! Benchmarks of every crate, and comparisons with other libraries.
