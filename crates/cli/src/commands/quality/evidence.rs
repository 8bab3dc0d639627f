//! The evidence of a cloud for given grasps.

use grasp::{GraspModel, Uncertainty, Workspace, robust_quality};
use shape::{Evidence, PAD_RADIUS, PointCloud};

use crate::args::{Common, QualityOptions};
use crate::failure::Failure;
use crate::input;

/// A contact farther from all points of the cloud than this is not on its object, metres.
const ON_OBJECT: f64 = 0.02;

/// Names of the columns that a cloud adds.
pub(super) const COLUMNS: [&str; 3] =
    ["robust_quality", "distance_to_cloud_m", "normal_spread_deg"];

/// The cloud of the options and the warnings of its reader.
pub(super) fn read(
    options: &QualityOptions,
    common: &Common,
) -> Result<Option<input::Scan>, Failure> {
    let scan = |path| input::scan(path, &options.reading, common.seed);
    options.cloud.as_deref().map(scan).transpose()
}

/// The robust quality of a grasp, and of its contacts the largest distance from the data and the
/// largest spread of the data's normals. The spread is absent if a contact is unseen.
pub(super) fn cells(
    model: &GraspModel<'_>,
    cloud: &PointCloud,
    work: &mut Workspace,
) -> Result<[Option<f64>; 3], moduli::Error> {
    let found: Vec<Evidence> = model
        .contacts
        .iter()
        .map(|c| shape::evidence(cloud.points(), &c.position, &c.inward_normal, PAD_RADIUS))
        .collect();
    let known: Vec<Uncertainty> = found.iter().map(moduli::uncertainty).collect();
    let robust = robust_quality(model, &known, work)?;
    let distance = found.iter().map(|e| e.distance).fold(0.0, f64::max);
    let spread = found.iter().map(|e| e.normal_spread).fold(0.0, f64::max);
    let seen = found.iter().all(|e| e.seen);
    Ok([
        Some(robust),
        Some(distance),
        seen.then(|| spread.to_degrees()),
    ])
}

/// A warning about contacts that are far from every point of the cloud, from the distances of the grasps.
pub(super) fn warning(distances: impl Iterator<Item = Option<f64>>) -> Option<String> {
    let far = |(_, distance): &(usize, Option<f64>)| distance.is_some_and(|d| d > ON_OBJECT);
    let (first, distance) = distances.enumerate().find(far)?;
    Some(format!(
        "a contact of grasp {first} is {:.1} mm from the nearest point of the cloud; \
         are these grasps of another object, in another frame or in another unit?",
        1e3 * distance.unwrap_or_default()
    ))
}
