//! The paper's ascent and transfer.

use grasp::Convention;
use nalgebra::{Point3, Vector3};
use shape::RadialShape;
use space::{Objective, PaperAscent, PaperTransfer};
use sph::direction::{angle, retract};
use sph::{Coefficients, Direction, SphericalCoords};

use crate::common::{between, field};

const ASCENT: PaperAscent = PaperAscent {
    steps: 100,
    ..PaperAscent::PAPER
};

fn paper() -> Convention {
    Convention::named("paper").unwrap()
}

/// An egg: a ball, longer along z and blunter below.
fn egg(stretch: f64) -> RadialShape {
    let mut beta = Coefficients::constant(6, 0.04);
    beta.as_mut_slice()[sph::index::position(2, 0)] = stretch;
    beta.as_mut_slice()[sph::index::position(1, 0)] = 0.2 * stretch;
    beta.as_mut_slice()[sph::index::position(3, 1)] = 0.3 * stretch;
    RadialShape::new(beta).unwrap()
}

/// Three contacts near the equator, away from the best places.
fn around_the_waist() -> Vec<Direction> {
    [(1.5, 0.1), (1.7, 2.3), (1.4, 4.0)]
        .map(|(theta, phi)| SphericalCoords { theta, phi }.direction())
        .to_vec()
}

#[test]
fn the_ascent_climbs_and_its_trace_is_complete() {
    let shape = egg(0.01);
    let mut objective = Objective::new(&paper(), &shape, &Point3::origin());
    let start = around_the_waist();
    let mut trace = Vec::new();
    let ascent = ASCENT
        .climb(&shape, &start, &mut objective, |s| trace.push(s.quality))
        .unwrap();
    assert!(ascent.quality > ascent.start_quality + 0.02);
    assert_eq!(trace.len(), ASCENT.steps + 1);
    assert_eq!(trace[0], ascent.start_quality);
    assert_eq!(trace[ASCENT.steps], ascent.quality);
    assert_eq!(ascent.evaluations, 1 + 7 * ASCENT.steps);
    let again = objective.quality_at(&shape, &ascent.directions).unwrap();
    assert_eq!(again, ascent.quality);
}

#[test]
fn steps_are_no_longer_than_the_rate() {
    let shape = egg(0.01);
    let mut objective = Objective::new(&paper(), &shape, &Point3::origin());
    let mut before: Option<Vec<Direction>> = None;
    ASCENT
        .climb(&shape, &around_the_waist(), &mut objective, |step| {
            if let Some(before) = &before {
                for (p, q) in before.iter().zip(step.directions) {
                    assert!(angle(p, q) <= ASCENT.rate + 1e-12);
                }
            }
            before = Some(step.directions.to_vec());
        })
        .unwrap();
}

#[test]
fn an_open_grasp_stays_where_it_is() {
    let shape = egg(0.0);
    let p = Direction::new_normalize(Vector3::new(1.0, 0.2, 0.1));
    let start: Vec<Direction> = [0.0, 0.1, 0.2]
        .map(|y| retract(&p, &Vector3::new(0.0, y, -y)))
        .to_vec();
    let mut objective = Objective::new(&paper(), &shape, &Point3::origin());
    let ascent = ASCENT
        .climb(&shape, &start, &mut objective, |_| {})
        .unwrap();
    assert_eq!((ascent.start_quality, ascent.quality), (0.0, 0.0));
    for (p, q) in start.iter().zip(&ascent.directions) {
        assert!(angle(p, q) <= 1e-12);
    }
}

#[test]
fn a_transfer_visits_every_station_and_ends_on_the_target() {
    let (from, to) = [egg(0.0), egg(0.025)].map(field).into();
    let convention = paper();
    let transfer = between(&from, &to, &convention);
    let scheme = PaperTransfer {
        intervals: 10,
        ascent: PaperAscent {
            steps: 20,
            ..ASCENT
        },
    };
    let stations = transfer.stations(scheme.intervals).unwrap();
    assert_eq!(stations.len(), 11);
    assert!(space::distance_of(&stations[10], &to) <= 1e-16);
    let start = around_the_waist();
    let mut parameters = Vec::new();
    let arrived = scheme
        .carry_traced(&transfer, &start, |t, _| parameters.push(t))
        .unwrap();
    parameters.dedup();
    assert_eq!(parameters.len(), 11);
    let naive = transfer.naive(&start).unwrap();
    assert!(arrived.quality > naive.quality);
    assert_eq!(arrived.start_quality, naive.start_quality);
    let mut objective = Objective::new(&convention, &to, &Point3::origin());
    let again = objective.quality_at(&to, &arrived.directions).unwrap();
    assert!((again - arrived.quality).abs() <= 1e-9);
}

#[test]
fn conventions_are_resolved_on_the_surface() {
    let shape = egg(0.02);
    let origin = Point3::new(0.1, 0.0, 0.0);
    let graspit = Convention::named("graspit").unwrap();
    let objective = Objective::new(&graspit, &shape, &origin);
    let (_, r_max) = shape.radius_bounds();
    let grasp::TorqueLength::Metres(length) = objective.convention().torque_length else {
        panic!("the torque length is not resolved");
    };
    assert!(length <= r_max + objective.centre().coords.norm() && length > 0.8 * r_max);
    let frogger = Convention::named("frogger").unwrap();
    assert_eq!(Objective::new(&frogger, &shape, &origin).centre(), origin);
    assert_eq!(
        Objective::new(&paper(), &shape, &origin).centre(),
        Point3::origin()
    );
}
