//! The gradient of a facet's offset by contact positions, normals and the centre.

use crate::contact_model::ContactModel;
use crate::convention::TorqueLength;
use crate::grasp_model::GraspModel;
use crate::quality::{ActiveFacet, Carrier};
use crate::wrench::WrenchError;
use nalgebra::{UnitVector3, Vector3};

/// How the edges of a cone turn when its normal does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameRule {
    /// By the convention's tangent rule: the derivative of the number that `epsilon` returns.
    Tangent,
    /// By parallel transport, without spin about the normal: the derivative for frames that are
    /// carried along a step. The same for round cones.
    Transported,
}

/// Derivatives by everything a grasp is made of, one entry per contact.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gradient {
    /// By the contact positions (1/length).
    pub positions: Vec<Vector3<f64>>,
    /// By the inward normals: tangent vectors of the sphere at each normal.
    pub normals: Vec<Vector3<f64>>,
    /// By the centre (1/length).
    pub centre: Vector3<f64>,
}

impl Gradient {
    fn reset(&mut self, contacts: usize) {
        self.positions.clear();
        self.positions.resize(contacts, Vector3::zeros());
        self.normals.clear();
        self.normals.resize(contacts, Vector3::zeros());
        self.centre = Vector3::zeros();
    }
}

/// The gradient of a facet's offset, dQ = Σ_j λ_j u·dw_j over its carriers, into `out`.
///
/// With u = (a, b) and g = a + b × r / length, a carrier of force f at arm r = c − z gives
/// f × b / length by its position, minus that by the centre, and by its normal what turning the
/// cone does to g·f. Where Q is the least of several offsets that tie, it has no gradient and every
/// one of the tied facets gives a generalised one.
pub fn facet_gradient(
    model: &GraspModel<'_>,
    facet: &ActiveFacet,
    frame: FrameRule,
    out: &mut Gradient,
) -> Result<(), WrenchError> {
    let length = model.validate()?;
    out.reset(model.contacts.len());
    for carrier in facet.carriers() {
        let by = by_carrier(model, facet, carrier, frame, length);
        out.positions[carrier.contact] += by.position * carrier.weight;
        out.centre -= by.position * carrier.weight;
        out.normals[carrier.contact] += by.normal * carrier.weight;
    }
    if model.convention.torque_length == TorqueLength::MaxContactDistance {
        by_length(model, facet, length, out);
    }
    Ok(())
}

struct ByCarrier {
    position: Vector3<f64>,
    normal: Vector3<f64>,
}

fn by_carrier(
    model: &GraspModel<'_>,
    facet: &ActiveFacet,
    carrier: &Carrier,
    frame: FrameRule,
    length: f64,
) -> ByCarrier {
    let contact = &model.contacts[carrier.contact];
    let n = contact.inward_normal.into_inner();
    let mut arm = contact.position - model.centre;
    let (a, b) = split(&facet.normal);
    let (f, torque) = split(&carrier.wrench);
    let place = place_in_patch(model, carrier, &(torque * length - arm.cross(&f)));
    arm += place;
    let g = a + b.cross(&arm) / length;
    let unit = f.dot(&n);
    let slip = f - n * unit;
    // The part of the torque that no arm explains is torsion about the normal.
    let torsion = (torque - arm.cross(&f) / length).dot(&n);
    let mut normal = g * unit - slip * g.dot(&n) + b * torsion;
    if frame == FrameRule::Tangent {
        let spin = g.dot(&n.cross(&slip));
        normal += spin_of_tangent(model, &contact.inward_normal, spin);
    }
    if place != Vector3::zeros() {
        // The corners of a patch turn with its normal.
        let lever = place.cross(&f.cross(&b)) / length;
        normal += lever.cross(&n);
        if frame == FrameRule::Tangent {
            normal += spin_of_tangent(model, &contact.inward_normal, lever.dot(&n));
        }
    }
    normal -= n * n.dot(&normal);
    ByCarrier {
        position: f.cross(&b) / length,
        normal,
    }
}

/// What `by_spin`, the derivative by a rotation about the normal, adds to the derivative by the normal.
///
/// t comes from the vector e = n (e·n) + t (e·t); turning n by dn spins t by −(e·n)/(e·t) side·dn.
fn spin_of_tangent(
    model: &GraspModel<'_>,
    normal: &UnitVector3<f64>,
    by_spin: f64,
) -> Vector3<f64> {
    let rule = &model.convention.tangent;
    let t = rule.tangent(normal).into_inner();
    let axis = rule.axis(normal);
    let spin = -axis.dot(normal) / axis.dot(&t);
    normal.cross(&t) * (spin * by_spin)
}

/// Where the corner of a patch lies from its contact, from the torque d × f that the arm of the contact
/// does not explain: d is orthogonal to the normal, so (d × f) × n = −d (f·n). Zero for other models.
fn place_in_patch(model: &GraspModel<'_>, carrier: &Carrier, rest: &Vector3<f64>) -> Vector3<f64> {
    let ContactModel::Patch { .. } = model.contact_model(carrier.contact) else {
        return Vector3::zeros();
    };
    let n = &model.contacts[carrier.contact].inward_normal;
    let force = n.x * carrier.wrench[0] + n.y * carrier.wrench[1] + n.z * carrier.wrench[2];
    -rest.cross(n) / force
}

/// The torque length is the arm of the farthest contact: a longer one shrinks all torques.
fn by_length(model: &GraspModel<'_>, facet: &ActiveFacet, length: f64, out: &mut Gradient) {
    let (_, b) = split(&facet.normal);
    let torque: f64 = facet
        .carriers()
        .iter()
        .map(|c| c.weight * b.dot(&split(&c.wrench).1))
        .sum();
    let arm = |i: usize| model.contacts[i].position - model.centre;
    let farthest = (0..model.contacts.len())
        .max_by(|&i, &j| arm(i).norm_squared().total_cmp(&arm(j).norm_squared()));
    if let Some(i) = farthest {
        let by_position = arm(i) * (-torque / (length * length));
        out.positions[i] += by_position;
        out.centre -= by_position;
    }
}

fn split(w: &crate::wrench::Wrench) -> (Vector3<f64>, Vector3<f64>) {
    (
        w.fixed_rows::<3>(0).into_owned(),
        w.fixed_rows::<3>(3).into_owned(),
    )
}
