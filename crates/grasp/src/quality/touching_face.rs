//! The exact point where the largest ball touches the hull of round cones, by Newton's method.
//!
//! There ν u = Σ λ_i p_i with p_i on the ellipsoid of contact i and u·p_i = ν for every contact that
//! takes part. A contact takes part either with its one support point p_i(u), smooth in u, or, where
//! u is orthogonal to its axes, with its whole flat ellipsoid: then p_i = base + Σ m_k/λ_i axis_k with
//! unknown m and the conditions axis_k·u = 0. Minima of Q favour these kinks.

use super::facet::{ActiveFacet, Carrier};
use crate::cone::Cone;
use crate::hull::plane::{V6, add_scaled, dot, norm, scale};
use nalgebra::{SMatrix, SVector};

/// Contacts that can take part at once.
const MOST: usize = 6;
/// Unknowns: u, ν, and for each contact λ and up to three m.
const SIZE: usize = 7 + 2 * MOST;
const STEPS: usize = 20;
/// A mean position inside the ellipsoid, rather than on its rim, means that all of it takes part.
const RIM: f64 = 0.98;

type Unknowns = SVector<f64, SIZE>;

/// A contact that takes part: its cone, where its unknowns begin, and whether all of it does.
#[derive(Clone, Copy, Default)]
struct Part {
    cone: usize,
    first: usize,
    whole: bool,
}

impl Part {
    /// The axes that carry an unknown m, and its place.
    fn unknown_axes<'a>(&self, cone: &'a Cone) -> impl Iterator<Item = (usize, &'a V6)> + use<'a> {
        let axes = if self.whole { 3 } else { 0 };
        let first = self.first + 1;
        let used = cone.axes[..axes].iter().filter(|a| dot(a, a) > 0.0);
        used.enumerate().map(move |(k, axis)| (first + k, axis))
    }
}

struct Face<'a> {
    cones: &'a [Cone],
    parts: [Part; MOST],
    count: usize,
    x: Unknowns,
}

/// The touching point near `facet`, or None where Newton's method does not lead to one.
pub(crate) fn touching_face(cones: &[Cone], facet: &ActiveFacet) -> Option<ActiveFacet> {
    let mut face = Face::near(cones, facet)?;
    for _ in 0..STEPS {
        let step = face.newton_step()?;
        face.x -= step;
        let length = face.x.fixed_rows::<6>(0).norm();
        face.x.fixed_rows_mut::<6>(0).unscale_mut(length);
        if step.norm() <= 1e-11 {
            return face.accept(facet);
        }
    }
    None
}

impl<'a> Face<'a> {
    fn near(cones: &'a [Cone], facet: &ActiveFacet) -> Option<Self> {
        let mut face = Face {
            cones,
            parts: [Part::default(); MOST],
            count: 0,
            x: Unknowns::zeros(),
        };
        face.x.fixed_rows_mut::<6>(0).copy_from(&facet.normal);
        face.x[6] = facet.offset;
        let mut next = 7;
        for at in 0..cones.len() {
            face.take_part(at, facet, &mut next)?;
        }
        Some(face)
    }

    /// Adds the contact of a cone if it carries any of the facet; None if there is no room left.
    fn take_part(&mut self, at: usize, facet: &ActiveFacet, next: &mut usize) -> Option<()> {
        let cone = &self.cones[at];
        let own = |c: &&Carrier| c.contact == cone.contact as usize;
        let carriers = || facet.carriers().iter().filter(own);
        let weight: f64 = carriers().map(|c| c.weight).sum();
        if weight <= 1e-6 {
            return Some(());
        }
        // Σ λ of the carriers' places inside the ellipsoid.
        let place = cone.axes.map(|axis| {
            let square = dot(&axis, &axis).max(f64::MIN_POSITIVE);
            let along = |c: &Carrier| {
                let w: V6 = c.wrench.into();
                c.weight * dot(&add_scaled(&w, -1.0, &cone.base), &axis) / square
            };
            carriers().map(along).sum::<f64>()
        });
        let radius = place.iter().map(|m| m * m).sum::<f64>().sqrt() / weight;
        let part = Part {
            cone: at,
            first: *next,
            whole: radius < RIM,
        };
        let axes = part.unknown_axes(cone).count();
        *next += 1 + axes;
        if *next > SIZE {
            return None;
        }
        *self.parts.get_mut(self.count)? = part;
        self.count += 1;
        self.x[part.first] = weight;
        let used = cone.axes.iter().zip(place).filter(|(a, _)| dot(a, a) > 0.0);
        for ((row, _), (_, m)) in part.unknown_axes(cone).zip(used) {
            self.x[row] = m;
        }
        Some(())
    }

