//! Whether a cloud shows both sides of its object, or a single sheet around which a wrap makes a thin shell.

use nalgebra::{Point3, UnitVector3};
use rayon::prelude::*;
use sphere_map::{Tree, Wrap};

use crate::voxel_grid::{VoxelGrid, median};

/// A wall that is thicker than so many spacings has an inside; behind it no point is expected.
const THICKEST: f64 = 8.0;
/// The points of a wall are looked for within so many spacings of its normal.
const AROUND: f64 = 2.5;
/// A point belongs to the other side of a wall if it is deeper than this share of the thickness,
const DEEP: f64 = 0.5;
/// and it belongs to the wall if it is at most so many thicknesses away along the normal.
const FARTHEST: f64 = 2.0;
/// Share of the points of a wall that have to be on its other side.
const BACKED: f64 = 0.2;

/// The thin walls of a wrapped cloud.
///
/// A wrap is closed by construction. Around half a sphere it is a shell with two sides, and the points of
/// the only side that was seen lie between them. A wall that was scanned from both sides, as that of a
/// bowl, has points on either. Where the noise is as large as the wall is thick, nothing tells the two
/// apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Walls {
    /// Share of the points, 0 to 1, at walls thinner than eight spacings.
    pub thin_share: f64,
    /// Median thickness of these walls, metres; 0 where there are none.
    pub median_thickness_m: f64,
    /// The same in spacings of the points.
    pub in_spacings: f64,
    /// Share of the points, 0 to 1, at thin walls without points on the other side: near 1 for the scan
    /// of one side of an object, near 0 for a complete one.
    pub single_sheet_share: f64,
}

impl Walls {
    /// Measures the walls of a wrap at the points that it was made from.
    ///
    /// Costs a line through the tree and a search in a grid per point, on all threads of the pool.
    pub(crate) fn new(points: &[Point3<f64>], wrap: &Wrap, tree: &Tree) -> Self {
        let (around, thickest) = (AROUND * wrap.spacing, THICKEST * wrap.spacing);
        let side = around.hypot(thickest).max(f64::MIN_POSITIVE);
        let grid = VoxelGrid::new(points, side);
        let walls: Vec<(f64, bool)> = points
            .par_iter()
            .zip(&wrap.normals)
            .filter_map(|(x, normal)| {
                let wall = thickness(x, normal, tree, thickest)?;
                Some((wall, backed(x, normal, wall, &grid, around)))
            })
            .collect();
        let share = |count: usize| count as f64 / points.len().max(1) as f64;
        let thickness = median(walls.iter().map(|(wall, _)| *wall).collect());
        Self {
            thin_share: share(walls.len()),
            median_thickness_m: thickness,
            in_spacings: thickness / wrap.spacing,
            single_sheet_share: share(walls.iter().filter(|(_, backed)| !backed).count()),
        }
    }
}

/// Thickness of the wall of the wrap at a point, along the outward normal there; `None` where it is
/// thicker than `most`.
fn thickness(x: &Point3<f64>, normal: &UnitVector3<f64>, tree: &Tree, most: f64) -> Option<f64> {
    let met = tree.along_line(x, normal, most);
    let sides = |outer: bool| met.iter().filter(move |m| m.1 == outer).map(|m| m.0);
    let outer = sides(true).min_by(|a, b| a.abs().total_cmp(&b.abs()))?;
    let inner = sides(false).filter(|t| *t < outer).max_by(f64::total_cmp)?;
    Some(outer - inner)
}

/// Whether enough of the points around the normal lie on the other side of a wall.
fn backed(
    x: &Point3<f64>,
    normal: &UnitVector3<f64>,
    thickness: f64,
    grid: &VoxelGrid,
    around: f64,
) -> bool {
    let (mut all, mut deep) = (0_u32, 0_u32);
    let middle = x - normal.into_inner() * (0.5 * thickness);
    for (i, _) in grid.within(&middle, around.hypot(thickness)) {
        let arm = grid.point(i) - x;
        let depth = -arm.dot(normal);
        let lateral = arm.norm_squared() - depth * depth;
        if lateral <= around * around && depth.abs() <= FARTHEST * thickness {
            all += 1;
            deep += u32::from(depth >= DEEP * thickness);
        }
    }
    f64::from(deep) >= BACKED * f64::from(all)
}
