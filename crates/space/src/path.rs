//! The curve γ = (u, v) between two points of the moduli space (Sec. III-C).

use shape::RadialShape;
use shape::algebra::{SpaceError, deformation};
use sph::Direction;
use sph::direction::geodesic;

use crate::point::ModuliPoint;

/// Shapes along the straight line u(t) = (1−t)f + tf′, contacts along great circles.
///
/// ```
/// use shape::RadialShape;
/// use space::{ModuliPoint, Path};
///
/// // Half-way between balls of 3 and 5 cm is the ball of 4 cm.
/// let ball = |radius| RadialShape::sphere(4, radius);
/// let small = ModuliPoint { surface: ball(0.03)?, directions: vec![] };
/// let large = ModuliPoint { surface: ball(0.05)?, directions: vec![] };
/// let middle = Path { from: &small, to: &large }.at(0.5)?;
/// let (least, largest) = middle.surface.radius_bounds();
/// assert!((least - 0.04).abs() < 1e-6 && (largest - 0.04).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Path<'a> {
    /// The start γ(0).
    pub from: &'a ModuliPoint<RadialShape>,
    /// The end γ(1); it has as many contacts as γ(0).
    pub to: &'a ModuliPoint<RadialShape>,
}

impl Path<'_> {
    /// γ(t), t ∈ [0, 1]. It is in M^rad × (S²)^m by Lemma 3.2. If one end has more contacts than
    /// the other, the extra ones are left out.
    ///
    /// # Errors
    /// The shapes cannot be combined.
    pub fn at(&self, t: f64) -> Result<ModuliPoint<RadialShape>, SpaceError> {
        let directions: Vec<Direction> = self
            .from
            .directions
            .iter()
            .zip(&self.to.directions)
            .map(|(p, q)| geodesic(p, q, t))
            .collect();
        Ok(ModuliPoint {
            surface: deformation(&self.from.surface, &self.to.surface, t)?,
            directions,
        })
    }
}
