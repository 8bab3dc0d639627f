//! `moduli grasp`: a cloud in, ranked grasps and a page out.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use grasp::Convention;
use hand::Hand;
use indicatif::ProgressBar;
use moduli::records::scene_record;
use moduli::{
    HandSearch, Library, Measure, Plan, Planned, Poses, Progress, Stage, TransferOptions,
};
use record::GraspsFile;
use record::grasps::{HoleRecord, SceneRecord, SurfaceModel};
use serde::Serialize;
use shape::{Embedding, PointCloud};

use crate::args::{Common, GraspOptions, SurfaceChoice};
use crate::failure::Failure;
use crate::input::Scan;
use crate::outcomes::{reasons, sentence, why_none};
use crate::result::Written;
use crate::{hands, input, library_folder, output, page, result};

/// The built-in object that is not in the library.
const UNSEEN: &str = "U1";

#[derive(Serialize)]
struct GraspLine {
    object: String,
    points: usize,
    /// How the surface is represented: `radial` or `spherical`.
    model: SurfaceModel,
    rms_m: f64,
    surface_rms_m: Option<f64>,
    unexplained_share: Option<f64>,
    /// Whether a spherical surface is proved not to touch itself (`proved`) or to be an immersion only.
    embedding: Option<&'static str>,
    closed_holes: Vec<HoleRecord>,
    r_min_certified_m: f64,
    r_max_certified_m: f64,
    scene: Option<SceneRecord>,
    hand: String,
    neighbours: Vec<String>,
    transferred: usize,
    transferred_closed: usize,
    /// Grasps with a hand, whose contacts are the transferred ones or others near them.
    transferred_with_hand: usize,
    /// Those of them whose contacts are the transferred ones.
    transferred_met: usize,
    /// Grasps of the library left out, because they have another number of contacts than the hand has
    /// fingers.
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
    warnings: Vec<String>,
    seconds: f64,
}

pub(crate) fn run(options: &GraspOptions, common: &Common) -> Result<(), Failure> {
    let convention = input::convention(&options.convention)?;
    if options.fit.heat.is_some() && options.model == SurfaceChoice::Spherical {
        return Err(Failure::usage("--heat applies to radial surfaces only"));
    }
    let hand = hands::load(&options.hand)?;
    let (library, warnings) = library_folder::beside_builtin(options.library.as_deref())?;
    warnings.iter().for_each(output::warn);
    let shared = Shared {
        options,
        common,
        convention,
        hand,
        library,
        warnings,
    };
    let folders = folders(options)?;
    if options.clouds.is_empty() {
        let (name, scan) = builtin_object(common)?;
        let folder = options.output.clone();
        let folder = folder.unwrap_or_else(|| default_folder(&name));
        return shared.grasp(&name, &scan, &folder);
    }
    let mut failures = Vec::new();
    for (path, folder) in options.clouds.iter().zip(&folders) {
        let done = input::scan(path, &options.fit.reading, common.seed)
            .and_then(|scan| shared.grasp(&input::stem(path), &scan, folder));
        failures.extend(done.err());
    }
    Failure::all(failures)
}

/// `out/NAME`.
fn default_folder(name: &str) -> PathBuf {
    PathBuf::from("out").join(name)
}

/// The folder of each cloud's results; two clouds never share one.
fn folders(options: &GraspOptions) -> Result<Vec<PathBuf>, Failure> {
    let folder = |cloud: &PathBuf| match &options.output {
        Some(output) if options.clouds.len() == 1 => output.clone(),
        Some(output) => output.join(input::stem(cloud)),
        None => default_folder(&input::stem(cloud)),
    };
    let folders: Vec<PathBuf> = options.clouds.iter().map(folder).collect();
    let results: Vec<PathBuf> = folders.iter().map(|f| f.join("grasps.json")).collect();
    run::check_results(&results, &options.clouds)?;
    Ok(folders)
}