    fn direction(&self) -> V6 {
        std::array::from_fn(|k| self.x[k])
    }

    /// λ times the point with which a contact takes part.
    fn share(&self, part: &Part, u: &V6) -> V6 {
        let cone = &self.cones[part.cone];
        let weight = self.x[part.first];
        if !part.whole {
            return scale(&cone.farthest(u).0, weight);
        }
        part.unknown_axes(cone)
            .fold(scale(&cone.base, weight), |p, (row, axis)| {
                add_scaled(&p, self.x[row], axis)
            })
    }

    fn newton_step(&self) -> Option<Unknowns> {
        let (u, offset) = (self.direction(), self.x[6]);
        let mut jacobian = SMatrix::<f64, SIZE, SIZE>::identity();
        let mut value = Unknowns::zeros();
        for k in 0..6 {
            value[k] = -offset * u[k];
            jacobian[(k, k)] = -offset;
            jacobian[(k, 6)] = -u[k];
            jacobian[(6, k)] = 2.0 * u[k];
        }
        value[6] = dot(&u, &u) - 1.0;
        jacobian[(6, 6)] = 0.0;
        for part in &self.parts[..self.count] {
            let cone = &self.cones[part.cone];
            let share = self.share(part, &u);
            let point = if part.whole {
                cone.base
            } else {
                add_curvature(cone, &u, self.x[part.first], &mut jacobian);
                cone.farthest(&u).0
            };
            let row = part.first;
            value[row] = dot(&point, &u) - offset;
            jacobian[(row, row)] = 0.0;
            jacobian[(row, 6)] = -1.0;
            for k in 0..6 {
                value[k] += share[k];
                jacobian[(k, row)] = point[k];
                jacobian[(row, k)] = point[k];
            }
            for (row, axis) in part.unknown_axes(cone) {
                value[row] = dot(axis, &u);
                jacobian[(row, row)] = 0.0;
                for k in 0..6 {
                    jacobian[(k, row)] = axis[k];
                    jacobian[(row, k)] = axis[k];
                }
            }
        }
        let step = jacobian.lu().solve(&value)?;
        step.iter().all(|x| x.is_finite()).then_some(step)
    }

    /// A stationary point counts if it is near, made of points of the cones, and no cone rises above.
    fn accept(&self, from: &ActiveFacet) -> Option<ActiveFacet> {
        let (u, offset) = (self.direction(), self.x[6]);
        let heights = self.cones.iter().map(|c| c.farthest(&u).1);
        let highest = heights.fold(f64::NEG_INFINITY, f64::max);
        let near = dot(&u, &from.normal.into()) > 0.9;
        let supports = highest <= offset + 1e-12 * norm(&self.cones[0].base).max(1.0);
        let parts = &self.parts[..self.count];
        let convex = parts.iter().all(|part| {
            let weight = self.x[part.first];
            let inside: f64 = part
                .unknown_axes(&self.cones[part.cone])
                .map(|(row, _)| self.x[row] * self.x[row])
                .sum();
            weight > 0.0 && inside.sqrt() <= weight * (1.0 + 1e-9)
        });
        if !(near && supports && convex) {
            return None;
        }
        let carriers = parts.iter().map(|part| {
            let weight = self.x[part.first];
            let point = scale(&self.share(part, &u), 1.0 / weight);
            (self.cones[part.cone].contact as usize, point, weight)
        });
        Some(ActiveFacet::new(offset, &u, carriers))
    }
}

/// Adds weight·∂p/∂u, the second derivative of the support function of an ellipsoid.
fn add_curvature(cone: &Cone, u: &V6, weight: f64, jacobian: &mut SMatrix<f64, SIZE, SIZE>) {
    let (point, height) = cone.farthest(u);
    let rise = height - dot(&cone.base, u);
    if rise <= 0.0 {
        return;
    }
    let factor = weight / rise;
    for i in 0..6 {
        for j in 0..6 {
            let axes: f64 = cone.axes.iter().map(|a| a[i] * a[j]).sum();
            let along = (point[i] - cone.base[i]) * (point[j] - cone.base[j]);
            jacobian[(i, j)] += factor * (axes - along);
        }
    }
}
