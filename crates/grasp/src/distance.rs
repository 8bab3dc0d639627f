//! The distance of two grasps in contact space.

use crate::contact::Grasp;
use thiserror::Error;

/// d(g, g′) = max(|c_i − c′_i|, |n_i − n′_i|, |z − z′|) over all contacts i (paper, Sec. III-C).
///
/// Contacts are compared in their order; lengths and normals enter with the same weight, so the
/// number depends on the unit of length.
pub fn distance(a: &Grasp, b: &Grasp) -> Result<f64, ContactCounts> {
    if a.contacts.len() != b.contacts.len() {
        return Err(ContactCounts {
            first: a.contacts.len(),
            second: b.contacts.len(),
        });
    }
    let centre = (a.centre - b.centre).norm();
    Ok(a.contacts
        .iter()
        .zip(&b.contacts)
        .map(|(p, q)| {
            let positions = (p.position - q.position).norm();
            let normals = (p.inward_normal.into_inner() - q.inward_normal.into_inner()).norm();
            positions.max(normals)
        })
        .fold(centre, f64::max))
}

/// Grasps of different numbers of contacts have no distance.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("grasps of {first} and {second} contacts have no distance")]
pub struct ContactCounts {
    /// The contacts of the first grasp.
    pub first: usize,
    /// The contacts of the second grasp.
    pub second: usize,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Contact;
    use nalgebra::{Point3, Vector3};

    #[test]
    fn takes_the_largest_part() {
        let contact = |x| Contact {
            position: Point3::new(x, 0.0, 0.0),
            inward_normal: Vector3::x_axis(),
        };
        let a = Grasp::new(vec![contact(0.0), contact(1.0)], Point3::origin()).unwrap();
        let mut b = a.clone();
        assert_eq!(distance(&a, &b), Ok(0.0));
        b.contacts[1].position.y = 0.25;
        assert_eq!(distance(&a, &b), Ok(0.25));
        b.contacts[0].inward_normal = Vector3::y_axis();
        assert_eq!(distance(&a, &b), Ok(2.0_f64.sqrt()));
        b.centre.z = -3.0;
        assert_eq!(distance(&a, &b), Ok(3.0));
        b.contacts.push(contact(2.0));
        let error = ContactCounts {
            first: 2,
            second: 3,
        };
        assert_eq!(distance(&a, &b), Err(error));
    }
}
