//! A transfer between two objects measures each grasp under the convention resolved on its own
//! object.

use std::sync::Arc;

use grasp::Convention;
use nalgebra::{Point3, Vector3};
use shape::AnyField;
use space::{Continuation, Objective, PaperAscent, PaperTransfer, Transfer, TransferEnd};

use crate::common::{between, closed_start, field, lumpy, paper};

/// Two objects whose clouds stood in different places of their frames.
fn far_apart(from: &AnyField, to: &AnyField, rule: &Convention) -> [(f64, f64, f64); 3] {
    let origins = [Point3::new(-0.5, 0.1, 0.0), Point3::new(0.02, 0.0, 0.3)];
    let [at, to_end] =
        [(from, origins[0]), (to, origins[1])].map(|(surface, object_origin)| TransferEnd {
            surface,
            object_origin,
        });
    let transfer = Transfer::new(at, to_end, rule);
    let start = closed_start(from, 3);
    let expected = Objective::new(rule, from, &origins[0])
        .quality_at(from, &start)
        .unwrap();
    let ours = Continuation::default().carry(&transfer, &start).unwrap();
    let paper = PaperTransfer {
        intervals: 3,
        ascent: PaperAscent {
            steps: 5,
            ..PaperAscent::PAPER
        },
    };
    let paper = paper.carry(&transfer, &start).unwrap();
    let naive = transfer.naive(&start).unwrap();
    [ours, paper, naive].map(|end| {
        let again = Objective::new(rule, to, &origins[1])
            .quality_at(to, &end.directions)
            .unwrap();
        assert!(
            (again - end.quality).abs() <= 1e-9 * (1.0 + again),
            "{}",
            rule.name
        );
        (expected, end.start_quality, end.quality)
    })
}

#[test]
fn a_source_is_measured_about_its_own_origin() {
    let (from, to) = [lumpy(3), lumpy(53)].map(field).into();
    for named in [
        Convention::frogger(),
        Convention::openrave(),
        Convention::unit(),
    ] {
        let rule = Convention {
            friction: 1.0,
            ..named
        };
        for (expected, start, _) in far_apart(&from, &to, &rule) {
            assert!(expected > 0.0, "{}: the start is open", rule.name);
            assert!(
                (start - expected).abs() <= 1e-9 * expected,
                "{}: {start} for {expected}",
                rule.name
            );
        }
    }
}

#[test]
fn a_rule_is_resolved_on_each_object() {
    let small = field(lumpy(3));
    let large = field(shape::algebra::cone(&[3.0], &[&lumpy(53)]).unwrap());
    for (expected, start, _) in far_apart(&small, &large, &Convention::graspit()) {
        assert!(expected > 0.0);
        assert!(
            (start - expected).abs() <= 1e-9 * expected,
            "{start} for {expected}"
        );
    }
}

#[test]
fn stations_are_made_once_per_pair() {
    let (from, to) = [lumpy(1), lumpy(2)].map(field).into();
    let convention = paper();
    let transfer = between(&from, &to, &convention);
    let scheme = Continuation::default();
    let first = transfer.stations(scheme.intervals).unwrap();
    scheme.carry(&transfer, &closed_start(&from, 1)).unwrap();
    scheme.carry(&transfer, &closed_start(&from, 2)).unwrap();
    let again = transfer.stations(scheme.intervals).unwrap();
    assert!(Arc::ptr_eq(&first, &again));
    assert_eq!(first.len(), scheme.intervals + 1);
    assert!(transfer.stations(0).unwrap().len() == 2);
}

#[test]
fn an_open_start_is_content_with_what_its_convention_calls_stable() {
    // With a torque length in metres a good grasp has a hundredth of its quality in centimetres.
    // The ascent must not take it for a poor one and restart.
    let surface = field(lumpy(7));
    let p = sph::Direction::new_normalize(Vector3::new(1.0, 0.3, 0.2));
    let start = [0.0, 0.3, 0.6]
        .map(|y| sph::direction::retract(&p, &Vector3::new(0.0, y, -y)))
        .to_vec();
    let climb = |rule: &Convention| {
        let mut objective = Objective::new(rule, &surface, &Point3::origin());
        space::MonotoneAscent::default()
            .climb(&surface, &start, &mut objective, |_| {})
            .unwrap()
    };
    let metres = Convention::paper().with_torque_length(1.0);
    // A threshold that no grasp exceeds: every restart is made.
    let strict = Convention {
        stable_above: 1.0,
        ..metres.clone()
    };
    let (content, restarted) = (climb(&metres), climb(&strict));
    assert_eq!(content.start_quality, 0.0, "the start is meant to be open");
    assert!(content.quality > 0.0);
    assert!(content.evaluations < restarted.evaluations);
}
