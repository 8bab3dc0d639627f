//! Epsilon quality of grasps from standard input, timed on one thread.
//!
//! A line is a grasp: friction, edges (0 for the round cone), tolerance (of the round cone), number
//! of contacts m, then 3m position, 3m normal and 3 centre coordinates, separated by blanks. Prints
//! quality (what the convention prints), lower and upper, one grasp per line; then the median over five runs of the microseconds per grasp and
//! the facets made a grasp. With the name of a convention as argument, its own friction, edges and
//! torque length take the place of the line's (`frogger` then also has its own tangents).
#![allow(clippy::print_stdout, reason = "a program that prints its result")]

use grasp::{Contact, Convention, Edges, Epsilon, GraspModel, TangentRule, Workspace, epsilon};
use nalgebra::{Point3, Unit, Vector3};
use std::error::Error;
use std::time::Instant;

struct Case {
    contacts: Vec<Contact>,
    centre: Point3<f64>,
    convention: Convention,
}

fn parse(line: &str, name: Option<&str>) -> Result<Case, Box<dyn Error>> {
    let numbers: Vec<f64> = line
        .split_whitespace()
        .map(str::parse)
        .collect::<Result<_, _>>()?;
    let [friction, edges, tolerance, count, coordinates @ ..] = numbers.as_slice() else {
        return Err("a line holds four numbers and the coordinates".into());
    };
    let count = *count as usize;
    if coordinates.len() != 6 * count + 3 {
        return Err(format!("{} coordinates for {count} contacts", coordinates.len()).into());
    }
    let vectors: Vec<Vector3<f64>> = coordinates
        .chunks(3)
        .map(Vector3::from_column_slice)
        .collect();
    let contacts = (0..count)
        .map(|i| Contact {
            position: vectors[i].into(),
            inward_normal: Unit::new_normalize(vectors[count + i]),
        })
        .collect();
    let edges = if *edges == 0.0 {
        Edges::Round {
            tolerance: *tolerance,
        }
    } else {
        Edges::Polygon(*edges as usize)
    };
    let mut convention = Convention::named(name.unwrap_or("unit"))?;
    match name {
        None => (convention.friction, convention.edges) = (*friction, edges),
        Some("frogger") => {
            convention.tangent = TangentRule::Projected(Vector3::new(1.2, 2.3, 3.4));
        }
        Some(_) => {}
    }
    Ok(Case {
        contacts,
        centre: vectors[2 * count].into(),
        convention,
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let name = std::env::args().nth(1);
    let cases: Vec<Case> = std::io::stdin()
        .lines()
        .map(|line| parse(&line?, name.as_deref()))
        .collect::<Result<_, _>>()?;
    let mut workspace = Workspace::new();
    let mut results: Vec<Epsilon> = Vec::new();
    let mut times = Vec::new();
    let mut facets = 0;
    for _ in 0..5 {
        results.clear();
        facets = 0;
        let start = Instant::now();
        for case in &cases {
            let model = GraspModel::new(&case.contacts, &case.centre, &case.convention);
            results.push(epsilon(&model, &mut workspace)?);
            facets += workspace.facets_made();
        }
        times.push(start.elapsed().as_secs_f64() * 1e6 / cases.len().max(1) as f64);
    }
    for (e, case) in results.iter().zip(&cases) {
        let printed = e.value(&case.convention);
        println!("{printed:e} {:e} {:e}", e.lower, e.upper);
    }
    times.sort_by(f64::total_cmp);
    println!(
        "{:.4} {:.1}",
        times[2],
        facets as f64 / cases.len().max(1) as f64
    );
    Ok(())
}
