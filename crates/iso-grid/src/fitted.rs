//! A region for a surface of which nothing is known but its formula.

use glam::{DVec3, IVec3};
use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::{BoxKernel, CompileError, Decoration};

use crate::{Region, Surface, Workspace};

/// Half the sides of the cubes around the origin in which the surface is looked for, one after the other.
const HALF_SIDES: [f64; 5] = [2.0, 8.0, 32.0, 128.0, 512.0];

/// A region is cut in halves this often along each axis: 16 cells.
const HALVINGS: u32 = 4;

/// A region is cut anew as long as that draws its longest side in to less than this part,
const WORTHWHILE: f64 = 0.9;

/// but no more often than this: a single point could be closed in on until no double lies between the sides.
const ROUNDS: usize = 12;

/// No side is drawn closer than this part of the longest one, so that flat surfaces keep some space around them.
const THINNEST: f64 = 0.25;

impl Region {
    /// The cube from −2 to 2, which shows something of most surfaces that go on for ever.
    pub fn standard() -> Self {
        cube(HALF_SIDES[0])
    }

    /// A region close around the surface, or around a part of it near the origin.
    ///
    /// The surface is looked for in growing cubes around the origin, in cells that intervals cannot prove empty. The
    /// region is drawn around it in the first cube whose faces it does not meet. If there is none, that cube is taken where
    /// it meets the faces of the fewest axes, and [`Region::standard`] where nothing is found at all. What lies outside of
    /// the cube that was taken is not looked at; inside it, nothing of the surface is left out.
    ///
    /// When the surface's [`Stop`](crate::Stop) is requested, any region.
    ///
    /// # Errors
    /// When the engine cannot compile the surface.
    pub fn fitted(surface: &Surface, workspace: &mut Workspace) -> Result<Self, CompileError> {
        let kernel = &**surface.value_enclosures()?;
        let mut best: Option<(usize, Self)> = None;
        for cube in HALF_SIDES.map(cube) {
            if surface.stop().is_requested() {
                break;
            }
            let Some(held) = cube.drawn_in(kernel, workspace) else { continue };
            let meets =
                (0..3).filter(|&axis| held.min[axis] == cube.min[axis] || held.max[axis] == cube.max[axis]);
            let axes_met = meets.count();
            if best.is_none_or(|(fewest, _)| axes_met < fewest) {
                best = Some((axes_met, held));
            }
            if axes_met == 0 {
                break;
            }
        }
        let Some((_, mut region)) = best else { return Ok(Self::standard()) };
        for _ in 0..ROUNDS {
            if surface.stop().is_requested() {
                break;
            }
            let Some(closer) = region.drawn_in(kernel, workspace) else { break };
            let longest = region.extent().max_element();
            region = closer;
            if region.extent().max_element() > WORTHWHILE * longest {
                break;
            }
        }
        Ok(region)
    }

    /// The box around the cells of the region that may hold the surface, but not too thin; `None` when none may.
    fn drawn_in(self, kernel: &dyn BoxKernel, workspace: &mut Workspace) -> Option<Self> {
        let mut cells = vec![IVec3::ZERO];
        for depth in 1..=HALVINGS {
            let halves: Vec<IVec3> =
                cells.iter().flat_map(|cell| OCTANTS.map(|octant| 2 * cell + octant)).collect();
            cells = self.not_empty(halves, 1 << depth, kernel, workspace);
        }
        let first = cells.iter().copied().reduce(IVec3::min)?;
        let last = cells.iter().copied().reduce(IVec3::max)?;
        let (min, max) = (self.corner(first, 1 << HALVINGS), self.corner(last + 1, 1 << HALVINGS));
        let spare = 0.5 * (DVec3::splat(THINNEST * (max - min).max_element()) - (max - min)).max(DVec3::ZERO);
        Some(Self { min: (min - spare).max(self.min), max: (max + spare).min(self.max) })
    }

    /// Those of `cells`, of which `count` fill the region along each axis, that may hold the surface.
    fn not_empty(
        &self,
        mut cells: Vec<IVec3>,
        count: i32,
        kernel: &dyn BoxKernel,
        workspace: &mut Workspace,
    ) -> Vec<IVec3> {
        let ends = |far: i32| {
            [0, 1, 2].map(|axis| {
                cells.iter().map(|&cell| self.corner(cell + far, count)[axis]).collect::<Vec<_>>()
            })
        };
        let (lo, hi) = (ends(0), ends(1));
        let (mut below, mut above) = (vec![0.0; cells.len()], vec![0.0; cells.len()]);
        let mut decoration = vec![Decoration::Trivial; cells.len()];
        kernel.evaluate(
            &mut workspace.scratch,
            Boxes { lo: lo.each_ref().map(Vec::as_slice), hi: hi.each_ref().map(Vec::as_slice) },
            Enclosures { lo: &mut below, hi: &mut above, decoration: &mut decoration },
        );
        workspace.counters.box_evaluations += cells.len() as u64;
        let mut may_hold = below.iter().zip(&above).map(|(&lo, &hi)| lo <= 0.0 && 0.0 <= hi);
        cells.retain(|_| may_hold.next() == Some(true));
        cells
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

fn cube(half_side: f64) -> Region {
    Region { min: DVec3::splat(-half_side), max: DVec3::splat(half_side) }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use iso_expr::{Ast, Interpreter};

    use super::*;

    fn fitted(formula: &str) -> Region {
        let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
        Region::fitted(&Surface::new(Arc::new(Interpreter), program), &mut Workspace::default()).unwrap()
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
