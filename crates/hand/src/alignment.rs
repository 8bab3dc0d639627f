//! The rigid motion that brings points nearest to others.

use grasp::Contact;
use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};

/// Depth below a contact of the second point, which represents its normal, metres.
pub(crate) const DEPTH: f64 = 0.03;

/// The motion with the least sum of squared distances of `motion * from` and `to` (Kabsch 1976).
pub(crate) fn align(pairs: &[(Point3<f64>, Point3<f64>)]) -> Isometry3<f64> {
    let count = pairs.len().max(1) as f64;
    let from = pairs.iter().map(|p| p.0.coords).sum::<Vector3<f64>>() / count;
    let to = pairs.iter().map(|p| p.1.coords).sum::<Vector3<f64>>() / count;
    let mut covariance = Matrix3::zeros();
    for (p, q) in pairs {
        covariance += (q.coords - to) * (p.coords - from).transpose();
    }
    // With a NaN in the input the iteration would not end.
    let svd = covariance.try_svd(true, true, f64::EPSILON, 200);
    let rotation = match svd.map(|svd| (svd.u, svd.v_t)) {
        Some((Some(u), Some(v_t))) => {
            let mut signs = Matrix3::identity();
            signs[(2, 2)] = (u * v_t).determinant().signum();
            u * signs * v_t
        }
        _ => Matrix3::identity(),
    };
    let rotation =
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
    Isometry3::from_parts(Translation3::from(to - rotation * from), rotation)
}

/// A contact and the point below it. A motion that fits both also fits the normal.
pub(crate) fn contact_points(contact: &Contact) -> [Point3<f64>; 2] {
    let below = contact.position + contact.inward_normal.into_inner() * DEPTH;
    [contact.position, below]
}

/// The pose of a hand after the rigid motion that brings its contacts `from` on one object nearest
/// to the contacts `to` on another.
///
/// Contacts correspond by index, and each includes its normal. Contacts without a partner are
/// ignored.
pub fn carried_pose(
    object_from_palm: &Isometry3<f64>,
    from: &[Contact],
    to: &[Contact],
) -> Isometry3<f64> {
    let pairs: Vec<_> = from
        .iter()
        .zip(to)
        .flat_map(|(a, b)| {
            let ([a, below_a], [b, below_b]) = (contact_points(a), contact_points(b));
            [(a, b), (below_a, below_b)]
        })
        .collect();
    align(&pairs) * object_from_palm
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitVector3;

    #[test]
    fn a_motion_of_contacts_moves_the_hand_along() {
        let motion = Isometry3::new(Vector3::new(0.1, -0.2, 0.05), Vector3::new(0.3, 2.0, -1.0));
        let contact = |x: f64, y: f64| Contact {
            position: Point3::new(x, y, 0.02 * x),
            inward_normal: UnitVector3::new_normalize(Vector3::new(-x, -y, 0.01)),
        };
        let from = [
            contact(0.03, 0.0),
            contact(-0.02, 0.03),
            contact(-0.02, -0.04),
        ];
        let to = from.map(|c| Contact {
            position: motion * c.position,
            inward_normal: motion * c.inward_normal,
        });
        let palm = Isometry3::new(Vector3::new(0.0, 0.1, 0.2), Vector3::new(1.0, 0.0, 0.5));
        let moved = carried_pose(&palm, &from, &to);
        assert!((moved.to_matrix() - (motion * palm).to_matrix()).norm() <= 1e-12);
        // No rigid motion maps contacts onto their mirror image; the result is a rotation even so.
        let mirrored = from.map(|c| Contact {
            position: Point3::new(c.position.x, c.position.y, -c.position.z - 0.01),
            inward_normal: c.inward_normal,
        });
        let moved = carried_pose(&Isometry3::identity(), &from, &mirrored);
        assert!((moved.rotation.to_rotation_matrix().matrix().determinant() - 1.0).abs() <= 1e-9);
    }
}
