//! Triangle meshes as bytes of files.

use std::io::{self, Write};

use crate::triangle_mesh::TriangleMesh;

/// A format in which meshes are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// Binary little-endian PLY with double coordinates.
    Ply,
    /// Wavefront text with all digits.
    Obj,
    /// Binary STL; coordinates are rounded to single precision.
    Stl,
    /// Text OFF with all digits.
    Off,
    /// Binary glTF 2.0; coordinates are rounded to single precision and the axes are kept.
    Glb,
}

impl MeshFormat {
    /// The format that a file-name extension stands for, with or without the dot, in any case.
    pub fn from_extension(extension: &str) -> Option<Self> {
        let extension = extension.trim_start_matches('.').to_ascii_lowercase();
        Some(match extension.as_str() {
            "ply" => Self::Ply,
            "obj" => Self::Obj,
            "stl" => Self::Stl,
            "off" => Self::Off,
            "glb" => Self::Glb,
            _ => return None,
        })
    }
}

/// Writes a mesh in a format.
///
/// ```
/// use nalgebra::Point3;
/// use shape::TriangleMesh;
/// use shape::io::{MeshFormat, read_cloud, write_mesh};
///
/// let corner = |x, y| Point3::new(x, y, 0.0);
/// let mesh = TriangleMesh {
///     vertices: vec![corner(0.0, 0.0), corner(0.25, 0.0), corner(0.0, 0.5)],
///     triangles: vec![[0, 1, 2]],
/// };
/// for (format, name) in [(MeshFormat::Obj, "obj"), (MeshFormat::Glb, "glb")] {
///     let mut bytes = Vec::new();
///     write_mesh(&mesh, format, &mut bytes)?;
///     assert_eq!(read_cloud(&bytes, name)?.vertices(), mesh.vertices);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Those of `out`; a mesh that is too large for the counts of the format.
pub fn write_mesh(mesh: &TriangleMesh, format: MeshFormat, out: &mut impl Write) -> io::Result<()> {
    match format {
        MeshFormat::Ply => write_ply(mesh, out),
        MeshFormat::Obj => write_obj(mesh, out),
        MeshFormat::Stl => write_stl(mesh, out),
        MeshFormat::Off => write_off(mesh, out),
        MeshFormat::Glb => write_glb(mesh, out),
    }
}

/// Writes a mesh as binary little-endian PLY with double coordinates.
///
/// # Errors
/// Those of `out`.
pub fn write_ply(mesh: &TriangleMesh, out: &mut impl Write) -> io::Result<()> {
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\n\
         element vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
         element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        mesh.vertices.len(),
        mesh.triangles.len()
    )?;
    for p in &mesh.vertices {
        for x in p.iter() {
            out.write_all(&x.to_le_bytes())?;
        }
    }
    for triangle in &mesh.triangles {
        out.write_all(&[3])?;
        for corner in triangle {
            out.write_all(&corner.to_le_bytes())?;
        }
    }
    Ok(())
}

fn write_obj(mesh: &TriangleMesh, out: &mut impl Write) -> io::Result<()> {
    for p in &mesh.vertices {
        writeln!(out, "v {} {} {}", p.x, p.y, p.z)?;
    }
    for [a, b, c] in mesh.triangles.iter().map(|t| t.map(|i| u64::from(i) + 1)) {
        writeln!(out, "f {a} {b} {c}")?;
    }
    Ok(())
}

fn write_off(mesh: &TriangleMesh, out: &mut impl Write) -> io::Result<()> {
    writeln!(
        out,
        "OFF\n{} {} 0",
        mesh.vertices.len(),
        mesh.triangles.len()
    )?;
    for p in &mesh.vertices {
        writeln!(out, "{} {} {}", p.x, p.y, p.z)?;
    }
    for [a, b, c] in &mesh.triangles {
        writeln!(out, "3 {a} {b} {c}")?;
    }
    Ok(())
}

/// A count of 32 bits.
fn count(n: usize) -> io::Result<u32> {
    u32::try_from(n).map_err(|_| io::Error::other("the mesh is too large for the format"))
}

