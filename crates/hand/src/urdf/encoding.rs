//! The text of a URDF's bytes.

use std::borrow::Cow;

/// The text of a URDF given as bytes: UTF-8, UTF-16 with a byte order mark, or otherwise Latin-1.
///
/// Old files contain Latin-1 letters in comments. Names that are used are repeated in the TOML, so
/// a wrongly decoded letter leads to the error that the name does not exist. Linear in the bytes.
///
/// ```
/// assert_eq!(hand::urdf_text(b"<!-- Gr\xf6\xdfe -->"), "<!-- Größe -->");
/// ```
pub fn urdf_text(bytes: &[u8]) -> Cow<'_, str> {
    let utf16 = |unit: fn([u8; 2]) -> u16| {
        let units = bytes[2..].chunks_exact(2).map(|b| unit([b[0], b[1]]));
        let signs = char::decode_utf16(units);
        Cow::Owned(
            signs
                .map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER))
                .collect(),
        )
    };
    match bytes {
        [0xff, 0xfe, ..] => utf16(u16::from_le_bytes),
        [0xfe, 0xff, ..] => utf16(u16::from_be_bytes),
        _ => match std::str::from_utf8(bytes) {
            Ok(text) => Cow::Borrowed(text),
            Err(_) => Cow::Owned(bytes.iter().map(|&b| char::from(b)).collect()),
        },
    }
}
