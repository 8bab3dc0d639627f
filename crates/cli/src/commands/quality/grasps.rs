//! Grasps from .json, .npy and .csv files.

use std::path::Path;

use grasp::{CentreRule, Contact, Convention, Grasp};
use hand::TipModel;
use nalgebra::{Point3, UnitVector3, Vector3};
use record::{GraspsFile, IsaacFile};
use run::npy::Table;

use super::GraspSet;
use super::isaac::read_isaac;
use crate::args::QualityOptions;
use crate::failure::Failure;
use crate::input;

/// Normals whose length is within this of 1 are made unit vectors.
const NEARLY_UNIT: f64 = 0.01;
/// Normals whose length is farther from 1 than this are counted, since they were made unit vectors.
const UNIT: f64 = 1e-6;
/// Contacts farther from the certified range of the surface than this are not on it, metres.
const OFF_SURFACE: f64 = 5e-3;

const EXPECTED: &str = "expected a grasps.json, an isaac_grasp YAML, or rows of numbers as an array of NumPy or as text (.csv)";

/// The grasps of a file, whose content decides how it is read: a `grasps.json`, an array of NumPy, or
/// a text of rows of numbers.
///
/// The centre of torques comes with each row of numbers. In a `grasps.json` it is the one that the
/// `named` convention of the options names, or that of the file where the options name none.
pub(super) fn read_grasps(
    options: &QualityOptions,
    named: &Convention,
) -> Result<GraspSet, Failure> {
    let path = options.grasps.as_path();
    let asked = options.convention.convention.as_ref().map(|_| named);
    let bytes = input::read(path)?;
    let start = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(&bytes);
    if let Some(kind) = shape::io::foreign_kind(&bytes) {
        return Err(Failure::input(path, format!("this is {kind}; {EXPECTED}")));
    }
    let text = String::from_utf8_lossy(start);
    if IsaacFile::is_meant(&text) {
        return read_isaac(path, &text, options, named);
    }
    let mut reader = Reader {
        path,
        adjusted: 0,
        off_object: None,
    };
    let (mut rule, mut tips) = (None, TipModel::Point);
    let named_json = path.extension().is_some_and(|e| e == "json");
    let grasps = if bytes.starts_with(b"\x93NUMPY") {
        let table = Table::from_npy_flattened(&bytes).map_err(|e| Failure::input(path, e))?;
        contacts_in(path, "the table", table.columns())?;
        let rows = table.rows().enumerate();
        rows.map(|(row, cells)| reader.grasp_of_row(&format!("row {row}"), cells))
            .collect::<Result<_, _>>()?
    } else if named_json || start.trim_ascii_start().starts_with(b"{") {
        let (grasps, convention, contacts) = reader.read_json(start, asked)?;
        (rule, tips) = (Some(convention), contacts);
        grasps
    } else {
        let rows = rows_of_text(path, start)?;
        let grasp =
            |(line, cells): &(usize, Vec<f64>)| reader.grasp_of_row(&format!("line {line}"), cells);
        rows.iter().map(grasp).collect::<Result<_, _>>()?
    };
    if grasps.is_empty() {
        return Err(Failure::input(path, "there are no grasps in the file"));
    }
    Ok(GraspSet {
        grasps,
        rule,
        resolved: None,
        tips,
        warnings: reader.warnings(),
    })
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

/// Converts numbers to grasps, and counts the normals that were changed.
struct Reader<'a> {
    path: &'a Path,
    adjusted: usize,
    /// A contact that is not on the object of its file.
    off_object: Option<String>,
}

