//! Where the closed hand really is: its tips at the surface, its links out of the true object.

use std::sync::Arc;

use crate::common::{
    egg, link_distance, object_from_links, on_ground, paper_params, parry_mesh, seeded,
};
use hand::{
    CollisionObject, Geometry, Hand, HandModel, PointTree, Surroundings, hand_meshes,
    load_urdf_with_meshes, propose, schunk_sdh, synthesize, synthesize_on, touching_joints,
};
use nalgebra::{Isometry3, Point3, Vector3};
use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::{TriMesh, TriMeshFlags};
use shape::{FitSettings, PointCloud, Support};

#[test]
fn at_the_grasp_joints_the_tips_touch() {
    let surface = egg(0.03, 0.2);
    let mesh = parry_mesh(&surface, 361, 720);
    let object = CollisionObject::new(&surface).unwrap();
    for hand in [
        schunk_sdh().unwrap(),
        Hand::built_in("panda").unwrap().unwrap(),
        Hand::built_in("robotiq_2f85").unwrap().unwrap(),
    ] {
        let params = paper_params(&hand, 60);
        let found = synthesize(&surface, &hand, &params, &mut seeded(4)).unwrap();
        assert!(found.grasps.len() >= 10);
        for grasp in found.grasps.iter().take(10) {
            let palm = &grasp.object_from_palm;
            let joints = touching_joints(&object, &hand, palm, &grasp.joints);
            let poses = object_from_links(&hand, palm, &joints);
            for finger in hand.fingers() {
                let gaps = finger
                    .tip_links
                    .iter()
                    .map(|&l| link_distance(hand.model(), l, &poses[l], &mesh, 0.01));
                let gap = gaps.fold(f64::INFINITY, f64::min);
                assert!(gap > 0.0 && gap <= 5e-4, "{}: {gap}", hand.name());
            }
        }
    }
}

/// A hand of the data folder with the spec that its URDF gives.
fn published(name: &str) -> Hand {
    let path = testkit::scans().join("hands").join(name);
    let folder = path.parent().unwrap().to_owned();
    let text = std::fs::read_to_string(&path).unwrap();
    let mesh = |file: &str| std::fs::read(folder.join(file.trim_start_matches("package://")));
    let model: HandModel = load_urdf_with_meshes(&text, mesh).unwrap();
    let spec = propose(&model, None, &seeded(0)).unwrap().spec;
    Hand::new(model, &spec).unwrap()
}

#[test]
#[ignore = "needs the scans of MODULI_DATA"]
fn hulls_of_published_tips_are_tight() {
    for name in [
        "sdh/sdh.urdf",
        "allegro/allegro_hand_right.urdf",
        "robotiq_2f85/2f85.urdf",
    ] {
        let hand = published(name);
        let joints = &hand.preshapes()[0].joints;
        let poses = hand.model().root_from_links(joints).unwrap();
        let meshes = hand_meshes(&hand, joints).unwrap();
        for &link in hand.fingers().iter().flat_map(|f| &f.tip_links) {
            let of_pieces = hand.model().links()[link]
                .geometry
                .iter()
                .flat_map(|piece| {
                    let placed = poses[link] * piece.link_from_geometry;
                    let points = match &piece.geometry {
                        Geometry::Hull { points, .. } => points.clone(),
                        _ => Vec::new(),
                    };
                    points.into_iter().map(move |p| placed * p)
                });
            let real: Vec<Point3<f64>> = of_pieces.collect();
            let (_, drawn) = meshes.iter().find(|(l, _)| *l == link).unwrap();
            if real.is_empty() {
                continue;
            }
            for direction in sph::direction::even_directions(400) {
                let reach = |points: &[Point3<f64>]| {
                    let heights = points.iter().map(|p| p.coords.dot(&direction));
                    heights.fold(f64::NEG_INFINITY, f64::max)
                };
                let excess = reach(&drawn.vertices) - reach(&real);
                // Boxes of the same link may reach farther.
                let boxes = hand.model().links()[link].geometry.len() > 1;
                assert!(
                    boxes || (-1e-9..=2e-4).contains(&excess),
                    "{name}: {excess}"
                );
            }
        }
    }
}

/// A pose of the palm and joints.
type Placed = (Isometry3<f64>, Vec<f64>);

/// Stable grasps of the fitted scan, with the support and the points of the scan.
fn grasps(hand: &Hand, cloud: &PointCloud) -> (Vec<Placed>, Support, Point3<f64>) {
    let settings = FitSettings {
        degree: 50,
        lambda: None,
    };
    let fit = shape::fit::fit(cloud, &settings).unwrap();
    let centre = fit.centre_in_cloud;
    let centred: Vec<Point3<f64>> = cloud.points().iter().map(|p| p - centre.coords).collect();
    let support = Support {
        normal: Vector3::z_axis(),
        offset_m: centred.iter().map(|p| p.z).fold(f64::INFINITY, f64::min),
    };
    let object = CollisionObject::new(&fit.shape)
        .unwrap()
        .with_surroundings(Arc::new(Surroundings {
            cloud: PointTree::new(centred),
            ..Surroundings::default()
        }));
    let params = on_ground(hand, 200, support);
    let found = synthesize_on(&object, hand, &params, &mut seeded(6), &|| {}).unwrap();
    let placed = found.grasps.iter().take(20).map(|g| {
        let joints = touching_joints(&object, hand, &g.object_from_palm, &g.joints);
        (g.object_from_palm, joints)
    });
    (placed.collect(), support, centre)
}

fn vector(p: &Point3<f64>) -> Vector {
    Vector::new(p.x, p.y, p.z)
}

#[test]
#[ignore = "needs the scans of MODULI_DATA"]
fn hands_are_above_the_table_and_out_of_the_true_object() {
    for (object, file) in [
        ("tomato_soup_can", "tomato_soup_can.obj"),
        ("pear", "pear_mesh.ply"),
    ] {
        let bytes = testkit::scan_bytes(&format!("objects/{object}.ply"));
        let cloud = PointCloud::new(shape::io::read_ply(&bytes).unwrap().points).unwrap();
        let bytes = testkit::scan_bytes(&format!("objects/meshes/{file}"));
        let extension = file.rsplit_once('.').unwrap().1;
        let shape::io::Geometry::Mesh(mesh) =
            shape::io::read_cloud(&bytes, extension).unwrap().geometry
        else {
            panic!("{file} has no faces");
        };
        for hand in [schunk_sdh().unwrap(), published("panda/panda_gripper.urdf")] {
            let (grasps, support, centre) = grasps(&hand, &cloud);
            assert!(grasps.len() >= 10, "{object}: {}", grasps.len());
            let vertices = mesh.vertices.iter().map(|v| vector(&(v - centre.coords)));
            let flags = TriMeshFlags::ORIENTED | TriMeshFlags::MERGE_DUPLICATE_VERTICES;
            let solid = TriMesh::with_flags(vertices.collect(), mesh.triangles.clone(), flags);
            let solid = solid.unwrap();
            for (palm, joints) in grasps {
                for (_, link) in hand_meshes(&hand, &joints).unwrap() {
                    for v in &link.vertices {
                        let p = palm * v;
                        assert!(support.height(&p) >= 3e-3 - 1e-9, "{object}: {p}");
                        let found = solid.project_local_point(vector(&p), false);
                        let depth = (found.point - vector(&p)).length();
                        assert!(!found.is_inside || depth < 1e-3, "{object}: {depth}");
                    }
                }
            }
        }
    }
}
