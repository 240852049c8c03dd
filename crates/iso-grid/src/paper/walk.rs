//! The way of a ray through the cells of a grid.

use crate::paper::lattice::Lattice;
use crate::{Ray, Span};

/// The cells that a ray passes through, from the nearest to the farthest: the 3-D digital differential analyser of
/// J. Amanatides and A. Woo, 'A Fast Voxel Traversal Algorithm for Ray Tracing', Eurographics 1987.
///
/// Each step goes to the neighbour behind the plane that comes next. Where that plane is on the ray is computed from the
/// plane itself, not by adding up, so the error does not grow along the way, and each cell's stretch begins just where
/// the last one ended. Cells that the ray only touches, in an edge or a corner, are passed over. A ray that runs inside
/// a plane between cells passes through those above it.
pub(crate) struct CellWalk<'a> {
    lattice: &'a Lattice,
    ray: Ray,
    rest: Span,
    place: Option<[usize; 3]>,
    /// Where the ray leaves the cell along each axis; infinite along an axis at a right angle to the ray.
    leaves: [f64; 3],
}

/// A ray's passage through one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Passage {
    /// The cell's place.
    pub(crate) place: [usize; 3],
    /// The part of the ray in the cell, longer than nothing.
    pub(crate) span: Span,
}

impl<'a> CellWalk<'a> {
    /// The way along `span`, the part of `ray` inside the lattice's region.
    pub(crate) fn new(lattice: &'a Lattice, ray: Ray, span: Span) -> Self {
        let mut walk = Self { lattice, ray, rest: span, place: None, leaves: [f64::INFINITY; 3] };
        let place = std::array::from_fn(|axis| walk.first_place(axis));
        walk.place = Some(place);
        for (axis, &place) in place.iter().enumerate() {
            walk.leaves[axis] = walk.leaving(axis, place);
        }
        walk
    }

    /// The first place along `axis` that the ray has not left at the start.
    fn first_place(&self, axis: usize) -> usize {
        let planes = self.lattice.planes(axis);
        let (last, direction) = (planes.len() - 2, self.ray.direction[axis]);
        if direction > 0.0 {
            planes[1..].partition_point(|&plane| self.crossing(axis, plane) <= self.rest.start).min(last)
        } else if direction < 0.0 {
            planes[1..].partition_point(|&plane| self.crossing(axis, plane) > self.rest.start).min(last)
        } else {
            planes[1..].partition_point(|&plane| plane <= self.ray.origin[axis]).min(last)
        }
    }

    /// Where the ray leaves the places `place` along `axis`.
    fn leaving(&self, axis: usize, place: usize) -> f64 {
        let planes = self.lattice.planes(axis);
        let direction = self.ray.direction[axis];
        if direction == 0.0 {
            return f64::INFINITY;
        }
        self.crossing(axis, planes[if direction > 0.0 { place + 1 } else { place }])
    }

    /// Where the ray meets a plane across `axis`.
    fn crossing(&self, axis: usize, plane: f64) -> f64 {
        (plane - self.ray.origin[axis]) / self.ray.direction[axis]
    }

    /// The place behind the plane that the ray meets next, unless that is the region's face.
    fn step(&mut self, place: [usize; 3]) -> Option<[usize; 3]> {
        let [x, y, z] = self.leaves;
        let axis = if x <= y && x <= z { 0 } else { 1 + usize::from(z < y) };
        let forward = self.ray.direction[axis] > 0.0;
        let next = if forward { place[axis].checked_add(1) } else { place[axis].checked_sub(1) }?;
        if next >= self.lattice.cells()[axis] {
            return None;
        }
        self.leaves[axis] = self.leaving(axis, next);
        let mut stepped = place;
        stepped[axis] = next;
        Some(stepped)
    }
}

