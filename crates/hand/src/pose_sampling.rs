//! Random hand poses around an object: from all sides (paper, Sec. IV-C), or for two fingers at
//! antipodal pairs of the surface.

mod antipodal;
mod obstacles;
mod places;

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, UnitVector3, Vector3};
use rand::{Rng, RngExt};

use crate::collision::CollisionObject;
use crate::hand::Hand;
use antipodal::Pairs;
use places::Target;
use shape::Support;

/// Largest number of repeated draws per pose.
const REDRAWS: usize = 50;

/// A pose of the hand before its fingers close.
#[derive(Debug, Clone, PartialEq)]
pub struct HandPose {
    /// Pose of the palm (the root link) in the centred frame.
    pub object_from_palm: Isometry3<f64>,
    /// Index of the pre-shape.
    pub preshape: usize,
}

/// The distribution of poses; all quantities are uniform and independent.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseSampling {
    /// Least height, on the unit sphere, of the direction from which the hand approaches, along z
    /// or along the normal of the support. 0 is the upper hemisphere of the paper, -1 the whole
    /// sphere.
    pub least_height: f64,
    /// The plane on which the object stands, and the least height above it of the links of the open
    /// hand, metres. Poses are drawn again, up to fifty times, until the hand is above it.
    pub support: Option<(Support, f64)>,
    /// Range of the distance from the surface to the approach point, along the line of
    /// approach, metres.
    pub standoff: (f64, f64),
    /// Indices of the pre-shapes to draw from; none gives no poses.
    pub preshapes: Vec<usize>,
    /// Half angle of the cones in which the line between two jaws must lie at both contacts, radians;
    /// `None` aims every pose at the origin.
    pub antipodal: Option<f64>,
}

impl PoseSampling {
    /// The upper hemisphere, every pre-shape, the stand-off range of the hand's spec; antipodal pairs
    /// within the friction cones of μ = 0.5 for a hand of two fingers.
    pub fn of_hand(hand: &Hand) -> Self {
        PoseSampling {
            least_height: 0.0,
            support: None,
            standoff: hand.standoff(),
            preshapes: (0..hand.preshapes().len()).collect(),
            antipodal: (hand.fingers().len() == 2).then(|| 0.5_f64.atan()),
        }
    }

    /// Draws `count` poses: the hand is aimed at the origin from a uniform direction, at a
    /// uniform stand-off and roll, in a uniformly chosen pre-shape.
    ///
    /// An object that is not star-shaped has thin and bent parts away from its origin. Every second hand
    /// is aimed at a point half-way through such a part instead, below a place drawn by area, and the
    /// stand-off is measured from one of the places where the line of approach leaves the surface.
    ///
    /// With [`Self::antipodal`] the jaws of the pre-shape are placed at a pair of points on the
    /// surface instead: the first in a uniform direction, the line between them uniform in the
    /// friction cone of the first and within that of the second, their distance less than the
    /// opening; the approach is uniform about the line, among the directions in which points of the
    /// surface are clear of the links that may not touch, with the fingers open and closed. Where
    /// no such pair is found in a hundred draws, or the hand has no jaws, the pose is one of those
    /// above.
    ///
    /// The same generator state gives the same poses.
    pub fn sample<R: Rng + ?Sized>(
        &self,
        object: &CollisionObject<'_>,
        hand: &Hand,
        count: usize,
        rng: &mut R,
    ) -> Vec<HandPose> {
        if self.preshapes.is_empty() {
            return Vec::new();
        }
        let target = Target::of(object);
        let pairs = self
            .antipodal
            .map(|cone| Pairs::new(object, &target, hand, self, cone));
        let found = |rng: &mut R| {
            let (which, pose) = pairs.as_ref()?.draw(hand, rng)?;
            Some(HandPose {
                object_from_palm: pose,
                preshape: self.preshapes[which],
            })
        };
        (0..count)
            .map(|_| found(rng).unwrap_or_else(|| self.draw_above(&target, hand, rng)))
            .collect()
    }

    /// A pose of the open hand above the support, if one is found.
    fn draw_above<R: Rng + ?Sized>(
        &self,
        target: &Target<'_>,
        hand: &Hand,
        rng: &mut R,
    ) -> HandPose {
        let mut pose = self.draw(target, hand, rng);
        for _ in 0..REDRAWS {
            if self.is_above(hand, &pose) {
                break;
            }
            pose = self.draw(target, hand, rng);
        }
        pose
    }

    fn is_above(&self, hand: &Hand, pose: &HandPose) -> bool {
        let Some((support, clearance)) = &self.support else {
            return true;
        };
        let joints = &hand.preshapes()[pose.preshape].joints;
        let Ok(links) = hand.model().root_from_links(joints) else {
            return true;
        };
        let seen = support.seen_from(&pose.object_from_palm);
        hand.lowest_link(&seen, &links)
            .is_none_or(|(_, height)| height >= *clearance)
    }

    fn draw<R: Rng + ?Sized>(&self, target: &Target<'_>, hand: &Hand, rng: &mut R) -> HandPose {
        let z: f64 = rng.random_range(self.least_height.clamp(-1.0, 1.0)..=1.0);
        let azimuth = rng.random_range(0.0..std::f64::consts::TAU);
        let roll = rng.random_range(0.0..std::f64::consts::TAU);
        let standoff = rng.random_range(self.standoff.0..=self.standoff.1);
        let preshape = self.preshapes[rng.random_range(0..self.preshapes.len())];
        let ring = (1.0 - z * z).max(0.0).sqrt();
        let (sin, cos) = azimuth.sin_cos();
        let from = UnitVector3::new_normalize(Vector3::new(ring * cos, ring * sin, z));
        let from = match &self.support {
            Some((support, _)) => upright(&support.normal) * from,
            None => from,
        };
        let (aim, outside) = target.aim(&from, rng);
        let mut pose = aimed(hand, &from, outside + standoff, roll);
        pose.translation.vector += aim.coords;
        HandPose {
            object_from_palm: pose,
            preshape,
        }
    }
}

/// The least rotation that takes +z to the normal of a support; none where it is +z.
fn upright(normal: &UnitVector3<f64>) -> UnitQuaternion<f64> {
    let z = Vector3::z_axis();
    UnitQuaternion::rotation_between_axis(&z, normal).unwrap_or_else(|| {
        UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI)
    })
}

/// The pose whose line of approach goes from `from · distance` to the origin.
///
/// `from` is a direction of the centred frame, `roll` (radians) is a rotation about the approach.
pub fn aimed(hand: &Hand, from: &UnitVector3<f64>, distance: f64, roll: f64) -> Isometry3<f64> {
    let towards = -*from;
    let approach = hand.approach_axis();
    // Between opposite directions the shortest rotation is not unique; any half turn about a
    // perpendicular axis will do.
    let turn = UnitQuaternion::rotation_between(&approach, &towards).unwrap_or_else(|| {
        let (across, _) = sph::direction::tangent_frame(&approach);
        UnitQuaternion::from_axis_angle(&UnitVector3::new_normalize(across), std::f64::consts::PI)
    });
    let rotation = UnitQuaternion::from_axis_angle(&towards, roll) * turn;
    let point = Point3::from(from.into_inner() * distance);
    let offset = rotation * hand.approach_point();
    Isometry3::from_parts(Translation3::from(point - offset), rotation)
}
