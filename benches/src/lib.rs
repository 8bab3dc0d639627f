//! Benchmarks of every layer, and side-by-side runs against peers.
