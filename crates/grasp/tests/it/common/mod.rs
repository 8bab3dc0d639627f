//! Random grasps for the tests.
#![allow(dead_code, reason = "each test file uses a part")]

use grasp::{Contact, Convention, Edges};
use nalgebra::{Point3, Unit, UnitVector3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A generator for a fixed seed.
pub(crate) fn generator(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

/// A vector uniform in the unit ball.
pub(crate) fn in_ball(rng: &mut ChaCha8Rng) -> Vector3<f64> {
    loop {
        let v = Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0));
        if v.norm_squared() <= 1.0 && v.norm_squared() > 1e-4 {
            return v;
        }
    }
}

/// A unit vector uniform on the sphere.
pub(crate) fn on_sphere(rng: &mut ChaCha8Rng) -> UnitVector3<f64> {
    Unit::new_normalize(in_ball(rng))
}

/// Contacts around an equator of radius `size` that press roughly inwards: mostly closed.
pub(crate) fn around(rng: &mut ChaCha8Rng, count: usize, size: f64) -> Vec<Contact> {
    (0..count)
        .map(|i| {
            let a = std::f64::consts::TAU * i as f64 / count as f64;
            let p = Vector3::new(a.cos(), a.sin(), 0.0) + in_ball(rng) * 0.2;
            Contact {
                position: Point3::from(p * size),
                inward_normal: Unit::new_normalize(-p + in_ball(rng) * 0.3),
            }
        })
        .collect()
}

/// Contacts in the ball of radius 2 with normals anywhere: mostly open.
pub(crate) fn anywhere(rng: &mut ChaCha8Rng, count: usize) -> Vec<Contact> {
    (0..count)
        .map(|_| Contact {
            position: Point3::from(in_ball(rng) * 2.0),
            inward_normal: on_sphere(rng),
        })
        .collect()
}

/// The convention `unit` with this friction and these edges.
pub(crate) fn unit(friction: f64, edges: Edges) -> Convention {
    Convention {
        friction,
        edges,
        ..Convention::unit()
    }
}
