//! Ascents within limits, on M^sph, under rotation, and of other qualities.

use crate::common::{between, closed_start, field, lumpy, paper};
use grasp::{Convention, Edges};
use nalgebra::{Point3, Rotation3, Vector3};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use shape::{AnyField, RadialShape, SphericalShape, Surface};
use space::point::contacts_on;
use space::quality::{LinearPieces, Quality};
use space::sample::{ContactSampling, perturbed_spherical};
use space::{
    AscentError, ByDifferences, Cap, ConstraintError, Constraints, Continuation, MonotoneAscent,
    Objective,
};
use sph::Direction;
use sph::direction::{angle, retract, tangent_frame};

/// A convention whose quality does not depend on a choice of frame.
fn round() -> Convention {
    Convention {
        edges: Edges::Round { tolerance: 1e-9 },
        ..paper()
    }
}

fn objective(convention: &Convention, surface: &impl Surface) -> Objective {
    Objective::new(convention, surface, &Point3::origin())
}

fn distances(surface: &impl Surface, contacts: &[Direction]) -> Vec<f64> {
    let at = contacts_on(surface, contacts);
    [(0, 1), (0, 2), (1, 2)]
        .map(|(i, j)| (at[i].position - at[j].position).norm())
        .to_vec()
}

#[test]
fn no_state_violates_a_limit() {
    let mut held = 0;
    for seed in 0..6 {
        let shape = lumpy(seed);
        let start = closed_start(&shape, seed);
        let free = MonotoneAscent::default()
            .climb(&shape, &start, &mut objective(&paper(), &shape), |_| {})
            .unwrap();
        let span = |d: &[f64]| d.iter().copied().fold(0.0, f64::max);
        let limits = Constraints {
            least_separation: Some(0.02),
            largest_separation: Some(span(&distances(&shape, &free.directions)) - 0.004),
            caps: vec![Cap {
                axis: Vector3::z_axis(),
                least_cosine: -0.8,
            }],
            closed_holes: Vec::new(),
            closed_under: None,
        };
        let mut qualities = Vec::new();
        let result = MonotoneAscent::default().climb_within(
            &shape,
            &start,
            &mut objective(&paper(), &shape),
            &limits,
            |step| {
                assert!(limits.allow(&shape, step.directions), "seed {seed}");
                qualities.push(step.quality);
            },
        );
        let ascent = result.unwrap();
        assert!(qualities.windows(2).all(|q| q[1] >= q[0]));
        let inside = limits.repair(&shape, &start).unwrap();
        let from = objective(&paper(), &shape)
            .quality_at(&shape, &inside)
            .unwrap();
        assert_eq!(from, ascent.start_quality);
        assert!(ascent.quality >= from);
        let slack =
            limits.largest_separation.unwrap() - span(&distances(&shape, &ascent.directions));
        held += usize::from(slack < 1e-4);
    }
    assert!(held >= 2, "the limit held {held} of 6 ascents back");
}

#[test]
fn a_friction_margin_is_kept() {
    let shape = lumpy(2);
    let start = closed_start(&shape, 4);
    let quality = objective(&paper(), &shape);
    let slippery = quality.with_friction(0.6);
    let limits = Constraints {
        closed_under: Some(slippery.clone()),
        ..Constraints::default()
    };
    let mut states = Vec::new();
    let ascent = MonotoneAscent::default()
        .climb_within(&shape, &start, &mut quality.clone(), &limits, |step| {
            states.push(step.directions.to_vec());
        })
        .unwrap();
    assert!(ascent.quality > 0.1);
    for contacts in &states {
        assert!(slippery.clone().quality_at(&shape, contacts).unwrap() > 0.0);
    }
}

#[test]
fn impossible_limits_are_errors() {
    let shape = lumpy(1);
    let start = closed_start(&shape, 1);
    let climb = |limits: Constraints| {
        MonotoneAscent::default()
            .climb_within(
                &shape,
                &start,
                &mut objective(&paper(), &shape),
                &limits,
                |_| {},
            )
            .unwrap_err()
    };
    let apart = climb(Constraints {
        least_separation: Some(1.0),
        ..Constraints::default()
    });
    assert!(matches!(
        apart,
        AscentError::Constraints(ConstraintError::Unreachable { by, .. }) if by > 0.5
    ));
    for value in [-1.0, f64::NAN, f64::INFINITY] {
        let bad = climb(Constraints {
            largest_separation: Some(value),
            ..Constraints::default()
        });
        assert!(matches!(
            bad,
            AscentError::Constraints(ConstraintError::Limit { .. })
        ));
    }
    let one_sided = climb(Constraints {
        // No grasp within ten degrees is closed.
        caps: vec![Cap {
            axis: Vector3::x_axis(),
            least_cosine: 10_f64.to_radians().cos(),
        }],
        closed_under: Some(objective(&paper(), &shape).with_friction(0.1)),
        ..Constraints::default()
    });
    assert!(matches!(
        one_sided,
        AscentError::Constraints(ConstraintError::FrictionMargin { .. })
    ));
}

