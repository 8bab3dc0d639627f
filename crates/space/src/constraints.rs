//! Hard constraints on the positions of contacts.

use grasp::QualityError;
use nalgebra::Vector3;
use shape::{ClosedPatch, Surface};
use sph::Direction;
use sph::direction::{log, retract};

use crate::objective::Objective;
use crate::quality::{LinearPieces, Quality, dot, in_frame, moved};

/// The directions p with axis·p ≥ least_cosine: a half-space at 0, a cone for positive values, the
/// outside of a cone for negative ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cap {
    /// Central direction of the cap.
    pub axis: Direction,
    /// Cosine of the opening angle, in [−1, 1].
    pub least_cosine: f64,
}

/// What every state of an ascent must satisfy. The default has no constraints.
#[derive(Clone, Debug, Default)]
pub struct Constraints {
    /// Least distance between any two contacts, metres.
    pub least_separation: Option<f64>,
    /// Largest distance between any two contacts, metres: the span of a hand.
    pub largest_separation: Option<f64>,
    /// The allowed part of the surface: the direction of every contact lies in all of these caps.
    pub caps: Vec<Cap>,
    /// Parts of the surface that close holes of the object: no contact lies on them.
    pub closed_holes: Vec<ClosedPatch>,
    /// An objective under which the grasp must be force-closed too. [`Objective::with_friction`]
    /// with a smaller μ makes this a margin of the friction cones.
    pub closed_under: Option<Objective>,
}

/// Why an ascent cannot start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ConstraintError {
    /// A constraint is not a usable number.
    #[error("{name} is {value}; expected {expected}")]
    Limit {
        /// Name of the constraint.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What it should be.
        expected: &'static str,
    },
    /// Separations and caps cannot be satisfied together near the start.
    #[error("the start cannot be moved inside the limits: {name} is still missed by {by}")]
    Unreachable {
        /// Name of the most violated constraint.
        name: &'static str,
        /// Size of the violation: metres for distances, a cosine for caps.
        by: f64,
    },
    /// No grasp reachable from the start is closed under the second objective.
    #[error("the start misses closure under the friction margin by {by}, no closed grasp is near")]
    FrictionMargin {
        /// Distance from closure.
        by: f64,
    },
}

/// Largest number of rounds of moving contacts back inside.
const ROUNDS: usize = 80;
/// Move of each contact when the slopes of the surface do not lead inside, radians.
const STEP_AROUND: f64 = 0.03;
/// Moves end this share of a constraint's scale inside it, so that the repair terminates.
const INSIDE: f64 = 1e-6;
/// Largest move of one repair, radians.
const REPAIR_STEP: f64 = 0.3;

const LARGEST: &str = "the largest separation";

/// One constraint at a state: slack ≥ 0 and its slope.
struct Limit {
    name: &'static str,
    slack: f64,
    /// The size relative to which a violation is measured.
    scale: f64,
    /// Index of a contact and the derivative of the slack by its move.
    by_move: [(usize, Vector3<f64>); 2],
}

impl Constraints {
    /// Whether there are no constraints.
    pub fn is_empty(&self) -> bool {
        self.least_separation.is_none()
            && self.largest_separation.is_none()
            && self.caps.is_empty()
            && self.closed_holes.is_empty()
            && self.closed_under.is_none()
    }

    /// Checks that the numbers are usable.
    ///
    /// # Errors
    /// [`ConstraintError::Limit`] with the first constraint that is not.
    pub fn validate(&self) -> Result<(), ConstraintError> {
        let bad = |name, value, expected| {
            Err(ConstraintError::Limit {
                name,
                value,
                expected,
            })
        };
        for (name, value) in [
            ("least separation", self.least_separation),
            ("largest separation", self.largest_separation),
        ] {
            if let Some(value) = value
                && !(value.is_finite() && value >= 0.0)
            {
                return bad(name, value, "metres ≥ 0");
            }
        }
        if let (Some(least), Some(largest)) = (self.least_separation, self.largest_separation)
            && least > largest
        {
            return bad(
                "least separation",
                least,
                "no more than the largest separation",
            );
        }
        match self.caps.iter().find(|c| !(c.least_cosine.abs() <= 1.0)) {
            Some(cap) => bad("cap", cap.least_cosine, "a cosine in [−1, 1]"),
            None => Ok(()),
        }
    }

