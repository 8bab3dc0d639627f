//! The header of binary records. No other module uses bincode.
//!
//! Layout, little endian: magic `MODULI\r\n` (8 bytes), kind (u16), version (u16), length of the
//! body (u64), FNV-1a checksum of the body (u64), body.

use bincode::config;
use serde::Serialize;
use serde::de::DeserializeOwned;

const MAGIC: [u8; 8] = *b"MODULI\r\n";
const HEADER: usize = 28;
/// Largest body, bytes: 256 MiB. A library of a thousand shapes of degree 100 has 80 MB.
const MAX_BODY: u64 = 1 << 28;

/// Kind of a binary record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A [`crate::ShapeRecord`].
    Shape,
    /// A [`crate::LibraryRecord`].
    Library,
    /// A [`crate::SphericalRecord`].
    Spherical,
    /// A [`crate::LibraryObjectRecord`].
    LibraryObject,
}

impl Kind {
    fn code(self) -> u16 {
        match self {
            Kind::Shape => 1,
            Kind::Library => 2,
            Kind::Spherical => 3,
            Kind::LibraryObject => 4,
        }
    }

    /// The version that is written. Shapes of version 1 of both kinds, which have no notes, are read too.
    fn version(self) -> u16 {
        match self {
            Kind::Shape | Kind::Spherical => 2,
            Kind::Library | Kind::LibraryObject => 1,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Kind::Shape => "shape",
            Kind::Library => "library",
            Kind::Spherical => "spherical shape",
            Kind::LibraryObject => "library object",
        }
    }

    fn from_code(code: u16) -> Option<Self> {
        [
            Kind::Shape,
            Kind::Library,
            Kind::Spherical,
            Kind::LibraryObject,
        ]
        .into_iter()
        .find(|kind| kind.code() == code)
    }
}

/// Why bytes are not the expected record.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EnvelopeError {
    /// The bytes do not begin with the mark of a moduli record.
    #[error("not a moduli record: it does not begin with the mark MODULI")]
    Magic,
    /// The record is of another kind.
    #[error("this record holds a {found}, expected a {expected}")]
    Kind {
        /// The kind found.
        found: String,
        /// The kind expected.
        expected: &'static str,
    },
    /// The record has another version of its format.
    #[error("{kind} record of format version {found}; this program reads version {known}")]
    Version {
        /// The kind.
        kind: &'static str,
        /// Version found.
        found: u16,
        /// The version that is read.
        known: u16,
    },
    /// The length of the body differs from that in the header.
    #[error("the record says {expected} bytes of content, but {found} follow the header")]
    Length {
        /// Bytes announced.
        expected: u64,
        /// Bytes present.
        found: u64,
    },
    /// The checksum of the body differs from that in the header.
    #[error("the record is damaged: its checksum does not match its content")]
    Checksum,
    /// The body cannot be decoded.
    #[error("the record does not decode: {reason}")]
    Body {
        /// The message of the decoder.
        reason: String,
    },
}

/// Encodes a value behind a header.
///
/// # Errors
/// The value cannot be encoded, or its body is larger than 256 MiB.
pub fn encode<T: Serialize>(kind: Kind, value: &T) -> Result<Vec<u8>, EnvelopeError> {
    let body = bincode::serde::encode_to_vec(value, config::standard().with_fixed_int_encoding())
        .map_err(|e| EnvelopeError::Body {
        reason: e.to_string(),
    })?;
    if body.len() as u64 > MAX_BODY {
        return Err(EnvelopeError::Body {
            reason: format!("{} bytes; at most {MAX_BODY} are allowed", body.len()),
        });
    }
    let mut out = Vec::with_capacity(HEADER + body.len());
    out.extend_from_slice(&MAGIC);
    out.extend_from_slice(&kind.code().to_le_bytes());
    out.extend_from_slice(&kind.version().to_le_bytes());
    out.extend_from_slice(&(body.len() as u64).to_le_bytes());
    out.extend_from_slice(&checksum(&body).to_le_bytes());
    out.extend_from_slice(&body);
    Ok(out)
}

/// The kind of record whose header the bytes begin with; `None` for anything else.
pub fn kind_of(bytes: &[u8]) -> Option<Kind> {
    if bytes.len() < HEADER || bytes[..8] != MAGIC {
        return None;
    }
    Kind::from_code(u16::from_le_bytes([bytes[8], bytes[9]]))
}

/// The version of the format that a header names.
pub fn version_of(bytes: &[u8]) -> Option<u16> {
    kind_of(bytes).map(|_| u16::from_le_bytes([bytes[10], bytes[11]]))
}

/// Decodes a value after checking mark, kind, version, length and checksum.
///
/// # Errors
/// One of these checks fails, or the body does not decode to the type or has bytes left over.
pub fn decode<T: DeserializeOwned>(kind: Kind, bytes: &[u8]) -> Result<T, EnvelopeError> {
    decode_version(kind, kind.version(), bytes)
}

/// [`decode`] for a version that is not the newest.
///
/// # Errors
/// Those of [`decode`].
pub fn decode_version<T: DeserializeOwned>(
    kind: Kind,
    version: u16,
    bytes: &[u8],
) -> Result<T, EnvelopeError> {
    let body = checked_body(kind, version, bytes)?;
    let config = config::standard()
        .with_fixed_int_encoding()
        .with_limit::<{ MAX_BODY as usize }>();
    let (value, read) =
        bincode::serde::decode_from_slice(body, config).map_err(|e| EnvelopeError::Body {
            reason: e.to_string(),
        })?;
    if read == body.len() {
        Ok(value)
    } else {
        Err(EnvelopeError::Body {
            reason: format!("{} bytes are left over", body.len() - read),
        })
    }
}

fn checked_body(kind: Kind, version: u16, bytes: &[u8]) -> Result<&[u8], EnvelopeError> {
    if bytes.len() < HEADER || bytes[..8] != MAGIC {
        return Err(EnvelopeError::Magic);
    }
    let short = |at: usize| u16::from_le_bytes([bytes[at], bytes[at + 1]]);
    let long = |at: usize| {
        let mut eight = [0; 8];
        eight.copy_from_slice(&bytes[at..at + 8]);
        u64::from_le_bytes(eight)
    };
    if short(8) != kind.code() {
        let found = Kind::from_code(short(8)).map_or("record of an unknown kind", Kind::name);
        return Err(EnvelopeError::Kind {
            found: found.to_owned(),
            expected: kind.name(),
        });
    }
    if short(10) != version {
        return Err(EnvelopeError::Version {
            kind: kind.name(),
            found: short(10),
            known: kind.version(),
        });
    }
    let body = &bytes[HEADER..];
    if long(12) != body.len() as u64 {
        return Err(EnvelopeError::Length {
            expected: long(12),
            found: body.len() as u64,
        });
    }
    if long(20) != checksum(body) {
        return Err(EnvelopeError::Checksum);
    }
    Ok(body)
}

/// The 64-bit FNV-1a hash. It detects accidental changes, not deliberate ones.
pub fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}
