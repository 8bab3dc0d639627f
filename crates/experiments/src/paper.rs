//! The constants that the paper states and the numbers that it reports. The settings of its ascent
//! and its transfer are those of `space`.
//!
//! F. T. Pokorny, Y. Bekiroglu, D. Kragic, "Grasp Moduli Spaces and Spherical Harmonics",
//! ICRA 2014.

use std::ops::Range;

use space::{PaperAscent, PaperTransfer};

/// Number of points of a cloud (Sec. IV-A).
pub const CLOUD_POINTS: usize = 25_000;
/// Highest degree L of a surface (Sec. IV-A).
pub const DEGREE: usize = 50;
/// Coefficients of a surface, (L+1)² (Sec. IV-A).
pub const COEFFICIENTS: usize = 2_601;
/// A degree that captures even minute details (Sec. II-C).
pub const DETAILED_DEGREE: usize = 70;
/// Objects S_1 to S_12 (Fig. 4).
pub const OBJECTS: usize = 12;

/// The object whose cloud Fig. 2 shows.
pub const CLOUD_OBJECT: usize = 8;
/// Spheres added to the shape space (Sec. IV-A).
pub const SPHERES: usize = 30;
/// Smallest and largest radius of those spheres, metres.
pub const SPHERE_RADII: (f64, f64) = (0.03, 0.06);
/// The object that is deformed (Sec. IV-A).
pub const DEFORMED_FROM: usize = 5;
/// The objects into which it is deformed (Sec. IV-A).
pub const DEFORMED_TO: [usize; 4] = [1, 2, 10, 11];
/// The objects near which these deformations pass (Sec. IV-A).
pub const PASSED_BY_DEFORMATIONS: [usize; 2] = [7, 8];
/// The objects near which the sequence of spheres passes (Sec. IV-A).
pub const PASSED_BY_SPHERES: [usize; 2] = [11, 12];

/// Positions of β with noise in the top row of Fig. 5: β_0 … β_9.
pub const COARSE_BAND: Range<usize> = 0..10;
/// Positions of β with noise in the bottom row of Fig. 5: β_499 … β_599.
pub const FINE_BAND: Range<usize> = 499..600;
/// Number of contacts of a grasp (from Sec. IV-B on).
pub const CONTACTS: usize = 3;

/// Random hand poses per surface (Sec. IV-C).
pub const HAND_POSES: usize = 1_400;
/// Number of vertices of the collision mesh (Sec. IV-C).
pub const COLLISION_VERTICES: usize = 10_000;
/// The paper found more stable grasps than this on every object (Sec. IV-C).
pub const STABLE_GRASPS_ABOVE: usize = 200;
/// Size of G_i, the set of best grasps on S_i (Sec. IV-C).
pub const BEST_GRASPS: usize = 50;
/// Size of Ĝ_i, the set of the best grasps in G_i (Sec. IV-C).
pub const VERY_BEST_GRASPS: usize = 10;

/// Forward-difference step δ, radians (Sec. IV-D).
pub const DIFFERENCE_STEP: f64 = PaperAscent::PAPER.delta;
/// Step length of the ascent, radians (Sec. IV-D).
pub const ASCENT_RATE: f64 = PaperAscent::PAPER.rate;
/// Number of steps of the ascent on one surface (Sec. IV-D).
pub const ASCENT_STEPS: usize = PaperAscent::PAPER.steps;
/// Initial and final quality of the four ascents of Fig. 8.
pub const ASCENT_EXAMPLES: [(f64, f64); 4] =
    [(0.51, 0.72), (0.54, 0.64), (0.62, 0.70), (0.62, 0.67)];

/// Number of stations γ(0), γ(0.1), …, γ(1) of a transfer (Sec. IV-E).
pub const TRANSFER_STATIONS: usize = PaperTransfer::PAPER.intervals + 1;
/// Number of steps of the ascent on each station (Sec. IV-E).
pub const TRANSFER_STEPS: usize = PaperTransfer::PAPER.ascent.steps;
/// Number of transfers per source surface (Sec. IV-E).
pub const TRANSFERS_PER_SOURCE: usize = 110;
/// Number of all transfers (Sec. IV-E).
pub const TRANSFERS: usize = 1_320;
/// Quality below which a grasp is unstable (Sec. IV-E).
pub const UNSTABLE_BELOW: f64 = 0.01;
/// Number of unstable transfers (Sec. IV-E).
pub const UNSTABLE_TRANSFERS: usize = 9;
/// Unstable transfers by source surface; all other surfaces had none (Sec. IV-E).
pub const UNSTABLE_BY_SOURCE: [(usize, usize); 5] = [(2, 2), (4, 1), (5, 1), (9, 4), (10, 1)];

/// The ascent of Sec. IV-D with another number of steps.
pub fn ascent(steps: usize) -> PaperAscent {
    PaperAscent {
        steps,
        ..PaperAscent::PAPER
    }
}

/// Number of unstable transfers that the paper reports from source surface S_i.
pub fn unstable_from(source: usize) -> usize {
    UNSTABLE_BY_SOURCE
        .iter()
        .find(|(number, _)| *number == source)
        .map_or(0, |(_, count)| *count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_fit_together() {
        assert_eq!(sph::index::count(DEGREE), COEFFICIENTS);
        assert_eq!(catalogue::SCAN_POINTS, CLOUD_POINTS);
        assert_eq!(catalogue::library_objects().len(), OBJECTS);
        assert_eq!((OBJECTS - 1) * VERY_BEST_GRASPS, TRANSFERS_PER_SOURCE);
        assert_eq!(OBJECTS * TRANSFERS_PER_SOURCE, TRANSFERS);
        let unstable: usize = (1..=OBJECTS).map(unstable_from).sum();
        assert_eq!(unstable, UNSTABLE_TRANSFERS);
        let fine = FINE_BAND;
        assert!(COARSE_BAND.end <= fine.start && fine.end <= COEFFICIENTS);
    }
}
