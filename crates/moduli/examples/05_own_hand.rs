//! Grasps of a custom hand, given by a URDF and a TOML that states how the hand is used.
#![allow(clippy::print_stdout, reason = "a program that prints its result")]

use moduli::{Convention, FitSettings, Hand, Object, PointCloud, Poses};

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (urdf, spec) = (
        include_str!("gripper.urdf"), // three fingers that slide towards the axis of the palm
        include_str!("gripper.toml"),
    );
    let hand = Hand::from_texts(urdf, spec)?;
    let scan = catalogue::by_id("U1").ok_or("no such object")?.scan(0);
    let settings = FitSettings {
        degree: 20,
        lambda: None,
    };
    let object = Object::from_cloud("U1", &PointCloud::new(scan)?, &settings)?;
    let measure = object.measure(&Convention::paper())?;
    let poses = Poses {
        count: 200,
        ..Poses::default()
    };
    let grasps = measure.synthesize(&hand, &poses)?;
    println!("{} of 200 poses give a stable grasp", grasps.len());
    for placement in grasps.best(3).iter().filter_map(|g| g.hand()) {
        println!("fingers at {:.4?} m", placement.joints);
    }
    Ok(())
}
