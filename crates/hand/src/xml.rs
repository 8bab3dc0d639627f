//! The elements of an XML text, for checks before urdf-rs reads it.
//!
//! Size, depth and number of elements are limited, and document types (and so entities) are
//! refused. Names keep their prefixes, and namespaces need not be declared: many robot descriptions
//! use undeclared prefixes.

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use thiserror::Error;

/// The largest URDF text accepted, in bytes.
pub const MAX_URDF_BYTES: usize = 4 << 20;
/// The deepest nesting of elements accepted.
pub const MAX_URDF_DEPTH: usize = 64;
/// The largest number of elements accepted.
pub const MAX_URDF_ELEMENTS: usize = 50_000;

/// One element.
#[derive(Clone, Debug, Default)]
pub(crate) struct Element {
    /// Its name with its prefix.
    pub(crate) name: String,
    /// Position of its tag in the text.
    pub(crate) byte: usize,
    /// Names and values in the order of the text.
    pub(crate) attributes: Vec<(String, String)>,
    /// The elements inside it.
    pub(crate) children: Vec<Element>,
    /// Its own text.
    text: String,
}

impl Element {
    /// The value of an attribute.
    pub(crate) fn attribute(&self, name: &str) -> Option<&str> {
        let found = self.attributes.iter().find(|(n, _)| n == name)?;
        Some(found.1.as_str())
    }

    /// The first child of this name.
    pub(crate) fn child(&self, name: &str) -> Option<&Element> {
        self.children.iter().find(|c| c.name == name)
    }

    /// The children of this name.
    pub(crate) fn children_named<'s>(
        &'s self,
        name: &'s str,
    ) -> impl Iterator<Item = &'s Element> + 's {
        self.children.iter().filter(move |c| c.name == name)
    }

    /// Its own text, without that of the elements inside it.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// An attribute, or the text of a child of that name: some files use elements instead.
    pub(crate) fn value(&self, name: &str) -> Option<&str> {
        self.attribute(name)
            .or_else(|| self.child(name).map(|c| c.text.as_str()))
    }
}

/// Why a text was not taken for XML.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum XmlError {
    /// The text is too long.
    #[error("the text has {bytes} bytes, more than {limit}")]
    TooLarge {
        /// Its length.
        bytes: usize,
        /// The limit.
        limit: usize,
    },
    /// Elements nest too deeply.
    #[error("elements nest deeper than {limit} at byte {byte}")]
    TooDeep {
        /// Where.
        byte: usize,
        /// The limit.
        limit: usize,
    },
    /// There are too many elements.
    #[error("{count} elements, more than {limit}")]
    TooMany {
        /// How many.
        count: usize,
        /// The limit.
        limit: usize,
    },
    /// Not well-formed.
    #[error("not XML at byte {byte}: {what}")]
    NotXml {
        /// Where.
        byte: usize,
        /// What is wrong.
        what: String,
    },
    /// A document type (and so possibly entities) is declared.
    #[error(
        "a document type or entity is declared at byte {byte}; robot files need none, so remove it"
    )]
    Doctype {
        /// Where.
        byte: usize,
    },
}

/// How large a text may be.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Bytes.
    pub(crate) bytes: usize,
    /// Elements.
    pub(crate) elements: usize,
}

/// The root element of the text of a URDF.
///
/// One pass over the bytes. Errors name the byte where the text stops being acceptable.
pub(crate) fn urdf_root(text: &str) -> Result<Element, XmlError> {
    let limits = Limits {
        bytes: MAX_URDF_BYTES,
        elements: MAX_URDF_ELEMENTS,
    };
    root_within(text, &limits)
}

