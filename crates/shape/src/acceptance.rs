//! Whether a surface may be called the surface of a cloud.

mod distance;
mod local_noise;

use std::fmt;

use nalgebra::{Point3, Vector3};
use sph::Direction;

use crate::surface::Surface;
use crate::voxel_grid::{KeyMap, key};

pub use distance::nearest_places;
pub use local_noise::noise;

/// A point is explained within this many standard deviations of the noise of the surface,
const DEVIATIONS: f64 = 4.0;
/// or within this share of the diameter of the cloud.
const LEAST_TOLERANCE: f64 = 0.005;
/// Beyond this share of the diameter no noise explains a point: points that fill a volume have no noise
/// of a surface.
const MOST_TOLERANCE: f64 = 0.03;
/// Share of the points that may be unexplained.
pub const MAX_UNEXPLAINED: f64 = 0.02;
/// A surface that explains fewer points is coarse if no more than the second share of the points is
/// farther from it than the first share of the diameter.
const COARSE: (f64, f64) = (0.015, 0.06);
/// Boxes along the diameter in which the largest cluster of unexplained points is looked for.
const BOXES: f64 = 8.0;

/// How well a surface explains the points of its cloud.
///
/// A proof that a surface is valid says nothing about the points: a ball is a valid surface and no
/// description of a needle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Acceptance {
    /// Standard deviation σ of the points from a smooth surface, from quadrics through their
    /// neighbours, metres.
    pub noise_m: f64,
    /// A point is explained if it is at most so far from the surface: 4σ, at least 0.5 % and at most
    /// 3 % of the diameter of the cloud. Metres.
    pub tolerance_m: f64,
    /// Share of the points that are not explained, 0 to 1.
    pub unexplained_share: f64,
    /// Share of the points that are farther from the surface than 1.5 % of the diameter.
    pub far_share: f64,
    /// Root mean square of the distances of the points from the surface, metres.
    pub surface_rms_m: f64,
    /// Where most of the points that are not explained are.
    pub worst: Option<Cluster>,
}

/// Points that a surface does not explain, near each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cluster {
    /// Their mean, in the frame of the points.
    pub centre: Point3<f64>,
    /// Their share of all points, 0 to 1.
    pub share: f64,
    /// Their largest distance from the surface, metres.
    pub farthest_m: f64,
}

/// What a surface is worth as a description of its cloud.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// At least 98 % of the points are explained.
    Explained,
    /// Fewer are, but at least 94 % of the points are within 1.5 % of the diameter: the form is right and
    /// edges, steps and recesses are rounded off.
    Coarse,
    /// The surface is no description of the points.
    Unexplained,
}

impl Acceptance {
    /// Measures the distances of points from a surface whose origin is at `origin` in their frame; the
    /// axes are the same.
    ///
    /// `start` gives a direction per point from which the nearest place on the surface is looked for:
    /// for a radial surface the direction of the point. Where that search ends too far from the point, and
    /// where there is no direction, it begins again at the nearest of 4,000 places on the surface.
    /// `noise` is σ of [`noise`]. Costs a few evaluations of the surface per point, on all threads of the
    /// pool; the order of the points matters only for the rounding of the sums.
    pub fn measure(
        surface: &(impl Surface + Sync),
        origin: &Point3<f64>,
        points: &[Point3<f64>],
        start: impl Fn(usize) -> Option<Direction> + Sync,
        noise: f64,
    ) -> Self {
        let diameter = diameter(points);
        let tolerance =
            (DEVIATIONS * noise).clamp(LEAST_TOLERANCE * diameter, MOST_TOLERANCE * diameter);
        let distances = distance::distances(surface, origin, points, start, tolerance);
        let count = points.len().max(1) as f64;
        let squares: f64 = distances.iter().map(|d| d * d).sum();
        // Written so that NaN is not explained.
        let far: Vec<usize> = (0..points.len())
            .filter(|i| !(distances[*i] <= tolerance))
            .collect();
        let limit = tolerance.max(COARSE.0 * diameter);
        let beyond = far.iter().filter(|i| !(distances[**i] <= limit));
        Self {
            far_share: beyond.count() as f64 / count,
            noise_m: noise,
            tolerance_m: tolerance,
            unexplained_share: far.len() as f64 / count,
            surface_rms_m: (squares / count).sqrt(),
            worst: worst(points, &distances, &far, diameter / BOXES),
        }
    }

