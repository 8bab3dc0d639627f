//! Fig. 4: the surfaces and the shape space.

use report::{
    Axis, Block, Chart, Item, Lines, Mark, Points, Scene, SceneCell, SceneGrid, Section, Series,
};

use super::findings::{Place, ShapeSpace};
use crate::drawing::{section, surface};
use crate::pipeline::{FittedScan, FittedSet};
use crate::table::{Table, millimetres, number, per_cent};

pub(super) fn table(ours: &ShapeSpace) -> Table {
    let mut table = Table::new(
        "Sec. IV-A: which shapes the deformations pass (paper: S7 and S8)",
        &[
            "shape",
            "way",
            "at t",
            "distance mm",
            "of nearer end",
            "nearest there",
        ],
    );
    for p in &ours.passings {
        table.row([
            p.id.clone(),
            format!("{}→{}", p.from, p.to),
            number(Some(p.t), 2),
            millimetres(Some(p.distance_m), 1),
            per_cent(Some(p.distance_over_nearer_end)),
            if p.nearest_object_there { "yes" } else { "no" }.into(),
        ]);
    }
    if let Some(line) = &ours.spheres {
        let nearest: Vec<String> = line
            .objects_by_distance
            .iter()
            .take(3)
            .map(|(id, d, r)| format!("{id} {:.1} mm at radius {:.1} mm", 1e3 * d, 1e3 * r))
            .collect();
        table.note(format!(
            "{} spheres bend by {} of their line; nearest to it (paper: S11 and S12): {}",
            line.radii_m.len(),
            per_cent(Some(line.bend)),
            nearest.join(", "),
        ));
    }
    table.note(format!(
        "MDS of {} shapes keeps {} of the squared distances in 2 dimensions, {} in 3",
        ours.places.len(),
        per_cent(Some(ours.explained[0])),
        per_cent(Some(ours.explained[1])),
    ));
    table
}

/// The surfaces, and the classical scaling in two and three dimensions.
pub(super) fn figures(set: &FittedSet, found: &ShapeSpace) -> Vec<Section> {
    vec![
        section(
            "Objects",
            "Surfaces fitted to the clouds, all to one scale.",
            vec![Block::SceneGrid(grid(set))],
        ),
        section(
            "Shape space",
            "Classical scaling of the distances between β vectors, in millimetres.",
            vec![Block::Scene(scene(found)), Block::Chart(plane(found))],
        ),
    ]
}

fn grid(set: &FittedSet) -> SceneGrid {
    let cell = |o: &FittedScan| SceneCell {
        label: format!(
            "{} {}",
            o.id(),
            if o.id() == o.scan.name {
                ""
            } else {
                &o.scan.name
            }
        ),
        items: vec![surface(o.shape())],
    };
    SceneGrid {
        title: "Smooth surfaces".to_owned(),
        columns: 4,
        cells: set.objects.iter().map(cell).collect(),
        ..SceneGrid::default()
    }
}

/// The points of one kind, and their labels.
fn of_kind<'a>(found: &'a ShapeSpace, kind: &'a str) -> impl Iterator<Item = &'a Place> {
    found.places.iter().filter(move |p| p.kind == kind)
}

/// Deformations: the name, and the points from end to end.
fn ways(found: &ShapeSpace) -> Vec<(String, Vec<&Place>)> {
    let mut ways: Vec<(String, Vec<&Place>)> = Vec::new();
    for place in of_kind(found, "deformation") {
        let name = place.label.split(" at ").next().unwrap_or_default();
        match ways.last_mut() {
            Some((last, places)) if last == name => places.push(place),
            _ => ways.push((name.to_owned(), vec![place])),
        }
    }
    for (name, places) in &mut ways {
        let end = |id: &str| of_kind(found, "object").find(|p| p.label == id);
        if let Some((from, to)) = name.split_once('→') {
            places.splice(0..0, end(from));
            places.extend(end(to));
        }
    }
    ways
}

fn scene(found: &ShapeSpace) -> Scene {
    let at = |p: &&Place| std::array::from_fn(|k| 1e3 * p.coordinates[k]);
    let points = |name: &str, kind: &str, labelled: bool, size_px| {
        Item::Points(Points {
            name: name.to_owned(),
            points: of_kind(found, kind).map(|p| at(&p)).collect(),
            labels: of_kind(found, kind)
                .filter(|_| labelled)
                .map(|p| p.label.clone())
                .collect(),
            size_px,
        })
    };
    let mut items = vec![points("objects", "object", true, 7)];
    items.push(points("spheres", "sphere", false, 4));
    for (name, places) in ways(found) {
        items.push(Item::Lines(Lines {
            name,
            points: places.iter().map(at).collect(),
        }));
    }
    items.retain(|item| !matches!(item, Item::Points(p) if p.points.is_empty()));
    Scene {
        title: "Three dimensions".to_owned(),
        axes: Some(["1 / mm", "2 / mm", "3 / mm"].map(str::to_owned)),
        items,
        ..Scene::default()
    }
}

fn plane(found: &ShapeSpace) -> Chart {
    let at = |p: &&Place| [1e3 * p.coordinates[0], 1e3 * p.coordinates[1]];
    let mut objects = Series::points(
        "objects",
        of_kind(found, "object").map(|p| at(&p)).collect(),
    );
    objects.labels = found.ids.clone();
    let spheres = Series::points(
        "spheres",
        of_kind(found, "sphere").map(|p| at(&p)).collect(),
    );
    let mut series = vec![objects, spheres];
    for (name, places) in ways(found) {
        series.push(Series {
            mark: Mark::Line,
            ..Series::points(name, places.iter().map(at).collect())
        });
    }
    series.retain(|s| !s.points.is_empty());
    Chart {
        title: "Two dimensions".to_owned(),
        x: Axis::linear("1 / mm"),
        y: Axis::linear("2 / mm"),
        series,
        diagonal: false,
        equal_scale: true,
    }
}
