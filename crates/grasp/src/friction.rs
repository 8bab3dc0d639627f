//! Friction cones: the tangent rule and the edges of inscribed pyramids.

use crate::convention::{EdgeNorm, TangentRule};
use nalgebra::{UnitVector3, Vector3};

/// The tangent that the edges start from: the normalised projection of the coordinate axis least
/// aligned with `normal` onto its tangent plane; the lowest axis on ties.
pub fn tangent(normal: &UnitVector3<f64>) -> UnitVector3<f64> {
    TangentRule::LeastAligned.tangent(normal)
}

/// The `count` edges f_j = n + μ(cos a_j t + sin a_j n×t), a_j = 2πj/count, from the tangent rule.
pub fn cone_edges(
    normal: &UnitVector3<f64>,
    friction: f64,
    count: usize,
    norm: EdgeNorm,
) -> impl Iterator<Item = Vector3<f64>> {
    cone_edges_from(normal, &tangent(normal), friction, count, norm)
}

/// The same edges counted from an explicit unit tangent.
///
/// Under `EdgeNorm::UnitLength` each edge is divided by √(1+μ²).
pub fn cone_edges_from(
    normal: &UnitVector3<f64>,
    tangent: &UnitVector3<f64>,
    friction: f64,
    count: usize,
    norm: EdgeNorm,
) -> impl Iterator<Item = Vector3<f64>> + Clone + use<> {
    let scale = match norm {
        EdgeNorm::UnitNormalComponent => 1.0,
        EdgeNorm::UnitLength => 1.0 / friction.hypot(1.0),
    };
    let n = normal.into_inner() * scale;
    let t = tangent.into_inner() * (scale * friction);
    let b = normal.cross(tangent) * (scale * friction);
    (0..count).map(move |j| {
        let (sin, cos) = angle(j, count).sin_cos();
        n + t * cos + b * sin
    })
}

/// The angle 2πj/count of edge j.
pub(crate) fn angle(j: usize, count: usize) -> f64 {
    std::f64::consts::TAU * j as f64 / count as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Unit;

    #[test]
    fn tangent_takes_the_lowest_axis_on_ties() {
        let t = tangent(&Vector3::z_axis());
        assert_eq!(t.into_inner(), Vector3::x());
        let t = tangent(&Vector3::x_axis());
        assert_eq!(t.into_inner(), Vector3::y());
        let n = Unit::new_normalize(Vector3::new(1.0, 1.0, 1.0));
        assert!(tangent(&n).x > 0.8);
        assert!(tangent(&n).dot(&n).abs() <= 1e-15);
    }

    #[test]
    fn edges_lie_on_the_cone() {
        let n = Unit::new_normalize(Vector3::new(0.3, -0.5, 0.8));
        for f in cone_edges(&n, 0.7, 5, EdgeNorm::UnitNormalComponent) {
            assert!((f.dot(&n) - 1.0).abs() <= 1e-14);
            assert!(((f - n.into_inner()).norm() - 0.7).abs() <= 1e-14);
        }
        for f in cone_edges(&n, 0.7, 5, EdgeNorm::UnitLength) {
            assert!((f.norm() - 1.0).abs() <= 1e-14);
        }
        let first = cone_edges(&n, 0.7, 5, EdgeNorm::UnitNormalComponent).next();
        let expected = n.into_inner() + tangent(&n).into_inner() * 0.7;
        assert!((first.unwrap() - expected).norm() <= 1e-14);
    }
}
