//! Random shapes and grasps by noise on bands of coefficients (Fig. 5, Sec. IV-B)

use std::process::ExitCode;

fn main() -> ExitCode {
    experiments::program::main(
        "sec4b_sampling",
        "Random shapes and grasps by noise on bands of coefficients (Fig. 5, Sec. IV-B)",
        experiments::sections::sampling::run,
    )
}
