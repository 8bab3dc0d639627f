//! Builds the library of known objects and their best hand grasps.

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use experiments::ExperimentError;
use experiments::library::{LibrarySettings, build};
use grasp::Convention;
use record::LibraryRecord;

/// Fits S1 to S12 and stores them with the best grasps of the Schunk hand
#[derive(Debug, Parser)]
#[command(name = "build_library", version)]
struct Args {
    /// Folder for library.bin
    #[arg(long, value_name = "DIR", default_value = "fixtures")]
    out: PathBuf,
    /// Seed of the scans and of the hand poses: the same seed gives the same library
    #[arg(long, default_value_t = LibrarySettings::SEED)]
    seed: u64,
    /// Threads to use; all processors when absent
    #[arg(long)]
    threads: Option<usize>,
}

fn main() -> ExitCode {
    let args = Args::parse();
    match execute(&args) {
        Ok(text) => {
            // A closed pipe is not a failure of the build.
            let _ = writeln!(std::io::stdout(), "{text}");
            ExitCode::SUCCESS
        }
        Err(error) => experiments::program::fail("build_library", &error),
    }
}

fn execute(args: &Args) -> Result<String, ExperimentError> {
    let start = Instant::now();
    let settings = LibrarySettings {
        seed: args.seed,
        ..LibrarySettings::standard(Convention::named("paper")?)
    };
    let threads = args.threads.unwrap_or(0);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()?;
    let library = pool.install(|| build(&settings))?;
    let bytes = library.to_bytes()?;
    let path = experiments::output::write(&args.out, "library.bin", &bytes)?;
    let seconds = start.elapsed().as_secs_f64();
    Ok(format!(
        "{}{} bytes, {seconds:.1} s, {}",
        describe(&library),
        bytes.len(),
        path.display()
    ))
}

fn describe(library: &LibraryRecord) -> String {
    let line = |entry: &record::LibraryEntry| {
        let quality = |grasp: Option<&record::LibraryGrasp>| grasp.map_or(0.0, |g| g.quality);
        format!(
            "{:<4} {:<26} {:>2} grasps, quality {:.3} to {:.3}, rms {:.2} mm, λ {:.2e}\n",
            entry.id,
            entry.name,
            entry.grasps.len(),
            quality(entry.grasps.first()),
            quality(entry.grasps.last()),
            1e3 * entry.shape.rms_m,
            entry.shape.lambda,
        )
    };
    library.entries.iter().map(line).collect()
}
