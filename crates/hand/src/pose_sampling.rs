//! Random hand poses around an object (paper, Sec. IV-C).

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, UnitVector3, Vector3};
use rand::{Rng, RngExt};
use shape::RadialShape;

use crate::hand::Hand;

/// A pose of the hand before its fingers close.
#[derive(Debug, Clone, PartialEq)]
pub struct HandPose {
    /// Pose of the palm (the root link) in the object frame.
    pub object_from_palm: Isometry3<f64>,
    /// Index of the pre-shape.
    pub preshape: usize,
}

/// What is drawn: all uniformly and independently.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseSampling {
    /// Least height z of the direction of approach on the unit sphere; 0 is the upper
    /// hemisphere of the paper, -1 the whole sphere.
    pub least_height: f64,
    /// Range of the distance from the surface to the approach point, along the line of
    /// approach, metres.
    pub standoff: (f64, f64),
    /// Indices of the pre-shapes to draw from; none gives no poses.
    pub preshapes: Vec<usize>,
}

impl PoseSampling {
    /// The upper hemisphere, every pre-shape, the stand-off range of the hand's spec.
    pub fn of_hand(hand: &Hand) -> Self {
        PoseSampling {
            least_height: 0.0,
            standoff: hand.standoff(),
            preshapes: (0..hand.preshapes().len()).collect(),
        }
    }

    /// Draws `count` poses: the hand is aimed at the origin from a uniform direction, at a
    /// uniform stand-off and roll, in a uniformly chosen pre-shape.
    ///
    /// The same generator state gives the same poses.
    pub fn sample<R: Rng + ?Sized>(
        &self,
        surface: &RadialShape,
        hand: &Hand,
        count: usize,
        rng: &mut R,
    ) -> Vec<HandPose> {
        if self.preshapes.is_empty() {
            return Vec::new();
        }
        (0..count).map(|_| self.draw(surface, hand, rng)).collect()
    }

    fn draw<R: Rng + ?Sized>(&self, surface: &RadialShape, hand: &Hand, rng: &mut R) -> HandPose {
        let z: f64 = rng.random_range(self.least_height.clamp(-1.0, 1.0)..=1.0);
        let azimuth = rng.random_range(0.0..std::f64::consts::TAU);
        let roll = rng.random_range(0.0..std::f64::consts::TAU);
        let standoff = rng.random_range(self.standoff.0..=self.standoff.1);
        let preshape = self.preshapes[rng.random_range(0..self.preshapes.len())];
        let ring = (1.0 - z * z).max(0.0).sqrt();
        let (sin, cos) = azimuth.sin_cos();
        let from = UnitVector3::new_normalize(Vector3::new(ring * cos, ring * sin, z));
        let distance = surface.radius(&from) + standoff;
        HandPose {
            object_from_palm: aimed(hand, &from, distance, roll),
            preshape,
        }
    }
}

/// The pose whose line of approach runs from `from · distance` to the origin.
///
/// `from` is a direction of the object frame, `roll` (radians) turns about the approach.
pub fn aimed(hand: &Hand, from: &UnitVector3<f64>, distance: f64, roll: f64) -> Isometry3<f64> {
    let towards = -*from;
    let approach = hand.approach_axis();
    // Opposite directions have no shortest rotation; any half turn across does.
    let turn = UnitQuaternion::rotation_between(&approach, &towards).unwrap_or_else(|| {
        let (across, _) = sph::direction::tangent_frame(&approach);
        UnitQuaternion::from_axis_angle(&UnitVector3::new_normalize(across), std::f64::consts::PI)
    });
    let rotation = UnitQuaternion::from_axis_angle(&towards, roll) * turn;
    let point = Point3::from(from.into_inner() * distance);
    let offset = rotation * hand.approach_point();
    Isometry3::from_parts(Translation3::from(point - offset), rotation)
}
