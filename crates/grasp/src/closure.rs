//! Force closure by a linear programme, independent of any hull.

use crate::grasp_model::GraspModel;
use crate::quality::min_weight_of;
use crate::wrench::{Wrench, WrenchError};
use crate::wrenches::wrenches;
use nalgebra::DMatrix;

/// A singular value below this part of the largest counts as zero.
const RANK_TOLERANCE: f64 = 1e-9;
/// A smallest weight (times the number of wrenches) below this counts as zero.
const WEIGHT_TOLERANCE: f64 = 1e-9;

/// Whether the grasp resists every small wrench: the origin lies strictly inside Conv{w_ij}.
///
/// The wrenches must span R⁶ and be balanced by weights that are all positive, the largest
/// smallest of which a linear programme finds. Grasps whose epsilon quality is below about 1e-8 of
/// the longest wrench may be called either way.
pub fn force_closed(model: &GraspModel<'_>) -> Result<bool, WrenchError> {
    Ok(wrenches_force_closed(&wrenches(model)?))
}

/// The same for a plain list of wrenches.
pub fn wrenches_force_closed(wrenches: &[Wrench]) -> bool {
    spans(wrenches) && min_weight_of(wrenches).is_some_and(|w| w > WEIGHT_TOLERANCE)
}

fn spans(wrenches: &[Wrench]) -> bool {
    if wrenches.len() < 7 {
        return false;
    }
    let matrix = DMatrix::from_fn(6, wrenches.len(), |i, j| wrenches[j][i]);
    let values = matrix.singular_values();
    values[5] > RANK_TOLERANCE * values[0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Contact;
    use crate::convention::Convention;
    use nalgebra::{Point3, Vector3};

    fn ring(count: usize) -> Vec<Contact> {
        (0..count)
            .map(|i| {
                let a = std::f64::consts::TAU * i as f64 / count as f64;
                let p = Vector3::new(a.cos(), a.sin(), 0.0);
                Contact {
                    position: p.into(),
                    inward_normal: nalgebra::Unit::new_normalize(-p),
                }
            })
            .collect()
    }

    #[test]
    fn three_contacts_close_and_two_do_not() {
        let convention = Convention::unit();
        let centre = Point3::origin();
        let closed = |c: &[Contact]| force_closed(&GraspModel::new(c, &centre, &convention));
        assert_eq!(closed(&ring(3)), Ok(true));
        // Two points cannot resist a torque about the line through them.
        assert_eq!(closed(&ring(2)), Ok(false));
        let mut same_side = ring(3);
        same_side[1] = same_side[0];
        same_side[2] = same_side[0];
        assert_eq!(closed(&same_side), Ok(false));
    }
}
