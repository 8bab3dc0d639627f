//! The rigid bodies of a hand, where its fingers part, and which links make each finger.

use crate::collision::LinkShape;
use crate::model::{Drive, HandModel, JointKind};

/// Links joined by joints that do not move count as one body; bodies are numbered, parents first.
pub(super) struct Bodies {
    /// The links of each body, the one that carries the others first.
    pub(super) links: Vec<Vec<usize>>,
    /// The joint that moves each body; none for the root.
    joint: Vec<Option<usize>>,
    parent: Vec<Option<usize>>,
    /// Whether the body or one that it carries has collision geometry.
    useful: Vec<bool>,
}

/// One finger: the bodies at its end, the longest first, and the joints that move them alone.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    pub(super) ends: Vec<usize>,
    /// Joints from the palm outwards to the first of the ends.
    pub(super) path: Vec<usize>,
}

/// Whether a joint moves its child at all.
fn moves(model: &HandModel, joint: usize) -> bool {
    let joint = &model.joints[joint];
    let driven = match joint.drive {
        Drive::Fixed => false,
        Drive::Driven(_) => joint.limits.0 < joint.limits.1,
        Drive::Mimic { multiplier, .. } => multiplier != 0.0,
    };
    driven && joint.kind != JointKind::Fixed
}

impl Bodies {
    pub(super) fn new(model: &HandModel) -> Self {
        let mut of_link = vec![0; model.links.len()];
        let mut bodies = Bodies {
            links: vec![vec![0]],
            joint: vec![None],
            parent: vec![None],
            useful: Vec::new(),
        };
        for link in 1..model.links.len() {
            let Some(joint) = model.links[link].parent_joint else {
                continue;
            };
            let carrier = of_link[model.joints[joint].parent];
            if moves(model, joint) {
                of_link[link] = bodies.links.len();
                bodies.links.push(vec![link]);
                bodies.joint.push(Some(joint));
                bodies.parent.push(Some(carrier));
            } else {
                of_link[link] = carrier;
                bodies.links[carrier].push(link);
            }
        }
        let solid = |links: &Vec<usize>| links.iter().any(|&l| !model.links[l].geometry.is_empty());
        bodies.useful = bodies.links.iter().map(solid).collect();
        for body in (1..bodies.links.len()).rev() {
            if let Some(parent) = bodies.parent[body] {
                bodies.useful[parent] |= bodies.useful[body];
            }
        }
        bodies
    }

    fn children(&self, body: usize) -> Vec<usize> {
        let of_body = |b: &usize| self.useful[*b] && self.parent[*b] == Some(body);
        (0..self.links.len()).filter(of_body).collect()
    }

    /// The link on which the fingers hang: the first link of the body where all ways part.
    pub(super) fn palm(&self) -> usize {
        let mut body = 0;
        loop {
            match self.children(body)[..] {
                [only] if !self.children(only).is_empty() => body = only,
                _ => return self.links[body][0],
            }
        }
    }

    /// The joints that move a body, from the root outwards.
    fn way(&self, body: usize) -> Vec<usize> {
        let up = std::iter::successors(Some(body), |&b| self.parent[b]);
        let mut way: Vec<usize> = up.filter_map(|b| self.joint[b]).collect();
        way.reverse();
        way
    }

    /// The fingers that hang on the root; `length` says how far a body reaches from the joint that
    /// carries another.
    pub(super) fn chains(&self, length: &dyn Fn(usize, &[usize]) -> f64) -> Vec<Chain> {
        let ends: Vec<Vec<usize>> = self
            .children(0)
            .into_iter()
            .flat_map(|child| self.ends(child, length))
            .collect();
        let ways: Vec<Vec<usize>> = ends.iter().map(|e| self.way(e[0])).collect();
        let shared = |k: usize, joint: &usize| {
            let mut others = ways.iter().enumerate().filter(|(other, _)| *other != k);
            others.any(|(_, way)| way.contains(joint))
        };
        let path = |k: usize| {
            let own = ways[k].iter().copied().filter(|j| !shared(k, j));
            own.collect()
        };
        ends.iter()
            .enumerate()
            .map(|(k, ends)| Chain {
                ends: ends.clone(),
                path: path(k),
            })
            .collect()
    }

    /// The ends of the fingers that a body carries.
    ///
    /// Where a finger forks into parts that move by one joint each, these are bars of a linkage or
    /// halves of a tip; parts with two or more joints are fingers of their own.
    fn ends(&self, body: usize, length: &dyn Fn(usize, &[usize]) -> f64) -> Vec<Vec<usize>> {
        let children = self.children(body);
        match children[..] {
            [] => return vec![vec![body]],
            [only] => return self.ends(only, length),
            _ => {}
        }
        let (stubs, long): (Vec<usize>, Vec<usize>) = children
            .into_iter()
            .partition(|&c| self.children(c).is_empty());
        if !long.is_empty() {
            return long
                .into_iter()
                .flat_map(|c| self.ends(c, length))
                .collect();
        }
        let from = self.joint[body].unwrap_or_default();
        let mut ends: Vec<(f64, usize)> = stubs
            .into_iter()
            .map(|c| (length(from, &self.links[c]), c))
            .collect();
        ends.sort_by(|a, b| b.0.total_cmp(&a.0));
        let longest = ends[0].0;
        let near = ends.iter().filter(|(l, _)| *l >= longest - SAME_LENGTH);
        vec![near.map(|(_, c)| *c).collect()]
    }

    /// The links of a body that have geometry.
    pub(super) fn solid_links(&self, body: usize, shapes: &[LinkShape]) -> Vec<usize> {
        let links = self.links[body].iter().copied();
        links.filter(|&l| !shapes[l].is_empty()).collect()
    }
}

/// Parts of a forked tip that end this near to each other belong together, metres.
const SAME_LENGTH: f64 = 0.01;
