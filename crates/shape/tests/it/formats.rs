//! One cloud and one mesh, written in the many ways that programs write them.

use nalgebra::Point3;
use shape::TriangleMesh;
use shape::io::{Format, Geometry, LoadError, Loaded, Warning, read_cloud};

use crate::octahedron::{
    CORNERS, FACES, PLY_CLOUD, PLY_MESH, binary_stl, face_rows, npy, obj, off, ply, rows, stl,
};

fn load(bytes: &[u8], extension: &str) -> Loaded {
    read_cloud(bytes, extension)
        .unwrap_or_else(|e| panic!("{e}\n{}", String::from_utf8_lossy(bytes)))
}

/// The file is the cloud of the corners.
fn is_cloud(bytes: &[u8], extension: &str) {
    let loaded = load(bytes, extension);
    let Geometry::Points(points) = &loaded.geometry else {
        panic!("a cloud: {}", String::from_utf8_lossy(bytes));
    };
    assert_eq!(points.len(), 6, "{}", String::from_utf8_lossy(bytes));
    for (p, corner) in points.iter().zip(CORNERS) {
        assert!((p - Point3::from(corner)).norm() <= 1e-7, "{p}");
    }
}

fn mesh(bytes: &[u8], extension: &str) -> TriangleMesh {
    match load(bytes, extension).geometry {
        Geometry::Mesh(mesh) => mesh,
        Geometry::Points(_) => panic!("a mesh: {}", String::from_utf8_lossy(bytes)),
    }
}

/// The file is the mesh of the corners and faces.
fn is_mesh(bytes: &[u8], extension: &str) {
    let mesh = mesh(bytes, extension);
    assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (6, 8));
    // Two pyramids over a rhombus: 4/3 a b c.
    let volume = 4.0 / 3.0 * 0.1 * 0.25 * 0.5;
    assert!((mesh.volume() - volume).abs() <= 1e-9, "{}", mesh.volume());
}

fn refused(bytes: &[u8], extension: &str, words: &[&str]) {
    let error = read_cloud(bytes, extension).unwrap_err().to_string();
    for word in words {
        assert!(error.contains(word), "`{word}` is not in: {error}");
    }
}

#[test]
fn headers_of_ply() {
    let plain = ply(PLY_CLOUD, &rows());
    for extra in [
        "property float scalar_C2C_absolute_distances[<0.1]",
        "property float scalar_Intensity_(0)",
        "property float scalar_Coord._X%",
        "property float a:b#c",
        "property int64 label",
        "property uint64 stamp",
        "property double scalar Dip (deg.)",
    ] {
        let header = PLY_CLOUD.replace("end_header", &format!("{extra}\nend_header"));
        let body = rows().replace('\n', " 7\n");
        is_cloud(ply(&header, &body).as_bytes(), "ply");
    }
    let loud = plain
        .replace("element vertex", "ELEMENT vertex")
        .replace("property", "Property");
    is_cloud(loud.as_bytes(), "ply");
    is_cloud(format!("\u{feff}{plain}").as_bytes(), "ply");
    is_cloud(plain.replace('\n', "\r").as_bytes(), "ply");
    is_cloud(plain.replace('\n', "\r\n").as_bytes(), "ply");
    is_cloud(
        plain
            .replace(" x\n", " X\n")
            .replace(" y\n", " Y\n")
            .as_bytes(),
        "ply",
    );
    let body = rows();
    let latin = [
        &b"ply\nformat ascii 1.0\ncomment caf\xE9\n"[..],
        PLY_CLOUD.as_bytes(),
        body.as_bytes(),
    ];
    is_cloud(&latin.concat(), "ply");
    refused(
        ply(&PLY_CLOUD.replace("float z", "int128 z"), &rows()).as_bytes(),
        "ply",
        &["line 6", "int128"],
    );
}

