//! `moduli mesh`: a shape as triangles, in the frame of its cloud.

use moduli::records::stored_shape;

use crate::args::MeshOptions;
use crate::failure::Failure;
use crate::{input, output};

pub(crate) fn run(options: &MeshOptions) -> Result<(), Failure> {
    let record = input::shape_record(&options.shape)?;
    let shape = stored_shape(&record).map_err(|e| Failure::input(&options.shape, e))?;
    let mut mesh = shape.mesh(options.rows, options.columns);
    for vertex in &mut mesh.vertices {
        *vertex += record.centre_in_cloud().coords;
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
