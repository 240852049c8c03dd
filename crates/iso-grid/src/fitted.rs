//! A region for a surface of which nothing is known but its formula.

mod sphere;

use std::ops::Range;

use glam::{DVec3, IVec3};
use iso_expr::{BoxKernel, CompileError, Decorated, Decoration, Interval};

use crate::batch::BoxBatch;
use crate::{Kernel, Region, Surface, Workspace};
pub use sphere::Sphere;

/// Half the sides of the cubes around the origin in which the surface is looked for, one after the other.
const HALF_SIDES: [f64; 5] = [2.0, 8.0, 32.0, 128.0, 512.0];

/// Those in which it is looked for if nothing is found in them, or if it is cut off in the last of them.
const FARTHER: [f64; 6] = [2048.0, 8192.0, 32_768.0, 131_072.0, 524_288.0, 2_097_152.0];

/// Cells of a cube along each axis that lie in the cube before it.
const BEFORE: Range<i32> = 6..10;

/// Those that lie in its inner half.
const INNER_HALF: Range<i32> = 4..12;

/// Cells that may hold the surface are cut in halves this often to prove that they do,
const HALVINGS_TO_PROVE: u32 = 3;

/// as long as there are no more of them; of more, some are looked at.
const MOST_TO_PROVE: usize = 300;

/// A region is cut in halves this often along each axis: 16 cells.
const HALVINGS: u32 = 4;

/// A region is cut anew as long as that draws its longest side in to less than this part,
const WORTHWHILE: f64 = 0.9;

/// but no more often than this: a single point could be closed in on until no double lies between the sides.
const ROUNDS: usize = 12;

/// No side is drawn closer than this part of the longest one, so that flat surfaces keep some space around them.
const THINNEST: f64 = 0.25;

/// A region that was drawn around a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fitted {
    /// The region.
    pub region: Region,
    /// Whether the surface certainly has points outside of it.
    pub goes_on: bool,
    /// A sphere around the points at which F − C is found to change its sign in the region, if any are. What the surface reaches beyond is thin or
    /// small; at poles the sign changes, too.
    pub sphere: Option<Sphere>,
}

/// What may be seen of the surface in a cube.
struct Glimpse {
    /// The box around it.
    held: Region,
    /// On how many axes it meets faces of the cube.
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
        Self { region, goes_on: false, sphere: None }
    }
}

impl Fitted {
    /// The middle of what is to be seen: that of the sphere, or else of the region.
    pub fn center(&self) -> DVec3 {
        self.sphere.map_or(self.region.center(), |sphere| sphere.center)
    }

    /// The least region that holds both, of surfaces that may be different ones. If it is larger than one of the two, what goes on outside of
    /// that may lie in it.
    pub fn hull(&self, other: &Self) -> Self {
        let region = self
            .region
            .hull(&other.region)
            .expect("regions that are fitted are no farther than 2²¹ from the origin");
        let is_both = self.region == region && other.region == region;
        // Where nothing is found there is nothing to look at.
        let sphere = match (self.sphere, other.sphere) {
            (Some(sphere), Some(other)) => Some(sphere.hull(&other)),
            (one, other) => one.or(other),
        };
        Self { region, goes_on: is_both && self.goes_on && other.goes_on, sphere }
    }

