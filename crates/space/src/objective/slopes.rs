//! Linear models of the epsilon quality as a function of the contacts' directions.

use grasp::{Edges, Margin, QualityError};
use shape::Surface;
use sph::Direction;

use super::{FACETS, Objective, band};
use crate::quality::{LinearPieces, Quality, in_frame};

/// The epsilon quality, or minus the distance from closure for an open grasp. Slopes follow from
/// the chain rule dQ = Σᵢ (df(pᵢ)ᵀ ∂Q/∂cᵢ + dn(pᵢ)ᵀ ∂Q/∂nᵢ) · uᵢ for every near-active facet.
///
/// An objective may only be used on the surface that it was resolved on.
impl<S: Surface> Quality<S> for Objective {
    fn value(&mut self, surface: &S, directions: &[Direction]) -> Result<f64, QualityError> {
        self.margin_at(surface, directions)
            .map(|margin| margin.value)
    }

    fn linearise(
        &mut self,
        surface: &S,
        directions: &[Direction],
        pieces: &mut LinearPieces,
    ) -> Result<(), QualityError> {
        pieces.reset(directions.len());
        let margin = self.differentiate(surface, directions)?;
        let Self {
            evaluator,
            pyramids,
            realised,
            facets,
            ..
        } = self;
        facets.clear();
        let mut floor = margin.value;
        if !margin.closed {
            facets.push(margin.facet);
        } else if let Some(pyramids) = pyramids {
            let centre = evaluator.resolved.centre();
            floor = pyramids.near_facets(&realised.contacts, &centre, facets)?;
            let deciding = pieces.push(0.0);
            realised.chain(&evaluator.resolved, directions, &margin.facet, deciding)?;
        } else {
            evaluator.near_active_facets(&realised.contacts, band(margin.value), facets)?;
        }
        for facet in facets.iter().take(FACETS) {
            let piece = pieces.push(facet.offset - floor);
            realised.chain(&evaluator.resolved, directions, facet, piece)?;
        }
        Ok(())
    }

    fn slope(
        &mut self,
        surface: &S,
        directions: &[Direction],
        slope: &mut [f64],
    ) -> Result<(), QualityError> {
        let margin = self.differentiate(surface, directions)?;
        let resolved = &self.evaluator.resolved;
        self.realised
            .chain(resolved, directions, &margin.facet, slope)
    }

    fn discontinuities(
        &mut self,
        surface: &S,
        side: &[Direction],
        directions: &[Direction],
        out: &mut LinearPieces,
    ) {
        out.reset(directions.len());
        if !matches!(self.convention().edges, Edges::Polygon(_)) {
            return;
        }
        let rule = self.convention().tangent;
        for (i, (s, p)) in side.iter().zip(directions).enumerate() {
            let at = surface.differential(p);
            let side = if s == p {
                at.inward_normal
            } else {
                surface.contact(s).1
            };
            for (slack, by_normal) in rule.discontinuities(&side, &at.inward_normal) {
                let slope = in_frame(p, &(at.normal_slope.transpose() * by_normal));
                out.push(slack)[2 * i..2 * i + 2].copy_from_slice(&slope);
            }
        }
    }

    fn forget(&mut self) {
        Objective::forget(self);
    }

    fn evaluations(&self) -> usize {
        self.evaluator.evaluations
    }

    fn stable_above(&self) -> f64 {
        self.convention().stable_above
    }
}

impl Objective {
    fn margin_at(
        &mut self,
        surface: &impl Surface,
        directions: &[Direction],
    ) -> Result<Margin, QualityError> {
        self.realised.place(surface, directions);
        self.last = None;
        let margin = self.evaluator.margin(&self.realised.contacts)?;
        self.last = Some(margin);
        self.at.clear();
        self.at.extend_from_slice(directions);
        Ok(margin)
    }

    /// Computes the margin at the directions and the derivatives of the contacts there.
    fn differentiate(
        &mut self,
        surface: &impl Surface,
        directions: &[Direction],
    ) -> Result<Margin, QualityError> {
        let margin = match self.last {
            Some(margin) if self.at == directions => margin,
            _ => self.margin_at(surface, directions)?,
        };
        self.realised.differentiate(surface, directions);
        Ok(margin)
    }
}
