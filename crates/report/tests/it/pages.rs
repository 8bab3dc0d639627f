//! Whole pages: their content, that they load nothing, and which input is an error.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::read::ZlibDecoder;
use report::{
    Arrows, Axis, BarSeries, Bars, Block, Chart, GraspPage, Histogram, Item, Mesh, Page, PageGrasp,
    Points, ReportError, Sample, Scene, SceneCell, SceneGrid, Section, Series, Surface, Table,
    WeakestWrench, grasp_page,
};

const HOSTILE: &str = r#"</script><script>alert("1")</script><img src='http://x/'>&quot;%{x}"#;

fn tetrahedron() -> Mesh {
    Mesh {
        vertices: vec![
            [0.1, 0.0, 0.0],
            [0.0, 0.1, 0.0],
            [0.0, 0.0, 0.1],
            [-0.031_234_56, -0.03, -0.03],
        ],
        triangles: vec![[0, 1, 2], [0, 1, 3], [1, 2, 3], [0, 2, 3]],
    }
}

fn grasp(text: &str) -> PageGrasp {
    PageGrasp {
        label: text.to_owned(),
        quality: 0.412_349,
        source: text.to_owned(),
        contacts: vec![[0.012_345_6, -0.02, 0.0], [0.0, 0.0, 0.05]],
        inward_normals: vec![[1.0, 0.0, 0.0], [0.0, 0.0, -2.0]],
        lower: 0.412_3,
        distances_to_cloud: vec![0.000_5, 0.004],
        weakest: Some(WeakestWrench {
            force: [0.6, 0.0, 0.0],
            torque: [0.0, 0.8, 0.0],
        }),
        pose: text.to_owned(),
        details: vec![(text.to_owned(), text.to_owned())],
        hand: Some(tetrahedron()),
    }
}

fn object(text: &str) -> GraspPage {
    GraspPage {
        title: text.to_owned(),
        subtitle_lines: vec![text.to_owned()],
        mesh: tetrahedron(),
        closed_holes: Mesh::default(),
        cloud: vec![[0.02, 0.03, 0.041_114]; 9000],
        friction: 0.5,
        grasps: vec![grasp(text), grasp("synthesis")],
    }
}

/// A surface, points and arrows.
fn items(text: &str) -> Vec<Item> {
    let name = || text.to_owned();
    vec![
        Item::Surface(Surface {
            mesh: tetrahedron(),
            values: vec![0.0, 1.0, 2.0, 3.0],
        }),
        Item::Points(Points {
            name: name(),
            points: vec![[0.0; 3], [0.1; 3]],
            labels: vec![name(), name()],
            size_px: 4,
        }),
        Item::Arrows(Arrows {
            tips: vec![[0.0; 3]],
            directions: vec![[0.0, 0.0, 1.0]],
            length: 0.02,
        }),
    ]
}

fn every_block(text: &str) -> Page {
    let name = || text.to_owned();
    let items = items(text);
    let series = Series {
        labels: vec![name(), name()],
        ..Series::line(text, vec![[1.0, 2.5], [3.0, 0.125]])
    };
    let blocks = vec![
        Block::Chart(Chart {
            title: name(),
            x: Axis::linear(text),
            y: Axis::log(text),
            series: vec![series],
            diagonal: true,
            equal_scale: false,
        }),
        Block::Bars(Bars {
            title: name(),
            x_label: name(),
            y_label: name(),
            categories: vec![name()],
            series: vec![BarSeries {
                name: name(),
                values: vec![17.5],
            }],
        }),
        Block::Histogram(Histogram {
            title: name(),
            x_label: name(),
            bins: 4,
            samples: vec![Sample {
                name: name(),
                values: vec![0.0, 1.0, 1.0],
            }],
        }),
        Block::Scene(Scene {
            title: name(),
            axes: Some([name(), name(), name()]),
            items: items.clone(),
            value_label: name(),
            ..Scene::default()
        }),
        Block::SceneGrid(SceneGrid {
            title: name(),
            columns: 2,
            cells: vec![
                SceneCell {
                    label: name(),
                    items,
                };
                3
            ],
            value_label: name(),
            ..SceneGrid::default()
        }),
        Block::Table(Table {
            title: name(),
            headers: vec![name()],
            rows: vec![vec![name()]],
        }),
        Block::Text(name()),
    ];
    Page {
        title: name(),
        intro: name(),
        sections: vec![Section {
            heading: name(),
            text: name(),
            blocks,
        }],
    }
}