    /// A region close around the surface, or around a part of it near the origin.
    ///
    /// The surface is looked for in growing cubes around the origin, in cells that intervals cannot prove empty. The
    /// region is drawn around it in the first cube whose faces it does not meet, or in a larger one if that is proven to hold more of it
    /// and its faces are not met either. If there is none, that cube is taken where it meets the faces of the fewest axes, and
    /// [`Region::standard`] where nothing is found at all. Inside the cube that was taken nothing of the surface is left out. It is looked
    /// for up to 512 from the origin, or up to 2²¹ if it is nowhere nearer, and one cube farther than the one that is taken.
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
        for (number, half_side) in HALF_SIDES.into_iter().chain(FARTHER).enumerate() {
            let is_enough = |(taken, _): &(usize, Glimpse)| number >= HALF_SIDES.len().max(taken + 2);
            if is_stopped() || best.as_ref().is_some_and(is_enough) {
                break;
            }
            let cube = cube(half_side);
            let mut cells = cube.open_cells(kernel, workspace);
            let Some(found) = cube.glimpse(&cells) else { continue };
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
        let Some((_, Glimpse { held, .. })) = best else {
            return Ok(Self { region: Region::standard(), goes_on, sphere: None });
        };
        let (outer, cells, region) = held.closed_in((kernel, &is_stopped), workspace);
        let sphere = outer.sphere_around_surface(cells, (kernel, &is_stopped), workspace);
        Ok(Self { region, goes_on, sphere })
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

    /// The cells, sixteen along each axis, that may hold the surface.
    fn open_cells(&self, kernel: &dyn BoxKernel, workspace: &mut Workspace) -> Vec<IVec3> {
        (1..=HALVINGS).fold(vec![IVec3::ZERO], |cells, depth| {
            self.not_empty(halved(&cells), 1 << depth, kernel, workspace)
        })
    }

    /// The box around some of sixteen cells along each axis, but not too thin; `None` when there are none.
    fn around(&self, cells: &[IVec3]) -> Option<Self> {
        let first = cells.iter().copied().reduce(IVec3::min)?;
        let last = cells.iter().copied().reduce(IVec3::max)?;
        let (min, max) = (self.corner(first, 1 << HALVINGS), self.corner(last + 1, 1 << HALVINGS));
        let spare = 0.5 * (DVec3::splat(THINNEST * (max - min).max_element()) - (max - min)).max(DVec3::ZERO);
        Some(Self { min: (min - spare).max(self.min), max: (max + spare).min(self.max) })
    }

    /// What may be seen in cells of this cube.
    fn glimpse(&self, cells: &[IVec3]) -> Option<Glimpse> {
        let held = self.around(cells)?;
        let is_met = |&axis: &usize| held.min[axis] == self.min[axis] || held.max[axis] == self.max[axis];
        let axes_met = (0..3).filter(is_met).count();
        let is_inner = |cell: &IVec3| cell.to_array().iter().all(|along| INNER_HALF.contains(along));
        Some(Glimpse { held, axes_met, is_scrap: axes_met > 0 && !cells.iter().any(is_inner) })
    }

    /// Whether the surface is found to have points in some of sixteen cells along each axis. If there are few, they are halved to find out.
    fn is_crossed(
        &self,
        mut cells: Vec<IVec3>,
        (kernel, is_stopped): (&dyn BoxKernel, &dyn Fn() -> bool),
        workspace: &mut Workspace,
    ) -> bool {
        for depth in HALVINGS..=HALVINGS + HALVINGS_TO_PROVE {
            if depth > HALVINGS {
                cells = self.not_empty(halved(&cells), 1 << depth, kernel, workspace);
            }
            let step = cells.len().div_ceil(MOST_TO_PROVE).max(1);
            // Not always the same one of each few, for cells lie in rows.
            let some: Vec<_> =
                cells.chunks(step).enumerate().map(|(number, few)| few[number % few.len()]).collect();
            if some.chunks(64).any(|cells| self.holds_points(cells, 1 << depth, kernel, workspace)) {
                return true;
            }
            if cells.len() > MOST_TO_PROVE || is_stopped() {
                return false;
            }
        }
        false
    }

    /// Whether F, continuous on one of `cells`, of which `count` fill the region along each axis, has both signs at its corners, or is zero
    /// at one that is not in the cube before.
    fn holds_points(
        &self,
        cells: &[IVec3],
        count: i32,
        kernel: &dyn BoxKernel,
        workspace: &mut Workspace,
    ) -> bool {
        let boxes = cells.iter().flat_map(|&cell| {
            let corner = move |octant: IVec3| self.corner(cell + octant, count);
            let corners = OCTANTS.map(|octant| (corner(octant), corner(octant)));
            std::iter::once(self.cell(cell, count)).chain(corners)
        });
        let found = enclose(kernel, workspace, boxes);
        let places = (0..found.len()).step_by(1 + OCTANTS.len());
        places.zip(cells).any(|(place, cell)| {
            let corners = OCTANTS.into_iter().zip(place + 1..);
            let mut corners = corners.map(|(octant, corner)| (*cell + octant, found.interval(0, corner)));
            found.decorated(0, place).decoration >= Decoration::Continuous
                && (corners.clone().any(|(_, value)| value.hi < 0.0)
                    && corners.clone().any(|(_, value)| value.lo > 0.0)
                    || corners.any(|(corner, value)| {
                        value == Interval::point(0.0) && !is_in_cube_before(corner, count)
                    }))
        })
    }

    /// Those of `cells`, of which `count` fill the region along each axis, that may hold the surface.
    fn not_empty(
        &self,
        mut cells: Vec<IVec3>,
        count: i32,
        kernel: &dyn BoxKernel,
        workspace: &mut Workspace,
    ) -> Vec<IVec3> {
        let found = enclose(kernel, workspace, cells.iter().map(|&cell| self.cell(cell, count)));
        let mut may_hold = (0..found.len()).map(|cell| found.interval(0, cell).contains_zero());
        cells.retain(|_| may_hold.next() == Some(true));
        cells
    }

    /// The corners of a cell.
    fn cell(&self, cell: IVec3, count: i32) -> (DVec3, DVec3) {
        (self.corner(cell, count), self.corner(cell + 1, count))
    }

    /// The corner of a cell next to the region's least corner.
    fn corner(&self, cell: IVec3, count: i32) -> DVec3 {
        let part = cell.as_dvec3() / f64::from(count);
        // Written so that the outermost corners are the region's, exactly.
        self.min * (1.0 - part) + self.max * part
    }
}

const OCTANTS: [IVec3; 8] = [
    IVec3::new(0, 0, 0),
    IVec3::new(1, 0, 0),
    IVec3::new(0, 1, 0),
    IVec3::new(1, 1, 0),
    IVec3::new(0, 0, 1),
    IVec3::new(1, 0, 1),
    IVec3::new(0, 1, 1),
    IVec3::new(1, 1, 1),
];

/// The eight cells that each cell is cut into.
fn halved(cells: &[IVec3]) -> Vec<IVec3> {
    cells.iter().flat_map(|cell| OCTANTS.map(|octant| 2 * cell + octant)).collect()
}

/// Encloses F over boxes with these corners.
fn enclose<'w>(
    kernel: &dyn BoxKernel,
    workspace: &'w mut Workspace,
    boxes: impl Iterator<Item = (DVec3, DVec3)> + Clone,
) -> &'w BoxBatch {
    let Workspace { boxes: batch, scratch, counters, .. } = workspace;
    batch.replace(boxes);
    batch.evaluate(kernel, scratch, 1);
    counters.box_evaluations += batch.len() as u64;
    batch
}

