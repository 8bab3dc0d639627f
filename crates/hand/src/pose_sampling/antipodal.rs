//! Antipodal pairs of surface points, and poses of a gripper at them.

use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, UnitQuaternion, UnitVector3, Vector3};
use rand::{Rng, RngExt};
use shape::{RadialField, Surface};
use sph::Direction;
use sph::direction::tangent_frame;

use super::PoseSampling;
use super::obstacles::Obstacles;
use super::places::{Places, Target};
use crate::collision::CollisionObject;
use crate::hand::{Hand, Jaws};
use shape::Support;

/// Number of pairs tried per pose.
const TRIES: usize = 100;
/// Number of approach directions tried per pair.
const TURNS: usize = 6;
/// Opening of the jaws beyond the distance of the pair, metres, so that both tips start clear of
/// the surface.
const SPARE: f64 = 2e-3;
/// Clearance between the surface and links that must not touch, metres.
const CLEARANCE: f64 = 6e-3;
/// Number of surface points with which the hand is compared.
const POINTS: usize = 400;
/// Largest displacement of the middle of the jaws along the approach, in both directions, metres.
const SHIFT: f64 = 6e-3;
/// Step along a line, as a fraction of the object's radius, before the crossing is bisected.
const STEP: f64 = 0.05;
const BISECTIONS: usize = 20;

/// A surface on which antipodal pairs are sampled.
pub(super) struct Pairs<'a> {
    body: Body<'a>,
    points: Vec<Point3<f64>>,
    /// The states of the jaws as they close from each sampled pre-shape, the widest first.
    jaws: Vec<Vec<Station<'a>>>,
    cone: f64,
    least_height: f64,
    support: Option<(Support, f64)>,
    radius: f64,
}

/// A surface as lines through it meet it.
enum Body<'a> {
    Radial(Box<RadialField>),
    Spherical(&'a Places<'a>),
}

/// One state of the closing jaws.
struct Station<'a> {
    jaws: Jaws,
    /// Poses of all links, palm frame.
    links: Vec<Isometry3<f64>>,
    obstacles: Obstacles<'a>,
}

impl<'a> Pairs<'a> {
    pub(super) fn new(
        object: &CollisionObject<'a>,
        target: &'a Target<'a>,
        hand: &'a Hand,
        sampling: &PoseSampling,
        cone: f64,
    ) -> Self {
        let directions = sph::direction::even_directions(POINTS);
        let (body, points) = match target {
            Target::Radial(shape) => {
                let field = RadialField::new((*shape).clone());
                let points = directions.iter().map(|d| field.point(d)).collect();
                (Body::Radial(Box::new(field)), points)
            }
            Target::Spherical(places) => {
                let points = directions.iter().map(|d| places.field().point(d)).collect();
                (Body::Spherical(places), points)
            }
        };
        Pairs {
            radius: object.outer_radius(),
            points,
            body,
            jaws: sampling
                .preshapes
                .iter()
                .map(|&p| stations(hand, p))
                .collect(),
            cone,
            least_height: sampling.least_height,
            support: sampling.support,
        }
    }

    /// A pose with the jaws at an antipodal pair, and the index of the pre-shape.
    pub(super) fn draw<R: Rng + ?Sized>(
        &self,
        hand: &Hand,
        rng: &mut R,
    ) -> Option<(usize, Isometry3<f64>)> {
        let which = rng.random_range(0..self.jaws.len());
        let way = &self.jaws[which];
        let open = way.first()?;
        let widest = open.jaws.opening - SPARE;
        for _ in 0..TRIES {
            let Some((first, second)) = self.pair(widest, rng) else {
                continue;
            };
            // The state in which the distance of the tips is that of the pair.
            let width = (first - second).norm();
            let wider = way.iter().rev().find(|s| s.jaws.opening >= width);
            let closed = wider.unwrap_or(open);
            for _ in 0..TURNS {
                let roll = rng.random_range(0.0..std::f64::consts::TAU);
                let shift = rng.random_range(-SHIFT..=SHIFT);
                let pose = self.about(hand, &closed.jaws, (&first, &second), roll, shift);
                let clear = |pose: &Isometry3<f64>| {
                    let stations = [closed, open];
                    stations.iter().all(|s| self.is_above(hand, s, pose))
                        && !stations.iter().any(|s| self.meets(s, pose))
                };
                if let Some(pose) = pose.filter(clear) {
                    return Some((which, pose));
                }
            }
        }
        None
    }

    fn meets(&self, station: &Station<'_>, pose: &Isometry3<f64>) -> bool {
        station.obstacles.meet(&pose.inverse(), &self.points)
    }

    fn is_above(&self, hand: &Hand, station: &Station<'_>, pose: &Isometry3<f64>) -> bool {
        self.support.is_none_or(|(support, clearance)| {
            let lowest = hand.lowest_link(&support.seen_from(pose), &station.links);
            lowest.is_none_or(|(_, height)| height >= clearance)
        })
    }

