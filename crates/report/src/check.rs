//! Checks of the input. Each error names the place, the index and the value.

use crate::error::ReportError;

/// An error for a NaN or infinite entry of `values`.
pub(crate) fn finite(place: &str, values: &[f64]) -> Result<(), ReportError> {
    match values.iter().position(|v| !v.is_finite()) {
        None => Ok(()),
        Some(index) => Err(ReportError::NotFinite {
            place: place.to_owned(),
            index,
            value: values[index],
        }),
    }
}

/// An error for a NaN or infinite coordinate of `points`; the index is that of the point.
pub(crate) fn finite_points<const N: usize>(
    place: &str,
    points: &[[f64; N]],
) -> Result<(), ReportError> {
    for (index, point) in points.iter().enumerate() {
        if let Some(&value) = point.iter().find(|v| !v.is_finite()) {
            return Err(ReportError::NotFinite {
                place: place.to_owned(),
                index,
                value,
            });
        }
    }
    Ok(())
}

/// An error for a value ≤ 0, which a logarithmic axis cannot show.
pub(crate) fn positive(
    place: &str,
    values: impl IntoIterator<Item = f64>,
) -> Result<(), ReportError> {
    match values.into_iter().enumerate().find(|(_, v)| *v <= 0.0) {
        None => Ok(()),
        Some((index, value)) => Err(ReportError::NotPositive {
            place: place.to_owned(),
            index,
            value,
        }),
    }
}

/// An error if a list has `found` entries and not `expected`.
pub(crate) fn same_length(place: &str, expected: usize, found: usize) -> Result<(), ReportError> {
    if expected == found {
        return Ok(());
    }
    Err(ReportError::LengthMismatch {
        place: place.to_owned(),
        expected,
        found,
    })
}

/// An error unless there are no labels or one per point.
pub(crate) fn labels(place: &str, points: usize, labels: &[String]) -> Result<(), ReportError> {
    if labels.is_empty() {
        return Ok(());
    }
    same_length(place, points, labels.len())
}

/// An error for an empty part.
pub(crate) fn not_empty(place: &str, length: usize) -> Result<(), ReportError> {
    if length > 0 {
        return Ok(());
    }
    Err(ReportError::Empty {
        place: place.to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finite_names_index_and_value() {
        let found = finite("q", &[0.0, 1.0, f64::INFINITY]);
        assert_eq!(
            found,
            Err(ReportError::NotFinite {
                place: "q".into(),
                index: 2,
                value: f64::INFINITY
            })
        );
        assert!(finite("q", &[f64::NAN]).is_err());
        assert!(finite_points("p", &[[0.0, 0.0], [0.0, f64::NAN]]).is_err());
        assert!(finite_points("p", &[[0.0, 0.0], [0.0, 1.0]]).is_ok());
    }

    #[test]
    fn positive_refuses_zero() {
        assert!(positive("x", [1.0, 0.0]).is_err());
        assert!(positive("x", [1.0, 1e-300]).is_ok());
    }
}
