//! A warm workspace answers without touching the heap.

use crate::common::{anywhere, around, generator, unit};
use grasp::{
    ActiveFacet, Contact, Edges, FrameRule, Gradient, GraspModel, Workspace, epsilon, epsilon_linf,
    facet_gradient, margin, near_active_facets,
};
use nalgebra::Point3;
use testkit::{CountingAllocator, allocations};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

struct Scratch {
    workspace: Workspace,
    facets: Vec<ActiveFacet>,
    gradient: Gradient,
}

fn pass(grasps: &[Vec<Contact>], edges: Edges, scratch: &mut Scratch) {
    let convention = unit(0.8, edges);
    for contacts in grasps {
        let model = GraspModel {
            contacts,
            centre: &Point3::origin(),
            convention: &convention,
            contact_models: &[],
        };
        let workspace = &mut scratch.workspace;
        epsilon(&model, workspace).unwrap();
        epsilon_linf(&model, workspace).unwrap();
        let found = margin(&model, workspace).unwrap();
        facet_gradient(
            &model,
            &found.facet,
            FrameRule::Tangent,
            &mut scratch.gradient,
        )
        .unwrap();
        near_active_facets(&model, 1e-3, workspace, &mut scratch.facets).unwrap();
    }
}

#[test]
fn no_allocation_after_the_first_pass() {
    let mut rng = generator(30);
    let mut grasps: Vec<Vec<Contact>> = (0..30).map(|_| around(&mut rng, 4, 1.0)).collect();
    grasps.extend((0..30).map(|_| anywhere(&mut rng, 3)));
    let mut scratch = Scratch {
        workspace: Workspace::new(),
        facets: Vec::new(),
        gradient: Gradient::default(),
    };
    for edges in [Edges::Polygon(8), Edges::Round { tolerance: 1e-2 }] {
        pass(&grasps, edges, &mut scratch);
        let before = allocations();
        pass(&grasps, edges, &mut scratch);
        let inside = allocations() - before;
        // The name of the convention that `pass` itself makes.
        let convention = allocations();
        drop(unit(0.8, edges));
        let own = allocations() - convention;
        assert_eq!(inside, own);
    }
}
