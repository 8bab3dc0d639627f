//! Meshes of glTF 2.0: all triangles of the scene, moved by their nodes.
//!
//! The axes are those of the file; glTF has y upwards.

use nalgebra::{Matrix4, Point3, Quaternion, Translation3, UnitQuaternion, Vector3};
use serde_json::Value;

use super::error::LoadError;
use super::geometry::Raw;
use super::gltf_buffers::{Document, index, refuse};

/// Deepest nesting of nodes, and most nodes that are visited.
const MAX_DEPTH: usize = 64;
const MAX_NODES: usize = 100_000;

/// Reads the triangles of all meshes in the scene; without any triangle, their points.
pub(super) fn read(bytes: &[u8]) -> Result<Raw, LoadError> {
    let document = Document::read(bytes)?;
    let json = &document.json;
    let scene = index(json, "scene").unwrap_or(0);
    let roots = &json["scenes"][scene]["nodes"];
    let roots: Vec<usize> = match roots.is_array() {
        true => indices(roots).collect(),
        false => nodes_without_parent(json).collect(),
    };
    let start = |node: usize| (node, Matrix4::identity(), 0);
    let mut open: Vec<(usize, Matrix4<f64>, usize)> = roots.into_iter().map(start).collect();
    let mut raw = Raw::default();
    let mut visited = 0;
    // A mesh may be used by many nodes; the total is limited.
    let most = bytes.len().saturating_add(1000);
    while let Some((node, parent, depth)) = open.pop() {
        visited += 1;
        if depth > MAX_DEPTH || visited > MAX_NODES {
            return Err(refuse(
                "too many nodes, or nodes inside of themselves",
                "a tree of nodes",
            ));
        }
        let facts = &json["nodes"][node];
        let here = parent * local(facts);
        if let Some(mesh) = index(facts, "mesh") {
            let primitives = json["meshes"][mesh]["primitives"].as_array();
            for primitive in primitives.into_iter().flatten() {
                add(&document, primitive, &here, &mut raw)?;
                if raw.vertices.len() + raw.triangles.len() > most {
                    return Err(refuse("one mesh in very many places", "a plain scene"));
                }
            }
        }
        open.extend(indices(&facts["children"]).map(|n| (n, here, depth + 1)));
    }
    Ok(raw)
}

/// The whole numbers of a list.
fn indices(list: &Value) -> impl Iterator<Item = usize> {
    let list = list.as_array().into_iter().flatten();
    list.filter_map(|v| usize::try_from(v.as_u64()?).ok())
}

fn nodes_without_parent(json: &Value) -> impl Iterator<Item = usize> {
    let nodes = json["nodes"].as_array().map_or(&[][..], Vec::as_slice);
    let mut is_child = vec![false; nodes.len()];
    for child in nodes.iter().flat_map(|n| indices(&n["children"])) {
        if let Some(entry) = is_child.get_mut(child) {
            *entry = true;
        }
    }
    is_child
        .into_iter()
        .enumerate()
        .filter(|(_, child)| !child)
        .map(|(i, _)| i)
}

/// The transformation of a node: its matrix, or translation, rotation and scale.
fn local(node: &Value) -> Matrix4<f64> {
    let numbers = |key: &str| -> Option<Vec<f64>> {
        node[key].as_array()?.iter().map(Value::as_f64).collect()
    };
    if let Some(matrix) = numbers("matrix").filter(|m| m.len() == 16) {
        return Matrix4::from_column_slice(&matrix);
    }
    let three = |key: &str, other: f64| match numbers(key).as_deref() {
        Some(&[x, y, z]) => Vector3::new(x, y, z),
        _ => Vector3::repeat(other),
    };
    let rotation = match numbers("rotation").as_deref() {
        Some(&[x, y, z, w]) => UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)),
        _ => UnitQuaternion::identity(),
    };
    Translation3::from(three("translation", 0.0)).to_homogeneous()
        * rotation.to_homogeneous()
        * Matrix4::new_nonuniform_scaling(&three("scale", 1.0))
}

