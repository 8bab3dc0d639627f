//! Synthesis: grasps of a hand on an object, found by closing it from sampled poses (Sec. IV-C).

use hand::{
    ClosingRules, CollisionObject, Hand, HandGrasp, PoseSampling, Synthesis, SynthesisError,
    SynthesisParams,
};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use crate::error::Error;
use crate::grasp::{Grasp, Grasps, HandPlacement, Source};
use crate::measure::Measure;

/// How far each tip is from its contact before the fingers close, metres.
const OPEN: f64 = 0.01;

/// Which poses of a hand are sampled, and which closed poses are kept as grasps.
#[derive(Clone, Debug, PartialEq)]
pub struct Poses {
    /// Number of poses.
    pub count: usize,
    /// Indices of the pre-shapes from which the fingers close; all if empty.
    pub preshapes: Vec<usize>,
    /// Range of the distance from the surface, metres; the hand's range if absent.
    pub standoff: Option<(f64, f64)>,
    /// Whether fingers continue to close past their tips until every link has contact (power
    /// grasps).
    pub power: bool,
    /// The quality from which a grasp counts as stable; the measure's threshold if absent.
    pub least_quality: Option<f64>,
    /// Seed of the poses: the same seed gives the same grasps on any number of threads.
    pub seed: u64,
    /// Stream of that seed; the streams of one seed are independent.
    pub stream: u64,
}

impl Default for Poses {
    /// The paper's 1,400 poses, all pre-shapes, fingertip grasps, seed 0, stream 0.
    fn default() -> Self {
        Self {
            count: 1400,
            preshapes: Vec::new(),
            standoff: None,
            power: false,
            least_quality: None,
            seed: 0,
            stream: 0,
        }
    }
}

impl Measure<'_> {
    /// Closes a hand from sampled poses and keeps the stable grasps, the best first.
    ///
    /// Poses are drawn in one sequence and evaluated on the threads of rayon's pool. 1,400 poses take
    /// about 2 s on one core.
    ///
    /// # Errors
    /// The surface is too rough for the collision model, or a quality cannot be computed.
    pub fn synthesize(&self, hand: &Hand, poses: &Poses) -> Result<Grasps, Error> {
        self.synthesize_watched(hand, poses, &|| {})
    }

    /// The same; `pose_done` is called once per pose, from any thread.
    ///
    /// # Errors
    /// As [`Measure::synthesize`].
    pub fn synthesize_watched(
        &self,
        hand: &Hand,
        poses: &Poses,
        pose_done: &(dyn Fn() + Sync),
    ) -> Result<Grasps, Error> {
        let measure = self.for_hand(hand);
        let found = measure.close_hand(hand, poses, pose_done)?;
        let grasp = |found: &HandGrasp| measure.of_hand_grasp(hand, found);
        Ok(Grasps {
            list: found.grasps.iter().map(grasp).collect::<Result<_, _>>()?,
            outcomes: Some(found.outcomes),
        })
    }

    fn close_hand(
        &self,
        hand: &Hand,
        poses: &Poses,
        pose_done: &(dyn Fn() + Sync),
    ) -> Result<Synthesis, SynthesisError> {
        let preshapes = if poses.preshapes.is_empty() {
            (0..hand.preshapes().len()).collect()
        } else {
            poses.preshapes.clone()
        };
        let rules = ClosingRules {
            past_tips: poses.power,
            support: self.support(),
            ..ClosingRules::default()
        };
        let usual = PoseSampling::of_hand(hand);
        let cone = self.convention().friction.atan();
        let params = SynthesisParams {
            poses: poses.count,
            sampling: PoseSampling {
                preshapes,
                standoff: poses.standoff.unwrap_or(hand.standoff()),
                antipodal: usual.antipodal.map(|usual| usual.min(cone)),
                support: self.support().map(|s| (s, rules.support_clearance)),
                ..usual
            },
            rules,
            convention: self.convention().clone(),
            centre: self.centre(),
            tips: self.tips(),
            least_quality: poses.least_quality.unwrap_or(self.stable_above()),
        };
        let mut generator = ChaCha8Rng::seed_from_u64(poses.seed);
        generator.set_stream(poses.stream);
        let object = CollisionObject::new(self.object().field())?;
        let object = object.with_surroundings(self.object().surroundings().clone());
        let found = hand::synthesize_on(&object, hand, &params, &mut generator, pose_done)?;
        Ok(found)
    }

    /// The pre-shape from which the hand closed, opened until each tip is [`OPEN`] from where it touches;
    /// the pre-shape itself where the joints or the support leave no room.
    fn pregrasp(&self, hand: &Hand, found: &HandGrasp) -> Vec<f64> {
        let start = &hand.preshapes()[found.preshape].joints;
        let opened = hand.opened_by(start, &found.joints, OPEN);
        let clearance = self.clearance(hand, &found.object_from_palm, &opened);
        let least = ClosingRules::default().support_clearance;
        if clearance.is_some_and(|height| height < least) {
            return start.clone();
        }
        opened
    }

    fn of_hand_grasp(&self, hand: &Hand, found: &HandGrasp) -> Result<Grasp, Error> {
        let source = Source::Synthesis {
            preshape: found.preshape,
        };
        let (directions, contacts) = (found.directions.clone(), found.contacts.clone());
        let grasp = self.grasp_of(directions, contacts, found.quality, source)?;
        Ok(grasp.with_hand(Some(HandPlacement {
            centred_from_palm: found.object_from_palm,
            joints: found.joints.clone(),
            pregrasp_joints: self.pregrasp(hand, found),
            contact_error: 0.0,
            met: true,
            clearance_to_support: self.clearance(hand, &found.object_from_palm, &found.joints),
        })))
    }
}
