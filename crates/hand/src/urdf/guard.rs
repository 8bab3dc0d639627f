//! What a URDF text must satisfy before it reaches the XML reader.
//!
//! The reader recurses once a nested element and the process dies when its stack
//! ends, so depth and size are bounded here, by a tokenizer that is stricter than
//! XML: whatever it does not understand is refused.

use super::UrdfError;

/// The largest URDF text accepted, in bytes.
pub const MAX_URDF_BYTES: usize = 4 << 20;
/// The deepest nesting of elements accepted.
pub const MAX_URDF_DEPTH: usize = 64;
/// The largest number of elements accepted.
pub const MAX_URDF_ELEMENTS: usize = 50_000;

/// Checks size, nesting and the absence of a document type (and so of entities).
///
/// One pass over the bytes. Errors name the byte where the text stops being acceptable.
pub(super) fn check_text(text: &str) -> Result<(), UrdfError> {
    if text.len() > MAX_URDF_BYTES {
        return Err(UrdfError::TooLarge {
            bytes: text.len(),
            limit: MAX_URDF_BYTES,
        });
    }
    let (mut at, mut depth, mut elements) = (0, 0usize, 0usize);
    while let Some(open) = text[at..].find('<').map(|k| k + at) {
        let rest = &text[open..];
        at = open
            + match kind_of(rest) {
                Markup::Comment => skip_to(rest, "-->", open)?,
                Markup::CharacterData => skip_to(rest, "]]>", open)?,
                Markup::Instruction => skip_to(rest, "?>", open)?,
                Markup::Declaration => return Err(UrdfError::Doctype { byte: open }),
                Markup::Close => {
                    depth = depth
                        .checked_sub(1)
                        .ok_or_else(|| not_xml(open, "a closing tag without its opening"))?;
                    skip_to(rest, ">", open)?
                }
                Markup::Open => {
                    let (length, empty) = open_tag(rest, open)?;
                    vectors(&rest[..length], &rest[length..], open)?;
                    elements += 1;
                    depth += usize::from(!empty);
                    length
                }
            };
        if depth > MAX_URDF_DEPTH {
            return Err(UrdfError::TooDeep {
                byte: open,
                limit: MAX_URDF_DEPTH,
            });
        }
        if elements > MAX_URDF_ELEMENTS {
            return Err(UrdfError::TooMany {
                what: "elements",
                count: elements,
                limit: MAX_URDF_ELEMENTS,
            });
        }
    }
    if depth != 0 {
        return Err(not_xml(text.len(), "the text ends inside an element"));
    }
    Ok(())
}

enum Markup {
    Comment,
    CharacterData,
    Instruction,
    Declaration,
    Close,
    Open,
}

fn kind_of(rest: &str) -> Markup {
    if rest.starts_with("<!--") {
        Markup::Comment
    } else if rest.starts_with("<![CDATA[") {
        Markup::CharacterData
    } else if rest.starts_with("<?") {
        Markup::Instruction
    } else if rest.starts_with("<!") {
        Markup::Declaration
    } else if rest.starts_with("</") {
        Markup::Close
    } else {
        Markup::Open
    }
}

fn not_xml(byte: usize, what: &'static str) -> UrdfError {
    UrdfError::NotXml { byte, what }
}

fn skip_to(rest: &str, end: &str, byte: usize) -> Result<usize, UrdfError> {
    rest.find(end)
        .map(|k| k + end.len())
        .ok_or_else(|| not_xml(byte, "markup that never ends"))
}

/// Length of an opening tag and whether it closes itself; `<` inside it is refused.
fn open_tag(rest: &str, byte: usize) -> Result<(usize, bool), UrdfError> {
    let mut quote = None;
    let mut last = b'<';
    for (k, c) in rest.bytes().enumerate().skip(1) {
        match (quote, c) {
            (_, b'<') => return Err(not_xml(byte + k, "'<' inside a tag")),
            (Some(q), _) if c == q => quote = None,
            (Some(_), _) => {}
            (None, b'"' | b'\'') => quote = Some(c),
            (None, b'>') => return Ok((k + 1, last == b'/')),
            (None, _) => {}
        }
        last = c;
    }
    Err(not_xml(byte, "a tag that never ends"))
}

/// Attributes that hold vectors, whatever the element; as elements the reader takes them too.
const VECTORS: [&str; 4] = ["xyz", "rpy", "size", "scale"];

/// Checks that the vectors of a tag, and those in the text of an element of such a name, are
/// numbers: the reader leaves out entries that are none and takes what remains.
fn vectors(tag: &str, text: &str, byte: usize) -> Result<(), UrdfError> {
    let ends = |c: char| c.is_whitespace() || "/>".contains(c);
    let name = tag[1..].split(ends).next().unwrap_or_default();
    let content = text.split('<').next().unwrap_or_default();
    if let Some(&what) = VECTORS.iter().find(|v| **v == name) {
        numbers(content, what, byte)?;
    }
    if !["origin", "axis", "box", "mesh"].contains(&name) {
        return Ok(());
    }
    let mut rest = &tag[1 + name.len()..];
    // Quotes are balanced and hold no '<', or the tag would not have ended.
    while let Some(equals) = rest.find('=') {
        let key = rest[..equals].trim();
        let after = rest[equals + 1..].trim_start();
        let Some(quote) = after.chars().next().filter(|c| "\"'".contains(*c)) else {
            return Err(not_xml(byte, "an attribute without quotes"));
        };
        let Some(end) = after[1..].find(quote) else {
            return Err(not_xml(byte, "an attribute that never ends"));
        };
        if let Some(&what) = VECTORS.iter().find(|v| **v == key) {
            numbers(&after[1..=end], what, byte)?;
        }
        rest = &after[end + 2..];
    }
    Ok(())
}

fn numbers(text: &str, what: &'static str, byte: usize) -> Result<(), UrdfError> {
    let odd = text
        .split_whitespace()
        .find(|word| word.parse::<f64>().is_err());
    odd.map_or(Ok(()), |word| {
        Err(UrdfError::NotANumber {
            byte,
            what,
            word: word.chars().take(40).collect(),
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinary_text_passes() {
        let text = "<?xml version=\"1.0\"?><!-- <a> --><r a='>'><b c=\"/\"/><d></d></r>";
        assert!(check_text(text).is_ok());
    }

    #[test]
    fn deep_nesting_is_refused_at_its_byte() {
        let deep = "<a>".repeat(100_000);
        assert!(matches!(
            check_text(&deep),
            Err(UrdfError::TooDeep { byte: 192, .. })
        ));
    }

    #[test]
    fn document_types_and_broken_markup_are_refused() {
        let bomb = "<!DOCTYPE r [<!ENTITY a \"aaaa\">]><r>&a;</r>";
        assert!(matches!(
            check_text(bomb),
            Err(UrdfError::Doctype { byte: 0 })
        ));
        for text in ["<a", "<a <b>", "</a>", "<a>", "<!-- ", "<a b='>"] {
            assert!(
                matches!(check_text(text), Err(UrdfError::NotXml { .. })),
                "{text}"
            );
        }
    }
}
