//! Helpers that the tests of several crates share.
//!
//! - [`scans`] is the folder of real scans. A test that needs it is marked `#[ignore = "needs the
//!   scans of MODULI_DATA"]`. Without the folder such a test is listed as ignored, with the reason,
//!   and counted in the last line of its test program; it never passes without its data. To run all
//!   tests:
//!
//!   ```sh
//!   MODULI_DATA=FOLDER cargo test --workspace -- --include-ignored
//!   ```
//!
//! - [`mod@reference`] holds results of independent programs, which tests compare with.
//! - [`CountingAllocator`] counts the allocations of each thread.
//!
//! ```
//! // Reference values of the first harmonic, Y_{0,0} = 1 / (2 √π).
//! let row = testkit::reference::YLM.lines().nth(1).unwrap();
//! let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
//! assert_eq!(cells[..2], [0.0, 0.0]);
//! assert!((cells[4] - 0.5 / std::f64::consts::PI.sqrt()).abs() < 1e-15);
//! ```

pub mod allocation;
pub mod reference;

pub use allocation::{CountingAllocator, allocations};

use std::path::PathBuf;

/// The environment variable that names the folder of real scans and hands.
const VARIABLE: &str = "MODULI_DATA";

/// The folder of real scans (`objects`) and hands (`hands`).
///
/// # Panics
/// The environment variable `MODULI_DATA` is not set, or is not a folder. A test that was started
/// without its data must fail.
pub fn scans() -> PathBuf {
    let Some(folder) = std::env::var_os(VARIABLE).map(PathBuf::from) else {
        panic!(
            "{VARIABLE} is not set; set it to the folder of the scans, or leave ignored tests out"
        );
    };
    assert!(
        folder.is_dir(),
        "{VARIABLE} is `{}`, which is not a folder",
        folder.display()
    );
    folder
}

/// The bytes of a file below [`scans`].
///
/// # Panics
/// There are no scans, or the file cannot be read.
pub fn scan_bytes(path: &str) -> Vec<u8> {
    let path = scans().join(path);
    std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
