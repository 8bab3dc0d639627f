//! Measures one grasp under every convention, then all its metrics under one.
#![allow(clippy::print_stdout, reason = "a program that prints its result")]

use moduli::{Convention, FitSettings, Metrics, Object, PointCloud};

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scan = catalogue::by_id("U1").ok_or("no such object")?.scan(0);
    let settings = FitSettings {
        degree: 20,
        lambda: None,
    };
    let object = Object::from_cloud("U1", &PointCloud::new(scan)?, &settings)?;
    // Three points near the surface, in the frame of the cloud, metres.
    let c = object.frame().centre_in_cloud();
    let points = [[0.1, 0.0], [-0.05, 0.09], [-0.05, -0.09]].map(|[x, y]| [c.x + x, c.y + y, c.z]);
    for name in Convention::NAMES {
        let measure = object.measure(&Convention::named(name)?)?;
        let grasp = measure.grasp_at(&points)?;
        let (q, stable) = (grasp.quality(), measure.is_stable(grasp.epsilon().lower));
        println!("{name:9} quality {q:.5}, stable: {stable}");
    }
    let measure = object.measure(&Convention::paper())?;
    let metrics = measure.metrics(&measure.grasp_at(&points)?)?;
    for (name, value) in Metrics::COLUMNS
        .iter()
        .zip(metrics.row(measure.convention()))
    {
        println!("{name:24} {value:?}");
    }
    Ok(())
}
