//! Every row of the reference grasps, and the check values of the conventions.

use grasp::hull::ConvexHull;
use grasp::{
    Contact, Convention, EdgeNorm, Edges, GraspModel, TorqueLength, Workspace, Wrench, epsilon,
    epsilon_linf, epsilon_of_wrenches, wrenches_force_closed, wrenches_with_tangents,
};
use nalgebra::{Point3, Unit, UnitVector3, Vector3};

struct Row {
    contacts: Vec<Contact>,
    tangents: Vec<UnitVector3<f64>>,
    centre: Point3<f64>,
    convention: Convention,
    q_l1: f64,
    vol_l1: f64,
    q_linf: Option<f64>,
}

fn reference_rows() -> Vec<Row> {
    let rows = testkit::reference::QUALITY.lines().skip(1);
    rows.map(parse_row).collect()
}

fn vectors(field: &str) -> Vec<Vector3<f64>> {
    let numbers: Vec<f64> = field.split(';').map(|x| x.parse().unwrap()).collect();
    numbers.chunks(3).map(Vector3::from_column_slice).collect()
}

fn parse_row(line: &str) -> Row {
    let field: Vec<&str> = line.split(',').collect();
    let number = |i: usize| field[i].parse::<f64>().unwrap();
    let contacts = vectors(field[0])
        .into_iter()
        .zip(vectors(field[1]))
        .map(|(c, n)| Contact {
            position: c.into(),
            inward_normal: Unit::new_unchecked(n),
        })
        .collect();
    let edge_norm = match field[6] {
        "length" => EdgeNorm::UnitLength,
        _ => EdgeNorm::UnitNormalComponent,
    };
    Row {
        contacts,
        tangents: vectors(field[2])
            .into_iter()
            .map(Unit::new_unchecked)
            .collect(),
        centre: vectors(field[3])[0].into(),
        convention: Convention {
            edge_norm,
            friction: number(4),
            edges: Edges::Polygon(field[5].parse().unwrap()),
            torque_length: TorqueLength::Metres(number(7)),
            ..Convention::unit()
        },
        q_l1: number(8),
        vol_l1: number(9),
        q_linf: field[10].parse().ok(),
    }
}

impl Row {
    fn wrenches(&self) -> Vec<Wrench> {
        wrenches_with_tangents(&self.model(), &self.tangents).unwrap()
    }

    fn model(&self) -> GraspModel<'_> {
        GraspModel::new(&self.contacts, &self.centre, &self.convention)
    }

    /// All sums of one edge or nothing per contact.
    fn sums(&self) -> Vec<Wrench> {
        let each = self.wrenches().len() / self.contacts.len();
        let mut sums = vec![Wrench::zeros()];
        for edges in self.wrenches().chunks(each) {
            let with = |s: &Wrench| edges.iter().map(|w| s + w).collect::<Vec<_>>();
            let more: Vec<Wrench> = sums.iter().flat_map(with).collect();
            sums.extend(more);
        }
        sums
    }
}

#[test]
fn epsilon_of_every_reference_row() {
    let rows = reference_rows();
    assert_eq!(rows.len(), 409);
    let mut workspace = Workspace::new();
    for (index, row) in rows.iter().enumerate() {
        let found = epsilon_of_wrenches(&row.wrenches(), &mut workspace).unwrap();
        let error = (found.quality - row.q_l1).abs();
        assert!(error <= 1e-9, "row {index}: {} {}", found.quality, row.q_l1);
        assert!(found.lower <= found.upper);
        assert!(found.upper - found.lower <= 1e-10, "row {index}");
        assert_eq!(found.closed, row.q_l1 > 1e-9, "row {index}");
    }
}

#[test]
fn tangent_rule_of_every_generic_reference_row() {
    let rows = reference_rows();
    let mut workspace = Workspace::new();
    // The last nine rows state a tangent of their own.
    for row in &rows[..400] {
        let found = epsilon(&row.model(), &mut workspace).unwrap();
        assert!((found.quality - row.q_l1).abs() <= 1e-9);
    }
}

#[test]
fn full_hull_of_every_reference_row() {
    let rows = reference_rows();
    for (index, row) in rows.iter().enumerate() {
        let (volume, ball) = match ConvexHull::new(&row.wrenches()) {
            Ok(hull) => (hull.volume(), hull.ball_radius().max(0.0)),
            Err(_) => (0.0, 0.0),
        };
        let error = (volume - row.vol_l1).abs();
        assert!(
            error <= 1e-9 * row.vol_l1.max(1.0),
            "row {index}: {volume} {}",
            row.vol_l1
        );
        assert!((ball - row.q_l1).abs() <= 1e-9, "row {index}");
    }
}

#[test]
fn sums_of_every_reference_row_that_has_them() {
    let rows = reference_rows();
    let mut workspace = Workspace::new();
    let mut seen = 0;
    for (index, row) in rows.iter().enumerate() {
        let Some(expected) = row.q_linf else { continue };
        let by_support = epsilon_linf(&row.model(), &mut workspace).unwrap();
        let error = (by_support.quality - expected).abs();
        assert!(error <= 1e-9, "row {index}: {by_support:?} {expected}");
        let found = epsilon_of_wrenches(&row.sums(), &mut workspace)
            .unwrap()
            .quality;
        let error = (found - expected).abs();
        assert!(error <= 1e-9, "row {index}: {found} {expected}");
        seen += 1;
    }
    assert!(seen > 50);
}

#[test]
fn linear_programme_agrees_on_closure() {
    let rows = reference_rows();
    for (index, row) in rows.iter().enumerate() {
        let closed = wrenches_force_closed(&row.wrenches());
        assert_eq!(closed, row.q_l1 > 1e-9, "row {index}: {}", row.q_l1);
    }
}

#[test]
fn check_values_of_three_contacts_on_the_unit_circle() {
    let contacts: Vec<Contact> = (0..3)
        .map(|i| {
            let a = std::f64::consts::TAU * f64::from(i) / 3.0;
            let p = Vector3::new(a.cos(), a.sin(), 0.0);
            Contact {
                position: p.into(),
                inward_normal: Unit::new_unchecked(-p),
            }
        })
        .collect();
    let expected = [
        (0.5, 8, EdgeNorm::UnitNormalComponent, 0.275925),
        (0.5, 8, EdgeNorm::UnitLength, 0.246795),
        (1.0, 8, EdgeNorm::UnitNormalComponent, 0.554694),
        (1.0, 8, EdgeNorm::UnitLength, 0.392228),
        (1.0, 10, EdgeNorm::UnitNormalComponent, 0.558403),
        (0.7, 4, EdgeNorm::UnitNormalComponent, 0.356831),
    ];
    for (friction, edges, edge_norm, quality) in expected {
        let convention = Convention {
            friction,
            edges: Edges::Polygon(edges),
            edge_norm,
            ..Convention::unit()
        };
        let tangents = [Vector3::z_axis(); 3];
        let centre = Point3::origin();
        let model = GraspModel::new(&contacts, &centre, &convention);
        let list = wrenches_with_tangents(&model, &tangents).unwrap();
        let found = epsilon_of_wrenches(&list, &mut Workspace::new())
            .unwrap()
            .quality;
        assert!((found - quality).abs() <= 5e-7, "{found} {quality}");
    }
}
