//! The positions of degrees l and orders m in a coefficient vector.

/// Position of Y_{l,m} in a coefficient vector: l² + l + m.
///
/// Degrees are consecutive, and within a degree m runs from −l to l. Needs |m| ≤ l.
pub fn position(l: usize, m: isize) -> usize {
    debug_assert!(m.unsigned_abs() <= l, "order {m} beyond degree {l}");
    (l * l + l).wrapping_add_signed(m)
}

/// Degree and order of the harmonic at a position; the inverse of [`position`].
pub fn degree_order(position: usize) -> (usize, isize) {
    let l = position.isqrt();
    (l, position as isize - (l * l + l) as isize)
}

/// Number of harmonics up to and including a degree: (L+1)².
pub fn count(degree: usize) -> usize {
    (degree + 1) * (degree + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn position_and_degree_order_are_inverse() {
        for i in 0..count(300) {
            let (l, m) = degree_order(i);
            assert!(m.unsigned_abs() <= l);
            assert_eq!(position(l, m), i);
        }
    }
}
