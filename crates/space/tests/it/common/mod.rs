//! Shapes and starts that several tests share.

use grasp::Convention;
use nalgebra::Point3;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use shape::{AnyField, RadialField, RadialShape, Surface};
use space::sample::{perturbed, uniform_direction};
use space::{Objective, Transfer, TransferEnd};
use sph::{Coefficients, Direction};

/// A ball with waves.
pub(crate) fn lumpy(seed: u64) -> RadialShape {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let ball = RadialShape::new(Coefficients::constant(6, 0.04)).unwrap();
    loop {
        if let Ok(point) = perturbed(&ball, 1..49, 0.003, 3, &mut rng) {
            return point.surface;
        }
    }
}

/// A radial surface prepared for ascents and transfers.
pub(crate) fn field(shape: RadialShape) -> AnyField {
    RadialField::new(shape).into()
}

/// The paper's convention.
pub(crate) fn paper() -> Convention {
    Convention::named("paper").unwrap()
}

/// The first force-closed triple of a seed.
pub(crate) fn closed_start(surface: &impl Surface, seed: u64) -> Vec<Direction> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut objective = Objective::new(&paper(), surface, &Point3::origin());
    loop {
        let triple: Vec<Direction> = (0..3).map(|_| uniform_direction(&mut rng)).collect();
        if objective.quality_at(surface, &triple).unwrap() > 0.02 {
            return triple;
        }
    }
}

/// A pair of objects, each with the mean of its cloud at the origin of its cloud's frame.
pub(crate) fn between<'a>(
    from: &'a AnyField,
    to: &'a AnyField,
    convention: &'a Convention,
) -> Transfer<'a> {
    let end = |surface| TransferEnd {
        surface,
        object_origin: Point3::origin(),
    };
    Transfer::new(end(from), end(to), convention)
}
