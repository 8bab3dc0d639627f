//! Ascents and transfers on the built-in library, ours beside the paper's scheme: cost and quality.
//!
//! `study ascent|transfer|best COUNT [paper|ours|thorough]…` takes COUNT grasps (or pairs) spread evenly
//! over the library and prints means; run it under `time` for the cost.
#![allow(clippy::print_stdout, reason = "a program that reports")]

use std::error::Error;
use std::time::Instant;

use grasp::Convention;
use moduli::sample::ContactSampling;
use moduli::transfer::{Transfer, all_pairs};
use moduli::{Continuation, MonotoneAscent, Objective, PaperAscent, PaperTransfer};
use nalgebra::Point3;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use record::LibraryRecord;
use shape::RadialField;
use sph::Direction;

const LIBRARY: &[u8] = include_bytes!("../../../fixtures/library.bin");
/// Grasps of every object that are carried, as in Sec. IV-E.
const GRASPS: usize = 10;
/// Runs of the paper's scheme that ours is compared with.
const RUNS: usize = 10;
/// Deviation of their starts from the naive transfer, radians.
const SCATTER: f64 = 0.3;
/// Differences below this are no differences.
const SAME: f64 = 1e-6;

struct Object {
    surface: RadialField,
    origin: Point3<f64>,
    grasps: Vec<Vec<Direction>>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let count = arguments.get(1).map_or(Ok(24), |text| text.parse())?;
    let schemes: Vec<&str> = arguments.iter().skip(2).map(String::as_str).collect();
    let study = Study {
        objects: library()?,
        convention: Convention::named("paper")?,
    };
    match arguments.first().map(String::as_str) {
        Some("ascent") => study.ascents(count, &schemes),
        Some("transfer") => study.transfers(count, &schemes),
        Some("best") => study.best_of_runs(count, &schemes),
        _ => Err("expected ascent, transfer or best, and a count".into()),
    }
}

fn library() -> Result<Vec<Object>, Box<dyn Error>> {
    let library = LibraryRecord::from_bytes(LIBRARY)?;
    library
        .entries
        .iter()
        .map(|entry| {
            let grasps = entry.grasps.iter().take(GRASPS);
            Ok(Object {
                surface: RadialField::new(entry.shape.shape()?),
                origin: Point3::from(-entry.shape.centre_in_cloud().coords),
                grasps: grasps.filter_map(|g| g.directions()).collect(),
            })
        })
        .collect()
}

struct Study {
    objects: Vec<Object>,
    convention: Convention,
}

/// What one scheme did, summed.
#[derive(Default)]
struct Sum {
    ends: Vec<f64>,
    evaluations: usize,
    stationarity: Vec<f64>,
}

impl Sum {
    fn add(&mut self, quality: f64, evaluations: usize, stationarity: f64) {
        self.ends.push(quality);
        self.evaluations += evaluations;
        self.stationarity.push(stationarity);
    }

    fn print(&self, name: &str, seconds: f64) {
        let count = self.ends.len() as f64;
        let mean = |list: &[f64]| list.iter().sum::<f64>() / count;
        let most = self.stationarity.iter().copied().fold(0.0, f64::max);
        let mut sorted = self.stationarity.clone();
        sorted.sort_by(f64::total_cmp);
        println!(
            "{name:9} mean Q {:.5}, below 0.01: {}, {:.0} evaluations, {:.2} µs each, \
             {:.2} ms a grasp; stationarity mean {:.5}, median {:.6}, above 0.001: {}, most {most:.4}",
            mean(&self.ends),
            self.ends.iter().filter(|q| **q < 0.01).count(),
            self.evaluations as f64 / count,
            1e6 * seconds / self.evaluations as f64,
            1e3 * seconds / count,
            mean(&self.stationarity),
            sorted[sorted.len() / 2],
            sorted.iter().filter(|s| **s > 1e-3).count(),
        );
    }
}

impl Study {
    /// COUNT grasps over all objects, spread evenly: (object, grasp).
    fn starts(&self, count: usize) -> Vec<(usize, usize)> {
        let all: Vec<(usize, usize)> = (0..self.objects.len())
            .flat_map(|k| (0..self.objects[k].grasps.len()).map(move |g| (k, g)))
            .collect();
        spread(all.len(), count).map(|i| all[i]).collect()
    }

    fn ascents(&self, count: usize, schemes: &[&str]) -> Result<(), Box<dyn Error>> {
        for scheme in ["paper", "ours"] {
            if !schemes.is_empty() && !schemes.contains(&scheme) {
                continue;
            }
            let (mut sum, mut below, clock) = (Sum::default(), 0, Instant::now());
            for (k, g) in self.starts(count) {
                let Object {
                    surface, origin, ..
                } = &self.objects[k];
                let start = &self.objects[k].grasps[g];
                let mut objective = Objective::new(&self.convention, surface, origin);
                let end = if scheme == "paper" {
                    paper_ascent(1000).climb(surface, start, &mut objective, |_| {})?
                } else {
                    MonotoneAscent::default().climb(surface, start, &mut objective, |_| {})?
                };
                below += usize::from(end.quality < end.start_quality);
                sum.add(end.quality, end.evaluations, end.stationarity);
            }
            sum.print(scheme, clock.elapsed().as_secs_f64());
            println!("{:9} {below} of {count} below their start", "");
        }
        Ok(())
    }

