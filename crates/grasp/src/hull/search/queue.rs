//! The facets of a large polytope by their bounds, without a look at all of them.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::hull::polytope::Polytope;

/// A facet with the bound that it had when it was put in line.
#[derive(Clone, Copy, Debug)]
struct Entry {
    key: f64,
    facet: u32,
}

impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Entry {}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Entry {
    /// The least key is the greatest entry.
    fn cmp(&self, other: &Self) -> Ordering {
        let keys = other.key.total_cmp(&self.key);
        keys.then(other.facet.cmp(&self.facet))
    }
}

/// Entries whose facet has gone or has another bound by now are passed over.
#[derive(Clone, Debug, Default)]
pub(super) struct Queue(BinaryHeap<Entry>);

impl Queue {
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    pub(super) fn put(&mut self, polytope: &Polytope, facets: &[u32]) {
        let entry = |&facet: &u32| Entry {
            key: polytope.keys[facet as usize],
            facet,
        };
        self.0.extend(facets.iter().map(entry));
    }

    /// The facet with the least bound, which stays in line.
    pub(super) fn nearest(&mut self, polytope: &Polytope) -> Option<usize> {
        while let Some(entry) = self.0.peek() {
            let at = entry.facet as usize;
            if polytope.keys[at].total_cmp(&entry.key).is_eq() && entry.key < f64::INFINITY {
                return Some(at);
            }
            self.0.pop();
        }
        None
    }
}
