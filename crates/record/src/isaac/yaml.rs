//! YAML text as a tree whose nodes know their lines. Aliases and deep nesting are refused.

use yaml_rust2::parser::{Event, Parser};

use super::error::IsaacError;

/// Deepest nesting that is read; the format needs four levels.
const DEEPEST: usize = 16;

/// A node and the line where it begins, from 1.
pub(super) struct Node {
    pub(super) line: usize,
    pub(super) value: Value,
}

pub(super) enum Value {
    Scalar(String),
    List(Vec<Node>),
    Map(Vec<(String, Node)>),
}

/// An open list or map.
struct Open {
    line: usize,
    is_map: bool,
    children: Vec<Node>,
}

impl Open {
    fn close(self) -> Result<Node, IsaacError> {
        let line = self.line;
        if !self.is_map {
            let value = Value::List(self.children);
            return Ok(Node { line, value });
        }
        let mut pairs = Vec::with_capacity(self.children.len() / 2);
        let mut children = self.children.into_iter();
        while let (Some(key), Some(value)) = (children.next(), children.next()) {
            let Value::Scalar(name) = key.value else {
                return Err(IsaacError::yaml(key.line, "a key is not a plain word"));
            };
            if pairs.iter().any(|(known, _)| *known == name) {
                let what = format!("the key `{name}` is given twice");
                return Err(IsaacError::yaml(key.line, what));
            }
            pairs.push((name, value));
        }
        let value = Value::Map(pairs);
        Ok(Node { line, value })
    }
}

/// The first document of a text.
pub(super) fn parse(text: &str) -> Result<Node, IsaacError> {
    let mut parser = Parser::new_from_str(text);
    let mut open: Vec<Open> = Vec::new();
    loop {
        let (event, mark) = parser
            .next_token()
            .map_err(|e| IsaacError::yaml(e.marker().line(), e.info()))?;
        let line = mark.line();
        let done = match event {
            Event::Alias(_) => {
                return Err(IsaacError::yaml(line, "aliases (`*name`) are not read"));
            }
            Event::SequenceStart(..) | Event::MappingStart(..) => {
                if open.len() == DEEPEST {
                    let what = format!("nested deeper than {DEEPEST} levels");
                    return Err(IsaacError::yaml(line, what));
                }
                open.push(Open {
                    line,
                    is_map: matches!(event, Event::MappingStart(..)),
                    children: Vec::new(),
                });
                continue;
            }
            Event::Scalar(word, ..) => Node {
                line,
                value: Value::Scalar(word),
            },
            Event::SequenceEnd | Event::MappingEnd => match open.pop() {
                Some(node) => node.close()?,
                None => continue,
            },
            Event::StreamEnd | Event::DocumentEnd => {
                return Err(IsaacError::yaml(line, "the document is empty"));
            }
            _ => continue,
        };
        match open.last_mut() {
            Some(parent) => parent.children.push(done),
            None => return Ok(done),
        }
    }
}
