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
