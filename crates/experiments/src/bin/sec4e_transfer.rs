//! Grasps carried between all objects (Fig. 9, Sec. IV-E)

use std::process::ExitCode;

fn main() -> ExitCode {
    experiments::program::main(
        "sec4e_transfer",
        "Grasps carried between all objects (Fig. 9, Sec. IV-E)",
        experiments::sections::transfer::run,
    )
}
