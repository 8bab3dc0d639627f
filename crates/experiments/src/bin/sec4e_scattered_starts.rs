//! Our transfer against many runs of the paper's ascent (beyond Sec. IV-E)

use std::process::ExitCode;

fn main() -> ExitCode {
    experiments::program::main(
        "sec4e_scattered_starts",
        "Our transfer against many runs of the paper's ascent (beyond Sec. IV-E)",
        experiments::sections::scattered_starts::run,
    )
}
