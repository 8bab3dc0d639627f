//! The elements of an XML text: as much of XML as a URDF needs, and nothing that can run away.
//!
//! Stricter than XML in size, depth and number of elements, and in document types (and so entities),
//! which are refused. Names keep their prefixes, and namespaces need not be declared: descriptions of
//! robots are full of prefixes that nothing declares.

use std::borrow::Cow;

use super::UrdfError;

/// The largest URDF text accepted, in bytes.
pub const MAX_URDF_BYTES: usize = 4 << 20;
/// The deepest nesting of elements accepted.
pub const MAX_URDF_DEPTH: usize = 64;
/// The largest number of elements accepted.
pub const MAX_URDF_ELEMENTS: usize = 50_000;

/// One element.
#[derive(Clone, Debug, Default)]
pub(super) struct Element<'a> {
    /// Its name with its prefix.
    pub(super) name: &'a str,
    /// Where its tag begins.
    pub(super) byte: usize,
    /// Names and values in the order of the text.
    pub(super) attributes: Vec<(&'a str, Cow<'a, str>)>,
    /// The elements inside it.
    pub(super) children: Vec<Element<'a>>,
    /// Its text before the first child.
    text: &'a str,
}

impl<'a> Element<'a> {
    /// The value of an attribute.
    pub(super) fn attribute(&self, name: &str) -> Option<&str> {
        let found = self.attributes.iter().find(|(n, _)| *n == name)?;
        Some(found.1.as_ref())
    }

    /// The first child of this name.
    pub(super) fn child(&self, name: &str) -> Option<&Element<'a>> {
        self.children.iter().find(|c| c.name == name)
    }

    /// The children of this name.
    pub(super) fn children_named<'s>(
        &'s self,
        name: &'s str,
    ) -> impl Iterator<Item = &'s Element<'a>> + 's {
        self.children.iter().filter(move |c| c.name == name)
    }

    /// An attribute, or the text of a child of that name: some writers use elements.
    pub(super) fn value(&self, name: &str) -> Option<&str> {
        self.attribute(name)
            .or_else(|| self.child(name).map(|c| c.text))
    }
}

/// The root element of a text.
///
/// One pass over the bytes. Errors name the byte where the text stops being acceptable.
pub(super) fn root(text: &str) -> Result<Element<'_>, UrdfError> {
    if text.len() > MAX_URDF_BYTES {
        return Err(UrdfError::TooLarge {
            bytes: text.len(),
            limit: MAX_URDF_BYTES,
        });
    }
    let mut open: Vec<Element<'_>> = Vec::new();
    let mut done: Option<Element<'_>> = None;
    let (mut at, mut elements) = (0, 0usize);
    while let Some(byte) = text[at..].find('<').map(|k| k + at) {
        if open.is_empty() && !is_blank(&text[at..byte]) {
            return Err(not_xml(at, "text outside the root element"));
        }
        let rest = &text[byte..];
        let length = match kind_of(rest) {
            Markup::Comment => skip_to(rest, "-->", byte)?,
            Markup::CharacterData => skip_to(rest, "]]>", byte)?,
            Markup::Instruction => skip_to(rest, "?>", byte)?,
            Markup::Declaration => return Err(UrdfError::Doctype { byte }),
            Markup::Close => {
                let length = skip_to(rest, ">", byte)?;
                let element = open
                    .pop()
                    .filter(|e| e.name == rest[2..length - 1].trim())
                    .ok_or_else(|| not_xml(byte, "a closing tag without its opening"))?;
                settle(element, &mut open, &mut done)?;
                length
            }
            Markup::Open => {
                let (length, empty) = open_tag(rest, byte)?;
                let mut element = element(&rest[..length], byte)?;
                elements += 1;
                element.text = rest[length..].split('<').next().unwrap_or_default();
                if empty {
                    settle(element, &mut open, &mut done)?;
                } else {
                    open.push(element);
                }
                length
            }
        };
        at = byte + length;
        check_size(open.len(), elements, byte)?;
    }
    if !open.is_empty() {
        return Err(not_xml(text.len(), "the text ends inside an element"));
    }
    if !is_blank(&text[at..]) {
        return Err(not_xml(at, "text outside the root element"));
    }
    done.ok_or_else(|| not_xml(text.len(), "the text has no element"))
}

/// A mark of the byte order may stand before the text.
fn is_blank(text: &str) -> bool {
    text.trim_start_matches('\u{feff}').trim().is_empty()
}

