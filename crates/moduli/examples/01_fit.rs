//! Fits a surface to a scan, prints how well it fits, and stores it.
#![allow(clippy::print_stdout, reason = "a program that prints its result")]

use moduli::{FitSettings, Object, PointCloud};

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A noisy scan of a built-in object. For a file: Object::from_bytes(&bytes, Format::Ply).
    let scan = catalogue::by_id("U1").ok_or("no such object")?.scan(0);
    let settings = FitSettings {
        degree: 50,
        lambda: None, // chosen from the data
    };
    let object = Object::from_cloud("U1", &PointCloud::new(scan)?, &settings)?;
    let report = object.report();
    println!("{} points, rms {:.3} mm", report.points, 1e3 * report.rms);
    let (low, high) = object.radius_bounds();
    println!("proved: {:.1} mm < r < {:.1} mm", 1e3 * low, 1e3 * high);

    let bytes = object.to_shape_file()?; // what `moduli fit -o` writes
    let again = Object::from_shape_file(&bytes)?;
    assert_eq!(again.to_record(), object.to_record());
    Ok(())
}
