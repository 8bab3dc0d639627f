//! Options for finding the object in a cloud.

use clap::{Args, ValueEnum};
use moduli::nalgebra::{UnitVector3, Vector3};
use moduli::{SceneSettings, Support, SupportRule};

/// How the object is found in a cloud, and when its surface is accepted.
#[derive(Clone, Debug, Args)]
pub(crate) struct SceneOptions {
    /// How the object is found in the cloud: `auto` removes a visible support plane, rows that stand for
    /// "no return" and other pieces; `off` takes all points.
    #[arg(long, value_enum, default_value_t = SceneMode::Auto)]
    pub(crate) scene: SceneMode,
    /// Piece of the cloud to take, 1 for the largest, when no piece dominates or another one is wanted.
    #[arg(long, value_name = "N")]
    piece: Option<usize>,
    /// The plane on which the object stands: `auto` finds it or takes the lowest point along --up, `none`
    /// means no plane, and A,B,C,D is the plane A x + B y + C z + D = 0 in metres, with (A, B, C) towards
    /// the object.
    #[arg(long, value_name = "auto|none|A,B,C,D", default_value = "auto", allow_hyphen_values = true, value_parser = support)]
    support: SupportRule,
    /// Upward direction in the frame of the cloud.
    #[arg(long, value_name = "X,Y,Z", default_value = "0,0,1", allow_hyphen_values = true, value_parser = upward)]
    up: UnitVector3<f64>,
    /// Keep a surface that does not explain its points. Every result carries a warning then.
    #[arg(long)]
    pub(crate) accept_misfit: bool,
}

/// Whether the object is looked for in the cloud.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SceneMode {
    /// The object is found among the points.
    Auto,
    /// All points are the object's.
    Off,
}

impl SceneOptions {
    /// The settings, `None` where all points are the object's.
    pub(crate) fn settings(&self) -> Option<SceneSettings> {
        (self.scene == SceneMode::Auto).then_some(SceneSettings {
            piece: self.piece,
            support: self.support,
            up: self.up,
        })
    }
}

fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers: Option<Vec<f64>> = text
        .split(',')
        .map(|cell| cell.trim().parse().ok().filter(|x: &f64| x.is_finite()))
        .collect();
    numbers?.try_into().ok()
}

pub(super) fn upward(text: &str) -> Result<UnitVector3<f64>, String> {
    numbers::<3>(text)
        .and_then(|v| UnitVector3::try_new(Vector3::from(v), 1e-12))
        .ok_or_else(|| "expected X,Y,Z, not all 0".to_owned())
}

pub(super) fn support(text: &str) -> Result<SupportRule, String> {
    match text {
        "auto" => Ok(SupportRule::Auto),
        "none" => Ok(SupportRule::None),
        _ => numbers::<4>(text)
            .and_then(|[a, b, c, d]| {
                let normal = Vector3::new(a, b, c);
                let offset_m = -d / normal.norm();
                let normal = UnitVector3::try_new(normal, 1e-12)?;
                Some(SupportRule::Given(Support { normal, offset_m }))
            })
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
        assert_eq!(plane.offset_m, -0.5);
        assert_eq!(support("none"), Ok(SupportRule::None));
        assert!(support("0,0,0,1").is_err() && support("0,0,1").is_err());
        assert!(upward("0,0,0").is_err() && upward("0,nan,1").is_err());
        assert_eq!(upward("0,-3,0").unwrap(), -Vector3::y_axis());
    }
}
