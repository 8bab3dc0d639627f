//! The least friction of balance and of closure, with a proof of either side.

use grasp::{
    Contact, Convention, Edges, GraspModel, Workspace, Wrench, epsilon, friction_needed, wrenches,
};
use nalgebra::{Point3, Unit, Vector3};

use crate::common::{generator, unit};
use crate::families::{FAMILIES, family};

#[test]
fn friction_needed_of_known_grasps() {
    let centre = Point3::origin();
    let mut workspace = Workspace::new();
    let convention = unit(0.5, Edges::Round { tolerance: 1e-4 });
    // Two opposite contacts are in balance without friction and never closed.
    let pair = [1.0, -1.0].map(|s| Contact {
        position: Point3::new(0.03 * s, 0.0, 0.0),
        inward_normal: Unit::new_unchecked(Vector3::new(-s, 0.0, 0.0)),
    });
    let model = GraspModel::new(&pair, &centre, &convention);
    let needed = friction_needed(&model, 10.0, &mut workspace).unwrap();
    assert!(needed.balance.is_some_and(|mu| mu <= 1e-6), "{needed:?}");
    assert_eq!(needed.closure, None);
    // Tilted by 0.3 rad towards each other the line between them lies on the cones at tan 0.3.
    let tilted = [1.0, -1.0].map(|s| Contact {
        position: Point3::new(0.03 * s, 0.0, 0.0),
        inward_normal: Unit::new_normalize(Vector3::new(-s * 0.3_f64.cos(), 0.3_f64.sin(), 0.0)),
    });
    let model = GraspModel::new(&tilted, &centre, &convention);
    let needed = friction_needed(&model, 10.0, &mut workspace).unwrap();
    let balance = needed.balance.unwrap();
    assert!((balance - 0.3_f64.tan()).abs() <= 1e-6, "{balance}");
    // Three on a plane that press the same way cannot be in balance below a large μ.
    let up = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]].map(|[x, y]| Contact {
        position: Point3::new(x, y, 0.0),
        inward_normal: Vector3::z_axis(),
    });
    let model = GraspModel::new(&up, &centre, &convention);
    let needed = friction_needed(&model, 10.0, &mut workspace).unwrap();
    assert_eq!((needed.balance, needed.closure), (None, None));
}

/// How far the wrenches of normal component one and no more friction than μ reach along a direction, for
/// pyramids of k edges.
fn reach_along(contacts: &[Contact], convention: &Convention, u: &Wrench) -> f64 {
    let centre = Point3::origin();
    let all = wrenches(&GraspModel::new(contacts, &centre, convention)).unwrap();
    all.iter()
        .map(|w| w.dot(u))
        .fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn friction_needed_is_proved_from_both_sides() {
    let mut rng = generator(31);
    let mut workspace = Workspace::new();
    let centre = Point3::origin();
    let (mut checked, mut tight, mut on_a_line, mut none) = (0, 0, 0, 0);
    for name in FAMILIES {
        for round in 0..30 {
            let count = 2 + round % 5;
            let contacts = family(&mut rng, name, count);
            let under = |friction: f64| unit(friction, Edges::Polygon(5));
            let needed = friction_needed(
                &GraspModel::new(&contacts, &centre, &under(1.0)),
                50.0,
                &mut workspace,
            )
            .unwrap();
            // Below: along the direction of the proof no wrench reaches beyond 0.
            for bound in [needed.no_balance_below, needed.no_closure_below] {
                if bound.friction > 0.0 && bound.friction.is_finite() {
                    let less = under(bound.friction * (1.0 - 1e-9));
                    let reach = reach_along(&contacts, &less, &bound.direction);
                    assert!(reach <= 1e-11, "{name}: {reach} at {bound:?}");
                }
            }
            let (Some(balance), Some(closure)) = (needed.balance, needed.closure) else {
                none += 1;
                // Nor does all the friction that was asked for.
                let most = epsilon(
                    &GraspModel::new(&contacts, &centre, &under(50.0)),
                    &mut workspace,
                )
                .unwrap();
                assert!(most.lower <= 1e-9, "{name}: {needed:?} {most:?}");
                continue;
            };
            assert!(balance <= closure && needed.no_balance_below.friction <= balance);
            let width = closure - needed.no_closure_below.friction;
            tight += usize::from(width <= 2e-9 * closure);
            on_a_line += usize::from(closure > balance * (1.0 + 1e-8));
            // Above it is closed, below it is not.
            if closure > 1e-6 {
                let above = epsilon(
                    &GraspModel::new(&contacts, &centre, &under(1.02 * closure)),
                    &mut workspace,
                )
                .unwrap();
                assert!(above.closed, "{name}: {needed:?} {above:?}");
                let below = epsilon(
                    &GraspModel::new(&contacts, &centre, &under(0.98 * closure)),
                    &mut workspace,
                )
                .unwrap();
                assert!(below.lower <= 1e-12, "{name}: {needed:?} {below:?}");
                checked += 1;
            }
        }
    }
    let counts =
        format!("{checked} checked, {tight} tight, {on_a_line} on a line, {none} never closed");
    assert!(checked > 40 && on_a_line > 5 && none > 20, "{counts}");
    assert!(4 * tight > 3 * checked, "{counts}");
}
