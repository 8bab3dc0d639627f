//! A solid's surface seen from an interior point: its centre, area and area-uniform random points.

use crate::solid::{Hit, Solid};
use nalgebra::{Point3, Vector3};
use rand::{Rng, RngExt};

/// Squares along one side of a cube face in the coarse chart, which is used to find the centre.
const COARSE: usize = 12;
/// Squares along one side of a cube face in the fine chart, from which points are sampled.
const FINE: usize = 40;

/// Triangles that approximate the surface closely enough to propose random points on it.
///
/// Directions are spread over the six faces of a cube that is stretched like the object, so that
/// the triangles are of similar size on elongated objects too.
#[derive(Clone, Debug)]
pub(crate) struct Chart {
    /// Mean of the surface over its area.
    pub(crate) centre: Point3<f64>,
    /// Area of the surface, m².
    pub(crate) area: f64,
    viewpoint: Point3<f64>,
    /// Corners relative to the viewpoint.
    triangles: Vec<Triangle>,
    /// Running sum of triangle area × bound.
    cumulative: Vec<f64>,
}

#[derive(Clone, Debug)]
struct Triangle {
    corners: [Vector3<f64>; 3],
    /// Twice the area times the unit normal.
    normal: Vector3<f64>,
    /// Upper bound of the ratio of true area to triangle area that the sampling assumes.
    bound: f64,
}

impl Triangle {
    fn area(&self) -> f64 {
        0.5 * self.normal.norm()
    }

    /// Distance of the triangle's plane from the viewpoint times twice the area.
    fn reach(&self) -> f64 {
        self.normal.dot(&self.corners[0])
    }

    /// dA(surface) / dA(triangle) along the ray through q, a point of the triangle.
    ///
    /// Both area elements are ρ²/cos(incidence) dω.
    fn stretch(&self, q: &Vector3<f64>, hit: &Hit) -> f64 {
        let ray = q.norm();
        let on_surface = hit.distance.powi(2) / hit.normal.dot(&(q / ray));
        let on_triangle = ray.powi(3) * self.normal.norm() / self.reach();
        on_surface / on_triangle
    }
}

impl Chart {
    /// Charts the surface of a solid around an interior point.
    ///
    /// Costs about 10,000 ray casts.
    pub(crate) fn new(solid: &Solid, inside: Point3<f64>) -> Self {
        let coarse = Self::cast(solid, inside, &Vector3::repeat(1.0), COARSE);
        let mut half = Vector3::zeros();
        for corner in coarse.triangles.iter().flat_map(|t| t.corners) {
            half = half.sup(&corner.abs());
        }
        Self::cast(solid, coarse.centre, &half, FINE)
    }

    fn cast(solid: &Solid, viewpoint: Point3<f64>, half: &Vector3<f64>, squares: usize) -> Self {
        let mut triangles = Vec::with_capacity(12 * squares * squares);
        let (mut area, mut moment) = (0.0, Vector3::zeros());
        let side = squares + 1;
        for face in 0..6 {
            let hits: Vec<Hit> = (0..side * side)
                .map(|k| {
                    let cube = cube_point(face, k % side, k / side, squares);
                    let direction = cube.component_mul(half).normalize();
                    solid.leave(&viewpoint, &direction, half.min())
                })
                .collect();
            for (row, column) in (0..squares).flat_map(|r| (0..squares).map(move |c| (r, c))) {
                let k = row * side + column;
                for corners in [[k, k + 1, k + side + 1], [k, k + side + 1, k + side]] {
                    let (triangle, stretch) = span(&corners.map(|i| hits[i]), &viewpoint);
                    for (corner, ratio) in triangle.corners.iter().zip(stretch) {
                        let share = triangle.area() * ratio / 3.0;
                        area += share;
                        moment += corner * share;
                    }
                    triangles.push(triangle);
                }
            }
        }
        let mut sum = 0.0;
        let cumulative = triangles
            .iter()
            .map(|t| {
                sum += t.area() * t.bound;
                sum
            })
            .collect();
        Self {
            centre: viewpoint + moment / area,
            area,
            viewpoint,
            triangles,
            cumulative,
        }
    }