fn check_size(depth: usize, elements: usize, byte: usize) -> Result<(), UrdfError> {
    if depth > MAX_URDF_DEPTH {
        return Err(UrdfError::TooDeep {
            byte,
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
    Ok(())
}

/// A finished element goes into the one that is open, or is the root.
fn settle<'a>(
    element: Element<'a>,
    open: &mut [Element<'a>],
    done: &mut Option<Element<'a>>,
) -> Result<(), UrdfError> {
    let byte = element.byte;
    match open.last_mut() {
        Some(parent) => parent.children.push(element),
        None if done.is_some() => return Err(not_xml(byte, "a second root element")),
        None => *done = Some(element),
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

/// Name and attributes of an opening tag, which ends in `>` and whose quotes are balanced.
fn element(tag: &str, byte: usize) -> Result<Element<'_>, UrdfError> {
    let inside = tag[1..tag.len() - 1].trim_end_matches('/');
    let name = inside
        .split(|c: char| c.is_whitespace())
        .next()
        .unwrap_or_default();
    if name.is_empty() {
        return Err(not_xml(byte, "a tag without a name"));
    }
    let mut attributes = Vec::new();
    let mut rest = inside[name.len()..].trim_start();
    while !rest.is_empty() {
        let (key, after) = rest
            .split_once('=')
            .ok_or_else(|| not_xml(byte, "an attribute without a value"))?;
        let after = after.trim_start();
        let quote = after
            .chars()
            .next()
            .filter(|c| "\"'".contains(*c))
            .ok_or_else(|| not_xml(byte, "an attribute without quotes"))?;
        let (value, after) = after[1..]
            .split_once(quote)
            .ok_or_else(|| not_xml(byte, "an attribute that never ends"))?;
        attributes.push((key.trim(), decoded(value)));
        rest = after.trim_start();
    }
    Ok(Element {
        name,
        byte,
        attributes,
        ..Element::default()
    })
}

/// A value with the five predefined entities and character references put in; others stay as they are.
fn decoded(value: &str) -> Cow<'_, str> {
    if !value.contains('&') {
        return Cow::Borrowed(value);
    }
    let mut out = String::with_capacity(value.len());
    let mut rest = value;
    while let Some(start) = rest.find('&') {
        out.push_str(&rest[..start]);
        rest = &rest[start..];
        let known = rest
            .find(';')
            .and_then(|end| Some((end, character(&rest[1..end])?)));
        let (length, sign) = known.map_or((1, '&'), |(end, sign)| (end + 1, sign));
        out.push(sign);
        rest = &rest[length..];
    }
    out.push_str(rest);
    Cow::Owned(out)
}

fn character(entity: &str) -> Option<char> {
    match entity {
        "lt" => Some('<'),
        "gt" => Some('>'),
        "amp" => Some('&'),
        "quot" => Some('"'),
        "apos" => Some('\''),
        _ => {
            let code = entity.strip_prefix('#')?;
            let code = match code.strip_prefix('x') {
                Some(hexadecimal) => u32::from_str_radix(hexadecimal, 16).ok()?,
                None => code.parse().ok()?,
            };
            char::from_u32(code)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinary_text_passes() {
        let text = "\u{feff}<?xml version=\"1.0\"?><!-- <a> --><r a='>'>\n<b c=\"/\"/><x:d ><e>7 8<f/></e></x:d\n></r> ";
        let root = root(text).unwrap();
        assert_eq!((root.name, root.attribute("a")), ("r", Some(">")));
        assert_eq!(root.child("b").unwrap().attribute("c"), Some("/"));
        assert_eq!(root.child("x:d").unwrap().value("e"), Some("7 8"));
        assert!(root.child("d").is_none());
    }

    #[test]
    fn entities_of_attributes_are_decoded() {
        let root = root("<r a='&lt;&#65;&#x42;&amp;&unknown; & b'/>").unwrap();
        assert_eq!(root.attribute("a"), Some("<AB&&unknown; & b"));
    }

    #[test]
    fn deep_nesting_is_refused_at_its_byte() {
        let deep = "<a>".repeat(100_000);
        assert!(matches!(
            root(&deep),
            Err(UrdfError::TooDeep { byte: 192, .. })
        ));
    }

    #[test]
    fn document_types_and_broken_markup_are_refused() {
        let bomb = "<!DOCTYPE r [<!ENTITY a \"aaaa\">]><r>&a;</r>";
        assert!(matches!(root(bomb), Err(UrdfError::Doctype { byte: 0 })));
        for text in [
            "", "a", "<a", "<a <b>", "</a>", "<a>", "<!-- ", "<a b='>", "<a></b>", "<a/><b/>",
            "<a b=c/>", "<a b/>", "< a/>", "x<a/>", "<a/>x",
        ] {
            assert!(
                matches!(root(text), Err(UrdfError::NotXml { .. })),
                "{text}"
            );
        }
    }
}
