//! `moduli quality`: the quality of given grasps, each with an interval that contains it.

mod certificates;
mod evidence;
mod grasps;
mod isaac;

use std::path::Path;
use std::time::Instant;

use grasp::{CentreRule, Contact, Convention, Epsilon, Grasp, GraspModel, TangentRule, Workspace};
use hand::TipModel;
use moduli::Metrics;
use nalgebra::Vector3;
use rayon::prelude::*;
use serde::Serialize;

use self::certificates::CertificateLine;
use crate::args::{Common, Metric, QualityOptions};
use crate::failure::Failure;
use crate::{input, output};

/// Grasps that one thread takes at once.
const CHUNK: usize = 256;
/// Up to this many grasps are printed one by one.
const FEW: usize = 20;
/// The largest friction coefficient that `friction-needed` tries.
const MOST_FRICTION: f64 = 100.0;

/// The grasps of a file.
struct GraspSet {
    grasps: Vec<Grasp>,
    /// The convention that the file names.
    rule: Option<Convention>,
    /// The convention of the options resolved on the object, if the object is known.
    resolved: Option<Convention>,
    /// The contact model of the file.
    tips: TipModel,
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct QualityLine {
    grasps: usize,
    closed: usize,
    converged: usize,
    mean: f64,
    best: f64,
    metric: Metric,
    convention: String,
    warnings: Vec<String>,
    seconds: f64,
    us_per_grasp: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    columns: Option<Vec<&'static str>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rows: Option<Vec<Vec<Option<f64>>>>,
}

/// One grasp: whether it is force-closed, and its numbers in the order of [`Metrics::COLUMNS`].
struct Row {
    closed: bool,
    converged: bool,
    cells: Vec<Option<f64>>,
    certificate: Option<CertificateLine>,
}

pub(crate) fn run(options: &QualityOptions, common: &Common) -> Result<(), Failure> {
    let named = input::convention(&options.convention)?;
    let set = grasps::read_grasps(options, &named)?;
    let scan = evidence::read(options, common)?;
    let cloud = scan.as_ref().map(|scan| &scan.cloud);
    let named = set.resolved.unwrap_or(named);
    let (grasps, convention) = (set.grasps, convention(options, named, set.rule)?);
    let tips = options.contact.unwrap_or(set.tips);
    let start = Instant::now();
    let path = &options.grasps;
    let rows = if options.all {
        let all = |grasp: &Grasp, work: &mut Workspace| {
            let models = tips.of_contacts(convention.friction, grasp.contacts.len());
            let model = grasp.under(&convention).with_contact_models(&models);
            let metrics = Metrics::of_model(&model)?;
            let mut cells = metrics.row(&convention).to_vec();
            if let Some(cloud) = cloud {
                cells.extend(evidence::cells(&model, cloud, work)?);
            }
            Ok(Row::new(&metrics.epsilon, cells))
        };
        measure(&grasps, path, all)?
    } else {
        let one = |grasp: &Grasp, work: &mut Workspace| {
            let models = tips.of_contacts(convention.friction, grasp.contacts.len());
            let model = grasp.under(&convention).with_contact_models(&models);
            Ok(measured(&model, options, work)?)
        };
        measure(&grasps, path, one)?
    };
    let seconds = start.elapsed().as_secs_f64();
    let named = Metrics::COLUMNS.into_iter().chain(evidence::COLUMNS);
    let columns: Vec<&'static str> = named.take(rows[0].cells.len()).collect();
    if let Some(path) = &options.output {
        let bytes = table(path, &columns, &rows)?;
        output::write_file(path, &bytes)?;
    }
    if let Some(path) = &options.certificate {
        let proofs: Vec<_> = rows.iter().map(|row| &row.certificate).collect();
        output::write_file(path, &output::encode(&proofs)?)?;
    }
    let mut line = summary(&rows, options.metric, &convention, seconds);
    line.warnings.extend(set.warnings);
    line.warnings.extend(unit_warning(&grasps));
    line.warnings
        .extend(scan.iter().flat_map(|scan| scan.warnings.clone()));
    let distance = columns.iter().position(|c| *c == evidence::COLUMNS[1]);
    let distances = distance.map(|at| rows.iter().map(move |row| row.cells[at]));
    line.warnings.extend(distances.and_then(evidence::warning));
    line.warnings.iter().for_each(output::warn);
    if common.json {
        return output::say_json(&QualityLine {
            columns: options.all.then_some(columns),
            rows: options
                .all
                .then(|| rows.into_iter().map(|row| row.cells).collect()),
            ..line
        });
    }
    print(options.all, &columns, &rows);
    output::say(format!(
        "{} grasps, {} force-closed, mean {:.6}, best {:.6} under `{}`; {:.1} µs per grasp",
        line.grasps, line.closed, line.mean, line.best, line.convention, line.us_per_grasp
    ));
    Ok(())
}

/// The convention of the options, or of the file where the options name none.
fn convention(
    options: &QualityOptions,
    named: Convention,
    file: Option<Convention>,
) -> Result<Convention, Failure> {
    let said = &options.convention;
    let mut convention = match (file, &said.convention) {
        (Some(rule), None) => input::changed(rule, said)?,
        _ => named,
    };
    // FRoGGeR's own tangent frames. Under another torque length than its own the number belongs to no
    // system, and the frames are those of every convention.
    let own_length = Convention::named("frogger").map(|own| own.torque_length);
    if said.convention.as_deref() == Some("frogger") && own_length == Ok(convention.torque_length) {
        convention.tangent = TangentRule::Projected(Vector3::new(1.2, 2.3, 3.4));
    }
    // The centre comes with every grasp.
    convention.centre = CentreRule::Given;
    Ok(convention)
}

/// The number of one grasp and the interval that contains it.
fn measured(
    model: &GraspModel<'_>,
    options: &QualityOptions,
    work: &mut Workspace,
) -> Result<Row, grasp::QualityError> {
    let (found, certificate) = match (options.metric, &options.certificate) {
        (Metric::Epsilon, Some(_)) => {
            let (found, proof) = grasp::epsilon_with_certificate(model, work)?;
            let line = CertificateLine::new(&found, &proof);
            (found, Some(line))
        }
        (Metric::Linf, _) => (grasp::epsilon_linf(model, work)?, None),
        _ => (grasp::epsilon(model, work)?, None),
    };
    let cells = match options.metric {
        Metric::Epsilon | Metric::Linf => {
            let ends = [found.value(model.convention), found.lower, found.upper];
            let row = Row::new(&found, ends.map(Some).to_vec());
            return Ok(Row { certificate, ..row });
        }
        Metric::MinWeight => vec![grasp::min_weight(model)?; 3],
        Metric::FrictionNeeded => {
            let needed = grasp::friction_needed(model, MOST_FRICTION, work)?;
            let below = needed.closure.map(|_| needed.no_closure_below.friction);
            vec![needed.closure, below, needed.closure]
        }
    };
    let row = Row::new(&found, cells);
    Ok(Row {
        converged: true,
        ..row
    })
}

impl Row {
    fn new(found: &Epsilon, cells: Vec<Option<f64>>) -> Self {
        Row {
            closed: found.closed,
            converged: found.converged,
            cells,
            certificate: None,
        }
    }
}

/// A warning about contacts that are so far apart that they are probably in millimetres, or so far from
/// the centre of torques that one of the two is.
fn unit_warning(grasps: &[Grasp]) -> Option<String> {
    const WIDEST: f64 = 2.0;
    let spans = grasps.iter().map(|g| {
        let first = g.contacts.first().map_or(g.centre, |c| c.position);
        let apart = |c: &Contact| (c.position - first).norm();
        let apart = g.contacts.iter().map(apart).fold(0.0, f64::max);
        (apart, (g.centre - first).norm())
    });
    let wide = |(_, (apart, away)): &(usize, (f64, f64))| apart.max(*away) > WIDEST;
    let (first, (apart, away)) = spans.enumerate().find(wide)?;
    let what = if apart > WIDEST {
        format!("the contacts of grasp {first} are {apart:.1} m apart")
    } else {
        format!("the centre of grasp {first} is {away:.1} m from its contacts")
    };
    Some(format!(
        "{what}; positions are expected in metres: are these millimetres?"
    ))
}

fn warnings(rows: &[Row]) -> Vec<String> {
    let wide = rows.iter().filter(|row| !row.converged).count();
    match rows.iter().position(|row| !row.converged) {
        Some(first) => vec![format!(
            "{wide} of {} intervals are wider than asked for (the first is grasp {first}); \
             for these the quality is the proved lower bound",
            rows.len()
        )],
        None => Vec::new(),
    }
}

/// One row per grasp, computed in parallel.
fn measure(
    grasps: &[Grasp],
    path: &Path,
    row: impl Fn(&Grasp, &mut Workspace) -> Result<Row, moduli::Error> + Sync,
) -> Result<Vec<Row>, Failure> {
    // Of several failures the first is returned, so that the result does not depend on the threads.
    let chunks: Vec<Result<Vec<_>, Failure>> = grasps
        .par_chunks(CHUNK)
        .enumerate()
        .map(|(chunk, grasps)| {
            let mut work = Workspace::new();
            let one = |(i, g): (usize, &Grasp)| {
                row(g, &mut work)
                    .map_err(|e| Failure::input(path, format!("grasp {}: {e}", chunk * CHUNK + i)))
            };
            grasps.iter().enumerate().map(one).collect()
        })
        .collect();
    let chunks: Vec<Vec<Row>> = chunks.into_iter().collect::<Result<_, _>>()?;
    Ok(chunks.into_iter().flatten().collect())
}

fn summary(rows: &[Row], metric: Metric, convention: &Convention, seconds: f64) -> QualityLine {
    let qualities = || rows.iter().filter_map(|row| row.cells[0]);
    let count = rows.len() as f64;
    QualityLine {
        grasps: rows.len(),
        closed: rows.iter().filter(|row| row.closed).count(),
        converged: rows.iter().filter(|row| row.converged).count(),
        mean: qualities().sum::<f64>() / qualities().count().max(1) as f64,
        best: qualities().fold(f64::NEG_INFINITY, f64::max),
        metric,
        convention: convention.name.clone(),
        warnings: warnings(rows),
        seconds,
        us_per_grasp: 1e6 * seconds / count,
        columns: None,
        rows: None,
    }
}

/// The result as CSV with a header, where the name ends in `.csv`, or as `.npy`; what a grasp does
/// not have is an empty cell or NaN.
fn table(path: &Path, columns: &[&str], rows: &[Row]) -> Result<Vec<u8>, Failure> {
    if path.extension().is_some_and(|e| e == "csv") {
        let cell = |value: &Option<f64>| value.map_or_else(String::new, |v| v.to_string());
        let line = |row: &Row| row.cells.iter().map(cell).collect::<Vec<_>>().join(",");
        let lines = std::iter::once(columns.join(",")).chain(rows.iter().map(line));
        return Ok(lines
            .map(|line| line + "\n")
            .collect::<String>()
            .into_bytes());
    }
    let cells = rows.iter().flat_map(|row| &row.cells);
    let values = cells.map(|value| value.unwrap_or(f64::NAN)).collect();
    output::npy(columns.len(), values)
}

/// Six decimals, or an exponent where these would hide a number that is not zero.
fn short(value: f64) -> String {
    if value != 0.0 && value.abs() < 1e-3 {
        format!("{value:.3e}")
    } else {
        format!("{value:.6}")
    }
}

/// A few grasps are printed one by one; of many, the mean over those that have a value.
fn print(all: bool, columns: &[&str], rows: &[Row]) {
    if !all {
        if rows.len() <= FEW {
            for (i, row) in rows.iter().enumerate() {
                let [q, lower, upper] = [0, 1, 2].map(|k| row.cells[k].unwrap_or(f64::NAN));
                let mark = if row.converged { "" } else { "  not converged" };
                let [q, lower, upper] = [q, lower, upper].map(short);
                output::say(format!("{i:5}  {q:>10}  [{lower}, {upper}]{mark}"));
            }
        }
        return;
    }
    let width = |name: &str| name.len().max(10);
    let line = |first: &str, cells: Vec<String>| {
        let cells = cells.iter().zip(columns);
        let cells = cells.map(|(cell, name)| format!("  {cell:>w$}", w = width(name)));
        output::say(format!("{first:>5}{}", cells.collect::<String>()));
    };
    let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |v| format!("{v:.4e}"));
    line("", columns.iter().map(|&name| name.to_owned()).collect());
    if rows.len() <= FEW {
        for (i, row) in rows.iter().enumerate() {
            line(
                &i.to_string(),
                row.cells.iter().map(|&v| number(v)).collect(),
            );
        }
        return;
    }
    let mean = |column: usize| {
        let values: Vec<f64> = rows.iter().filter_map(|row| row.cells[column]).collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    };
    line(
        "mean",
        (0..columns.len()).map(|k| number(mean(k))).collect(),
    );
}
