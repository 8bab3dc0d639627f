//! The point of the smooth surface that is closest to a finger tip.

use nalgebra::{Isometry3, Matrix2, Matrix3x2, Point3, Vector2, Vector3};
use shape::{Surface, SurfaceRef};
use sph::Direction;
use sph::direction::tangent_frame;

use crate::collision::{CollisionObject, LinkShape, Precision};
use crate::hand::{Finger, Hand};

const MAX_STEPS: usize = 40;
/// The descent ends when the sine of the angle between normal and connecting line is below this.
const ANGLE_TOLERANCE: f64 = 1e-6;

/// The contact of a tip and the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipContact {
    /// The place of the closest point on the sphere; for a radial surface its direction from the
    /// object's origin.
    pub direction: Direction,
    /// The closest point of the surface, centred frame, metres.
    pub position: Point3<f64>,
    /// Inward unit normal of the surface there.
    pub inward_normal: nalgebra::UnitVector3<f64>,
    /// The closest point of the tip, centred frame, metres.
    pub on_tip: Point3<f64>,
    /// Distance between the two, metres.
    pub gap: f64,
}

/// The point of the surface closest to a finger's tip, and its normal; see [`link_contact`].
pub fn tip_contact(
    object: &CollisionObject<'_>,
    hand: &Hand,
    finger: &Finger,
    object_from_links: &[Isometry3<f64>],
) -> Option<TipContact> {
    closest(object, hand, &finger.tip_links, object_from_links)
}

/// The point of the surface closest to a link, and its normal.
///
/// Starts at the closest point of the mesh and descends on the smooth surface (BFGS in a
/// chart about the start; the distance to a convex body is smooth outside it). `None` if
/// the link touches or enters the surface, or has no geometry.
pub fn link_contact(
    object: &CollisionObject<'_>,
    hand: &Hand,
    link: usize,
    object_from_links: &[Isometry3<f64>],
) -> Option<TipContact> {
    closest(object, hand, &[link], object_from_links)
}

fn closest(
    object: &CollisionObject<'_>,
    hand: &Hand,
    links: &[usize],
    object_from_links: &[Isometry3<f64>],
) -> Option<TipContact> {
    let precision = Precision {
        cutoff: f64::INFINITY,
        absolute: 1e-6,
        relative: 0.0,
    };
    let start = links
        .iter()
        .map(|&link| object.link_gap(&hand.shapes[link], &object_from_links[link], precision))
        .min_by(|a, b| a.upper.total_cmp(&b.upper))?;
    let start = object.direction_at(&start)?;
    let tip = Tip {
        links: links
            .iter()
            .map(|&link| (&hand.shapes[link], object_from_links[link]))
            .collect(),
    };
    let chart = Chart::new(object, start);
    let at = descend(&chart, &tip)?;
    let direction = chart.direction(&at);
    let (position, inward_normal) = object.surface().contact(&direction);
    let (on_tip, gap) = tip.closest(&position)?;
    Some(TipContact {
        direction,
        position,
        inward_normal,
        on_tip,
        gap,
    })
}

/// The pieces of a tip in the centred frame.
struct Tip<'a> {
    links: Vec<(&'a LinkShape, Isometry3<f64>)>,
}

impl Tip<'_> {
    /// The point of the tip closest to p and its distance; `None` if p is in the tip.
    fn closest(&self, p: &Point3<f64>) -> Option<(Point3<f64>, f64)> {
        let mut best: Option<(Point3<f64>, f64)> = None;
        for (link, pose) in &self.links {
            for piece in &link.pieces {
                let object_from_piece = pose * piece.link_from_piece;
                let local = object_from_piece.inverse_transform_point(p);
                let on_piece = piece.closest_point(&local.coords);
                let distance = (on_piece - local.coords).norm();
                if distance.is_nan() || distance <= 0.0 {
                    return None;
                }
                if best.is_none_or(|(_, least)| distance < least) {
                    best = Some((object_from_piece * Point3::from(on_piece), distance));
                }
            }
        }
        best
    }
}

/// A chart of the directions near a start: two coordinates of the tangent plane there.
struct Chart<'a> {
    surface: SurfaceRef<'a>,
    start: Direction,
    axes: (Vector3<f64>, Vector3<f64>),
    /// How far the surface reaches, metres; near the start it moves about so far per coordinate.
    radius: f64,
}

impl<'a> Chart<'a> {
    fn new(object: &CollisionObject<'a>, start: Direction) -> Self {
        let radius = object.outer_radius();
        let surface = object.surface();
        let plain = tangent_frame(&start);
        let axes = match surface {
            SurfaceRef::Radial(_) => plain,
            SurfaceRef::Spherical(field) => {
                let slope = field.differential(&start).position_slope;
                even_axes(&(slope * plain.0), &(slope * plain.1), plain, radius)
            }
        };
        Chart {
            surface,
            start,
            axes,
            radius,
        }
    }

