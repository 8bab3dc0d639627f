//! p × ∇f by coefficients: the generators of rotations, on real harmonics.

use sph::Coefficients;

/// Coefficients of the three components of p × ∇_S f, each of the degree of f.
///
/// The generators K_x = y∂_z − z∂_y, K_y = z∂_x − x∂_z, K_z = x∂_y − y∂_x mix only the orders of
/// one degree. With C_m, S_m the real and imaginary part of Π_l^m(z)(x+iy)^m normalised as one
/// complex harmonic, and a_m = √((l−m)(l+m+1)): K_x C_m = ½(a_m S_{m+1} + a_{m−1} S_{m−1}), K_x S_m
/// = −½(a_m C_{m+1} + a_{m−1} C_{m−1}), K_y F_m = ½(−a_m F_{m+1} + a_{m−1} F_{m−1}) for F = C, S,
/// and K_z C_m = −m S_m, K_z S_m = m C_m. Costs a few operations per coefficient.
pub(crate) fn rotational_gradient(f: &Coefficients) -> [Coefficients; 3] {
    let degree = f.degree();
    let mut out = std::array::from_fn(|_| Coefficients::zeros(degree));
    for l in 0..=degree {
        for m in 0..=l {
            let (cos, sin) = (f.get(l, m as isize), f.get(l, -(m as isize)));
            let sin = if m == 0 { 0.0 } else { sin };
            add_order(&mut out, l, m, cos, sin);
        }
    }
    out
}

/// Adds the images of cos · Y_{l,m} + sin · Y_{l,−m}.
fn add_order([kx, ky, kz]: &mut [Coefficients; 3], l: usize, m: usize, cos: f64, sin: f64) {
    let centre = l * l + l;
    let ladder = |m: usize| (((l - m) * (l + m + 1)) as f64).sqrt();
    // Y_{l,0} is C_0, the others are √2 C_m and √2 S_m.
    let root = std::f64::consts::SQRT_2;
    if m < l {
        let half = 0.5 * ladder(m) * if m == 0 { root } else { 1.0 };
        kx.as_mut_slice()[centre - (m + 1)] += half * cos;
        kx.as_mut_slice()[centre + (m + 1)] -= half * sin;
        ky.as_mut_slice()[centre + (m + 1)] -= half * cos;
        ky.as_mut_slice()[centre - (m + 1)] -= half * sin;
    }
    if m > 0 {
        let half = 0.5 * ladder(m - 1) * if m == 1 { root } else { 1.0 };
        if m > 1 {
            kx.as_mut_slice()[centre - (m - 1)] += half * cos;
            ky.as_mut_slice()[centre - (m - 1)] += half * sin;
        }
        kx.as_mut_slice()[centre + (m - 1)] -= half * sin;
        ky.as_mut_slice()[centre + (m - 1)] += half * cos;
        kz.as_mut_slice()[centre - m] -= m as f64 * cos;
        kz.as_mut_slice()[centre + m] += m as f64 * sin;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sph::Basis;
    use sph::direction::even_directions;

    #[test]
    fn agrees_with_gradients_at_points() {
        let degree = 7;
        let basis = Basis::new(degree);
        let mut work = basis.workspace();
        for i in 0..(degree + 1) * (degree + 1) {
            let mut f = Coefficients::zeros(degree);
            f.as_mut_slice()[i] = 1.0;
            let fields = rotational_gradient(&f);
            for p in even_directions(20) {
                let expected = p.cross(&basis.jet(&f, &p, &mut work).gradient);
                for (axis, field) in fields.iter().enumerate() {
                    let found = basis.sum(field, &p, &mut work);
                    assert!((found - expected[axis]).abs() <= 1e-12, "{i} {axis}");
                }
            }
        }
    }
}
