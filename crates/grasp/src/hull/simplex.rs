//! Completing a few points of a hull to seven affinely independent ones.

use super::min_norm::Corral;
use super::plane::{V6, add_scaled, dot, norm, scale, sub};
use super::support::Support;

/// Seven affinely independent points and what the caller calls them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Simplex {
    pub(crate) points: [V6; 7],
    pub(crate) tags: [u32; 7],
}

/// A unit direction along which the whole hull has no thickness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Flat {
    pub(crate) normal: V6,
}

/// Keeps the independent points of the corral and adds the farthest of the hull, one direction at a
/// time; `tolerance` is the thickness below which the hull counts as flat.
pub(crate) fn complete(
    corral: &Corral,
    source: &mut impl Support,
    tolerance: f64,
) -> Result<Simplex, Flat> {
    let mut points = [[0.0; 6]; 7];
    let mut tags = [0; 7];
    let mut basis = [[0.0; 6]; 6];
    points[0] = corral.points[0];
    tags[0] = corral.tags[0];
    let mut rank = 0;
    for i in 1..corral.len {
        let edge = sub(&corral.points[i], &points[0]);
        let rest = reject(&edge, &basis[..rank]);
        let height = norm(&rest);
        if rank < 6 && height > 1e-6 * norm(&edge) && height > tolerance {
            basis[rank] = scale(&rest, 1.0 / height);
            rank += 1;
            points[rank] = corral.points[i];
            tags[rank] = corral.tags[i];
        }
    }
    while rank < 6 {
        let normal = complement(&basis[..rank]);
        let base = dot(&normal, &points[0]);
        let (up, up_tag) = source.support(&normal);
        let (down, down_tag) = source.support(&scale(&normal, -1.0));
        let (rise, fall) = (dot(&normal, &up) - base, base - dot(&normal, &down));
        if rise.max(fall) <= tolerance {
            return Err(Flat { normal });
        }
        let (point, tag) = if rise >= fall {
            (up, up_tag)
        } else {
            (down, down_tag)
        };
        let rest = reject(&sub(&point, &points[0]), &basis[..rank]);
        basis[rank] = scale(&rest, 1.0 / norm(&rest));
        rank += 1;
        points[rank] = point;
        tags[rank] = tag;
    }
    Ok(Simplex { points, tags })
}

/// What remains of `v` orthogonal to an orthonormal basis; twice, so that rounding does not stay.
fn reject(v: &V6, basis: &[V6]) -> V6 {
    let once = |v: V6| basis.iter().fold(v, |r, b| add_scaled(&r, -dot(&r, b), b));
    once(once(*v))
}

/// A unit vector orthogonal to fewer than six orthonormal vectors: the largest rest of an axis.
fn complement(basis: &[V6]) -> V6 {
    let mut best = ([0.0; 6], 0.0);
    for axis in 0..6 {
        let mut e = [0.0; 6];
        e[axis] = 1.0;
        let rest = reject(&e, basis);
        let length = norm(&rest);
        if length > best.1 {
            best = (rest, length);
        }
    }
    scale(&best.0, 1.0 / best.1)
}

#[cfg(test)]
mod tests {
    use super::super::support::PointList;
    use super::*;

    #[test]
    fn completes_one_point_and_names_flatness() {
        let mut points: Vec<V6> = (0..6)
            .flat_map(|k| {
                let mut p = [0.0; 6];
                p[k] = 1.0;
                let mut q = p;
                q[k] = -1.0;
                [p, q]
            })
            .collect();
        let corral = Corral::single(&points[0], 0);
        let start = complete(&corral, &mut PointList(&points), 1e-12);
        let Ok(Simplex { points: s, .. }) = start else {
            panic!("the cross polytope is not flat");
        };
        let m = nalgebra::Matrix6::from_fn(|i, j| s[j + 1][i] - s[0][i]);
        assert!(m.determinant().abs() >= 0.5);
        points.iter_mut().for_each(|p| p[3] = 0.25);
        let corral = Corral::single(&points[0], 0);
        let start = complete(&corral, &mut PointList(&points), 1e-12);
        let Err(Flat { normal }) = start else {
            panic!("a coordinate is constant");
        };
        assert!(normal[3].abs() > 0.1);
    }
}