    fn raw(&self, u: &Vector2<f64>) -> Vector3<f64> {
        self.start.into_inner() + self.axes.0 * u.x + self.axes.1 * u.y
    }

    fn direction(&self, u: &Vector2<f64>) -> Direction {
        Direction::new_normalize(self.raw(u))
    }

    /// Distance to the tip at chart coordinates, its gradient, and the sine of the angle
    /// between the connecting line and the normal.
    fn distance(&self, tip: &Tip<'_>, u: &Vector2<f64>) -> Option<(f64, Vector2<f64>, f64)> {
        let (p, length) = Direction::new_and_get(self.raw(u));
        let turned = |axis: &Vector3<f64>| (axis - p.into_inner() * p.dot(axis)) / length;
        let turns = (turned(&self.axes.0), turned(&self.axes.1));
        let (point, (a, b)) = match self.surface {
            SurfaceRef::Radial(shape) => {
                let (radius, slope) = shape.radius_and_gradient(&p);
                let moved = |turn: &Vector3<f64>| turn * radius + p.into_inner() * slope.dot(turn);
                let point = Point3::from(p.into_inner() * radius);
                (point, (moved(&turns.0), moved(&turns.1)))
            }
            SurfaceRef::Spherical(field) => {
                let at = field.differential(&p);
                let slope = at.position_slope;
                (at.position, (slope * turns.0, slope * turns.1))
            }
        };
        let (on_tip, distance) = tip.closest(&point)?;
        let line = (point - on_tip) / distance;
        let normal = a.cross(&b).normalize();
        let sine = line.cross(&normal).norm();
        Some((distance, Vector2::new(line.dot(&a), line.dot(&b)), sine))
    }
}

/// Combinations of the axes along which a surface moves at right angles, by `length` per unit; `a` and
/// `b` are its moves along the axes. The axes themselves where it hardly moves along one.
pub(crate) fn even_axes(
    a: &Vector3<f64>,
    b: &Vector3<f64>,
    axes: (Vector3<f64>, Vector3<f64>),
    length: f64,
) -> (Vector3<f64>, Vector3<f64>) {
    let (_, r) = Matrix3x2::from_columns(&[*a, *b]).qr().unpack();
    match r.try_inverse() {
        Some(inverse) if inverse.iter().all(|x| x.is_finite()) => {
            let mix = |k: usize| (axes.0 * inverse[(0, k)] + axes.1 * inverse[(1, k)]) * length;
            (mix(0), mix(1))
        }
        _ => axes,
    }
}

/// Chart coordinates of a local minimum of the distance, from the chart's origin.
fn descend(chart: &Chart<'_>, tip: &Tip<'_>) -> Option<Vector2<f64>> {
    let mut at = Vector2::zeros();
    let (mut value, mut gradient, mut sine) = chart.distance(tip, &at)?;
    let radius = chart.radius;
    let mut inverse_hessian = Matrix2::identity() * (1.0 / radius);
    for _ in 0..MAX_STEPS {
        if sine <= ANGLE_TOLERANCE {
            break;
        }
        let mut step = -(inverse_hessian * gradient);
        let slope = step.dot(&gradient);
        if slope.is_nan() || slope >= 0.0 {
            inverse_hessian = Matrix2::identity() * (1.0 / radius);
            step = -gradient / radius;
        }
        let Some((next, found)) = line_search(chart, tip, &at, &step, value, &gradient) else {
            break;
        };
        let (moved, turned) = (next - at, found.1 - gradient);
        update_inverse(&mut inverse_hessian, &moved, &turned);
        at = next;
        (value, gradient, sine) = found;
    }
    Some(at)
}

type Found = (f64, Vector2<f64>, f64);

/// Halves the step until the distance falls (Armijo).
fn line_search(
    chart: &Chart<'_>,
    tip: &Tip<'_>,
    at: &Vector2<f64>,
    step: &Vector2<f64>,
    value: f64,
    gradient: &Vector2<f64>,
) -> Option<(Vector2<f64>, Found)> {
    let mut scale = (0.2 / step.norm()).min(1.0);
    for _ in 0..30 {
        let next = at + step * scale;
        if let Some(found) = chart.distance(tip, &next)
            && found.0 <= value + 1e-4 * scale * step.dot(gradient)
        {
            return Some((next, found));
        }
        scale *= 0.5;
    }
    None
}

/// The BFGS update of an inverse Hessian.
fn update_inverse(h: &mut Matrix2<f64>, s: &Vector2<f64>, y: &Vector2<f64>) {
    let sy = s.dot(y);
    if sy.is_nan() || sy <= 1e-300 {
        return;
    }
    let left = Matrix2::identity() - s * y.transpose() / sy;
    *h = left * *h * left.transpose() + s * s.transpose() / sy;
}
