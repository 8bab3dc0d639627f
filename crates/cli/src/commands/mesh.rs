//! `moduli mesh`: writes a surface as a triangle mesh in the frame of its cloud.

use shape::io::{MeshFormat, write_mesh};

use crate::args::MeshOptions;
use crate::failure::Failure;
use crate::{input, output};

pub(crate) fn run(options: &MeshOptions) -> Result<(), Failure> {
    // A pipe or a device has no ending.
    let extension = options.output.extension().map(|e| e.to_string_lossy());
    let format = MeshFormat::from_extension(extension.as_deref().unwrap_or("ply"));
    let format = format.ok_or_else(|| {
        Failure::usage(format!(
            "-o {}: meshes are written as .ply, .obj, .stl, .off or .glb; give the file one of these endings",
            options.output.display()
        ))
    })?;
    let (rows, columns) = (options.rows, options.columns);
    let object = input::object(&options.shape)?;
    let mut mesh = object.shape().mesh(rows, columns);
    for vertex in &mut mesh.vertices {
        *vertex = object.frame().to_cloud(vertex);
    }
    let mut bytes = Vec::new();
    write_mesh(&mesh, format, &mut bytes)
        .map_err(|e| Failure::other(format!("cannot encode the mesh: {e}")))?;
    output::write_file(&options.output, &bytes)?;
    output::say(format!(
        "{} vertices, {} triangles, written to {}",
        mesh.vertices.len(),
        mesh.triangles.len(),
        options.output.display()
    ));
    Ok(())
}
