//! Eigenfunctions of the Laplacian on the sphere (Fig. 1, Sec. II-C)

use std::process::ExitCode;

fn main() -> ExitCode {
    experiments::program::main(
        "fig1_eigenfunctions",
        "Eigenfunctions of the Laplacian on the sphere (Fig. 1, Sec. II-C)",
        experiments::sections::eigenfunctions::run,
    )
}
