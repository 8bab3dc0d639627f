//! An octahedron as the text or bytes of several formats.

/// Corners of an octahedron, and its faces seen from outside.
pub(crate) const CORNERS: [[f64; 3]; 6] = [
    [0.1, 0.0, 0.0],
    [-0.1, 0.0, 0.0],
    [0.0, 0.25, 0.0],
    [0.0, -0.25, 0.0],
    [0.0, 0.0, 0.5],
    [0.0, 0.0, -0.5],
];
pub(crate) const FACES: [[u32; 3]; 8] = [
    [0, 2, 4],
    [2, 1, 4],
    [1, 3, 4],
    [3, 0, 4],
    [2, 0, 5],
    [1, 2, 5],
    [3, 1, 5],
    [0, 3, 5],
];
pub(crate) const PLY_CLOUD: &str =
    "element vertex 6\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
pub(crate) const PLY_MESH: &str = "element vertex 6\nproperty float x\nproperty float y\nproperty float z\n\
     element face 8\nproperty list uchar int vertex_indices\nend_header\n";

pub(crate) fn rows() -> String {
    CORNERS
        .iter()
        .map(|[x, y, z]| format!("{x} {y} {z}\n"))
        .collect()
}

pub(crate) fn face_rows() -> String {
    FACES
        .iter()
        .map(|[a, b, c]| format!("3 {a} {b} {c}\n"))
        .collect()
}

pub(crate) fn ply(header: &str, body: &str) -> String {
    format!("ply\nformat ascii 1.0\n{header}{body}")
}

pub(crate) fn off() -> String {
    format!("OFF\n6 8 0\n{}{}", rows(), face_rows())
}

pub(crate) fn obj() -> String {
    let vertices = CORNERS.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n"));
    let faces = FACES.iter().map(|f| {
        let [a, b, c] = f.map(|i| i + 1);
        format!("f {a} {b} {c}\n")
    });
    vertices.chain(faces).collect()
}

pub(crate) fn stl() -> String {
    let mut text = "solid part\n".to_owned();
    for face in FACES {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in face.map(|i| CORNERS[i as usize]) {
            text += &format!("vertex {x} {y} {z}\n");
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid part\n"
}

pub(crate) fn binary_stl(header: &str) -> Vec<u8> {
    let mut bytes = header.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend(8_u32.to_le_bytes());
    for face in FACES {
        bytes.extend([0; 12]);
        for corner in face.map(|i| CORNERS[i as usize]) {
            bytes.extend(corner.iter().flat_map(|x| (*x as f32).to_le_bytes()));
        }
        bytes.extend([0, 0]);
    }
    bytes
}

/// An array of NumPy with the corners.
pub(crate) fn npy(descr: &str, fortran: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let header =
        format!("{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': {shape}, }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.bytes());
    bytes.extend(data);
    bytes
}
