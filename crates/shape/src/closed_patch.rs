//! Parts of a surface where the object has a hole: a membrane closes a handle, and nothing is there.

use nalgebra::Point3;

/// A part of a surface that closes a hole of the object.
///
/// A surface of genus zero cannot have a handle, so a fit closes it by a thin slab. Nothing can be
/// touched there, and nothing may pass through it either, because the real hole was not measured.
/// Metres, in the frame of the surface that it belongs to.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedPatch {
    /// Points of the middle of the slab.
    pub places: Vec<Point3<f64>>,
    /// Points of the surface within this distance of one of the places belong to the patch.
    pub reach: f64,
    /// Area of one side, m².
    pub area: f64,
}

impl ClosedPatch {
    /// Distance of a point from the nearest place, less the reach: negative on the patch.
    pub fn distance(&self, x: &Point3<f64>) -> f64 {
        self.nearest(x)
            .map_or(f64::INFINITY, |(_, d)| d - self.reach)
    }

    /// The place nearest to a point, and its distance.
    pub fn nearest(&self, x: &Point3<f64>) -> Option<(Point3<f64>, f64)> {
        let squared = self.places.iter().map(|p| (p, (p - x).norm_squared()));
        let nearest = squared.min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some((*nearest.0, nearest.1.sqrt()))
    }

    /// Middle of the places; none where there is no place.
    pub fn centre(&self) -> Option<Point3<f64>> {
        let sum: nalgebra::Vector3<f64> = self.places.iter().map(|p| p.coords).sum();
        (!self.places.is_empty()).then(|| Point3::from(sum / self.places.len() as f64))
    }

    /// The patch moved by a vector.
    #[must_use]
    pub fn moved(&self, by: &nalgebra::Vector3<f64>) -> Self {
        Self {
            places: self.places.iter().map(|p| p + by).collect(),
            ..self.clone()
        }
    }
}

/// The patch that a point of a surface is on.
pub fn patch_at<'a>(patches: &'a [ClosedPatch], x: &Point3<f64>) -> Option<&'a ClosedPatch> {
    patches.iter().find(|patch| patch.distance(x) <= 0.0)
}
