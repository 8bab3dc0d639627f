//! What proves the two ends of an interval of epsilon quality.

use super::epsilon::{Epsilon, QualityError, epsilon};
use super::workspace::Workspace;
use crate::grasp_model::GraspModel;
use crate::hull::cap::Part;
use crate::wrench::Wrench;

/// A proof of an interval [lower, upper] of epsilon quality, to be checked without the search.
///
/// **Upper end.** h(`direction`) ≤ `upper`, where h(u) = max w·u over all wrenches of the grasp.
///
/// **Lower end.** The `facets` are 5-simplices over `vertices`, each a wrench of the grasp, or a point
/// −M c far beyond the half-space c·u ≥ 0 of one of the `domain`'s vectors c. Every five
/// vertices of a facet are shared by an even number of facets, so they form a closed surface; a ray from
/// the origin crosses it an odd number of times; and every facet has a positive least height (of its
/// vertices along its unit normal). Then every ray from the origin meets a facet. Let h(u) < `lower` for
/// a unit vector u, and let the ray along u meet a facet of normal n and least height f: it does so
/// within h(u), so n·u > f/`lower`. Hence no such u exists if for every facet one of these is true:
///
/// - f ≥ `lower`;
/// - all directions within arccos(f/`lower`) of n lie in one of the `caps`, in which h ≥ `lower`;
/// - all of them have c·u < 0 for one of the `domain`'s vectors c. The grasp then has symmetries, and
///   every u has an image under them with c·u ≥ 0 for all c.
///
/// The points −M c belong to no wrench; but they raise h in no direction with c·u ≥ 0, and in the others
/// h is that of an image.
///
/// Rounding errors of the wrenches and heights are within `rounding`, which is left off both ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// The proved lower end.
    pub lower: f64,
    /// The proved upper end.
    pub upper: f64,
    /// The unit vector along which the wrenches reach only `upper` far.
    pub direction: Wrench,
    /// Wrenches of the grasp, and points beyond the domain.
    pub vertices: Vec<Wrench>,
    /// The closed surface around the origin; empty where `lower` is 0.
    pub facets: Vec<CertificateFacet>,
    /// Caps of directions in which h is proved to be `lower` or more.
    pub caps: Vec<CertificateCap>,
    /// Unit vectors c of the half-spaces c·u ≥ 0 to which the symmetries reduce all directions.
    pub domain: Vec<Wrench>,
    /// What rounding may have added to a height, or symmetries that hold only nearly.
    pub rounding: f64,
}

/// A simplex of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CertificateFacet {
    /// Places of its six vertices in the certificate's list.
    pub vertices: [usize; 6],
    /// The outward unit normal.
    pub normal: Wrench,
}

/// A cap of directions around the face that the ball touches.
///
/// p_i = base_i + A_i m_i are points of the wrenches' ellipsoids, λ_i their weights, and Σ λ_i p_i is a
/// multiple of the direction; the module `cone::cap` of the source proves h ≥ `lower` from these.
#[derive(Clone, Debug, PartialEq)]
pub struct CertificateCap {
    /// The centre, a unit vector.
    pub direction: Wrench,
    /// The angle between the centre and the rim.
    pub angle: f64,
    /// (contact, λ, m): the points that touch.
    pub points: Vec<(usize, f64, [f64; 3])>,
}

/// The epsilon quality with its proof. Costs a copy of the search's polytope more than [`epsilon`].
///
/// The certificate's lower end may be lower than that of the quality, which is the best of several
/// attempts where one was not enough.
pub fn epsilon_with_certificate(
    model: &GraspModel<'_>,
    workspace: &mut Workspace,
) -> Result<(Epsilon, Certificate), QualityError> {
    workspace.forget();
    let found = epsilon(model, workspace)?;
    let (proved, slack) = if found.closed {
        workspace.proved()
    } else {
        (0.0, workspace.rounding())
    };
    let mut certificate = Certificate {
        lower: (proved - slack).clamp(0.0, found.lower),
        upper: found.upper,
        direction: found.direction,
        vertices: Vec::new(),
        facets: Vec::new(),
        caps: Vec::new(),
        domain: Vec::new(),
        rounding: slack,
    };
    if certificate.lower > 0.0 {
        workspace.copy_proof(&mut certificate);
    }
    Ok((found, certificate))
}

impl Workspace {
    /// What the polytope of the last search proves, and what is to be taken off for rounding.
    fn proved(&mut self) -> (f64, f64) {
        let symmetric = self.search.symmetry_error();
        let rounding = self.rounding() + symmetric;
        (self.search.polytope.proved(), rounding)
    }

    fn copy_proof(&self, out: &mut Certificate) {
        let polytope = &self.search.polytope;
        out.vertices = polytope.vertices.iter().map(|&v| v.into()).collect();
        out.facets = polytope
            .alive()
            .map(|f| CertificateFacet {
                vertices: polytope.facets[f].vertices.map(usize::from),
                normal: polytope.facets[f].plane.normal.into(),
            })
            .collect();
        out.domain = self.search.domain.iter().map(|&c| c.into()).collect();
        for cap in self.search.caps.iter().filter(|cap| cap.angle > 0.0) {
            let point = |part: &Part| {
                let contact = self.cones[part.cone].contact as usize;
                (contact, part.weight, part.place)
            };
            out.caps.push(CertificateCap {
                direction: cap.touching.direction.into(),
                angle: cap.angle,
                points: cap.touching.parts().iter().map(point).collect(),
            });
        }
    }
}