#[test]
fn bodies_of_ply() {
    let bare = rows().replace("0.1 ", ".1 ").replace("0 ", "0. ");
    for body in [
        bare,
        format!("\n{}", rows()),
        rows().replace('\n', "\n\n"),
        rows().replace(' ', "\n"),
        rows().replace('\n', " "),
        rows().replace('\n', "  \r\n"),
    ] {
        is_cloud(ply(PLY_CLOUD, &body).as_bytes(), "ply");
    }
    let coloured = PLY_CLOUD.replace("end_header", "property uchar red\nend_header");
    for colour in ["255.0", "256", "-1", "255"] {
        let body = rows().replace('\n', &format!(" {colour}\n"));
        is_cloud(ply(&coloured, &body).as_bytes(), "ply");
    }
    for odd in ["1.#QNAN 0 0", "-nan(ind) 0 0", "0 inf 0"] {
        let body = rows().replacen("0.1 0 0", odd, 1);
        let loaded = load(ply(PLY_CLOUD, &body).as_bytes(), "ply");
        assert_eq!((loaded.dropped, loaded.vertices().len()), (1, 5), "{odd}");
    }
    let floats = face_rows().replace("3 ", "3 0.0 ").replace("3 0.0 ", "3 ");
    let floats = floats.replace(' ', ".0 ").replace('\n', ".0\n");
    is_mesh(ply(PLY_MESH, &(rows() + &floats)).as_bytes(), "ply");
    refused(ply(PLY_CLOUD, "0 0 0\n1 1\n").as_bytes(), "ply", &["line"]);
    refused(
        ply(PLY_CLOUD, &rows().replace('\n', " 9\n")).as_bytes(),
        "ply",
        &["more numbers"],
    );
}

#[test]
fn faces_of_ply_under_other_names() {
    let body = rows() + &face_rows();
    for list in ["vertices", "vertex_index", "vertex_indexes", "indices"] {
        let header = PLY_MESH.replace("vertex_indices", list);
        is_mesh(ply(&header, &body).as_bytes(), "ply");
    }
    for element in ["polygon", "tri"] {
        let header = PLY_MESH.replace("element face", &format!("element {element}"));
        is_mesh(ply(&header, &body).as_bytes(), "ply");
    }
    let edges = PLY_MESH.replace("element face", "element edge");
    is_cloud(ply(&edges, &body).as_bytes(), "ply");
    let strips = PLY_MESH.replace("element face 8", "element tristrips 1");
    let strips = strips.replace("list uchar", "list int");
    let run: Vec<String> = FACES
        .iter()
        .map(|[a, b, c]| format!("{a} {b} {c}"))
        .collect();
    let body = format!("{}31 {}\n", rows(), run.join(" -1 "));
    is_mesh(ply(&strips, &body).as_bytes(), "ply");
    let none = PLY_MESH.replace("list uchar int vertex_indices", "int material");
    let body = rows() + &"7\n".repeat(8);
    refused(
        ply(&none, &body).as_bytes(),
        "ply",
        &["vertex_indices", "material"],
    );
}

#[test]
fn binary_ply_is_never_edited_as_text() {
    for (format, comment) in [
        ("binary_little_endian", "comment format ascii 1.0 nan"),
        ("binary_big_endian", "obj_info format ascii"),
    ] {
        let header = PLY_CLOUD
            .replace("float", "short")
            .replace("vertex 6", "vertex 2");
        let mut bytes = format!("ply\nformat {format} 1.0\n{comment}\n{header}").into_bytes();
        bytes.extend([9, 9, 9, 32, 10, 13, b'n', b'a', b'n', 9, 32, 9]);
        let loaded = load(&bytes, "ply");
        let word = |a: u8, b: u8| match format {
            "binary_big_endian" => f64::from(u16::from_be_bytes([a, b])),
            _ => f64::from(u16::from_le_bytes([a, b])),
        };
        let expected = [
            Point3::new(word(9, 9), word(9, 32), word(10, 13)),
            Point3::new(word(b'n', b'a'), word(b'n', 9), word(32, 9)),
        ];
        assert_eq!(loaded.vertices(), expected, "{format}");
    }
}