    /// Two points at most `widest` apart whose connecting line is in both friction cones.
    fn pair<R: Rng + ?Sized>(
        &self,
        widest: f64,
        rng: &mut R,
    ) -> Option<(Point3<f64>, Point3<f64>)> {
        let (first, inward) = match &self.body {
            Body::Radial(field) => field.contact(&uniform_direction(rng)),
            Body::Spherical(places) => places.draw(rng)?,
        };
        // Uniform on the cap about the inward normal.
        let cosine = rng.random_range(self.cone.cos()..=1.0);
        let azimuth = rng.random_range(0.0..std::f64::consts::TAU);
        let (a, b) = tangent_frame(&inward);
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let (sin, cos) = azimuth.sin_cos();
        let way = inward.into_inner() * cosine + (a * cos + b * sin) * sine;
        let (second, opposite) = match &self.body {
            Body::Radial(field) => {
                let second = first + way * exit(field, self.radius, &first, &way, widest)?;
                let direction = Direction::try_new(second.coords, 1e-9)?;
                (second, field.contact(&direction).1)
            }
            Body::Spherical(places) => {
                let crossing = places.exit(&first, &way, widest)?;
                let second = first + way * crossing.along;
                (second, places.normal_at(&crossing)?)
            }
        };
        (opposite.dot(&-way) >= self.cone.cos()).then_some((first, second))
    }

    /// The pose with the jaws at a pair, rotated by `roll` about the line between its points and
    /// moved by `shift` along the approach; `None` from below or if the palm would touch the
    /// surface.
    fn about(
        &self,
        hand: &Hand,
        jaws: &Jaws,
        (first, second): (&Point3<f64>, &Point3<f64>),
        roll: f64,
        shift: f64,
    ) -> Option<Isometry3<f64>> {
        let axis = UnitVector3::try_new(first - second, 1e-9)?;
        let (a, b) = tangent_frame(&axis);
        let approach = a * roll.cos() + b * roll.sin();
        let up = self
            .support
            .map_or(Vector3::z(), |(s, _)| s.normal.into_inner());
        if -approach.dot(&up) < self.least_height - 1e-9 {
            return None;
        }
        let middle = nalgebra::center(first, second) + approach * shift;
        let longest = jaws.depth - CLEARANCE;
        let back = match &self.body {
            Body::Radial(field) => exit(field, self.radius, &middle, &-approach, longest)?,
            Body::Spherical(places) => places.exit(&middle, &-approach, longest)?.along,
        };
        if !(back < jaws.depth - CLEARANCE) {
            return None;
        }
        let frame = |x: &Vector3<f64>, z: &Vector3<f64>| {
            Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[*x, z.cross(x), *z]))
        };
        let in_palm = frame(&jaws.axis, &hand.approach_axis());
        let in_object = frame(&axis, &approach);
        let turn = UnitQuaternion::from_rotation_matrix(&(in_object * in_palm.inverse()));
        let offset = middle - turn * jaws.middle;
        Some(Isometry3::from_parts(offset.into(), turn))
    }
}

/// The states of the closing jaws of a pre-shape, with the links that must stay clear.
fn stations(hand: &Hand, preshape: usize) -> Vec<Station<'_>> {
    let jaws = hand.jaws(preshape).unwrap_or_default();
    let station = |(k, jaws): (usize, Jaws)| {
        // Open tips are clear of the surface; closed tips touch it.
        let of_tips = (k == 0).then_some(0.0);
        let obstacles = Obstacles::new(hand, &jaws.joints, CLEARANCE, of_tips)?;
        let links = hand.model().root_from_links(&jaws.joints).ok()?;
        Some(Station {
            jaws,
            links,
            obstacles,
        })
    };
    jaws.into_iter().enumerate().filter_map(station).collect()
}

fn uniform_direction<R: Rng + ?Sized>(rng: &mut R) -> Direction {
    let z: f64 = rng.random_range(-1.0..=1.0);
    let (sin, cos) = rng.random_range(0.0..std::f64::consts::TAU).sin_cos();
    let ring = (1.0 - z * z).max(0.0).sqrt();
    Direction::new_normalize(Vector3::new(ring * cos, ring * sin, z))
}

/// The first exit, within `longest`, of a line that starts on the surface or inside it.
fn exit(
    field: &RadialField,
    radius: f64,
    start: &Point3<f64>,
    way: &Vector3<f64>,
    longest: f64,
) -> Option<f64> {
    let inside = |t: f64| {
        let p = start + way * t;
        Direction::try_new(p.coords, 1e-9)
            .is_none_or(|d| p.coords.norm() < field.point(&d).coords.norm())
    };
    let step = STEP * radius;
    let mut low = step;
    if !inside(low) {
        return None;
    }
    loop {
        let mut high = low + step;
        if !inside(high) {
            for _ in 0..BISECTIONS {
                let middle = 0.5 * (low + high);
                if inside(middle) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            return (high <= longest).then_some(high);
        }
        if high > longest {
            return None;
        }
        low = high;
    }
}
