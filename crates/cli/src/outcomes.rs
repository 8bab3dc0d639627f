//! The outcomes of hand poses, in words.

use hand::{Geometry, Hand, OutcomeCounts, Rejection, TipModel};

/// "96 of 200 poses give a stable grasp; 60 tip did not arrive, …".
pub(crate) fn sentence(outcomes: &OutcomeCounts) -> String {
    let mut parts: Vec<String> = reasons(outcomes)
        .iter()
        .filter(|(_, count)| *count > 0)
        .map(|(reason, count)| format!("{count} {}", reason.replace('_', " ")))
        .collect();
    if parts.is_empty() {
        parts.push("none rejected".to_owned());
    }
    format!(
        "{} of {} hand poses give a stable grasp ({})",
        outcomes.stable,
        outcomes.total(),
        parts.join(", ")
    )
}

/// The number of poses without a stable grasp, by reason, including reasons that did not occur.
pub(crate) fn reasons(outcomes: &OutcomeCounts) -> Vec<(&'static str, usize)> {
    let unstable = std::iter::once(("unstable", outcomes.unstable));
    outcomes.by_reason().into_iter().chain(unstable).collect()
}

/// Why no pose gave a stable grasp: the most frequent reason, its place, and what to try.
pub(crate) fn why_none(outcomes: &OutcomeCounts, hand: &Hand, tips: TipModel) -> String {
    let counts = reasons(outcomes);
    let Some((reason, count)) = counts.iter().max_by_key(|(_, count)| *count) else {
        return "no pose was tried".to_owned();
    };
    let advice = match *reason {
        "below_support" => {
            "the object may lie too low for the hand, or stand on no plane (--support none) or on another one (--support A,B,C,D)"
        }
        "obstacle" => {
            "other pieces of the scene are in the way of the hand; --scene off takes all points for the object"
        }
        "in_scan" => {
            "the fitted surface lies inside the scan there, by more than the noise; a fit of a higher degree (--degree) or `--model spherical` may describe it better"
        }
        "base_near_object" | "part_near_object" | "starts_in_object" => {
            "the object may be too large for the hand, or the least stand-off (standoff_m of the TOML) too small"
        }
        "tip_did_not_arrive"
            if hand.fingers().len() > 2 && hand.least_fingers() == hand.fingers().len() =>
        {
            "every finger must touch, since the TOML does not say otherwise (least_fingers = 2 or more accepts fewer); or the object may be too small or too thin for the hand, or the stand-off (standoff_m of the TOML) too large"
        }
        "tip_did_not_arrive" | "no_contact" => {
            "the object may be too small or too thin for the hand, or the stand-off (standoff_m of the TOML) too large"
        }
        "parts_near_each_other" => "the object may be too small for all fingers at once",
        _ if hand.fingers().len() < 3 && tips == TipModel::Point => {
            "two hard point contacts can never resist a torque about the line between them, so no grasp of this hand is force-closed, whatever the friction; it needs soft fingers (--contact soft:RADIUS), a third finger, or --power, where every link that touches is a contact"
        }
        _ => "more friction (--friction) or a smaller --least-quality may help",
    };
    let of_reason = outcomes
        .rejected
        .iter()
        .filter(|(r, _)| r.reason() == *reason);
    let most = of_reason.max_by_key(|(_, count)| **count);
    let place = most.map_or(String::new(), |(r, count)| {
        format!(", {count} times because {}", r.describe(hand))
    });
    let hull = most.and_then(|(r, _)| filling_hull(hand, r));
    format!(
        "{count} of {} poses ended as {}{place}; {}",
        outcomes.total(),
        reason.replace('_', " "),
        hull.unwrap_or_else(|| advice.to_owned())
    )
}

/// A note for a link that came too near and consists of meshes: their convex hulls may be the
/// cause.
fn filling_hull(hand: &Hand, rejection: &Rejection) -> Option<String> {
    let (Rejection::BaseNearObject { link } | Rejection::PartNearObject { link }) = rejection
    else {
        return None;
    };
    let link = &hand.model().links()[*link];
    let hull = link
        .geometry
        .iter()
        .find_map(|piece| match &piece.geometry {
            Geometry::Hull { file, .. } => Some(file),
            _ => None,
        })?;
    Some(format!(
        "the convex hull of the mesh '{hull}' stands in for '{}' and fills its hollows, perhaps the space where the object would be: split the mesh into convex parts, or use boxes and cylinders; or the object is too large for the hand, or the least stand-off (standoff_m of the TOML) too small",
        link.name
    ))
}
