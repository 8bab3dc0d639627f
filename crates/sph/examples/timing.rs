//! scratch
#![allow(clippy::print_stdout)]
use sph::Direction;
use sph::regression::{Gram, Penalty, Samples};
use std::time::Instant;
fn main() {
    let l: usize = std::env::args().nth(1).unwrap().parse().unwrap();
    for f in std::env::args().skip(2) {
        let b = std::fs::read(&f).unwrap();
        let x: Vec<f64> = b.chunks(8).map(|c| f64::from_le_bytes(c.try_into().unwrap())).collect();
        let v: Vec<nalgebra::Vector3<f64>> = x.chunks(3).map(|c| nalgebra::Vector3::new(c[0], c[1], c[2])).collect();
        let values: Vec<f64> = v.iter().map(|v| v.norm()).collect();
        let p: Vec<Direction> = v.iter().map(|v| Direction::new_normalize(*v)).collect();
        let s = Samples { directions: &p, values: &values };
        let t = Instant::now();
        let g = Gram::new(s, l).unwrap();
        let t1 = t.elapsed();
        let t = Instant::now();
        let lam = g.choose_penalty(2).unwrap();
        let t2 = t.elapsed();
        let t = Instant::now();
        let c = g.solve(s, lam).unwrap();
        let t3 = t.elapsed();
        let t = Instant::now();
        let d = g.solve(s, Penalty::NONE);
        let t4 = t.elapsed();
        println!("{f}: new {t1:?} choose {t2:?} ({:.2}) solve {t3:?} cond {:.1} plain {t4:?} {:?}", (lam.lambda / p.len() as f64).log10(), c.condition, d.map(|d| d.condition));
    }
}
