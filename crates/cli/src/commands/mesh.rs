//! `moduli mesh`: writes a surface as a triangle mesh in the frame of its cloud.

use crate::args::MeshOptions;
use crate::failure::Failure;
use crate::input::Surfaced;
use crate::{input, output};

pub(crate) fn run(options: &MeshOptions) -> Result<(), Failure> {
    let (rows, columns) = (options.rows, options.columns);
    let (mut mesh, frame) = match input::surfaced(&options.shape)? {
        Surfaced::Radial(object) => (object.shape().mesh(rows, columns), *object.frame()),
        Surfaced::Spherical(object) => (object.shape().mesh(rows, columns), *object.frame()),
    };
    for vertex in &mut mesh.vertices {
        *vertex = frame.to_cloud(vertex);
    }
    let mut bytes = Vec::new();
    shape::io::write_ply(&mesh, &mut bytes)
        .map_err(|e| Failure::other(format!("cannot encode PLY: {e}")))?;
    output::write_file(&options.output, &bytes)?;
    output::say(format!(
        "{} vertices, {} triangles, written to {}",
        mesh.vertices.len(),
        mesh.triangles.len(),
        options.output.display()
    ));
    Ok(())
}
