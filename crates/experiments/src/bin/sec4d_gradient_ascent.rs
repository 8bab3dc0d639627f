//! The ascent in quality on one surface (Fig. 7 and 8, Sec. IV-D)

use std::process::ExitCode;

fn main() -> ExitCode {
    experiments::program::main(
        "sec4d_gradient_ascent",
        "The ascent in quality on one surface (Fig. 7 and 8, Sec. IV-D)",
        experiments::sections::gradient_ascent::run,
    )
}
