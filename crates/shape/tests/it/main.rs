//! The tests of `shape` that use it from outside, as one program.

mod acceptance;
mod common;
mod embeddings;
mod formats;
mod loading;
mod mutations;
mod octahedron;
mod open_containers;
mod outliers;
mod properties;
mod real_scans;
mod scenes;
mod smoothing;
mod spherical;
mod spherical_clouds;
mod true_surfaces;
