//! Clouds of known surfaces.

use nalgebra::{Point3, Vector3};

/// Directions spread evenly over the sphere.
pub(crate) fn directions(count: usize) -> Vec<Vector3<f64>> {
    let angle = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    (0..count)
        .map(|i| {
            let z = (2.0 * i as f64 + 1.0) / count as f64 - 1.0;
            let r = (1.0 - z * z).sqrt();
            let (sin, cos) = (angle * i as f64).sin_cos();
            Vector3::new(r * cos, r * sin, z)
        })
        .collect()
}

/// Points of the unit square, spread evenly.
fn square(count: usize) -> impl Iterator<Item = (f64, f64)> {
    // The plastic number's sequence.
    let step = (0.754_877_666_246_692_7, 0.569_840_290_998_053_2);
    (0..count).map(move |i| ((i as f64 * step.0).fract(), (i as f64 * step.1).fract()))
}

/// The surface r = f(p).
pub(crate) fn blob(count: usize, radius: impl Fn(&Vector3<f64>) -> f64) -> Vec<Point3<f64>> {
    let place = |p: &Vector3<f64>| Point3::from(p * radius(p));
    directions(count).iter().map(place).collect()
}

/// The outside of a union of rods with round ends.
pub(crate) fn branches(density: f64, rods: &[(Point3<f64>, Point3<f64>, f64)]) -> Vec<Point3<f64>> {
    let mut points = Vec::new();
    for (k, (a, b, radius)) in rods.iter().enumerate() {
        let axis = b - a;
        let length = axis.norm();
        let total = std::f64::consts::TAU * radius * (length + 2.0 * radius);
        let (u, v) = frame(&(axis / length));
        for (s, t) in square((density * total) as usize) {
            let height = s * (length + 2.0 * radius) - radius;
            let (sin, cos) = (std::f64::consts::TAU * t).sin_cos();
            // By Archimedes' theorem heights are even on the caps too.
            let beyond = (height - height.clamp(0.0, length)) / radius;
            let across = radius * (1.0 - beyond * beyond).max(0.0).sqrt();
            let p = a + axis * (height / length) + (u * cos + v * sin) * across;
            let inside_another = rods.iter().enumerate().any(|(j, (c, d, r))| {
                let along = ((p - c).dot(&(d - c)) / (d - c).norm_squared()).clamp(0.0, 1.0);
                j != k && (p - (c + (d - c) * along)).norm() < *r
            });
            if !inside_another {
                points.push(p);
            }
        }
    }
    points
}

fn frame(n: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    let axis = if n.x.abs() < 0.6 {
        Vector3::x()
    } else {
        Vector3::y()
    };
    let u = n.cross(&axis).normalize();
    (u, n.cross(&u))
}

/// Half a sphere of radius 1 with a wall of the given thickness and a round rim.
pub(crate) fn cup(count: usize, thickness: f64) -> Vec<Point3<f64>> {
    let mut points = Vec::new();
    for radius in [1.0, 1.0 - thickness] {
        let n = (2.0 * count as f64 * radius * radius) as usize;
        let below = directions(n).into_iter().filter(|p| p.z < 0.0);
        points.extend(below.map(|p| Point3::from(p * radius)));
    }
    let rim = (count as f64 * 0.5 * thickness) as usize;
    for (s, t) in square(rim) {
        let (sin, cos) = (std::f64::consts::TAU * t).sin_cos();
        let (up, out) = (std::f64::consts::PI * s).sin_cos();
        let r = 1.0 - 0.5 * thickness + 0.5 * thickness * out;
        points.push(Point3::new(r * cos, r * sin, 0.5 * thickness * up));
    }
    points
}

/// A torus about z.
pub(crate) fn torus(count: usize, large: f64, small: f64) -> Vec<Point3<f64>> {
    square(count)
        .filter_map(|(s, t)| {
            let (sin, cos) = (std::f64::consts::TAU * s).sin_cos();
            // Fewer points on the inner half, by area.
            let keep = (large + small * cos) / (large + small);
            let kept = (s * 1e4).fract() < keep;
            let (y, x) = (std::f64::consts::TAU * t).sin_cos();
            let r = large + small * cos;
            kept.then(|| Point3::new(r * x, r * y, small * sin))
        })
        .collect()
}
