//! The shape space with spheres and deformations (Fig. 4, Sec. IV-A)

use std::process::ExitCode;

fn main() -> ExitCode {
    experiments::program::main(
        "sec4a_shape_space",
        "The shape space with spheres and deformations (Fig. 4, Sec. IV-A)",
        experiments::sections::shape_space::run,
    )
}
