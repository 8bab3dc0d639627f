//! A step of an ascent does not allocate.

use grasp::Convention;
use nalgebra::{Point3, Vector3};
use shape::{RadialField, RadialShape};
use space::{Cap, Constraints, MonotoneAscent, Objective};
use sph::{Coefficients, Direction, SphericalCoords, index};
use testkit::{CountingAllocator, allocations};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

/// Number of allocations of an ascent of at most `steps` steps, and the number of steps taken.
fn climb(
    steps: usize,
    surface: &RadialField,
    start: &[Direction],
    objective: &mut Objective,
    constraints: &Constraints,
) -> (usize, usize) {
    let settings = MonotoneAscent {
        steps,
        restarts: 0,
        ..MonotoneAscent::default()
    };
    let mut taken = 0;
    let before = allocations();
    settings
        .climb_within(surface, start, objective, constraints, |_| taken += 1)
        .unwrap();
    (allocations() - before, taken)
}

#[test]
fn a_longer_climb_allocates_no_more_than_a_shorter_one() {
    let mut beta = Coefficients::constant(20, 0.14);
    beta.as_mut_slice()[index::position(2, 0)] = 0.02;
    beta.as_mut_slice()[index::position(3, 1)] = 0.01;
    beta.as_mut_slice()[index::position(5, -3)] = 0.004;
    let surface = RadialField::new(RadialShape::new(beta).unwrap());
    let start = [(1.2, 0.1), (1.7, 1.8), (1.4, 4.4)]
        .map(|(theta, phi)| SphericalCoords { theta, phi }.direction());
    let convention = Convention::named("paper").unwrap();
    let mut objective = Objective::new(&convention, &surface, &Point3::origin());
    let tight = Constraints {
        least_separation: Some(0.02),
        largest_separation: Some(0.09),
        caps: vec![Cap {
            axis: Vector3::z_axis(),
            least_cosine: -0.7,
        }],
        closed_holes: Vec::new(),
        closed_under: None,
    };
    for constraints in [Constraints::default(), tight] {
        // Memory grows to what the longest ascent needs.
        let (_, long) = climb(60, &surface, &start, &mut objective, &constraints);
        let (few, short) = climb(3, &surface, &start, &mut objective, &constraints);
        let (many, _) = climb(60, &surface, &start, &mut objective, &constraints);
        assert!(long > short + 4, "{long} and {short} steps were taken");
        assert_eq!(few, many);
    }
}
