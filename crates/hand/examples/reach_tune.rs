//! tune
use rand_chacha::rand_core::SeedableRng;
fn main() {
    let hand = hand::schunk_sdh().unwrap();
    for name in std::env::args().skip(1) {
        let b = std::fs::read(format!("/tmp/hand_fit_{name}.bin")).unwrap();
        let beta: Vec<f64> = b
            .chunks_exact(8)
            .map(|c| f64::from_le_bytes(c.try_into().unwrap()))
            .collect();
        let surface = shape::RadialShape::new(sph::Coefficients::new(beta).unwrap()).unwrap();
        let object = hand::CollisionObject::new(&surface).unwrap();
        let params = hand::SynthesisParams {
            poses: 100,
            sampling: hand::PoseSampling::of_hand(&hand),
            rules: hand::ClosingRules::default(),
            convention: grasp::Convention::named("paper").unwrap(),
            centre: nalgebra::Point3::origin(),
            least_quality: 0.01,
        };
        let run = hand::synthesize(
            &surface,
            &hand,
            &params,
            &mut rand_chacha::ChaCha8Rng::seed_from_u64(1),
        )
        .unwrap();
        let t = std::time::Instant::now();
        let (mut r, mut near, mut none) = (0, 0, 0);
        for (k, g) in run.grasps.iter().take(10).enumerate() {
            let mut rp = hand::ReachParams::default();
            if let Ok(s) = std::env::var("STARTS") {
                rp.starts = s.parse().unwrap();
            }
            match hand::reach_contacts(
                &object,
                &hand,
                &g.contacts,
                &rp,
                &mut rand_chacha::ChaCha8Rng::seed_from_u64(k as u64),
            ) {
                hand::ReachOutcome::Reached(f) => {
                    r += 1;
                    println!(
                        "  reached {} starts {:.2} mm {:.2} rad",
                        f.starts,
                        f.position_error * 1e3,
                        f.normal_error
                    );
                }
                hand::ReachOutcome::Near(f) => {
                    near += 1;
                    println!("  near {:.2} mm", f.position_error * 1e3);
                }
                hand::ReachOutcome::Nothing { best_fit } => {
                    none += 1;
                    println!("  nothing {:.3} mm", best_fit * 1e3);
                }
                _ => {}
            }
        }
        println!(
            "{name}: reached {r} near {near} nothing {none}; {:.2} s",
            t.elapsed().as_secs_f64()
        );
    }
}
