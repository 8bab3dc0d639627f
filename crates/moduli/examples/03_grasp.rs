//! From a scan to ranked grasps of the built-in hand, as `moduli grasp` does it.
#![allow(clippy::print_stdout, reason = "a program that prints its result")]

use moduli::{Convention, FitSettings, Hand, Library, Object, Plan, PointCloud, Poses};

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scan = catalogue::by_id("U1").ok_or("no such object")?.scan(0);
    let settings = FitSettings {
        degree: 30,
        lambda: None,
    };
    let object = Object::from_cloud("U1", &PointCloud::new(scan)?, &settings)?;
    let measure = object.measure(&Convention::paper())?;
    let hand = Hand::schunk_sdh()?;
    let plan = Plan {
        poses: Poses {
            count: 150,
            ..Poses::default()
        },
        ..Plan::default()
    };
    let planned = plan.run(&measure, &hand, Library::builtin(), &|_| {})?;
    for grasp in planned.grasps.iter().take(5) {
        println!("{:.3} {:?}", grasp.quality(), grasp.palm_in_cloud());
    }
    let file = measure.grasps_file(&hand, &planned.grasps); // the content of grasps.json
    println!("{} grasps on {}", file.grasps.len(), file.object.name);
    Ok(())
}