/// The settings that all clouds of one call share.
struct Shared<'a> {
    options: &'a GraspOptions,
    common: &'a Common,
    convention: Convention,
    hand: Hand,
    library: Library,
    /// Warnings about the library.
    warnings: Vec<String>,
}

impl Shared<'_> {
    /// Plans grasps on a cloud and writes the results into a folder.
    fn grasp(&self, name: &str, scan: &Scan, folder: &Path) -> Result<(), Failure> {
        let start = Instant::now();
        let (options, common, hand) = (self.options, self.common, &self.hand);
        let made = input::fitted(scan, name, &options.fit, options.model.into())?;
        let cloud = &made.cloud;
        let object = made.object.with_warnings(self.warnings.iter().cloned());
        let refused = |e: moduli::Error| Failure::refused(format!("{name}: {e}"));
        let tips = options.contact.unwrap_or_else(|| hand.tip_model());
        let measure = object.measure(&self.convention).map_err(refused)?;
        let measure = measure.with_tips(tips);
        let bars = Bars::new(common.quiet);
        let planned = plan(options, common)
            .run(&measure, hand, &self.library, &|p| bars.show(p))
            .map_err(refused)?;
        bars.finish();

        let summary = sentence(&planned.outcomes);
        let facts = vec![format!("Hand {}: {summary}.", hand.name())];
        let ranked = &planned.grasps;
        let written = result::write(folder, &measure, Some(cloud), hand, ranked, facts)?;
        let seconds = start.elapsed().as_secs_f64();
        let line = line(&measure, hand, cloud, &planned, &written, seconds);
        if common.json {
            output::say_json(&line)?;
        } else {
            line.say_found(hand, &summary);
            written.print_table();
            line.say_end();
            written.print_paths();
        }
        if ranked.is_empty() {
            return Err(Failure::refused(format!(
                "{name}: no force-closed grasp found; {}; more --poses or --neighbours may help",
                why_none(&planned.outcomes, hand, tips)
            )));
        }
        Ok(())
    }
}

/// The result of one cloud.
fn line(
    measure: &Measure<'_>,
    hand: &Hand,
    cloud: &PointCloud,
    planned: &Planned,
    written: &Written,
    seconds: f64,
) -> GraspLine {
    let object = measure.object();
    let transferred = &planned.transferred;
    let (r_min, r_max) = object.radius_bounds();
    let report = object.report();
    let residual = |name: &str| report.residuals.get(name).copied();
    GraspLine {
        object: object.name().to_owned(),
        points: cloud.points().len(),
        model: object.model(),
        rms_m: report.rms,
        surface_rms_m: residual("surface_rms_m"),
        unexplained_share: residual("unexplained_share"),
        embedding: report.embedding.map(|embedding| match embedding {
            Embedding::Proved { .. } => "proved",
            Embedding::Undecided { .. } => "immersion",
        }),
        closed_holes: object.object_record().closed_holes,
        r_min_certified_m: r_min,
        r_max_certified_m: r_max,
        scene: report.scene.as_ref().map(scene_record),
        hand: hand.name().to_owned(),
        neighbours: transferred.neighbours.iter().map(described).collect(),
        transferred: transferred.all,
        transferred_closed: transferred.closed,
        transferred_with_hand: transferred.with_hand,
        transferred_met: transferred.met,
        transferred_of_other_count: transferred.of_other_count,
        poses: planned.outcomes.total(),
        synthesized: planned.outcomes.stable,
        rejected: reasons(&planned.outcomes).into_iter().collect(),
        grasps: planned.grasps.len(),
        best: planned.grasps.first().map(|g| g.quality()),
        contact_to_cloud_max_m: farthest_contact(&written.file, cloud),
        convention: measure.rule().name.clone(),
        grasps_json: written.grasps_json.display().to_string(),
        grasps_yaml: written.grasps_yaml.display().to_string(),
        index_html: written.index_html.display().to_string(),
        warnings: report.warnings.clone(),
        seconds,
    }
}

