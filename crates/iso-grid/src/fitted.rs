//! A region for a surface of which nothing is known but its formula.

mod cells;
mod faces;
mod facing;
mod sphere;

use std::f64::consts::TAU;
use std::ops::Range;

use glam::{DVec3, IVec3};
use iso_expr::{BoxKernel, CompileError, Decorated, Interval, Program};

use crate::{Kernel, Region, RegionError, Surface, Workspace};
use cells::{BEFORE, enclose};
pub use facing::Facing;
pub use sphere::Sphere;

/// Half the sides of the cubes around the origin in which the surface is looked for, one after the other.
const HALF_SIDES: [f64; 5] = [2.0, 8.0, 32.0, 128.0, 512.0];

/// All of these cubes are larger where the first one would hold fewer waves of a sine or cosine than this.
const WAVES: f64 = 2.0;

/// Long waves make cubes no larger than so many times: what hardly changes there is likely to matter little.
const SLOWEST: f64 = 32.0;

/// Half the sides of those in which it is looked for if nothing is found in the [first ones](HALF_SIDES), or if it is cut off in the last of them.
const FARTHER: [f64; 6] = [2048.0, 8192.0, 32_768.0, 131_072.0, 524_288.0, 2_097_152.0];

/// The cells of a cube along each axis that lie in its inner half.
const INNER_HALF: Range<i32> = 4..12;

/// A region is cut anew as long as that draws its longest side in to less than this part.
const WORTHWHILE: f64 = 0.9;

/// How often a region is cut anew at most: a single point could be closed in on until no double lies between the sides.
const ROUNDS: usize = 12;

/// A region that was drawn around a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fitted {
    /// The region.
    pub region: Region,
    /// Whether the surface certainly has points outside of it.
    pub goes_on: bool,
    /// Whether the surface may reach a face of the cube in which it was found, as far as intervals tell: where nothing is certain outside, it may
    /// go on all the same.
    pub is_cut_off: bool,
    /// A sphere around the points at which F − C is found to change its sign in the region, if any are. What the surface reaches beyond is thin or
    /// small; at poles the sign changes, too.
    pub sphere: Option<Sphere>,
    /// Which way the surface faces there.
    pub facing: Option<Facing>,
}

/// What may be seen of the surface in a cube.
struct Glimpse {
    /// The box around it.
    held: Region,
    /// On how many axes it may meet faces of the cube.
    axes_met: usize,
    /// Whether it is cut off, and nothing of it is in the cube's inner half.
    is_scrap: bool,
}

impl Glimpse {
    /// Lower where more of the surface is to be expected.
    fn rank(&self) -> (bool, usize) {
        (self.is_scrap, self.axes_met)
    }
}

/// A region that was chosen, and not drawn around anything.
impl From<Region> for Fitted {
    fn from(region: Region) -> Self {
        Self { region, goes_on: false, is_cut_off: false, sphere: None, facing: None }
    }
}

impl Fitted {
    /// The middle of what is to be seen: that of the sphere, or else of the region.
    pub fn center(&self) -> DVec3 {
        self.sphere.map_or(self.region.center(), |sphere| sphere.center)
    }

    /// The least region that holds both, of surfaces that may be different ones. If it is larger than one of the two, what goes on outside of
    /// that may lie in it.
    ///
    /// # Errors
    /// When its extent overflows, which that of regions found [around](Fitted::around) surfaces does not.
    pub fn hull(&self, other: &Self) -> Result<Self, RegionError> {
        let region = self.region.hull(&other.region)?;
        let is_both = self.region == region && other.region == region;
        // Where nothing is found there is nothing to look at.
        let sphere = match (self.sphere, other.sphere) {
            (Some(sphere), Some(other)) => Some(sphere.hull(&other)),
            (one, other) => one.or(other),
        };
        let facing = match (self.facing, other.facing) {
            (Some(facing), Some(other)) => Some(facing.hull(&other)),
            (one, other) => one.or(other),
        };
        Ok(Self {
            region,
            goes_on: is_both && self.goes_on && other.goes_on,
            is_cut_off: is_both && (self.is_cut_off || other.is_cut_off),
            sphere,
            facing,
        })
    }

