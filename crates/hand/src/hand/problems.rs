//! All faults of a spec; [`Hand::new`] stops at the first one.

use super::groups::groups;
use super::resolve::{
    approach, bad_number, find_driven, find_link, finger, fingers, least_fingers, link_shapes,
    pad_radius, palm, preshapes, separate, standoff,
};
use super::{Hand, HandError};
use crate::collision::LinkShape;
use crate::hand_spec::{FingerSpec, HandSpec, PreshapeSpec};
use crate::model::HandModel;

impl Hand {
    /// All faults that keep a spec from matching a model, in the order of the spec. Empty if and
    /// only if [`Hand::new`] succeeds.
    pub fn problems(model: &HandModel, spec: &HandSpec) -> Vec<HandError> {
        let mut found = Vec::new();
        let part = palm(model, spec).map_err(|e| found.push(e));
        let model = &part.unwrap_or_else(|()| model.clone());
        found.extend(approach(spec).err());
        found.extend(standoff(spec.standoff_m).err());
        for name in spec.self_distance.exempt_pairs.iter().flatten() {
            found.extend(find_link(model, "exempt_pairs", name).err());
        }
        found.extend(least_fingers(spec).err());
        found.extend(pad_radius(spec).err());
        match link_shapes(model) {
            Ok(shapes) => found.extend(finger_problems(model, &shapes, spec)),
            Err(broken) => found.push(broken),
        }
        found.extend(preshape_problems(model, &spec.preshape));
        found
    }
}

fn finger_problems(model: &HandModel, shapes: &[LinkShape], spec: &HandSpec) -> Vec<HandError> {
    let mut found = Vec::new();
    for spec in &spec.finger {
        let names = finger_names(model, spec);
        if names.is_empty() {
            found.extend(finger(model, shapes, spec).err());
        }
        found.extend(names);
    }
    if found.is_empty() {
        let together = fingers(model, shapes, &spec.finger).and_then(|mut fingers| {
            groups(model, shapes, spec, &mut fingers)?;
            separate(model, &fingers)
        });
        found.extend(together.err());
    }
    found
}

/// Faults in the names and numbers of one finger.
fn finger_names(model: &HandModel, spec: &FingerSpec) -> Vec<HandError> {
    let place = format!("finger '{}'", spec.name);
    let links = spec.tips.iter().map(|name| find_link(model, &place, name));
    let mut found: Vec<HandError> = links.filter_map(Result::err).collect();
    for (name, &ratio) in &spec.closing {
        found.extend(find_driven(model, &place, name).err());
        if !(ratio.is_finite() && ratio != 0.0) {
            found.push(bad_number(&place, ratio, "a closing ratio other than 0"));
        }
    }
    found
}

fn preshape_problems(model: &HandModel, specs: &[PreshapeSpec]) -> Vec<HandError> {
    let mut found = Vec::new();
    for spec in specs {
        for (joint, &value) in &spec.joints {
            let one = PreshapeSpec {
                name: spec.name.clone(),
                joints: [(joint.clone(), value)].into(),
            };
            found.extend(preshapes(model, &[one]).err());
        }
    }
    if found.is_empty() {
        found.extend(preshapes(model, specs).err());
    }
    found
}
