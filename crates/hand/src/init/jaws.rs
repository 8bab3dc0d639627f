//! Hands of two fingers: where their pads are and how they start.

use nalgebra::{Point3, UnitVector3, Vector3};
use rand::Rng;

use super::fingers::{Finger, Resting};
use super::opposition::{self, Start, close};
use super::{Approach, Draft, InitError, Proposal, trial};
use crate::hand::Hand;
use crate::hand_spec::HandSpec;

/// Points of a pad lie in one plane within this, metres.
const FLAT: f64 = 1e-3;
/// Radii of pads, metres.
const RADII: (f64, f64) = (5e-3, 15e-3);
/// The surface is this far behind the middle of the pads at most, metres.
const DEPTH: f64 = 0.015;

/// The face of a tip that looks at the other one.
struct Pad {
    /// The link that it belongs to.
    link: usize,
    middle: Point3<f64>,
    /// Half of its shorter side, metres.
    radius: f64,
}

impl Draft<'_> {
    /// Two fingers: the pads about a pair of opposite points.
    pub(super) fn jaws<R: Rng + Clone>(
        &self,
        first: &Finger,
        second: &Finger,
        rng: &R,
    ) -> Result<Proposal, InitError> {
        let curls = first.curls || second.curls;
        let mut starts = opposition::starts(self.hand, self.fingers);
        if starts.is_empty() || !curls {
            // Jaws open as far as they go.
            starts = vec![self.open()];
        }
        let mut best: Option<(f64, HandSpec)> = None;
        for start in starts.iter().take(super::TRIED) {
            let pads = self.pads(first, second, &start.joints);
            let middle = nalgebra::center(&pads[0].middle, &pads[1].middle);
            let across = pads[0].middle - pads[1].middle;
            let approach = Approach {
                axis: self.forward(&start.joints, &middle, &across),
                point: middle,
                standoff: [-DEPTH, 0.0],
            };
            let mut spec = self.spec(&approach, &[start]);
            for (finger, pad) in spec.finger.iter_mut().zip(&pads) {
                // The link with the pad comes first and gives its name to the finger.
                finger.name = self.link(pad.link);
                finger.tips.sort_by_key(|name| *name != finger.name);
            }
            let radius = pads[0].radius.min(pads[1].radius);
            spec.pad_radius_m = Some(super::round(radius.clamp(RADII.0, RADII.1)));
            let hand = Hand::new(self.hand.model.clone(), &spec)?;
            let score = trial::score(&hand, rng)?;
            if best.as_ref().is_none_or(|(found, _)| score > *found) {
                best = Some((score, spec));
            }
        }
        let spec = best.map(|(_, spec)| spec);
        let spec = spec.ok_or_else(|| InitError::NoOpposition {
            palm: self.link(0),
            fingers: format!(
                "{}, {}",
                self.link(first.tips[0]),
                self.link(second.tips[0])
            ),
        })?;
        let notes = vec![format!(
            "pad_radius_m = {} is half of the shorter side of the faces that look at each other; it decides how much torsion the contacts carry",
            spec.pad_radius_m.unwrap_or_default()
        )];
        Ok(Proposal { spec, notes })
    }

    /// All closing joints at the ends from which they close.
    fn open(&self) -> Start {
        let mut joints = self.hand.rest.clone();
        for &(driven, share) in self.fingers.iter().flat_map(|f| &f.closing) {
            let (lower, upper) = self.hand.limits(driven);
            joints[driven] = if share > 0.0 { lower } else { upper };
        }
        Start {
            name: "open".to_owned(),
            joints,
            centre: Point3::origin(),
            score: 0.0,
        }
    }

    /// The faces of both tips where they are most of the way closed.
    fn pads(&self, first: &Finger, second: &Finger, joints: &[f64]) -> [Pad; 2] {
        let ends = [first, second].map(|f| self.hand.end_at(f, joints));
        let closed = close(self.hand, self.fingers, joints, 0.5);
        let half = [first, second].map(|f| self.hand.end_at(f, &closed));
        // The way on which the tips come together.
        let way = (ends[0] - ends[1]) - (half[0] - half[1]);
        let fallback = ends[0] - ends[1];
        let across = UnitVector3::try_new(way, 1e-9)
            .or_else(|| UnitVector3::try_new(fallback, 1e-9))
            .unwrap_or(Vector3::y_axis());
        [
            pad(self.hand, first, joints, &-across.into_inner()),
            pad(self.hand, second, joints, &across),
        ]
    }

    /// The direction from the palm to the middle of the pads, across the line between them.
    fn forward(
        &self,
        joints: &[f64],
        middle: &Point3<f64>,
        across: &Vector3<f64>,
    ) -> UnitVector3<f64> {
        let axes = self.axes(joints, middle);
        let towards = axes.last().copied().unwrap_or(Vector3::z_axis());
        let Some(across) = UnitVector3::try_new(*across, 1e-9) else {
            return towards;
        };
        let square = towards.into_inner() - across.into_inner() * towards.dot(&across);
        UnitVector3::try_new(square, 1e-6).unwrap_or(towards)
    }
}

/// The part of a tip that is farthest along `inward`, palm frame.
fn pad(hand: &Resting<'_>, finger: &Finger, joints: &[f64], inward: &Vector3<f64>) -> Pad {
    let poses = hand.poses_at(joints);
    let points = |l: usize| hand.shapes[l].mesh(&poses[l]).vertices;
    let depth = |p: &Point3<f64>| p.coords.dot(inward);
    let reach = |l: usize| {
        points(l)
            .iter()
            .map(depth)
            .fold(f64::NEG_INFINITY, f64::max)
    };
    let (mut link, mut deepest) = (finger.tips[0], reach(finger.tips[0]));
    for &other in &finger.tips[1..] {
        if reach(other) > deepest + 1e-6 {
            (link, deepest) = (other, reach(other));
        }
    }
    let points = points(link);
    let on_face = |p: &&Point3<f64>| depth(p) >= deepest - FLAT;
    let face: Vec<&Point3<f64>> = points.iter().filter(on_face).collect();
    let (a, b) = sph::direction::tangent_frame(&UnitVector3::new_normalize(*inward));
    let range = |axis: &Vector3<f64>| {
        let values = || face.iter().map(|p| p.coords.dot(axis));
        let least = values().fold(f64::INFINITY, f64::min);
        (least, values().fold(f64::NEG_INFINITY, f64::max))
    };
    let (along_a, along_b) = (range(&a), range(&b));
    let half = |(low, high): (f64, f64)| 0.5 * (high - low);
    let middle = a * (along_a.0 + half(along_a)) + b * (along_b.0 + half(along_b));
    Pad {
        link,
        middle: Point3::from(middle + inward * deepest),
        radius: half(along_a).min(half(along_b)),
    }
}
