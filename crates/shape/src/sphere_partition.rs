//! A partition of the sphere into cells of nearly equal area.

use nalgebra::Vector3;
use sph::Direction;
use sph::direction::{retract, tangent_frame};

/// Mean number of points per coarse cell; with this many an empty cell is significant.
const POINTS_PER_VIEW: usize = 160;

/// Cells of nearly equal area: bands of latitude, each cut into sectors.
pub(crate) struct SpherePartition {
    /// Index of each band's first cell, and at the end the number of cells.
    starts: Vec<usize>,
}

impl SpherePartition {
    /// About `count` cells, at least 8.
    pub(crate) fn new(count: usize) -> Self {
        let bands = ((count.max(8) as f64 * std::f64::consts::PI).sqrt() / 2.0).round() as usize;
        let height = std::f64::consts::PI / bands as f64;
        let mut starts = vec![0];
        for band in 0..bands {
            let sine = ((band as f64 + 0.5) * height).sin();
            let sectors = (std::f64::consts::TAU * sine / height).round().max(1.0) as usize;
            starts.push(starts[band] + sectors);
        }
        Self { starts }
    }

    /// Cells so coarse that an empty one is significant: nothing was observed there.
    pub(crate) fn for_views(points: usize) -> Self {
        Self::new(points / POINTS_PER_VIEW)
    }

    /// The cells that share an edge with a cell, from points just outside its four sides.
    pub(crate) fn neighbours(&self, cell: usize) -> Vec<usize> {
        let step = std::f64::consts::PI / self.bands() as f64;
        let p = self.centre(cell);
        let (north, east) = compass(&p);
        let mut around: Vec<usize> = [north, -north, east, -east]
            .iter()
            .map(|v| self.index(&retract(&p, &(v * step))))
            .filter(|k| *k != cell)
            .collect();
        around.dedup();
        around
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        self.starts[self.bands()]
    }

    /// Area of a cell on the unit sphere, steradians.
    pub(crate) fn solid_angle(&self, cell: usize) -> f64 {
        let band = self.band(cell);
        let edge = |band: usize| (std::f64::consts::PI * band as f64 / self.bands() as f64).cos();
        let sectors = self.starts[band + 1] - self.starts[band];
        std::f64::consts::TAU * (edge(band) - edge(band + 1)) / sectors as f64
    }

    fn band(&self, cell: usize) -> usize {
        self.starts.partition_point(|start| *start <= cell) - 1
    }

    fn bands(&self) -> usize {
        self.starts.len() - 1
    }

    /// The cell of a direction.
    pub(crate) fn index(&self, p: &Direction) -> usize {
        let part = |x: f64, n: usize| ((x * n as f64).max(0.0) as usize).min(n - 1);
        let theta = p.x.hypot(p.y).atan2(p.z);
        let band = part(theta / std::f64::consts::PI, self.bands());
        let turn = p.y.atan2(p.x) / std::f64::consts::TAU + 0.5;
        self.starts[band] + part(turn, self.starts[band + 1] - self.starts[band])
    }

    /// A direction in the middle of a cell.
    pub(crate) fn centre(&self, cell: usize) -> Direction {
        let band = self.band(cell);
        let sectors = self.starts[band + 1] - self.starts[band];
        let theta = std::f64::consts::PI * (band as f64 + 0.5) / self.bands() as f64;
        let turn = ((cell - self.starts[band]) as f64 + 0.5) / sectors as f64 - 0.5;
        let phi = std::f64::consts::TAU * turn;
        sph::SphericalCoords { theta, phi }.direction()
    }
}

/// Unit tangents towards larger z and along increasing azimuth; any two at the poles.
fn compass(p: &Direction) -> (Vector3<f64>, Vector3<f64>) {
    let up = Vector3::z() - p.into_inner() * p.z;
    match up.try_normalize(1e-9) {
        Some(north) => (north, north.cross(p)),
        None => tangent_frame(p),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sph::direction::even_directions;

    #[test]
    fn every_cell_holds_its_centre_and_its_share() {
        for count in [8, 30, 500] {
            let cells = SpherePartition::new(count);
            let mut hits = vec![0_usize; cells.count()];
            for p in even_directions(100 * cells.count()) {
                hits[cells.index(&p)] += 1;
            }
            assert!(hits.iter().all(|h| (30..300).contains(h)), "{hits:?}");
            for cell in 0..cells.count() {
                assert_eq!(cells.index(&cells.centre(cell)), cell);
            }
        }
    }
}
