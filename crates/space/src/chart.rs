//! Coordinates of contacts: the paper's (θ,φ), and tangent vectors, which have no singularity at
//! the poles.

use nalgebra::Vector2;
use sph::direction::{log, retract, tangent_frame};
use sph::{Direction, SphericalCoords};

/// θ₁, φ₁, …, θ_m, φ_m of a list of directions, radians: the x of Sec. IV-D.
pub fn to_angles(directions: &[Direction]) -> Vec<f64> {
    directions
        .iter()
        .map(SphericalCoords::from_direction)
        .flat_map(|c| [c.theta, c.phi])
        .collect()
}

/// The directions of a list of angles.
///
/// Angles outside [0, π] × [0, 2π) are not wrapped, since p(θ,φ) is defined for all reals. An
/// ascent that steps over a pole (θ < 0 or θ > π) therefore continues along the same great circle
/// on the far side. The paper does not state what it does there; this is our reading.
pub fn from_angles(angles: &[f64]) -> Vec<Direction> {
    angles.chunks_exact(2).map(from_pair).collect()
}

/// The direction of one pair (θ, φ).
pub fn from_pair(pair: &[f64]) -> Direction {
    SphericalCoords {
        theta: pair[0],
        phi: pair[1],
    }
    .direction()
}

/// The direction at tangent coordinates u of p, in the frame of [`tangent_frame`].
pub fn from_tangent(p: &Direction, u: &Vector2<f64>) -> Direction {
    let (e1, e2) = tangent_frame(p);
    retract(p, &(e1 * u.x + e2 * u.y))
}

/// Tangent coordinates at p of a direction q; the inverse of [`from_tangent`].
pub fn to_tangent(p: &Direction, q: &Direction) -> Vector2<f64> {
    let (e1, e2) = tangent_frame(p);
    let v = log(p, q);
    Vector2::new(e1.dot(&v), e2.dot(&v))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sph::direction::{angle, even_directions};

    #[test]
    fn both_charts_come_back() {
        let all = even_directions(50);
        let back = from_angles(&to_angles(&all));
        for (p, q) in all.iter().zip(&back) {
            assert!(angle(p, q) <= 1e-14);
        }
        for q in &all {
            let u = to_tangent(&all[3], q);
            assert!(angle(&from_tangent(&all[3], &u), q) <= 1e-12);
        }
    }

    #[test]
    fn stepping_over_a_pole_goes_on_along_the_great_circle() {
        let over = from_pair(&[-0.1, 0.5]);
        let same = from_pair(&[0.1, 0.5 + std::f64::consts::PI]);
        assert!(angle(&over, &same) <= 1e-15);
    }
}
