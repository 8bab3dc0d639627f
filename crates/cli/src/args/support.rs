//! The plane on which the object stands.

use clap::Args;
use hand::Support;
use moduli::Object;
use moduli::nalgebra::{UnitVector3, Vector3};

/// The plane above which hands stay.
#[derive(Clone, Debug, Args)]
pub(crate) struct SupportOptions {
    /// The plane on which the object stands, above which hands stay by 3 mm: `auto` takes the foot of the
    /// object along --up, `none` means no plane, and A,B,C,D is the plane A x + B y + C z + D = 0 in
    /// metres, with (A, B, C) towards the object.
    #[arg(long, value_name = "auto|none|A,B,C,D", default_value = "auto", allow_hyphen_values = true, value_parser = support)]
    support: SupportRule,
    /// Upward direction in the frame of the cloud.
    #[arg(long, value_name = "X,Y,Z", default_value = "0,0,1", allow_hyphen_values = true, value_parser = upward)]
    up: UnitVector3<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum SupportRule {
    Auto,
    None,
    Given(Support),
}

impl SupportOptions {
    /// The plane under an object, in the frame of its cloud.
    pub(crate) fn under(&self, object: &Object) -> Option<Support> {
        match self.support {
            SupportRule::Auto => Some(object.foot(&self.up)),
            SupportRule::None => None,
            SupportRule::Given(plane) => Some(plane),
        }
    }
}

fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers: Option<Vec<f64>> = text
        .split(',')
        .map(|cell| cell.trim().parse().ok().filter(|x: &f64| x.is_finite()))
        .collect();
    numbers?.try_into().ok()
}

fn upward(text: &str) -> Result<UnitVector3<f64>, String> {
    numbers::<3>(text)
        .and_then(|v| UnitVector3::try_new(Vector3::from(v), 1e-12))
        .ok_or_else(|| "expected X,Y,Z, not all 0".to_owned())
}

fn support(text: &str) -> Result<SupportRule, String> {
    let plane = |[a, b, c, d]: [f64; 4]| {
        let normal = Vector3::new(a, b, c);
        let offset = -d / normal.norm();
        let normal = UnitVector3::try_new(normal, 1e-12)?;
        Some(SupportRule::Given(Support { normal, offset }))
    };
    match text {
        "auto" => Ok(SupportRule::Auto),
        "none" => Ok(SupportRule::None),
        _ => numbers(text)
            .and_then(plane)
            .ok_or_else(|| "expected `auto`, `none` or A,B,C,D with A, B, C not all 0".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_is_read_with_its_side() {
        let SupportRule::Given(plane) = support("0, 0,-2,1").unwrap() else {
            panic!("a plane");
        };
        assert_eq!(plane.normal, -Vector3::z_axis());
        assert_eq!(plane.offset, -0.5);
        assert_eq!(support("none"), Ok(SupportRule::None));
        assert!(support("0,0,0,1").is_err() && support("0,0,1").is_err());
        assert!(upward("0,0,0").is_err() && upward("0,nan,1").is_err());
        assert_eq!(upward("0,-3,0").unwrap(), -Vector3::y_axis());
    }
}