    fn jobs(&self, count: usize) -> Vec<moduli::transfer::Job> {
        let grasps: Vec<usize> = self.objects.iter().map(|o| o.grasps.len()).collect();
        let all = all_pairs(&grasps);
        spread(all.len(), count).map(|i| all[i]).collect()
    }

    fn transfers(&self, count: usize, schemes: &[&str]) -> Result<(), Box<dyn Error>> {
        for scheme in ["paper", "ours", "thorough"] {
            if !schemes.is_empty() && !schemes.contains(&scheme) {
                continue;
            }
            let (mut sum, clock) = (Sum::default(), Instant::now());
            for job in self.jobs(count) {
                let end = self.carry(&job, scheme)?;
                sum.add(
                    end.quality,
                    end.evaluations,
                    end.stationarity.unwrap_or(0.0),
                );
            }
            sum.print(scheme, clock.elapsed().as_secs_f64());
        }
        Ok(())
    }

    fn transfer(&self, job: &moduli::transfer::Job) -> Transfer<'_> {
        Transfer {
            from: &self.objects[job.from].surface,
            to: &self.objects[job.to].surface,
            convention: &self.convention,
            object_origin: self.objects[job.to].origin,
        }
    }

    fn carry(
        &self,
        job: &moduli::transfer::Job,
        scheme: &str,
    ) -> Result<moduli::Transferred, Box<dyn Error>> {
        let transfer = self.transfer(job);
        let start = &self.objects[job.from].grasps[job.grasp];
        if scheme == "paper" {
            let scheme = paper_transfer();
            let stations = scheme.stations(&transfer)?;
            return Ok(scheme.carry(&transfer, &stations, start, |_, _| {})?);
        }
        let scheme = match scheme {
            "thorough" => Continuation::thorough(),
            _ => Continuation::default(),
        };
        let stations = scheme.stations(&transfer)?;
        Ok(scheme.carry(&transfer, &stations, start, |_, _| {})?)
    }

    /// Ours against the best of the paper's transfer from the grasp itself and from others
    /// scattered around it: on the target, θ and φ kept, that is around the naive transfer.
    fn best_of_runs(&self, count: usize, schemes: &[&str]) -> Result<(), Box<dyn Error>> {
        let names: Vec<&str> = ["ours", "thorough"]
            .into_iter()
            .filter(|s| schemes.is_empty() || schemes.contains(s))
            .collect();
        let mut gaps: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
        for (index, job) in self.jobs(count).iter().enumerate() {
            let best = self.best_of_paper(job, index as u64)?;
            print!("{} {} {}: {best:.4}", job.from, job.to, job.grasp);
            for (name, gaps) in names.iter().zip(&mut gaps) {
                let end = self.carry(job, name)?;
                print!(" {name} {:+.4}", end.quality - best);
                gaps.push(end.quality - best);
            }
            println!();
        }
        for (name, gaps) in names.iter().zip(&gaps) {
            let share = |least: f64| {
                let reached = gaps.iter().filter(|g| **g >= -least).count();
                100.0 * reached as f64 / gaps.len() as f64
            };
            println!(
                "{name:9} at least the best of {RUNS}: {:.1} %, within 0.001: {:.1} %, 0.01: {:.1} %; mean gain {:+.4}, worst {:+.4}",
                share(SAME),
                share(1e-3),
                share(1e-2),
                gaps.iter().sum::<f64>() / gaps.len() as f64,
                gaps.iter().copied().fold(f64::INFINITY, f64::min),
            );
        }
        Ok(())
    }

    /// The best of [`RUNS`] of the paper's ascents on the target, from starts scattered around the
    /// naive transfer, each with all the steps of a whole transfer.
    fn best_of_paper(&self, job: &moduli::transfer::Job, seed: u64) -> Result<f64, Box<dyn Error>> {
        let (from, to) = (&self.objects[job.from], &self.objects[job.to]);
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let around = ContactSampling::Around(&from.grasps[job.grasp], SCATTER);
        let mut best = 0.0_f64;
        for _ in 0..RUNS {
            let start = around.draw(&mut rng);
            let mut objective = Objective::new(&self.convention, &to.surface, &to.origin);
            let end = paper_ascent(1000).climb(&to.surface, &start, &mut objective, |_| {})?;
            best = best.max(end.quality);
        }
        Ok(best)
    }
}

/// `count` of 0 … total−1, evenly.
fn spread(total: usize, count: usize) -> impl Iterator<Item = usize> {
    let count = count.min(total);
    (0..count).map(move |i| (2 * i + 1) * total / (2 * count))
}

fn paper_ascent(steps: usize) -> PaperAscent {
    PaperAscent {
        steps,
        delta: 1e-5,
        rate: 0.01,
    }
}

fn paper_transfer() -> PaperTransfer {
    PaperTransfer {
        intervals: 10,
        ascent: paper_ascent(100),
    }
}
