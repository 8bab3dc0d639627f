//! Library entries: the surface of an object and its best grasps at a least separation.

use grasp::Contact;
use nalgebra::Point3;
use record::LibraryEntry;

use crate::grasp::{Grasp, Grasps};
use crate::object::Object;
use crate::records::library_grasp;

/// Which grasps of an object a library keeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kept {
    /// Largest number of grasps.
    pub grasps: usize,
    /// Least separation of any two grasps ([`separation`]).
    pub separation: f64,
}

impl Default for Kept {
    /// Twelve grasps with a separation of a quarter of the object's mean radius.
    fn default() -> Self {
        Self {
            grasps: 12,
            separation: 0.25,
        }
    }
}

impl Object {
    /// The library entry of this object: its surface, and the best of the ranked grasps that have a
    /// hand.
    ///
    /// `id` is a short identifier; `name` is for display. `None` if the surface is a map of the sphere,
    /// which a library does not hold.
    pub fn library_entry(
        &self,
        id: &str,
        name: &str,
        ranked: &Grasps,
        kept: &Kept,
    ) -> Option<LibraryEntry> {
        let radius = self.shape().radial()?.mean_radius();
        let spread = spread_out(ranked, radius, kept);
        Some(LibraryEntry {
            id: id.to_owned(),
            name: name.to_owned(),
            shape: self.to_record()?,
            grasps: spread.into_iter().filter_map(library_grasp).collect(),
        })
    }
}

/// The first grasps of a ranked list, without those closer than the least separation to an earlier
/// one.
fn spread_out<'a>(ranked: &'a Grasps, radius: f64, kept: &Kept) -> Vec<&'a Grasp> {
    let mut chosen: Vec<&Grasp> = Vec::with_capacity(kept.grasps);
    for grasp in ranked.iter() {
        if chosen.len() == kept.grasps {
            break;
        }
        let near = |other: &&Grasp| {
            separation(grasp.contacts(), other.contacts(), radius)
                .is_some_and(|d| d < kept.separation)
        };
        if !chosen.iter().any(near) {
            chosen.push(grasp);
        }
    }
    chosen
}

/// The least d(g, g′) of Sec. III-C over all orders of the contacts, with lengths divided by
/// `radius`; `None` for different numbers of contacts.
///
/// Grasps that differ only in the order of the fingers apply the same wrenches to the object.
pub fn separation(a: &[Contact], b: &[Contact], radius: f64) -> Option<f64> {
    let scaled = |order: &mut dyn Iterator<Item = &Contact>| grasp::Grasp {
        contacts: order
            .map(|c| Contact {
                position: c.position / radius,
                ..*c
            })
            .collect(),
        centre: Point3::origin(),
    };
    let first = scaled(&mut a.iter());
    let distances = orders(b.len())
        .into_iter()
        .map(|order| grasp::distance(&first, &scaled(&mut order.iter().map(|&k| &b[k]))))
        .collect::<Result<Vec<f64>, _>>()
        .ok()?;
    distances.into_iter().min_by(f64::total_cmp)
}

/// All permutations of 0 … count−1.
fn orders(count: usize) -> Vec<Vec<usize>> {
    let mut all = vec![Vec::new()];
    for last in 0..count {
        all = all
            .into_iter()
            .flat_map(|order: Vec<usize>| {
                (0..=order.len()).map(move |place| {
                    let mut longer = order.clone();
                    longer.insert(place, last);
                    longer
                })
            })
            .collect();
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{UnitVector3, Vector3};

    fn contact(x: f64, y: f64) -> Contact {
        let position = Point3::new(x, y, 0.01);
        Contact {
            position,
            inward_normal: UnitVector3::new_normalize(-position.coords),
        }
    }

    #[test]
    fn the_order_of_fingers_and_the_unit_of_length_do_not_matter() {
        let a = [
            contact(0.03, 0.0),
            contact(0.0, 0.04),
            contact(-0.03, -0.01),
        ];
        let turned = [a[2], a[0], a[1]];
        assert_eq!(separation(&a, &turned, 0.04), Some(0.0));
        let mut moved = a;
        moved[1].position.z += 0.02;
        assert!((separation(&a, &moved, 0.04).unwrap() - 0.5).abs() <= 1e-12);
        assert_eq!(separation(&a, &a[..2], 0.04), None);
        let mut tilted = a;
        tilted[0].inward_normal = Vector3::z_axis();
        assert!(separation(&a, &tilted, 0.04).unwrap() > 1.0);
    }

    #[test]
    fn there_are_six_orders_of_three() {
        let mut all = orders(3);
        all.sort();
        all.dedup();
        assert_eq!(all.len(), 6);
        assert_eq!(orders(0), [Vec::<usize>::new()]);
    }
}