#[test]
fn texts_of_stl() {
    let plain = stl();
    let two_words = plain
        .replace("endloop", "end loop")
        .replace("endsolid", "end solid");
    let comments = plain.replace("outer loop", "# a comment\nouter loop");
    for text in [
        plain.to_ascii_uppercase(),
        plain.replacen("solid", "Solid", 1),
        format!("\u{feff}{plain}"),
        format!("\n  {plain}"),
        plain.replace('\n', "\r\n"),
        two_words,
        comments,
        plain.replace("solid part", "solid"),
    ] {
        is_mesh(text.as_bytes(), "stl");
    }
    for header in ["solid of a CAD program", "binary", "SOLID facet"] {
        is_mesh(&binary_stl(header), "stl");
        let trailing = [binary_stl(header), vec![0, 0]].concat();
        is_mesh(&trailing, "stl");
        refused(&binary_stl(header)[..200], "stl", &["8 facets"]);
    }
}

#[test]
fn layouts_of_off() {
    let plain = off();
    let body = rows() + &face_rows();
    for text in [
        plain.replacen("OFF\n", "OFF", 1),
        plain.replacen("OFF\n", "OFF ", 1),
        plain.replacen("OFF\n", "off\n", 1),
        plain.replacen("OFF\n", "", 1),
        plain.replacen("6 8 0", "# numbers\n6 8 0 # v f e", 1),
        plain.replacen("6 8 0", "6 8", 1),
        plain.replacen("6 8 0", "6\n8\n0", 1),
        format!("OFF\n6 8 0\n{}{}", rows(), face_rows().replace('\n', " ")),
        format!("OFF\n6 8 0\n{}", body.replace(' ', "\n")),
        format!(
            "NOFF\n6 8 0\n{}{}",
            rows().replace('\n', " 0 0 1\n"),
            face_rows()
        ),
        format!(
            "COFF\n6 8 0\n{}{}",
            rows().replace('\n', " 9 9 9 255\n"),
            face_rows()
        ),
        format!(
            "OFF\n6 8 0\n{}{}",
            rows(),
            face_rows().replace('\n', " 0.5 0.5 0.5\n")
        ),
    ] {
        is_mesh(text.as_bytes(), "off");
    }
    refused(
        plain.replacen("3 0 2 4", "3 0 2 9", 1).as_bytes(),
        "off",
        &["line 9"],
    );
}

#[test]
fn lines_of_obj_that_go_on() {
    let plain = obj();
    let faces = plain
        .replace("f 1 3 5", "f 1 3 \\\n5")
        .replace("f 1 4 6", "f \\\r\n1 \\\n4 6");
    let vertices = plain.replace("v 0.1 0 0", "v 0.1 \\\n 0 0");
    for text in [
        faces,
        vertices,
        plain.replace('\n', "\r\n"),
        plain.replace("f 1 3 5", "f 1/1 3//7 -2/4/4"),
        format!("# caf\u{e9}\nmtllib a.mtl\no part\ns off\n{plain}"),
    ] {
        is_mesh(text.as_bytes(), "obj");
    }
}

