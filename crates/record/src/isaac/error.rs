//! Why a text is not an `isaac_grasp` file.

/// Why a text is not an `isaac_grasp` file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum IsaacError {
    /// The text is not YAML, or uses a part of it that the format does not need.
    #[error("line {line}: {what}")]
    Yaml {
        /// Line, from 1.
        line: usize,
        /// What is wrong.
        what: String,
    },
    /// A key is missing or has an unexpected value.
    #[error("line {line}: `{key}` {found}; expected {expected}")]
    Key {
        /// Line, from 1.
        line: usize,
        /// The key, with that of its grasp.
        key: String,
        /// What it is.
        found: String,
        /// What it should be.
        expected: &'static str,
    },
}

impl IsaacError {
    pub(super) fn yaml(line: usize, what: impl Into<String>) -> Self {
        let what = what.into();
        Self::Yaml { line, what }
    }
}
