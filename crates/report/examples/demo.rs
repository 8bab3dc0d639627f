//! demo
use report::*;
use std::f64::consts::{PI, TAU};
fn r(t: f64, p: f64) -> f64 {
    0.045 * (1.0 + 0.35 * (2.0 * t).cos() + 0.12 * (3.0 * p).cos() * t.sin().powi(3))
}
fn pos(t: f64, p: f64) -> [f64; 3] {
    let r = r(t, p);
    [
        0.1 + r * t.sin() * p.cos(),
        r * t.sin() * p.sin(),
        0.05 + 1.4 * r * t.cos(),
    ]
}
fn mesh(n: usize, f: &dyn Fn(f64, f64) -> [f64; 3]) -> Mesh {
    let mut m = Mesh::default();
    for i in 0..n {
        for j in 0..n {
            m.vertices
                .push(f(PI * i as f64 / (n - 1) as f64, TAU * j as f64 / n as f64));
        }
    }
    for i in 0..n - 1 {
        for j in 0..n {
            let a = (i * n + j) as u32;
            let b = (i * n + (j + 1) % n) as u32;
            let c = a + n as u32;
            let d = b + n as u32;
            m.triangles.push([a, c, b]);
            m.triangles.push([b, c, d]);
        }
    }
    m
}
fn normal(t: f64, p: f64) -> [f64; 3] {
    let h = 1e-5;
    let a = pos(t + h, p);
    let b = pos(t - h, p);
    let c = pos(t, p + h);
    let d = pos(t, p - h);
    let u = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let v = [c[0] - d[0], c[1] - d[1], c[2] - d[2]];
    let n = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    n.map(|x| -x)
}
fn cuboid(lo: [f64; 3], hi: [f64; 3]) -> Mesh {
    let mut m = Mesh::default();
    for k in 0..8 {
        m.vertices.push([
            if k & 1 == 0 { lo[0] } else { hi[0] },
            if k & 2 == 0 { lo[1] } else { hi[1] },
            if k & 4 == 0 { lo[2] } else { hi[2] },
        ]);
    }
    for q in [
        [0, 1, 3, 2],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 3, 7, 6],
        [0, 2, 6, 4],
        [1, 3, 7, 5u32],
    ] {
        m.triangles.push([q[0], q[1], q[2]]);
        m.triangles.push([q[0], q[2], q[3]]);
    }
    m
}
fn main() {
    let mut grasps = vec![];
    for k in 0..24 {
        let a = 0.4 * k as f64;
        let tp = [(1.3, a), (1.5, a + 2.2), (1.2 + 0.02 * k as f64, a + 4.0)];
        let contacts: Vec<_> = tp.iter().map(|&(t, p)| pos(t, p)).collect();
        let inward_normals: Vec<_> = tp.iter().map(|&(t, p)| normal(t, p)).collect();
        let hand = (k < 5).then(|| {
            let mut m = cuboid([0.06, -0.04, 0.19], [0.14, 0.04, 0.28]);
            for (x, y) in [(0.045, 0.03), (0.045, -0.05), (0.14, -0.01)] {
                m.append(&cuboid([x, y, 0.05], [x + 0.02, y + 0.02, 0.19]));
            }
            m
        });
        grasps.push(PageGrasp {
            label: if k % 4 == 0 {
                "G17".into()
            } else {
                String::new()
            },
            quality: 0.5612 - 0.011 * k as f64,
            source: if k % 3 == 0 {
                "transfer from S5 <tomato soup can>".into()
            } else {
                "synthesis".into()
            },
            contacts,
            inward_normals,
            details: if hand.is_some() {
                [
                    "knuckle",
                    "thumb_2",
                    "thumb_3",
                    "finger_12",
                    "finger_13",
                    "finger_22",
                    "finger_23",
                ]
                .iter()
                .map(|n| (format!("joint {n}"), "-0.412 rad".into()))
                .collect()
            } else {
                vec![]
            },
            hand,
        });
    }
    let page = GraspPage { title: "mustard_bottle.ply".into(), subtitle_lines: vec!["96 × 58 × 190 mm, 25,000 points; fitted at degree 50, RMS 0.41 mm".into(), "Certified radius 24.31 – 98.02 mm".into(), "Convention paper: unit normal component, torque length 10 mm about the cloud mean, μ = 1.0, 10 edges".into()],
        mesh: mesh(100, &pos), cloud: (0..9000).map(|i| { let t = (1.0 - 2.0 * (i as f64 + 0.5) / 9000.0f64).acos(); pos(t, 2.399963 * i as f64) }).collect(), friction: 1.0, grasps };
    let html = grasp_page(&page).unwrap();
    eprintln!("{}", html.len());
    std::fs::write("/tmp/page.html", html).unwrap();
    std::fs::write(
        "/tmp/page_empty.html",
        grasp_page(&GraspPage {
            grasps: vec![],
            ..page
        })
        .unwrap(),
    )
    .unwrap();

    let cells: Vec<_> = (0..15)
        .map(|k| {
            let m = mesh(60, &|t, p| {
                let s = 1.0 + 0.3 * ((k % 5) as f64 * p).cos() * t.sin().powi(2);
                [s * t.sin() * p.cos(), s * t.sin() * p.sin(), s * t.cos()]
            });
            let values = m
                .vertices
                .iter()
                .map(|v| ((k + 1) as f64 * v[2]).sin() * v[0])
                .collect();
            let mut items = vec![Item::Surface(Surface {
                mesh: m,
                values: if k < 10 { values } else { vec![] },
            })];
            if k >= 10 {
                items.push(Item::Arrows(Arrows {
                    tips: vec![[1.0, 0.0, 0.0], [0.0, -1.0, 0.0]],
                    directions: vec![[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
                    length: 0.7,
                }));
            }
            SceneCell {
                label: format!("S{}", k + 1),
                items,
            }
        })
        .collect();
    let spiral: Vec<[f64; 3]> = (0..30)
        .map(|k| {
            [
                0.02 * k as f64,
                (0.2 * k as f64).sin() * 0.1,
                0.001 * (k * k) as f64,
            ]
        })
        .collect();
    let p = Page { title: "Experiments of Sec. IV".into(), intro: "First paragraph of the introduction, which says what was run and under which convention.\n\nSecond paragraph.".into(), sections: vec![
        Section { heading: "Reconstruction error".into(), text: "Error against degree.".into(), blocks: vec![
            Block::Chart(Chart { title: "RMS error against L".into(), x: Axis::linear("degree L"), y: Axis::log("RMS / mm"), diagonal: false, equal_scale: false,
                series: (0..9).map(|k| Series { mark: if k % 2 == 0 { Mark::Line } else { Mark::LineAndPoints }, ..Series::line(format!("S{k} object"), (1..50).map(|l| [l as f64, 20.0 / (l as f64).powf(1.0 + 0.1 * k as f64)]).collect()) }).collect() }),
            Block::Chart(Chart { title: "Initial against final quality".into(), x: Axis::linear("initial Q"), y: Axis::linear("final Q"), diagonal: true, equal_scale: true,
                series: (0..12).map(|k| Series::points(format!("S{}", k + 1), (0..50).map(|i| { let x = ((i * 37 + k * 11) % 100) as f64 / 160.0; [x, (x + 0.1 + 0.002 * (i + k) as f64).min(0.72)] }).collect())).collect() }),
            Block::Table(Table { title: "Paper and ours".into(), headers: ["quantity", "paper", "ours"].map(String::from).to_vec(), rows: vec![vec!["unstable transfers".into(), "9".into(), "3".into()], vec!["best Q".into(), "0.72".into(), "0.7213".into()]] }),
        ] },
        Section { heading: "Surfaces".into(), text: String::new(), blocks: vec![
            Block::SceneGrid(SceneGrid { title: "Twelve surfaces".into(), columns: 5, cells, colour_scale: ColourScale::Diverging, value_label: "Y".into() }),
            Block::Scene(Scene { title: "MDS".into(), axes: Some(["first", "second", "third"].map(String::from)), items: vec![
                Item::Points(Points { name: "objects".into(), points: spiral.iter().step_by(5).copied().collect(), labels: (0..6).map(|k| format!("S{k}")).collect(), size_px: 6 }),
                Item::Lines(Lines { name: "S5 to S1".into(), points: spiral }) ], ..Scene::default() }),
            Block::Bars(Bars { title: "Outcomes".into(), x_label: "object".into(), y_label: "poses".into(), categories: (1..13).map(|k| format!("S{k}")).collect(), series: ["accepted", "hand too close", "no contact"].iter().enumerate().map(|(j, n)| BarSeries { name: n.to_string(), values: (0..12).map(|k| 200.0 + 40.0 * ((k * 7 + j * 5) % 11) as f64).collect() }).collect() }),
            Block::Histogram(Histogram { title: "Quality".into(), x_label: "Q".into(), bins: 30, samples: ["before", "after"].iter().enumerate().map(|(j, n)| Sample { name: n.to_string(), values: (0..500).map(|i| 0.1 * j as f64 + ((i * 7919) % 1000) as f64 / 2000.0 + ((i * 104729) % 997) as f64 / 3000.0).collect() }).collect() }),
        ] } ] };
    std::fs::write("/tmp/exp.html", p.to_html().unwrap()).unwrap();
}
