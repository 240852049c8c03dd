//! Where the cells and points of a grid are.

use glam::DVec3;

use crate::Region;

/// The planes that cut a region into equal cells.
///
/// Cells and points are named by their places along x, y and z, or by one index in which x runs fastest.
#[derive(Clone, Debug)]
pub(crate) struct Lattice {
    planes: [Vec<f64>; 3],
    largest_side: f64,
}

impl Lattice {
    /// Cuts `region` into `cells` along x, y and z, each at least 1. The outermost planes are the region's own faces.
    pub(crate) fn new(region: &Region, cells: [u32; 3]) -> Self {
        let extent = region.extent();
        let planes = std::array::from_fn(|axis| {
            let (min, max, count) = (region.min()[axis], region.max()[axis], cells[axis]);
            let inner = |place: u32| (min + extent[axis] * (f64::from(place) / f64::from(count))).min(max);
            (0..count).map(inner).chain([max]).collect()
        });
        let sides = DVec3::from_array(std::array::from_fn(|axis| extent[axis] / f64::from(cells[axis])));
        Self { planes, largest_side: sides.max_element() }
    }

    /// The cells along each axis.
    pub(crate) fn cells(&self) -> [usize; 3] {
        self.points().map(|points| points - 1)
    }

    /// The points along each axis, one more than cells.
    pub(crate) fn points(&self) -> [usize; 3] {
        [0, 1, 2].map(|axis| self.planes[axis].len())
    }

    /// The coordinates along `axis` of the planes across it.
    pub(crate) fn planes(&self, axis: usize) -> &[f64] {
        &self.planes[axis]
    }

    /// The largest side of a cell.
    pub(crate) fn largest_side(&self) -> f64 {
        self.largest_side
    }

    /// The point at a place.
    pub(crate) fn point(&self, place: [usize; 3]) -> DVec3 {
        DVec3::new(self.planes[0][place[0]], self.planes[1][place[1]], self.planes[2][place[2]])
    }
}

/// The index of a place among `counts` places along the axes.
pub(crate) fn index(place: [usize; 3], counts: [usize; 3]) -> usize {
    (place[2] * counts[1] + place[1]) * counts[0] + place[0]
}

/// The place with an index among `counts` places along the axes.
pub(crate) fn place(index: usize, counts: [usize; 3]) -> [usize; 3] {
    [index % counts[0], index / counts[0] % counts[1], index / counts[0] / counts[1]]
}

/// The places of a cell's eight corners.
pub(crate) fn corners(cell: [usize; 3]) -> [[usize; 3]; 8] {
    std::array::from_fn(|corner| {
        [cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2)]
    })
}

/// The places of the cells that share a face, an edge or a corner with a cell, of `counts` cells along the axes.
pub(crate) fn neighbours(cell: [usize; 3], counts: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    let around = move |axis: usize| cell[axis].saturating_sub(1)..=(cell[axis] + 1).min(counts[axis] - 1);
    around(2)
        .flat_map(move |k| around(1).flat_map(move |j| around(0).map(move |i| [i, j, k])))
        .filter(move |&place| place != cell)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_run_from_face_to_face() {
        for (min, max) in [(-1.0, 1.0), (1e12, 1e12 + 3.0), (0.1, 0.1 + 1e-9), (-1e300, 1e300)] {
            let region = Region::new(DVec3::splat(min), DVec3::splat(max)).unwrap();
            for cells in [1, 3, 7, 60] {
                let lattice = Lattice::new(&region, [cells; 3]);
                let planes = lattice.planes(1);
                assert_eq!((planes[0], planes[cells as usize]), (min, max));
                assert!(planes.is_sorted());
            }
        }
    }

    #[test]
    fn places_and_indices_name_each_other() {
        let counts = [3, 4, 5];
        for number in 0..60 {
            assert_eq!(index(place(number, counts), counts), number);
        }
    }

    #[test]
    fn neighbours_are_the_cells_one_place_away() {
        assert_eq!(neighbours([1, 1, 1], [3; 3]).count(), 26);
        assert_eq!(neighbours([0, 0, 0], [3; 3]).count(), 7);
        assert_eq!(neighbours([0, 0, 0], [1; 3]).count(), 0);
        assert_eq!(neighbours([2, 0, 0], [3, 1, 1]).collect::<Vec<_>>(), [[1, 0, 0]]);
    }
}
