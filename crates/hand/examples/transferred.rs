//! diag
#![allow(clippy::print_stdout, missing_docs)]
use grasp::Convention;
use hand::*;
use moduli::Continuation;
use moduli::point::contacts_on;
use moduli::transfer::Transfer;
use nalgebra::Point3;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use shape::RadialField;
use std::time::Instant;

fn main() {
    let every: usize = std::env::args().nth(1).map_or(40, |a| a.parse().unwrap());
    let starts: usize = std::env::args().nth(2).map_or(12, |a| a.parse().unwrap());
    let bytes = std::fs::read("fixtures/library.bin").unwrap();
    let library = record::LibraryRecord::from_bytes(&bytes).unwrap();
    let hand = schunk_sdh().unwrap();
    let convention = Convention::named("paper").unwrap();
    let surfaces: Vec<RadialField> = library
        .entries
        .iter()
        .map(|e| RadialField::new(e.shape.shape().unwrap()))
        .collect();
    let objects: Vec<CollisionObject> = surfaces
        .iter()
        .map(|s| CollisionObject::new(s.shape()).unwrap())
        .collect();
    let reachers: Vec<Reacher> = objects.iter().map(|o| Reacher::new(o, &hand)).collect();
    let scheme = Continuation::default();
    let mut k = 0;
    let (mut reached, mut near, mut total) = (0, 0, 0);
    let (mut improved, mut share, mut t_improve) = (0, 0.0, 0.0);
    let trials: usize = std::env::args().nth(3).map_or(40, |a| a.parse().unwrap());
    let mut t_reach = 0.0;
    let mut t_carry = 0.0;
    for (i, from) in library.entries.iter().enumerate() {
        for j in 0..library.entries.len() {
            if i == j {
                continue;
            }
            for g in from.grasps.iter().take(10) {
                k += 1;
                if k % every != 0 {
                    continue;
                }
                let transfer = Transfer {
                    from: &surfaces[i],
                    to: &surfaces[j],
                    convention: &convention,
                    object_origin: Point3::origin(),
                };
                let start = g.directions().unwrap();
                let naive = transfer.naive(&start).unwrap();
                let t = Instant::now();
                let stations = scheme.stations(&transfer).unwrap();
                let arrived = scheme
                    .carry(&transfer, &stations, &start, |_, _| {})
                    .unwrap();
                t_carry += t.elapsed().as_secs_f64();
                let wanted = contacts_on(&surfaces[j], &arrived.contacts);
                let span = (0..3)
                    .map(|a| (wanted[a].position - wanted[(a + 1) % 3].position).norm())
                    .fold(0.0, f64::max);
                let params = ReachParams {
                    starts,
                    ..ReachParams::default()
                };
                let q = g.palm_quaternion_xyzw;
                let palm = nalgebra::Isometry3::from_parts(
                    nalgebra::Translation3::from(nalgebra::Vector3::from(g.palm_translation_m)),
                    nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(
                        q[3], q[0], q[1], q[2],
                    )),
                );
                let known = if std::env::var_os("COLD").is_some() {
                    vec![]
                } else {
                    vec![HandState {
                        object_from_palm: carried_pose(
                            &palm,
                            &contacts_on(&surfaces[i], &start),
                            &wanted,
                        ),
                        joints: g.joints_rad.clone(),
                    }]
                };
                let mut rng = ChaCha8Rng::seed_from_u64(k as u64);
                let t = Instant::now();
                let outcome = reachers[j].reach(&wanted, &params, &known, &mut rng);
                let s = t.elapsed().as_secs_f64();
                t_reach += s;
                total += 1;
                let text = match &outcome {
                    ReachOutcome::Reached(r) => {
                        reached += 1;
                        format!(
                            "reached {} starts, {:.2} mm {:.2} rad",
                            r.starts,
                            1e3 * r.position_error,
                            r.normal_error
                        )
                    }
                    ReachOutcome::Near(r) => {
                        near += 1;
                        let t = Instant::now();
                        let ip = ImproveParams {
                            trials,
                            spread: 4e-3,
                            convention: convention.clone(),
                            centre: Point3::origin(),
                        };
                        let better = reachers[j]
                            .improve(&wanted, r.clone(), &params, &ip, &mut rng)
                            .unwrap();
                        t_improve += t.elapsed().as_secs_f64();
                        if better.quality >= naive.quality.max(0.01) {
                            improved += 1;
                            share += better.quality / arrived.quality;
                        }
                        format!(
                            "near {:.2} mm {:.2} rad Q {:.3} improved {:.3} at {:.1} mm",
                            1e3 * r.position_error,
                            r.normal_error,
                            better.start_quality,
                            better.quality,
                            1e3 * better.reached.position_error
                        )
                    }
                    ReachOutcome::Nothing { best_fit } => {
                        format!("nothing, fit {:.1} mm", 1e3 * best_fit)
                    }
                    other => format!("{other:?}"),
                };
                println!(
                    "{:>3}->{:<3} naive {:.3} Q {:.3} span {:.0} mm: {text} ({:.0} ms)",
                    from.id,
                    library.entries[j].id,
                    naive.quality,
                    arrived.quality,
                    1e3 * span,
                    1e3 * s
                );
            }
        }
    }
    println!(
        "{reached} reached, {near} near of {total}; reach {:.0} ms each, carry {:.0} ms",
        1e3 * t_reach / total as f64,
        1e3 * t_carry / total as f64
    );
    println!(
        "{improved} improved, mean share {:.3}, {:.0} ms each",
        share / improved as f64,
        1e3 * t_improve / near as f64
    );
}
