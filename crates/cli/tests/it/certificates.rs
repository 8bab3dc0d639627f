//! `moduli quality --certificate` checked by lines that know contacts, `unit` and nothing of the search.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::{Matrix6, Vector3, Vector6};
use serde_json::Value;
use tempfile::TempDir;

use crate::common::{moduli, stdout};

type V = Vector6<f64>;

/// Rounding of a height.
const ROUNDING: f64 = 1e-12;

/// The wrenches base + x·axes, |x| ≤ 1, of one contact.
struct Cone {
    base: V,
    axes: [V; 2],
}

/// The cones of a row of `unit` with this friction and torque length.
fn cones(row: &[f64], friction: f64, length: f64) -> Vec<Cone> {
    let count = (row.len() - 3) / 6;
    let triple = |k: usize| Vector3::new(row[3 * k], row[3 * k + 1], row[3 * k + 2]);
    let cone = |k: usize| {
        let (arm, n) = (triple(k) - triple(2 * count), triple(k + count));
        let axis = (0..3).fold(
            0,
            |best, k| if n[k].abs() < n[best].abs() { k } else { best },
        );
        let axis = Vector3::ith(axis, 1.0);
        let t = (axis - n * n.dot(&axis)).normalize();
        let wrench = |f: Vector3<f64>| {
            let torque = arm.cross(&f) / length;
            V::new(f.x, f.y, f.z, torque.x, torque.y, torque.z)
        };
        Cone {
            base: wrench(n),
            axes: [wrench(t * friction), wrench(n.cross(&t) * friction)],
        }
    };
    (0..count).map(cone).collect()
}

fn vector(value: &Value) -> V {
    V::from_fn(|k, _| value[k].as_f64().unwrap())
}

fn list<'a>(proof: &'a Value, key: &str) -> impl Iterator<Item = &'a Value> {
    proof[key].as_array().unwrap().iter()
}

/// Checks a certificate; `edges` is the number of edges of a pyramid, or none.
fn check(proof: &Value, cones: &[Cone], edges: Option<usize>) {
    let upper = proof["upper"].as_f64().unwrap();
    let points: Vec<V> = match edges {
        Some(count) => (0..count)
            .map(|j| (TAU * j as f64 / count as f64).sin_cos())
            .flat_map(|(s, c)| {
                cones
                    .iter()
                    .map(move |k| k.base + k.axes[0] * c + k.axes[1] * s)
            })
            .collect(),
        None => Vec::new(),
    };
    // The upper end: no wrench reaches farther along the direction.
    let u = vector(&proof["direction"]);
    let round = |k: &Cone| k.base.dot(&u) + k.axes[0].dot(&u).hypot(k.axes[1].dot(&u));
    let heights: Vec<f64> = match edges {
        Some(_) => points.iter().map(|p| p.dot(&u)).collect(),
        None => cones.iter().map(round).collect(),
    };
    let height = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
    assert!(
        (u.norm() - 1.0).abs() <= ROUNDING && height <= upper + ROUNDING,
        "{height} {upper}"
    );
    // Vertices are wrenches of the grasp, or far beyond one of the half-spaces of the domain.
    let domain: Vec<V> = list(proof, "domain").map(vector).collect();
    let vertices: Vec<V> = list(proof, "vertices").map(vector).collect();
    let of_contact = |w: &V, k: &Cone| {
        let a = nalgebra::Matrix6x2::from_columns(&k.axes);
        let x = (a.transpose() * a).try_inverse().unwrap() * a.transpose() * (w - k.base);
        (a * x + k.base - w).norm() <= ROUNDING && x.norm() <= 1.0 + ROUNDING
    };
    for w in &vertices {
        let wrench = match edges {
            Some(_) => points.iter().any(|p| (p - w).norm() <= ROUNDING),
            None => cones.iter().any(|k| of_contact(w, k)),
        };
        let beyond = |c: &V| (w / w.norm() + c).norm() <= 1e-9 && w.norm() > 1.0;
        assert!(wrench || domain.iter().any(beyond), "{w}");
    }
    check_surface(proof, cones, &vertices, &domain);
}

