//! tune
use std::time::Instant;
fn main() {
    use rand_chacha::rand_core::SeedableRng;
    let root = std::env::var("MODULI_DATA").unwrap();
    let mut spec = hand::SDH_SPEC.to_string();
    if let Ok(subs) = std::env::var("SUBS") {
        for pair in subs.split(';') {
            let (a, b) = pair.split_once("=>").unwrap();
            assert!(spec.contains(a), "{a}");
            spec = spec.replace(a, b);
        }
    }
    if let Ok(f) = std::env::var("SPEC") {
        spec = std::fs::read_to_string(f).unwrap();
    }
    let model = match std::env::var("URDF") {
        Ok(f) => {
            let dir = std::path::Path::new(&f).parent().unwrap().to_path_buf();
            hand::load_urdf_with_meshes(&std::fs::read_to_string(&f).unwrap(), |m| {
                std::fs::read(dir.join(m))
            })
            .unwrap()
        }
        Err(_) => hand::load_urdf(hand::SDH_URDF).unwrap(),
    };
    let hand = hand::Hand::new(model, &hand::HandSpec::from_toml(&spec).unwrap()).unwrap();
    let mut sum = 0;
    let mut worst = usize::MAX;
    let names: Vec<String> = std::env::args().skip(1).collect();
    let poses = std::env::var("POSES")
        .ok()
        .and_then(|s| s.parse().ok())
        .unwrap_or(1400);
    for name in &names {
        let surface = if let Some(r) = name.strip_prefix("sphere") {
            shape::RadialShape::sphere(50, r.parse::<f64>().unwrap() / 1e3).unwrap()
        } else {
            let cache = format!("/tmp/hand_fit_{name}.bin");
            let beta = match std::fs::read(&cache) {
                Ok(b) => b
                    .chunks_exact(8)
                    .map(|c| f64::from_le_bytes(c.try_into().unwrap()))
                    .collect(),
                Err(_) => {
                    let bytes = std::fs::read(format!("{root}/objects/{name}.ply")).unwrap();
                    let cloud = shape::PointCloud::new(shape::io::read_ply(&bytes).unwrap().points)
                        .unwrap();
                    let fit = shape::fit::fit(
                        &cloud,
                        &shape::FitSettings {
                            degree: 50,
                            lambda: None,
                        },
                    )
                    .unwrap();
                    let v: Vec<f64> = fit.shape.coefficients().as_slice().to_vec();
                    std::fs::write(
                        &cache,
                        v.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>(),
                    )
                    .unwrap();
                    v
                }
            };
            shape::RadialShape::new(sph::Coefficients::new(beta).unwrap()).unwrap()
        };
        let t = Instant::now();
        let object = hand::CollisionObject::new(&surface).unwrap();
        let build = t.elapsed();
        let params = hand::SynthesisParams {
            poses,
            sampling: hand::PoseSampling::of_hand(&hand),
            rules: hand::ClosingRules::default(),
            convention: grasp::Convention::named("paper").unwrap(),
            centre: nalgebra::Point3::origin(),
            least_quality: 0.01,
        };
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let sampled = params.sampling.sample(&surface, &hand, poses, &mut rng);
        let t = Instant::now();
        let outcomes: Vec<_> = sampled
            .iter()
            .map(|p| hand::evaluate_pose(&object, &hand, p, &params).unwrap())
            .collect();
        let seconds = t.elapsed().as_secs_f64();
        let by_pre = |k: usize| {
            outcomes
                .iter()
                .zip(&sampled)
                .filter(|(o, p)| p.preshape == k && matches!(o, hand::Outcome::Stable(_)))
                .count()
        };
        let pre = (by_pre(0), by_pre(1), by_pre(2));
        if std::env::var("BINS").is_ok() {
            let (lo, hi) = hand.standoff();
            let mut bins = vec![[0usize; 3]; 8];
            for (o, p) in outcomes.iter().zip(&sampled) {
                let t = p.object_from_palm.translation.vector;
                let s = t.norm() - surface.radius(&nalgebra::UnitVector3::new_normalize(t));
                let b = (((s - lo) / (hi - lo) * 8.0) as usize).min(7);
                bins[b][0] += 1;
                if matches!(o, hand::Outcome::Stable(_)) {
                    bins[b][1] += 1;
                }
            }
            println!(
                "   {:?}",
                bins.iter()
                    .map(|b| format!("{:.2}", b[1] as f64 / b[0] as f64))
                    .collect::<Vec<_>>()
            );
        }
        let all = hand::collect(outcomes);
        sum += all.outcomes.stable;
        worst = worst.min(all.outcomes.stable);
        println!(
            "{name}: r {:?} build {build:?} err {:.3} mm; {seconds:.2} s; stable {} {:?} unstable {} {:?} best {:.3} 50th {:.3}",
            surface.radius_bounds(),
            object.mesh_error() * 1e3,
            all.outcomes.stable,
            pre,
            all.outcomes.unstable,
            all.outcomes.by_reason(),
            all.grasps.first().map_or(0.0, |g| g.quality),
            all.grasps.get(49).map_or(0.0, |g| g.quality)
        );
        if std::env::var("DETAIL").is_ok() {
            for (r, c) in &all.outcomes.rejected {
                println!("   {c} {}", r.describe(&hand));
            }
        }
    }
    println!("SUM {sum} WORST {worst}");
}
