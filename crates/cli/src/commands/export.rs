//! `moduli export`: grasps in the formats of other programs.

use record::grasps::{HandRecord, JointRecord};
use record::{GraspRecord, GraspsFile, isaac_grasps, moveit_grasps};
use run::npz::{Array, Entries, to_npz};
use serde::Serialize;

use crate::args::{Common, ExportKind, ExportOptions};
use crate::failure::Failure;
use crate::{input, output};

#[derive(Serialize)]
struct ExportLine {
    object: String,
    grasps: usize,
    without_hand: usize,
    output: String,
}

pub(crate) fn run(options: &ExportOptions, common: &Common) -> Result<(), Failure> {
    run::check_results(&[&options.output], &[&options.grasps])?;
    let file = input::grasps(&options.grasps)?;
    let held = with_hand(&file);
    if held.is_empty() {
        return Err(Failure::input(
            &options.grasps,
            "none of its grasps has a hand, and the formats of other programs hold hand poses; `moduli grasp` and `moduli synthesize` write grasps with a hand",
        ));
    }
    let bytes = match options.kind {
        ExportKind::Isaac => isaac_grasps(&file).into_bytes(),
        ExportKind::Moveit => moveit_grasps(&file).into_bytes(),
        ExportKind::Npz => to_npz(&arrays(&held))
            .ok_or_else(|| Failure::other("the arrays are too large for an archive"))?,
    };
    output::write_file(&options.output, &bytes)?;
    let line = ExportLine {
        object: file.object.name.clone(),
        grasps: held.len(),
        without_hand: file.grasps.len() - held.len(),
        output: options.output.display().to_string(),
    };
    if common.json {
        return output::say_json(&line);
    }
    output::say(format!(
        "{}: {} grasps of the hand {}, {} without a hand left out",
        line.object, line.grasps, held[0].1.name, line.without_hand
    ));
    output::say(line.output);
    Ok(())
}

fn with_hand(file: &GraspsFile) -> Vec<(&GraspRecord, &HandRecord)> {
    let all = file.grasps.iter();
    all.filter_map(|g| Some((g, g.hand.as_ref()?))).collect()
}

/// One row per grasp; contacts that a grasp does not have are NaN.
fn arrays(grasps: &[(&GraspRecord, &HandRecord)]) -> Vec<Array> {
    let count = grasps.len();
    let names: Vec<String> = grasps[0].1.joints.keys().cloned().collect();
    let contacts = grasps.iter().map(|(g, _)| g.contacts_m.len()).max();
    let contacts = contacts.unwrap_or(0);
    let floats = |name: &str, shape: Vec<usize>, values: Vec<f64>| Array {
        name: name.to_owned(),
        shape,
        entries: Entries::Floats(values),
    };
    let joints =
        |of: &dyn Fn(&HandRecord) -> Vec<f64>| grasps.iter().flat_map(|g| of(g.1)).collect();
    let value = |joint: Option<&JointRecord>| joint.map_or(f64::NAN, |j| j.value);
    let closed = joints(&|h| names.iter().map(|n| value(h.joints.get(n))).collect());
    let open = joints(&|h| {
        names
            .iter()
            .map(|n| value(h.pregrasp_joints.get(n)))
            .collect()
    });
    let poses = joints(&|h| {
        let pose = &h.cloud_from_palm;
        [&pose.translation_m[..], &pose.quaternion_xyzw].concat()
    });
    let padded = |of: &dyn Fn(&GraspRecord) -> Vec<[f64; 3]>| -> Vec<f64> {
        let row = |g: &GraspRecord| {
            let mut row = of(g);
            row.resize(contacts, [f64::NAN; 3]);
            row.concat()
        };
        grasps.iter().flat_map(|(g, _)| row(g)).collect()
    };
    vec![
        floats(
            "quality",
            vec![count],
            grasps.iter().map(|g| g.0.quality).collect(),
        ),
        floats("object_from_palm", vec![count, 7], poses),
        floats("joints", vec![count, names.len()], closed),
        floats("pregrasp_joints", vec![count, names.len()], open),
        floats(
            "contacts_m",
            vec![count, contacts, 3],
            padded(&|g| g.contacts_m.clone()),
        ),
        floats(
            "inward_normals",
            vec![count, contacts, 3],
            padded(&|g| g.inward_normals.clone()),
        ),
        Array {
            name: "joint_names".to_owned(),
            shape: vec![names.len()],
            entries: Entries::Words(names),
        },
    ]
}
