//! Grasps from .json, .npy and .csv files.

use std::path::Path;

use grasp::{CentreRule, Contact, Convention, Grasp};
use nalgebra::{Point3, UnitVector3, Vector3};

use crate::failure::Failure;
use crate::input;

/// Normals whose length is within this of 1 are made unit vectors.
const NEARLY_UNIT: f64 = 0.01;

/// The grasps of a file, and the convention that it names if it names one.
///
/// The centre of torques comes with each row of numbers. In a `grasps.json` it is the one that the
/// `asked` convention names, or that of the file where none was asked for.
pub(super) fn read_grasps(
    path: &Path,
    asked: Option<&Convention>,
) -> Result<(Vec<Grasp>, Option<Convention>), Failure> {
    let mut rule = None;
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("");
    let grasps = match extension {
        "npy" => {
            let table = input::any_table(path)?;
            contacts_in(path, "the table", table.columns())?;
            table
                .rows()
                .enumerate()
                .map(|(row, cells)| from_row(path, row, cells))
                .collect::<Result<Vec<_>, _>>()?
        }
        "csv" => read_csv(path)?,
        "json" => {
            let (grasps, convention) = read_json(path, asked)?;
            rule = Some(convention);
            grasps
        }
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
    Ok((grasps, rule))
}

/// The contacts of a row of 6m+3 numbers: m positions, m inward normals and the centre.
fn contacts_in(path: &Path, place: &str, columns: usize) -> Result<usize, Failure> {
    if columns >= 15 && columns % 6 == 3 {
        return Ok((columns - 3) / 6);
    }
    Err(Failure::input(
        path,
        format!(
            "{place} has {columns} columns; expected 6m+3 for m contacts, two or more: \
             positions, inward normals, centre (21 for three contacts)"
        ),
    ))
}

/// A normal that is unit up to one per cent, made unit.
fn unit_normal(normal: Vector3<f64>) -> UnitVector3<f64> {
    if (normal.norm() - 1.0).abs() <= NEARLY_UNIT {
        UnitVector3::new_normalize(normal)
    } else {
        UnitVector3::new_unchecked(normal)
    }
}

/// A grasp from a row of numbers; `row` names it in errors.
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
    let count = contacts_in(path, &format!("row {row}"), cells.len())?;
    let contacts = (0..count)
        .map(|k| Contact {
            position: Point3::from(triple(k)),
            inward_normal: unit_normal(triple(k + count)),
        })
        .collect();
    Grasp::new(contacts, Point3::from(triple(2 * count)))
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
        contacts_in(path, &place, cells.len())?;
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

/// The grasps of a `grasps.json`, and its convention.
fn read_json(path: &Path, asked: Option<&Convention>) -> Result<(Vec<Grasp>, Convention), Failure> {
    let file = input::grasps(path)?;
    let convention = moduli::records::convention(&file.convention)
        .map_err(|e| Failure::input(path, format!("convention `{}`: {e}", file.convention.name)))?;
    let centre = match asked.unwrap_or(&convention).centre {
        CentreRule::CloudMean => Point3::from(file.object.centre_m),
        CentreRule::CentreOfMass => Point3::from(file.object.centre_of_mass_m),
        CentreRule::ObjectOrigin | CentreRule::Given => Point3::origin(),
    };
    let grasps = file
        .grasps
        .iter()
        .enumerate()
        .map(|(i, g)| {
            let contacts = g
                .contacts_m
                .iter()
                .zip(&g.inward_normals)
                .map(|(c, n)| Contact {
                    position: Point3::from(*c),
                    inward_normal: unit_normal(Vector3::from(*n)),
                })
                .collect();
            Grasp::new(contacts, centre)
                .map_err(|e| Failure::input(path, format!("grasp {i}: {e}")))
        })
        .collect::<Result<_, _>>()?;
    Ok((grasps, convention))
}
