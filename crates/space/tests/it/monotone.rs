//! Our ascent: monotone, without coordinate singularities, and better than the fixed step.

use crate::common::{between, closed_start, field, lumpy, paper};
use grasp::{Convention, Edges, FrameRule, Gradient};
use nalgebra::{Point3, Vector3};
use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use shape::Surface;
use space::point::contacts_on;
use space::sample::uniform_direction;
use space::{MonotoneAscent, Objective, PaperAscent};
use sph::Direction;
use sph::direction::{retract, tangent_frame};

proptest! {
    #![proptest_config(ProptestConfig { cases: 16, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn quality_never_falls(seed in 0_u64..500) {
        let shape = lumpy(seed);
        let start = closed_start(&shape, seed);
        let mut objective = Objective::new(&paper(), &shape, &Point3::origin());
        let mut trace = Vec::new();
        let ascent = MonotoneAscent::default()
            .climb(&shape, &start, &mut objective, |s| trace.push(s.quality))
            .unwrap();
        for pair in trace.windows(2) {
            prop_assert!(pair[1] >= pair[0], "{} after {}", pair[1], pair[0]);
        }
        prop_assert_eq!(trace[0], ascent.start_quality);
        prop_assert_eq!(*trace.last().unwrap(), ascent.quality);
        let again = objective.quality_at(&shape, &ascent.directions).unwrap();
        prop_assert!((again - ascent.quality).abs() <= 1e-12);
    }
}

#[test]
fn it_beats_a_thousand_fixed_steps_with_a_twentieth_of_the_evaluations() {
    let (mut ours_cost, mut theirs_cost) = (0, 0);
    for seed in 0..6 {
        let shape = lumpy(seed);
        let start = closed_start(&shape, seed);
        let mut objective = Objective::new(&paper(), &shape, &Point3::origin());
        let fixed = PaperAscent::PAPER;
        let a = MonotoneAscent::default()
            .climb(&shape, &start, &mut objective, |_| {})
            .unwrap();
        let b = fixed.climb(&shape, &start, &mut objective, |_| {}).unwrap();
        assert!(a.quality >= a.start_quality);
        assert!(
            a.quality > b.quality,
            "seed {seed}: {} and {}",
            a.quality,
            b.quality
        );
        ours_cost += a.evaluations;
        theirs_cost += b.evaluations;
    }
    assert!(20 * ours_cost <= theirs_cost);
}

#[test]
fn it_finds_closure_from_open_grasps() {
    let shape = lumpy(3);
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    let mut objective = Objective::new(&paper(), &shape, &Point3::origin());
    let (mut open, mut closed) = (0, 0);
    while open < 20 {
        let start: Vec<Direction> = (0..3).map(|_| uniform_direction(&mut rng)).collect();
        if objective.quality_at(&shape, &start).unwrap() > 0.0 {
            continue;
        }
        open += 1;
        let ascent = MonotoneAscent::default()
            .climb(&shape, &start, &mut objective, |_| {})
            .unwrap();
        closed += usize::from(ascent.quality > 0.01);
    }
    assert!(closed >= 18, "{closed} of {open} open starts became closed");
}

#[test]
fn the_gradient_by_contacts_agrees_with_differences_also_at_the_poles() {
    let shape = lumpy(5);
    let mut objective = Objective::new(&paper(), &shape, &Point3::origin());
    let mut checked = 0;
    for seed in 0..40 {
        let mut start = closed_start(&shape, seed);
        if seed % 4 == 0 {
            start[0] = Vector3::z_axis();
        }
        let contacts = contacts_on(&shape, &start);
        let here = objective.margin(&contacts).unwrap();
        if !here.closed {
            continue;
        }
        // Away from ties: another facet within reach of the differences has another gradient.
        let mut near = Vec::new();
        objective
            .near_active_facets(&contacts, 1e-3, &mut near)
            .unwrap();
        if near.len() > 1 {
            continue;
        }
        let mut gradient = Gradient::default();
        objective
            .facet_gradient(&contacts, &here.facet, FrameRule::Tangent, &mut gradient)
            .unwrap();
        for i in 0..3 {
            let at = shape.differential(&start[i]);
            let (e1, e2) = tangent_frame(&start[i]);
            for v in [e1, e2] {
                let slope = (at.position_slope * v).dot(&gradient.positions[i])
                    + (at.normal_slope * v).dot(&gradient.normals[i]);
                let mut shifted = |h: f64| {
                    let mut moved = start.clone();
                    moved[i] = retract(&start[i], &(v * h));
                    objective.quality_at(&shape, &moved).unwrap()
                };
                let h = 1e-5;
                let difference = (shifted(h) - shifted(-h)) / (2.0 * h);
                assert!(
                    (slope - difference).abs() <= 1e-6 * (1.0 + slope.abs()),
                    "seed {seed}, contact {i}: {slope} against {difference}"
                );
                checked += 1;
            }
        }
    }
    assert!(checked >= 60, "{checked} slopes checked");
}

#[test]
fn our_transfer_is_never_below_the_naive_one() {
    let convention = paper();
    for seed in 0..6 {
        let (from, to) = [lumpy(seed), lumpy(seed + 50)].map(field).into();
        let transfer = between(&from, &to, &convention);
        let start = closed_start(&from, seed);
        let scheme = space::Continuation::default();
        let arrived = scheme.carry(&transfer, &start).unwrap();
        let naive = transfer.naive(&start).unwrap();
        assert!(arrived.quality >= naive.quality);
        assert!(arrived.quality > 0.1, "seed {seed}: {}", arrived.quality);
        assert_eq!(arrived.start_quality, naive.start_quality);
    }
}

#[test]
fn round_cones_are_climbed_as_high_as_pyramids() {
    let with = |edges| Convention { edges, ..paper() };
    let round = with(Edges::Round { tolerance: 1e-5 });
    let many = with(Edges::Polygon(16));
    for seed in 0..5 {
        let shape = lumpy(seed);
        let start = closed_start(&shape, seed + 100);
        let climb = |convention: &Convention| {
            let mut objective = Objective::new(convention, &shape, &Point3::origin());
            MonotoneAscent::default()
                .climb(&shape, &start, &mut objective, |_| {})
                .unwrap()
        };
        let (a, b) = (climb(&round), climb(&many));
        // The loss from the inscribed pyramids at the end.
        let whole = Objective::new(&round, &shape, &Point3::origin())
            .epsilon(&contacts_on(&shape, &b.directions))
            .unwrap();
        let gap = whole.upper - b.quality;
        assert!((-1e-12..0.1).contains(&gap));
        assert!(
            a.quality >= b.quality - gap,
            "seed {seed}: {} {}",
            a.quality,
            b.quality
        );
    }
}
