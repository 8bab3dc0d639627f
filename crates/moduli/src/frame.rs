//! The conversion between the frame of the user's cloud and the centred frame; no other module
//! converts.
//!
//! Both have the same axes. The origin of the centred frame is the mean of the cloud's points; all
//! computation happens there, and everything that is reported is in the frame of the cloud.

use nalgebra::{Isometry3, Point3, Translation3};
use shape::Support;

/// Where the centred frame of an object lies in the frame of its cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloudFrame {
    centre: Point3<f64>,
}

impl CloudFrame {
    /// `centre` is the origin of the centred frame in the frame of the cloud, metres.
    pub fn new(centre: Point3<f64>) -> Self {
        Self { centre }
    }

    /// The origin of the centred frame in the frame of the cloud, metres.
    pub fn centre_in_cloud(&self) -> Point3<f64> {
        self.centre
    }

    /// The origin of the cloud's frame in the centred frame, metres.
    pub fn cloud_origin(&self) -> Point3<f64> {
        Point3::from(-self.centre.coords)
    }

    /// A point of the centred frame, in the frame of the cloud.
    pub fn to_cloud(&self, centred: &Point3<f64>) -> Point3<f64> {
        centred + self.centre.coords
    }

    /// A point of the cloud's frame, in the centred frame.
    pub fn to_centred(&self, in_cloud: &Point3<f64>) -> Point3<f64> {
        in_cloud - self.centre.coords
    }

    /// A plane given in the frame of the cloud, in the centred frame.
    pub fn plane_to_centred(&self, plane: &Support) -> Support {
        Support {
            offset_m: plane.offset_m - plane.normal.dot(&self.centre.coords),
            ..*plane
        }
    }

    /// A plane given in the centred frame, in the frame of the cloud.
    pub fn plane_to_cloud(&self, plane: &Support) -> Support {
        Support {
            offset_m: plane.offset_m + plane.normal.dot(&self.centre.coords),
            ..*plane
        }
    }

    /// A pose given in the frame of the cloud, in the centred frame.
    pub fn pose_to_centred(&self, cloud_from_palm: &Isometry3<f64>) -> Isometry3<f64> {
        Translation3::from(-self.centre.coords) * cloud_from_palm
    }

    /// A pose given in the centred frame, in the frame of the cloud.
    pub fn pose_to_cloud(&self, centred_from_palm: &Isometry3<f64>) -> Isometry3<f64> {
        Translation3::from(self.centre.coords) * centred_from_palm
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back() {
        let frame = CloudFrame::new(Point3::new(0.5, -0.2, 1.0));
        let p = Point3::new(0.01, 0.02, 0.03);
        assert!((frame.to_centred(&frame.to_cloud(&p)) - p).norm() <= 1e-15);
        assert_eq!(frame.to_centred(&frame.centre_in_cloud()), Point3::origin());
        assert_eq!(frame.to_cloud(&frame.cloud_origin()), Point3::origin());
        let plane = Support {
            normal: nalgebra::Vector3::z_axis(),
            offset_m: 0.97,
        };
        let centred = frame.plane_to_centred(&plane);
        assert!((centred.height(&frame.to_centred(&p)) - plane.height(&p)).abs() <= 1e-15);
        assert!((frame.plane_to_cloud(&centred).offset_m - plane.offset_m).abs() <= 1e-15);
        let pose = Isometry3::translation(0.1, 0.2, 0.3);
        let moved = frame.pose_to_cloud(&pose) * Point3::origin();
        assert!((moved - frame.to_cloud(&Point3::new(0.1, 0.2, 0.3))).norm() <= 1e-15);
    }
}