fn json_of(html: &str, id: &str) -> serde_json::Value {
    let tag = format!("<script type=\"text/plain\" class=\"packed\" id=\"{id}\">");
    let start = html.find(&tag).unwrap() + tag.len();
    let end = start + html[start..].find("</script>").unwrap();
    let bytes = STANDARD.decode(&html[start..end]).unwrap();
    serde_json::from_reader(ZlibDecoder::new(&bytes[..])).unwrap()
}

fn assert_self_contained(html: &str) {
    let own = html;
    assert!(own.contains("default-src 'none'"));
    for load in ["<link", "<script src", "<img", "<iframe", "@import", "url("] {
        assert!(!own.contains(load), "{load}");
    }
    assert_eq!(html.matches("id=\"plotly-js\"").count(), 1);
    assert!(html.len() < 2_200_000, "{} bytes", html.len());
}

#[test]
fn a_grasp_page_holds_its_data_in_millimetres() {
    let html = grasp_page(&object("mug")).unwrap();
    let data = json_of(&html, "grasp-data");
    let surface = &data["plot"]["data"][0];
    assert_eq!(surface["x"], serde_json::json!([100.0, 0.0, 0.0, -31.24]));
    assert_eq!(surface["i"], serde_json::json!([0, 0, 1, 0]));
    let cloud = &data["plot"]["data"][1];
    assert_eq!(cloud["x"].as_array().unwrap().len(), 3000);
    assert_eq!(cloud["z"][0], 41.12);
    let grasps = data["grasps"].as_array().unwrap();
    assert_eq!(grasps.len(), 2);
    let traces = grasps[0].as_array().unwrap().iter();
    let roles: Vec<_> = traces.map(|t| t["meta"].as_str().unwrap()).collect();
    assert_eq!(
        roles,
        [
            "grasp", "grasp", "grasp", "cones", "wrench", "wrench", "hand"
        ]
    );
    assert_eq!(grasps[0][1]["x"], serde_json::json!([12.34, 0.0]));
    assert!(html.contains("0.4123"));
    assert!(html.contains("<dd>12.3, -20.0, 0.0</dd>"));
    // To the scan, and whether there is a hand.
    assert!(html.contains("<td class=\"num\">4.0</td><td>yes</td>"));
    assert!(html.contains("0.000, 0.000, -1.000"));
}

#[test]
fn pages_load_nothing_and_embed_plotly_once() {
    assert_self_contained(&grasp_page(&object("mug")).unwrap());
    assert_self_contained(&every_block("plain").to_html().unwrap());
}

#[test]
fn hostile_text_stays_text() {
    for html in [
        grasp_page(&object(HOSTILE)).unwrap(),
        every_block(HOSTILE).to_html().unwrap(),
    ] {
        assert_self_contained(&html);
        let own = &html;
        assert!(!own.contains("<script>alert") && !own.contains("alert(\"1\")"));
        assert!(own.contains("&lt;/script&gt;&lt;script&gt;alert(&quot;1&quot;)"));
        // Each script element that is opened is closed by its own end tag and no other.
        let opened = own.matches("<script").count();
        assert_eq!(opened, own.matches("</script>").count());
    }
}

#[test]
fn text_inside_figures_is_no_markup() {
    let html = every_block(HOSTILE).to_html().unwrap();
    for k in 0..5 {
        let figure = json_of(&html, &format!("figure-{k}-data")).to_string();
        assert!(!figure.contains("<script") && !figure.contains("%{x}"));
    }
}

