//! Point clouds, and their directions and radii about a centre.

use std::sync::Arc;

use nalgebra::{Point3, Vector3};
use sph::Direction;
use sph::direction::direction_and_radius;

/// Why points are not accepted as a cloud.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CloudError {
    /// Too few points for a surface.
    #[error("{count} points; expected at least {needed}")]
    TooFew {
        /// Points given.
        count: usize,
        /// Points needed.
        needed: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("point {index} is ({x}, {y}, {z}); expected finite coordinates")]
    NotFinite {
        /// Which point.
        index: usize,
        /// x as found.
        x: f64,
        /// y as found.
        y: f64,
        /// z as found.
        z: f64,
    },
    /// A coordinate beyond [`PointCloud::FARTHEST`].
    #[error(
        "point {index} has the coordinate {value:e} m; expected at most {limit:e} m from the origin: is the unit right? Subtract the offset of map coordinates",
        limit = PointCloud::FARTHEST
    )]
    TooFar {
        /// Which point.
        index: usize,
        /// The coordinate.
        value: f64,
    },
    /// An extent below [`PointCloud::LEAST_EXTENT`].
    #[error(
        "the cloud has an extent of {extent:e} m; expected at least {least:e} m: is the unit right?",
        least = PointCloud::LEAST_EXTENT
    )]
    TooSmall {
        /// Largest side of the bounding box.
        extent: f64,
    },
    /// All points coincide.
    #[error("the cloud has no extent: all points are at the same place")]
    NoExtent,
}

/// Points of an object's surface, metres, in the frame of their source. They are always finite. Copies
/// share the points.
#[derive(Clone, Debug, PartialEq)]
pub struct PointCloud {
    points: Arc<Vec<Point3<f64>>>,
}

/// A cloud seen from a centre: directions on the sphere and radii.
#[derive(Clone, Debug, PartialEq)]
pub struct RadialSamples {
    /// pᵢ.
    pub directions: Vec<Direction>,
    /// rᵢ, metres.
    pub radii: Vec<f64>,
}

impl PointCloud {
    /// The least number of points that bound a solid.
    pub const MIN_POINTS: usize = 4;

    /// Largest coordinate, metres.
    pub const FARTHEST: f64 = 1e6;

    /// Least extent, metres.
    pub const LEAST_EXTENT: f64 = 1e-9;

    /// Checks that there are enough points, that all are finite and within
    /// [`PointCloud::FARTHEST`], and that they have an extent.
    ///
    /// # Errors
    /// The first of these conditions that fails, with the point.
    pub fn new(points: Vec<Point3<f64>>) -> Result<Self, CloudError> {
        if points.len() < Self::MIN_POINTS {
            return Err(CloudError::TooFew {
                count: points.len(),
                needed: Self::MIN_POINTS,
            });
        }
        let bad = |p: &Point3<f64>| !p.iter().all(|x| x.is_finite());
        if let Some(index) = points.iter().position(bad) {
            let Point3 { coords: p } = points[index];
            return Err(CloudError::NotFinite {
                index,
                x: p.x,
                y: p.y,
                z: p.z,
            });
        }
        let far = |p: &Point3<f64>| p.iter().any(|x| x.abs() > Self::FARTHEST);
        if let Some(index) = points.iter().position(far) {
            let value = points[index].coords.iter().copied();
            let value = value.fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
            return Err(CloudError::TooFar { index, value });
        }
        let cloud = Self {
            points: Arc::new(points),
        };
        let extent = cloud.extent().max();
        if extent >= Self::LEAST_EXTENT {
            Ok(cloud)
        } else if extent > 0.0 {
            Err(CloudError::TooSmall { extent })
        } else {
            Err(CloudError::NoExtent)
        }
    }

    /// The points, metres.
    pub fn points(&self) -> &[Point3<f64>] {
        &self.points
    }

    /// Size of the bounding box along x, y, z, metres.
    pub fn extent(&self) -> Vector3<f64> {
        let mut low = self.points[0].coords;
        let mut high = low;
        for p in self.points.iter() {
            low = low.inf(&p.coords);
            high = high.sup(&p.coords);
        }
        high - low
    }

    /// Mean of the points: the paper's centre of mass (Sec. IV-A).
    pub fn mean(&self) -> Point3<f64> {
        // Summed as offsets from the first point, so that a far-away cloud keeps its digits.
        let first = self.points[0];
        let sum: Vector3<f64> = self.points.iter().map(|p| p - first).sum();
        first + sum / self.points.len() as f64
    }

    /// Every coordinate times a factor, such as 0.001 for a cloud in millimetres.
    pub fn scaled(&self, factor: f64) -> Result<Self, CloudError> {
        Self::new(self.points.iter().map(|p| p * factor).collect())
    }

    /// Directions and radii seen from a centre. A point at the centre has no direction and is
    /// omitted.
    pub fn seen_from(&self, centre: &Point3<f64>) -> RadialSamples {
        // Reserved at once, because a cloud may have millions of points.
        let mut directions = Vec::with_capacity(self.points.len());
        let mut radii = Vec::with_capacity(self.points.len());
        for (p, r) in self
            .points
            .iter()
            .filter_map(|p| direction_and_radius(&(p - centre)))
        {
            directions.push(p);
            radii.push(r);
        }
        RadialSamples { directions, radii }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_of_no_frame_are_refused() {
        let cloud = |scale: f64| {
            let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            PointCloud::new(corners.map(|c| Point3::from(c) * scale).to_vec())
        };
        assert!(cloud(9e5).is_ok());
        for scale in [1e155, -1e155, 1.1e6] {
            let error = cloud(scale).unwrap_err();
            assert!(matches!(error, CloudError::TooFar { index: 1, value } if value == scale));
            assert!(error.to_string().len() < 150, "{error}");
        }
        assert_eq!(
            cloud(1e-162).unwrap_err(),
            CloudError::TooSmall { extent: 1e-162 }
        );
    }

    #[test]
    fn refuses_nan_and_clouds_without_extent() {
        let p = Point3::new(1.0, 2.0, 3.0);
        assert_eq!(PointCloud::new(vec![p; 10]), Err(CloudError::NoExtent));
        assert!(matches!(
            PointCloud::new(vec![p; 2]),
            Err(CloudError::TooFew { count: 2, .. })
        ));
        let mut points = vec![p; 10];
        points[3].y = f64::NAN;
        assert!(matches!(
            PointCloud::new(points),
            Err(CloudError::NotFinite { index: 3, .. })
        ));
    }

    #[test]
    fn the_mean_is_right_far_from_the_origin() {
        let points = (0..8)
            .map(|i| {
                Point3::new(
                    9e5 + f64::from(i & 1),
                    f64::from(i >> 1 & 1),
                    f64::from(i >> 2),
                )
            })
            .collect();
        let mean = PointCloud::new(points).unwrap().mean();
        assert_eq!(mean, Point3::new(9e5 + 0.5, 0.5, 0.5));
    }
}