#[test]
fn slopes_on_m_sph_agree_with_differences() {
    let mut rng = ChaCha8Rng::seed_from_u64(17);
    let base = SphericalShape::from_radial(&lumpy(4)).unwrap();
    let mut checked = 0;
    for seed in 0..24 {
        let around = ContactSampling::Uniform(3);
        let Ok(point) = perturbed_spherical(&base, 1..30, 2e-4, &around, &mut rng) else {
            continue;
        };
        let surface = &point.surface;
        let mut start = closed_start(surface, seed);
        if seed % 3 == 0 {
            start[1] = -Vector3::z_axis();
        }
        let mut quality = objective(&paper(), surface);
        let mut pieces = LinearPieces::default();
        quality.linearise(surface, &start, &mut pieces).unwrap();
        // Away from ties, where differences see two facets.
        if pieces.len() > 1 && pieces.get(1).0 < 1e-3 {
            continue;
        }
        for i in 0..3 {
            let (e1, e2) = tangent_frame(&start[i]);
            for (k, e) in [e1, e2].iter().enumerate() {
                let mut shifted = |h: f64| {
                    let mut moved = start.clone();
                    moved[i] = retract(&start[i], &(e * h));
                    quality.value(surface, &moved).unwrap()
                };
                let difference = (shifted(1e-5) - shifted(-1e-5)) / 2e-5;
                let slope = pieces.get(0).1[2 * i + k];
                assert!(
                    (slope - difference).abs() <= 1e-5 * (1.0 + slope.abs()),
                    "seed {seed}, contact {i}: {slope} against {difference}"
                );
                checked += 1;
            }
        }
        let ascent = MonotoneAscent::default()
            .climb(surface, &start, &mut quality, |_| {})
            .unwrap();
        assert!(ascent.quality >= ascent.start_quality);
    }
    assert!(checked >= 24, "{checked} slopes checked");
}

#[test]
fn a_rotated_object_is_climbed_the_same_way() {
    let shape = lumpy(6);
    let start = closed_start(&shape, 6);
    let turn = Rotation3::from_euler_angles(0.7, -1.1, 2.3);
    let turned_shape =
        RadialShape::new(sph::rotation::rotate(shape.coefficients(), &turn)).unwrap();
    let turned: Vec<Direction> = start.iter().map(|p| turn * *p).collect();
    let climb = |shape: &RadialShape, start: &[Direction]| {
        MonotoneAscent {
            steps: 30,
            ..MonotoneAscent::default()
        }
        .climb(shape, start, &mut objective(&round(), shape), |_| {})
        .unwrap()
    };
    let (a, b) = (climb(&shape, &start), climb(&turned_shape, &turned));
    assert!((a.start_quality - b.start_quality).abs() <= 1e-7);
    assert!((a.quality - b.quality).abs() <= 1e-4, "{a:?} {b:?}");
    for (p, q) in a.directions.iter().zip(&b.directions) {
        assert!(angle(&(turn * *p), q) <= 1e-2);
    }
}

#[test]
fn a_converged_grasp_is_stationary_and_stays() {
    for seed in [0, 2, 3, 5, 9, 11] {
        let surface = field(lumpy(seed));
        let start = closed_start(&surface, seed);
        let convention = paper();
        let mut slopes = Vec::new();
        let ascent = MonotoneAscent::default()
            .climb(
                &surface,
                &start,
                &mut objective(&convention, &surface),
                |step| {
                    slopes.push(step.stationarity);
                },
            )
            .unwrap();
        assert_eq!(slopes.last(), Some(&ascent.stationarity));
        assert!(ascent.stationarity <= 0.2 * slopes[0], "{slopes:?}");
        let transfer = between(&surface, &surface, &convention);
        let scheme = Continuation::default();
        let carried = scheme.carry(&transfer, &ascent.directions).unwrap();
        assert!(carried.quality >= ascent.quality - 1e-9);
        assert!(carried.quality <= ascent.quality + 1e-9);
        for (p, q) in ascent.directions.iter().zip(&carried.directions) {
            assert!(angle(p, q) <= 1e-9, "moved by {}", angle(p, q));
        }
        assert!(carried.open.is_none());
    }
}

