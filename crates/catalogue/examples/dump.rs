//! throwaway
#![allow(clippy::all, clippy::print_stdout)]
use nalgebra::*;
fn main() {
    for o in catalogue::library_objects()
        .iter()
        .chain(catalogue::unseen_objects())
    {
        let t = std::time::Instant::now();
        let s = o.scan(1);
        let t1 = t.elapsed();
        let t = std::time::Instant::now();
        let _ = o.scan(2);
        let t2 = t.elapsed();
        let (mut lo, mut hi) = (Vector3::repeat(9.0f64), Vector3::repeat(-9.0f64));
        for p in &s {
            lo = lo.inf(&p.coords);
            hi = hi.sup(&p.coords);
        }
        let (nt, np) = (140usize, 200usize);
        let mut txt = String::new();
        let mut worst = (9.0f64, Vector3::zeros());
        let (mut r0, mut r1) = (9.0f64, 0.0f64);
        for i in 0..=nt {
            for j in 0..=np {
                let th = std::f64::consts::PI * i as f64 / nt as f64;
                let ph = 2.0 * std::f64::consts::PI * j as f64 / np as f64;
                let d = Unit::new_normalize(Vector3::new(
                    th.sin() * ph.cos(),
                    th.sin() * ph.sin(),
                    th.cos(),
                ));
                let h = o.surface(&d);
                let c = h.normal.dot(&d);
                if c < worst.0 {
                    worst = (c, h.point.coords);
                }
                r0 = r0.min(h.radius);
                r1 = r1.max(h.radius);
                let mut crossings = 0;
                let mut neg = true;
                for k in 1..600 {
                    let p = o.centre() + d.into_inner() * (0.25 * k as f64 / 600.0);
                    let n = o.implicit(&p) < 0.0;
                    if n != neg {
                        crossings += 1;
                        neg = n;
                    }
                }
                if crossings != 1 {
                    println!("  {} crossings {} at {:?}", o.id, crossings, d);
                }
                txt += &format!(
                    "{} {} {} {} {} {}\n",
                    h.point.x, h.point.y, h.point.z, h.normal.x, h.normal.y, h.normal.z
                );
            }
        }
        std::fs::write(format!("/tmp/cat/{}.txt", o.id), txt).unwrap();
        let cl: String = s
            .iter()
            .map(|p| format!("{} {} {}\n", p.x, p.y, p.z))
            .collect();
        std::fs::write(format!("/tmp/cat/{}.xyz", o.id), cl).unwrap();
        println!(
            "{} {:26} {:?} {:?} ext {:.4} {:.4} {:.4} zlo {:.4} h {:.4} centre {:.4} {:.4} {:.4} r {:.4} {:.4} mincos {:.3} at {:.3} {:.3} {:.3}",
            o.id,
            o.name,
            t1,
            t2,
            hi.x - lo.x,
            hi.y - lo.y,
            hi.z - lo.z,
            lo.z,
            o.height,
            o.centre().x,
            o.centre().y,
            o.centre().z,
            r0,
            r1,
            worst.0,
            worst.1.x,
            worst.1.y,
            worst.1.z
        );
    }
    for o in catalogue::library_objects()
        .iter()
        .chain(catalogue::unseen_objects())
    {
        use rand::SeedableRng;
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let s = o.sample(100000, &catalogue::ScanNoise::NONE, &mut rng);
        let (mut lo, mut hi) = (Vector3::repeat(9.0f64), Vector3::repeat(-9.0f64));
        for p in &s {
            lo = lo.inf(&p.coords);
            hi = hi.sup(&p.coords);
        }
        let mut hollow = -9.0f64;
        for i in 0..500 {
            for j in 0..i {
                hollow = hollow.max(o.implicit(&center(&s[i], &s[j])));
            }
        }
        let mut a = vec![];
        for n in [320usize, 1000] {
            let mut t = 0.0;
            for i in 0..n {
                for j in 0..n {
                    let z: f64 = -1.0 + 2.0 * (i as f64 + 0.5) / n as f64;
                    let ph = 2.0 * std::f64::consts::PI * (j as f64 + 0.5) / n as f64;
                    let q = (1.0 - z * z).sqrt();
                    let d = Unit::new_normalize(Vector3::new(q * ph.cos(), q * ph.sin(), z));
                    let h = o.surface(&d);
                    t += h.radius * h.radius / h.normal.dot(&d);
                }
            }
            a.push(t * 4.0 * std::f64::consts::PI / (n * n) as f64 / o.area() - 1.0);
        }
        println!(
            "{} {:20} lo {:.4} {:.4} {:.4} hi {:.4} {:.4} {:.4} h {:.4} ext {:.4} {:.4} hollow {:.4} area {:.5} err {:.4} {:.4}",
            o.id,
            o.name,
            lo.x,
            lo.y,
            lo.z,
            hi.x,
            hi.y,
            hi.z,
            o.height,
            hi.x - lo.x,
            hi.y - lo.y,
            hollow,
            o.area(),
            a[0],
            a[1]
        );
    }
    // L2
    let rs: Vec<Vec<f64>> = catalogue::library_objects()
        .iter()
        .map(|o| {
            let mut v = vec![];
            for i in 0..90 {
                for j in 0..120 {
                    let z: f64 = -1.0 + 2.0 * (i as f64 + 0.5) / 90.0;
                    let ph = 2.0 * std::f64::consts::PI * (j as f64 + 0.5) / 120.0;
                    let s = (1.0 - z * z).sqrt();
                    v.push(o.radius(&Unit::new_normalize(Vector3::new(
                        s * ph.cos(),
                        s * ph.sin(),
                        z,
                    ))));
                }
            }
            v
        })
        .collect();
    let n = rs[0].len() as f64;
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>() / n;
    let sub = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x - y).collect::<Vec<_>>();
    for s in [7usize, 8] {
        for e in [1usize, 2, 10, 11] {
            let a = &rs[4];
            let b = &rs[e - 1];
            let c = &rs[s - 1];
            let ab = sub(b, a);
            let ac = sub(c, a);
            let t = (dot(&ab, &ac) / dot(&ab, &ab)).clamp(0., 1.);
            let foot: Vec<f64> = ac.iter().zip(&ab).map(|(x, y)| x - t * y).collect();
            let (d, d5, de) = (dot(&foot, &foot).sqrt(), dot(&ac, &ac).sqrt(), {
                let w = sub(c, b);
                dot(&w, &w).sqrt()
            });
            println!(
                "S{s} to S5-S{e}: t {t:.2} dist {:.2} mm, to S5 {:.2}, to end {:.2}, ratio {:.2}",
                d * 1e3,
                d5 * 1e3,
                de * 1e3,
                d / d5.min(de)
            );
        }
    }
    for i in 0..12 {
        println!(
            "{}",
            (0..12)
                .map(|j| {
                    let w = sub(&rs[i], &rs[j]);
                    format!("{:6.2}", 1e3 * dot(&w, &w).sqrt())
                })
                .collect::<String>()
        );
    }
}