#[test]
fn figures_hold_their_data() {
    let html = every_block("plain").to_html().unwrap();
    let chart = json_of(&html, "figure-0-data");
    assert_eq!(chart["data"][1]["y"], serde_json::json!([2.5, 0.125]));
    assert_eq!(chart["layout"]["yaxis"]["type"], "log");
    let bars = json_of(&html, "figure-1-data");
    assert_eq!(bars["data"][0]["y"][0], 17.5);
    let histogram = json_of(&html, "figure-2-data");
    assert_eq!(histogram["data"][0]["y"], serde_json::json!([1, 0, 0, 2]));
    let scene = json_of(&html, "figure-3-data");
    let values = &scene["data"][0]["intensity"];
    assert_eq!(*values, serde_json::json!([0.0, 1.0, 2.0, 3.0]));
    let grid = json_of(&html, "figure-4-data");
    let surfaces = grid["data"].as_array().unwrap().iter();
    assert_eq!(surfaces.filter(|t| t["intensity"].is_array()).count(), 3);
}

#[test]
fn equal_scales_in_every_view() {
    let html = every_block("plain").to_html().unwrap();
    for k in [3, 4] {
        let scene = &json_of(&html, &format!("figure-{k}-data"))["layout"]["scene"];
        let scale = |axis: &str| {
            let range = &scene[format!("{axis}axis")]["range"];
            let length = range[1].as_f64().unwrap() - range[0].as_f64().unwrap();
            scene["aspectratio"][axis].as_f64().unwrap() / length
        };
        assert!((scale("x") / scale("y") - 1.0).abs() <= 1e-9);
        assert!((scale("x") / scale("z") - 1.0).abs() <= 1e-9);
    }
}

#[test]
fn an_object_without_grasps_has_a_page() {
    let page = GraspPage {
        grasps: Vec::new(),
        ..object("mug")
    };
    let html = grasp_page(&page).unwrap();
    assert!(html.contains("No grasp was found"));
    assert_eq!(
        json_of(&html, "grasp-data")["grasps"],
        serde_json::json!([])
    );
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let page = every_block("plain");
    assert_eq!(page.to_html().unwrap(), page.to_html().unwrap());
    let object = object("mug");
    assert_eq!(grasp_page(&object).unwrap(), grasp_page(&object).unwrap());
}

#[test]
fn numbers_that_are_none_are_refused_by_place() {
    let spoil: [fn(&mut GraspPage); 7] = [
        |p| p.mesh.vertices[2][1] = f64::NAN,
        |p| p.cloud[5][0] = f64::INFINITY,
        |p| p.friction = f64::NAN,
        |p| p.grasps[1].quality = f64::NAN,
        |p| p.grasps[1].contacts[0][2] = f64::NEG_INFINITY,
        |p| p.grasps[1].inward_normals[0][0] = f64::NAN,
        |p| p.grasps[0].hand.as_mut().unwrap().vertices[0][0] = f64::NAN,
    ];
    let places = [
        "mesh: vertices",
        "cloud",
        "friction",
        "grasp 1: quality",
        "grasp 1: contacts",
        "grasp 1: normals",
        "grasp 0: hand: vertices",
    ];
    for (spoil, place) in spoil.iter().zip(places) {
        let mut page = object("mug");
        spoil(&mut page);
        let error = grasp_page(&page).unwrap_err();
        assert!(error.to_string().starts_with(place), "{error}");
    }
}

#[test]
fn parts_that_do_not_match_are_refused() {
    let mut page = object("mug");
    page.grasps[0].inward_normals.pop();
    assert!(matches!(
        grasp_page(&page),
        Err(ReportError::LengthMismatch {
            expected: 2,
            found: 1,
            ..
        })
    ));
    let mut page = object("mug");
    page.grasps[0].inward_normals[1] = [0.0; 3];
    assert!(matches!(
        grasp_page(&page),
        Err(ReportError::OutOfRange { .. })
    ));
    let mut page = object("mug");
    page.mesh.triangles[3] = [0, 1, 4];
    assert!(matches!(
        grasp_page(&page),
        Err(ReportError::NoSuchVertex {
            index: 3,
            vertex: 4,
            ..
        })
    ));
}

#[test]
fn a_page_names_the_section_of_a_bad_number() {
    let mut page = every_block("plain");
    if let Block::Chart(chart) = &mut page.sections[0].blocks[0] {
        chart.series[0].points[1][1] = f64::NAN;
    }
    let error = page.to_html().unwrap_err().to_string();
    assert!(
        error.contains("section 0 (plain): block 0: series 0"),
        "{error}"
    );
}
