//! Steps that experiments share: surfaces from clouds, and hand grasps on surfaces.

use moduli::{Convention, Grasp, Grasps, Hand, Object, Poses};
use rayon::prelude::*;
use serde_json::{Value, json};
use shape::{AnyField, FitSettings, RadialShape};
use space::{Objective, Transfer, TransferEnd};
use sph::Direction;

use crate::error::ExperimentError;
use crate::objects::{ObjectCloud, ObjectSource, Objects, Refused};
use crate::run::{Purpose, Run, stream};

/// An object of an experiment: its scan, and the surface fitted to it.
#[derive(Clone, Debug)]
pub struct FittedScan {
    /// The scan.
    pub scan: ObjectCloud,
    /// The surface, and the position of the scan.
    pub object: Object,
    /// The surface alone.
    shape: RadialShape,
}

impl FittedScan {
    /// k for S_k, from 1.
    pub fn number(&self) -> usize {
        self.scan.number
    }

    /// Its short name.
    pub fn id(&self) -> &str {
        &self.scan.id
    }

    /// The surface, in the centred frame.
    pub fn shape(&self) -> &RadialShape {
        &self.shape
    }

    /// The surface prepared for ascents; the first call takes a few milliseconds.
    pub fn field(&self) -> &AnyField {
        self.object.field()
    }

    /// Grasp quality on this surface as a function of contacts.
    ///
    /// # Errors
    /// A number of the convention is out of range.
    pub fn objective(&self, convention: &Convention) -> Result<Objective, moduli::Error> {
        Ok(self.object.measure(convention)?.objective())
    }
}

/// The objects with fitted surfaces, and the refused ones.
#[derive(Clone, Debug)]
pub struct FittedSet {
    /// Origin of the objects.
    pub source: ObjectSource,
    /// Fitted objects, in order.
    pub objects: Vec<FittedScan>,
    /// Objects that could not be read or fitted.
    pub refused: Vec<Refused>,
}

impl FittedSet {
    /// The object S_k.
    pub fn get(&self, number: usize) -> Option<&FittedScan> {
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

fn describe(fitted: &FittedScan) -> Value {
    let (low, high) = fitted.shape().radius_bounds();
    let report = fitted.object.report();
    json!({
        "number": fitted.number(),
        "id": fitted.id(),
        "name": fitted.scan.name,
        "points": report.points,
        "degree": fitted.shape().degree(),
        "lambda": report.lambda,
        "rms_m": report.rms,
        "max_abs_m": report.max_abs,
        "r_min_certified_m": low,
        "r_max_certified_m": high,
        "volume_m3": fitted.shape().mass_properties().volume,
    })
}

/// Loads the run's objects (all, or those with the given numbers) and fits them in parallel.
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

/// Fits every cloud; those without a surface in M^rad are added to the refused ones.
pub fn fit_all(objects: Objects, settings: &FitSettings) -> FittedSet {
    let fits: Vec<Result<FittedScan, Refused>> = objects
        .clouds
        .into_par_iter()
        .map(|scan| {
            let object = Object::from_cloud(&scan.name, &scan.cloud, settings);
            let refused = |reason| Refused {
                id: scan.id.clone(),
                reason,
            };
            let object = object.map_err(|error| refused(error.to_string()))?;
            let shape = object.shape().radial().cloned();
            let shape = shape.ok_or_else(|| refused("not a radial surface".to_owned()))?;
            Ok(FittedScan {
                scan,
                object,
                shape,
            })
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

/// Hand grasps on an object (Sec. IV-C), the best first under the convention. Every object has its
/// own random generator for the poses.
///
/// # Errors
/// A grasp of the hand cannot be computed on this surface.
pub fn synthesize(
    fitted: &FittedScan,
    hand: &Hand,
    convention: &Convention,
    poses: usize,
    seed: u64,
) -> Result<Grasps, moduli::Error> {
    let poses = Poses {
        count: poses,
        seed,
        stream: stream(Purpose::Poses, fitted.number()),
        ..Poses::default()
    };
    fitted.object.measure(convention)?.synthesize(hand, &poses)
}

/// The directions of the contacts of grasps.
pub fn directions(grasps: &[Vec<Grasp>]) -> Vec<Vec<Vec<Direction>>> {
    let of = |grasps: &Vec<Grasp>| grasps.iter().map(|g| g.directions().to_vec()).collect();
    grasps.iter().map(of).collect()
}

/// The best hand grasps on every object: at most `count` per object, from `poses` poses.
///
/// # Errors
/// No object has a stable grasp.
pub fn best_grasps(
    run: &Run,
    set: &FittedSet,
    poses: usize,
    count: usize,
) -> Result<Vec<Vec<Grasp>>, ExperimentError> {
    run.say(&format!("closing the hand from {poses} poses an object"));
    let hand = Hand::schunk_sdh()?;
    // Surfaces are prepared here, so that the time is not attributed to an ascent.
    set.objects.par_iter().for_each(|fitted| {
        fitted.field();
    });
    let mut all = Vec::with_capacity(set.objects.len());
    for fitted in &set.objects {
        let found = synthesize(fitted, &hand, &run.convention, poses, run.seed)?;
        all.push(found.iter().take(count).cloned().collect());
    }
    if all.iter().all(Vec::is_empty) {
        return Err(ExperimentError::NoGrasps { poses });
    }
    Ok(all)
}

/// The transfer from one object to another, for both schemes.
pub fn transfer_between<'a>(
    run: &'a Run,
    from: &'a FittedScan,
    to: &'a FittedScan,
) -> Transfer<'a> {
    let end = |fitted: &'a FittedScan| TransferEnd {
        surface: fitted.field(),
        object_origin: fitted.object.frame().cloud_origin(),
    };
    Transfer::new(end(from), end(to), &run.convention)
}
