//! The option for the contact model.

use hand::TipModel;

/// A contact model and its size in metres.
pub(super) fn contact_option(text: &str) -> Result<TipModel, String> {
    let radius = |text: &str| {
        let radius = text.parse::<f64>().ok();
        radius
            .filter(|r| r.is_finite() && *r > 0.0)
            .ok_or_else(|| format!("`{text}` is not a radius; expected metres above 0"))
    };
    match text.split_once(':') {
        None if text == "point" => Ok(TipModel::Point),
        Some(("soft", size)) => radius(size).map(|radius| TipModel::Soft { radius }),
        Some(("patch", size)) => radius(size).map(|radius| TipModel::Patch { radius }),
        _ => Err("expected `point`, `soft:RADIUS` or `patch:RADIUS`".to_owned()),
    }
}