    /// Whether contacts satisfy the separations and caps; force closure is not tested.
    pub fn allow(&self, surface: &impl Surface, directions: &[Direction]) -> bool {
        (0..self.count(directions.len())).all(|k| self.limit(surface, directions, k).slack >= 0.0)
    }

    /// Moves contacts until they satisfy the separations and caps, correcting each violated one in
    /// turn along its slope.
    ///
    /// Contacts that satisfy them are returned unchanged. The result is near the start but not the
    /// nearest solution.
    ///
    /// # Errors
    /// [`ConstraintError::Unreachable`] with the most violated constraint.
    pub fn repair(
        &self,
        surface: &impl Surface,
        directions: &[Direction],
    ) -> Result<Vec<Direction>, ConstraintError> {
        let mut here = directions.to_vec();
        self.repair_in_place(surface, &mut here)?;
        Ok(here)
    }

    /// [`Constraints::repair`] in place; after an error the directions are unspecified.
    ///
    /// # Errors
    /// As [`Constraints::repair`].
    pub fn repair_in_place(
        &self,
        surface: &impl Surface,
        directions: &mut [Direction],
    ) -> Result<(), ConstraintError> {
        let count = self.count(directions.len());
        for round in 0..ROUNDS {
            let mut kept = true;
            for k in 0..count {
                let limit = self.limit(surface, directions, k);
                if limit.slack < 0.0 {
                    kept = false;
                    if round < ROUNDS / 2 {
                        limit.step_inside(directions);
                    } else {
                        limit.step_around(directions);
                    }
                }
            }
            if kept {
                return Ok(());
            }
        }
        let share = |l: &Limit| l.slack / l.scale;
        let worst = (0..count)
            .map(|k| self.limit(surface, directions, k))
            .min_by(|a, b| share(a).total_cmp(&share(b)));
        match worst {
            Some(limit) if limit.slack < 0.0 => Err(ConstraintError::Unreachable {
                name: limit.name,
                by: -limit.slack,
            }),
            _ => Ok(()),
        }
    }

    /// Every constraint as a linear function of the contacts' moves, for the model of a step.
    pub(crate) fn linearise<S: Surface>(
        &mut self,
        surface: &S,
        directions: &[Direction],
        out: &mut LinearPieces,
    ) -> Result<(), QualityError> {
        out.reset(directions.len());
        if self.is_empty() {
            return Ok(());
        }
        if let Some(second) = &mut self.closed_under {
            let value = second.value(surface, directions)?;
            second.linearise(surface, directions, out)?;
            out.raise(value);
        }
        for k in 0..self.count(directions.len()) {
            let limit = self.limit(surface, directions, k);
            limit.write(directions, out.push(limit.slack));
        }
        Ok(())
    }

    /// Whether contacts are closed under the second objective; true if there is none.
    pub(crate) fn closed<S: Surface>(
        &mut self,
        surface: &S,
        directions: &[Direction],
    ) -> Result<bool, QualityError> {
        match &mut self.closed_under {
            Some(second) => Ok(second.value(surface, directions)? > 0.0),
            None => Ok(true),
        }
    }

    /// Number of separations, caps and holes for this many contacts: first every cap of every contact,
    /// then every hole of every contact, then every pair.
    fn count(&self, contacts: usize) -> usize {
        let of_a_pair = usize::from(self.least_separation.is_some())
            + usize::from(self.largest_separation.is_some());
        let pairs = contacts * contacts.saturating_sub(1) / 2;
        (self.caps.len() + self.closed_holes.len()) * contacts + of_a_pair * pairs
    }

    /// Constraint k of these contacts.
    fn limit(&self, surface: &impl Surface, directions: &[Direction], k: usize) -> Limit {
        let of_caps = self.caps.len() * directions.len();
        if k < of_caps {
            return self.caps[k / directions.len()].limit(directions, k % directions.len());
        }
        let (k, holes) = (k - of_caps, self.closed_holes.len() * directions.len());
        if k < holes {
            let hole = &self.closed_holes[k / directions.len()];
            return of_hole(surface, directions, hole, k % directions.len());
        }
        let k = k - holes;
        match (self.least_separation, self.largest_separation) {
            (Some(least), Some(largest)) => {
                let (pair, bound) = (k / 2, k % 2);
                let far = (bound == 1).then_some(largest);
                of_pair(surface, directions, pair, least, far)
            }
            (least, far) => of_pair(surface, directions, k, least.unwrap_or(0.0), far),
        }
    }
}

