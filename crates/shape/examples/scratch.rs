//! scratch
use shape::*;
fn main() {
    let dir = "/work/shared/data/objects/";
    let idx = std::fs::read_to_string(format!("{dir}index.tsv")).unwrap();
    for l in idx.lines().skip(1) {
        let c: Vec<&str> = l.split('\t').collect();
        let b = std::fs::read(format!("{dir}{}", c[2])).unwrap();
        let cloud = PointCloud::new(io::read_ply(&b).unwrap().points).unwrap();
        let seen = cloud.seen_from(&cloud.mean());
        let lo = seen.radii.iter().cloned().fold(1e9, f64::min) * 1e3;
        let hi = seen.radii.iter().cloned().fold(0., f64::max) * 1e3;
        let t = std::time::Instant::now();
        match fit::fit(
            &cloud,
            &FitSettings {
                degree: 50,
                lambda: None,
            },
        ) {
            Ok(f) => {
                let (a, b) = f.shape.radius_bounds();
                println!(
                    "{:24} {} {} data {lo:.1}..{hi:.1} fit {:.1}..{:.1} rms {:.3} max {:.2} lam {:.1e} cond {:.0} {:.2}s",
                    c[0],
                    c[1],
                    c[9],
                    a * 1e3,
                    b * 1e3,
                    f.rms * 1e3,
                    f.max_abs * 1e3,
                    f.lambda,
                    f.condition,
                    t.elapsed().as_secs_f64()
                )
            }
            Err(e) => println!(
                "{:24} {} {} data {lo:.1}..{hi:.1} {e} {:.2}s",
                c[0],
                c[1],
                c[9],
                t.elapsed().as_secs_f64()
            ),
        }
    }
}