fn add(
    document: &Document,
    primitive: &Value,
    here: &Matrix4<f64>,
    raw: &mut Raw,
) -> Result<(), LoadError> {
    let Some(positions) = index(&primitive["attributes"], "POSITION") else {
        return Ok(());
    };
    let numbers = document.numbers(positions, 3)?;
    let start = raw.vertices.len();
    let moved = |p: &[f64]| {
        let p = here * Point3::new(p[0], p[1], p[2]).to_homogeneous();
        Point3::new(p.x, p.y, p.z)
    };
    raw.vertices.extend(numbers.chunks_exact(3).map(moved));
    let count = raw.vertices.len() - start;
    let corners: Vec<u32> = match index(primitive, "indices") {
        None => (start as u32..(start + count) as u32).collect(),
        Some(accessor) => {
            let numbers = document.numbers(accessor, 1)?;
            if let Some(corner) = numbers.iter().find(|c| !(**c >= 0.0 && **c < count as f64)) {
                let expected = format!("numbers of vertices below {count}");
                return Err(refuse(format!("corner {corner}"), &expected));
            }
            numbers.iter().map(|c| start as u32 + *c as u32).collect()
        }
    };
    let first = raw.triangles.len();
    match index(primitive, "mode").unwrap_or(4) {
        4 => raw
            .triangles
            .extend(corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]])),
        5 => raw.strip(&corners),
        6 => {
            if let [middle, rest @ ..] = &corners[..] {
                raw.triangles
                    .extend(rest.windows(2).map(|c| [*middle, c[0], c[1]]));
            }
        }
        _ => {}
    }
    if here.fixed_view::<3, 3>(0, 0).determinant() < 0.0 {
        for triangle in &mut raw.triangles[first..] {
            triangle.swap(1, 2);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document(node: &str) -> String {
        // Three positions and three indices of one byte, in base64.
        let mut buffer: Vec<u8> = Vec::new();
        for x in [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
            buffer.extend(x.to_le_bytes());
        }
        buffer.extend([0, 1, 2]);
        let digits = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let six = |c: &[u8], k: usize| {
            let word = u32::from(c[0]) << 16 | u32::from(c[1]) << 8 | u32::from(c[2]);
            char::from(digits[(word >> (18 - 6 * k) & 63) as usize])
        };
        let text: String = buffer
            .chunks_exact(3)
            .flat_map(|c| (0..4).map(move |k| six(c, k)))
            .collect();
        format!(
            r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0{node}}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}},
            {{"bufferView":0,"byteOffset":36,"componentType":5121,"count":3,"type":"SCALAR"}}],
            "bufferViews":[{{"buffer":0,"byteLength":39}}],
            "buffers":[{{"byteLength":39,"uri":"data:application/octet-stream;base64,{text}"}}]}}"#
        )
    }

    #[test]
    fn nodes_move_their_meshes() {
        let raw = read(document("").as_bytes()).unwrap();
        assert_eq!(raw.triangles, [[0, 1, 2]]);
        assert_eq!(raw.vertices[1], Point3::new(1.0, 0.0, 0.0));
        let moved = document(r#","translation":[0,0,5],"scale":[-2,2,2]"#);
        let raw = read(moved.as_bytes()).unwrap();
        assert_eq!(raw.vertices[1], Point3::new(-2.0, 0.0, 5.0));
        // A mirror turns the triangles inside out.
        assert_eq!(raw.triangles, [[0, 2, 1]]);
    }

    #[test]
    fn damaged_documents_are_refused() {
        let good = document("");
        for (from, to) in [
            ("\"count\":3", "\"count\":4000000000"),
            ("data:application", "mesh.bin?application"),
            ("\"version\"", "version"),
            ("5121", "5126"),
            ("\"mesh\":0", "\"mesh\":0,\"children\":[0]"),
        ] {
            assert!(good.contains(from), "{from}");
            let nodes = good.replace("\"nodes\":[", "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[");
            assert!(read(nodes.replace(from, to).as_bytes()).is_err(), "{from}");
        }
    }
}
