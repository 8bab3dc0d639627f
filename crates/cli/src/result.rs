//! The files of ranked grasps, and the table.

use std::path::{Path, PathBuf};

use hand::Hand;
use moduli::{Grasp, Measure};
use record::{GraspsFile, isaac_grasps};
use shape::PointCloud;

use crate::failure::Failure;
use crate::{output, page};

/// Rows of the table on standard output.
const SHOWN: usize = 10;

/// What was written.
pub(crate) struct Written {
    pub(crate) file: GraspsFile,
    pub(crate) grasps_json: PathBuf,
    pub(crate) grasps_yaml: PathBuf,
    pub(crate) index_html: PathBuf,
}

/// Writes grasps.json, grasps.yaml and index.html into a folder; `facts` are further lines of the
/// page's head.
pub(crate) fn write(
    folder: &Path,
    measure: &Measure,
    cloud: Option<&PointCloud>,
    hand: &Hand,
    ranked: &[Grasp],
    facts: Vec<String>,
) -> Result<Written, Failure> {
    let mut file = measure.grasps_file(hand, ranked);
    if let Some(cloud) = cloud {
        let name = measure.object().name();
        measure
            .add_evidence(hand, &mut file.grasps, ranked, cloud)
            .map_err(|e| Failure::refused(format!("{name}: {e}")))?;
    }
    let written = Written {
        grasps_json: folder.join("grasps.json"),
        grasps_yaml: folder.join("grasps.yaml"),
        index_html: folder.join("index.html"),
        file,
    };
    let file = &written.file;
    let html = page::render(measure, cloud, hand, ranked, file, facts)?;
    output::write_file(&written.grasps_json, &output::encode(file)?)?;
    output::write_file(&written.grasps_yaml, isaac_grasps(file).as_bytes())?;
    output::write_file(&written.index_html, html.as_bytes())?;
    Ok(written)
}

impl Written {
    /// The best grasps, a line each.
    pub(crate) fn print_table(&self) {
        if self.file.grasps.is_empty() {
            return;
        }
        output::say(format!(
            "\n{:>4}  {:>7}  {:36}  {}",
            "rank", "quality", "source", "contacts (mm, frame of the cloud)"
        ));
        for grasp in self.file.grasps.iter().take(SHOWN) {
            let contacts: Vec<String> = grasp
                .contacts_m
                .iter()
                .map(|c| format!("({:.1} {:.1} {:.1})", 1e3 * c[0], 1e3 * c[1], 1e3 * c[2]))
                .collect();
            output::say(format!(
                "{:>4}  {:>7.4}  {:36}  {}",
                grasp.rank,
                grasp.quality,
                page::source_label(&grasp.source),
                contacts.join(" ")
            ));
        }
        output::say("");
    }

    /// The paths of the files.
    pub(crate) fn print_paths(&self) {
        for path in [&self.grasps_json, &self.grasps_yaml, &self.index_html] {
            output::say(path.display().to_string());
        }
    }
}
