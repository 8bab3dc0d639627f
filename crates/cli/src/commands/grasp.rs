//! `moduli grasp`: a cloud in, ranked grasps and a page out.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Instant;

use hand::Hand;
use record::GraspsFile;
use serde::Serialize;
use shape::PointCloud;

use crate::args::{Common, GraspOptions};
use crate::failure::Failure;
use crate::plan::synthesis::{Request, reasons, sentence, synthesize};
use crate::plan::{
    Candidate, Fitted, Target, library, ranking, reach, result, synthesis, transfer,
};
use crate::{hands, input, output};

/// The built-in object that stands for "never seen before".
const UNSEEN: &str = "U1";

#[derive(Serialize)]
struct GraspLine {
    object: String,
    points: usize,
    r_min_certified_m: f64,
    r_max_certified_m: f64,
    hand: String,
    neighbours: Vec<String>,
    transferred: usize,
    transferred_closed: usize,
    /// With a hand, whether it meets the contacts or makes others near them.
    transferred_with_hand: usize,
    /// Of these, those whose contacts the hand meets.
    transferred_met: usize,
    /// Transferred grasps with another number of contacts than the hand has fingers.
    transferred_of_other_count: usize,
    poses: usize,
    synthesized: usize,
    rejected: BTreeMap<&'static str, usize>,
    grasps: usize,
    best: Option<f64>,
    contact_to_cloud_max_m: f64,
    convention: String,
    grasps_json: String,
    grasps_yaml: String,
    index_html: String,
    seconds: f64,
}

/// Transferred grasps: all, and the kept ones with their hands.
struct Carried {
    all: usize,
    closed: usize,
    of_other_count: usize,
    neighbours: Vec<String>,
    kept: Vec<Candidate>,
}

pub(crate) fn run(options: &GraspOptions, common: &Common) -> Result<(), Failure> {
    let start = Instant::now();
    let convention = input::convention(&options.convention)?;
    let hand = hands::load(&options.hand)?;
    let (name, cloud) = object(options, common)?;
    let points = cloud.points().len();
    let fitted = Fitted::new(input::fit(&cloud, &name, &options.fit)?, points);
    let target = Target::new(&name, &fitted, &convention);

    let carried = carried(options, common, &target, &hand)?;
    let bar = output::progress(common.quiet, options.poses, "closing the hand");
    let request = Request {
        poses: options.poses,
        preshapes: (0..hand.preshapes().len()).collect(),
        least_quality: target.convention.stable_above,
        standoff: None,
        power: false,
        seed: common.seed,
    };
    let found = synthesize(&target, &hand, &request, &bar)?;
    bar.finish_and_clear();

    let held = || carried.kept.iter().filter_map(|c| c.hand.as_ref());
    let (with_hand, met) = (held().count(), held().filter(|h| h.met).count());
    let mut candidates = carried.kept.clone();
    candidates.extend(synthesis::candidates(&found, options.keep));
    let ranked = ranking::rank(candidates);
    let folder = options
        .output
        .clone()
        .unwrap_or_else(|| PathBuf::from("out").join(&name));
    let facts = vec![format!(
        "Hand {}: {}.",
        hand.name(),
        sentence(&found.outcomes)
    )];
    let written = result::write(&folder, &target, Some(&cloud), &hand, &ranked, facts)?;

    let (r_min, r_max) = fitted.shape.radius_bounds();
    let line = GraspLine {
        object: name.clone(),
        points,
        r_min_certified_m: r_min,
        r_max_certified_m: r_max,
        hand: hand.name().to_owned(),
        neighbours: carried.neighbours,
        transferred: carried.all,
        transferred_closed: carried.closed,
        transferred_with_hand: with_hand,
        transferred_met: met,
        transferred_of_other_count: carried.of_other_count,
        poses: options.poses,
        synthesized: found.outcomes.stable,
        rejected: reasons(&found.outcomes).into_iter().collect(),
        grasps: ranked.len(),
        best: ranked.first().map(|c| c.quality),
        contact_to_cloud_max_m: farthest_contact(&written.file, &cloud),
        convention: target.convention.name.clone(),
        grasps_json: written.grasps_json.display().to_string(),
        grasps_yaml: written.grasps_yaml.display().to_string(),
        index_html: written.index_html.display().to_string(),
        seconds: start.elapsed().as_secs_f64(),
    };
    if common.json {
        output::say_json(&line)?;
    } else {
        line.say_found(&hand, &sentence(&found.outcomes));
        written.print_table();
        line.say_end();
        written.print_paths();
    }
    if ranked.is_empty() {
        return Err(Failure::refused(format!(
            "{name}: no force-closed grasp found; {}; more --poses or --neighbours may help",
            synthesis::why_none(&found.outcomes, &hand)
        )));
    }
    Ok(())
}

