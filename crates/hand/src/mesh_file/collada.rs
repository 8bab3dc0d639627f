//! The vertices of a Collada document (DAE).
//!
//! Read as robot software does: the unit of the document counts, its `up_axis` does not, and the
//! geometries are placed by the nodes of the scene.

use std::collections::HashMap;

use nalgebra::{Matrix4, Point3, Rotation3, Unit, Vector3};

use crate::xml::{self, Element};

/// The deepest nesting of nodes that refer to each other.
const DEEPEST: usize = 32;

/// Whether a text is a Collada document.
pub(super) fn is_collada(bytes: &[u8]) -> bool {
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
    start.contains("<COLLADA")
}

/// All vertices, in metres.
///
/// Errors: a sentence that says what is missing or wrong.
pub(super) fn vertices(bytes: &[u8]) -> Result<Vec<Point3<f64>>, String> {
    let text = String::from_utf8_lossy(bytes);
    let limits = xml::Limits {
        bytes: super::MAX_MESH_BYTES,
        elements: 1_000_000,
    };
    let root = xml::root_within(&text, &limits).map_err(|e| format!("Collada: {e}"))?;
    let document = Document::new(&root)?;
    let mut found = Vec::new();
    for scene in all(&root, "library_visual_scenes", "visual_scene") {
        for node in scene.children_named("node") {
            document.place(node, &Matrix4::identity(), 0, &mut found)?;
        }
    }
    if found.is_empty() {
        // Without a scene the geometries stand where they are.
        found = document.positions.values().flatten().copied().collect();
    }
    if found.is_empty() {
        return Err("the Collada file (DAE) has no vertices".to_owned());
    }
    let unit = unit(&root)?;
    Ok(found.iter().map(|p| p * unit).collect())
}

fn unit(root: &Element) -> Result<f64, String> {
    let unit = root.child("asset").and_then(|a| a.child("unit"));
    match unit.and_then(|u| u.attribute("meter")) {
        None => Ok(1.0),
        Some(text) => match text.trim().parse::<f64>() {
            Ok(metres) if metres > 0.0 && metres.is_finite() => Ok(metres),
            _ => Err(format!("Collada: the unit is '{text}' metres")),
        },
    }
}

/// The elements `item` of all libraries of a name.
fn all<'e>(
    root: &'e Element,
    library: &'e str,
    item: &'e str,
) -> impl Iterator<Item = &'e Element> + 'e {
    let libraries = root.children_named(library);
    libraries.flat_map(move |l| l.children_named(item))
}

struct Document<'e> {
    /// Vertices by the id of their geometry.
    positions: HashMap<&'e str, Vec<Point3<f64>>>,
    /// Nodes outside the scene, by id.
    nodes: HashMap<&'e str, &'e Element>,
}

impl<'e> Document<'e> {
    fn new(root: &'e Element) -> Result<Self, String> {
        let mut positions = HashMap::new();
        for geometry in all(root, "library_geometries", "geometry") {
            let id = geometry.attribute("id").unwrap_or_default();
            if let Some(mesh) = geometry.child("mesh") {
                positions.insert(id, of_mesh(mesh, id)?);
            }
        }
        let nodes = all(root, "library_nodes", "node");
        let named = nodes.filter_map(|n| Some((n.attribute("id")?, n)));
        Ok(Self {
            positions,
            nodes: named.collect(),
        })
    }

    /// Adds the vertices of the geometries of a node and of the nodes in it.
    fn place(
        &self,
        node: &Element,
        parent: &Matrix4<f64>,
        depth: usize,
        found: &mut Vec<Point3<f64>>,
    ) -> Result<(), String> {
        if depth > DEEPEST {
            return Err(format!("Collada: nodes nest deeper than {DEEPEST}"));
        }
        let mut here = *parent;
        for child in &node.children {
            here *= transform(child)?;
        }
        for child in &node.children {
            let url = child.attribute("url").unwrap_or_default();
            let id = url.trim_start_matches('#');
            match child.name.as_str() {
                "node" => self.place(child, &here, depth + 1, found)?,
                "instance_geometry" => {
                    let points = self.positions.get(id);
                    let points = points.ok_or_else(|| format!("Collada: no geometry '{url}'"))?;
                    found.extend(points.iter().map(|p| here.transform_point(p)));
                }
                "instance_node" => {
                    let node = self.nodes.get(id);
                    let node = node.ok_or_else(|| format!("Collada: no node '{url}'"))?;
                    self.place(node, &here, depth + 1, found)?;
                }
                _ => {}
            }
            if found.len() > super::MAX_MESH_VERTICES {
                return Err(format!(
                    "Collada: more than {} vertices",
                    super::MAX_MESH_VERTICES
                ));
            }
        }
        Ok(())
    }
}

