//! A small piece of the sphere and certified bounds of a map on it.

use nalgebra::{Matrix3, Vector3};
use sph::direction::{angle, tangent_frame};
use sph::{Direction, Jet, SphericalCoords};

use crate::third_derivatives::ThirdDerivatives;

/// Largest radius of injectivity of one expansion, radians.
const FARTHEST: f64 = 0.06;
/// Margin of the contraction for rounding.
const ROUNDING: f64 = 1e-6;
/// Rounding of places, as a share of the size of the map.
const PLACE_ROUNDING: f64 = 1e-11;

/// Ranges of θ and φ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub(crate) theta: [f64; 2],
    pub(crate) phi: [f64; 2],
}

impl Piece {
    pub(crate) fn centre(&self) -> Direction {
        SphericalCoords {
            theta: 0.5 * (self.theta[0] + self.theta[1]),
            phi: 0.5 * (self.phi[0] + self.phi[1]),
        }
        .direction()
    }

    /// Largest angle between the centre and a point of the piece: that of a corner, since along a meridian
    /// the cosine of the angle is a sine curve above its axis, and along a parallel it falls on both sides.
    fn radius(&self) -> f64 {
        let centre = self.centre();
        let corners = self.theta.iter().flat_map(|theta| {
            self.phi.iter().map(|phi| SphericalCoords {
                theta: *theta,
                phi: *phi,
            })
        });
        let angles = corners.map(|c| angle(&centre, &c.direction()));
        angles.fold(0.0, f64::max) + 1e-12
    }

    pub(crate) fn quarters(&self) -> [Self; 4] {
        let middle = |[a, b]: [f64; 2]| 0.5 * (a + b);
        let (t, p) = (middle(self.theta), middle(self.phi));
        let halves = |[a, b]: [f64; 2], m: f64| [[a, m], [m, b]];
        let ([north, south], [west, east]) = (halves(self.theta, t), halves(self.phi, p));
        [(north, west), (north, east), (south, west), (south, east)]
            .map(|(theta, phi)| Self { theta, phi })
    }
}

/// The expansion of the map f about the centre of a piece.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    pub(crate) piece: Piece,
    pub(crate) depth: u32,
    pub(crate) centre: Direction,
    /// All of the piece is within this angle.
    pub(crate) radius: f64,
    /// f is injective on all points within this angle of the centre; 0 if nothing is proved.
    pub(crate) reach: f64,
    /// f(centre).
    pub(crate) place: Vector3<f64>,
    pub(crate) normal: Vector3<f64>,
    /// K_i f as columns.
    turning: Matrix3<f64>,
    /// Hessians of the coordinates in the tangent frame: (uu, uv, vv).
    bending: [Vector3<f64>; 3],
    /// Bound of the third derivatives on the piece.
    third: f64,
    slack: f64,
}

impl Cell {
    pub(crate) fn new(
        piece: Piece,
        depth: u32,
        jets: [Jet; 3],
        thirds: &ThirdDerivatives,
        size: f64,
    ) -> Self {
        let (centre, radius) = (piece.centre(), piece.radius());
        let p = centre.into_inner();
        let (u, v) = tangent_frame(&centre);
        let rows = jets.each_ref().map(|j| p.cross(&j.gradient).transpose());
        let turning = Matrix3::from_rows(&rows);
        let bend = |a: &Vector3<f64>, b: &Vector3<f64>| {
            Vector3::from(jets.each_ref().map(|j| a.dot(&(j.hessian * b))))
        };
        let along = |w: &Vector3<f64>| Vector3::from(jets.each_ref().map(|j| j.gradient.dot(w)));
        let (fu, fv) = (along(&u), along(&v));
        let mut cell = Self {
            piece,
            depth,
            centre,
            radius,
            reach: 0.0,
            place: Vector3::from(jets.each_ref().map(|j| j.value)),
            normal: fu
                .cross(&fv)
                .try_normalize(0.0)
                .unwrap_or_else(Vector3::zeros),
            turning,
            bending: [bend(&u, &u), bend(&u, &v), bend(&v, &v)],
            third: thirds.within(&centre, radius),
            slack: PLACE_ROUNDING * size,
        };
        // (ω·K) K_i f for ω = u, v: rows by coordinate.
        let turned = |w: &Vector3<f64>| {
            Matrix3::from_rows(&jets.each_ref().map(|j| {
                let row = p.cross(&(j.hessian * w.cross(&p))) + p * w.dot(&j.gradient);
                row.transpose()
            }))
        };
        cell.reach = reach(&turning, &[turned(&u), turned(&v)], |angle| {
            thirds.within(&centre, angle)
        });
        cell
    }

