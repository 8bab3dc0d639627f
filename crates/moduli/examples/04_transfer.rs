//! Transfers grasps from known objects to a new one, and improves one of them further.
#![allow(clippy::print_stdout, reason = "a program that prints its result")]

use moduli::{Convention, FitSettings, Hand, Library, Object, PointCloud, Source};

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scan = catalogue::by_id("U2").ok_or("no such object")?.scan(0);
    let settings = FitSettings {
        degree: 30,
        lambda: None,
    };
    let object = Object::from_cloud("U2", &PointCloud::new(scan)?, &settings)?;
    let measure = object.measure(&Convention::paper())?;
    let library = Library::builtin();
    for near in library.nearest(&object, 3)? {
        println!("{}: {:.1} mm away", near.name, 1e3 * near.distance);
    }
    let carried = library.transfer_to(&measure, &Hand::schunk_sdh()?)?;
    for grasp in carried.best(5) {
        if let Source::Transfer { from, naive, .. } = grasp.source() {
            println!("{:.3} from {from}, unimproved {naive:.3}", grasp.quality());
        }
    }
    let best = *carried.best(1).first().ok_or("no grasp arrived")?;
    println!("after an ascent {:.3}", measure.ascend(best)?.quality());
    Ok(())
}
