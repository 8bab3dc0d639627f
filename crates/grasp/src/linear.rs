//! A small dense linear programme: min c·x subject to A x = b, x ≥ 0.
//!
//! Two-phase tableau simplex for the dozen rows and few hundred columns that
//! grasps ask for. The artificial columns stay in the tableau, which so yields the multipliers.

/// How a programme ends.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Outcome {
    /// The minimum: the point, the value and the multipliers y of the rows (c − Aᵀy ≥ 0, b·y = value).
    Optimal {
        x: Vec<f64>,
        value: f64,
        multipliers: Vec<f64>,
    },
    /// No feasible point: y with Aᵀy ≤ 0 and b·y > 0 proves it.
    Infeasible { certificate: Vec<f64> },
    /// The objective falls without bound.
    Unbounded,
}

/// Rows of A, b, and c; every row as long as `cost`.
#[derive(Clone, Debug)]
pub(crate) struct Programme {
    pub(crate) rows: Vec<Vec<f64>>,
    pub(crate) right: Vec<f64>,
    pub(crate) cost: Vec<f64>,
}

const TOLERANCE: f64 = 1e-11;
/// Far more than any programme of a grasp takes; a point feasible so far is then returned.
const MOST_PIVOTS: usize = 100_000;

struct Tableau {
    /// Each row: variables, artificials, right-hand side.
    rows: Vec<Vec<f64>>,
    basis: Vec<usize>,
    variables: usize,
    flipped: Vec<bool>,
}

impl Programme {
    pub(crate) fn solve(&self) -> Outcome {
        let mut tableau = self.tableau();
        let (m, n) = (self.rows.len(), self.cost.len());
        let mut phase1 = vec![0.0; n + m + 1];
        phase1[n..n + m].fill(1.0);
        let mut phase2 = self.cost.clone();
        phase2.resize(n + m + 1, 0.0);
        for i in 0..m {
            subtract(&mut phase1, 1.0, &tableau.rows[i]);
        }
        tableau.run(&mut phase1, &mut phase2);
        let size = self.right.iter().map(|b| b.abs()).fold(1e-300, f64::max);
        if -phase1[n + m] > 1e-9 * size {
            let certificate = multipliers(&phase1, n, &tableau.flipped, 1.0);
            return Outcome::Infeasible { certificate };
        }
        tableau.expel_artificials(&mut phase2);
        let mut unused = vec![0.0; n + m + 1];
        if !tableau.run(&mut phase2, &mut unused) {
            return Outcome::Unbounded;
        }
        let mut x = vec![0.0; n];
        for (row, &variable) in tableau.rows.iter().zip(&tableau.basis) {
            if variable < n {
                x[variable] = row[n + m];
            }
        }
        Outcome::Optimal {
            x,
            value: -phase2[n + m],
            multipliers: multipliers(&phase2, n, &tableau.flipped, 0.0),
        }
    }

    fn tableau(&self) -> Tableau {
        let (m, n) = (self.rows.len(), self.cost.len());
        let mut flipped = vec![false; m];
        let rows = (0..m)
            .map(|i| {
                flipped[i] = self.right[i] < 0.0;
                let sign = if flipped[i] { -1.0 } else { 1.0 };
                let mut row: Vec<f64> = self.rows[i].iter().map(|a| sign * a).collect();
                row.resize(n + m + 1, 0.0);
                row[n + i] = 1.0;
                row[n + m] = sign * self.right[i];
                row
            })
            .collect();
        Tableau {
            rows,
            basis: (n..n + m).collect(),
            variables: n,
            flipped,
        }
    }
}

impl Tableau {
    /// Pivots until no reduced cost is negative; false if the objective is unbounded.
    ///
    /// The steepest column enters first; where that goes on for long the programme is degenerate and
    /// Bland's rule, which cannot cycle, takes over.
    fn run(&mut self, objective: &mut [f64], other: &mut [f64]) -> bool {
        let patience = 10 * (self.rows.len() + 1);
        for pivot in 0..MOST_PIVOTS {
            let mut candidates = (0..self.variables).filter(|&j| objective[j] < -TOLERANCE);
            let entering = if pivot < patience {
                candidates.min_by(|&a, &b| objective[a].total_cmp(&objective[b]))
            } else {
                candidates.next()
            };
            let Some(j) = entering else { return true };
            let Some(i) = self.leaving(j) else {
                return false;
            };
            self.pivot(i, j, objective, other);
        }
        true
    }

