//! Grasps as the user gives them: `grasps.json`, or rows of numbers.

use std::path::Path;

use grasp::{Contact, Grasp};
use nalgebra::{Point3, UnitVector3, Vector3};

use crate::failure::Failure;
use crate::input;

/// The numbers of one grasp: c1 c2 c3 n1 n2 n3 z, each a vector.
const COLUMNS: usize = 21;

/// The grasps of a file, at least one; the ending of its name decides how it is read.
pub(super) fn read_grasps(path: &Path) -> Result<Vec<Grasp>, Failure> {
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
                "expected a file of grasps whose name ends in .json, .npy or .csv",
            ));
        }
    };
    if grasps.is_empty() {
        return Err(Failure::input(path, "there are no grasps in the file"));
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

/// Comma-separated rows; a first row without any number is a header.
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

/// A `grasps.json`; torques are taken about the mean of the object's cloud.
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