fn write_stl(mesh: &TriangleMesh, out: &mut impl Write) -> io::Result<()> {
    let mut header = [b' '; 80];
    header[..10].copy_from_slice(b"binary STL");
    out.write_all(&header)?;
    out.write_all(&count(mesh.triangles.len())?.to_le_bytes())?;
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| mesh.vertices[i as usize]);
        let normal = (b - a)
            .cross(&(c - a))
            .try_normalize(0.0)
            .unwrap_or_default();
        for v in [normal, a.coords, b.coords, c.coords] {
            for x in v.iter() {
                out.write_all(&(*x as f32).to_le_bytes())?;
            }
        }
        out.write_all(&[0, 0])?;
    }
    Ok(())
}

fn write_glb(mesh: &TriangleMesh, out: &mut impl Write) -> io::Result<()> {
    let points: Vec<[f32; 3]> = mesh
        .vertices
        .iter()
        .map(|p| [p.x as f32, p.y as f32, p.z as f32])
        .collect();
    // The format asks for the bounds of positions.
    let bound = |least: bool| {
        let start = if least {
            f32::INFINITY
        } else {
            f32::NEG_INFINITY
        };
        let one = |a: f32, b: f32| if least { a.min(b) } else { a.max(b) };
        let fold = |m: [f32; 3], p: &[f32; 3]| [one(m[0], p[0]), one(m[1], p[1]), one(m[2], p[2])];
        points.iter().fold([start; 3], fold)
    };
    let (positions, corners) = (12 * points.len(), 12 * mesh.triangles.len());
    let json = serde_json::json!({
        "asset": {"version": "2.0", "generator": "moduli"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 4}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": points.len(), "type": "VEC3",
             "min": bound(true), "max": bound(false)},
            {"bufferView": 1, "componentType": 5125, "count": 3 * mesh.triangles.len(), "type": "SCALAR"}
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": positions, "target": 34962},
            {"buffer": 0, "byteOffset": positions, "byteLength": corners, "target": 34963}
        ],
        "buffers": [{"byteLength": positions + corners}]
    });
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = count(28 + text.len() + positions + corners)?;
    out.write_all(b"glTF")?;
    for word in [2, length, count(text.len())?] {
        out.write_all(&word.to_le_bytes())?;
    }
    out.write_all(b"JSON")?;
    out.write_all(&text)?;
    out.write_all(&count(positions + corners)?.to_le_bytes())?;
    out.write_all(b"BIN\0")?;
    for x in points.iter().flatten() {
        out.write_all(&x.to_le_bytes())?;
    }
    for corner in mesh.triangles.iter().flatten() {
        out.write_all(&corner.to_le_bytes())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::io::{Geometry, read_cloud};

    #[test]
    fn a_written_mesh_is_read_back() {
        let corners = [
            [0.0, 0.0, 0.0],
            [0.5, 0.0, 0.0],
            [0.0, 0.25, 0.0],
            [0.0, 0.0, -0.125],
        ];
        let mesh = TriangleMesh {
            vertices: corners.map(Point3::from).to_vec(),
            triangles: vec![[0, 1, 2], [1, 0, 3], [0, 2, 3], [2, 1, 3]],
        };
        for extension in ["ply", "obj", "stl", "off", "glb"] {
            let format = MeshFormat::from_extension(extension).unwrap();
            let mut bytes = Vec::new();
            write_mesh(&mesh, format, &mut bytes).unwrap();
            let loaded = read_cloud(&bytes, extension).unwrap();
            let Geometry::Mesh(read) = loaded.geometry else {
                panic!("{extension} is a mesh");
            };
            // The vertices of an STL come in the order of its triangles.
            assert_eq!(read.triangles.len(), 4, "{extension}");
            assert_eq!(read.vertices.len(), 4, "{extension}");
            assert_eq!(read.volume(), mesh.volume(), "{extension}");
        }
        assert_eq!(MeshFormat::from_extension("fbx"), None);
    }
}