/// The root element of any text within the limits; see [`urdf_root`].
pub(crate) fn root_within(text: &str, limits: &Limits) -> Result<Element, XmlError> {
    if text.len() > limits.bytes {
        return Err(XmlError::TooLarge {
            bytes: text.len(),
            limit: limits.bytes,
        });
    }
    // A byte order mark may precede the text.
    let body = text.trim_start_matches('\u{feff}');
    let skipped = text.len() - body.len();
    let place = |position: u64| skipped + usize::try_from(position).unwrap_or(text.len());
    let mut reader = Reader::from_str(body);
    let mut building = Building {
        limit: limits.elements,
        ..Building::default()
    };
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
            Event::DocType(_) => return Err(XmlError::Doctype { byte }),
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
    limit: usize,
}

impl Building {
    fn open(&mut self, element: Element) -> Result<(), XmlError> {
        let byte = element.byte;
        if self.root.is_some() {
            return Err(not_xml(byte, "a second root element"));
        }
        self.open.push(element);
        self.elements += 1;
        if self.open.len() > MAX_URDF_DEPTH {
            return Err(XmlError::TooDeep {
                byte,
                limit: MAX_URDF_DEPTH,
            });
        }
        if self.elements > self.limit {
            return Err(XmlError::TooMany {
                count: self.elements,
                limit: self.limit,
            });
        }
        Ok(())
    }

    fn close(&mut self, byte: usize) -> Result<(), XmlError> {
        let element = self.open.pop();
        let element = element.ok_or_else(|| not_xml(byte, "a closing tag without its opening"))?;
        match self.open.last_mut() {
            Some(parent) => parent.children.push(element),
            None => self.root = Some(element),
        }
        Ok(())
    }

    fn text(&mut self, text: &str, byte: usize) -> Result<(), XmlError> {
        match self.open.last_mut() {
            Some(element) => element.text.push_str(text),
            None if text.trim().is_empty() => {}
            None => return Err(not_xml(byte, OUTSIDE)),
        }
        Ok(())
    }

    fn finish(self, end: usize) -> Result<Element, XmlError> {
        if !self.open.is_empty() {
            return Err(not_xml(end, "the text ends inside an element"));
        }
        self.root
            .ok_or_else(|| not_xml(end, "the text has no element"))
    }
}

fn not_xml(byte: usize, what: impl Into<String>) -> XmlError {
    XmlError::NotXml {
        byte,
        what: what.into(),
    }
}

/// Name and attributes of an opening tag. Entities that XML does not define stay as they are.
fn element(tag: &BytesStart<'_>, byte: usize) -> Result<Element, XmlError> {
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
        let root = urdf_root(text).unwrap();
        assert_eq!((root.name.as_str(), root.attribute("a")), ("r", Some(">")));
        assert_eq!(root.child("b").unwrap().attribute("c"), Some("/"));
        assert_eq!(root.child("x:d").unwrap().value("e"), Some("7 8"));
        assert!(root.child("d").is_none());
    }

    #[test]
    fn entities_of_attributes_are_decoded() {
        let root = urdf_root("<r a='&lt;&#65;&#x42;&amp;' b='&unknown; & b'/>").unwrap();
        assert_eq!(root.attribute("a"), Some("<AB&"));
        assert_eq!(root.attribute("b"), Some("&unknown; & b"));
    }

    #[test]
    fn deep_nesting_is_refused_at_its_byte() {
        let deep = "<a>".repeat(100_000);
        assert!(matches!(
            urdf_root(&deep),
            Err(XmlError::TooDeep { byte: 192, .. })
        ));
    }

    #[test]
    fn document_types_and_broken_markup_are_refused() {
        let bomb = "<!DOCTYPE r [<!ENTITY a \"aaaa\">]><r>&a;</r>";
        assert!(matches!(
            urdf_root(bomb),
            Err(XmlError::Doctype { byte: 0 })
        ));
        for text in [
            "", "a", "<a", "<a <b>", "</a>", "<a>", "<!-- ", "<a b='>", "<a></b>", "<a/><b/>",
            "<a b=c/>", "<a b/>", "< a/>", "x<a/>", "<a/>x",
        ] {
            assert!(
                matches!(urdf_root(text), Err(XmlError::NotXml { .. })),
                "{text}"
            );
        }
    }
}
