//! Faces of a region that lie on the surface.

use glam::IVec3;
use iso_expr::BoxKernel;

use super::cells::enclose;
use crate::{Region, Workspace};

/// A face is cut into so many patches along each of its sides.
const PATCHES: i32 = 8;

/// A face is taken to be thicker than it is, by this part of the region's length and of how far it is from zero: whole waves end at multiples of
/// π, which are no doubles.
const NEAR: f64 = 1.0 / (1_u64 << 40) as f64;

/// F counts as zero all over a face where it is so many times less than near by.
const NOTHING: f64 = 1.0 / (1_u64 << 20) as f64;

/// A side of a region that lies on the surface is moved out by this part of the region's length.
const ASIDE: f64 = 1.0 / 64.0;

impl Region {
    /// The region, a little larger where whole faces lie on the surface, as on planes at the end of a wave. Rays would begin right on the
    /// surface there, and could not be told from those that touch it.
    pub(super) fn off_the_surface(self, kernel: &dyn BoxKernel, workspace: &mut Workspace) -> Self {
        let mut found = self;
        let aside = ASIDE * self.extent();
        for axis in 0..3 {
            let mut lies_on_it = |at: f64, inside: f64| {
                let (face, size) = self.patches((axis, at), kernel, workspace);
                if 2 * face < (PATCHES * PATCHES) as usize {
                    return false;
                }
                // The surface may pass through many patches of any face, but then it does so near by as well.
                let (inside, size_inside) = self.patches((axis, inside), kernel, workspace);
                2 * inside <= face || size < NOTHING * size_inside
            };
            let (min, max, aside) = (self.min[axis], self.max[axis], aside[axis]);
            if lies_on_it(min, min + aside) {
                found.min[axis] = min - aside;
            }
            if lies_on_it(max, max - aside) {
                found.max[axis] = max + aside;
            }
        }
        found
    }

    /// How many patches of a plane across an axis may hold the surface, and how far from zero F may be on them.
    fn patches(
        &self,
        (axis, at): (usize, f64),
        kernel: &dyn BoxKernel,
        workspace: &mut Workspace,
    ) -> (usize, f64) {
        let near = NEAR * (at.abs() + self.extent()[axis]);
        let patches = (0..PATCHES * PATCHES).map(|number| {
            let mut patch = IVec3::ZERO;
            (patch[(axis + 1) % 3], patch[(axis + 2) % 3]) = (number / PATCHES, number % PATCHES);
            let (mut lo, mut hi) = self.cell(patch, PATCHES);
            (lo[axis], hi[axis]) = (at - near, at + near);
            (lo, hi)
        });
        let found = enclose(kernel, workspace, patches);
        let of_patches = (0..found.len()).map(|patch| found.interval(0, patch));
        let size = of_patches.clone().fold(0.0, |size: f64, of| size.max(-of.lo).max(of.hi));
        (of_patches.filter(|of| of.contains_zero()).count(), size)
    }
}
