//! Separates the points near a plane into the object's foot and the support.
//!
//! The plane is cut into squares. Above a point of the foot of a solid, a vertical line leaves the solid
//! and so meets an odd number of layers of points; above a point of the support it meets an even number:
//! none beside the object, two below an overhang. In squares where a wall rises, points on the inner
//! side of the wall belong to the foot.

use std::collections::VecDeque;

use nalgebra::Point3;
use sph::direction::tangent_frame;

use super::Support;
use crate::voxel_grid::spacing;

/// Side of a square, in spacings.
const SQUARE: f64 = 2.0;
/// Gap between two layers, in spacings, at least.
const GAP: f64 = 3.0;
/// A layer that spans more, in spacings, is a wall.
const WALL: f64 = 6.0;
/// Points up to this many spacings above the tolerance show where a wall meets the plane, and only those
/// at most so many spacings away count.
const WALL_FOOT: f64 = 4.0;
const WALL_NEAR: f64 = 3.0;
/// A point at most this many spacings outside the wall still belongs to it.
const WALL_SLACK: f64 = 0.25;
/// Most squares.
const MOST_SQUARES: f64 = 4e6;
/// Share and number of the squares with points on the plane that must show a support.
const LEAST_BEYOND: (f64, usize) = (0.05, 12);
/// The same share where the plane is not upright.
const LEAST_BEYOND_ALL_ROUND: f64 = 0.5;
/// Directions in the plane, and the share of them in which such a support reaches beyond the object.
const DIRECTIONS: usize = 36;
const LEAST_ROUND: f64 = 0.85;

/// Points from which the density of a foot is known, and how many times denser than the rest it must be
/// to be thinned.
const LEAST_FOOT: usize = 60;
const DENSER: f64 = 1.2;

/// The evidence that a plane needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Evidence {
    /// Points beyond the object or below its underside.
    Beyond,
    /// Points beyond the object in nearly every direction.
    BeyondAllRound,
}

/// What is above a square of the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Label {
    /// Nothing, and the square is connected with the outside.
    Outside,
    /// An odd number of layers, or nothing but enclosed by walls.
    Foot,
    /// An even number of layers.
    Below,
    /// A wall.
    Wall,
}

/// A point over the plane.
#[derive(Clone, Copy)]
struct Place {
    u: f64,
    v: f64,
    height: f64,
}

/// The squares of a plane with what is above them.
pub(super) struct Footprint {
    places: Vec<Place>,
    tolerance: f64,
    step: f64,
    side: f64,
    corner: (f64, f64),
    columns: usize,
    rows: usize,
    /// Points on the plane, square by square.
    on_plane: Vec<u32>,
    /// Points above the plane, sorted by square and then by height.
    above: Vec<(u32, u32)>,
    /// Where the points of each square begin in `above`.
    starts: Vec<u32>,
    labels: Vec<Label>,
}