    /// A region close around the surface, or around a part of it near the origin.
    ///
    /// The surface is looked for in growing cubes around the origin, in cells that intervals cannot prove empty. The
    /// region is drawn around it in the first cube whose faces it does not meet, or in a larger one if that is proven to hold more of it
    /// and its faces are not met either. If there is none, that cube is taken where it meets the faces of the fewest axes, and
    /// [`Region::standard`] where nothing is found at all. Inside the cube that was taken nothing of the surface is left out,
    /// and faces that lie on it are moved out a little. It is looked for up to 512 from the origin, or up to 2²¹ if it is nowhere nearer, and one
    /// cube farther than the one that is taken; of surfaces with long waves the cubes are larger, so that the first one holds two.
    ///
    /// When the surface's [`Stop`](crate::Stop) is requested, any region.
    ///
    /// # Errors
    /// When the engine cannot compile the surface.
    pub fn around(surface: &Surface, workspace: &mut Workspace) -> Result<Self, CompileError> {
        let surface = surface.by_signs();
        let kernel = &**surface.over_boxes(Kernel::ValueEnclosures)?;
        let is_stopped = || surface.stop().is_requested();
        let mut best: Option<(usize, Glimpse)> = None;
        let mut goes_on = false;
        let scale = scale(surface.program());
        for (number, half_side) in HALF_SIDES.into_iter().chain(FARTHER).enumerate() {
            let is_enough = |(taken, _): &(usize, Glimpse)| number >= HALF_SIDES.len().max(taken + 2);
            if is_stopped() || best.as_ref().is_some_and(is_enough) {
                break;
            }
            let cube = cube(scale * half_side);
            let mut cells = cube.open_cells(kernel, workspace);
            let Some(found) = cube.glimpse(&cells, kernel, workspace) else { continue };
            let Some((taken, known)) = &best else {
                best = Some((number, found));
                continue;
            };
            let is_whole = known.axes_met == 0;
            let is_better = if is_whole { found.axes_met == 0 } else { found.rank() < known.rank() };
            let mut has_more = || {
                cells.retain(|cell| cell.to_array().iter().any(|along| !BEFORE.contains(along)));
                cube.is_crossed(std::mem::take(&mut cells), (kernel, &is_stopped), workspace)
            };
            if is_better && (!is_whole || has_more()) {
                (best, goes_on) = (Some((number, found)), false);
            } else if !is_better && !goes_on && (is_whole || number == taken + 1) {
                // What is cut off mostly goes on in the next cube, and farther out less is seen.
                goes_on = has_more();
            }
        }
        let Some((_, Glimpse { held, axes_met, .. })) = best else {
            return Ok(Self { goes_on, ..Region::standard().into() });
        };
        let (outer, cells, mut region) = held.closed_in((kernel, &is_stopped), workspace);
        if axes_met > 0 {
            region = region.off_the_surface(kernel, workspace);
        }
        let (sphere, facing) = outer.crossings(cells, (kernel, &is_stopped), workspace);
        Ok(Self { region, goes_on, is_cut_off: axes_met > 0, sphere, facing })
    }
}

impl Region {
    /// The cube from −2 to 2, which shows something of most surfaces that go on for ever.
    pub fn standard() -> Self {
        cube(HALF_SIDES[0])
    }

    /// The box around the surface in this one, as close as cells tell, behind the last one that was cut into cells and those of them that may
    /// hold the surface.
    fn closed_in(
        self,
        (kernel, is_stopped): (&dyn BoxKernel, &dyn Fn() -> bool),
        workspace: &mut Workspace,
    ) -> (Self, Vec<IVec3>, Self) {
        let (mut outer, mut inner) = (self, self);
        let mut cells = Vec::new();
        for _ in 0..ROUNDS {
            outer = inner;
            cells = outer.open_cells(kernel, workspace);
            let Some(closer) = outer.around(&cells).filter(|_| !is_stopped()) else { break };
            inner = closer;
            if inner.extent().max_element() > WORTHWHILE * outer.extent().max_element() {
                break;
            }
        }
        (outer, cells, inner)
    }

    /// F − C over the region.
    ///
    /// # Errors
    /// When the engine cannot compile the surface.
    pub fn enclosure(&self, surface: &Surface, workspace: &mut Workspace) -> Result<Decorated, CompileError> {
        let corners = std::iter::once((self.min, self.max));
        Ok(enclose(&**surface.over_boxes(Kernel::ValueEnclosures)?, workspace, corners).decorated(0, 0))
    }

    /// Whether some of the surface may be in the region; if not, that is proven.
    ///
    /// # Errors
    /// When the engine cannot compile the surface.
    pub fn may_hold(&self, surface: &Surface, workspace: &mut Workspace) -> Result<bool, CompileError> {
        Ok(!self.open_cells(&**surface.by_signs().over_boxes(Kernel::ValueEnclosures)?, workspace).is_empty())
    }

    /// What may be seen in cells of this cube.
    fn glimpse(&self, cells: &[IVec3], kernel: &dyn BoxKernel, workspace: &mut Workspace) -> Option<Glimpse> {
        let held = self.around(cells)?;
        let axes_met = self.axes_met(cells, kernel, workspace);
        let is_inner = |cell: &IVec3| cell.to_array().iter().all(|along| INNER_HALF.contains(along));
        Some(Glimpse { held, axes_met, is_scrap: axes_met > 0 && !cells.iter().any(is_inner) })
    }
}

/// How many times larger than usual a cube must be to show some waves of a program.
fn scale(program: &Program) -> f64 {
    let side = Interval { lo: -HALF_SIDES[0], hi: HALF_SIDES[0] };
    let scales = program.phases([side; 3]).map(|phase| WAVES * TAU / phase);
    scales.filter(|scale| *scale <= SLOWEST).fold(1.0, f64::max)
}

fn cube(half_side: f64) -> Region {
    Region { min: DVec3::splat(-half_side), max: DVec3::splat(half_side) }
}

#[cfg(test)]
mod tests;
