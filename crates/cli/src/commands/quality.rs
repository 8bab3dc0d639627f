//! `moduli quality`: a number, and an interval that holds it, for every grasp given.

use std::path::Path;
use std::time::Instant;

use grasp::{CentreRule, Contact, Convention, Epsilon, Grasp, Workspace};
use nalgebra::{Point3, UnitVector3, Vector3};
use rayon::prelude::*;
use serde::Serialize;

use crate::args::{Common, QualityOptions};
use crate::failure::Failure;
use crate::{input, output};

/// c1 c2 c3 n1 n2 n3 z.
const COLUMNS: usize = 21;
/// Grasps a thread takes at once.
const CHUNK: usize = 256;

#[derive(Serialize)]
struct QualityLine {
    grasps: usize,
    closed: usize,
    mean: f64,
    best: f64,
    convention: String,
    seconds: f64,
    us_per_grasp: f64,
}

pub(crate) fn run(options: &QualityOptions, common: &Common) -> Result<(), Failure> {
    let mut convention = input::convention(&options.convention)?;
    // The centre comes with every grasp.
    convention.centre = CentreRule::Given;
    let grasps = read_grasps(&options.grasps)?;
    let start = Instant::now();
    let results = measure(&grasps, &convention, &options.grasps)?;
    let seconds = start.elapsed().as_secs_f64();
    let numbers: Vec<f64> = results.iter().map(|e| e.value(&convention)).collect();
    if let Some(path) = &options.output {
        let rows: Vec<f64> = results
            .iter()
            .zip(&numbers)
            .flat_map(|(e, q)| [*q, e.lower, e.upper])
            .collect();
        output::write_file(path, &output::npy(3, rows)?)?;
    }
    let count = grasps.len() as f64;
    let line = QualityLine {
        grasps: grasps.len(),
        closed: results.iter().filter(|e| e.closed).count(),
        mean: numbers.iter().sum::<f64>() / count,
        best: numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        convention: convention.name.clone(),
        seconds,
        us_per_grasp: 1e6 * seconds / count,
    };
    if common.json {
        return output::say_json(&line);
    }
    if grasps.len() <= 20 {
        for (i, (e, q)) in results.iter().zip(&numbers).enumerate() {
            output::say(format!("{i:5}  {q:10.6}  [{:.6}, {:.6}]", e.lower, e.upper));
        }
    }
    output::say(format!(
        "{} grasps, {} force-closed, mean {:.6}, best {:.6} under `{}`; {:.1} µs a grasp",
        line.grasps, line.closed, line.mean, line.best, line.convention, line.us_per_grasp
    ));
    Ok(())
}

fn measure(
    grasps: &[Grasp],
    convention: &Convention,
    path: &Path,
) -> Result<Vec<Epsilon>, Failure> {
    // Of several failures the first is returned, so that threads do not decide which.
    let chunks: Vec<Result<Vec<Epsilon>, Failure>> = grasps
        .par_chunks(CHUNK)
        .enumerate()
        .map(|(chunk, grasps)| {
            let mut work = Workspace::new();
            let one = |(i, g): (usize, &Grasp)| {
                grasp::epsilon(&g.under(convention), &mut work)
                    .map_err(|e| Failure::input(path, format!("grasp {}: {e}", chunk * CHUNK + i)))
            };
            grasps.iter().enumerate().map(one).collect()
        })
        .collect();
    let chunks: Vec<Vec<Epsilon>> = chunks.into_iter().collect::<Result<_, _>>()?;
    Ok(chunks.concat())
}

fn read_grasps(path: &Path) -> Result<Vec<Grasp>, Failure> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("");
    let grasps = match extension {
        "npy" => {
            let table = input::table(path, COLUMNS)?;
            table
                .rows()
                .enumerate()
                .map(|(row, cells)| from_row(path, row, cells))
                .collect::<Result<Vec<_>, _>>()?
        }
        "csv" => read_csv(path)?,
        "json" => read_json(path)?,
        _ => {
            return Err(Failure::input(
                path,
                "expected grasps in a .json, .npy or .csv file",
            ));
        }
    };
    if grasps.is_empty() {
        return Err(Failure::input(path, "holds no grasps"));
    }
    Ok(grasps)
}

/// A grasp from 21 numbers; `row` names it in errors.
fn from_row(path: &Path, row: usize, cells: &[f64]) -> Result<Grasp, Failure> {
    if let Some(column) = cells.iter().position(|v| !v.is_finite()) {
        return Err(Failure::input(
            path,
            format!(
                "row {row}, column {column} is {}; expected a finite number",
                cells[column]
            ),
        ));
    }
    let triple = |k: usize| Vector3::new(cells[3 * k], cells[3 * k + 1], cells[3 * k + 2]);
    let contacts = (0..3)
        .map(|k| Contact {
            position: Point3::from(triple(k)),
            inward_normal: UnitVector3::new_unchecked(triple(k + 3)),
        })
        .collect();
    Grasp::new(contacts, Point3::from(triple(6)))
        .map_err(|e| Failure::input(path, format!("row {row}: {e}")))
}

/// Comma separated rows; a first row of words is a header.
fn read_csv(path: &Path) -> Result<Vec<Grasp>, Failure> {
    let text = String::from_utf8(input::read(path)?)
        .map_err(|_| Failure::input(path, "not a text file"))?;
    let mut grasps = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        let header = number == 0 && cells.iter().all(|c| c.parse::<f64>().is_err());
        if line.trim().is_empty() || header {
            continue;
        }
        let place = format!("line {}", number + 1);
        if cells.len() != COLUMNS {
            return Err(Failure::input(
                path,
                format!("{place} has {} columns; expected {COLUMNS}", cells.len()),
            ));
        }
        let parse = |(column, cell): (usize, &&str)| {
            cell.parse::<f64>().map_err(|_| {
                Failure::input(
                    path,
                    format!("{place}, column {column} is `{cell}`; expected a number"),
                )
            })
        };
        let cells: Vec<f64> = cells
            .iter()
            .enumerate()
            .map(parse)
            .collect::<Result<_, _>>()?;
        grasps.push(from_row(path, grasps.len(), &cells)?);
    }
    Ok(grasps)
}

/// Our own grasps.json; torques are taken about the object's centre.
fn read_json(path: &Path) -> Result<Vec<Grasp>, Failure> {
    let file = input::grasps(path)?;
    file.grasps
        .iter()
        .enumerate()
        .map(|(i, g)| {
            let contacts = g
                .contacts_m
                .iter()
                .zip(&g.inward_normals)
                .map(|(c, n)| Contact {
                    position: Point3::from(*c),
                    inward_normal: UnitVector3::new_unchecked(Vector3::from(*n)),
                })
                .collect();
            Grasp::new(contacts, Point3::from(file.object.centre_m))
                .map_err(|e| Failure::input(path, format!("grasp {i}: {e}")))
        })
        .collect()
}