impl Footprint {
    /// Sorts points over a plane; those within `tolerance` of it lie on it. Lengths are metres.
    pub(super) fn new(
        points: &[Point3<f64>],
        plane: &Support,
        tolerance: f64,
        step: f64,
    ) -> Option<Self> {
        let (e1, e2) = tangent_frame(&plane.normal);
        let place = |p: &Point3<f64>| Place {
            u: p.coords.dot(&e1),
            v: p.coords.dot(&e2),
            height: plane.height(p),
        };
        let places: Vec<Place> = points.iter().map(place).collect();
        let on = || places.iter().filter(|p| p.height.abs() <= tolerance);
        let bounds = |of: fn(&Place) -> f64| {
            let values = on().map(of);
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
                (a.min(x), b.max(x))
            })
        };
        let ((u0, u1), (v0, v1)) = (bounds(|p| p.u), bounds(|p| p.v));
        let area = (u1 - u0) * (v1 - v0);
        if !(area.is_finite() && area > 0.0 && step > 0.0) {
            return None;
        }
        let side = (SQUARE * step).max((area / MOST_SQUARES).sqrt());
        let count = |length: f64| (length / side).floor() as usize + 3;
        let mut footprint = Self {
            places,
            tolerance,
            step,
            side,
            corner: (u0 - side, v0 - side),
            columns: count(u1 - u0),
            rows: count(v1 - v0),
            on_plane: Vec::new(),
            above: Vec::new(),
            starts: Vec::new(),
            labels: Vec::new(),
        };
        footprint.sort_points();
        footprint.label();
        Some(footprint)
    }

    /// Indices of the object's points, if there is evidence for a support.
    pub(super) fn object(&self, points: &[Point3<f64>], evidence: Evidence) -> Option<Vec<usize>> {
        let squares: Vec<usize> = self.squares().filter(|s| self.on_plane[*s] > 0).collect();
        let beyond = squares.iter().filter(|s| self.is_beyond(**s)).count();
        let share = beyond as f64 / squares.len() as f64;
        let seen = match evidence {
            Evidence::Beyond => share >= LEAST_BEYOND.0 && beyond >= LEAST_BEYOND.1,
            Evidence::BeyondAllRound => share >= LEAST_BEYOND_ALL_ROUND && self.reaches_all_round(),
        };
        if !seen {
            return None;
        }
        let above = |i: &usize| self.places[*i].height > self.tolerance;
        let foot = |i: &usize| {
            let place = &self.places[*i];
            place.height.abs() <= self.tolerance && self.is_foot(place)
        };
        let mut object: Vec<usize> = (0..points.len()).filter(above).collect();
        let foot: Vec<usize> = (0..points.len()).filter(foot).collect();
        object.extend(self.thinned(points, &object, foot));
        object.sort_unstable();
        Some(object)
    }

    /// Indices of the points on the plane with nothing above them or near them.
    pub(super) fn open(&self) -> impl Iterator<Item = usize> {
        let open = |place: &Place| {
            let square = self
                .square(place)
                .filter(|s| self.labels[*s] == Label::Outside);
            place.height.abs() <= self.tolerance && square.is_some_and(|s| self.is_beyond(s))
        };
        (0..self.places.len()).filter(move |i| open(&self.places[*i]))
    }

    /// The foot as dense as the rest of the object.
    ///
    /// Where the foot is denser, it includes points of the support. In each square the highest
    /// points are kept, since a foot is never below the support.
    fn thinned(&self, points: &[Point3<f64>], above: &[usize], foot: Vec<usize>) -> Vec<usize> {
        let even: Vec<usize> = (foot.iter().copied())
            .filter(|i| self.label_at(*i) == Some(Label::Foot))
            .collect();
        let place = |indices: &[usize]| -> Vec<Point3<f64>> {
            indices.iter().map(|i| points[*i]).collect()
        };
        let (ours, theirs) = (spacing(&place(above)), spacing(&place(&even)));
        let denser = (ours / theirs).powi(2);
        if even.len() < LEAST_FOOT || !(denser > DENSER) {
            return foot;
        }
        let mut squares: Vec<Vec<usize>> = vec![Vec::new(); self.columns * self.rows];
        for i in foot {
            if let Some(square) = self.square(&self.places[i]) {
                squares[square].push(i);
            }
        }
        let mut kept = Vec::new();
        for mut square in squares {
            square.sort_by(|a, b| self.places[*b].height.total_cmp(&self.places[*a].height));
            square.truncate((square.len() as f64 / denser).round() as usize);
            kept.extend(square);
        }
        kept
    }

    fn label_at(&self, point: usize) -> Option<Label> {
        self.square(&self.places[point])
            .map(|square| self.labels[square])
    }

    fn squares(&self) -> std::ops::Range<usize> {
        0..self.columns * self.rows
    }

    fn square(&self, place: &Place) -> Option<usize> {
        let column = ((place.u - self.corner.0) / self.side).floor();
        let row = ((place.v - self.corner.1) / self.side).floor();
        let inside =
            (0.0..self.columns as f64).contains(&column) && (0.0..self.rows as f64).contains(&row);
        inside.then(|| row as usize * self.columns + column as usize)
    }

    /// Squares at most `reach` away along each axis, the square itself among them.
    fn around(&self, square: usize, reach: usize) -> impl Iterator<Item = usize> + use<> {
        let (row, column, columns) = (square / self.columns, square % self.columns, self.columns);
        let span =
            move |at: usize, count: usize| at.saturating_sub(reach)..(at + reach + 1).min(count);
        let beside = span(column, self.columns);
        span(row, self.rows).flat_map(move |r| beside.clone().map(move |c| r * columns + c))
    }

    fn sort_points(&mut self) {
        let count = self.columns * self.rows;
        self.on_plane = vec![0; count];
        for (i, place) in self.places.iter().enumerate() {
            let Some(square) = self.square(place) else {
                continue;
            };
            if place.height > self.tolerance {
                self.above.push((square as u32, i as u32));
            } else if place.height >= -self.tolerance {
                self.on_plane[square] += 1;
            }
        }
        let height = |i: u32| self.places[i as usize].height;
        self.above
            .sort_unstable_by(|a, b| a.0.cmp(&b.0).then(height(a.1).total_cmp(&height(b.1))));
        self.starts = vec![0; count + 1];
        for (square, _) in &self.above {
            self.starts[*square as usize + 1] += 1;
        }
        for square in 0..count {
            self.starts[square + 1] += self.starts[square];
        }
    }

    /// Points above a square, lowest first.
    fn above(&self, square: usize) -> impl Iterator<Item = &Place> {
        let range = self.starts[square] as usize..self.starts[square + 1] as usize;
        self.above[range]
            .iter()
            .map(|(_, i)| &self.places[*i as usize])
    }

    fn label(&mut self) {
        let outside = self.reachable();
        let raw: Vec<Label> = self
            .squares()
            .map(|square| match self.layers(square) {
                None => Label::Wall,
                Some(0) if outside[square] => Label::Outside,
                Some(0) => Label::Foot,
                Some(layers) if layers % 2 == 1 => Label::Foot,
                Some(_) => Label::Below,
            })
            .collect();
        // The majority of the squares around corrects a layer that was missed or seen twice.
        self.labels = raw.clone();
        for square in self.squares().filter(|s| raw[*s] != Label::Wall) {
            let votes =
                |wanted: Label| self.around(square, 1).filter(|s| raw[*s] == wanted).count();
            let [foot, below, outside] = [Label::Foot, Label::Below, Label::Outside].map(votes);
            let own = raw[square];
            if own == Label::Foot && below + outside > foot {
                let other = if below > outside {
                    Label::Below
                } else {
                    Label::Outside
                };
                self.labels[square] = other;
            } else if own == Label::Below && foot > below + outside {
                self.labels[square] = Label::Foot;
            }
        }
    }

    /// Squares without points above that are connected with the edge of the grid.
    fn reachable(&self) -> Vec<bool> {
        let empty = |square: usize| self.starts[square] == self.starts[square + 1];
        let mut reached = vec![false; self.columns * self.rows];
        let at_edge = |s: &usize| {
            let (row, column) = (s / self.columns, s % self.columns);
            row == 0 || column == 0 || row + 1 == self.rows || column + 1 == self.columns
        };
        let mut queue: VecDeque<usize> =
            self.squares().filter(|s| at_edge(s) && empty(*s)).collect();
        queue.iter().for_each(|s| reached[*s] = true);
        while let Some(square) = queue.pop_front() {
            let (row, column) = (square / self.columns, square % self.columns);
            let straight =
                |other: &usize| other / self.columns == row || other % self.columns == column;
            for other in self.around(square, 1).filter(straight) {
                if empty(other) && !reached[other] {
                    reached[other] = true;
                    queue.push_back(other);
                }
            }
        }
        reached
    }

    /// Number of layers above a square; `None` where one of them is a wall.
    fn layers(&self, square: usize) -> Option<usize> {
        let mut layers = 0;
        let (mut low, mut last) = (0.0, f64::NEG_INFINITY);
        for place in self.above(square) {
            if place.height - last > GAP * self.step {
                layers += 1;
                low = place.height;
            }
            last = place.height;
            if last - low > WALL * self.step {
                return None;
            }
        }
        Some(layers)
    }

    /// Whether a square shows a support: no point is above or near it, or it lies deep below an underside.
    fn is_beyond(&self, square: usize) -> bool {
        let free = |s: usize| self.labels[s] == Label::Outside;
        match self.labels[square] {
            Label::Outside => self
                .around(square, 1)
                .all(|s| self.starts[s] == self.starts[s + 1]),
            Label::Below => self
                .around(square, 1)
                .all(|s| free(s) || (self.labels[s] == Label::Below && self.on_plane[s] > 0)),
            Label::Foot | Label::Wall => false,
        }
    }

    /// Whether the points on the plane reach beyond those above it in nearly every direction.
    fn reaches_all_round(&self) -> bool {
        let reach = |above: bool, (sin, cos): (f64, f64)| {
            let wanted =
                |p: &&Place| (p.height > self.tolerance) == above && p.height >= -self.tolerance;
            let along = self
                .places
                .iter()
                .filter(wanted)
                .map(|p| p.u * cos + p.v * sin);
            along.fold(f64::NEG_INFINITY, f64::max)
        };
        let beyond = (0..DIRECTIONS).filter(|k| {
            let turn = (std::f64::consts::TAU * *k as f64 / DIRECTIONS as f64).sin_cos();
            reach(false, turn) > reach(true, turn) + 2.0 * self.side
        });
        beyond.count() as f64 >= LEAST_ROUND * DIRECTIONS as f64
    }

    /// Whether a point on the plane belongs to the object.
    fn is_foot(&self, place: &Place) -> bool {
        let Some(square) = self.square(place) else {
            return false;
        };
        match self.labels[square] {
            Label::Foot => true,
            Label::Outside | Label::Below => false,
            Label::Wall => self.is_inside_wall(square, place),
        }
    }

    /// Whether a point lies on the foot's side of the wall that rises near it.
    fn is_inside_wall(&self, square: usize, place: &Place) -> bool {
        let middle = |wanted: fn(Label) -> bool| {
            let (mut u, mut v, mut count) = (0.0, 0.0, 0);
            for s in self.around(square, 2).filter(|s| wanted(self.labels[*s])) {
                u += (s % self.columns) as f64 * self.side;
                v += (s / self.columns) as f64 * self.side;
                count += 1;
            }
            (count > 0).then(|| (u / f64::from(count), v / f64::from(count)))
        };
        let foot = middle(|label| label == Label::Foot);
        let rest = middle(|label| matches!(label, Label::Outside | Label::Below));
        let (Some(foot), Some(rest)) = (foot, rest) else {
            return foot.is_some();
        };
        let (mut u, mut v, mut count) = (0.0, 0.0, 0);
        let low = self.tolerance + WALL_FOOT * self.step;
        let near = self
            .around(square, 2)
            .flat_map(|s| self.above(s).take_while(|p| p.height <= low));
        for wall in near {
            let apart = (wall.u - place.u).hypot(wall.v - place.v);
            if apart <= WALL_NEAR * self.step {
                (u, v, count) = (u + wall.u, v + wall.v, count + 1);
            }
        }
        let inward = (foot.0 - rest.0, foot.1 - rest.1);
        let length = inward.0.hypot(inward.1);
        if count == 0 || length == 0.0 {
            return false;
        }
        let arm = (
            place.u - u / f64::from(count),
            place.v - v / f64::from(count),
        );
        (arm.0 * inward.0 + arm.1 * inward.1) / length >= -WALL_SLACK * self.step
    }
}