impl Reader<'_> {
    fn warnings(&self) -> Vec<String> {
        let count = self.adjusted;
        let said =
            format!("{count} normals were not of unit length (within 1 %) and were normalised");
        let adjusted = (count > 0).then_some(said);
        adjusted
            .into_iter()
            .chain(self.off_object.clone())
            .collect()
    }

    /// Notes the first contact that is farther from the centre of the file's object, or nearer to it,
    /// than any point of the surface.
    fn compare_with_object(&mut self, file: &GraspsFile) {
        let object = &file.object;
        let (least, largest) = (object.r_min_certified_m, object.r_max_certified_m);
        if !(largest > 0.0 && least <= largest) {
            return;
        }
        let off = |contact: &[f64; 3]| {
            let radius = (Point3::from(*contact) - Point3::from(object.centre_m)).norm();
            (radius - largest).max(least - radius)
        };
        for (i, grasp) in file.grasps.iter().enumerate() {
            let farthest = grasp.contacts_m.iter().map(off).fold(0.0, f64::max);
            if self.off_object.is_none() && farthest > OFF_SURFACE {
                self.off_object = Some(format!(
                    "a contact of grasp {i} is {:.1} mm or more from the surface of `{}`, the object of \
                     the file; are these grasps of another object, in another frame or in another unit?",
                    1e3 * farthest,
                    object.name
                ));
            }
        }
    }

    /// The unit vector of a normal whose length is 1 to within one per cent.
    fn unit_normal(&mut self, normal: Vector3<f64>) -> UnitVector3<f64> {
        let excess = (normal.norm() - 1.0).abs();
        if excess <= NEARLY_UNIT {
            self.adjusted += usize::from(excess > UNIT);
            UnitVector3::new_normalize(normal)
        } else {
            UnitVector3::new_unchecked(normal)
        }
    }

    /// A grasp from a row of numbers; `place` names it in errors.
    fn grasp_of_row(&mut self, place: &str, cells: &[f64]) -> Result<Grasp, Failure> {
        if let Some(column) = cells.iter().position(|v| !v.is_finite()) {
            let value = cells[column];
            let why = format!("{place}, column {column} is {value}; expected a finite number");
            return Err(Failure::input(self.path, why));
        }
        let triple = |k: usize| Vector3::new(cells[3 * k], cells[3 * k + 1], cells[3 * k + 2]);
        let count = contacts_in(self.path, place, cells.len())?;
        let contacts = (0..count)
            .map(|k| Contact {
                position: Point3::from(triple(k)),
                inward_normal: self.unit_normal(triple(k + count)),
            })
            .collect();
        Grasp::new(contacts, Point3::from(triple(2 * count)))
            .map_err(|e| Failure::input(self.path, format!("{place}: {e}")))
    }

    /// The grasps of a `grasps.json`, its convention and what its contacts transmit.
    fn read_json(
        &mut self,
        bytes: &[u8],
        asked: Option<&Convention>,
    ) -> Result<(Vec<Grasp>, Convention, TipModel), Failure> {
        let path = self.path;
        let file = GraspsFile::from_json(bytes).map_err(|e| Failure::input(path, e))?;
        let convention = moduli::records::convention(&file.convention).map_err(|e| {
            Failure::input(path, format!("convention `{}`: {e}", file.convention.name))
        })?;
        let centre = match asked.unwrap_or(&convention).centre {
            CentreRule::CloudMean => Point3::from(file.object.centre_m),
            CentreRule::CentreOfMass => Point3::from(file.object.centre_of_mass_m),
            CentreRule::ObjectOrigin | CentreRule::Given => Point3::origin(),
        };
        self.compare_with_object(&file);
        let mut grasps = Vec::with_capacity(file.grasps.len());
        for (i, g) in file.grasps.iter().enumerate() {
            let pairs = g.contacts_m.iter().zip(&g.inward_normals);
            let contacts = pairs
                .map(|(c, n)| Contact {
                    position: Point3::from(*c),
                    inward_normal: self.unit_normal(Vector3::from(*n)),
                })
                .collect();
            let grasp = Grasp::new(contacts, centre);
            grasps.push(grasp.map_err(|e| Failure::input(path, format!("grasp {i}: {e}")))?);
        }
        let tips = moduli::records::tip_model(file.convention.contact);
        Ok((grasps, convention, tips))
    }
}

/// The rows of a text with their line numbers.
///
/// Columns are separated by semicolons if a line has any, else by commas, else by blanks; beside
/// semicolons a comma is a decimal comma. `#` begins a comment, and a first line without any number
/// is a header; where its first name is empty, the first column is left out.
fn rows_of_text(path: &Path, bytes: &[u8]) -> Result<Vec<(usize, Vec<f64>)>, Failure> {
    let binary = |b: &u8| b.is_ascii_control() && !b.is_ascii_whitespace();
    if bytes.iter().any(binary) {
        let why = format!("not a file of grasps; {EXPECTED}");
        return Err(Failure::input(path, why));
    }
    let text = String::from_utf8_lossy(bytes);
    let mut rows: Vec<(usize, Vec<f64>)> = Vec::new();
    // Numbers of rows that stand in a first column without a name.
    let mut index_column = None;
    for (index, line) in text.split('\n').enumerate() {
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.is_empty() {
            continue;
        }
        let mut cells = cells(line);
        if rows.is_empty() && index_column.is_none() && cells.iter().all(|c| number(c).is_none()) {
            index_column = Some(cells[0].is_empty());
            continue;
        }
        if index_column == Some(true) {
            cells.remove(0);
        }
        let place = format!("line {}", index + 1);
        let named = |(column, cell): (usize, &&str)| {
            let why = format!("{place}, column {column} is `{cell}`; expected a number");
            number(cell).ok_or_else(|| Failure::input(path, why))
        };
        let numbers: Vec<f64> = cells
            .iter()
            .enumerate()
            .map(named)
            .collect::<Result<_, _>>()?;
        contacts_in(path, &place, numbers.len())?;
        rows.push((index + 1, numbers));
    }
    Ok(rows)
}

fn cells(line: &str) -> Vec<&str> {
    match [';', ','].into_iter().find(|c| line.contains(*c)) {
        Some(separator) => {
            let line = line.strip_suffix(separator).unwrap_or(line);
            let cells = line.split(separator);
            cells.map(|c| c.trim().trim_matches(['"', '\''])).collect()
        }
        None => line.split_whitespace().collect(),
    }
}

/// A number, perhaps with a decimal comma: where commas separate, no cell has one.
fn number(cell: &str) -> Option<f64> {
    cell.parse()
        .ok()
        .or_else(|| cell.replacen(',', ".", 1).parse().ok())
}
