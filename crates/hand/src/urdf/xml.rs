//! The elements of an XML text, for checks before urdf-rs reads it.
//!
//! Size, depth and number of elements are limited, and document types (and so entities) are
//! refused. Names keep their prefixes, and namespaces need not be declared: many robot descriptions
//! use undeclared prefixes.

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use super::UrdfError;

/// The largest URDF text accepted, in bytes.
pub const MAX_URDF_BYTES: usize = 4 << 20;
/// The deepest nesting of elements accepted.
pub const MAX_URDF_DEPTH: usize = 64;
/// The largest number of elements accepted.
pub const MAX_URDF_ELEMENTS: usize = 50_000;

/// One element.
#[derive(Clone, Debug, Default)]
pub(super) struct Element {
    /// Its name with its prefix.
    pub(super) name: String,
    /// Position of its tag in the text.
    pub(super) byte: usize,
    /// Names and values in the order of the text.
    pub(super) attributes: Vec<(String, String)>,
    /// The elements inside it.
    pub(super) children: Vec<Element>,
    /// Its own text.
    text: String,
}

impl Element {
    /// The value of an attribute.
    pub(super) fn attribute(&self, name: &str) -> Option<&str> {
        let found = self.attributes.iter().find(|(n, _)| n == name)?;
        Some(found.1.as_str())
    }

    /// The first child of this name.
    pub(super) fn child(&self, name: &str) -> Option<&Element> {
        self.children.iter().find(|c| c.name == name)
    }

    /// The children of this name.
    pub(super) fn children_named<'s>(
        &'s self,
        name: &'s str,
    ) -> impl Iterator<Item = &'s Element> + 's {
        self.children.iter().filter(move |c| c.name == name)
    }

    /// An attribute, or the text of a child of that name: some files use elements instead.
    pub(super) fn value(&self, name: &str) -> Option<&str> {
        self.attribute(name)
            .or_else(|| self.child(name).map(|c| c.text.as_str()))
    }
}

/// The root element of a text.
///
/// One pass over the bytes. Errors name the line and column at which the text is refused.
pub(super) fn root(text: &str) -> Result<Element, UrdfError> {
    if text.len() > MAX_URDF_BYTES {
        return Err(UrdfError::TooLarge {
            bytes: text.len(),
            limit: MAX_URDF_BYTES,
        });
    }
    // A byte order mark may precede the text.
    let body = text.trim_start_matches('\u{feff}');
    let skipped = text.len() - body.len();
    let place = |position: u64| skipped + usize::try_from(position).unwrap_or(text.len());
    let mut reader = Reader::from_str(body);
    let mut building = Building::default();
    loop {
        let byte = place(reader.buffer_position());
        let event = reader
            .read_event()
            .map_err(|e| not_xml(place(reader.error_position()), e.to_string()))?;
        match event {
            Event::Start(tag) => building.open(element(&tag, byte)?)?,
            Event::Empty(tag) => {
                building.open(element(&tag, byte)?)?;
                building.close(byte)?;
            }
            Event::End(_) => building.close(byte)?,
            Event::Text(text) => {
                let text = text.decode().map_err(|e| not_xml(byte, e.to_string()))?;
                building.text(&text, byte)?;
            }
            Event::DocType(_) => return Err(UrdfError::Doctype { byte }),
            Event::GeneralRef(_) if building.open.is_empty() => {
                return Err(not_xml(byte, OUTSIDE));
            }
            Event::CData(_)
            | Event::Comment(_)
            | Event::Decl(_)
            | Event::PI(_)
            | Event::GeneralRef(_) => {}
            Event::Eof => return building.finish(text.len()),
        }
    }
}

const OUTSIDE: &str = "text outside the root element";

/// The open elements, and the root element after it is closed.
#[derive(Default)]
struct Building {
    open: Vec<Element>,
    root: Option<Element>,
    elements: usize,
}

impl Building {
    fn open(&mut self, element: Element) -> Result<(), UrdfError> {
        let byte = element.byte;
        if self.root.is_some() {
            return Err(not_xml(byte, "a second root element"));
        }
        self.open.push(element);
        self.elements += 1;
        if self.open.len() > MAX_URDF_DEPTH {
            return Err(UrdfError::TooDeep {
                byte,
                limit: MAX_URDF_DEPTH,
            });
        }
        if self.elements > MAX_URDF_ELEMENTS {
            return Err(UrdfError::TooMany {
                what: "elements",
                count: self.elements,
                limit: MAX_URDF_ELEMENTS,
            });
        }
        Ok(())
    }

    fn close(&mut self, byte: usize) -> Result<(), UrdfError> {
        let element = self.open.pop();
        let element = element.ok_or_else(|| not_xml(byte, "a closing tag without its opening"))?;
        match self.open.last_mut() {
            Some(parent) => parent.children.push(element),
            None => self.root = Some(element),
        }
        Ok(())
    }

    fn text(&mut self, text: &str, byte: usize) -> Result<(), UrdfError> {
        match self.open.last_mut() {
            Some(element) => element.text.push_str(text),
            None if text.trim().is_empty() => {}
            None => return Err(not_xml(byte, OUTSIDE)),
        }
        Ok(())
    }

    fn finish(self, end: usize) -> Result<Element, UrdfError> {
        if !self.open.is_empty() {
            return Err(not_xml(end, "the text ends inside an element"));
        }
        self.root
            .ok_or_else(|| not_xml(end, "the text has no element"))
    }
}

fn not_xml(byte: usize, what: impl Into<String>) -> UrdfError {
    UrdfError::NotXml {
        byte,
        what: what.into(),
    }
}

/// Name and attributes of an opening tag. Entities that XML does not predefine are kept unchanged.
fn element(tag: &BytesStart<'_>, byte: usize) -> Result<Element, UrdfError> {
    let word = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let name = word(tag.name().as_ref());
    if name.is_empty() || name.starts_with(char::is_whitespace) {
        return Err(not_xml(byte, "a tag without a name"));
    }
    let mut attributes = Vec::new();
    for attribute in tag.attributes().with_checks(false) {
        let attribute = attribute.map_err(|e| not_xml(byte, e.to_string()))?;
        let raw = word(&attribute.value);
        let value = quick_xml::escape::unescape(&raw).map_or_else(|_| raw.clone(), Into::into);
        attributes.push((word(attribute.key.as_ref()), value));
    }
    Ok(Element {
        name,
        byte,
        attributes,
        ..Element::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinary_text_passes() {
        let text = "\u{feff}<?xml version=\"1.0\"?><!-- <a> --><r a='>'>\n<b c=\"/\"/><x:d ><e>7 8<f/></e></x:d\n></r> ";
        let root = root(text).unwrap();
        assert_eq!((root.name.as_str(), root.attribute("a")), ("r", Some(">")));
        assert_eq!(root.child("b").unwrap().attribute("c"), Some("/"));
        assert_eq!(root.child("x:d").unwrap().value("e"), Some("7 8"));
        assert!(root.child("d").is_none());
    }

    #[test]
    fn entities_of_attributes_are_decoded() {
        let root = root("<r a='&lt;&#65;&#x42;&amp;' b='&unknown; & b'/>").unwrap();
        assert_eq!(root.attribute("a"), Some("<AB&"));
        assert_eq!(root.attribute("b"), Some("&unknown; & b"));
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
