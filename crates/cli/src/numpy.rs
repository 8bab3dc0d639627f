//! Tables of doubles in `.npy` files.

use std::path::Path;

use npyz::{NpyFile, Order, WriterBuilder};

use crate::failure::Failure;
use crate::input;

/// A table, row after row.
pub(crate) struct Table {
    pub(crate) columns: usize,
    pub(crate) values: Vec<f64>,
}

impl Table {
    pub(crate) fn rows(&self) -> std::slice::ChunksExact<'_, f64> {
        self.values.chunks_exact(self.columns)
    }
}

/// Reads an N×columns array of 32- or 64-bit floats, in either memory order.
pub(crate) fn read(path: &Path, columns: usize) -> Result<Table, Failure> {
    let bytes = input::read(path)?;
    let parse = |e: std::io::Error| Failure::input(path, format!("not a readable .npy file: {e}"));
    let file = NpyFile::new(&bytes[..]).map_err(parse)?;
    let shape = file.shape().to_vec();
    if shape.len() != 2 || shape[1] != columns as u64 {
        return Err(Failure::input(
            path,
            format!("an array of shape {shape:?}; expected N×{columns}"),
        ));
    }
    let order = file.order();
    // The header's count is checked against the bytes at hand before anything is allocated.
    if shape[0].saturating_mul(shape[1]) > bytes.len() as u64 {
        return Err(Failure::input(
            path,
            "the file is shorter than its header says",
        ));
    }
    let values = match file.try_data::<f64>() {
        Ok(data) => data.collect::<Result<Vec<f64>, _>>().map_err(parse)?,
        Err(file) => match file.try_data::<f32>() {
            Ok(data) => data
                .map(|v| v.map(f64::from))
                .collect::<Result<Vec<f64>, _>>()
                .map_err(parse)?,
            Err(_) => {
                return Err(Failure::input(
                    path,
                    "expected 32- or 64-bit floating point numbers",
                ));
            }
        },
    };
    let rows = shape[0] as usize;
    let values = match order {
        Order::C => values,
        Order::Fortran => (0..rows * columns)
            .map(|i| values[(i % columns) * rows + i / columns])
            .collect(),
    };
    Ok(Table { columns, values })
}

/// The bytes of an N×columns array.
pub(crate) fn encode(columns: usize, values: &[f64]) -> Result<Vec<u8>, Failure> {
    let fail = |e: std::io::Error| Failure::other(format!("cannot encode .npy: {e}"));
    let mut bytes = Vec::new();
    let mut writer = npyz::WriteOptions::new()
        .default_dtype()
        .shape(&[(values.len() / columns) as u64, columns as u64])
        .writer(&mut bytes)
        .begin_nd()
        .map_err(fail)?;
    writer.extend(values.iter().copied()).map_err(fail)?;
    writer.finish().map_err(fail)?;
    Ok(bytes)
}
