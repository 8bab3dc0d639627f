//! The symmetries of a grasp: rotations and reflections about the centre that permute its contacts.
//!
//! An orthogonal matrix R of R³ takes a force f at an arm c to R f at R c, and the torque c × f to
//! det R · R (c × f). Round cones have no direction of their own, so the wrenches of a contact become
//! exactly those of its image.

use super::Cone;
use crate::hull::plane::V6;
use crate::hull::support::{SpaceMap, Symmetries};
use nalgebra::{Matrix3, Vector3};

/// Contacts further than this from their images, relative to their size, are not symmetric. What the
/// images are off by costs the lower end of a quality as much.
const APART: f64 = 1e-6;
/// More maps than this are not looked for.
const MOST: usize = 200;

/// See [`crate::hull::support::Support::symmetries`].
pub(super) fn symmetries(cones: &[Cone], out: &mut Symmetries) {
    out.maps.clear();
    out.error = 0.0;
    out.slack = 0.0;
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
                let map = frame.onto(cones, size, [first, second], sign);
                let Some(map) = map.and_then(|m| permutes(cones, m, size, &mut out.error)) else {
                    continue;
                };
                if maps.len() < MOST && !maps.iter().any(|m| same(m, &map)) {
                    maps.push(map);
                }
            }
        }
    }
    if let Some(slack) = products(&mut maps, cones.len()) {
        out.slack = slack;
        let moves = |m: &&SpaceMap| (m.matrix - Matrix3::identity()).norm() > 1e-3;
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
    let x = x.try_normalize(0.03)?;
    let y = (y - x * x.dot(&y)).try_normalize(0.03)?;
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

    fn onto(
        &self,
        cones: &[Cone],
        size: f64,
        [first, second]: [usize; 2],
        sign: f64,
    ) -> Option<Matrix3<f64>> {
        let [one, other] = self.of;
        if (one.0 == other.0) != (first == second) {
            return None;
        }
        let x = vector(&cones[first], one.1, size);
        let y = vector(&cones[second], other.1, size);
        let from = vector(&cones[one.0], one.1, size).dot(&vector(&cones[other.0], other.1, size));
        if (x.dot(&y) - from).abs() > 4.0 * APART {
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
    let mirrors = matrix.determinant() < 0.0;
    Some(SpaceMap {
        matrix,
        image,
        mirrors,
    })
}

fn same(a: &SpaceMap, b: &SpaceMap) -> bool {
    a.key() == b.key()
}

/// How far any product of two maps is from a map, None where one is missing: then they are no group.
fn products(maps: &mut [SpaceMap], count: usize) -> Option<f64> {
    maps.sort_unstable_by_key(SpaceMap::key);
    let mut worst = 0.0_f64;
    for a in &*maps {
        for b in &*maps {
            let mut image = [u8::MAX; 16];
            for (onto, &middle) in image.iter_mut().zip(&b.image[..count]) {
                *onto = a.image[middle as usize];
            }
            let product = SpaceMap {
                matrix: a.matrix * b.matrix,
                image,
                mirrors: a.mirrors != b.mirrors,
            };
            let at = maps
                .binary_search_by_key(&product.key(), SpaceMap::key)
                .ok()?;
            worst = worst.max((maps[at].matrix - product.matrix).norm());
        }
    }
    Some(worst)
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
