//! The paths that a Rust file names in `use` items and in its code.

/// A path as written, and whether its last name is imported by a `pub use`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Import {
    pub(crate) path: Vec<String>,
    /// The name under which a re-export makes the item visible.
    pub(crate) reexported_as: Option<String>,
}

/// Every path of a `use` item, and every other path that starts with `crate` or `super`.
pub(crate) fn imports(text: &str) -> Vec<Import> {
    let code = without_comments(text);
    let mut found = Vec::new();
    let mut rest = code.as_str();
    let mut other = String::new();
    while let Some((before, public, tree, after)) = next_use(rest) {
        other.push_str(before);
        let mut paths = Vec::new();
        expand(&[], tree.trim(), &mut paths);
        for (path, name) in paths {
            let reexported_as = public.then_some(name);
            found.push(Import {
                path,
                reexported_as,
            });
        }
        rest = after;
    }
    other.push_str(rest);
    found.extend(paths_in_code(&other));
    found.sort();
    found.dedup();
    found
}

/// Text before a `use` item, whether it is public, its tree, and the text after it.
fn next_use(text: &str) -> Option<(&str, bool, &str, &str)> {
    let mut from = 0;
    loop {
        let at = from + text[from..].find("use ")?;
        let line = text[..at].rfind('\n').map_or(0, |n| n + 1);
        let before = text[line..at].trim();
        if matches!(before, "" | "pub" | "pub(crate)" | "pub(super)") {
            let tree = &text[at + 4..];
            let end = tree.find(';')?;
            return Some((
                &text[..line],
                !before.is_empty(),
                &tree[..end],
                &tree[end + 1..],
            ));
        }
        from = at + 4;
    }
}

fn expand(prefix: &[String], tree: &str, out: &mut Vec<(Vec<String>, String)>) {
    if let Some(open) = tree.find('{') {
        let mut inner: Vec<String> = prefix.to_vec();
        inner.extend(names(tree[..open].trim_end_matches(':')));
        let body = &tree[open + 1..tree.rfind('}').unwrap_or(tree.len())];
        for part in split_top(body) {
            expand(&inner, part.trim(), out);
        }
        return;
    }
    let (path, alias) = match tree.split_once(" as ") {
        Some((path, alias)) => (path, Some(alias.trim().to_owned())),
        None => (tree, None),
    };
    let mut whole: Vec<String> = prefix.to_vec();
    whole.extend(names(path));
    if whole.last().is_some_and(|last| last == "self") {
        whole.pop();
    }
    if let Some(last) = whole.last().cloned() {
        out.push((whole, alias.unwrap_or(last)));
    }
}

fn names(path: &str) -> Vec<String> {
    path.split("::")
        .map(|name| name.trim().to_owned())
        .filter(|name| !name.is_empty())
        .collect()
}

/// The top-level parts of a list in braces.
fn split_top(body: &str) -> Vec<&str> {
    let (mut depth, mut start, mut parts) = (0_i32, 0, Vec::new());
    for (at, c) in body.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&body[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&body[start..]);
    parts.retain(|part| !part.trim().is_empty());
    parts
}

fn paths_in_code(code: &str) -> Vec<Import> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let mut found = Vec::new();
    for start in ["crate::", "super::"] {
        for (at, _) in code.match_indices(start) {
            let joined = code[..at].ends_with("::") || code[..at].ends_with(is_name);
            if joined {
                continue;
            }
            let end = code[at..]
                .find(|c: char| !is_name(c) && c != ':')
                .map_or(code.len(), |n| at + n);
            found.push(Import {
                path: names(&code[at..end]),
                reexported_as: None,
            });
        }
    }
    found
}

/// The text without comments and with the contents of string literals blanked.
fn without_comments(text: &str) -> String {
    text.lines()
        .map(|line| line.split("//").next().unwrap_or(""))
        .collect::<Vec<_>>()
        .join("\n")
}

#[test]
fn use_trees_are_expanded() {
    let text = "use std::fmt; // use crate::no;\npub(crate) use child::{self, A as B};\nuse super::{\n    x::{Y, Z},\n    w,\n};\nfn f() -> crate::g::H { super::super::k() }\n";
    let found = imports(text);
    let plain: Vec<String> = found.iter().map(|i| i.path.join("::")).collect();
    let expected = [
        "child",
        "child::A",
        "crate::g::H",
        "std::fmt",
        "super::super::k",
        "super::w",
        "super::x::Y",
        "super::x::Z",
    ];
    assert_eq!(plain, expected);
    let b = found
        .iter()
        .find(|i| i.path.join("::") == "child::A")
        .unwrap();
    assert_eq!(b.reexported_as.as_deref(), Some("B"));
}