    /// What the surface is worth.
    pub fn verdict(&self) -> Verdict {
        if self.unexplained_share <= MAX_UNEXPLAINED {
            Verdict::Explained
        } else if self.far_share <= COARSE.1 {
            Verdict::Coarse
        } else {
            Verdict::Unexplained
        }
    }
}

impl fmt::Display for Acceptance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the surface explains {:.1} % of the points, expected at least {:.0} %",
            100.0 * (1.0 - self.unexplained_share),
            100.0 * (1.0 - MAX_UNEXPLAINED)
        )?;
        if let Some(worst) = &self.worst {
            let c = worst.centre;
            write!(
                f,
                ": of those farther than {:.1} mm from it, most are around ({:.3}, {:.3}, {:.3}) m ({:.1} % of all, up to {:.1} mm away)",
                1e3 * self.tolerance_m,
                c.x,
                c.y,
                c.z,
                100.0 * worst.share,
                1e3 * worst.farthest_m
            )?;
        }
        Ok(())
    }
}

/// Diagonal of the bounding box, metres.
fn diameter(points: &[Point3<f64>]) -> f64 {
    let Some(first) = points.first() else {
        return 0.0;
    };
    let (mut low, mut high) = (first.coords, first.coords);
    for p in points {
        low = low.inf(&p.coords);
        high = high.sup(&p.coords);
    }
    (high - low).norm()
}

/// The box that holds most of the points in question.
fn worst(points: &[Point3<f64>], distances: &[f64], far: &[usize], side: f64) -> Option<Cluster> {
    let mut boxes: KeyMap<Vec<usize>> = KeyMap::default();
    for &i in far {
        boxes.entry(key(&points[i], side)).or_default().push(i);
    }
    // The key breaks ties, so that the order of the map does not.
    let fullest = boxes
        .into_iter()
        .max_by_key(|(key, members)| (members.len(), *key))?;
    let members = fullest.1;
    let first = points[members[0]];
    let sum: Vector3<f64> = members.iter().map(|i| points[*i] - first).sum();
    Some(Cluster {
        centre: first + sum / members.len() as f64,
        share: members.len() as f64 / points.len() as f64,
        farthest_m: members.iter().map(|i| distances[*i]).fold(0.0, f64::max),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radial::RadialShape;
    use sph::Coefficients;
    use sph::direction::even_directions;

    fn ball() -> RadialShape {
        RadialShape::new(Coefficients::constant(4, 0.05)).unwrap()
    }

    fn on_a_sphere(radius: f64) -> Vec<Point3<f64>> {
        let directions = even_directions(3000);
        directions
            .iter()
            .map(|p| Point3::from(p.into_inner() * radius))
            .collect()
    }

    fn measured(points: &[Point3<f64>]) -> Acceptance {
        Acceptance::measure(&ball(), &Point3::origin(), points, |_| None, noise(points))
    }

    #[test]
    fn points_on_the_surface_are_explained_and_a_lid_beside_it_is_not() {
        let mut points = on_a_sphere(0.05);
        let clean = measured(&points);
        assert!(clean.verdict() == Verdict::Explained && clean.unexplained_share == 0.0);
        assert!(
            clean.surface_rms_m <= 1e-9 && clean.noise_m <= 1e-5,
            "{clean:?}"
        );
        assert_eq!(clean.worst, None);
        for p in points.iter_mut().filter(|p| p.z > 0.045) {
            p.z += 0.02;
        }
        let lifted = measured(&points);
        assert!(
            (0.04..0.06).contains(&lifted.unexplained_share),
            "{lifted:?}"
        );
        let worst = lifted.worst.unwrap();
        assert!(worst.centre.z > 0.06 && (worst.farthest_m - 0.02).abs() <= 1e-3);
        assert_eq!(lifted.verdict(), Verdict::Coarse);
        assert!(lifted.to_string().contains("95.0 %"), "{lifted}");
    }

    #[test]
    fn points_that_fill_a_volume_are_not_noise() {
        let points: Vec<Point3<f64>> = (1..=3000)
            .flat_map(|i| {
                let radius = 0.05 * (f64::from(i) / 3000.0).cbrt();
                on_a_sphere(radius)
                    .into_iter()
                    .skip(i as usize % 3000)
                    .take(1)
            })
            .collect();
        let filled = measured(&points);
        assert!(filled.unexplained_share >= 0.5, "{filled:?}");
        assert_eq!(filled.verdict(), Verdict::Unexplained);
    }
}
