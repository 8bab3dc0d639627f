//! Evidence of a cloud for a surface at the scale of a fingertip.
//!
//! A fitted surface is smooth even where the object has an edge. Two numbers are measured on the
//! points alone, for any kind of surface: the distance of the data from the surface at a contact,
//! and the angle between the normals of the data within a pad around it and the normal of the
//! surface.

use nalgebra::{Matrix3, Point3, UnitVector3, Vector3};

/// Radius of a fingertip's pad without a hand, metres.
pub const PAD_RADIUS: f64 = 5e-3;

/// Number of points that determine a plane well.
const ENOUGH: usize = 8;
/// Largest number of points of a pad at which normals are estimated.
const MOST_NORMALS: usize = 200;

/// The evidence of a cloud for the surface near one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evidence {
    /// Distance of the contact from the plane that fits the points around it best, metres; of an unseen
    /// contact the distance from the nearest point.
    pub distance: f64,
    /// The largest angle between the contact's normal and the data's normals within the pad, radians, up
    /// to π/2; π for an unseen contact, where any normal is possible.
    pub normal_spread: f64,
    /// Whether the pad has enough points.
    pub seen: bool,
}

/// The evidence for a contact at `place` with the unit normal `normal`, from the points of a cloud in the
/// same frame, within `radius` of it, metres.
///
/// The normal at each point is that of the plane through the points within half the radius of it, or
/// through its eight nearest where those are fewer. Costs one pass over the cloud, and for each point of
/// the pad (200 at most) one pass over the points within twice the radius.
pub fn evidence(
    points: &[Point3<f64>],
    place: &Point3<f64>,
    normal: &UnitVector3<f64>,
    radius: f64,
) -> Evidence {
    let within = |length: f64| move |p: &&Point3<f64>| (*p - place).norm() <= length;
    let near: Vec<Point3<f64>> = points
        .iter()
        .filter(within(2.0 * radius))
        .copied()
        .collect();
    let pad: Vec<Point3<f64>> = near.iter().filter(within(radius)).copied().collect();
    let plane = plane_around(&near, place, 0.5 * radius);
    let (Some((middle, across)), true) = (plane, pad.len() >= ENOUGH) else {
        let distances = points.iter().map(|p| (p - place).norm());
        return Evidence {
            distance: distances.fold(f64::INFINITY, f64::min),
            normal_spread: std::f64::consts::PI,
            seen: false,
        };
    };
    let step = pad.len().div_ceil(MOST_NORMALS);
    let angles = pad.iter().step_by(step).filter_map(|p| {
        let (_, found) = plane_around(&near, p, 0.5 * radius)?;
        Some(found.dot(normal).abs().min(1.0).acos())
    });
    Evidence {
        distance: across.dot(&(place.coords - middle)).abs(),
        normal_spread: angles.fold(0.0, f64::max),
        seen: true,
    }
}

/// The mean and the normal of the points within `radius` of a place, or of the nearest ones; `None` where
/// they are too few.
fn plane_around(
    points: &[Point3<f64>],
    place: &Point3<f64>,
    radius: f64,
) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let distance = |p: &Point3<f64>| (p - place).norm();
    let mut chosen: Vec<Point3<f64>> = points
        .iter()
        .filter(|p| distance(p) <= radius)
        .copied()
        .collect();
    if chosen.len() < ENOUGH {
        if points.len() < ENOUGH {
            return None;
        }
        chosen = points.to_vec();
        chosen.select_nth_unstable_by(ENOUGH - 1, |a, b| distance(a).total_cmp(&distance(b)));
        chosen.truncate(ENOUGH);
    }
    let middle = chosen.iter().map(|p| p.coords).sum::<Vector3<f64>>() / chosen.len() as f64;
    let spread: Matrix3<f64> = chosen
        .iter()
        .map(|p| (p.coords - middle) * (p.coords - middle).transpose())
        .sum();
    let axes = spread.symmetric_eigen();
    Some((
        middle,
        axes.eigenvectors.column(axes.eigenvalues.imin()).into(),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points 1 mm apart on the top of a box and on the side that falls off at x = 0.
    fn step() -> Vec<Point3<f64>> {
        let grid = || {
            (-20..=20)
                .flat_map(|i| (-20..=20).map(move |j| [1e-3 * f64::from(i), 1e-3 * f64::from(j)]))
        };
        let top = grid()
            .filter(|p| p[0] <= 0.0)
            .map(|[x, y]| Point3::new(x, y, 0.0));
        let side = grid()
            .filter(|p| p[0] < 0.0)
            .map(|[z, y]| Point3::new(0.0, y, z));
        top.chain(side).collect()
    }

    #[test]
    fn a_flat_place_is_known_and_an_edge_is_not() {
        let down = -Vector3::z_axis();
        let at = |x: f64, z: f64| evidence(&step(), &Point3::new(x, 0.0, z), &down, PAD_RADIUS);
        let flat = at(-0.012, 2e-4);
        assert!(
            flat.seen && (flat.distance - 2e-4).abs() <= 1e-12,
            "{flat:?}"
        );
        assert!(flat.normal_spread <= 1e-6, "{flat:?}");
        let edge = at(0.0, 0.0);
        assert!(edge.seen && edge.normal_spread > 1.0, "{edge:?}");
        let unseen = at(-0.012, 0.03);
        assert!(
            !unseen.seen && (unseen.distance - 0.03).abs() <= 1e-6,
            "{unseen:?}"
        );
        assert_eq!(unseen.normal_spread, std::f64::consts::PI);
    }
}
