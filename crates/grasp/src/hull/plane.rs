//! Six-dimensional vectors as plain arrays, and the hyperplane through six points.

/// A vector of R⁶.
pub(crate) type V6 = [f64; 6];

/// The inner product.
#[inline(always)]
pub(crate) fn dot(a: &V6, b: &V6) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]) + (a[4] * b[4] + a[5] * b[5])
}

/// a − b.
#[inline(always)]
pub(crate) fn sub(a: &V6, b: &V6) -> V6 {
    std::array::from_fn(|k| a[k] - b[k])
}

/// a + s b.
#[inline(always)]
pub(crate) fn add_scaled(a: &V6, s: f64, b: &V6) -> V6 {
    std::array::from_fn(|k| a[k] + s * b[k])
}

/// s a.
#[inline(always)]
pub(crate) fn scale(a: &V6, s: f64) -> V6 {
    std::array::from_fn(|k| a[k] * s)
}

/// The Euclidean norm.
#[inline(always)]
pub(crate) fn norm(a: &V6) -> f64 {
    dot(a, a).sqrt()
}

/// The hyperplane n·x = offset with |n| = 1, and how far it misses the points it was made from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    pub(crate) normal: V6,
    pub(crate) offset: f64,
    pub(crate) residual: f64,
}

impl Plane {
    /// n·x − offset.
    #[inline(always)]
    pub(crate) fn height(&self, x: &V6) -> f64 {
        dot(&self.normal, x) - self.offset
    }

    /// The hyperplane through six points, by elimination with complete pivoting; either orientation.
    ///
    /// Points that lie in less than a hyperplane give one of the hyperplanes that hold them.
    pub(crate) fn through(points: &[V6; 6]) -> Plane {
        let normal = null_vector(std::array::from_fn(|i| sub(&points[i + 1], &points[0])));
        let heights = points.map(|p| dot(&normal, &p));
        let low = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let high = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Plane {
            normal,
            offset: 0.5 * (low + high),
            residual: 0.5 * (high - low),
        }
    }

    /// The same plane seen from the other side.
    pub(crate) fn flipped(&self) -> Plane {
        Plane {
            normal: self.normal.map(|x| -x),
            offset: -self.offset,
            residual: self.residual,
        }
    }
}

/// A unit vector orthogonal to five rows.
fn null_vector(mut a: [V6; 5]) -> V6 {
    let mut column: [usize; 6] = std::array::from_fn(|j| j);
    let mut rank = 0;
    for k in 0..5 {
        let (mut row, mut col, mut best) = (k, k, 0.0);
        for (i, r) in a.iter().enumerate().skip(k) {
            for (j, x) in r.iter().enumerate().skip(k) {
                if x.abs() > best {
                    (row, col, best) = (i, j, x.abs());
                }
            }
        }
        if best == 0.0 {
            break;
        }
        rank = k + 1;
        a.swap(k, row);
        column.swap(k, col);
        for r in &mut a {
            r.swap(k, col);
        }
        let pivot = a[k];
        for r in a.iter_mut().skip(k + 1) {
            let factor = r[k] / pivot[k];
            for j in k..6 {
                r[j] -= factor * pivot[j];
            }
        }
    }
    let mut x = [0.0; 6];
    x[5] = 1.0;
    for k in (0..rank).rev() {
        let tail: f64 = (k + 1..6).map(|j| a[k][j] * x[j]).sum();
        x[k] = -tail / a[k][k];
    }
    let length = norm(&x);
    let mut out = [0.0; 6];
    for (k, &c) in column.iter().enumerate() {
        out[c] = x[k] / length;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_through_its_points() {
        let points: [V6; 6] = std::array::from_fn(|i| {
            std::array::from_fn(|k| ((3 * i + 7 * k + i * k * k) as f64 * 0.7).sin())
        });
        let plane = Plane::through(&points);
        assert!((norm(&plane.normal) - 1.0).abs() <= 1e-14);
        assert!(plane.residual <= 1e-14);
        for p in &points {
            assert!(plane.height(p).abs() <= 1e-14);
        }
    }

    #[test]
    fn repeated_points_still_give_a_plane() {
        let mut points = [[0.0; 6]; 6];
        points[1][0] = 1.0;
        points[2][0] = 2.0;
        let plane = Plane::through(&points);
        assert!((norm(&plane.normal) - 1.0).abs() <= 1e-14);
        assert!(plane.residual <= 1e-15);
    }
}
