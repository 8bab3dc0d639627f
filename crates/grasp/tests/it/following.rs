//! A workspace that follows a moving grasp answers as a new one does.

use crate::common::{anywhere, around, generator, in_ball, unit};
use grasp::{
    ActiveFacet, Contact, ContactModel, Edges, GraspModel, Workspace, epsilon, margin,
    near_active_facets,
};
use nalgebra::{Point3, Unit};
use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;

/// All contacts, or one of them, moved and turned by up to `size`.
fn moved(
    contacts: &[Contact],
    which: Option<usize>,
    size: f64,
    rng: &mut ChaCha8Rng,
) -> Vec<Contact> {
    let chosen = |i: usize| which.is_none_or(|k| k % contacts.len() == i);
    let step = |(i, c): (usize, &Contact)| {
        if !chosen(i) {
            return *c;
        }
        Contact {
            position: c.position + in_ball(rng) * size,
            inward_normal: Unit::new_normalize(c.inward_normal.into_inner() + in_ball(rng) * size),
        }
    };
    contacts.iter().enumerate().map(step).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn walks_give_the_same_intervals(
        seed in 0_u64..10_000,
        count in 3_usize..6,
        edges in 3_usize..12,
        power in 0_i32..9,
        soft in any::<bool>(),
    ) {
        let mut rng = generator(seed);
        let convention = unit(0.9, Edges::Polygon(edges));
        let finger = ContactModel::Soft { friction: 0.9, torsion: 0.2 };
        let contact_models = vec![finger; if soft { count } else { 0 }];
        let mut contacts = around(&mut rng, count, 1.0);
        let (mut following, mut anew) = (Workspace::with_warm_start(), Workspace::new());
        let mut facets: [Vec<ActiveFacet>; 2] = Default::default();
        for step in 0..40 {
            // Large steps and small ones in turn, as of an ascent with differences.
            let small = step % 3 > 0;
            let size = if small { 10.0_f64.powi(-power) } else { 0.03 };
            contacts = moved(&contacts, small.then_some(step), size, &mut rng);
            if step % 13 == 12 {
                contacts = anywhere(&mut rng, count);
            }
            let model = GraspModel { contacts: &contacts, centre: &Point3::origin(), convention: &convention, contact_models: &contact_models };
            let a = epsilon(&model, &mut following).unwrap();
            let b = epsilon(&model, &mut anew).unwrap();
            prop_assert_eq!(a.closed, b.closed);
            prop_assert!((a.lower - b.lower).abs() <= 1e-11 && (a.upper - b.upper).abs() <= 1e-11, "{a:?} {b:?}");
            let (a, b) = (margin(&model, &mut following).unwrap(), margin(&model, &mut anew).unwrap());
            prop_assert!((a.value - b.value).abs() <= 1e-11);
            if step % 4 == 0 {
                near_active_facets(&model, 0.05, &mut following, &mut facets[0]).unwrap();
                near_active_facets(&model, 0.05, &mut anew, &mut facets[1]).unwrap();
                same_planes(&facets[0], &facets[1])?;
                same_planes(&facets[1], &facets[0])?;
            }
        }
    }
}

/// Every plane of the first list that can be nearest is in the second: its foot lies in its facet.
fn same_planes(a: &[ActiveFacet], b: &[ActiveFacet]) -> Result<(), TestCaseError> {
    let level = a.first().map_or(0.0, |f| f.offset) + 0.05 - 1e-9;
    let own = |f: &&ActiveFacet| f.carriers().iter().all(|c| c.weight >= 1e-6);
    for facet in a.iter().filter(own).filter(|f| f.offset < level) {
        let found = b.iter().any(|other| {
            (other.offset - facet.offset).abs() <= 1e-9
                && (other.normal - facet.normal).norm() <= 1e-6
        });
        prop_assert!(found, "{} is not among {}", facet.offset, b.len());
    }
    Ok(())
}

#[test]
fn differences_cost_a_fraction_of_a_new_search() {
    let mut rng = generator(5);
    let convention = unit(0.9, Edges::Polygon(10));
    let (mut made, mut anew) = (0, 0);
    let mut following = Workspace::with_warm_start();
    let mut plain = Workspace::new();
    for _ in 0..30 {
        let contacts = around(&mut rng, 3, 1.0);
        for (step, workspace) in (0..7).flat_map(|s| [(s, true), (s, false)]) {
            let near = moved(&contacts, Some(step), 1e-5, &mut rng);
            let model = GraspModel {
                contacts: &near,
                centre: &Point3::origin(),
                convention: &convention,
                contact_models: &[],
            };
            if workspace {
                let before = following.facets_made();
                epsilon(&model, &mut following).unwrap();
                let after = following.facets_made();
                // A new search counts from nothing.
                made += if after >= before && step > 0 {
                    after - before
                } else {
                    after
                };
            } else {
                epsilon(&model, &mut plain).unwrap();
                anew += plain.facets_made();
            }
        }
    }
    assert!(3 * made <= anew, "{made} facets against {anew}");
}
