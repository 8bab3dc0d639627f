//! Named arrays in one archive, as `numpy.load` reads it.

/// A named array of an archive, in C order.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// Its name, the key in NumPy.
    pub name: String,
    /// The lengths of its axes.
    pub shape: Vec<usize>,
    /// Its entries.
    pub entries: Entries,
}

/// The entries of an array.
#[derive(Clone, Debug, PartialEq)]
pub enum Entries {
    /// Floats of 64 bits.
    Floats(Vec<f64>),
    /// Words; NumPy stores all of them as long as the longest.
    Words(Vec<String>),
}

/// The bytes of an archive (ZIP, stored without compression, always the same for the same arrays);
/// `None` where an array does not have as many entries as its shape says, or is too large.
///
/// ```
/// use run::npz::{Array, Entries, to_npz};
///
/// let array = Array {
///     name: "q".to_owned(),
///     shape: vec![2],
///     entries: Entries::Floats(vec![0.5, 1.0]),
/// };
/// assert!(to_npz(&[array.clone()]).unwrap().starts_with(b"PK"));
/// assert!(to_npz(&[Array { shape: vec![3], ..array }]).is_none());
/// ```
pub fn to_npz(arrays: &[Array]) -> Option<Vec<u8>> {
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    for array in arrays {
        let name = format!("{}.npy", array.name);
        let content = npy(array)?;
        let size = u32::try_from(content.len()).ok()?;
        let offset = u32::try_from(bytes.len()).ok()?;
        let length = u16::try_from(name.len()).ok()?;
        // Version, flags, method, time and date (1 January 1980), checksum, both sizes.
        let mut facts = Vec::new();
        for half in [20u16, 0x800, 0, 0, 0x21] {
            facts.extend(half.to_le_bytes());
        }
        for word in [crc32(&content), size, size] {
            facts.extend(word.to_le_bytes());
        }
        facts.extend(length.to_le_bytes());
        facts.extend(0u16.to_le_bytes());
        bytes.extend(b"PK\x03\x04");
        bytes.extend(&facts);
        bytes.extend(name.as_bytes());
        bytes.extend(&content);
        directory.extend(b"PK\x01\x02");
        directory.extend(20u16.to_le_bytes());
        directory.extend(&facts);
        // Comment, disk, attributes of two kinds.
        directory.extend([0u8; 10]);
        directory.extend(offset.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let count = u16::try_from(arrays.len()).ok()?;
    let start = u32::try_from(bytes.len()).ok()?;
    let length = u32::try_from(directory.len()).ok()?;
    bytes.extend(directory);
    bytes.extend(b"PK\x05\x06\0\0\0\0");
    bytes.extend(count.to_le_bytes());
    bytes.extend(count.to_le_bytes());
    bytes.extend(length.to_le_bytes());
    bytes.extend(start.to_le_bytes());
    bytes.extend(0u16.to_le_bytes());
    Some(bytes)
}

fn npy(array: &Array) -> Option<Vec<u8>> {
    let count: usize = array.shape.iter().product();
    let (kind, content) = match &array.entries {
        Entries::Floats(values) if values.len() == count => {
            let bytes = values.iter().flat_map(|v| v.to_le_bytes());
            ("<f8".to_owned(), bytes.collect::<Vec<u8>>())
        }
        Entries::Words(words) if words.len() == count => {
            let longest = words.iter().map(|w| w.chars().count()).max();
            let width = longest.unwrap_or(0).max(1);
            let padded = words
                .iter()
                .flat_map(|w| w.chars().chain(std::iter::repeat('\0')).take(width));
            let bytes = padded.flat_map(|c| u32::from(c).to_le_bytes());
            (format!("<U{width}"), bytes.collect())
        }
        _ => return None,
    };
    let axes: Vec<String> = array.shape.iter().map(|n| format!("{n},")).collect();
    let mut header = format!(
        "{{'descr': '{kind}', 'fortran_order': False, 'shape': ({}), }}",
        axes.join(" ")
    );
    // Mark, version and length take ten bytes; the whole is a multiple of 64.
    let short = (64 - (10 + header.len() + 1) % 64) % 64;
    header.extend(std::iter::repeat_n(' ', short));
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(header.len()).ok()?.to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(content);
    Some(bytes)
}

/// The checksum of ZIP files.
fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32, byte: &u8| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            let shifted = crc >> 1;
            if crc & 1 == 1 {
                shifted ^ 0xEDB8_8320
            } else {
                shifted
            }
        })
    };
    !bytes.iter().fold(!0, step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_that_of_zip() {
        assert_eq!(crc32(b"123456789"), 0xCBF4_3926);
        assert_eq!(crc32(b""), 0);
    }

    #[test]
    fn headers_are_those_of_numpy() {
        let words = Array {
            name: "names".to_owned(),
            shape: vec![2],
            entries: Entries::Words(vec!["ab".to_owned(), "é".to_owned()]),
        };
        let bytes = npy(&words).unwrap();
        let text = String::from_utf8_lossy(&bytes[10..128]).into_owned();
        assert!(text.starts_with("{'descr': '<U2', 'fortran_order': False, 'shape': (2,), }"));
        assert_eq!(bytes[127], b'\n');
        let letters = bytes[128..].chunks_exact(4);
        let letters: Vec<u32> = letters
            .map(|c| u32::from_le_bytes([c[0], c[1], c[2], c[3]]))
            .collect();
        assert_eq!(letters, [97, 98, 0xE9, 0]);
    }
}
