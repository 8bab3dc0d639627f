//! The normal f_u × f_v of a map S² → R³ as a function on the sphere, and a proof that it never
//! vanishes.

use nalgebra::Vector3;
use sph::bounds::certified_range;
use sph::grid::{GridValues, RingGrid};
use sph::{Coefficients, Direction, SphericalCoords};

use crate::rotation_field::rotational_gradient;

/// Points per half wave of the certificate; the first that decides is used.
const OVERSAMPLING: [usize; 2] = [3, 6];
/// A normal shorter than this part of the longest one is taken for zero.
const VANISHING: f64 = 1e-6;

/// Bounds of |f_u × f_v|, the area of the surface per area of the sphere, m².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Immersion {
    /// Proved: nowhere below this.
    pub lower: f64,
    /// Least value seen on a grid.
    pub seen_lower: f64,
    /// Largest value seen on a grid.
    pub seen_upper: f64,
}

/// Why three functions are no surface in M^sph.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SphericalError {
    /// The normal vanishes, or nearly: the map is no immersion.
    #[error(
        "not an immersion: the area element falls to {seen:.3e} m² along ({x:.3}, {y:.3}, {z:.3}), where the largest is {largest:.3e} m²"
    )]
    NotImmersed {
        /// |f_u × f_v| there.
        seen: f64,
        /// Direction, x.
        x: f64,
        /// Direction, y.
        y: f64,
        /// Direction, z.
        z: f64,
        /// Largest |f_u × f_v|.
        largest: f64,
    },
    /// The normal was nowhere zero on the grid, but that is no proof.
    #[error(
        "cannot prove the map an immersion: area element at least {seen:.3e} m² on a grid, but the certificate ends at {certificate:.3} (needs > 0); a lower degree or more penalty may help"
    )]
    Undecided {
        /// Least value seen.
        seen: f64,
        /// Certified lower bound of the product that should be positive.
        certificate: f64,
    },
    /// f_u × f_v points inward.
    #[error("the surface is inside out (volume {volume:.3e} m³); mirror the sphere coordinates")]
    InsideOut {
        /// Signed volume, m³.
        volume: f64,
    },
}

/// Directions of a grid's points, ring after ring.
pub(crate) fn grid_directions(grid: &RingGrid) -> Vec<Vector3<f64>> {
    let step = std::f64::consts::TAU / grid.longitudes() as f64;
    let turns: Vec<(f64, f64)> = (0..grid.longitudes())
        .map(|k| (step * k as f64).sin_cos())
        .collect();
    let ring = |&(s, z): &(f64, f64)| turns.iter().map(move |(sin, cos)| [s * cos, s * sin, z]);
    grid.rings()
        .iter()
        .flat_map(ring)
        .map(Vector3::from)
        .collect()
}

/// f_u × f_v on a grid: N_x = p·(∇y × ∇z) = p·((p×∇y) × (p×∇z)), and so on round.
///
/// Nine syntheses; exact, poles included.
pub(crate) fn normals(coordinates: &[Coefficients; 3], grid: &RingGrid) -> Vec<Vector3<f64>> {
    let fields = coordinates.each_ref().map(|c| {
        let parts = rotational_gradient(c);
        parts.map(|part| grid.synthesis(&part).values)
    });
    let at = |axis: usize, i: usize| {
        let [x, y, z] = &fields[axis];
        Vector3::new(x[i], y[i], z[i])
    };
    grid_directions(grid)
        .iter()
        .enumerate()
        .map(|(i, p)| {
            let [a, b, c] = [at(0, i), at(1, i), at(2, i)];
            Vector3::new(
                p.dot(&b.cross(&c)),
                p.dot(&c.cross(&a)),
                p.dot(&a.cross(&b)),
            )
        })
        .collect()
}

/// Proves that N = f_u × f_v vanishes nowhere.
///
/// N is a spherical polynomial of degree at most 2L+1. W, of degree K, is chosen such that g = N·W is
/// positive and even ([`Samples::multiplier`]); g has degree at most 2L+1+K, and a certified g > 0
/// leaves no zero to N: |N| ≥ min g / max |W|.
pub(crate) fn certify(coordinates: &[Coefficients; 3]) -> Result<Immersion, SphericalError> {
    let degree = coordinates[0].degree();
    let samples = Samples::new(coordinates)?;
    let multiplier = samples.multiplier(degree);
    let longest = multiplier
        .iter()
        .map(|w| certified_range(w, 8))
        .map(|range| range.lower.abs().max(range.upper).powi(2))
        .sum::<f64>()
        .sqrt();
    let mut certificate = f64::NAN;
    for oversampling in OVERSAMPLING {
        let rings = oversampling * (2 * degree + 1 + multiplier[0].degree()) + 1;
        let grid = RingGrid::equiangular(rings, 2 * (rings - 1));
        let products = products(&normals(coordinates, &grid), &multiplier, &grid);
        let (low, high) = extremes(&products);
        // The bound of sph::bounds for a polynomial known by its values.
        let widening = (0.5 * std::f64::consts::PI / oversampling as f64)
            .cos()
            .powi(-2);
        let rounding = 1e-12 * (longest * samples.longest + 1.0);
        certificate = 0.5 * (low + high) - 0.5 * (high - low) * widening - rounding;
        if certificate > 0.0 {
            return Ok(Immersion {
                lower: certificate / longest,
                seen_lower: samples.shortest,
                seen_upper: samples.longest,
            });
        }
    }
    Err(SphericalError::Undecided {
        seen: samples.shortest,
        certificate,
    })
}

