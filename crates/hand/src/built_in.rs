//! The built-in hands: a simplified Schunk SDH and two grippers.

use thiserror::Error;

use crate::hand::{Hand, HandError};
use crate::hand_spec::{HandSpec, SpecTextError};
use crate::urdf::{UrdfError, load_urdf};

/// The URDF of the built-in hand.
pub const SDH_URDF: &str = fixtures::SDH_URDF;
/// The spec of the built-in hand.
pub const SDH_SPEC: &str = fixtures::SDH_SPEC;

/// Names, URDFs and specs.
const BUILT_IN: [(&str, &str, &str); 3] = [
    ("sdh", SDH_URDF, SDH_SPEC),
    ("panda", fixtures::PANDA_URDF, fixtures::PANDA_SPEC),
    (
        "robotiq_2f85",
        fixtures::ROBOTIQ_2F85_URDF,
        fixtures::ROBOTIQ_2F85_SPEC,
    ),
];

/// Why a hand could not be made from a URDF and a spec.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum LoadError {
    /// The URDF was refused.
    #[error(transparent)]
    Urdf(#[from] UrdfError),
    /// The spec could not be read.
    #[error(transparent)]
    SpecText(#[from] SpecTextError),
    /// The spec does not fit the URDF.
    #[error(transparent)]
    Hand(#[from] HandError),
}

/// The Schunk SDH with our simplified collision model: three fingers, seven driven
/// joints, pre-shapes "parallel" and "spread" (paper, Sec. IV-C).
pub fn schunk_sdh() -> Result<Hand, LoadError> {
    Hand::from_texts(SDH_URDF, SDH_SPEC)
}

impl Hand {
    /// The hand described by a URDF and a TOML spec. The collision geometry of the URDF must
    /// consist of primitives; for meshes see [`crate::load_urdf_with_meshes`].
    ///
    /// # Errors
    /// One of the texts is refused, or the spec does not match the URDF.
    pub fn from_texts(urdf: &str, spec: &str) -> Result<Self, LoadError> {
        Ok(Self::new(load_urdf(urdf)?, &HandSpec::from_toml(spec)?)?)
    }

    /// The built-in hand of a name, one of [`Hand::BUILT_IN`].
    ///
    /// ```
    /// let gripper = hand::Hand::built_in("panda").unwrap()?;
    /// assert_eq!(gripper.groups().len(), 1);
    /// assert!(hand::Hand::built_in("claw").is_none());
    /// # Ok::<(), hand::LoadError>(())
    /// ```
    pub fn built_in(name: &str) -> Option<Result<Self, LoadError>> {
        let (_, urdf, spec) = BUILT_IN.iter().find(|(known, ..)| *known == name)?;
        Some(Self::from_texts(urdf, spec))
    }

    /// The names of the built-in hands.
    pub const BUILT_IN: [&str; 3] = [BUILT_IN[0].0, BUILT_IN[1].0, BUILT_IN[2].0];

    /// The built-in Schunk SDH, see [`schunk_sdh`].
    ///
    /// ```
    /// let hand = hand::Hand::schunk_sdh()?;
    /// assert_eq!(hand.model().driven_count(), 7);
    /// # Ok::<(), hand::LoadError>(())
    /// ```
    ///
    /// # Errors
    /// The built-in files cannot be read; a test excludes it.
    pub fn schunk_sdh() -> Result<Self, LoadError> {
        schunk_sdh()
    }
}
