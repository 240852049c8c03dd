//! A sphere around what is found of a surface in a region, for a camera to look at.
//!
//! Intervals tell where nothing of the surface is, and leave open much more than it fills; sometimes what is left holds curves or points of it
//! alone, which nobody sees. So the surface is looked for at points, and a region that holds all of it stays as large as intervals say.

use glam::{DVec3, IVec3};
use iso_expr::{BoxKernel, Interval};
use rustc_hash::{FxBuildHasher, FxHashMap};

use super::Facing;
use super::cells::{HALVINGS, OCTANTS, enclose, halved};
use crate::{Region, Workspace};

/// Cells outside of the sphere are halved this often to find more of the surface in them.
const HALVINGS_OUTSIDE: u32 = 3;

/// Of more cells outside of the sphere none are halved.
const MOST_OUTSIDE: usize = 250;

/// The edges of a cell, by the numbers of their corners in [`OCTANTS`].
const EDGES: [[usize; 2]; 12] =
    [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]];

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// The middle.
    pub center: DVec3,
    /// The radius.
    pub radius: f64,
}

impl Sphere {
    /// A sphere around points, in the middle of the box around them; `None` when there are none, or all are the same.
    fn around(points: &[DVec3]) -> Option<Self> {
        let min = points.iter().copied().reduce(DVec3::min)?;
        let max = points.iter().copied().reduce(DVec3::max)?;
        let center = min + 0.5 * (max - min);
        let radius = points.iter().map(|point| point.distance(center)).fold(0.0, f64::max);
        (radius > 0.0).then_some(Self { center, radius })
    }

    /// The least sphere around this one and another one.
    pub fn hull(&self, other: &Self) -> Self {
        let between = other.center - self.center;
        let distance = between.length();
        if distance + other.radius <= self.radius {
            *self
        } else if distance + self.radius <= other.radius {
            *other
        } else {
            let radius = 0.5 * (distance + self.radius + other.radius);
            Self { center: self.center + (radius - self.radius) / distance * between, radius }
        }
    }
}

/// Where a surface is found.
#[derive(Default)]
struct Crossings {
    points: Vec<DVec3>,
    /// Vectors along its normals; not numbers where not all values around are.
    normals: Vec<DVec3>,
}

/// A vector along the gradient of what has these values at the corners of a cube.
fn gradient(values: [f64; 8]) -> DVec3 {
    // A part of each, so that no sum overflows.
    let sides = OCTANTS.map(|octant| 2.0 * octant.as_dvec3() - 1.0);
    sides.into_iter().zip(values).map(|(side, value)| 0.125 * value * side).sum()
}

impl Region {
    /// A sphere around the points at which F is found to change its sign at the corners of `cells`, sixteen along each axis, that may hold the
    /// surface, and which way it faces there; `None` when there are none.
    pub(super) fn crossings(
        &self,
        mut cells: Vec<IVec3>,
        (kernel, is_stopped): (&dyn BoxKernel, &dyn Fn() -> bool),
        workspace: &mut Workspace,
    ) -> (Option<Sphere>, Option<Facing>) {
        let mut found = Crossings::default();
        for depth in HALVINGS..=HALVINGS + HALVINGS_OUTSIDE {
            let count = 1 << depth;
            self.push_crossings(&mut found, (&cells, count), kernel, workspace);
            let Some(sphere) = Sphere::around(&found.points) else { break };
            cells.retain(|cell| self.is_outside(*cell, count, &sphere));
            let is_last = depth == HALVINGS + HALVINGS_OUTSIDE;
            if is_last || cells.is_empty() || cells.len() > MOST_OUTSIDE || is_stopped() {
                break;
            }
            cells = self.not_empty(halved(&cells), 2 * count, kernel, workspace);
        }
        (Sphere::around(&found.points), Facing::of(&found.normals))
    }

    /// Whether all of a cell lies outside of a sphere.
    fn is_outside(&self, cell: IVec3, count: i32, sphere: &Sphere) -> bool {
        let (lo, hi) = self.cell(cell, count);
        sphere.center.clamp(lo, hi).distance(sphere.center) > sphere.radius
    }

    /// Adds about where F is zero on edges of cells, of which `count` fill the region along each axis, along which it changes its sign, and about
    /// the gradients of F in those cells.
    fn push_crossings(
        &self,
        found: &mut Crossings,
        (cells, count): (&[IVec3], i32),
        kernel: &dyn BoxKernel,
        workspace: &mut Workspace,
    ) {
        let mut corners = Vec::new();
        let mut numbers = FxHashMap::with_capacity_and_hasher(2 * cells.len(), FxBuildHasher);
        let mut number_of = |corner: IVec3| {
            *numbers.entry(corner).or_insert_with(|| {
                corners.push(self.corner(corner, count));
                corners.len() - 1
            })
        };
        let cells: Vec<_> =
            cells.iter().map(|cell| OCTANTS.map(|octant| number_of(*cell + octant))).collect();
        let enclosures = enclose(kernel, workspace, corners.iter().map(|corner| (*corner, *corner)));
        let values: Vec<Interval> =
            (0..enclosures.len()).map(|corner| enclosures.interval(0, corner)).collect();
        for cell in cells {
            let (at, values) = (cell.map(|corner| corners[corner]), cell.map(|corner| values[corner]));
            let before = found.points.len();
            found.points.extend(EDGES.into_iter().filter_map(|edge| crossing(edge, &at, &values)));
            if found.points.len() == before {
                // It may go through corners from edge to edge.
                let is_below = |corner: &usize| values[*corner].hi < 0.0;
                let is_above = |corner: &usize| values[*corner].lo > 0.0;
                let ends = (0..8).find(is_below).zip((0..8).find(is_above));
                found.points.extend(ends.and_then(|(a, b)| crossing([a, b], &at, &values)));
            }
            if found.points.len() > before {
                found.normals.push(gradient(values.map(middle)) / self.extent());
            }
        }
    }
}

