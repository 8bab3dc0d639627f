//! Reconstruction error against the degree L (Fig. 2, Sec. III-B)

use std::process::ExitCode;

fn main() -> ExitCode {
    experiments::program::main(
        "fig2_reconstruction",
        "Reconstruction error against the degree L (Fig. 2, Sec. III-B)",
        experiments::sections::reconstruction::run,
    )
}
