//! The numbers behind Fig. 4.

use serde::Serialize;

use crate::paper;
use crate::run::Run;

/// Amount of computation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Number of spheres.
    pub spheres: usize,
    /// Number of points of each sphere's cloud.
    pub sphere_points: usize,
    /// Number of equal steps of a deformation.
    pub deformation_steps: usize,
}

impl Settings {
    /// The settings of a run.
    pub fn of(run: &Run) -> Self {
        Self {
            spheres: run.scale.pick(10, paper::SPHERES),
            sphere_points: run.scale.pick(5_000, paper::CLOUD_POINTS),
            deformation_steps: 10,
        }
    }
}

/// One point of the shape space with its coordinates in the figures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Place {
    /// Label: an object's id, "sphere 30.0 mm", "S5→S1 at 0.10".
    pub label: String,
    /// "object", "sphere" or "deformation".
    pub kind: &'static str,
    /// Coordinates of the three-dimensional scaling, metres; the first two are those of the plane.
    pub coordinates: Vec<f64>,
}

/// Distance of a shape from the straight line between two others in the shape space.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Passing {
    /// The shape.
    pub id: String,
    /// Id of the start of the line.
    pub from: String,
    /// Id of the end of the line.
    pub to: String,
    /// Parameter of the nearest point of the line, 0 at the start and 1 at the end.
    pub t: f64,
    /// Distance from that point, metres.
    pub distance_m: f64,
    /// That distance divided by the distance from the nearer end.
    pub distance_over_nearer_end: f64,
    /// Whether no other object, including the ends, is nearer to that point.
    pub nearest_object_there: bool,
}

/// The sequence of spheres in the shape space.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SphereLine {
    /// Radii, metres.
    pub radii_m: Vec<f64>,
    /// Largest distance of a sphere from the line through the first and the last, divided by its
    /// length.
    pub bend: f64,
    /// Objects in order of their distance from the line: id, distance (m), radius of the sphere
    /// there (m).
    pub objects_by_distance: Vec<(String, f64, f64)>,
}

/// The numbers behind Fig. 4.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShapeSpace {
    /// Ids in the order of the table.
    pub ids: Vec<String>,
    /// d(f_i, f_j) = ‖β_i − β_j‖, metres.
    pub distances_m: Vec<Vec<f64>>,
    /// Distances of S7 and S8 from the four deformations.
    pub passings: Vec<Passing>,
    /// The spheres.
    pub spheres: Option<SphereLine>,
    /// Share of the squared distances that two and three dimensions reproduce.
    pub explained: [f64; 2],
    /// All points with their coordinates.
    pub places: Vec<Place>,
}
