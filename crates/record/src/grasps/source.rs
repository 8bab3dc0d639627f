//! The origin of a grasp.

use serde::{Deserialize, Serialize};

/// The origin of a grasp.
///
/// In JSON an object with the keys `kind`, `from`, `shape_distance_m` and `source_quality`; the
/// last three are `null` except for a transfer.
///
/// ```
/// use record::grasps::SourceRecord;
///
/// let text = r#"{"kind":"synthesis","from":null,"shape_distance_m":null,"source_quality":null}"#;
/// let source: SourceRecord = serde_json::from_str(text)?;
/// assert_eq!(source, SourceRecord::Synthesis);
/// assert_eq!(serde_json::to_string(&source)?, text);
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "Keys", into = "Keys")]
pub enum SourceRecord {
    /// A hand was closed on the object.
    Synthesis,
    /// The grasp was transferred from another object.
    Transfer {
        /// Id and name of the other object.
        from: Option<String>,
        /// Distance d of the shapes (Sec. III-A), metres.
        shape_distance_m: Option<f64>,
        /// Quality of the grasp on the other object.
        source_quality: Option<f64>,
    },
    /// The name that another program gives to the origin of its grasp.
    Other(String),
}

/// The keys of the file.
#[derive(Clone, Serialize, Deserialize)]
struct Keys {
    kind: String,
    #[serde(default)]
    from: Option<String>,
    #[serde(default)]
    shape_distance_m: Option<f64>,
    #[serde(default)]
    source_quality: Option<f64>,
}

impl SourceRecord {
    /// The value of the key `kind`: `synthesis`, `transfer`, or another program's name.
    pub fn kind(&self) -> &str {
        match self {
            Self::Synthesis => "synthesis",
            Self::Transfer { .. } => "transfer",
            Self::Other(kind) => kind,
        }
    }

    /// Quality on the object from which the grasp was transferred, if known.
    pub fn source_quality(&self) -> Option<f64> {
        match self {
            Self::Transfer { source_quality, .. } => *source_quality,
            Self::Synthesis | Self::Other(_) => None,
        }
    }
}

impl From<Keys> for SourceRecord {
    fn from(keys: Keys) -> Self {
        match keys.kind.as_str() {
            "synthesis" => Self::Synthesis,
            "transfer" => Self::Transfer {
                from: keys.from,
                shape_distance_m: keys.shape_distance_m,
                source_quality: keys.source_quality,
            },
            _ => Self::Other(keys.kind),
        }
    }
}

impl From<SourceRecord> for Keys {
    fn from(source: SourceRecord) -> Self {
        let kind = source.kind().to_owned();
        let (from, shape_distance_m, source_quality) = match source {
            SourceRecord::Transfer {
                from,
                shape_distance_m,
                source_quality,
            } => (from, shape_distance_m, source_quality),
            SourceRecord::Synthesis | SourceRecord::Other(_) => (None, None, None),
        };
        Self {
            kind,
            from,
            shape_distance_m,
            source_quality,
        }
    }
}
