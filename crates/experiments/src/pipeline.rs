//! The steps that experiments share: surfaces from clouds, and hand grasps on surfaces.

use grasp::Convention;
use hand::{
    ClosingRules, CollisionObject, Hand, HandGrasp, PoseSampling, Synthesis, SynthesisParams,
};
use nalgebra::Point3;
use rayon::prelude::*;
use serde_json::{Value, json};
use shape::{Fit, FitSettings, RadialField, RadialShape};
use space::{Objective, Transfer, TransferEnd};
use sph::Direction;

use crate::error::ExperimentError;
use crate::objects::{ObjectCloud, ObjectSource, Objects, Refused};
use crate::run::{Purpose, Run, generator};

/// An object with its surface.
#[derive(Clone, Debug)]
pub struct FittedObject {
    /// The object and its cloud.
    pub object: ObjectCloud,
    /// Its surface.
    pub fit: Fit,
    /// The same surface, prepared for ascents.
    pub surface: RadialField,
}

impl FittedObject {
    /// k for S_k, from 1.
    pub fn number(&self) -> usize {
        self.object.number
    }

    /// Its short name.
    pub fn id(&self) -> &str {
        &self.object.id
    }

    /// The surface, in the centred frame.
    pub fn shape(&self) -> &RadialShape {
        &self.fit.shape
    }

    /// Origin of the cloud's frame in the centred frame, metres.
    pub fn object_origin(&self) -> Point3<f64> {
        Point3::from(-self.fit.centre_in_cloud.coords)
    }

    /// Grasp quality on this surface.
    pub fn objective(&self, convention: &Convention) -> Objective {
        Objective::new(convention, self.shape(), &self.object_origin())
    }
}

/// All objects with surfaces, and the others.
#[derive(Clone, Debug)]
pub struct FittedSet {
    /// Where they come from.
    pub source: ObjectSource,
    /// Fitted objects in order.
    pub objects: Vec<FittedObject>,
    /// Objects that could not be read or fitted.
    pub refused: Vec<Refused>,
}

impl FittedSet {
    /// The object S_k.
    pub fn get(&self, number: usize) -> Option<&FittedObject> {
        self.objects.iter().find(|o| o.number() == number)
    }

    /// The `objects` part of a result.
    pub fn describe(&self) -> Value {
        let fitted: Vec<Value> = self.objects.iter().map(describe).collect();
        json!({
            "source": self.source.to_string(),
            "fitted": fitted,
            "refused": self.refused,
        })
    }
}

fn describe(fitted: &FittedObject) -> Value {
    let (low, high) = fitted.shape().radius_bounds();
    json!({
        "number": fitted.number(),
        "id": fitted.id(),
        "name": fitted.object.name,
        "points": fitted.object.cloud.points().len(),
        "degree": fitted.shape().degree(),
        "lambda": fitted.fit.lambda,
        "rms_m": fitted.fit.rms,
        "max_abs_m": fitted.fit.max_abs,
        "r_min_certified_m": low,
        "r_max_certified_m": high,
        "volume_m3": fitted.shape().mass_properties().volume,
    })
}

/// Loads the run's objects, all or those of some numbers, and fits them in parallel.
///
/// # Errors
/// Fewer than `needed` of them have a surface.
pub fn fitted_objects(
    run: &Run,
    numbers: Option<&[usize]>,
    needed: usize,
) -> Result<FittedSet, ExperimentError> {
    let mut objects = Objects::load(&run.objects, run.seed)?.only(run.only)?;
    if let (Some(numbers), true) = (numbers, run.only.is_empty()) {
        objects = objects.select(numbers);
    }
    run.say(&format!(
        "fitting {} objects at degree {}",
        objects.clouds.len(),
        run.fit.degree
    ));
    let given = objects.clouds.len() + objects.refused.len();
    let set = fit_all(objects, &run.fit);
    if set.objects.len() >= needed {
        return Ok(set);
    }
    let reason = |r: &Refused| format!("\n  {}: {}", r.id, r.reason);
    Err(ExperimentError::TooFewObjects {
        fitted: set.objects.len(),
        given,
        needed,
        source_name: set.source.to_string(),
        reasons: set.refused.iter().map(reason).collect(),
    })
}