/// Whether a corner of cells, of which `count` fill a cube along each axis, lies in the cube before it, or on its faces.
fn is_in_cube_before(corner: IVec3, count: i32) -> bool {
    let halves = count >> HALVINGS;
    let before = halves * BEFORE.start..=halves * BEFORE.end;
    corner.to_array().iter().all(|along| before.contains(along))
}

fn cube(half_side: f64) -> Region {
    Region { min: DVec3::splat(-half_side), max: DVec3::splat(half_side) }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use iso_expr::{Ast, Interpreter};

    use super::*;

    fn surface(formula: &str) -> Surface {
        let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
        Surface::new(Arc::new(Interpreter), program)
    }

    fn around(formula: &str) -> Fitted {
        Fitted::around(&surface(formula), &mut Workspace::default()).unwrap()
    }

    fn fitted(formula: &str) -> Region {
        around(formula).region
    }

    /// The region holds the box from `min` to `max`, and is no more than a tenth of its longest side larger.
    fn assert_close(formula: &str, min: DVec3, max: DVec3) {
        let region = fitted(formula);
        let slack = 0.1 * (max - min).max_element();
        assert!(
            (min - region.min()).min_element() >= 0.0 && (region.max() - max).min_element() >= 0.0,
            "{region:?}"
        );
        assert!((min - region.min()).max_element() <= slack, "{formula}: {region:?}");
        assert!((region.max() - max).max_element() <= slack, "{formula}: {region:?}");
    }

    #[test]
    fn bounded_surfaces_of_any_size_are_framed() {
        for radius in [1e-3, 0.1, 1.0, 1.999, 2.0, 3.0, 100.0, 500.0] {
            let formula = format!("x^2 + y^2 + z^2 = {}", radius * radius);
            assert_close(&formula, DVec3::splat(-radius), DVec3::splat(radius));
        }
        let ellipsoid = "(x - 5)^2 + (y/2)^2 + (z + 1)^2 = 1";
        assert_close(ellipsoid, DVec3::new(4.0, -2.0, -2.0), DVec3::new(6.0, 2.0, 0.0));
    }

    #[test]
    fn parts_apart_from_each_other_are_framed_together() {
        let two = "min(x^2 + y^2 + z^2 - 1, (x - 10)^2 + y^2 + z^2 - 1)";
        assert_close(two, DVec3::splat(-1.0), DVec3::new(11.0, 1.0, 1.0));
        let small = "(x^2 + y^2 + z^2 - 1)*((x - 3)^2 + y^2 + z^2 - 0.25)";
        assert_close(small, DVec3::splat(-1.0), DVec3::new(3.5, 1.0, 1.0));
        assert!(!around(two).goes_on && !around(small).goes_on);
    }

    #[test]
    fn a_surface_that_goes_on_elsewhere_is_said_to() {
        let oval = around("y^2 + z^2 = x*(x - 1)*(x - 5)");
        assert!(oval.goes_on && oval.region.max().x < 1.2, "{oval:?}");
        let through_corners = ["z", "x = 1", "x = y", "x - y = 1", "max(x, y)"];
        let others = ["sin(x) = cos(y) + sin(z)", "x^2 + y^2 = 9", "z = x*y", "x = 10"];
        for formula in others.into_iter().chain(through_corners) {
            assert!(around(formula).goes_on, "{formula}");
        }
        for formula in [
            "x^2 + y^2 + z^2 = 1",
            "x^2 + y^2 + z^2 = 4",
            "max(abs(x), abs(y), abs(z)) = 2",
            "x^4 + y^4 + z^4 = 3*x^2 + 7",
            "x^2 + y^2 + z^2 = -1",
        ] {
            assert!(!around(formula).goes_on, "{formula}");
        }
    }

    #[test]
    fn corners_of_the_cube_before_are_no_points_outside_of_it() {
        let mut workspace = Workspace::default();
        let mut holds_points = |formula| {
            let surface = surface(formula);
            let kernel = &**surface.over_boxes(Kernel::ValueEnclosures).unwrap();
            // From (2, 0, 0) to (3, 1, 1), beside the cube of half side 2.
            cube(8.0).holds_points(&[IVec3::new(10, 8, 8)], 16, kernel, &mut workspace)
        };
        assert!(holds_points("x = 3") && holds_points("x = 2.5"));
        assert!(!holds_points("x = 2") && !holds_points("x^2 + y^2 + z^2 = 4"));
    }

    /// Intervals are wide here, so that all cells stay open, far from the sphere too; and a pole is no surface.
    #[test]
    fn what_is_not_proven_is_not_said_to_go_on() {
        let sphere = "x^2 + y^2 + z^2 - 1 + 20((x - y)^2 - x^2 + 2x*y - y^2)";
        for formula in [sphere, "1/(x - 20)"] {
            assert!(!around(formula).goes_on, "{formula}");
        }
    }

    /// Intervals are wide, and from a larger cube on the region would be: 1.125 instead of 35 of 32 parts.
    #[test]
    fn a_larger_cube_is_taken_only_if_it_holds_more() {
        let region = fitted("x^2 + y^2 + z^2 - 1 + ((x - y)^2 - x^2 + 2x*y - y^2)/4");
        assert_eq!((region.min(), region.max()), (DVec3::splat(-1.09375), DVec3::splat(1.09375)));
    }

    #[test]
    fn what_is_far_away_is_looked_for_there() {
        assert_close(
            "(x - 3000)^2 + y^2 + z^2 = 1",
            DVec3::new(2999.0, -1.0, -1.0),
            DVec3::new(3001.0, 1.0, 1.0),
        );
        assert_close("x^2 + y^2 + z^2 = 1e12", DVec3::splat(-1e6), DVec3::splat(1e6));
    }

    #[test]
    fn what_is_met_first_in_the_largest_of_the_near_cubes_is_no_scrap() {
        assert_close("x^2 + y^2 + z^2 = 490000", DVec3::splat(-700.0), DVec3::splat(700.0));
        for formula in ["x = 300", "x = 1000", "x^2 + y^2 = 90000"] {
            assert!(around(formula).goes_on, "{formula}");
        }
    }

    #[test]
    fn of_two_regions_neither_may_hide_what_goes_on_outside_of_the_other() {
        let [near, far] = ["x^2 + y^2 = 1", "x^2 + y^2 + z^2 = 100"].map(around);
        assert!(near.goes_on && near.hull(&near).goes_on);
        assert!(!near.hull(&far).goes_on && !far.hull(&near).goes_on);
    }

    /// Nearer cubes show corners of the hyperboloid, and its waist is farther out.
    #[test]
    fn scraps_are_not_taken_for_the_surface() {
        let region = fitted("x^2 + y^2 - z^2 = 100");
        assert!(region.max().x >= 30.0, "{region:?}");
    }

    #[test]
    fn flat_surfaces_keep_some_space_around_them() {
        let region = fitted("x^2 + y^2 + 1e6 z^2 = 1");
        assert!(
            region.extent().z >= 0.25 * region.extent().x - 1e-9 && region.extent().x < 2.3,
            "{region:?}"
        );
    }

    #[test]
    fn unbounded_surfaces_are_cut_off_where_they_go_on() {
        assert_eq!(fitted("sin(x) = cos(y) + sin(z)"), Region::standard());
        let cylinder = fitted("x^2 + y^2 = 9");
        assert!(cylinder.extent().z == 16.0 && cylinder.extent().x <= 7.0, "{cylinder:?}");
    }

    #[test]
    fn a_single_point_keeps_a_region_around_it() {
        let region = fitted("(x - 1)^2 + y^2 + z^2 = 0");
        assert!(region.extent().min_element() > 1e-12 && region.extent().max_element() < 1e-6, "{region:?}");
    }

    #[test]
    fn nothing_to_see_gives_the_standard_region() {
        for formula in ["x^2 + y^2 + z^2 = -1", "sqrt(-1 - x^2)", "1"] {
            assert_eq!(fitted(formula), Region::standard(), "{formula}");
        }
    }
}
