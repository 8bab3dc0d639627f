//! Surfaces, clouds and contacts as items of a scene, in millimetres; shared by all figures.

use nalgebra::{Point3, Vector3};
use report::{Arrows, Block, Item, Lines, Mesh, Points, SceneCell, Section, Surface};
use shape::{PointCloud, RadialShape, Surface as _};
use space::point::contacts_on;
use sph::{Coefficients, Direction, batch};

/// Circles of latitude of a drawn mesh, and points per circle.
const MESH: (usize, usize) = (48, 72);
/// Length of a drawn normal, millimetres.
const NORMAL_LENGTH: f64 = 30.0;
/// Approximate number of points of a drawn cloud.
const CLOUD_POINTS: usize = 2_500;

fn millimetres(v: &Vector3<f64>) -> [f64; 3] {
    (v * 1e3).into()
}

/// The mesh of a surface, in millimetres.
fn mesh(shape: &RadialShape) -> Mesh {
    let mesh = shape.mesh(MESH.0, MESH.1);
    Mesh {
        vertices: mesh
            .vertices
            .iter()
            .map(|p| millimetres(&p.coords))
            .collect(),
        triangles: mesh.triangles,
    }
}

/// A plain surface.
pub fn surface(shape: &RadialShape) -> Item {
    Item::Surface(Surface {
        mesh: mesh(shape),
        values: Vec::new(),
    })
}

/// A surface coloured by a function on the sphere.
pub fn coloured(shape: &RadialShape, function: &Coefficients) -> Item {
    let mesh = mesh(shape);
    let directions: Vec<Direction> = mesh
        .vertices
        .iter()
        .map(|&v| Direction::new_normalize(Vector3::from(v)))
        .collect();
    Item::Surface(Surface {
        mesh,
        values: batch::evaluate(function, &directions),
    })
}

/// Inward normals at contacts on a surface, as arrows that press on it.
pub fn contacts(shape: &RadialShape, directions: &[Direction]) -> Item {
    let contacts = contacts_on(shape, directions);
    Item::Arrows(Arrows {
        tips: contacts
            .iter()
            .map(|c| millimetres(&c.position.coords))
            .collect(),
        directions: contacts
            .iter()
            .map(|c| c.inward_normal.into_inner().into())
            .collect(),
        length: NORMAL_LENGTH,
    })
}

/// The path of one contact over a surface.
pub fn track(shape: &RadialShape, directions: impl Iterator<Item = Direction>) -> Item {
    Item::Lines(Lines {
        name: String::new(),
        // Lifted by half a millimetre, since the surface would hide parts of it.
        points: directions
            .map(|p| millimetres(&(shape.point(&p).coords + p.into_inner() * 5e-4)))
            .collect(),
    })
}

/// A thinned cloud seen from a centre.
pub fn cloud(cloud: &PointCloud, centre: &Point3<f64>) -> Item {
    let step = cloud.points().len().div_ceil(CLOUD_POINTS);
    Item::Points(Points {
        name: String::new(),
        points: cloud
            .points()
            .iter()
            .step_by(step)
            .map(|p| millimetres(&(p - centre)))
            .collect(),
        labels: Vec::new(),
        size_px: 2,
    })
}

/// A surface with a grasp on it and a label below.
pub fn grasp_cell(label: String, shape: &RadialShape, directions: &[Direction]) -> SceneCell {
    SceneCell {
        label,
        items: vec![surface(shape), contacts(shape, directions)],
    }
}

/// A section of figures with a line of text.
pub fn section(heading: &str, text: &str, blocks: Vec<Block>) -> Section {
    Section {
        heading: heading.to_owned(),
        text: text.to_owned(),
        blocks,
    }
}