#[test]
fn concave_polygons_are_cut_without_lids_over_their_notches() {
    // A star with five tips, from a tip and from a notch, seen along each axis.
    let corner = |i: usize| {
        let r = if i.is_multiple_of(2) { 0.1 } else { 0.04 };
        let t = std::f64::consts::TAU * i as f64 / 10.0;
        [r * t.cos(), r * t.sin(), 0.0]
    };
    let area = 5.0 * 0.1 * 0.04 * (std::f64::consts::TAU / 10.0).sin();
    for (first, axis) in [(0, 0), (1, 0), (0, 1), (1, 2)] {
        let corners: Vec<[f64; 3]> = (0..10).map(|i| corner(i + first)).collect();
        let row = |c: &[f64; 3]| {
            let at = |k: usize| c[(k + axis) % 3];
            format!("{} {} {}\n", at(0), at(1), at(2))
        };
        let rows: String = corners.iter().map(row).collect();
        let numbers = "0 1 2 3 4 5 6 7 8 9";
        let off = format!("OFF\n10 1 0\n{rows}10 {numbers}\n");
        let vertices = rows.lines().map(|l| format!("v {l}\n")).collect::<String>();
        let obj = format!("{vertices}f 1 2 3 4 5 6 7 8 9 10\n");
        let header = PLY_MESH
            .replace("vertex 6", "vertex 10")
            .replace("face 8", "face 1");
        let ply = ply(&header, &format!("{rows}10 {numbers}\n"));
        for (text, extension) in [(off, "off"), (obj, "obj"), (ply, "ply")] {
            let mesh = mesh(text.as_bytes(), extension);
            assert_eq!(mesh.triangles.len(), 8);
            assert!(
                (mesh.area() - area).abs() <= 1e-9,
                "{extension}: {}",
                mesh.area()
            );
        }
    }
}

#[test]
fn vertices_that_no_face_uses_do_not_count() {
    let off = off().replacen("6 8 0", "7 8 0", 1);
    for (text, extension) in [
        (format!("{}v 900 0 0\n", obj()), "obj"),
        (off.replacen("3 0 2 4", "900 0 0\n3 0 2 4", 1), "off"),
    ] {
        let loaded = load(text.as_bytes(), extension);
        assert_eq!(loaded.warnings, [Warning::Unused { vertices: 1 }]);
        is_mesh(text.as_bytes(), extension);
    }
}

#[test]
fn columns_of_text() {
    let csv = |header: &str, row: &dyn Fn(usize, [f64; 3]) -> String| {
        let rows = CORNERS.iter().enumerate().map(|(i, c)| row(i, *c) + "\n");
        format!("{header}{}", rows.collect::<String>())
    };
    let id = |i: usize, [x, y, z]: [f64; 3]| format!("{i},{x},{y},{z}");
    let decimal = |_: usize, c: [f64; 3]| c.map(|x| format!("{x:.3}").replace('.', ",")).join(";");
    for (text, extension) in [
        (csv("timestamp,x [m],y [m],z [m]\n", &id), "csv"),
        (csv("id,pos_x,pos_y,pos_z\n", &id), "csv"),
        (csv(",0,1,2\n", &id), "csv"),
        (
            csv("\"Result\",\"Points:0\",\"Points:1\",\"Points:2\"\n", &id),
            "csv",
        ),
        (
            csv("# id x y z\n", &|i, [x, y, z]| format!("{i} {x} {y} {z}")),
            "txt",
        ),
        (
            csv("//R X Y Z\n", &|i, [x, y, z]| format!("{i} {x} {y} {z}")),
            "asc",
        ),
        (csv("", &decimal), "csv"),
        (csv("x;y;z\n", &decimal), "csv"),
        (
            csv("6\n", &|_, [x, y, z]| format!("{x} {y} {z} 0.5 9 9 9")),
            "pts",
        ),
        (
            csv("", &|_, [x, y, z]| format!("{x} {y} {z} 255 0 0")),
            "xyzrgb",
        ),
        (
            csv("", &|_, [x, y, z]| format!("{x} {y} {z} 0 0 1")),
            "xyzn",
        ),
        (format!("\u{feff}{}", rows()), "xyz"),
        (rows().replace(' ', "\t"), "txt"),
        (rows(), "dat"),
    ] {
        is_cloud(text.as_bytes(), extension);
    }
    let time = csv("# t x y z\n# 6 rows\n", &|i, [x, y, z]| {
        format!("{i} {x} {y} {z}")
    });
    is_cloud(time.as_bytes(), "txt");
    let commas = csv("", &|_, c| {
        c.map(|x| format!("{x:.3}").replace('.', ",")).join(",")
    });
    refused(commas.as_bytes(), "csv", &["line 3", "decimal"]);
    let other = csv("latitude,longitude,height,id\n", &id);
    refused(other.as_bytes(), "csv", &["line 1", "latitude", "header"]);
    let missing = rows().replacen("0.1 0 0", "0.1 0", 1);
    refused(missing.as_bytes(), "xyz", &["line 1", "three numbers"]);
}

