//! Archives of NumPy arrays (.npz): a ZIP file with one .npy file per array.

use std::io::Read;

use flate2::read::DeflateDecoder;

use super::array;
use super::error::{LoadError, quoted};
use super::format::Format;
use super::geometry::Raw;

/// Names that programs give to an array of points, the first ones preferred.
const POINTS: [&str; 12] = [
    "points",
    "xyz",
    "pcd",
    "pc",
    "point_cloud",
    "pointcloud",
    "cloud",
    "pts",
    "vertices",
    "verts",
    "coords",
    "arr_0",
];
/// Largest ratio of the unpacked to the packed size of an array.
const MOST_PER_BYTE: usize = 200;
/// Largest number of arrays that are examined if none has a known name.
const MOST_ARRAYS: usize = 100;
const END: u32 = 0x0605_4b50;
const ENTRY: u32 = 0x0201_4b50;
const LOCAL: u32 = 0x0403_4b50;

struct Entry<'a> {
    name: String,
    deflated: bool,
    packed: &'a [u8],
    size: usize,
}

/// Reads the array of points: by its name, or the only one with three columns or more.
pub(super) fn read(bytes: &[u8]) -> Result<Raw, LoadError> {
    let entries = entries(bytes)?;
    if entries.is_empty() {
        return Err(LoadError::Foreign {
            kind: "a ZIP archive without arrays of NumPy",
            advice: "unpack it first",
        });
    }
    let named = |name: &&str| {
        let is_it = |e: &&Entry| e.name.eq_ignore_ascii_case(name);
        entries.iter().find(is_it)
    };
    if let Some(entry) = POINTS.iter().find_map(named) {
        return array::read(&unpacked(entry)?);
    }
    let arrays = entries
        .iter()
        .take(MOST_ARRAYS)
        .filter_map(|e| array::read(&unpacked(e).ok()?).ok());
    let mut arrays: Vec<Raw> = arrays.take(2).collect();
    match (arrays.pop(), arrays.pop()) {
        (Some(one), None) => Ok(one),
        _ => {
            let names: Vec<&str> = entries.iter().map(|e| e.name.as_str()).take(20).collect();
            let what = format!("the arrays {}", quoted(&names.join("`, `")));
            let expected = "one array of shape (N, 3), or one that is named `points`";
            Err(LoadError::content(Format::Npz, what, expected))
        }
    }
}

fn unpacked(entry: &Entry) -> Result<Vec<u8>, LoadError> {
    if !entry.deflated {
        return Ok(entry.packed.to_vec());
    }
    let most = entry.packed.len().saturating_mul(MOST_PER_BYTE);
    let limit = entry.size.min(most) as u64;
    let mut array = Vec::new();
    let read = DeflateDecoder::new(entry.packed)
        .take(limit)
        .read_to_end(&mut array);
    if read.is_ok() && array.len() == entry.size {
        return Ok(array);
    }
    let what = format!("a damaged array `{}`", entry.name);
    let expected = "deflated bytes of the size that is stated";
    Err(LoadError::content(Format::Npz, what, expected))
}

fn number(bytes: &[u8], at: usize, width: usize) -> Option<usize> {
    let part = bytes.get(at..at.checked_add(width)?)?;
    Some(
        part.iter()
            .rev()
            .fold(0, |sum, b| sum << 8 | usize::from(*b)),
    )
}

/// The directory at the end of the archive.
fn entries(bytes: &[u8]) -> Result<Vec<Entry<'_>>, LoadError> {
    const EXPECTED: &str = "the directory of a ZIP archive";
    let end = || {
        let found = "the end of the file".to_owned();
        LoadError::byte(Format::Npz, bytes.len(), EXPECTED.to_owned(), found)
    };
    // The record at the end has 22 bytes and a comment.
    let from = bytes.len().saturating_sub(22 + 0xffff);
    let records = (from..bytes.len().saturating_sub(21)).rev();
    let record = records
        .into_iter()
        .find(|at| number(bytes, *at, 4) == Some(END as usize))
        .ok_or_else(end)?;
    let count = number(bytes, record + 10, 2).ok_or_else(end)?;
    let mut at = number(bytes, record + 16, 4).ok_or_else(end)?;
    let mut entries = Vec::new();
    for _ in 0..count {
        let (entry, next) = entry(bytes, at).ok_or_else(|| {
            LoadError::byte(
                Format::Npz,
                at,
                EXPECTED.to_owned(),
                "other bytes".to_owned(),
            )
        })?;
        entries.extend(entry);
        at = next;
    }
    Ok(entries)
}

