//! Rays side by side: those of a picture, and those of a part of it.

use glam::DVec3;
use pulp::Simd;

use crate::Ray;
use crate::lanes::{Lanes, ROW, Row, parts};

/// The rays of a picture: one for each column and row, evenly spaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Raster {
    /// Parallel rays.
    Parallel {
        /// Where the ray in the middle of the picture begins.
        middle: DVec3,
        /// From where one ray begins to where its right neighbour does.
        right: DVec3,
        /// From where one ray begins to where its lower neighbour does.
        down: DVec3,
        /// Of all rays.
        direction: DVec3,
    },
    /// Rays from one point, all with directions of length 1 up to rounding.
    Spreading {
        /// Where they begin.
        eye: DVec3,
        /// From the eye to the middle of the picture, a vector of length 1.
        forward: DVec3,
        /// From one pixel to its right neighbour, where the middle of the picture is at distance 1; perpendicular to
        /// `forward`.
        right: DVec3,
        /// From one pixel to its lower neighbour there; perpendicular to `forward`.
        down: DVec3,
    },
}

impl Raster {
    /// The ray `across` columns to the right of the middle of the picture and `along` rows below it.
    #[inline]
    pub fn ray(&self, across: f64, along: f64) -> Ray {
        match *self {
            Self::Parallel { middle, right, down, direction } => {
                Ray { origin: middle + (across * right + along * down), direction }
            }
            Self::Spreading { eye, forward, right, down } => {
                Ray { origin: eye, direction: (forward + (across * right + along * down)).normalize() }
            }
        }
    }

    /// Origins and directions of rays, coordinate by coordinate, each as [`Raster::ray`] has it to the last bit.
    #[inline(always)]
    fn rays<S: Simd>(&self, simd: S, [across, along]: [Lanes<S>; 2]) -> [[Lanes<S>; 3]; 2] {
        let at = [across, along];
        match *self {
            Self::Parallel { middle, right, down, direction } => {
                [combination(simd, middle, [right, down], at), everywhere(simd, direction)]
            }
            Self::Spreading { eye, forward, right, down } => {
                let [x, y, z] = combination(simd, forward, [right, down], at);
                let scale = Lanes::all(simd, 1.0) / (x * x + y * y + z * z).sqrt();
                [everywhere(simd, eye), [x * scale, y * scale, z * scale]]
            }
        }
    }
}

/// The same vector everywhere, coordinate by coordinate.
#[inline(always)]
fn everywhere<S: Simd>(simd: S, vector: DVec3) -> [Lanes<S>; 3] {
    [Lanes::all(simd, vector.x), Lanes::all(simd, vector.y), Lanes::all(simd, vector.z)]
}

/// `from` and so many times the other two vectors, coordinate by coordinate.
#[inline(always)]
fn combination<S: Simd>(
    simd: S,
    from: DVec3,
    [right, down]: [DVec3; 2],
    [across, along]: [Lanes<S>; 2],
) -> [Lanes<S>; 3] {
    let ([x, y, z], [rx, ry, rz], [dx, dy, dz]) =
        (everywhere(simd, from), everywhere(simd, right), everywhere(simd, down));
    [x + (across * rx + along * dx), y + (across * ry + along * dy), z + (across * rz + along * dz)]
}

/// Some rays of a tile, coordinate by coordinate.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RayRow {
    pub(crate) origins: [Row; 3],
    pub(crate) directions: [Row; 3],
}

impl RayRow {
    /// The points of the rays at `t`, each as [`Ray::at`] has it to the last bit.
    #[inline(always)]
    pub(crate) fn at<S: Simd>(&self, simd: S, t: &Row, points: [&mut Row; 3]) {
        for (axis, coordinates) in points.into_iter().enumerate() {
            for part in 0..parts::<S>() {
                let origin = Lanes::of(simd, &self.origins[axis], part);
                let direction = Lanes::of(simd, &self.directions[axis], part);
                (origin + Lanes::of(simd, t, part) * direction).put(coordinates, part);
            }
        }
    }
}

/// Neighbouring rays, row by row from the top.
#[derive(Clone, Copy, Debug)]
pub struct Tile<'a> {
    pub(crate) rays: Rays<'a>,
    width: usize,
    height: usize,
}