#[test]
fn clouds_of_other_programs() {
    let little: Vec<u8> = CORNERS
        .as_flattened()
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    is_cloud(&npy("<f8", "False", "(6, 3)", &little), "npy");
    is_cloud(&npy("<f8", "False", "(2, 3, 3)", &little), "npy");
    let big = CORNERS
        .as_flattened()
        .iter()
        .flat_map(|x| (*x as f32).to_be_bytes());
    is_cloud(
        &npy(">f4", "False", "(6, 3)", &big.collect::<Vec<_>>()),
        "npy",
    );
    let columns = (0..3).flat_map(|k| CORNERS.iter().map(move |c| c[k]));
    let columns: Vec<u8> = columns.flat_map(f64::to_le_bytes).collect();
    is_cloud(&npy("<f8", "True", "(6, 3)", &columns), "npy");
    let wide: Vec<u8> = CORNERS
        .iter()
        .flat_map(|c| [c[0], c[1], c[2], 0.0, 0.0, 1.0])
        .flat_map(f64::to_le_bytes)
        .collect();
    is_cloud(&npy("<f8", "False", "(6, 6)", &wide), "npy");
    refused(
        &npy("<f8", "False", "(18,)", &little),
        "npy",
        &["shape (18)"],
    );
    refused(&npy("<f8", "False", "(9, 3)", &little), "npy", &["9 × 3"]);
    let old = format!(
        "# .PCD v.5\nCOLUMNS x y z\nPOINTS 6\nDATA ascii\n{}",
        rows()
    );
    is_cloud(old.as_bytes(), "pcd");
    let new =
        "VERSION .7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nWIDTH 6\nHEIGHT 1\nDATA ascii\n";
    is_cloud(
        format!("{new}{}", rows().replace('\n', " 0\n")).as_bytes(),
        "pcd",
    );
}

#[test]
fn the_name_of_a_file_may_lie() {
    for (bytes, format) in [
        (stl().into_bytes(), Format::Stl),
        (binary_stl("x"), Format::Stl),
        (off().into_bytes(), Format::Off),
        (obj().into_bytes(), Format::Obj),
        (
            ply(PLY_MESH, &(rows() + &face_rows())).into_bytes(),
            Format::Ply,
        ),
    ] {
        for name in ["ply", "pcd", "stl", "obj", "off", "npy", "glb", "xyz"] {
            let loaded = load(&bytes, name);
            assert_eq!(loaded.format, format, "{name}");
            let lies = Format::from_extension(name) != Some(format);
            assert_eq!(loaded.warnings.len(), usize::from(lies), "{name}");
            is_mesh(&bytes, name);
        }
    }
}

#[test]
fn files_that_are_not_read_have_their_true_names() {
    for (text, word) in [
        (
            "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n",
            "git lfs pull",
        ),
        ("<!DOCTYPE html>\n<html>", "web page"),
        ("<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"x\">", "DAE"),
        ("<?xml version=\"1.0\"?>\n<robot name=\"x\">", "URDF"),
        ("#VRML V2.0 utf8\n", "VRML"),
        ("LASF\0\0", "LAS"),
        ("\u{feff}<html>", "web page"),
        ("ISO-10303-21;\n", "STEP"),
        ("PK\u{5}\u{6}\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", "ZIP"),
    ] {
        for extension in ["stl", "ply", "xyz", "dae", ""] {
            let error = read_cloud(text.as_bytes(), extension).unwrap_err();
            assert!(matches!(error, LoadError::Foreign { .. }), "{error}");
            assert!(error.to_string().contains(word), "{error}");
        }
    }
}
