//! Grasps of the Schunk hand from random poses (Sec. IV-C)

use std::process::ExitCode;

fn main() -> ExitCode {
    experiments::program::main(
        "sec4c_initial_grasps",
        "Grasps of the Schunk hand from random poses (Sec. IV-C)",
        experiments::sections::initial_grasps::run,
    )
}