impl Cap {
    fn limit(&self, directions: &[Direction], i: usize) -> Limit {
        Limit {
            name: "a cap",
            slack: self.axis.dot(&directions[i]) - self.least_cosine,
            scale: 1.0,
            by_move: [(i, self.axis.into_inner()), (i, Vector3::zeros())],
        }
    }
}

/// A contact keeps off a part of the surface that closes a hole.
fn of_hole(
    surface: &impl Surface,
    directions: &[Direction],
    hole: &ClosedPatch,
    i: usize,
) -> Limit {
    let at = surface.differential(&directions[i]);
    let nearest = hole.nearest(&at.position);
    let (away, distance) = nearest.map_or((Vector3::zeros(), f64::INFINITY), |(place, d)| {
        (at.position - place, d - hole.reach)
    });
    let along = away.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
    let slope = at.position_slope.transpose() * along;
    Limit {
        name: "the distance from a closed hole",
        slack: distance,
        scale: hole.reach.max(1e-3),
        by_move: [(i, slope), (i, Vector3::zeros())],
    }
}

/// The constraint of one pair of contacts: at most `far` apart if that is given, else at least
/// `least`.
fn of_pair(
    surface: &impl Surface,
    directions: &[Direction],
    pair: usize,
    least: f64,
    far: Option<f64>,
) -> Limit {
    // Pairs in the order (0,1), (0,2), …, (1,2), …
    let (mut i, mut left) = (0, pair);
    while left >= directions.len() - 1 - i {
        left -= directions.len() - 1 - i;
        i += 1;
    }
    let j = i + 1 + left;
    let (a, b) = (
        surface.differential(&directions[i]),
        surface.differential(&directions[j]),
    );
    let apart = a.position - b.position;
    let distance = apart.norm();
    let along = apart.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
    let by_move = [
        (i, a.position_slope.transpose() * along),
        (j, -(b.position_slope.transpose() * along)),
    ];
    match far {
        None => Limit {
            name: "the least separation",
            slack: distance - least,
            scale: least.max(1e-3),
            by_move,
        },
        Some(largest) => Limit {
            name: LARGEST,
            slack: largest - distance,
            scale: largest.max(1e-3),
            by_move: by_move.map(|(i, v)| (i, -v)),
        },
    }
}

impl Limit {
    fn write(&self, directions: &[Direction], slope: &mut [f64]) {
        for (i, v) in &self.by_move {
            let [a, b] = in_frame(&directions[*i], v);
            slope[2 * i] += a;
            slope[2 * i + 1] += b;
        }
    }

    /// Moves a pair of contacts along the great circle between them: together for the largest
    /// separation, apart for the least one. Moves along slopes alone can end in a local extremum of
    /// a bumpy surface.
    fn step_around(&self, directions: &mut [Direction]) {
        let [(i, _), (j, _)] = self.by_move;
        if i == j {
            self.step_inside(directions);
            return;
        }
        let length = match self.name {
            LARGEST => STEP_AROUND,
            _ => -STEP_AROUND,
        };
        let (p, q) = (directions[i], directions[j]);
        let towards = |p: &Direction, q: &Direction| {
            let way = log(p, q);
            retract(p, &(way * (length / way.norm().max(STEP_AROUND))))
        };
        (directions[i], directions[j]) = (towards(&p, &q), towards(&q, &p));
    }

    /// The shortest move that, to first order, makes the slack just positive.
    fn step_inside(&self, directions: &mut [Direction]) {
        let mut slopes = self.by_move.map(|(i, v)| in_frame(&directions[i], &v));
        let square = |slopes: &[[f64; 2]; 2]| slopes.iter().map(|s| dot(s, s)).sum::<f64>();
        if square(&slopes) == 0.0 {
            // The slope vanishes for coinciding contacts and opposite a cap's axis: any direction
            // reduces the violation.
            slopes = [[1.0, 0.0], [0.0, 1.0]];
        }
        let square = square(&slopes);
        let wanted = (INSIDE * self.scale - self.slack) / square;
        let factor = wanted.min(REPAIR_STEP / square.sqrt());
        for ((i, _), slope) in self.by_move.iter().zip(slopes) {
            directions[*i] = moved(&directions[*i], &slope.map(|s| factor * s));
        }
    }
}
