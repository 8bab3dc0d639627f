//! The plane under an object whose surface is fitted already.

use clap::Args;
use moduli::nalgebra::UnitVector3;
use moduli::{Object, Support, SupportRule};

use super::scene::{support, upward};

/// The plane above which hands stay.
#[derive(Clone, Debug, Args)]
pub(crate) struct SupportOptions {
    /// The plane on which the object stands, above which hands stay by 3 mm: `auto` takes the one in the
    /// shape file, or the foot of the object along --up where it has none; `none` means no plane, and
    /// A,B,C,D is the plane A x + B y + C z + D = 0 in metres, with (A, B, C) towards the object.
    #[arg(long, value_name = "auto|none|A,B,C,D", default_value = "auto", allow_hyphen_values = true, value_parser = support)]
    support: SupportRule,
    /// Upward direction in the frame of the cloud.
    #[arg(long, value_name = "X,Y,Z", default_value = "0,0,1", allow_hyphen_values = true, value_parser = upward)]
    up: UnitVector3<f64>,
}

impl SupportOptions {
    /// The plane under an object, in the frame of its cloud.
    pub(crate) fn under(&self, object: &Object) -> Option<Support> {
        match self.support {
            SupportRule::Auto => Some(
                object
                    .support()
                    .copied()
                    .unwrap_or_else(|| object.foot(&self.up)),
            ),
            SupportRule::None => None,
            SupportRule::Given(plane) => Some(plane),
        }
    }
}
