//! `moduli synthesize`: grasps of a hand on a shape, found by closing it from random poses.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Instant;

use grasp::Convention;
use hand::{Hand, Synthesis};
use serde::Serialize;

use crate::args::{Common, SynthesizeOptions};
use crate::failure::Failure;
use crate::plan::result::{self, Written};
use crate::plan::synthesis::{self, Request, reasons, sentence};
use crate::plan::{Fitted, Target, ranking};
use crate::{hands, input, output};

/// Power grasps begin nearer than the least stand-off of grasps with the tips, by up to this share of
/// it: from farther away only tips arrive.
const POWER_NEARER: f64 = 0.3;

#[derive(Serialize)]
struct SynthesizeLine<'a> {
    object: &'a str,
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
    let request = request(options, common, &hand, &convention)?;
    let (name, fitted) = Fitted::read(&options.shape)?;
    let target = Target::new(&name, &fitted, &convention);
    let bar = output::progress(common.quiet, options.poses, "closing the hand");
    let found = synthesis::synthesize(&target, &hand, &request, &bar)?;
    bar.finish_and_clear();

    let ranked = ranking::rank(synthesis::candidates(&found, options.keep));
    let folder = options
        .output
        .clone()
        .unwrap_or_else(|| PathBuf::from("out").join(input::stem(&options.shape)));
    let summary = format!("Hand {}: {}.", hand.name(), sentence(&found.outcomes));
    let facts = vec![summary.clone()];
    let written = result::write(&folder, &target, None, &hand, &ranked, facts)?;
    if common.json {
        let seconds = start.elapsed().as_secs_f64();
        output::say_json(&line(&target, &hand, &request, &found, &written, seconds))?;
    } else {
        output::say(format!("{name}: {summary}"));
        written.print_table();
        output::say(format!(
            "{} of {} stable grasps kept under convention `{}`, {:.1} s",
            ranked.len(),
            found.outcomes.stable,
            target.convention.name,
            start.elapsed().as_secs_f64()
        ));
        written.print_paths();
    }
    if ranked.is_empty() {
        return Err(Failure::refused(format!(
            "{name}: 0 grasps of the hand {}: {}",
            hand.name(),
            synthesis::why_none(&found.outcomes, &hand)
        )));
    }
    Ok(())
}

fn request(
    options: &SynthesizeOptions,
    common: &Common,
    hand: &Hand,
    convention: &Convention,
) -> Result<Request, Failure> {
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
    let mut preshapes: Vec<usize> = options
        .preshape
        .iter()
        .map(index)
        .collect::<Result<_, _>>()?;
    if preshapes.is_empty() {
        preshapes = (0..hand.preshapes().len()).collect();
    }
    let (least, _) = hand.standoff();
    let nearer = options
        .power
        .then_some((least - POWER_NEARER * least.abs(), least));
    Ok(Request {
        poses: options.poses,
        preshapes,
        least_quality,
        standoff: options.standoff.or(nearer),
        power: options.power,
        seed: common.seed,
    })
}

fn line<'a>(
    target: &'a Target,
    hand: &'a Hand,
    request: &Request,
    found: &Synthesis,
    written: &Written,
    seconds: f64,
) -> SynthesizeLine<'a> {
    let mut because = BTreeMap::new();
    for (rejection, count) in &found.outcomes.rejected {
        *because.entry(rejection.describe(hand)).or_default() += count;
    }
    let qualities: Vec<f64> = found.grasps.iter().map(|g| g.quality).collect();
    let name_of = |p: &usize| hand.preshapes()[*p].name.as_str();
    SynthesizeLine {
        object: target.name,
        hand: hand.name(),
        fingers: hand.fingers().len(),
        preshapes: request.preshapes.iter().map(name_of).collect(),
        poses: found.outcomes.total(),
        stable: found.outcomes.stable,
        kept: written.file.grasps.len(),
        rejected: reasons(&found.outcomes).into_iter().collect(),
        because,
        best: qualities.first().copied(),
        mean: (!qualities.is_empty())
            .then(|| qualities.iter().sum::<f64>() / qualities.len() as f64),
        convention: &target.convention.name,
        grasps_json: written.grasps_json.display().to_string(),
        grasps_yaml: written.grasps_yaml.display().to_string(),
        index_html: written.index_html.display().to_string(),
        seconds,
    }
}
