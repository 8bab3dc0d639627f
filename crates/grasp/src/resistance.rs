//! Wrench resistance: contact forces inside the cones that hold an external wrench.

use crate::cone::Cone;
use crate::convention::Edges;
use crate::friction::angle;
use crate::grasp_model::GraspModel;
use crate::hull::plane::{V6, dot};
use crate::linear::{Outcome, Programme};
use crate::wrench::{Wrench, WrenchError};
use nalgebra::Vector3;

/// How a grasp meets an external wrench.
#[derive(Clone, Debug, PartialEq)]
pub enum Resistance {
    /// The forces that hold it with the least largest normal force.
    Holds {
        /// The force of each contact on the object.
        forces: Vec<Vector3<f64>>,
        /// The torsional moment of each contact about its normal (soft fingers).
        torsions: Vec<f64>,
        /// The largest normal force among the contacts.
        largest_normal_force: f64,
        /// No forces can do with less than this.
        bound: f64,
    },
    /// No forces inside the cones hold it.
    Fails {
        /// A unit direction in which the external wrench pushes and no contact can push back:
        /// direction·external > 0 and −direction·w ≤ 0 for every wrench w of the cones.
        proof: Wrench,
    },
}

const ROUNDS: usize = 60;

/// Finds contact forces with Σ wrench(f_i) + external = 0, each in its cone.
///
/// `external` is (force, torque/length) in the convention's torque length. Polygonal cones give the
/// exact optimum of a linear programme; round cones add the wrench that the multipliers ask for until
/// the optimum is certain to a relative 1e-9 (or to what 60 rounds reach: see `bound`).
pub fn resist(model: &GraspModel<'_>, external: &Wrench) -> Result<Resistance, WrenchError> {
    let length = model.validate()?;
    let contacts = model.contacts.len();
    let cones: Vec<Cone> = (0..contacts)
        .flat_map(|i| Cone::all(model, i, length))
        .collect();
    let scales: Vec<f64> = (0..contacts).map(|i| model.edge_scale(i)).collect();
    let (count, mut rounds) = match model.convention.edges {
        Edges::Polygon(count) => (count, 1),
        Edges::Round { .. } => (8, ROUNDS),
    };
    let mut columns = corners(&cones, count);
    loop {
        rounds -= 1;
        let outcome = programme(&columns, &scales, external).solve();
        let (multipliers, optimum) = match &outcome {
            Outcome::Optimal { multipliers, .. } => (multipliers, true),
            Outcome::Infeasible { certificate } => (certificate, false),
            Outcome::Unbounded => return Ok(fails(&[0.0; 6])),
        };
        let shortfall = match model.convention.edges {
            Edges::Polygon(_) => 0.0,
            Edges::Round { .. } => price(&cones, &scales, multipliers, &mut columns, optimum),
        };
        if shortfall > 1e-9 && rounds > 0 {
            continue;
        }
        return Ok(match outcome {
            // Scaling the multipliers down until they price every wrench right keeps them a proof.
            Outcome::Optimal { x, value, .. } => {
                let bound = value / (1.0 + shortfall);
                holds(model, &columns, &x, value, bound, length)
            }
            Outcome::Infeasible { certificate } => fails(&certificate),
            Outcome::Unbounded => fails(&[0.0; 6]),
        });
    }
}

fn fails(certificate: &[f64]) -> Resistance {
    let proof = Wrench::from_fn(|k, _| -certificate[k]);
    Resistance::Fails {
        proof: proof.try_normalize(0.0).unwrap_or(proof),
    }
}

/// The corners of all inscribed pyramids, each with its contact.
fn corners(cones: &[Cone], count: usize) -> Vec<(usize, V6)> {
    let circle: Vec<(f64, f64)> = (0..count)
        .map(|j| {
            let (sin, cos) = angle(j, count).sin_cos();
            (cos, sin)
        })
        .collect();
    let mut columns = Vec::new();
    for cone in cones {
        let i = cone.contact as usize;
        columns.extend(cone.corners(&circle).map(|w| (i, w)));
    }
    columns
}

/// min t with Σ α_c w_c = −external and Σ_{c of i} α_c scale_i + slack_i = t for every contact i.
fn programme(columns: &[(usize, V6)], scales: &[f64], external: &Wrench) -> Programme {
    let (n, m) = (columns.len(), scales.len());
    let mut rows: Vec<Vec<f64>> = (0..6)
        .map(|k| {
            let mut row: Vec<f64> = columns.iter().map(|(_, w)| w[k]).collect();
            row.resize(n + m + 1, 0.0);
            row
        })
        .collect();
    for (i, scale) in scales.iter().enumerate() {
        let mut row: Vec<f64> = columns
            .iter()
            .map(|(owner, _)| if *owner == i { *scale } else { 0.0 })
            .collect();
        row.resize(n + m + 1, 0.0);
        row[n + i] = 1.0;
        row[n + m] = -1.0;
        rows.push(row);
    }
    let mut right: Vec<f64> = external.iter().map(|x| -x).collect();
    right.resize(6 + m, 0.0);
    let mut cost = vec![0.0; n + m + 1];
    cost[n + m] = 1.0;
    Programme { rows, right, cost }
}

/// Adds the wrench of each cone that the multipliers undervalue; returns the largest undervaluation.
///
/// For an optimum it is measured relative to the contact's own multiplier.
fn price(
    cones: &[Cone],
    scales: &[f64],
    multipliers: &[f64],
    columns: &mut Vec<(usize, V6)>,
    optimum: bool,
) -> f64 {
    let y: V6 = std::array::from_fn(|k| multipliers[k]);
    let size = dot(&y, &y).sqrt().max(f64::MIN_POSITIVE);
    let mut worst: f64 = 0.0;
    for cone in cones {
        let i = cone.contact as usize;
        let (point, height) = cone.farthest(&y);
        // A column of contact i is priced right when y·w ≤ −scale·z_i with z_i ≤ 0 its multiplier.
        let allowed = -scales[i] * multipliers[6 + i];
        let excess = height - allowed;
        let relative = if optimum && allowed > 1e-12 * size {
            excess / allowed
        } else {
            excess / size
        };
        if relative > 1e-9 {
            columns.push((i, point));
            worst = worst.max(relative);
        }
    }
    worst
}

fn holds(
    model: &GraspModel<'_>,
    columns: &[(usize, V6)],
    x: &[f64],
    value: f64,
    bound: f64,
    length: f64,
) -> Resistance {
    let contacts = model.contacts.len();
    let mut forces = vec![Vector3::zeros(); contacts];
    let mut torques = vec![Vector3::zeros(); contacts];
    for ((owner, w), &share) in columns.iter().zip(x) {
        forces[*owner] += Vector3::new(w[0], w[1], w[2]) * share;
        torques[*owner] += Vector3::new(w[3], w[4], w[5]) * (share * length);
    }
    let torsions = (0..contacts)
        .map(|i| {
            let contact = &model.contacts[i];
            let arm = contact.position - model.centre;
            (torques[i] - arm.cross(&forces[i])).dot(&contact.inward_normal)
        })
        .collect();
    Resistance::Holds {
        forces,
        torsions,
        largest_normal_force: value,
        bound,
    }
}
