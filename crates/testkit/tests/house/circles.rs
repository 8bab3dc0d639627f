//! No cycle of modules except between parent and child.

use std::collections::{BTreeMap, BTreeSet};

use crate::imports::{Import, imports};
use crate::sources::{Source, crate_folders, sources};

type Module = Vec<String>;

/// The modules of one crate and what they import.
struct Graph {
    imports: BTreeMap<Module, Vec<Import>>,
}

impl Graph {
    fn new(sources: &[Source]) -> Self {
        let of = |s: &Source| (s.module.clone(), imports(&s.shipped));
        Self {
            imports: sources.iter().map(of).collect(),
        }
    }

    /// The module in which the last name of a path, as written in `module`, is defined; re-exports
    /// are followed. `None` for foreign paths.
    fn home(&self, module: &Module, path: &[String], depth: usize) -> Option<Module> {
        let mut at = module.clone();
        let mut names = path;
        match names.first()?.as_str() {
            "crate" => {
                at.clear();
                names = &names[1..];
            }
            "super" => {
                while names.first().is_some_and(|n| n == "super") {
                    at.pop()?;
                    names = &names[1..];
                }
            }
            "self" => names = &names[1..],
            child => {
                let mut deeper = at.clone();
                deeper.push(child.to_owned());
                if !self.imports.contains_key(&deeper) {
                    return None;
                }
            }
        }
        while let Some(name) = names.first() {
            let mut deeper = at.clone();
            deeper.push(name.clone());
            if self.imports.contains_key(&deeper) {
                at = deeper;
                names = &names[1..];
                continue;
            }
            let reexport = self.imports.get(&at)?.iter().find(|import| {
                import.reexported_as.as_ref() == Some(name) && import.path.first() != Some(name)
            });
            return match reexport {
                Some(import) if depth > 0 => self
                    .home(&at, &import.path, depth - 1)
                    .or_else(|| Some(at.clone())),
                _ => Some(at),
            };
        }
        Some(at)
    }

    /// What a module uses, without its own ancestors and descendants.
    fn uses(&self, module: &Module) -> BTreeSet<Module> {
        let related = |other: &Module| other.starts_with(module) || module.starts_with(other);
        self.imports[module]
            .iter()
            .filter_map(|import| self.home(module, &import.path, 8))
            .filter(|home| !related(home))
            .collect()
    }

    /// Pairs of modules each of which reaches the other.
    fn circles(&self) -> Vec<String> {
        let direct: BTreeMap<&Module, BTreeSet<Module>> =
            self.imports.keys().map(|m| (m, self.uses(m))).collect();
        let reachable = |from: &Module| {
            let mut seen = BTreeSet::new();
            let mut open: Vec<Module> = direct[from].iter().cloned().collect();
            while let Some(next) = open.pop() {
                if seen.insert(next.clone()) {
                    open.extend(direct[&next].iter().cloned());
                }
            }
            seen
        };
        let all: BTreeMap<&Module, BTreeSet<Module>> =
            direct.keys().map(|m| (*m, reachable(m))).collect();
        let mut found = Vec::new();
        for (module, uses) in &direct {
            for other in uses {
                if all[other].contains(*module) {
                    found.push(format!("{} -> {}", module.join("::"), other.join("::")));
                }
            }
        }
        found
    }
}

#[test]
fn modules_have_no_circles() {
    let mut found = Vec::new();
    let mut modules = 0;
    for (name, folder) in crate_folders() {
        let graph = Graph::new(&sources(&folder));
        modules += graph.imports.len();
        found.extend(graph.circles().into_iter().map(|c| format!("{name}: {c}")));
    }
    assert!(modules > 100, "only {modules} modules were found");
    assert!(
        found.is_empty(),
        "modules that use each other in a circle, by edge:\n{}",
        found.join("\n")
    );
}

#[test]
fn circles_are_found_through_reexports() {
    let source = |module: &[&str], text: &str| Source {
        path: "x.rs".into(),
        module: module.iter().map(|m| (*m).to_owned()).collect(),
        shipped: text.to_owned(),
    };
    let mut files = vec![
        source(&[], "mod a;\nmod b;\npub use b::B;\n"),
        source(&["a"], "use crate::B;\n"),
        source(&["b"], "use crate::a::A;\n"),
    ];
    assert_eq!(Graph::new(&files).circles(), ["a -> b", "b -> a"]);
    files[2] = source(&["b"], "use std::fmt;\n");
    assert!(Graph::new(&files).circles().is_empty());
}