/// The lower end: a closed surface around 0 whose facets are far enough, in a cap, or not in the domain.
fn check_surface(proof: &Value, cones: &[Cone], vertices: &[V], domain: &[V]) {
    let [lower, rounding] = ["lower", "rounding"].map(|k| proof[k].as_f64().unwrap());
    let caps: Vec<(V, f64)> = list(proof, "caps")
        .map(|cap| (vector(&cap["direction"]), proved_angle(cap, cones, lower)))
        .collect();
    let (mut ridges, mut crossings) = (BTreeMap::new(), 0);
    let mut ray = None;
    for facet in list(proof, "facets") {
        let at: Vec<usize> = list(facet, "vertices")
            .map(|v| v.as_u64().unwrap() as usize)
            .collect();
        let n = vector(&facet["normal"]).normalize();
        let floor = at
            .iter()
            .map(|&v| vertices[v].dot(&n))
            .fold(f64::INFINITY, f64::min)
            + rounding;
        assert!(floor > 0.0);
        let spread = (floor / lower).min(1.0).acos();
        let capped = |(c, angle): &(V, f64)| c.dot(&n).min(1.0).acos() + spread <= *angle;
        let elsewhere = |c: &V| c.dot(&n) < -spread.sin();
        assert!(
            floor >= lower || caps.iter().any(capped) || domain.iter().any(elsewhere),
            "{floor} below {lower}, {spread} about {n}"
        );
        for omitted in 0..6 {
            let mut five = at.clone();
            five.remove(omitted);
            five.sort_unstable();
            *ridges.entry(five).or_insert(0) += 1;
        }
        let corners = Matrix6::from_fn(|i, j| vertices[at[j]][i]);
        let ray = *ray.get_or_insert_with(|| corners * V::new(0.21, 0.33, 0.11, 0.17, 0.07, 0.11));
        let shares = corners.lu().solve(&ray);
        crossings += usize::from(shares.is_some_and(|s| s.iter().all(|s| *s > 0.0)));
    }
    assert!(
        ridges.values().all(|count| count % 2 == 0) && crossings % 2 == 1,
        "{crossings}"
    );
}

/// A point that touches, with A N Aᵀ.
struct Part {
    weight: f64,
    p: V,
    bend: Matrix6<f64>,
    rim: bool,
}

fn parts(cap: &Value, cones: &[Cone], u: &V, sin: f64) -> Vec<Part> {
    list(cap, "points")
        .map(|point| {
            let cone = &cones[point["contact"].as_u64().unwrap() as usize];
            let m = [0, 1].map(|k| point["place"][k].as_f64().unwrap());
            let length = m[0].hypot(m[1]).min(1.0);
            let [a, b] = cone.axes;
            let inverse = if length > 0.0 { 1.0 / length } else { 0.0 };
            let along = (a * m[0] + b * m[1]) * inverse;
            let all = a * a.transpose() + b * b.transpose();
            let slope = a.dot(u).hypot(b.dot(u)) + sin * all.symmetric_eigenvalues().max().sqrt();
            let bend = all * 2.0 * (1.0 - length) + (all - along * along.transpose()) * length;
            Part {
                weight: point["weight"].as_f64().unwrap(),
                p: cone.base + a * m[0] + b * m[1],
                bend: bend / slope,
                rim: length >= 0.999,
            }
        })
        .collect()
}