    /// One random point of the true surface, uniform by area, and the outward unit normal there.
    ///
    /// A point of a random triangle is proposed, projected along its ray onto the surface, and
    /// accepted in proportion to the ratio of the area elements. The density is exact wherever that
    /// ratio is below the triangle's bound.
    pub(crate) fn sample(&self, solid: &Solid, rng: &mut impl Rng) -> Hit {
        loop {
            let (q, triangle) = self.propose(rng);
            let ray = q.norm();
            let hit = solid.leave(&self.viewpoint, &(q / ray), ray);
            if rng.random::<f64>() * triangle.bound < triangle.stretch(&q, &hit) {
                return hit;
            }
        }
    }

    /// A uniform point of a triangle chosen by area × bound, relative to the viewpoint.
    fn propose(&self, rng: &mut impl Rng) -> (Vector3<f64>, &Triangle) {
        let last = self.cumulative.len() - 1;
        let level = rng.random::<f64>() * self.cumulative[last];
        let index = self.cumulative.partition_point(|&sum| sum <= level);
        let triangle = &self.triangles[index.min(last)];
        let (mut u, mut v) = (rng.random::<f64>(), rng.random::<f64>());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let [a, b, c] = triangle.corners;
        (a + (b - a) * u + (c - a) * v, triangle)
    }
}

/// The triangle between three hits, with its area ratios at the corners.
fn span(hits: &[Hit; 3], viewpoint: &Point3<f64>) -> (Triangle, [f64; 3]) {
    let corners = hits.map(|hit| hit.point - viewpoint);
    let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
    let mut triangle = Triangle {
        corners,
        normal,
        bound: 1.0,
    };
    let stretch = [0, 1, 2].map(|i| triangle.stretch(&corners[i], &hits[i]));
    let bend = stretch.iter().fold(1.0f64, |m, s| m.max(*s).max(1.0 / s));
    // Between the corners the ratio can exceed its corner values if an edge of the solid crosses
    // the triangle.
    triangle.bound = 1.1 * bend * bend;
    (triangle, stretch)
}

/// Grid point (i, j) of a face of the cube [−1, 1]³; faces are numbered +x −x +y −y +z −z.
///
/// The grid is uniform in angle, and every face is anticlockwise seen from outside.
fn cube_point(face: usize, i: usize, j: usize, squares: usize) -> Vector3<f64> {
    let spread = |k: usize| {
        let angle = std::f64::consts::FRAC_PI_2 * (k as f64 / squares as f64 - 0.5);
        angle.tan()
    };
    let (u, v) = (spread(i), spread(j));
    match face {
        0 => Vector3::new(1.0, u, v),
        1 => Vector3::new(-1.0, v, u),
        2 => Vector3::new(v, 1.0, u),
        3 => Vector3::new(u, -1.0, v),
        4 => Vector3::new(u, v, 1.0),
        _ => Vector3::new(v, u, -1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use std::f64::consts::PI;

    #[test]
    fn area_and_centre_of_a_ball() {
        let ball = Solid::ball(0.04).at(0.01, 0.0, 0.04);
        let chart = Chart::new(&ball, Point3::new(0.0, 0.005, 0.045));
        assert!((chart.area / (4.0 * PI * 0.04f64.powi(2)) - 1.0).abs() <= 1e-3);
        assert!((chart.centre - Point3::new(0.01, 0.0, 0.04)).norm() <= 1e-5);
    }

    #[test]
    fn triangles_face_outwards() {
        let ball = Solid::ball(0.04);
        let chart = Chart::new(&ball, Point3::origin());
        assert!(chart.triangles.len() == 12 * FINE * FINE);
        assert!(chart.triangles.iter().all(|t| t.reach() > 0.0));
    }

    #[test]
    fn hardly_any_area_lies_above_its_bound() {
        for object in crate::library_objects()
            .iter()
            .chain(crate::unseen_objects())
        {
            let chart = object.chart();
            let mut rng = ChaCha8Rng::seed_from_u64(1);
            let (mut kept, mut lost) = (0.0, 0.0);
            for _ in 0..20_000 {
                let (q, triangle) = chart.propose(&mut rng);
                let hit = object
                    .solid()
                    .leave(&chart.viewpoint, &q.normalize(), q.norm());
                let ratio = triangle.stretch(&q, &hit) / triangle.bound;
                kept += ratio.min(1.0);
                lost += (ratio - 1.0).max(0.0);
            }
            assert!(lost <= 2e-3 * kept, "{}: {}", object.id, lost / kept);
            assert!(kept >= 0.5 * 20_000.0, "{}: {}", object.id, kept / 2e4);
        }
    }
}
