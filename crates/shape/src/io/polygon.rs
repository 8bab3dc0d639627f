//! Polygons cut into triangles.

use nalgebra::{Point2, Point3, Vector3};

/// The largest concave polygon that is cut: the cost grows with the square of its corners.
pub(super) const MAX_CONCAVE: usize = 4096;

/// Share of its area by which a fan may cover itself: the rounding of coordinates in files.
const FOLDED: f64 = 1e-9;

/// Cuts a polygon into triangles; `false` if it is concave and has more than [`MAX_CONCAVE`] corners.
///
/// A polygon that is star-shaped from its first corner, such as a convex one, becomes the fan of
/// that corner. Other polygons are cut by ear clipping (Meisters 1975) in the projection along the
/// normal of their area. `corners` are indices of `vertices`.
pub(super) fn cut(
    corners: &[u32],
    vertices: &[Point3<f64>],
    triangles: &mut Vec<[u32; 3]>,
) -> bool {
    if corners.len() <= 3 || corners.iter().any(|&c| c as usize >= vertices.len()) {
        fan(corners, triangles);
        return true;
    }
    let points = flattened(corners, vertices);
    let (mut turned, mut folded) = (0.0, 0.0);
    for pair in points[1..].windows(2) {
        let area = area(&points[0], &pair[0], &pair[1]);
        (turned, folded) = (turned + area.max(0.0), folded - area.min(0.0));
    }
    // Written so that areas that are not finite make a fan.
    if !(folded > FOLDED * turned) {
        fan(corners, triangles);
        return true;
    }
    if corners.len() > MAX_CONCAVE {
        return false;
    }
    clip_ears(corners, &points, triangles);
    true
}

fn fan(corners: &[u32], triangles: &mut Vec<[u32; 3]>) {
    if let [first, rest @ ..] = corners {
        triangles.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
    }
}

/// The corners in the plane that shows the most of the polygon, counter-clockwise.
fn flattened(corners: &[u32], vertices: &[Point3<f64>]) -> Vec<Point2<f64>> {
    let at = |i: usize| vertices[corners[i % corners.len()] as usize].coords;
    let origin = at(0);
    let normal: Vector3<f64> = (0..corners.len())
        .map(|i| (at(i) - origin).cross(&(at(i + 1) - origin)))
        .sum();
    let axis = normal.iamax();
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let sign = if normal[axis] < 0.0 { -1.0 } else { 1.0 };
    let flat = |i: usize| Point2::new(at(i)[u] - origin[u], sign * (at(i)[v] - origin[v]));
    (0..corners.len()).map(flat).collect()
}

/// Twice the signed area of a triangle.
fn area(a: &Point2<f64>, b: &Point2<f64>, c: &Point2<f64>) -> f64 {
    (b - a).perp(&(c - a))
}

fn clip_ears(corners: &[u32], points: &[Point2<f64>], triangles: &mut Vec<[u32; 3]>) {
    let mut left: Vec<usize> = (0..corners.len()).collect();
    let mut start = 0;
    while left.len() > 3 {
        let n = left.len();
        let around = |i: usize| [left[(i + n - 1) % n], left[i % n], left[(i + 1) % n]];
        let ear = |on_edge: bool| {
            let is_ear = |i: &usize| is_ear(around(*i), &left, points, on_edge);
            (start..start + n).find(is_ear)
        };
        // A corner may lie on the edge of every ear; a polygon that cuts itself may have no ear at all.
        let Some(ear) = ear(false).or_else(|| ear(true)) else {
            break;
        };
        triangles.push(around(ear).map(|i| corners[i]));
        left.remove(ear % n);
        start = ear % n % left.len();
    }
    let rest: Vec<u32> = left.iter().map(|&i| corners[i]).collect();
    fan(&rest, triangles);
}

/// Whether the triangle of three corners turns left and holds no other one, on its edges neither
/// unless `on_edge`.
fn is_ear([a, b, c]: [usize; 3], left: &[usize], points: &[Point2<f64>], on_edge: bool) -> bool {
    let (pa, pb, pc) = (&points[a], &points[b], &points[c]);
    if area(pa, pb, pc) <= 0.0 {
        return false;
    }
    let beside = |area: f64| if on_edge { area > 0.0 } else { area >= 0.0 };
    let inside = |p| beside(area(pa, pb, p)) && beside(area(pb, pc, p)) && beside(area(pc, pa, p));
    let same = |p: &Point2<f64>| p == pa || p == pb || p == pc;
    !left
        .iter()
        .any(|&i| !same(&points[i]) && inside(&points[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area_of(triangles: &[[u32; 3]], vertices: &[Point3<f64>]) -> Vec<f64> {
        let at = |i: u32| vertices[i as usize];
        triangles
            .iter()
            .map(|&[a, b, c]| (at(b) - at(a)).cross(&(at(c) - at(a))).y / 2.0)
            .collect()
    }

    #[test]
    fn a_star_is_cut_without_lids_over_its_notches() {
        let n = 10_u32;
        let corner = |i: u32| {
            let r = if i.is_multiple_of(2) { 1.0 } else { 0.3 };
            let t = std::f64::consts::TAU * f64::from(i) / f64::from(n);
            Point3::new(r * t.sin(), 0.5, r * t.cos())
        };
        let vertices: Vec<_> = (0..n).map(corner).collect();
        let corners: Vec<u32> = (0..n).collect();
        let mut triangles = Vec::new();
        assert!(cut(&corners, &vertices, &mut triangles));
        assert_eq!(triangles.len(), 8);
        let areas = area_of(&triangles, &vertices);
        // Ten triangles from the middle: half of the product of two sides and the sine between.
        let expected = 5.0 * 0.3 * (std::f64::consts::TAU / 10.0).sin();
        assert!((areas.iter().sum::<f64>() - expected).abs() <= 1e-12);
        assert!(areas.iter().all(|a| *a > 0.0));
    }

    #[test]
    fn convex_polygons_stay_fans_and_long_concave_ones_are_refused() {
        let square = [[0., 0.], [1., 0.], [1., 1.], [0., 1.]].map(|[x, y]| Point3::new(x, y, 0.));
        let mut triangles = Vec::new();
        assert!(cut(&[0, 1, 2, 3], &square, &mut triangles));
        assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
        let zigzag = |i: usize| Point3::new(i as f64, (i % 2) as f64, 0.0);
        let vertices: Vec<_> = (0..MAX_CONCAVE + 1).map(zigzag).collect();
        let corners: Vec<u32> = (0..vertices.len() as u32).collect();
        assert!(!cut(&corners, &vertices, &mut triangles));
    }
}