impl Iterator for CellWalk<'_> {
    type Item = Passage;

    fn next(&mut self) -> Option<Passage> {
        loop {
            let place = self.place?;
            let start = self.rest.start;
            let end = self.leaves.iter().fold(self.rest.end, |end, &leaves| end.min(leaves));
            self.place = if end < self.rest.end { self.step(place) } else { None };
            if start < end {
                self.rest.start = end;
                return Some(Passage { place, span: Span { start, end } });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;
    use crate::{Region, testing};

    fn passages(region: &Region, cells: [u32; 3], ray: Ray) -> Vec<Passage> {
        let lattice = Lattice::new(region, cells);
        region.clip(&ray).map_or(Vec::new(), |span| CellWalk::new(&lattice, ray, span).collect())
    }

    /// Every cell's own part of the ray, by the slab method, in order of t; cells are half open towards larger coordinates
    /// for a ray inside a plane.
    fn by_brute_force(region: &Region, cells: [u32; 3], ray: Ray) -> Vec<Passage> {
        let lattice = Lattice::new(region, cells);
        let Some(whole) = region.clip(&ray) else { return Vec::new() };
        let mut passages = Vec::new();
        for number in 0..lattice.cells().iter().product() {
            let place = crate::paper::lattice::place(number, lattice.cells());
            let mut span = whole;
            for axis in 0..3 {
                let planes = lattice.planes(axis);
                let (lo, hi) = (planes[place[axis]], planes[place[axis] + 1]);
                let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
                if direction == 0.0 {
                    let is_last = place[axis] + 2 == planes.len();
                    if !(lo <= origin && (origin < hi || is_last && origin == hi)) {
                        span.end = f64::NEG_INFINITY;
                    }
                } else {
                    let (a, b) = ((lo - origin) / direction, (hi - origin) / direction);
                    span = Span { start: span.start.max(a.min(b)), end: span.end.min(a.max(b)) };
                }
            }
            if span.start < span.end {
                passages.push(Passage { place, span });
            }
        }
        passages.sort_by(|a, b| a.span.start.total_cmp(&b.span.start));
        passages
    }

    proptest! {
        #![proptest_config(testing::property(4000))]

        #[test]
        fn cells_are_those_that_the_ray_crosses(
            ray in testing::ray(),
            cells in proptest::array::uniform3(1_u32..9),
        ) {
            let region = Region::new(DVec3::splat(-1.0), DVec3::new(1.0, 1.5, 2.0)).unwrap();
            prop_assert_eq!(passages(&region, cells, ray), by_brute_force(&region, cells, ray));
        }
    }

    #[test]
    fn a_ray_in_a_plane_between_cells_walks_above_it() {
        let region = Region::new(DVec3::ZERO, DVec3::splat(4.0)).unwrap();
        for zero in [0.0, -0.0] {
            let ray = Ray { origin: DVec3::new(-1.0, 2.0, 4.0), direction: DVec3::new(2.0, zero, -zero) };
            let places: Vec<_> = passages(&region, [4; 3], ray).iter().map(|passage| passage.place).collect();
            assert_eq!(places, [[0, 2, 3], [1, 2, 3], [2, 2, 3], [3, 2, 3]]);
        }
    }

    #[test]
    fn a_diagonal_passes_through_the_corners_of_cells() {
        let region = Region::new(DVec3::ZERO, DVec3::splat(3.0)).unwrap();
        let ray = Ray { origin: DVec3::splat(4.0), direction: DVec3::splat(-1.0) };
        let places: Vec<_> = passages(&region, [3; 3], ray).iter().map(|passage| passage.place).collect();
        assert_eq!(places, [[2; 3], [1; 3], [0; 3]]);
    }

    #[test]
    fn a_ray_that_starts_inside_begins_in_its_cell() {
        let region = Region::new(DVec3::ZERO, DVec3::splat(10.0)).unwrap();
        let ray = Ray { origin: DVec3::splat(5.5), direction: DVec3::Z * 1e-3 };
        let passages = passages(&region, [10; 3], ray);
        assert_eq!(passages[0], Passage { place: [5; 3], span: Span { start: 0.0, end: 0.5 / 1e-3 } });
        assert_eq!(passages.len(), 5);
    }

    #[test]
    fn each_stretch_begins_where_the_last_one_ended() {
        let region = Region::new(DVec3::splat(1e12), DVec3::splat(1e12 + 1.0)).unwrap();
        let ray = Ray { origin: DVec3::splat(1e12 - 3.0), direction: DVec3::new(1.0, 0.9, 0.8) };
        let passages = passages(&region, [60; 3], ray);
        assert!(passages.windows(2).all(|pair| pair[0].span.end == pair[1].span.start));
        assert_eq!(passages.first().unwrap().span.start, region.clip(&ray).unwrap().start);
        assert_eq!(passages.last().unwrap().span.end, region.clip(&ray).unwrap().end);
    }
}