    /// Half the extent of f of the piece along a unit vector, about the value at the centre.
    pub(crate) fn extent(&self, along: &Vector3<f64>) -> f64 {
        let r = self.radius;
        let slope = (self.turning.transpose() * along).norm();
        let [uu, uv, vv] = self.bending.map(|b| b.dot(along));
        // The larger size of an eigenvalue.
        let mean = 0.5 * (uu + vv);
        let bend = mean.abs() + (0.25 * (uu - vv) * (uu - vv) + uv * uv).sqrt();
        r * slope + 0.5 * r * r * bend + r * r * r / 6.0 * self.third + self.slack
    }

    /// Whether f of two pieces is proved disjoint by a plane across one of three directions.
    pub(crate) fn apart(&self, other: &Self) -> bool {
        let gap = other.place - self.place;
        let separates =
            |along: &Vector3<f64>| gap.dot(along).abs() > self.extent(along) + other.extent(along);
        separates(&self.normal)
            || separates(&other.normal)
            || gap.try_normalize(0.0).is_some_and(|d| separates(&d))
            || (self.normal + other.normal)
                .try_normalize(1e-6)
                .is_some_and(|d| separates(&d))
            || (self.normal - other.normal)
                .try_normalize(1e-6)
                .is_some_and(|d| separates(&d))
    }

    /// The corners of a box that contains f of the piece.
    pub(crate) fn bounds(&self) -> (Vector3<f64>, Vector3<f64>) {
        let half = Vector3::new(
            self.extent(&Vector3::x()),
            self.extent(&Vector3::y()),
            self.extent(&Vector3::z()),
        );
        (self.place - half, self.place + half)
    }

    /// Whether the other piece is so near that f is proved injective on the union of the two
    /// pieces.
    pub(crate) fn reaches(&self, other: &Self) -> bool {
        angle(&self.centre, &other.centre) + other.radius <= self.reach && self.radius <= self.reach
    }
}

/// The largest angle r within which f is proved injective about a point.
///
/// Let M = (K_1 f, K_2 f, K_3 f), c the point, and A the pseudo-inverse of M(c), so that A M(c) = 1 − ccᵀ.
/// On the great circle from p to q, which the rotation about ω ⟂ p, q follows, f(q) − f(p) = ∫ M ω. So
/// |A (f(q) − f(p)) − ω| ≤ (sin r + sup |A (M − M(c))|) |ω|, and f(p) ≠ f(q) if the bracket is below 1.
/// With D_u and D_v the derivatives of M and τ the bound of its second ones, the supremum is at most
/// r (|A D_u|² + |A D_v|²)^{1/2} + ½ r² |A| τ.
fn reach(turning: &Matrix3<f64>, turned: &[Matrix3<f64>; 2], third: impl Fn(f64) -> f64) -> f64 {
    let svd = turning.svd(true, true);
    let (Some(u), Some(vt)) = (svd.u, svd.v_t) else {
        return 0.0;
    };
    // The singular values come in decreasing order; the third is zero, along the centre.
    let [first, second] = [svd.singular_values[0], svd.singular_values[1]];
    if !(second > 1e-9 * first && first > 0.0) {
        return 0.0;
    }
    let part = |k: usize| vt.row(k).transpose() * u.column(k).transpose();
    let inverse: Matrix3<f64> = part(0) / first + part(1) / second;
    let d = (inverse * turned[0])
        .norm()
        .hypot((inverse * turned[1]).norm());
    let mut best = 0.0_f64;
    for farthest in [FARTHEST, 0.5 * FARTHEST, 0.2 * FARTHEST, 0.05 * FARTHEST] {
        if best >= farthest {
            break;
        }
        let b = third(farthest) / second;
        // (1 + d) r + ½ b r² = 1 − rounding.
        let most = 1.0 - ROUNDING;
        let root = 2.0 * most / ((1.0 + d) + ((1.0 + d).powi(2) + 2.0 * b * most).sqrt());
        best = best.max(root.min(farthest));
    }
    best
}
