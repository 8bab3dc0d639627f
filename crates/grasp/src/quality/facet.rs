//! The facets of the hull that decide a quality.

use crate::hull::cap::MOST_PARTS;
use crate::hull::plane::V6;
use crate::wrench::Wrench;

/// A wrench on a facet of the hull, and its share in the facet's point nearest to the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carrier {
    /// The contact whose cone it belongs to.
    pub contact: usize,
    /// The wrench.
    pub wrench: Wrench,
    /// Its barycentric coordinate λ; all of a facet's sum to one.
    pub weight: f64,
}

/// A facet of the hull: normal·w ≤ offset for every wrench w, with equality for its carriers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActiveFacet {
    /// The distance of its plane from the origin, negative when the origin lies beyond it.
    pub offset: f64,
    /// The outward unit normal: the wrench direction in which the grasp is that weak.
    pub normal: Wrench,
    carriers: [Carrier; ActiveFacet::MOST],
    count: usize,
}

impl ActiveFacet {
    /// The most wrenches that carry a facet: six vertices, a corral of seven, or every contact of a
    /// touching face.
    pub(crate) const MOST: usize = MOST_PARTS;

    /// The wrenches that carry it; Σ weight·wrench = offset·normal.
    pub fn carriers(&self) -> &[Carrier] {
        &self.carriers[..self.count]
    }

    pub(crate) fn new(
        offset: f64,
        normal: &V6,
        carriers: impl IntoIterator<Item = (usize, V6, f64)>,
    ) -> ActiveFacet {
        let mut facet = ActiveFacet {
            offset,
            normal: (*normal).into(),
            carriers: [Carrier {
                contact: 0,
                wrench: Wrench::zeros(),
                weight: 0.0,
            }; ActiveFacet::MOST],
            count: 0,
        };
        for (slot, (contact, wrench, weight)) in facet.carriers.iter_mut().zip(carriers) {
            *slot = Carrier {
                contact,
                wrench: wrench.into(),
                weight,
            };
            facet.count += 1;
        }
        facet
    }
}
