//! Families of structured grasps: the ones that real objects have and random ones never.

use grasp::{Contact, Convention, EdgeNorm, Edges, TorqueLength};
use nalgebra::{Point3, Unit, Vector3};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::common::in_ball;

pub(crate) const FAMILIES: [&str; 9] = [
    "ring",
    "box",
    "cylinder",
    "ball",
    "repeated",
    "antipodal",
    "collinear",
    "coplanar",
    "random",
];

/// Half the size of the objects.
const SIZE: f64 = 0.05;

fn contact(p: Vector3<f64>, n: Vector3<f64>) -> Contact {
    Contact {
        position: p.into(),
        inward_normal: Unit::new_normalize(n),
    }
}

fn on_ring(i: usize, of: usize, z: f64) -> Contact {
    let (sin, cos) = (std::f64::consts::TAU * i as f64 / of as f64).sin_cos();
    contact(
        Vector3::new(SIZE * cos, SIZE * sin, z),
        Vector3::new(-cos, -sin, 0.0),
    )
}

fn on_box(rng: &mut ChaCha8Rng) -> Contact {
    let half = [0.05, 0.03, 0.07];
    let grid = [-0.05, -0.03, -0.02, 0.0, 0.02, 0.03];
    let axis = rng.random_range(0..3);
    let sign = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
    let mut p = Vector3::from_fn(|_, _| grid[rng.random_range(0..6)]);
    p[axis] = sign * half[axis];
    let mut n = Vector3::zeros();
    n[axis] = -sign;
    contact(p, n)
}

fn on_ball(direction: Vector3<f64>) -> Contact {
    let p = direction.try_normalize(0.0).unwrap_or(Vector3::x());
    contact(p * SIZE, -p)
}

/// The contacts of a family, before they are disturbed.
pub(crate) fn family(rng: &mut ChaCha8Rng, name: &str, count: usize) -> Vec<Contact> {
    let few: Vec<Contact> = (0..count.div_ceil(2))
        .map(|_| on_ball(in_ball(rng)))
        .collect();
    let line = in_ball(rng).normalize();
    let one = |i: usize, rng: &mut ChaCha8Rng| match name {
        "ring" => on_ring(i, count, 0.0),
        "box" => on_box(rng),
        "cylinder" => on_ring(
            rng.random_range(0..12),
            12,
            [-0.04, 0.0, 0.04][rng.random_range(0..3)],
        ),
        "ball" => on_ball(Vector3::from_fn(|_, _| f64::from(rng.random_range(-1..2)))),
        "repeated" => few[i % few.len()],
        "antipodal" => {
            let p = few[i / 2 % few.len()].position.coords;
            on_ball(if i.is_multiple_of(2) { p } else { -p })
        }
        "collinear" => contact(line * (0.02 * i as f64 - 0.03), in_ball(rng)),
        "coplanar" => {
            let p = in_ball(rng);
            let flat = Vector3::new(p.x, p.y, 0.0);
            contact(flat * SIZE, -flat)
        }
        _ => {
            let p = in_ball(rng);
            contact(p * SIZE, in_ball(rng) * 0.5 - p)
        }
    };
    (0..count).map(|i| one(i, rng)).collect()
}

/// One grasp of a family, in a third of all cases exact and disturbed by 1e-16 … 1e-3 in the others.
pub(crate) fn disturbed(rng: &mut ChaCha8Rng, name: &str, count: usize) -> Vec<Contact> {
    let mut contacts = family(rng, name, count);
    if rng.random_range(0..3) > 0 {
        let size = 10.0_f64.powf(rng.random_range(-16.0..-3.0));
        for c in &mut contacts {
            c.position += in_ball(rng) * (SIZE * size);
            let n = c.inward_normal.into_inner() + in_ball(rng) * size;
            c.inward_normal = Unit::new_normalize(n);
        }
    }
    contacts
}

/// Friction 1e-9 … 1e6 and torque lengths 1e-9 … 1e9, the usual ones among them.
pub(crate) fn extreme(rng: &mut ChaCha8Rng, edges: Edges) -> Convention {
    let friction = match rng.random_range(0..3) {
        0 => 1.0,
        1 => [0.3, 0.5, 1.0, 2.0][rng.random_range(0..4)],
        _ => 10.0_f64.powf(rng.random_range(-9.0..6.0)),
    };
    let length = match rng.random_range(0..3) {
        0 => SIZE,
        1 => [0.01, 0.05, 1.0][rng.random_range(0..3)],
        _ => 10.0_f64.powf(rng.random_range(-9.0..9.0)),
    };
    Convention {
        friction,
        torque_length: TorqueLength::Metres(length),
        edges,
        edge_norm: if rng.random_bool(0.5) {
            EdgeNorm::UnitLength
        } else {
            EdgeNorm::UnitNormalComponent
        },
        ..Convention::unit()
    }
}

/// The origin, or in a quarter of all cases a point up to a kilometre away.
pub(crate) fn centre(rng: &mut ChaCha8Rng) -> Point3<f64> {
    match rng.random_range(0..4) {
        0 => Point3::from(in_ball(rng) * 10.0_f64.powf(rng.random_range(-3.0..3.0))),
        _ => Point3::origin(),
    }
}
