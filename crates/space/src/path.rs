//! The curve γ = (u, v) between two points of the moduli space (Sec. III-C).

use shape::RadialShape;
use shape::algebra::{SpaceError, deformation};
use sph::Direction;
use sph::direction::geodesic;

use crate::point::ModuliPoint;

/// Shapes along the straight line u(t) = (1−t)f + tf′, contacts along great circles.
#[derive(Clone, Copy, Debug)]
pub struct Path<'a> {
    /// γ(0).
    pub from: &'a ModuliPoint<RadialShape>,
    /// γ(1); as many contacts as γ(0).
    pub to: &'a ModuliPoint<RadialShape>,
}

impl Path<'_> {
    /// γ(t), t ∈ [0, 1]. It is in M^rad × (S²)^m by Lemma 3.2. Extra contacts of the longer end
    /// are left out.
    pub fn at(&self, t: f64) -> Result<ModuliPoint<RadialShape>, SpaceError> {
        let contacts: Vec<Direction> = self
            .from
            .contacts
            .iter()
            .zip(&self.to.contacts)
            .map(|(p, q)| geodesic(p, q, t))
            .collect();
        Ok(ModuliPoint {
            surface: deformation(&self.from.surface, &self.to.surface, t)?,
            contacts,
        })
    }
}
