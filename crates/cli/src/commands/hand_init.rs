//! `moduli hand init`: a first TOML for the URDF of a hand.

use std::path::PathBuf;

use hand::{HandSpec, Proposal, propose};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use serde::Serialize;

use crate::args::{Common, HandInitOptions};
use crate::failure::Failure;
use crate::{files, hands, output};

#[derive(Serialize)]
struct InitLine {
    urdf: String,
    spec: String,
    name: String,
    palm_link: String,
    fingers: Vec<String>,
    preshapes: Vec<String>,
    exempt_pairs: usize,
    notes: Vec<String>,
}

pub(crate) fn run(options: &HandInitOptions, common: &Common) -> Result<(), Failure> {
    let urdf = &options.urdf;
    let path = spec_path(options)?;
    run::check_results(&[&path], &[urdf])?;
    let model = hands::model(urdf, options.package_root.as_deref())?;
    let rng = ChaCha8Rng::seed_from_u64(common.seed);
    let proposal =
        propose(&model, options.palm.as_deref(), &rng).map_err(|e| Failure::input(urdf, e))?;
    output::write_file(&path, text(&proposal.spec).as_bytes())?;
    let line = line(options, &path, proposal);
    if common.json {
        output::say_json(&line)
    } else {
        say(&line);
        Ok(())
    }
}

/// The file given, or the one beside the URDF unless there is one.
fn spec_path(options: &HandInitOptions) -> Result<PathBuf, Failure> {
    if let Some(path) = &options.output {
        return Ok(path.clone());
    }
    if files::is_standard_input(&options.urdf) {
        return Err(Failure::usage(
            "a URDF from standard input has no folder; give the file for the TOML with -o",
        ));
    }
    let beside = options.urdf.with_extension("toml");
    if beside.exists() {
        return Err(Failure::usage(format!(
            "{} exists already and may have been written by hand; give another file, or this one, with -o",
            beside.display()
        )));
    }
    Ok(beside)
}

fn text(spec: &HandSpec) -> String {
    format!(
        "# How the hand is used, as `moduli hand init` found it from the URDF; lengths in metres, angles in radians.\n\
         # docs/bring-your-own-hand.md says what each key means; `moduli hand check` tries the hand on a ball.\n{}",
        spec.to_toml()
    )
}

fn line(options: &HandInitOptions, path: &std::path::Path, proposal: Proposal) -> InitLine {
    let Proposal { spec, notes } = proposal;
    InitLine {
        urdf: options.urdf.display().to_string(),
        spec: path.display().to_string(),
        name: spec.name,
        palm_link: spec.palm,
        fingers: spec.finger.into_iter().map(|f| f.name).collect(),
        preshapes: spec.preshape.into_iter().map(|p| p.name).collect(),
        exempt_pairs: spec.self_distance.exempt_pairs.len(),
        notes,
    }
}

fn say(line: &InitLine) {
    output::say(format!(
        "hand {}: palm {}, fingers {}, pre-shapes {}, {} exempt pairs",
        line.name,
        line.palm_link,
        line.fingers.join(", "),
        line.preshapes.join(", "),
        line.exempt_pairs
    ));
    for note in &line.notes {
        output::say(format!("note     {note}"));
    }
    output::say(&line.spec);
}