/// An entry of the directory if it is an array, and where the next one stands.
fn entry(bytes: &[u8], at: usize) -> Option<(Option<Entry<'_>>, usize)> {
    if number(bytes, at, 4)? != ENTRY as usize {
        return None;
    }
    let (method, packed) = (number(bytes, at + 10, 2)?, number(bytes, at + 20, 4)?);
    let (size, local) = (number(bytes, at + 24, 4)?, number(bytes, at + 42, 4)?);
    let length = number(bytes, at + 28, 2)?;
    let next = at + 46 + length + number(bytes, at + 30, 2)? + number(bytes, at + 32, 2)?;
    let name = String::from_utf8_lossy(bytes.get(at + 46..at + 46 + length)?).into_owned();
    if number(bytes, local, 4)? != LOCAL as usize {
        return None;
    }
    let start = local + 30 + number(bytes, local + 26, 2)? + number(bytes, local + 28, 2)?;
    let array = name
        .strip_suffix(".npy")
        .filter(|_| matches!(method, 0 | 8));
    let entry = match array {
        None => None,
        Some(array) => Some(Entry {
            name: array.to_owned(),
            deflated: method == 8,
            packed: bytes.get(start..start.checked_add(packed)?)?,
            size,
        }),
    };
    Some((entry, next))
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::DeflateEncoder;

    use super::*;

    fn deflated(content: &[u8]) -> Vec<u8> {
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(content).unwrap();
        encoder.finish().unwrap()
    }

    fn archive(files: &[(&str, Vec<u8>)]) -> Vec<u8> {
        let (mut bytes, mut directory) = (Vec::new(), Vec::new());
        for (index, (name, content)) in files.iter().enumerate() {
            // The second file is deflated.
            let packed = match index {
                1 => deflated(content),
                _ => content.clone(),
            };
            let local = bytes.len() as u32;
            let mut common = vec![20, 0, 0, 0, if index == 1 { 8 } else { 0 }, 0];
            common.extend([0; 8]);
            common.extend((packed.len() as u32).to_le_bytes());
            common.extend((content.len() as u32).to_le_bytes());
            common.extend((name.len() as u16).to_le_bytes());
            common.extend([0, 0]);
            bytes.extend(LOCAL.to_le_bytes());
            bytes.extend(&common);
            bytes.extend(name.bytes());
            bytes.extend(&packed);
            directory.extend(ENTRY.to_le_bytes());
            directory.extend([20, 0]);
            directory.extend(&common);
            directory.extend([0; 10]);
            directory.extend(local.to_le_bytes());
            directory.extend(name.bytes());
        }
        let start = bytes.len() as u32;
        bytes.extend(&directory);
        bytes.extend(END.to_le_bytes());
        bytes.extend([0, 0, 0, 0, files.len() as u8, 0, files.len() as u8, 0]);
        bytes.extend((directory.len() as u32).to_le_bytes());
        bytes.extend(start.to_le_bytes());
        bytes.extend([0, 0]);
        bytes
    }

    #[test]
    fn the_array_of_points_is_found() {
        let points = |k: u8| array::tests::npy("'|u1'", "(2, 3)", "False", &[k, 0, 0, 0, k, 0]);
        let labels = array::tests::npy("'|u1'", "(2,)", "False", &[1, 2]);
        for files in [
            vec![("other.npy", points(1)), ("points.npy", points(7))],
            vec![("label.npy", labels.clone()), ("data.npy", points(7))],
        ] {
            assert_eq!(read(&archive(&files)).unwrap().vertices[0].x, 7.0);
        }
        let two = archive(&[("a.npy", points(1)), ("b.npy", points(2))]);
        let error = read(&two).err().unwrap().to_string();
        assert!(error.contains("`a`, `b`"), "{error}");
        assert!(read(&two[..two.len() - 30]).is_err());
        assert!(read(&archive(&[("label.npy", labels)])).is_err());
    }
}
