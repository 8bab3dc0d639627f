//! Rounding of numbers to the precision that a figure can show.

/// Metres to millimetres, rounded to 0.02 mm.
///
/// A picture of a 20 cm object has about 0.3 mm per pixel. Steps of 0.02 mm keep shaded meshes smooth
/// and deflate to less room than steps of 0.01 mm.
pub(crate) fn millimetres(metres: f64) -> f64 {
    // Adding zero turns −0 into 0.
    (metres * 5e4).round() / 50.0 + 0.0
}

/// Millimetres of a point in metres, rounded to 0.02 mm.
pub(crate) fn point_millimetres(point_m: [f64; 3]) -> [f64; 3] {
    point_m.map(millimetres)
}

/// Rounds to `digits` significant decimal digits; 0 stays 0.
pub(crate) fn significant(value: f64, digits: i32) -> f64 {
    if value == 0.0 {
        return 0.0;
    }
    decimals(value, digits - 1 - value.abs().log10().floor() as i32)
}

/// Rounds to a number of decimals (negative: to tens, hundreds, …).
pub(crate) fn decimals(value: f64, places: i32) -> f64 {
    // Beyond these bounds the power of ten would leave the range of f64.
    if !(-290..=290).contains(&places) {
        return value;
    }
    let rounded = if places >= 0 {
        let unit = 10f64.powi(places);
        (value * unit).round() / unit
    } else {
        let unit = 10f64.powi(-places);
        (value / unit).round() * unit
    };
    if rounded.is_finite() {
        rounded + 0.0
    } else {
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::{prop_assert, proptest};

    #[test]
    fn millimetres_come_in_steps_of_two_hundredths() {
        assert_eq!(millimetres(0.012_345_678), 12.34);
        assert_eq!(millimetres(-1e-9).to_string(), "0");
    }

    proptest! {
        #[test]
        fn significant_digits_keep_the_value(mantissa in -10.0f64..10.0, exponent in -300i32..300) {
            let value = mantissa * 10f64.powi(exponent);
            let rounded = significant(value, 7);
            prop_assert!((rounded - value).abs() <= 1e-6 * value.abs());
        }
    }
}