/// N on a Gauss–Legendre grid.
struct Samples {
    grid: RingGrid,
    normals: Vec<Vector3<f64>>,
    shortest: f64,
    longest: f64,
}

impl Samples {
    /// Refuses normals that vanish, or nearly, on the grid.
    fn new(coordinates: &[Coefficients; 3]) -> Result<Self, SphericalError> {
        let rings = 3 * coordinates[0].degree() + 4;
        let grid = RingGrid::gauss_legendre(rings, 2 * rings);
        let normals = normals(coordinates, &grid);
        let lengths: Vec<f64> = normals.iter().map(|n| n.norm()).collect();
        let (shortest, longest) = extremes(&lengths);
        if shortest > VANISHING * longest {
            return Ok(Self {
                grid,
                normals,
                shortest,
                longest,
            });
        }
        let at = lengths.iter().position(|l| *l == shortest).unwrap_or(0);
        let p = direction(&grid, at);
        Err(SphericalError::NotImmersed {
            seen: shortest,
            x: p.x,
            y: p.y,
            z: p.z,
            largest: longest,
        })
    }

    /// The W whose product with N is most even on the grid.
    ///
    /// Each candidate approximates D/(N·D), for a field D that looks the same way as N: p, as on
    /// every member of M^rad, or N/|N| itself, smoothed. Low degrees make the certificate cheap,
    /// high ones follow N more closely.
    fn multiplier(&self, degree: usize) -> [Coefficients; 3] {
        let unit: Vec<Vector3<f64>> = self.normals.iter().map(|n| n.normalize()).collect();
        let smooth = |degree: usize| self.values(&self.analysed(&unit, degree));
        let fields = [
            grid_directions(&self.grid),
            smooth(8),
            smooth(24),
            unit.clone(),
        ];
        let mut best = (
            f64::NEG_INFINITY,
            std::array::from_fn(|_| Coefficients::zeros(0)),
        );
        for field in fields {
            let along: Vec<f64> = field
                .iter()
                .zip(&self.normals)
                .map(|(d, n)| d.dot(n))
                .collect();
            // Where D leaves N's side its quotient is of no use.
            if along
                .iter()
                .zip(&self.normals)
                .any(|(a, n)| *a <= 0.02 * n.norm())
            {
                continue;
            }
            let quotient: Vec<Vector3<f64>> =
                field.iter().zip(&along).map(|(d, a)| d / *a).collect();
            for order in [4, 16, degree.max(16)] {
                let candidate = self.analysed(&quotient, order);
                let (low, high) = extremes(&products(&self.normals, &candidate, &self.grid));
                if low / high > best.0 {
                    best = (low / high, candidate);
                }
            }
        }
        best.1
    }

    fn analysed(&self, field: &[Vector3<f64>], degree: usize) -> [Coefficients; 3] {
        std::array::from_fn(|axis| {
            let values = GridValues {
                longitudes: self.grid.longitudes(),
                values: field.iter().map(|v| v[axis]).collect(),
            };
            self.grid.analysis(&values, degree)
        })
    }

    fn values(&self, field: &[Coefficients; 3]) -> Vec<Vector3<f64>> {
        let [x, y, z] = field.each_ref().map(|c| self.grid.synthesis(c).values);
        (0..x.len())
            .map(|i| Vector3::new(x[i], y[i], z[i]))
            .collect()
    }
}

/// N·W on a grid.
fn products(normals: &[Vector3<f64>], multiplier: &[Coefficients; 3], grid: &RingGrid) -> Vec<f64> {
    let [x, y, z] = multiplier.each_ref().map(|w| grid.synthesis(w).values);
    let product = |(i, n): (usize, &Vector3<f64>)| n.x * x[i] + n.y * y[i] + n.z * z[i];
    normals.iter().enumerate().map(product).collect()
}

fn extremes(values: &[f64]) -> (f64, f64) {
    let start = (f64::INFINITY, f64::NEG_INFINITY);
    values
        .iter()
        .fold(start, |(low, high), v| (low.min(*v), high.max(*v)))
}

fn direction(grid: &RingGrid, index: usize) -> Direction {
    let (sin, cos) = grid.rings()[index / grid.longitudes()];
    let turn = (index % grid.longitudes()) as f64 / grid.longitudes() as f64;
    SphericalCoords {
        theta: sin.atan2(cos),
        phi: std::f64::consts::TAU * turn,
    }
    .direction()
}