/// Grasps of the nearest known objects on the target, the best with a hand where one reaches.
fn carried(
    options: &GraspOptions,
    common: &Common,
    target: &Target,
    hand: &Hand,
) -> Result<Carried, Failure> {
    let library = library::built_in()?;
    let neighbours = transfer::neighbours(target, &library, options.neighbours)?;
    let bar = output::progress(common.quiet, 0, "transferring");
    let mut all = transfer::candidates(target, &neighbours, options.transfers, &bar)?;
    bar.finish_and_clear();
    if library.hand != hand.name() {
        // Poses and joints of another hand say nothing of this one's.
        all.iter_mut()
            .filter_map(|c| c.carried.as_mut())
            .for_each(|c| c.hand = None);
    }
    let fits = |c: &Candidate| c.contacts.len() == hand.fingers().len();
    let closed = all.iter().filter(|c| c.quality > 0.0).count();
    let counted = all.len();
    let mut kept = ranking::rank(all);
    kept.truncate(options.keep);
    let of_other_count = kept.iter().filter(|c| !fits(c)).count();
    if kept.iter().any(fits) {
        let bar = output::progress(common.quiet, kept.len(), "reaching contacts");
        let (starts, seed) = (options.reach_starts, common.seed);
        reach::give_hands(target, hand, &mut kept, starts, seed, &bar)?;
        bar.finish_and_clear();
    }
    let describe = |n: &transfer::Neighbour| {
        format!(
            "{} {} ({:.1} mm)",
            n.entry.id,
            n.entry.name,
            1e3 * n.distance
        )
    };
    Ok(Carried {
        all: counted,
        closed,
        of_other_count,
        neighbours: neighbours.iter().map(describe).collect(),
        kept,
    })
}

/// The cloud given, or the built-in unseen object.
fn object(options: &GraspOptions, common: &Common) -> Result<(String, PointCloud), Failure> {
    if let Some(path) = &options.cloud {
        return Ok((
            input::stem(path),
            input::cloud(path, &options.fit, common.seed)?,
        ));
    }
    let unseen = catalogue::by_id(UNSEEN)
        .ok_or_else(|| Failure::other(format!("the built-in object {UNSEEN} is missing")))?;
    let cloud = PointCloud::new(unseen.scan(common.seed))
        .map_err(|e| Failure::other(format!("the built-in object {UNSEEN}: {e}")))?;
    Ok((unseen.name.replace(' ', "-"), cloud))
}

/// Largest distance from a contact to the nearest point of the cloud, metres.
fn farthest_contact(file: &GraspsFile, cloud: &PointCloud) -> f64 {
    let contacts = file.grasps.iter().flat_map(|g| &g.contacts_m);
    contacts
        .map(|c| {
            let c = nalgebra::Point3::from(*c);
            let nearest = cloud.points().iter().map(|p| (p - c).norm_squared());
            nearest.fold(f64::INFINITY, f64::min).sqrt()
        })
        .fold(0.0, f64::max)
}

impl GraspLine {
    fn say_found(&self, hand: &Hand, synthesis: &str) {
        output::say(format!(
            "{}: {} points, surface proved between {:.1} and {:.1} mm from its centre",
            self.object,
            self.points,
            1e3 * self.r_min_certified_m,
            1e3 * self.r_max_certified_m
        ));
        output::say(format!(
            "nearest known objects: {}",
            self.neighbours.join(", ")
        ));
        output::say(format!(
            "{} of {} transferred grasps are force-closed; the hand {} meets the contacts of {} and makes grasps near those of {} more; {synthesis}",
            self.transferred_closed,
            self.transferred,
            self.hand,
            self.transferred_met,
            self.transferred_with_hand - self.transferred_met,
        ));
        if self.transferred_of_other_count > 0 {
            output::say(format!(
                "{} transferred grasps come without a hand: the library's have as many contacts as the SDH has fingers, three, and {} has {}",
                self.transferred_of_other_count,
                self.hand,
                hand.fingers().len()
            ));
        }
    }

    fn say_end(&self) {
        output::say(format!(
            "{} grasps under convention `{}`, contacts within {:.2} mm of the cloud, {:.1} s",
            self.grasps,
            self.convention,
            1e3 * self.contact_to_cloud_max_m,
            self.seconds
        ));
    }
}
