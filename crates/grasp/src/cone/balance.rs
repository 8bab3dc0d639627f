//! Even weights of a touching face: where they are not unique, the least sum of squares.
//!
//! In a symmetric grasp more contacts touch a plane than its face needs. A proof around the face's
//! direction gains from all of them, so the weights are shared out: of all x with C x = r, where the
//! columns of C are the points that touch (and the axes of ellipsoids that lie in the plane) and r is
//! ν u with the sum of weights below it, x = Cᵀ (C Cᵀ)⁻¹ r is the shortest.

use super::Cone;
use crate::hull::cap::{MOST_PARTS, Part, Touching};
use crate::hull::plane::{add_scaled, dot, norm, scale};

/// Contacts within this of the plane touch it, and slopes below it belong to a flat ellipsoid,
/// relative to the longest wrench.
const TOUCHES: f64 = 1e-9;
/// Keeps dependent rows solvable, relative to the trace.
const REGULAR: f64 = 1e-13;

type V7 = [f64; 7];

#[derive(Clone, Copy, Default)]
struct Column {
    part: usize,
    /// The axis, or the point itself.
    axis: Option<usize>,
    value: V7,
}

/// The same face with weights as even as they can be; None where that has no convex solution.
pub(super) fn balanced(cones: &[Cone], face: &Touching) -> Option<Touching> {
    let u = face.direction;
    let unit = cones.iter().map(Cone::reach).fold(0.0, f64::max);
    let mut touching = [usize::MAX; MOST_PARTS];
    let mut count = 0;
    for (at, cone) in cones.iter().enumerate() {
        let rise = cone.farthest(&u).1 - face.offset;
        if rise.abs() <= TOUCHES * unit {
            *touching.get_mut(count)? = at;
            count += 1;
        }
    }
    let mut goal = [0.0; 7];
    goal[..6].copy_from_slice(&scale(&u, face.offset));
    goal[6] = unit;
    loop {
        let mut columns = [Column::default(); 4 * MOST_PARTS];
        let mut used = 0;
        for (part, &at) in touching[..count].iter().enumerate() {
            used = add_columns(&cones[at], part, &u, unit, &mut columns, used);
        }
        let columns = &columns[..used];
        let x = shortest(columns, &goal)?;
        let worst = (0..used)
            .filter(|&k| columns[k].axis.is_none())
            .min_by(|&a, &b| x[a].total_cmp(&x[b]))?;
        if x[worst] <= 0.0 {
            let part = columns[worst].part;
            touching.copy_within(part + 1..count, part);
            count -= 1;
            if count == 0 {
                return None;
            }
            continue;
        }
        return assemble(cones, face, &touching[..count], columns, &x);
    }
}

/// The columns of one contact: its point, or its base and axes where it lies flat in the plane.
fn add_columns(
    cone: &Cone,
    part: usize,
    u: &[f64; 6],
    unit: f64,
    columns: &mut [Column],
    mut used: usize,
) -> usize {
    let slopes = cone.axes.map(|axis| dot(&axis, u));
    let flat = norm(&[slopes[0], slopes[1], slopes[2], 0.0, 0.0, 0.0]) <= TOUCHES * unit;
    let mut push = |axis: Option<usize>, vector: &[f64; 6], below: f64| {
        let mut value = [0.0; 7];
        value[..6].copy_from_slice(vector);
        value[6] = below;
        columns[used] = Column { part, axis, value };
        used += 1;
    };
    if flat {
        push(None, &cone.base, unit);
        for (k, axis) in cone.axes.iter().enumerate() {
            if dot(axis, axis) > 0.0 {
                push(Some(k), axis, 0.0);
            }
        }
    } else {
        push(None, &cone.farthest(u).0, unit);
    }
    used
}

/// x = Cᵀ (C Cᵀ)⁻¹ goal, refined; None if it does not solve C x = goal.
fn shortest(columns: &[Column], goal: &V7) -> Option<[f64; 4 * MOST_PARTS]> {
    let mut gram = nalgebra::SMatrix::<f64, 7, 7>::zeros();
    for column in columns {
        let v = nalgebra::SVector::<f64, 7>::from(column.value);
        gram += v * v.transpose();
    }
    let trace = gram.trace();
    for k in 0..7 {
        gram[(k, k)] += REGULAR * trace;
    }
    let factor = gram.cholesky()?;
    let goal = nalgebra::SVector::<f64, 7>::from(*goal);
    let mut x = [0.0; 4 * MOST_PARTS];
    let mut rest = goal;
    for _ in 0..3 {
        let y = factor.solve(&rest);
        rest = goal;
        for (x, column) in x.iter_mut().zip(columns) {
            let v = nalgebra::SVector::<f64, 7>::from(column.value);
            *x += v.dot(&y);
            rest -= v * *x;
        }
    }
    (rest.norm() <= TOUCHES * goal.norm()).then_some(x)
}

fn assemble(
    cones: &[Cone],
    face: &Touching,
    touching: &[usize],
    columns: &[Column],
    x: &[f64],
) -> Option<Touching> {
    let mut parts = [Part::default(); MOST_PARTS];
    for (part, &at) in parts.iter_mut().zip(touching) {
        part.cone = at;
        part.place = cones[at].place(&face.direction);
    }
    let mut total = 0.0;
    for (column, &x) in columns.iter().zip(x) {
        let part = &mut parts[column.part];
        match column.axis {
            None => {
                part.weight = x;
                total += x;
            }
            Some(k) => {
                if k == 0 {
                    part.place = [0.0; 3];
                }
                part.place[k] = x / part.weight;
            }
        }
    }
    for part in &mut parts[..touching.len()] {
        part.weight /= total;
        let length = part.place.iter().map(|m| m * m).sum::<f64>().sqrt();
        if length > 1.0 + 1e-9 {
            return None;
        }
        if length > 1.0 {
            part.place.iter_mut().for_each(|m| *m /= length);
        }
    }
    let point = parts[..touching.len()].iter().fold([0.0; 6], |s, part| {
        add_scaled(&s, part.weight, &cones[part.cone].at(&part.place))
    });
    Some(Touching {
        direction: face.direction,
        offset: dot(&point, &face.direction),
        parts,
        count: touching.len(),
    })
}
