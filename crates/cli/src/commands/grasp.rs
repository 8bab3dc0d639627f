//! `moduli grasp`: a cloud in, ranked grasps and a page out.

use std::path::PathBuf;
use std::time::Instant;

use moduli::Objective;
use record::GraspsFile;
use serde::Serialize;
use shape::PointCloud;

use crate::args::{Common, GraspOptions};
use crate::failure::Failure;
use crate::plan::synthesis::synthesize;
use crate::plan::{Candidate, Target, library, page, ranking, reach, synthesis, transfer};
use crate::{input, output};

/// The built-in object that stands for "never seen before".
const UNSEEN: &str = "U1";
/// Rows of the table on standard output.
const SHOWN: usize = 10;

#[derive(Serialize)]
struct GraspLine {
    object: String,
    points: usize,
    r_min_certified_m: f64,
    r_max_certified_m: f64,
    neighbours: Vec<String>,
    transferred: usize,
    transferred_closed: usize,
    transferred_with_hand: usize,
    poses: usize,
    synthesized: usize,
    grasps: usize,
    best: Option<f64>,
    contact_to_cloud_max_m: f64,
    convention: String,
    grasps_json: String,
    index_html: String,
    seconds: f64,
}

pub(crate) fn run(options: &GraspOptions, common: &Common) -> Result<(), Failure> {
    let start = Instant::now();
    let (name, cloud) = object(options, common)?;
    let convention = input::convention(&options.convention)?;
    let fit = input::fit(&cloud, &name, &options.fit)?;
    let origin = nalgebra::Point3::from(-fit.centre_in_cloud.coords);
    let objective = Objective::new(&convention, &fit.shape, &origin);
    let target = Target {
        name: &name,
        fit: &fit,
        convention: objective.convention().clone(),
        centre: objective.centre(),
    };

    let library = library::built_in()?;
    let neighbours = transfer::neighbours(&target, &library, options.neighbours)?;
    let bar = output::progress(common.quiet, 0, "transferring");
    let transferred = transfer::candidates(&target, &neighbours, options.transfers, &bar)?;
    bar.finish_and_clear();

    let hand = hand::schunk_sdh().map_err(|e| Failure::other(format!("the built-in hand: {e}")))?;
    let bar = output::progress(common.quiet, options.poses, "closing the hand");
    let found = synthesize(&target, &hand, options.poses, common.seed, &bar)?;
    bar.finish_and_clear();

    let closed = transferred.iter().filter(|c| c.quality > 0.0).count();
    let mut candidates = ranking::rank(transferred.clone());
    candidates.truncate(options.keep);
    let bar = output::progress(common.quiet, candidates.len(), "reaching contacts");
    reach::give_hands(
        &target,
        &hand,
        &mut candidates,
        options.reach_starts,
        common.seed,
        &bar,
    )?;
    bar.finish_and_clear();
    let reached = candidates.iter().filter(|c| c.hand.is_some()).count();
    candidates.extend(synthesis::candidates(&found, options.keep));
    let ranked = ranking::rank(candidates);
    let file = ranking::grasps_file(&target, &hand, &ranked);

    let folder = options
        .output
        .clone()
        .unwrap_or_else(|| PathBuf::from("out").join(&name));
    let json_path = folder.join("grasps.json");
    let page_path = folder.join("index.html");
    let json = serde_json::to_vec_pretty(&file)
        .map_err(|e| Failure::other(format!("cannot encode grasps.json: {e}")))?;
    output::write_file(&json_path, &json)?;
    let html = page::render(&target, &cloud, &hand, &ranked, &file)?;
    output::write_file(&page_path, html.as_bytes())?;

    let (r_min, r_max) = fit.shape.radius_bounds();
    let line = GraspLine {
        object: name.clone(),
        points: cloud.points().len(),
        r_min_certified_m: r_min,
        r_max_certified_m: r_max,
        neighbours: neighbours
            .iter()
            .map(|n| {
                format!(
                    "{} {} ({:.1} mm)",
                    n.entry.id,
                    n.entry.name,
                    1e3 * n.distance
                )
            })
            .collect(),
        transferred: transferred.len(),
        transferred_closed: closed,
        transferred_with_hand: reached,
        poses: options.poses,
        synthesized: found.outcomes.stable,
        grasps: ranked.len(),
        best: ranked.first().map(|c| c.quality),
        contact_to_cloud_max_m: farthest_contact(&ranked, &file, &cloud),
        convention: target.convention.name.clone(),
        grasps_json: json_path.display().to_string(),
        index_html: page_path.display().to_string(),
        seconds: start.elapsed().as_secs_f64(),
    };
    if common.json {
        output::say_json(&line)?;
    } else {
        print_table(&line, &file, &found.outcomes.by_reason());
    }
    if ranked.is_empty() {
        return Err(Failure::refused(format!(
            "{name}: no force-closed grasp found; {} of {} poses rejected; try more --poses, more --neighbours or a higher --friction",
            options.poses - found.outcomes.stable,
            options.poses
        )));
    }
    Ok(())
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
fn farthest_contact(ranked: &[Candidate], file: &GraspsFile, cloud: &PointCloud) -> f64 {
    debug_assert_eq!(ranked.len(), file.grasps.len());
    let contacts = file.grasps.iter().flat_map(|g| &g.contacts_m);
    contacts
        .map(|c| {
            let c = nalgebra::Point3::from(*c);
            let nearest = cloud.points().iter().map(|p| (p - c).norm_squared());
            nearest.fold(f64::INFINITY, f64::min).sqrt()
        })
        .fold(0.0, f64::max)
}

fn print_table(line: &GraspLine, file: &GraspsFile, reasons: &[(&'static str, usize)]) {
    output::say(format!(
        "{}: {} points, surface proved between {:.1} and {:.1} mm from its centre",
        line.object,
        line.points,
        1e3 * line.r_min_certified_m,
        1e3 * line.r_max_certified_m
    ));
    output::say(format!(
        "nearest known objects: {}",
        line.neighbours.join(", ")
    ));
    let rejected: Vec<String> = reasons
        .iter()
        .filter(|(_, count)| *count > 0)
        .map(|(reason, count)| format!("{count} {}", reason.replace('_', " ")))
        .collect();
    output::say(format!(
        "{} of {} transferred grasps are force-closed, the hand reaches {}; {} of {} hand poses give a stable grasp ({})",
        line.transferred_closed,
        line.transferred,
        line.transferred_with_hand,
        line.synthesized,
        line.poses,
        rejected.join(", ")
    ));
    output::say("");
    output::say(format!(
        "{:>4}  {:>7}  {:36}  {}",
        "rank", "quality", "source", "contacts (mm, frame of the cloud)"
    ));
    for grasp in file.grasps.iter().take(SHOWN) {
        let contacts: Vec<String> = grasp
            .contacts_m
            .iter()
            .map(|c| format!("({:.1} {:.1} {:.1})", 1e3 * c[0], 1e3 * c[1], 1e3 * c[2]))
            .collect();
        output::say(format!(
            "{:>4}  {:>7.4}  {:36}  {}",
            grasp.rank,
            grasp.quality,
            page::source_label(&grasp.source),
            contacts.join(" ")
        ));
    }
    output::say("");
    output::say(format!(
        "{} grasps under convention `{}`, contacts within {:.2} mm of the cloud, {:.1} s",
        line.grasps,
        line.convention,
        1e3 * line.contact_to_cloud_max_m,
        line.seconds
    ));
    output::say(format!("{}\n{}", line.grasps_json, line.index_html));
}
