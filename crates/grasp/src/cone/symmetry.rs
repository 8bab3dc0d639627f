//! The symmetries of a grasp: rotations and reflections about the centre that permute its contacts.
//!
//! An orthogonal matrix R of R³ takes a force f at an arm c to R f at R c, and the torque c × f to
//! det R · R (c × f). Round cones have no direction of their own, so the wrenches of a contact become
//! exactly those of its image.

use super::Cone;
use crate::hull::plane::V6;
use crate::hull::support::{SpaceMap, Symmetries};
use nalgebra::{Matrix3, Vector3};

/// Contacts further than this from their images, relative to their size, are not symmetric.
const APART: f64 = 1e-11;
/// More maps than this are not looked for.
const MOST: usize = 200;

/// See [`crate::hull::support::Support::symmetries`].
pub(super) fn symmetries(cones: &[Cone], out: &mut Symmetries) {
    out.maps.clear();
    out.error = 0.0;
    if cones.len() > 16 {
        return;
    }
    let size = cones.iter().map(|c| c.arm.norm()).fold(0.0, f64::max);
    let Some(frame) = Frame::of(cones, size) else {
        return;
    };
    let mut maps = std::mem::take(&mut out.found);
    maps.clear();
    for first in 0..cones.len() {
        for second in 0..cones.len() {
            for sign in [1.0, -1.0] {
                let map = frame.onto(cones, first, second, sign);
                let Some(map) = map.and_then(|m| permutes(cones, m, size, &mut out.error)) else {
                    continue;
                };
                if maps.len() < MOST && !maps.iter().any(|m| same(m, &map)) {
                    maps.push(map);
                }
            }
        }
    }
    if is_group(&maps, cones.len()) {
        let moves = |m: &&SpaceMap| (m.matrix - Matrix3::identity()).norm() > 1e-6;
        let moving = maps.iter().filter(moves);
        out.maps.extend(moving.map(|m| on_wrenches(&m.matrix)));
    }
    out.found = maps;
}

/// Two vectors that belong to two contacts (or one) and span a plane.
struct Frame {
    /// The contacts, and whether the arm or the normal.
    of: [(usize, bool); 2],
    basis: Matrix3<f64>,
}

fn vector(cone: &Cone, arm: bool, size: f64) -> Vector3<f64> {
    if arm { cone.arm / size } else { cone.normal }
}

fn basis(x: Vector3<f64>, y: Vector3<f64>, sign: f64) -> Option<Matrix3<f64>> {
    let x = x.try_normalize(1e-3)?;
    let y = (y - x * x.dot(&y)).try_normalize(1e-3)?;
    Some(Matrix3::from_columns(&[x, y, x.cross(&y) * sign]))
}

impl Frame {
    fn of(cones: &[Cone], size: f64) -> Option<Self> {
        let kinds = [(0, false), (0, true)];
        let others = (0..cones.len()).flat_map(|k| [(k, false), (k, true)]);
        for one in kinds {
            for other in others.clone() {
                let x = vector(&cones[one.0], one.1, size);
                let y = vector(&cones[other.0], other.1, size);
                if let Some(basis) = basis(x, y, 1.0) {
                    return Some(Frame {
                        of: [one, other],
                        basis,
                    });
                }
            }
        }
        None
    }

    fn onto(&self, cones: &[Cone], first: usize, second: usize, sign: f64) -> Option<Matrix3<f64>> {
        let size = cones.iter().map(|c| c.arm.norm()).fold(0.0, f64::max);
        let [one, other] = self.of;
        if (one.0 == other.0) != (first == second) {
            return None;
        }
        let x = vector(&cones[first], one.1, size);
        let y = vector(&cones[second], other.1, size);
        let from = vector(&cones[one.0], one.1, size).dot(&vector(&cones[other.0], other.1, size));
        if (x.dot(&y) - from).abs() > 1e-9 {
            return None;
        }
        Some(basis(x, y, sign)? * self.basis.transpose())
    }
}

/// The permutation of the contacts that a matrix makes, if it makes one.
fn permutes(cones: &[Cone], matrix: Matrix3<f64>, size: f64, error: &mut f64) -> Option<SpaceMap> {
    let mut image = [u8::MAX; 16];
    let mut worst = 0.0_f64;
    for (at, cone) in cones.iter().enumerate() {
        let (arm, normal) = (matrix * cone.arm, matrix * cone.normal);
        let hit = (0..cones.len()).find(|&k| {
            let other = &cones[k];
            let free = !image[..at].contains(&(k as u8));
            free && other.limits == cone.limits
                && (other.arm - arm).norm() <= APART * size
                && (other.normal - normal).norm() <= APART
        })?;
        image[at] = hit as u8;
        let other = &cones[hit];
        let [unit, friction, torsion, length] = cone.limits;
        let force = unit * friction.hypot(1.0);
        let turned = (other.normal - normal).norm();
        let moved = (other.arm - arm).norm();
        let turn = force * turned * (1.0 + cone.arm.norm() / length) + torsion * turned / length;
        worst = worst.max(2.0 * (turn + force * moved / length) + 2.0 * cone.rounding);
    }
    *error = error.max(worst);
    Some(SpaceMap { matrix, image })
}

fn same(a: &SpaceMap, b: &SpaceMap) -> bool {
    (a.matrix - b.matrix).norm() <= 1e-6
}

/// Whether all products are there too.
fn is_group(maps: &[SpaceMap], count: usize) -> bool {
    maps.iter().all(|a| {
        maps.iter().all(|b| {
            let det = a.matrix.determinant() * b.matrix.determinant();
            maps.iter().any(|c| {
                c.matrix.determinant() * det > 0.0
                    && (0..count).all(|k| c.image[k] == a.image[b.image[k] as usize])
                    && (c.matrix - a.matrix * b.matrix).norm() <= 1e-6
            })
        })
    })
}

/// R on forces and det R · R on torques.
fn on_wrenches(matrix: &Matrix3<f64>) -> [V6; 6] {
    let det = matrix.determinant().signum();
    let mut map = [[0.0; 6]; 6];
    for i in 0..3 {
        for j in 0..3 {
            map[i][j] = matrix[(i, j)];
            map[3 + i][3 + j] = det * matrix[(i, j)];
        }
    }
    map
}