#[test]
fn any_function_is_carried() {
    let (from, to) = [lumpy(3), lumpy(53)].map(field).into();
    let convention = paper();
    let transfer = between(&from, &to, &convention);
    // Smooth, positive, largest where the contacts' normals cancel.
    let balance = |surface: &AnyField, p: &[Direction]| {
        let sum: Vector3<f64> = p.iter().map(|p| surface.contact(p).1.into_inner()).sum();
        3.0 - sum.norm_squared() / 3.0
    };
    let scheme = Continuation::default();
    let start = closed_start(&from, 3);
    let mut trace = Vec::new();
    let carried = scheme
        .carry_by(
            &transfer,
            &start,
            |_, _| ByDifferences::new(balance, 1e-5),
            |t, step| trace.push((t, step.quality)),
        )
        .unwrap();
    let kept = balance(&to, &start);
    assert!(
        carried.quality > kept && carried.quality > 2.95,
        "{} from {kept}",
        carried.quality
    );
    assert!((balance(&to, &carried.directions) - carried.quality).abs() <= 1e-12);
    assert!(trace.windows(2).all(|w| w[1].0 >= w[0].0));
    let same_station = trace.windows(2).filter(|w| w[1].0 == w[0].0);
    assert!(same_station.clone().count() > 0);
    for pair in same_station {
        assert!(pair[1].1 >= pair[0].1);
    }
}

#[test]
fn transfers_keep_limits_on_the_way_and_in_recovery() {
    let (from, to) = [lumpy(3), lumpy(53)].map(field).into();
    let convention = paper();
    let transfer = between(&from, &to, &convention);
    let start = closed_start(&from, 3);
    let limits = |largest: f64| Constraints {
        least_separation: Some(0.025),
        largest_separation: Some(largest),
        caps: vec![Cap {
            axis: Vector3::z_axis(),
            least_cosine: -0.9,
        }],
        closed_holes: Vec::new(),
        closed_under: Some(objective(&convention, &from).with_friction(0.7)),
    };
    let slippery = Convention {
        friction: 0.7,
        ..paper()
    };
    for scheme in [Continuation::default(), Continuation::thorough()] {
        let tight = limits(0.078);
        let start = MonotoneAscent::default()
            .climb_within(
                &from,
                &start,
                &mut objective(&convention, &from),
                &tight,
                |_| {},
            )
            .unwrap()
            .directions;
        let carry = |limits: &Constraints, trace: &mut dyn FnMut(f64, &space::Step)| {
            scheme.carry_traced(&transfer, &start, limits, trace)
        };
        let mut seen = [0, 0];
        let arrived = carry(&tight, &mut |t, step| {
            for (end, surface) in [&from, &to].into_iter().enumerate() {
                if t == end as f64 {
                    assert!(tight.allow(surface, step.directions));
                    seen[end] += 1;
                }
            }
        })
        .unwrap();
        assert!(seen[0] > 0 && seen[1] > 0, "{seen:?}");
        assert!(tight.allow(&to, &arrived.directions));
        assert!(arrived.quality > 0.1, "{}", arrived.quality);
        let dry = objective(&slippery, &to).quality_at(&to, &arrived.directions);
        assert!(dry.unwrap() > 0.0);
        let error = carry(
            &Constraints {
                least_separation: Some(1.0),
                ..Constraints::default()
            },
            &mut |_, _| {},
        )
        .unwrap_err();
        assert!(matches!(
            error,
            space::TransferError::Constraints(ConstraintError::Unreachable { .. })
        ));
    }
}

#[test]
fn an_open_end_says_why() {
    // A tiny friction leaves nothing closed on a ball with three contacts near one point.
    let (from, to) = [0.03, 0.04]
        .map(|r| field(RadialShape::sphere(4, r).unwrap()))
        .into();
    let convention = Convention {
        friction: 1e-6,
        ..paper()
    };
    let transfer = between(&from, &to, &convention);
    let p = Direction::new_normalize(Vector3::new(1.0, 0.3, 0.2));
    let start: Vec<Direction> = [0.0, 0.1, 0.2]
        .map(|y| retract(&p, &Vector3::new(0.0, y, -y)))
        .to_vec();
    let scheme = Continuation::default();
    let carried = scheme.carry(&transfer, &start).unwrap();
    if carried.quality <= 0.0 {
        let reason = carried.open.unwrap();
        assert!(reason.distance.unwrap() >= 0.0 && reason.climbs > 1);
        assert!(reason.to_string().contains("no closed grasp"));
    } else {
        assert!(carried.open.is_none() && carried.quality <= 1e-6);
    }
}
