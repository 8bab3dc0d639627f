//! `moduli hand check`: findings about a hand's files, and pictures of the hand.

use std::collections::BTreeMap;
use std::path::PathBuf;

use hand::{Hand, TipModel};
use serde::Serialize;

use crate::args::{Common, HandCheckOptions, HandOptions};
use crate::failure::Failure;
use crate::hands::findings::{self, Checked, Finding};
use crate::hands::trial::{self, Trial};
use crate::hands::{page, spec_path};
use crate::outcomes::{reasons, sentence, why_none};
use crate::{input, output};

#[derive(Serialize)]
struct CheckLine<'a> {
    urdf: String,
    spec: String,
    findings: &'a [Finding],
    errors: usize,
    warnings: usize,
    hand: Option<HandLine<'a>>,
}

#[derive(Serialize)]
struct HandLine<'a> {
    name: &'a str,
    palm_link: &'a str,
    links: usize,
    driven_joints: Vec<&'a str>,
    fingers: Vec<&'a str>,
    preshapes: Vec<&'a str>,
    ball_diameter_m: f64,
    ball_poses: usize,
    ball_stable: usize,
    ball_rejected: BTreeMap<&'static str, usize>,
    page: String,
}

pub(crate) fn run(options: &HandCheckOptions, common: &Common) -> Result<(), Failure> {
    let files = HandOptions {
        hand: options.urdf.clone(),
        spec: options.spec.clone(),
        package_root: options.package_root.clone(),
    };
    let mut checked = findings::check(&files)?;
    let hand = checked.hand.take();
    let tried = hand
        .as_ref()
        .map(|hand| {
            let tips = options.contact.unwrap_or_else(|| hand.tip_model());
            checked.findings.extend(two_fingers(hand, tips, &files));
            trial::on_ball(hand, options.ball, tips, common.seed)
        })
        .transpose()?;
    if let (Some(hand), Some(tried)) = (&hand, &tried) {
        let tips = options.contact.unwrap_or_else(|| hand.tip_model());
        checked.findings.extend(all_fingers(hand, &files));
        if tried.outcomes.stable == 0 {
            let other = trial::other_ball(hand, tips, common.seed)?;
            checked
                .findings
                .push(no_grasp(hand, tried, tips, other, &files));
        }
    }
    let page = options.output.clone().unwrap_or_else(|| {
        PathBuf::from("out")
            .join(input::stem(&options.urdf))
            .join("hand.html")
    });
    let shown = hand.as_ref().zip(tried.as_ref());
    if let Some((hand, tried)) = shown {
        let html = page::render(hand, &checked, tried)?;
        output::write_file(&page, html.as_bytes())?;
    }
    let page = page.display().to_string();
    let line = CheckLine {
        urdf: files.hand.display().to_string(),
        spec: spec_path(&files).display().to_string(),
        findings: &checked.findings,
        errors: checked.count("error"),
        warnings: checked.count("warning"),
        hand: shown.map(|(hand, tried)| hand_line(hand, tried, page)),
    };
    if common.json {
        output::say_json(&line)?;
    } else {
        say(&line, tried.as_ref());
    }
    verdict(&checked, &files)
}

/// Advice for hands with two fingers.
fn two_fingers(hand: &Hand, tips: TipModel, files: &HandOptions) -> Option<Finding> {
    if hand.fingers().len() > 2 {
        return None;
    }
    let (severity, text) = match tips {
        TipModel::Point => (
            "warning",
            "two hard point contacts can never resist a torque about the line between them, whatever the friction; take soft fingers, --contact soft:RADIUS".to_owned(),
        ),
        TipModel::Soft { radius } if !hand.has_pad_radius() => (
            "warning",
            format!(
                "two hard point contacts could never hold, so the tips are taken for soft fingers of {:.0} mm radius; write the radius of their pads into the TOML, pad_radius_m = …, or give --contact soft:RADIUS",
                1e3 * radius
            ),
        ),
        TipModel::Soft { radius } | TipModel::Patch { radius } => (
            "note",
            format!(
                "the two tips touch with pads of {:.1} mm radius: two hard point contacts could never hold",
                1e3 * radius
            ),
        ),
    };
    Some(Finding {
        severity,
        place: spec_path(files).display().to_string(),
        text,
    })
}

/// A note for hands of many fingers all of which must touch.
fn all_fingers(hand: &Hand, files: &HandOptions) -> Option<Finding> {
    let fingers = hand.fingers().len();
    (fingers > 3 && hand.least_fingers() == fingers).then(|| Finding {
        severity: "note",
        place: spec_path(files).display().to_string(),
        text: format!(
            "a grasp needs all {fingers} fingers to touch; write least_fingers = 3 into the TOML to accept grasps in which some do not"
        ),
    })
}

/// An error if the hand grasps no ball at all, a warning if it grasps one of another diameter.
fn no_grasp(
    hand: &Hand,
    tried: &Trial,
    tips: TipModel,
    other: Option<f64>,
    files: &HandOptions,
) -> Finding {
    let (severity, advice) = match other {
        Some(diameter) => (
            "warning",
            format!("a ball of {:.0} mm can be grasped", 1e3 * diameter),
        ),
        None => ("error", "no other ball can be grasped either".to_owned()),
    };
    Finding {
        severity,
        place: spec_path(files).display().to_string(),
        text: format!(
            "no pose gives a stable grasp of a ball of {:.0} mm: {}; {advice}",
            1e3 * tried.diameter,
            why_none(&tried.outcomes, hand, tips)
        ),
    }
}

fn hand_line<'a>(hand: &'a Hand, tried: &Trial, page: String) -> HandLine<'a> {
    HandLine {
        name: hand.name(),
        palm_link: &hand.model().links()[0].name,
        links: hand.model().links().len(),
        driven_joints: hand.model().driven_names(),
        fingers: hand.fingers().iter().map(|f| f.name.as_str()).collect(),
        preshapes: hand.preshapes().iter().map(|p| p.name.as_str()).collect(),
        ball_diameter_m: tried.diameter,
        ball_poses: tried.outcomes.total(),
        ball_stable: tried.outcomes.stable,
        ball_rejected: reasons(&tried.outcomes).into_iter().collect(),
        page,
    }
}

fn say(line: &CheckLine, tried: Option<&Trial>) {
    for finding in line.findings {
        output::say(format!(
            "{:8} {}: {}",
            finding.severity, finding.place, finding.text
        ));
    }
    if let (Some(hand), Some(tried)) = (&line.hand, tried) {
        output::say(format!(
            "hand {}: palm {}, {} links, {} driven joints, fingers {}, pre-shapes {}",
            hand.name,
            hand.palm_link,
            hand.links,
            hand.driven_joints.len(),
            hand.fingers.join(", "),
            hand.preshapes.join(", ")
        ));
        output::say(format!(
            "on a ball of {:.0} mm: {}",
            1e3 * tried.diameter,
            sentence(&tried.outcomes)
        ));
        output::say(&hand.page);
    }
    output::say(format!(
        "{} errors, {} warnings",
        line.errors, line.warnings
    ));
}

fn verdict(checked: &Checked, files: &HandOptions) -> Result<(), Failure> {
    match checked.count("error") {
        0 => Ok(()),
        errors => Err(Failure::input(
            &files.hand,
            format!("this hand cannot be used: {errors} errors, listed above"),
        )),
    }
}
