//! Certificates as JSON.

use grasp::{Certificate, Epsilon, Wrench};
use serde::Serialize;

/// The proof of one interval; `grasp::Certificate` says what to check.
#[derive(Serialize)]
pub(super) struct CertificateLine {
    lower: f64,
    upper: f64,
    converged: bool,
    rounding: f64,
    direction: [f64; 6],
    vertices: Vec<[f64; 6]>,
    facets: Vec<FacetLine>,
    caps: Vec<CapLine>,
    domain: Vec<[f64; 6]>,
}

#[derive(Serialize)]
struct FacetLine {
    vertices: [usize; 6],
    normal: [f64; 6],
}

#[derive(Serialize)]
struct CapLine {
    direction: [f64; 6],
    angle: f64,
    points: Vec<PointLine>,
}

#[derive(Serialize)]
struct PointLine {
    contact: usize,
    weight: f64,
    place: [f64; 3],
}

impl CertificateLine {
    pub(super) fn new(found: &Epsilon, proof: &Certificate) -> Self {
        let plain = |w: &Wrench| <[f64; 6]>::from(*w);
        CertificateLine {
            lower: proof.lower,
            upper: proof.upper,
            converged: found.converged,
            rounding: proof.rounding,
            direction: plain(&proof.direction),
            vertices: proof.vertices.iter().map(plain).collect(),
            facets: proof
                .facets
                .iter()
                .map(|f| FacetLine {
                    vertices: f.vertices,
                    normal: plain(&f.normal),
                })
                .collect(),
            caps: proof
                .caps
                .iter()
                .map(|cap| CapLine {
                    direction: plain(&cap.direction),
                    angle: cap.angle,
                    points: cap
                        .points
                        .iter()
                        .map(|&(contact, weight, place)| PointLine {
                            contact,
                            weight,
                            place,
                        })
                        .collect(),
                })
                .collect(),
            domain: proof.domain.iter().map(plain).collect(),
        }
    }
}
