//! Points of the moduli space and their grasps.

use grasp::{Contact, Grasp};
use nalgebra::Point3;
use shape::Surface;
use sph::Direction;

/// (f, (p₁, …, p_m)) ∈ M × (S²)^m: a surface and directions of contacts (Definition 3.3 of the paper).
#[derive(Clone, Debug)]
pub struct ModuliPoint<S> {
    /// The surface f, in the centred frame.
    pub surface: S,
    /// The directions p₁, …, p_m of the contacts.
    pub directions: Vec<Direction>,
}

impl<S: Surface> ModuliPoint<S> {
    /// g(f, p) = (c₁, …, c_m, n₁, …, n_m, z) with cᵢ = f(pᵢ) and nᵢ the inward normal there.
    ///
    /// The centre z is an argument, since conventions differ on it; see [`crate::Objective`].
    pub fn grasp(&self, centre: Point3<f64>) -> Grasp {
        Grasp {
            contacts: contacts_on(&self.surface, &self.directions),
            centre,
        }
    }
}

/// Positions and inward normals of a surface at given directions.
pub fn contacts_on(surface: &impl Surface, directions: &[Direction]) -> Vec<Contact> {
    directions.iter().map(|p| contact_on(surface, p)).collect()
}

/// Position and inward normal of a surface at one direction.
pub fn contact_on(surface: &impl Surface, p: &Direction) -> Contact {
    let (position, inward_normal) = surface.contact(p);
    Contact {
        position,
        inward_normal,
    }
}