/// Fits every cloud; those without a surface in M^rad join the refused.
pub fn fit_all(objects: Objects, settings: &FitSettings) -> FittedSet {
    let fits: Vec<Result<FittedObject, Refused>> = objects
        .clouds
        .into_par_iter()
        .map(|object| match shape::fit::fit(&object.cloud, settings) {
            Ok(fit) => Ok(FittedObject {
                object,
                surface: RadialField::new(fit.shape.clone()),
                fit,
            }),
            Err(error) => Err(Refused {
                id: object.id,
                reason: error.to_string(),
            }),
        })
        .collect();
    let mut set = FittedSet {
        source: objects.source,
        objects: Vec::new(),
        refused: objects.refused,
    };
    for fit in fits {
        match fit {
            Ok(object) => set.objects.push(object),
            Err(refused) => set.refused.push(refused),
        }
    }
    set
}

/// Hand grasps on an object (Sec. IV-C): poses drawn first with the object's own generator, then
/// evaluated in parallel, ranked by quality under the convention.
pub fn synthesize(
    fitted: &FittedObject,
    hand: &Hand,
    convention: &Convention,
    poses: usize,
    seed: u64,
) -> Result<Synthesis, ExperimentError> {
    let surface = fitted.shape();
    let objective = fitted.objective(convention);
    let params = SynthesisParams {
        poses,
        sampling: PoseSampling::of_hand(hand),
        rules: ClosingRules::default(),
        convention: objective.convention().clone(),
        centre: objective.centre(),
        least_quality: convention.stable_above,
    };
    let mut rng = generator(seed, Purpose::Poses, fitted.number());
    let drawn = params.sampling.sample(surface, hand, poses, &mut rng);
    let object = CollisionObject::new(surface)?;
    let outcomes = drawn
        .par_iter()
        .map(|pose| hand::evaluate_pose(&object, hand, pose, &params))
        .collect::<Result<Vec<_>, _>>()?;
    Ok(hand::collect(outcomes))
}

/// The contacts of grasps as directions.
pub fn directions(grasps: &[Vec<HandGrasp>]) -> Vec<Vec<Vec<Direction>>> {
    let of = |grasps: &Vec<HandGrasp>| grasps.iter().map(|g| g.directions.clone()).collect();
    grasps.iter().map(of).collect()
}

/// The best hand grasps on every object: at most `count` each, of `poses` poses each.
///
/// # Errors
/// No object has a stable grasp.
pub fn best_grasps(
    run: &Run,
    set: &FittedSet,
    poses: usize,
    count: usize,
) -> Result<Vec<Vec<HandGrasp>>, ExperimentError> {
    run.say(&format!("closing the hand from {poses} poses an object"));
    let hand = hand::schunk_sdh()?;
    let mut all = Vec::with_capacity(set.objects.len());
    for fitted in &set.objects {
        let mut grasps = synthesize(fitted, &hand, &run.convention, poses, run.seed)?.grasps;
        grasps.truncate(count);
        all.push(grasps);
    }
    if all.iter().all(Vec::is_empty) {
        return Err(ExperimentError::NoGrasps { poses });
    }
    Ok(all)
}

/// What both schemes need, from one object to another.
pub fn transfer_between<'a>(
    run: &'a Run,
    from: &'a FittedObject,
    to: &'a FittedObject,
) -> Transfer<'a> {
    let end = |object: &'a FittedObject| TransferEnd {
        surface: &object.surface,
        object_origin: object.object_origin(),
    };
    Transfer::new(end(from), end(to), &run.convention)
}