/// What tells a tile's rays.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Rays<'a> {
    /// A raster, and where the first ray is in it.
    Raster { raster: &'a Raster, across: f64, along: f64 },
    /// All of them.
    Listed(&'a [Ray]),
}

impl<'a> Tile<'a> {
    /// The rays of `width` columns and `height` rows of a raster, of which the first one is `across` columns to the right
    /// of the middle and `along` rows below it: whole or half numbers.
    pub fn of(raster: &'a Raster, [across, along]: [f64; 2], width: usize, height: usize) -> Self {
        Self { rays: Rays::Raster { raster, across, along }, width, height }
    }

    /// Any rays, `width` in each row. What is proven holds for all of them, but takes long where they are no neighbours.
    ///
    /// # Panics
    /// When the last row is not full.
    pub fn listed(rays: &'a [Ray], width: usize) -> Self {
        assert!(rays.len().is_multiple_of(width), "a tile has full rows");
        Self { rays: Rays::Listed(rays), width, height: rays.len().checked_div(width).unwrap_or(0) }
    }

    /// The direction of all rays, if they are parallel.
    pub(crate) fn direction(&self) -> Option<DVec3> {
        match self.rays {
            Rays::Raster { raster: Raster::Parallel { direction, .. }, .. } => Some(*direction),
            _ => None,
        }
    }

    /// Whether there are rays between those of neighbouring columns and rows, too.
    pub(crate) fn is_dense(&self) -> bool {
        matches!(self.rays, Rays::Raster { .. })
    }

    /// How far neighbouring rays are apart at `t`, as a difference of t; nothing of listed ones.
    pub(crate) fn spacing(&self, t: f64) -> f64 {
        let Rays::Raster { raster, .. } = self.rays else { return 0.0 };
        match raster {
            Raster::Parallel { right, down, direction, .. } => {
                right.length().min(down.length()) / direction.length()
            }
            Raster::Spreading { right, down, .. } => t * right.length().min(down.length()),
        }
    }

    /// How many columns there are.
    pub fn width(&self) -> usize {
        self.width
    }

    /// How many rows there are.
    pub fn height(&self) -> usize {
        self.height
    }

    /// How many rays there are.
    pub fn len(&self) -> usize {
        self.width * self.height
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The ray in a column and a row, both counted from 0.
    #[inline]
    pub fn ray(&self, column: usize, row: usize) -> Ray {
        match self.rays {
            Rays::Raster { raster, across, along } => raster.ray(across + column as f64, along + row as f64),
            Rays::Listed(rays) => rays[row * self.width + column],
        }
    }

    /// Puts the rays in these columns and rows in place of others.
    #[inline(always)]
    pub(crate) fn put_rays<S: Simd>(&self, simd: S, [columns, rows]: [&Row; 2], place: &mut RayRow) {
        let RayRow { origins, directions } = place;
        match self.rays {
            Rays::Raster { raster, across, along } => {
                for part in 0..parts::<S>() {
                    let across = Lanes::all(simd, across) + Lanes::of(simd, columns, part);
                    let along = Lanes::all(simd, along) + Lanes::of(simd, rows, part);
                    let rays = raster.rays(simd, [across, along]);
                    for (vectors, found) in [&mut *origins, &mut *directions].into_iter().zip(rays) {
                        vectors.iter_mut().zip(found).for_each(|(row, numbers)| numbers.put(row, part));
                    }
                }
            }
            Rays::Listed(_) => {
                for lane in 0..ROW {
                    let Ray { origin, direction } = self.ray(columns[lane] as usize, rows[lane] as usize);
                    for axis in 0..3 {
                        (origins[axis][lane], directions[axis][lane]) = (origin[axis], direction[axis]);
                    }
                }
            }
        }
    }

    /// The rays in these columns and rows.
    #[inline(always)]
    pub(crate) fn row<S: Simd>(&self, simd: S, columns: &Row, rows: &Row) -> RayRow {
        let mut found = RayRow::default();
        self.put_rays(simd, [columns, rows], &mut found);
        found
    }

    /// The column and the row of each ray, row by row.
    pub fn positions(&self) -> impl Iterator<Item = (usize, usize)> {
        let Self { width, height, .. } = *self;
        (0..height).flat_map(move |row| (0..width).map(move |column| (column, row)))
    }

    /// All rays, row by row.
    pub fn rays(&self) -> impl Iterator<Item = Ray> {
        self.positions().map(|(column, row)| self.ray(column, row))
    }
}

impl<'a> From<&'a [Ray]> for Tile<'a> {
    /// The rays as one row.
    fn from(rays: &'a [Ray]) -> Self {
        Self::listed(rays, rays.len().max(1))
    }
}

#[cfg(test)]
mod tests {
    use iso_expr::random::Random;
    use pulp::{Arch, WithSimd};

    use super::*;

    /// The rays from a place of a tile on, counted row by row, behind the last one the first again, and their points at t.
    struct Points<'a>(&'a Tile<'a>, usize, Row);

    impl WithSimd for Points<'_> {
        type Output = (RayRow, [Row; 3]);

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let Self(tile, first, t) = self;
            let place = |lane: usize| (first + lane) % tile.len();
            let columns = std::array::from_fn(|lane| (place(lane) % tile.width()) as f64);
            let rows = std::array::from_fn(|lane| (place(lane) / tile.width()) as f64);
            let rays = tile.row(simd, &columns, &rows);
            let [mut x, mut y, mut z] = [Row::default(); 3];
            rays.at(simd, &t, [&mut x, &mut y, &mut z]);
            (rays, [x, y, z])
        }
    }

    #[test]
    fn neighbours_are_as_far_apart_as_is_said() {
        let direction = DVec3::new(0.0, 0.0, 0.5);
        let [right, down] = [0.02 * DVec3::X, 0.01 * DVec3::Y];
        for t in [1.0, 4.0] {
            for raster in [
                Raster::Parallel { middle: DVec3::ZERO, right, down, direction },
                Raster::Parallel { middle: DVec3::ZERO, right: down, down: right, direction },
                Raster::Spreading { eye: DVec3::ZERO, forward: DVec3::Z, right, down },
            ] {
                let tile = Tile::of(&raster, [0.0, 0.0], 2, 2);
                let [here, beside, below] =
                    [(0, 0), (1, 0), (0, 1)].map(|(column, row)| tile.ray(column, row));
                let nearest = here.at(t).distance(beside.at(t)).min(here.at(t).distance(below.at(t)));
                let expected = nearest / here.direction.length();
                assert!(
                    (tile.spacing(t) / expected - 1.0).abs() < 1e-3,
                    "{} for {expected}",
                    tile.spacing(t)
                );
            }
        }
        let alone = [Ray { origin: DVec3::ZERO, direction }; 2];
        assert_eq!(Tile::listed(&alone, 2).spacing(1.0), 0.0);
    }

    #[test]
    fn rays_side_by_side_are_those_one_by_one() {
        let mut random = Random::new(11);
        for round in 0..300 {
            let mut vector = || DVec3::from_array([(); 3].map(|()| random.between(-3.0, 3.0)));
            let [from, forward, right, down] = [vector(), vector(), 0.01 * vector(), 0.01 * vector()];
            let raster = if round % 2 == 0 {
                Raster::Parallel { middle: from, right, down, direction: forward }
            } else {
                Raster::Spreading { eye: from, forward, right, down }
            };
            let (width, height) = (1 + random.below(20), 1 + random.below(5));
            let corner = [random.below(200) as f64 - 100.5, random.below(200) as f64 - 100.0];
            let tile = Tile::of(&raster, corner, width, height);
            let rays: Vec<_> = tile.rays().collect();
            let t: Row = std::array::from_fn(|_| random.between(0.0, 5.0));
            for tile in [tile, Tile::listed(&rays, width)] {
                for first in 0..tile.len() {
                    let (row, points) = Arch::new().dispatch(Points(&tile, first, t));
                    for (lane, ray) in rays[first..].iter().take(ROW).enumerate() {
                        let vector = |rows: &[Row; 3]| DVec3::from_array(rows.map(|row| row[lane]));
                        let found = Ray { origin: vector(&row.origins), direction: vector(&row.directions) };
                        assert_eq!(found, *ray, "{raster:?}");
                        assert_eq!(vector(&points), ray.at(t[lane]), "{raster:?}");
                    }
                }
            }
        }
    }
}