/// The positions that the vertices of a mesh refer to.
fn of_mesh(mesh: &Element, id: &str) -> Result<Vec<Point3<f64>>, String> {
    let of_vertices = mesh
        .children_named("vertices")
        .flat_map(|v| v.children_named("input"));
    let position = of_vertices
        .filter(|i| i.attribute("semantic") == Some("POSITION"))
        .find_map(|i| i.attribute("source"));
    let source = position.and_then(|name| {
        let wanted = Some(name.trim_start_matches('#'));
        mesh.children_named("source")
            .find(|s| s.attribute("id") == wanted)
    });
    let array = source.and_then(|s| s.child("float_array"));
    let array =
        array.ok_or_else(|| format!("Collada: the geometry '{id}' has no list of positions"))?;
    let stride = source
        .and_then(|s| s.child("technique_common")?.child("accessor"))
        .and_then(|a| a.attribute("stride")?.trim().parse().ok())
        .unwrap_or(3);
    let numbers = numbers(array.text(), id)?;
    if !(3..=64).contains(&stride) || numbers.len() % stride != 0 {
        return Err(format!(
            "Collada: the geometry '{id}' has {} numbers, expected rows of {stride}",
            numbers.len()
        ));
    }
    let rows = numbers.chunks_exact(stride);
    Ok(rows.map(|r| Point3::new(r[0], r[1], r[2])).collect())
}

fn numbers(text: &str, place: &str) -> Result<Vec<f64>, String> {
    let number = |word: &str| match word.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!(
            "Collada: '{word}' in '{place}' is no finite number"
        )),
    };
    text.split_whitespace().map(number).collect()
}

/// What an element of a node does to its geometry; nothing for most.
fn transform(element: &Element) -> Result<Matrix4<f64>, String> {
    let count = match element.name.as_str() {
        "matrix" => 16,
        "translate" | "scale" => 3,
        "rotate" => 4,
        _ => return Ok(Matrix4::identity()),
    };
    let n = numbers(element.text(), &element.name)?;
    if n.len() != count {
        let name = &element.name;
        return Err(format!(
            "Collada: <{name}> has {} numbers, expected {count}",
            n.len()
        ));
    }
    Ok(match element.name.as_str() {
        "matrix" => Matrix4::from_row_slice(&n),
        "translate" => Matrix4::new_translation(&Vector3::new(n[0], n[1], n[2])),
        "scale" => Matrix4::new_nonuniform_scaling(&Vector3::new(n[0], n[1], n[2])),
        _ => match Unit::try_new(Vector3::new(n[0], n[1], n[2]), 1e-12) {
            Some(axis) => Rotation3::from_axis_angle(&axis, n[3].to_radians()).to_homogeneous(),
            None => Matrix4::identity(),
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document(asset: &str, scene: &str) -> String {
        format!(
            "<?xml version=\"1.0\"?><COLLADA version=\"1.4.1\"><asset>{asset}<up_axis>Y_UP</up_axis></asset>\
             <library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"a\" count=\"6\">1 2 3 4 5 6\
             </float_array></source><vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices></mesh>\
             </geometry></library_geometries>{scene}</COLLADA>"
        )
    }

    fn scene(inside: &str) -> String {
        format!(
            "<library_visual_scenes><visual_scene><node>{inside}<instance_geometry url=\"#g\"/></node>\
             </visual_scene></library_visual_scenes>"
        )
    }

    #[test]
    fn units_and_nodes_count_and_the_up_axis_does_not() {
        let read = |asset: &str, scene: &str| {
            let text = document(asset, scene);
            assert!(is_collada(text.as_bytes()));
            vertices(text.as_bytes()).unwrap()[0]
        };
        assert_eq!(read("", ""), Point3::new(1.0, 2.0, 3.0));
        assert_eq!(read("", &scene("")), Point3::new(1.0, 2.0, 3.0));
        let half = read("<unit name=\"h\" meter=\"0.5\"/>", &scene(""));
        assert_eq!(half, Point3::new(0.5, 1.0, 1.5));
        let moved = read(
            "",
            &scene("<translate>1 0 0</translate><scale>2 2 2</scale>"),
        );
        assert_eq!(moved, Point3::new(3.0, 4.0, 6.0));
        let turned = read("", &scene("<rotate>0 0 1 90</rotate>"));
        assert!((turned - Point3::new(-2.0, 1.0, 3.0)).norm() < 1e-12);
        let matrix = read(
            "",
            &scene("<matrix>1 0 0 9 0 1 0 0 0 0 1 0 0 0 0 1</matrix>"),
        );
        assert_eq!(matrix, Point3::new(10.0, 2.0, 3.0));
    }

    #[test]
    fn broken_documents_are_refused_by_what_is_wrong() {
        let refused = |text: String| vertices(text.as_bytes()).unwrap_err();
        let cyclic =
            "<library_nodes><node id=\"n\"><instance_node url=\"#n\"/></node></library_nodes>";
        let inside = scene("<instance_node url=\"#n\"/>") + cyclic;
        assert!(refused(document("", &inside)).contains("nest deeper"));
        assert!(refused(document("<unit meter=\"0\"/>", "")).contains("unit"));
        assert!(refused(document("", &scene("<scale>1 2</scale>"))).contains("expected 3"));
        assert!(refused(document("", "").replace("4 5 6", "4 5")).contains("rows of 3"));
        assert!(refused(document("", "").replace("4 5 6", "4 5 x")).contains("'x'"));
        assert!(refused(document("", "").replace("#p", "#q")).contains("no list of positions"));
    }
}