/// The angle of a cap, if h ≥ `lower` in it follows from its points, as `cone::cap` says; otherwise 0.
///
/// With p = base + A m of weights λ, u₀ the direction, g = Σ λ p, d = p − g, N = 2(1 − |m|)/S +
/// |m|/S (1 − m̂ m̂ᵀ), S ≥ |Aᵀ u| in the cap and any c with c sin α |d| ≤ 1:
/// h ≥ ν cos β + ½ κ sin² β − ρ sin β, κ the least eigenvalue on the complement of u₀ of
/// Σ λ (A N Aᵀ + c d dᵀ) less what the shift of the weights costs.
fn proved_angle(cap: &Value, cones: &[Cone], lower: f64) -> f64 {
    let (u, angle) = (vector(&cap["direction"]), cap["angle"].as_f64().unwrap());
    let (sin, cos) = angle.sin_cos();
    let parts = parts(cap, cones, &u, sin);
    let g: V = parts.iter().map(|part| part.p * part.weight).sum();
    let nu = g.dot(&u);
    let rest: f64 = parts
        .iter()
        .map(|p| 2.0 * p.weight * (p.bend * u).norm())
        .sum();
    let along: f64 = parts
        .iter()
        .map(|p| p.weight * (p.p - g).dot(&u).abs())
        .sum();
    let loss = along + sin * ((g - u * nu).norm() + rest) + ROUNDING;
    let needed = 2.0 * (lower + loss - nu * cos) / (sin * sin);
    let arms: Vec<V> = parts
        .iter()
        .map(|p| p.p - g - u * (p.p - g).dot(&u))
        .collect();
    let gram: Matrix6<f64> = parts
        .iter()
        .zip(&arms)
        .map(|(p, d)| d * d.transpose() * p.weight)
        .sum();
    // Shifts along d, or along the inverse of Σ λ d dᵀ on it.
    let inverse = gram
        .pseudo_inverse(1e-4 * gram.symmetric_eigenvalues().max())
        .unwrap();
    let holds = |shifts: &[V], gain: &Matrix6<f64>, inverted: bool, share: f64| {
        let longest = shifts.iter().map(|e| e.norm()).fold(0.0, f64::max);
        let c = share / (sin * longest);
        let (mut total, mut first, mut second) = (gain * c, 0.0, 0.0);
        for (part, e) in parts.iter().zip(shifts) {
            let keep = if part.rim {
                1.0
            } else {
                1.0 - c * sin * e.norm()
            };
            total += part.bend * part.weight * keep;
            let size = if part.rim { part.bend.trace() } else { 0.0 };
            first += part.weight * size * e.norm();
            second += part.weight * size * size;
        }
        let cost = if inverted { first * first } else { second };
        let kappa = needed + c * sin * sin * cost / 4.0;
        let lift = u * u.transpose() * (total.trace() + 2.0 * kappa.abs());
        (total + lift).symmetric_eigenvalues().min() >= kappa
    };
    let scaled: Vec<V> = arms.iter().map(|d| inverse * d).collect();
    let span = inverse * gram;
    let shares = [1.0, 0.5, 0.2, 0.07, 0.02];
    let proved = shares
        .iter()
        .any(|s| holds(&arms, &gram, false, *s) || holds(&scaled, &span, true, *s));
    if nu - loss >= lower && proved {
        angle
    } else {
        0.0
    }
}

fn certificate(row: &[f64], friction: f64, length: f64, edges: &str) -> Value {
    let folder = TempDir::new().unwrap();
    let cells: Vec<String> = row.iter().map(f64::to_string).collect();
    std::fs::write(folder.path().join("g.csv"), cells.join(",")).unwrap();
    let (friction, length) = (friction.to_string(), length.to_string());
    let words = [
        "quality",
        "g.csv",
        "--convention",
        "unit",
        "--certificate",
        "proof.json",
        "--friction",
        &friction,
    ];
    let more = ["--torque-length", &length, "--edges", edges];
    stdout(&moduli(folder.path(), &[&words[..], &more].concat()));
    let text = std::fs::read_to_string(folder.path().join("proof.json")).unwrap();
    serde_json::from_str::<Value>(&text).unwrap()[0].take()
}

/// Contacts around a ring of 5 cm, moved by `off` along z in turn, that press towards the axis.
fn ring(count: usize, off: f64) -> Vec<f64> {
    let at = |k: usize| (TAU * k as f64 / count as f64).sin_cos();
    let positions = (0..count).flat_map(|k| {
        let (sin, cos) = at(k);
        [0.05 * cos, 0.05 * sin, off * (k * k % 3) as f64]
    });
    let normals = (0..count).flat_map(|k| {
        let (sin, cos) = at(k);
        [-cos, -sin, 0.0]
    });
    positions.chain(normals).chain([0.001, off, 0.0]).collect()
}

#[test]
fn certificates_are_proofs() {
    for (count, off) in [(3, 0.0), (3, 0.004), (4, 0.002), (5, 0.0)] {
        let row = ring(count, off);
        for (friction, length) in [(1.0, 0.05), (0.5, 0.01)] {
            let cones = cones(&row, friction, length);
            for (edges, number) in [("round", None), ("8", Some(8)), ("5", Some(5))] {
                let proof = certificate(&row, friction, length, edges);
                assert!(
                    proof["lower"].as_f64().unwrap() > 0.0,
                    "{count} {off} {edges}"
                );
                check(&proof, &cones, number);
            }
        }
    }
}

#[test]
#[should_panic(expected = "below")]
fn a_lower_end_that_is_too_high_is_noticed() {
    let row = ring(4, 0.002);
    let mut proof = certificate(&row, 1.0, 0.05, "8");
    let raised = 1.001 * proof["lower"].as_f64().unwrap();
    proof["lower"] = raised.into();
    check(&proof, &cones(&row, 1.0, 0.05), Some(8));
}