/// The plan that the options describe.
fn plan(options: &GraspOptions, common: &Common) -> Plan {
    Plan {
        transfer: TransferOptions {
            neighbours: options.neighbours,
            grasps: options.transfers,
            keep: options.keep,
            search: HandSearch {
                starts: options.reach_starts,
                seed: common.seed,
                ..HandSearch::default()
            },
        },
        poses: Poses {
            count: options.poses,
            seed: common.seed,
            ..Poses::default()
        },
        keep: options.keep,
    }
}

/// "S7 soup can (18.0 mm)".
fn described((name, distance): &(String, f64)) -> String {
    format!("{name} ({:.1} mm)", 1e3 * distance)
}

/// A progress bar per stage.
struct Bars {
    transfer: ProgressBar,
    hands: ProgressBar,
    poses: ProgressBar,
}

impl Bars {
    fn new(quiet: bool) -> Self {
        Self {
            transfer: output::progress(quiet, 0, "transferring"),
            hands: output::progress(quiet, 0, "looking for hands"),
            poses: output::progress(quiet, 0, "closing the hand"),
        }
    }

    fn show(&self, progress: Progress) {
        let bar = match progress.stage {
            Stage::Transfer => &self.transfer,
            Stage::Reach => &self.hands,
            Stage::Synthesis => &self.poses,
        };
        bar.set_length(progress.total as u64);
        bar.inc(1);
        if progress.done == progress.total {
            bar.finish_and_clear();
        }
    }

    fn finish(&self) {
        for bar in [&self.transfer, &self.hands, &self.poses] {
            bar.finish_and_clear();
        }
    }
}

/// The built-in object that no library holds.
fn builtin_object(common: &Common) -> Result<(String, Scan), Failure> {
    let unseen = catalogue::by_id(UNSEEN)
        .ok_or_else(|| Failure::other(format!("the built-in object {UNSEEN} is missing")))?;
    let cloud = PointCloud::new(unseen.scan(common.seed))
        .map_err(|e| Failure::other(format!("the built-in object {UNSEEN}: {e}")))?;
    let scan = Scan {
        cloud,
        warnings: Vec::new(),
    };
    Ok((unseen.name.replace(' ', "-"), scan))
}

/// Largest distance from a contact to the nearest point of the cloud, metres.
fn farthest_contact(file: &GraspsFile, cloud: &PointCloud) -> f64 {
    let contacts = file.grasps.iter().flat_map(|g| &g.contacts_m);
    contacts
        .map(|c| page::nearest(cloud, c))
        .fold(0.0, f64::max)
}

impl GraspLine {
    /// What is proved of the surface.
    fn surface(&self) -> String {
        match (self.model, self.embedding) {
            (SurfaceModel::Radial, _) => format!(
                "radial surface, proved between {:.1} and {:.1} mm from its centre",
                1e3 * self.r_min_certified_m,
                1e3 * self.r_max_certified_m
            ),
            (SurfaceModel::Spherical, embedding) => format!(
                "spherical surface, {:.2} mm from the points (root mean square), proved {}",
                1e3 * self.rms_m,
                match embedding {
                    Some("proved") => "not to touch itself",
                    _ => "an immersion",
                }
            ),
        }
    }

    fn say_found(&self, hand: &Hand, synthesis: &str) {
        output::say(format!(
            "{}: {} points, {}",
            self.object,
            self.points,
            self.surface()
        ));
        for hole in &self.closed_holes {
            let [x, y, z] = hole.centre_m;
            output::say(format!(
                "a hole of {:.1} cm² at ({x:.3}, {y:.3}, {z:.3}) m was closed; no contact is placed there",
                1e4 * hole.area_m2
            ));
        }
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
                "{} grasps of the library are left out: they have as many contacts as the SDH has fingers, three, and {} has {}",
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
