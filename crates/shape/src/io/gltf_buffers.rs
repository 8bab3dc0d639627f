//! The bytes behind a glTF document: chunks, buffers and accessors.

use serde_json::Value;

use super::error::LoadError;
use super::format::Format;

/// A document and its buffers.
pub(super) struct Document {
    pub(super) json: Value,
    buffers: Vec<Vec<u8>>,
}

/// The file is damaged or has something that is not read.
pub(super) fn refuse(what: impl Into<String>, expected: &str) -> LoadError {
    LoadError::content(Format::Gltf, what, expected)
}

/// A whole number of an object.
pub(super) fn index(value: &Value, key: &str) -> Option<usize> {
    value[key].as_u64().and_then(|n| usize::try_from(n).ok())
}

/// Parts of the format that are stored otherwise.
const UNREAD: [&str; 2] = ["KHR_draco_mesh_compression", "EXT_meshopt_compression"];

impl Document {
    /// Reads a GLB, or a text whose buffers are inside.
    pub(super) fn read(bytes: &[u8]) -> Result<Self, LoadError> {
        let (text, blob) = if bytes.starts_with(b"glTF") {
            chunks(bytes)?
        } else {
            (bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes), None)
        };
        let json: Value = serde_json::from_slice(text).map_err(|e| {
            let expected = format!("JSON ({e})");
            LoadError::line(Format::Gltf, e.line(), &expected, "other text")
        })?;
        let required = json["extensionsRequired"].as_array();
        let names = required.into_iter().flatten().filter_map(Value::as_str);
        if let Some(name) = names.into_iter().find(|n| UNREAD.contains(n)) {
            return Err(refuse(
                format!("the extension `{name}`"),
                "a file without compression",
            ));
        }
        let list = json["buffers"].as_array().map_or(&[][..], Vec::as_slice);
        let buffers = list.iter().map(|buffer| match buffer["uri"].as_str() {
            None => Ok(blob.unwrap_or_default().to_vec()),
            Some(uri) => data_uri(uri),
        });
        Ok(Self {
            buffers: buffers.collect::<Result<_, _>>()?,
            json,
        })
    }

    /// The numbers of an accessor, `width` of them per entry.
    pub(super) fn numbers(&self, accessor: usize, width: usize) -> Result<Vec<f64>, LoadError> {
        let wrong = || {
            refuse(
                format!("a damaged accessor {accessor}"),
                "numbers that the buffers hold",
            )
        };
        let facts = &self.json["accessors"][accessor];
        let kind = if width == 3 { "VEC3" } else { "SCALAR" };
        if facts["sparse"].is_object() || facts["type"].as_str() != Some(kind) {
            let expected = format!("one of type {kind} that is not sparse");
            return Err(refuse(format!("accessor {accessor}"), &expected));
        }
        let count = index(facts, "count").ok_or_else(wrong)?;
        let component = index(facts, "componentType").ok_or_else(wrong)?;
        let normalized = facts["normalized"].as_bool().unwrap_or(false);
        let size = match component {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            5125 | 5126 => 4,
            _ => return Err(wrong()),
        };
        let view = &self.json["bufferViews"][index(facts, "bufferView").ok_or_else(wrong)?];
        let buffer = index(view, "buffer")
            .and_then(|b| self.buffers.get(b))
            .ok_or_else(wrong)?;
        let offset = |value: &Value| index(value, "byteOffset").unwrap_or(0);
        let stride = index(view, "byteStride").unwrap_or(size * width);
        let start = offset(view).checked_add(offset(facts)).ok_or_else(wrong)?;
        let last = count
            .saturating_sub(1)
            .checked_mul(stride)
            .and_then(|n| n.checked_add(start));
        let end = last.and_then(|n| n.checked_add(size * width));
        // A stride of 0 would make many numbers of few bytes.
        let enough =
            count == 0 || (stride >= size * width && end.is_some_and(|e| e <= buffer.len()));
        if !enough {
            return Err(wrong());
        }
        let entries = (0..count).flat_map(|i| (0..width).map(move |k| (i, k)));
        let number = |(i, k): (usize, usize)| {
            let at = start + i * stride + k * size;
            scalar(&buffer[at..at + size], component, normalized)
        };
        Ok(entries.map(number).collect())
    }
}

fn scalar(bytes: &[u8], component: usize, normalized: bool) -> f64 {
    let word = bytes
        .iter()
        .rev()
        .fold(0_u32, |w, b| w << 8 | u32::from(*b));
    let (value, most) = match component {
        5120 => (f64::from(word as u8 as i8), 127.0),
        5121 => (f64::from(word as u8), 255.0),
        5122 => (f64::from(word as u16 as i16), 32767.0),
        5123 => (f64::from(word as u16), 65535.0),
        5126 => return f64::from(f32::from_bits(word)),
        _ => return f64::from(word),
    };
    if normalized {
        (value / most).max(-1.0)
    } else {
        value
    }
}

/// The text and the binary part of a GLB.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), LoadError> {
    let end = || {
        let found = "the end of the file".to_owned();
        LoadError::byte(Format::Gltf, bytes.len(), "a whole chunk".to_owned(), found)
    };
    let word = |at: usize| {
        let four = bytes.get(at..at + 4).and_then(|b| b.try_into().ok());
        four.map(u32::from_le_bytes).ok_or_else(end)
    };
    let version = word(4)?;
    if version != 2 {
        let found = version.to_string();
        return Err(LoadError::byte(
            Format::Gltf,
            4,
            "version 2".to_owned(),
            found,
        ));
    }
    let chunk = |at: usize| {
        let length = word(at)? as usize;
        let data = bytes.get(at + 8..(at + 8).saturating_add(length));
        data.ok_or_else(end)
    };
    let text = chunk(12)?;
    let next = 20 + text.len();
    let blob = if next + 8 <= bytes.len() {
        Some(chunk(next)?)
    } else {
        None
    };
    Ok((text, blob))
}

/// The bytes of `data:…;base64,…`.
fn data_uri(uri: &str) -> Result<Vec<u8>, LoadError> {
    let expected = "a GLB, or buffers inside of the file";
    let Some((_, text)) = uri
        .split_once(";base64,")
        .filter(|_| uri.starts_with("data:"))
    else {
        let short: String = uri.chars().take(60).collect();
        return Err(refuse(
            format!("its numbers in another file, `{short}`"),
            expected,
        ));
    };
    let (mut out, mut word, mut bits) = (Vec::with_capacity(text.len() / 4 * 3), 0_u32, 0);
    for byte in text.bytes().filter(|b| *b != b'=') {
        let six = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            _ => return Err(refuse("a damaged buffer", "digits of base64")),
        };
        word = word << 6 | u32::from(six);
        bits += 6;
        if bits >= 8 {
            bits -= 8;
            out.push((word >> bits) as u8);
        }
    }
    Ok(out)
}
