//! One object of the catalogue: its true surface and its scans.

use crate::chart::Chart;
use crate::noise::ScanNoise;
use crate::solid::Solid;
use nalgebra::{Point3, Unit, Vector3};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::sync::OnceLock;

/// Number of points of a default scan, as in Sec. IV-A of the paper.
pub const SCAN_POINTS: usize = 25_000;

/// A household object given by an analytic solid.
///
/// It stands on the plane z = 0 with its upright axis along z, in metres; this object frame is not
/// centred. Its surface is star-shaped about [`CatalogueObject::centre`].
#[derive(Debug)]
pub struct CatalogueObject {
    /// Short name in tables: "S1" to "S12" for the library, "U1" and "U2" for the unseen objects.
    pub id: &'static str,
    /// Common name, such as "shampoo bottle".
    pub name: &'static str,
    /// One line on its form and size.
    pub description: &'static str,
    /// Extent along the upright z axis, metres.
    pub height: f64,
    stream: u64,
    solid: Solid,
    chart: OnceLock<Chart>,
}

/// A point of an object's true surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Position in the object frame, metres.
    pub point: Point3<f64>,
    /// Outward unit normal.
    pub normal: Unit<Vector3<f64>>,
    /// Distance from the object's centre, metres.
    pub radius: f64,
}

/// Id, name and description of a new object.
pub(crate) type Label = [&'static str; 3];

impl CatalogueObject {
    /// An object of the given height; `stream` is its stream of random numbers, distinct for every
    /// object.
    pub(crate) fn new(label: Label, stream: u64, height: f64, solid: Solid) -> Self {
        let [id, name, description] = label;
        Self {
            id,
            name,
            description,
            height,
            stream,
            solid,
            chart: OnceLock::new(),
        }
    }

    /// The chart, computed at the first use and cached.
    pub(crate) fn chart(&self) -> &Chart {
        let middle = Point3::new(0.0, 0.0, 0.45 * self.height);
        self.chart.get_or_init(|| Chart::new(&self.solid, middle))
    }

    #[cfg(test)]
    pub(crate) fn solid(&self) -> &Solid {
        &self.solid
    }

    /// Mean of the true surface over its area, object frame, metres: the limit of the mean of an
    /// area-uniform cloud. From a quadrature, accurate to about 0.1 mm.
    pub fn centre(&self) -> Point3<f64> {
        self.chart().centre
    }

    /// Area of the true surface, m², from a quadrature, accurate to about 0.3 %.
    pub fn area(&self) -> f64 {
        self.chart().area
    }

    /// The radial function r(p) from the centre: the distance to the surface along p, metres.
    pub fn radius(&self, direction: &Unit<Vector3<f64>>) -> f64 {
        self.surface(direction).radius
    }

    /// The surface point r(p) p + centre with its normal.
    pub fn surface(&self, direction: &Unit<Vector3<f64>>) -> SurfacePoint {
        let hit = self
            .solid
            .leave(&self.centre(), direction, 0.25 * self.height);
        SurfacePoint {
            point: hit.point,
            normal: Unit::new_unchecked(hit.normal),
            radius: hit.distance,
        }
    }

    /// The implicit function at a point of the object frame: negative inside, zero on the surface.
    ///
    /// It increases at most about as fast as the distance from the surface, but does not equal it.
    pub fn implicit(&self, point: &Point3<f64>) -> f64 {
        self.solid.field(point).value
    }

    /// Signed distance of a point near the surface (within a few millimetres), positive outside,
    /// metres. It is F/|∇F| for the implicit function F, accurate to first order.
    pub fn signed_distance(&self, point: &Point3<f64>) -> f64 {
        let field = self.solid.field(point);
        field.value / field.gradient.norm()
    }

    /// Random points of the surface, uniform by area, with the noise of a scan along the normal.
    ///
    /// Object frame, metres, in random order. About 1 µs per point; 3 µs for objects of many
    /// pieces.
    pub fn sample(&self, points: usize, noise: &ScanNoise, rng: &mut impl Rng) -> Vec<Point3<f64>> {
        let chart = self.chart();
        (0..points)
            .map(|_| {
                let hit = chart.sample(&self.solid, rng);
                noise.disturb(hit.point, &hit.normal, rng)
            })
            .collect()
    }

    /// The default scan: [`SCAN_POINTS`] points with the default noise.
    ///
    /// The same seed gives the same bytes; objects do not share random numbers.
    pub fn scan(&self, seed: u64) -> Vec<Point3<f64>> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(self.stream);
        self.sample(SCAN_POINTS, &ScanNoise::default(), &mut rng)
    }
}
