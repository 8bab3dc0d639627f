//! `moduli synthesize`: grasps of a hand on a shape, found by closing it from random poses.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Instant;

use grasp::Convention;
use hand::{Hand, OutcomeCounts};
use moduli::{Grasps, Measure, Poses, ranked};
use record::grasps::SurfaceModel;
use serde::Serialize;

use crate::args::{Common, SynthesizeOptions};
use crate::failure::Failure;
use crate::outcomes::{reasons, sentence, why_none};
use crate::result::{self, Written};
use crate::{hands, input, output};

/// Power grasps start nearer than the least stand-off of grasps with the tips, by up to this share
/// of it, because from farther away only tips touch.
const POWER_NEARER: f64 = 0.3;

#[derive(Serialize)]
struct SynthesizeLine<'a> {
    object: &'a str,
    /// How the surface is represented: `radial` or `spherical`.
    model: SurfaceModel,
    hand: &'a str,
    fingers: usize,
    preshapes: Vec<&'a str>,
    poses: usize,
    stable: usize,
    kept: usize,
    /// Poses that gave no stable grasp, by reason.
    rejected: BTreeMap<&'static str, usize>,
    /// The same by finger and link.
    because: BTreeMap<String, usize>,
    best: Option<f64>,
    mean: Option<f64>,
    convention: &'a str,
    grasps_json: String,
    grasps_yaml: String,
    index_html: String,
    seconds: f64,
}

pub(crate) fn run(options: &SynthesizeOptions, common: &Common) -> Result<(), Failure> {
    let start = Instant::now();
    let convention = input::convention(&options.convention)?;
    let hand = hands::load(&options.hand)?;
    let poses = poses(options, common, &hand, &convention)?;
    let object = input::object(&options.shape)?;
    let name = object.name();
    let refused = |e: moduli::Error| Failure::refused(format!("synthesis on {name}: {e}"));
    let tips = options.contact.unwrap_or_else(|| hand.tip_model());
    let measure = object
        .measure(&convention)
        .map_err(refused)?
        .with_tips(tips)
        .with_support(options.support.under(&object));
    let bar = output::progress(common.quiet, options.poses, "closing the hand");
    let found = measure
        .synthesize_watched(&hand, &poses, &|| bar.inc(1))
        .map_err(refused)?;
    bar.finish_and_clear();

    let outcomes = found.outcomes().cloned().unwrap_or_default();
    let ranked = ranked(found.iter().take(options.keep).cloned().collect());
    let folder = options
        .output
        .clone()
        .unwrap_or_else(|| PathBuf::from("out").join(input::stem(&options.shape)));
    let summary = format!("Hand {}: {}.", hand.name(), sentence(&outcomes));
    let facts = vec![summary.clone()];
    let written = result::write(&folder, &measure, None, &hand, &ranked, facts)?;
    if common.json {
        let seconds = start.elapsed().as_secs_f64();
        let run = Run {
            measure: &measure,
            hand: &hand,
            poses: &poses,
            found: &found,
            outcomes: &outcomes,
        };
        output::say_json(&run.line(&written, seconds))?;
    } else {
        output::say(format!("{name}: {summary}"));
        written.print_table();
        output::say(format!(
            "{} of {} stable grasps kept under convention `{}`, {:.1} s",
            ranked.len(),
            outcomes.stable,
            convention.name,
            start.elapsed().as_secs_f64()
        ));
        written.print_paths();
    }
    if ranked.is_empty() {
        return Err(Failure::refused(format!(
            "{name}: 0 grasps of the hand {}: {}",
            hand.name(),
            why_none(&outcomes, &hand, tips)
        )));
    }
    Ok(())
}

fn poses(
    options: &SynthesizeOptions,
    common: &Common,
    hand: &Hand,
    convention: &Convention,
) -> Result<Poses, Failure> {
    let least_quality = options.least_quality.unwrap_or(convention.stable_above);
    if !(least_quality.is_finite() && least_quality >= 0.0) {
        return Err(Failure::usage(format!(
            "--least-quality {least_quality}: expected a number, at least 0"
        )));
    }
    let index = |name: &String| {
        hand.preshape_index(name).ok_or_else(|| {
            let known: Vec<&str> = hand.preshapes().iter().map(|p| p.name.as_str()).collect();
            Failure::usage(format!(
                "--preshape {name}: the hand {} has {}",
                hand.name(),
                known.join(", ")
            ))
        })
    };
    let preshapes: Vec<usize> = options
        .preshape
        .iter()
        .map(index)
        .collect::<Result<_, _>>()?;
    let (least, _) = hand.standoff();
    let nearer = options
        .power
        .then_some((least - POWER_NEARER * least.abs(), least));
    Ok(Poses {
        count: options.poses,
        preshapes,
        least_quality: Some(least_quality),
        standoff: options.standoff.or(nearer),
        power: options.power,
        seed: common.seed,
        stream: 0,
    })
}

/// The settings and the result of a run.
struct Run<'a> {
    measure: &'a Measure<'a>,
    hand: &'a Hand,
    poses: &'a Poses,
    found: &'a Grasps,
    outcomes: &'a OutcomeCounts,
}

impl<'a> Run<'a> {
    fn line(&self, written: &Written, seconds: f64) -> SynthesizeLine<'a> {
        let mut because = BTreeMap::new();
        for (rejection, count) in &self.outcomes.rejected {
            *because.entry(rejection.describe(self.hand)).or_default() += count;
        }
        let qualities: Vec<f64> = self.found.iter().map(|g| g.quality()).collect();
        let preshapes = self.hand.preshapes().iter().enumerate();
        let drawn = &self.poses.preshapes;
        SynthesizeLine {
            object: self.measure.object().name(),
            model: self.measure.object().model(),
            hand: self.hand.name(),
            fingers: self.hand.fingers().len(),
            preshapes: preshapes
                .filter(|(i, _)| drawn.is_empty() || drawn.contains(i))
                .map(|(_, p)| p.name.as_str())
                .collect(),
            poses: self.outcomes.total(),
            stable: self.outcomes.stable,
            kept: written.file.grasps.len(),
            rejected: reasons(self.outcomes).into_iter().collect(),
            because,
            best: qualities.first().copied(),
            mean: (!qualities.is_empty())
                .then(|| qualities.iter().sum::<f64>() / qualities.len() as f64),
            convention: &self.measure.convention().name,
            grasps_json: written.grasps_json.display().to_string(),
            grasps_yaml: written.grasps_yaml.display().to_string(),
            index_html: written.index_html.display().to_string(),
            seconds,
        }
    }
}