/// About where F is zero between two corners of a cell, if it changes its sign from one to the other.
fn crossing([a, b]: [usize; 2], corners: &[DVec3; 8], values: &[Interval; 8]) -> Option<DVec3> {
    let changes = values[a].hi < 0.0 && values[b].lo > 0.0 || values[a].lo > 0.0 && values[b].hi < 0.0;
    let (from, to) = (middle(values[a]), middle(values[b]));
    // Halved, for a difference of halves does not overflow.
    let way = (0.5 * from) / (0.5 * from - 0.5 * to);
    changes.then(|| corners[a].lerp(corners[b], if way.is_nan() { 0.5 } else { way }))
}

/// Halves are added, whose sum does not overflow.
fn middle(interval: Interval) -> f64 {
    0.5 * interval.lo + 0.5 * interval.hi
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fitted::tests::around;

    /// The sphere holds these points, of which two are opposite ends of a diameter, and is hardly larger.
    #[track_caller]
    fn assert_around(formula: &str, points: &[[f64; 3]], radius: f64) {
        let sphere = around(formula).sphere.unwrap();
        let farthest =
            points.iter().map(|point| sphere.center.distance(DVec3::from_array(*point))).fold(0.0, f64::max);
        assert!(farthest <= 1.05 * sphere.radius, "{formula}: {sphere:?} does not hold all points");
        assert!(sphere.radius <= 1.05 * radius, "{formula}: {sphere:?} is too large");
    }

    #[test]
    fn what_is_closed_is_held_closely() {
        for radius in [1e-3, 1.0, 100.0] {
            let formula = format!("(x - {radius})^2 + y^2 + z^2 = {}", radius * radius);
            assert_around(&formula, &[[0.0; 3], [2.0 * radius, 0.0, 0.0]], radius);
        }
        assert_around("x^2 + (y/2)^2 + z^2 = 1", &[[0.0, -2.0, 0.0], [0.0, 2.0, 0.0]], 2.0);
        assert_around("sqrt(x^2 + y^2 + z^2) = 1", &[[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]], 1.0);
    }

    /// Steiner's Roman surface reaches half a unit far; three lines besides are all zeros of F, too, and nothing to see.
    #[test]
    fn curves_besides_the_surface_are_not_looked_at() {
        let fitted = around("x^2 y^2 + y^2 z^2 + z^2 x^2 = x y z");
        assert_eq!(fitted.region, Region::standard());
        let sphere = fitted.sphere.unwrap();
        assert!((0.4..0.8).contains(&sphere.radius) && sphere.center.length() < 0.1, "{sphere:?}");
    }

    #[test]
    fn what_is_thin_or_small_outside_is_looked_at_too() {
        let star = "sqrt(abs(x)) + sqrt(abs(y)) + sqrt(abs(z)) = 1";
        assert_around(star, &[[1.0, 0.0, 0.0], [0.0, 0.0, -1.0]], 1.0);
        // No corner of the first cells lies in the small ball.
        let apart = "min(x^2 + y^2 + z^2 - 0.25, (x - 1.5)^2 + (y - 0.37)^2 + (z - 0.21)^2 - 0.001)";
        assert_around(apart, &[[-0.5, 0.0, 0.0], [1.5, 0.37, 0.21]], 1.08);
    }

    #[test]
    fn where_no_sign_changes_there_is_no_sphere() {
        for formula in ["(x^2 + y^2 + z^2 - 1)^2", "x^2 + y^2 + z^2 + 1", "0x"] {
            assert_eq!(around(formula).sphere, None, "{formula}");
        }
    }

    /// A point that grows into a ball, say.
    #[test]
    fn where_nothing_is_found_there_is_nothing_to_look_at() {
        let [point, ball] = ["x^2 + y^2 + z^2 = 0", "x^2 + y^2 + z^2 = 1"].map(around);
        assert!(point.sphere.is_none() && ball.sphere.is_some());
        assert_eq!([point.hull(&ball).unwrap().sphere, ball.hull(&point).unwrap().sphere], [ball.sphere; 2]);
        assert_eq!(point.hull(&point).unwrap().sphere, None);
    }

    #[test]
    fn hulls_hold_both_spheres_and_touch_them() {
        let sphere = |x, radius| Sphere { center: DVec3::new(x, 0.0, 0.0), radius };
        assert_eq!(sphere(0.0, 1.0).hull(&sphere(5.0, 2.0)), sphere(3.0, 4.0));
        assert_eq!(sphere(0.0, 3.0).hull(&sphere(1.0, 1.0)), sphere(0.0, 3.0));
        assert_eq!(sphere(1.0, 1.0).hull(&sphere(0.0, 3.0)), sphere(0.0, 3.0));
        assert_eq!(sphere(1.0, 1.0).hull(&sphere(1.0, 1.0)), sphere(1.0, 1.0));
    }
}
