//! Membranes: where a handle was closed, since the carving keeps the topology of a ball.

use nalgebra::Point3;

use crate::carve::Carving;
use crate::lattice::Lattice;
use crate::mesh::Mesh;

/// A membrane of a smaller radius, in steps of the lattice, spans a gap between points, not a hole.
const LEAST_RADIUS: f64 = 1.5;

/// A hole that was closed to make the surface one of genus zero.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedHole {
    /// Middle of the membrane.
    pub centre: Point3<f64>,
    /// Area of the membrane, one side.
    pub area: f64,
    /// Largest distance of the membrane from its middle.
    pub radius: f64,
    /// Vertices of the lattice in the membrane.
    pub places: Vec<Point3<f64>>,
    /// How far the surface of the slab is from the nearest of the places, at most and about.
    pub reach: f64,
}

/// Vertices that are inside but far from all points, although the outside touches them.
pub(crate) struct Membranes {
    /// Vertices of all membranes, membrane after membrane.
    vertices: Vec<(usize, usize)>,
    count: usize,
}

impl Membranes {
    /// The membranes of a carving that stopped at `probe` from the points.
    pub(crate) fn find(carving: &Carving, distances: &[f32], probe: f64) -> Self {
        let of_membrane = |at: usize| f64::from(distances[at]) > probe && carving.on_surface(at);
        let mut label = vec![u32::MAX; distances.len()];
        let mut vertices = Vec::new();
        let mut count = 0;
        for start in 0..distances.len() {
            if !carving.inside[start] || label[start] != u32::MAX || !of_membrane(start) {
                continue;
            }
            let mut stack = vec![start];
            label[start] = count as u32;
            while let Some(at) = stack.pop() {
                vertices.push((at, count));
                for n in carving.neighbours(at) {
                    if carving.inside[n] && label[n] == u32::MAX && of_membrane(n) {
                        label[n] = count as u32;
                        stack.push(n);
                    }
                }
            }
            count += 1;
        }
        Self { vertices, count }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.vertices.is_empty()
    }

    /// Distance to the nearest membrane up to `reach`; infinite beyond.
    pub(crate) fn distances(&self, lattice: &Lattice, reach: f64) -> Vec<f32> {
        let mut squared = vec![f32::INFINITY; lattice.len()];
        for (at, _) in &self.vertices {
            lattice.visit(&lattice.place(*at), reach, |to, d, _| {
                squared[to] = squared[to].min(d as f32);
            });
        }
        squared.iter().map(|d| d.sqrt()).collect()
    }

    /// The holes, with areas from the triangles of the mesh that are farther than `probe` from all
    /// points and nearest to the membrane, both sides, halved; `slab` is half the thickness that
    /// membranes are given.
    pub(crate) fn holes(
        &self,
        lattice: &Lattice,
        mesh: &Mesh,
        distances: &[f32],
        probe: f64,
        slab: f64,
    ) -> Vec<ClosedHole> {
        let places: Vec<Vec<Point3<f64>>> = (0..self.count)
            .map(|k| {
                let of = self.vertices.iter().filter(|(_, of)| *of == k);
                of.map(|(at, _)| lattice.place(*at)).collect()
            })
            .collect();
        let mut areas = vec![0.0; self.count];
        for triangle in &mesh.triangles {
            let corners = mesh.corners(triangle);
            let middle =
                Point3::from((corners[0].coords + corners[1].coords + corners[2].coords) / 3.0);
            if far(lattice, distances, &middle) <= probe {
                continue;
            }
            let gap = |places: &Vec<Point3<f64>>| {
                let squared = places.iter().map(|p| (p - middle).norm_squared());
                squared.fold(f64::INFINITY, f64::min)
            };
            let nearest =
                (0..self.count).min_by(|a, b| gap(&places[*a]).total_cmp(&gap(&places[*b])));
            if let Some(k) = nearest {
                areas[k] += 0.5 * mesh.area_vector(triangle).norm();
            }
        }
        let mut holes: Vec<ClosedHole> = places
            .into_iter()
            .zip(areas)
            .map(|(places, area)| {
                let sum: nalgebra::Vector3<f64> = places.iter().map(|p| p.coords).sum();
                let centre = Point3::from(sum / places.len() as f64);
                let radii = places.iter().map(|p| (p - centre).norm());
                ClosedHole {
                    centre,
                    area,
                    radius: radii.fold(0.0, f64::max),
                    places,
                    reach: slab + lattice.step,
                }
            })
            .filter(|hole| hole.radius >= LEAST_RADIUS * lattice.step)
            .collect();
        holes.sort_by(|a, b| b.area.total_cmp(&a.area));
        holes
    }
}

/// The distance to the cloud at the lattice vertex nearest to a point.
fn far(lattice: &Lattice, distances: &[f32], p: &Point3<f64>) -> f64 {
    let at = (p - lattice.origin) / lattice.step;
    let cell = [at.x, at.y, at.z].map(|c| c.round().max(0.0) as usize);
    let cell: [usize; 3] = std::array::from_fn(|axis| cell[axis].min(lattice.dims[axis] - 1));
    f64::from(distances[lattice.index(cell)])
}
