//! The exact point where the largest ball touches the hull of round cones, by Newton's method.
//!
//! There ν u = Σ λ_i p_i(u), with p_i(u) the support point of contact i and h_i(u) = u·p_i(u) = ν for
//! every contact that takes part. Support points are smooth in u, so a start from an inner facet
//! converges in a few steps.

use super::margin::{ActiveFacet, Carrier};
use crate::finger::Cone;
use crate::hull::plane::{V6, dot, norm, scale};
use nalgebra::{SMatrix, SVector};

/// Contacts that can take part at once.
const MOST: usize = 6;
/// Unknowns: u, ν and one λ a contact.
const SIZE: usize = 7 + MOST;
const STEPS: usize = 20;

/// The touching point near `facet`, or None where Newton's method does not lead to one.
pub(crate) fn touching_face(cones: &[Cone], facet: &ActiveFacet) -> Option<ActiveFacet> {
    let mut active = [(0, 0.0); MOST];
    let mut count = 0;
    for (at, cone) in cones.iter().enumerate() {
        let own = |c: &&Carrier| c.contact == cone.contact as usize;
        let weight: f64 = facet.carriers().iter().filter(own).map(|c| c.weight).sum();
        if weight > 1e-6 {
            *active.get_mut(count)? = (at, weight);
            count += 1;
        }
    }
    let active = &mut active[..count];
    let (mut u, mut offset): (V6, f64) = (facet.normal.into(), facet.offset);
    for _ in 0..STEPS {
        let step = newton_step(cones, active, &u, offset)?;
        for (k, x) in u.iter_mut().enumerate() {
            *x -= step[k];
        }
        u = scale(&u, 1.0 / norm(&u));
        offset -= step[6];
        for (i, (_, weight)) in active.iter_mut().enumerate() {
            *weight -= step[7 + i];
        }
        eprintln!("n {count} off {offset} step {:e} w {:?} facet {}", step.norm(), active, facet.offset);
        if step.norm() <= 1e-12 {
            return accept(cones, active, &u, offset, facet);
        }
    }
    None
}

/// A stationary point counts if it is near, convex, and no cone rises above it.
fn accept(
    cones: &[Cone],
    active: &[(usize, f64)],
    u: &V6,
    offset: f64,
    from: &ActiveFacet,
) -> Option<ActiveFacet> {
    let highest = cones
        .iter()
        .map(|c| c.farthest(u).1)
        .fold(f64::NEG_INFINITY, f64::max);
    let near = dot(u, &from.normal.into()) > 0.9;
    let convex = active.iter().all(|&(_, weight)| weight >= -1e-9);
    let supports = highest <= offset + 1e-12 * highest.abs().max(1.0);
    eprintln!("{near} {convex} {supports} {highest} {offset}");
    if !(near && convex && supports) {
        return None;
    }
    let carriers = active.iter().map(|&(at, weight)| {
        let cone = &cones[at];
        (cone.contact as usize, cone.farthest(u).0, weight)
    });
    Some(ActiveFacet::new(offset, u, carriers))
}

fn newton_step(
    cones: &[Cone],
    active: &[(usize, f64)],
    u: &V6,
    offset: f64,
) -> Option<SVector<f64, SIZE>> {
    let mut jacobian = SMatrix::<f64, SIZE, SIZE>::identity();
    let mut value = SVector::<f64, SIZE>::zeros();
    for k in 0..6 {
        value[k] = -offset * u[k];
        jacobian[(k, k)] = -offset;
        jacobian[(k, 6)] = -u[k];
        jacobian[(6, k)] = 2.0 * u[k];
    }
    value[6] = dot(u, u) - 1.0;
    jacobian[(6, 6)] = 0.0;
    for (i, &(at, weight)) in active.iter().enumerate() {
        let cone = &cones[at];
        let (point, height) = cone.farthest(u);
        let row = 7 + i;
        value[row] = height - offset;
        jacobian[(row, row)] = 0.0;
        jacobian[(row, 6)] = -1.0;
        for k in 0..6 {
            value[k] += weight * point[k];
            jacobian[(k, row)] = point[k];
            jacobian[(row, k)] = point[k];
        }
        add_curvature(cone, &point, u, weight, &mut jacobian);
    }
    jacobian
        .lu()
        .solve(&value)
        .filter(|s| s.iter().all(|x| x.is_finite()))
}

/// Adds weight·∂p/∂u, the second derivative of the support function of an ellipsoid.
fn add_curvature(
    cone: &Cone,
    point: &V6,
    u: &V6,
    weight: f64,
    jacobian: &mut SMatrix<f64, SIZE, SIZE>,
) {
    let rise = dot(point, u) - dot(&cone.base, u);
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