    /// The row of the smallest ratio, the lowest variable on ties.
    fn leaving(&self, j: usize) -> Option<usize> {
        let mut best: Option<(usize, f64)> = None;
        for (i, row) in self.rows.iter().enumerate() {
            if row[j] <= TOLERANCE {
                continue;
            }
            let ratio = row[row.len() - 1].max(0.0) / row[j];
            let better = match best {
                None => true,
                Some((k, r)) => ratio < r || (ratio <= r && self.basis[i] < self.basis[k]),
            };
            if better {
                best = Some((i, ratio));
            }
        }
        best.map(|(i, _)| i)
    }

    fn pivot(&mut self, i: usize, j: usize, objective: &mut [f64], other: &mut [f64]) {
        let inverse = 1.0 / self.rows[i][j];
        self.rows[i].iter_mut().for_each(|x| *x *= inverse);
        let pivot = std::mem::take(&mut self.rows[i]);
        for row in &mut self.rows {
            if !row.is_empty() {
                let factor = row[j];
                subtract(row, factor, &pivot);
            }
        }
        for goal in [objective, other] {
            let factor = goal[j];
            subtract(goal, factor, &pivot);
        }
        self.rows[i] = pivot;
        self.basis[i] = j;
    }

    /// Replaces artificial variables that stayed in the basis at zero; a row in which no variable
    /// can replace one says 0 = 0 and is dropped.
    fn expel_artificials(&mut self, objective: &mut [f64]) {
        let mut unused = vec![0.0; objective.len()];
        let mut i = 0;
        while i < self.rows.len() {
            if self.basis[i] >= self.variables {
                let largest = (0..self.variables)
                    .max_by(|&a, &b| self.rows[i][a].abs().total_cmp(&self.rows[i][b].abs()));
                match largest {
                    Some(j) if self.rows[i][j].abs() > 1e-9 => {
                        self.pivot(i, j, objective, &mut unused);
                    }
                    _ => {
                        self.rows.remove(i);
                        self.basis.remove(i);
                        continue;
                    }
                }
            }
            i += 1;
        }
    }
}

/// The multipliers of the rows: what the artificial columns cost less their reduced costs.
fn multipliers(objective: &[f64], first: usize, flipped: &[bool], cost: f64) -> Vec<f64> {
    let signed = |(i, &flip): (usize, &bool)| {
        let y = cost - objective[first + i];
        if flip { -y } else { y }
    };
    flipped.iter().enumerate().map(signed).collect()
}

fn subtract(row: &mut [f64], factor: f64, pivot: &[f64]) {
    if factor != 0.0 {
        for (x, p) in row.iter_mut().zip(pivot) {
            *x -= factor * p;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_a_small_programme() {
        // min −x − 2y, x + y + s = 4, x + 3y + t = 6: the corner (3, 1).
        let programme = Programme {
            rows: vec![vec![1.0, 1.0, 1.0, 0.0], vec![1.0, 3.0, 0.0, 1.0]],
            right: vec![4.0, 6.0],
            cost: vec![-1.0, -2.0, 0.0, 0.0],
        };
        let Outcome::Optimal {
            x,
            value,
            multipliers,
        } = programme.solve()
        else {
            panic!("bounded and feasible");
        };
        assert!((value + 5.0).abs() <= 1e-12);
        assert!((multipliers[0] + 0.5).abs() <= 1e-12);
        assert!((multipliers[1] + 0.5).abs() <= 1e-12);
        assert!((x[0] - 3.0).abs() <= 1e-12 && (x[1] - 1.0).abs() <= 1e-12);
    }

    #[test]
    fn certifies_infeasibility_and_sees_unbounded_ones() {
        let programme = Programme {
            rows: vec![vec![1.0, 2.0], vec![-1.0, 1.0]],
            right: vec![-1.0, 0.0],
            cost: vec![0.0, 0.0],
        };
        let Outcome::Infeasible { certificate } = programme.solve() else {
            panic!("a positive sum cannot be −1");
        };
        assert!(-certificate[0] > 1e-9);
        for j in 0..2 {
            let sum: f64 = (0..2).map(|i| certificate[i] * programme.rows[i][j]).sum();
            assert!(sum <= 1e-9);
        }
        let programme = Programme {
            rows: vec![vec![1.0, -1.0]],
            right: vec![0.0],
            cost: vec![-1.0, 0.0],
        };
        assert_eq!(programme.solve(), Outcome::Unbounded);
    }
}
