//! Beams: rectangles of a tile's rays.

use glam::DVec3;
use iso_expr::Interval;

use super::spread::Spread;
use crate::area::Area;
use crate::batch::Affine;
use crate::{Region, Span, Tile};

/// Components beyond this size are left to rays one by one: below it nothing here overflows.
const LARGEST: f64 = 1e100;

/// Rays of areas of so many columns or rows are counted one by one.
const COUNTED: usize = 8;

/// What the roundings of a box's ends come to at most, as part of the ends.
const ROUNDINGS: f64 = 8.0 * f64::EPSILON;

/// The rays of an area.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beam {
    pub(super) area: Area,
    /// How far columns and rows are from the middle of the area at most.
    pub(super) radii: [f64; 2],
    pub(super) origins: Spread,
    pub(super) directions: Spread,
}

impl Beam {
    /// The rays of a part of a tile.
    pub(super) fn new(tile: &Tile<'_>, area: Area) -> Self {
        let [origins, directions] = Spread::of(tile, area);
        Self { area, radii: area.radii(), origins, directions }
    }

    /// Whether all components are finite, and of a size for which nothing overflows.
    pub(super) fn is_proportionate(&self) -> bool {
        [self.origins, self.directions].iter().all(|spread| spread.size.cmple(DVec3::splat(LARGEST)).all())
    }

    /// The corners of a box around the points of all rays in the region from `span.start` to `span.end`, which are not
    /// negative. `None` when there are no such points.
    pub(super) fn bounds(&self, span: Span, region: &Region) -> Option<(DVec3, DVec3)> {
        let (lo, hi) = self.bounds_in_space(span);
        let (lo, hi) = (lo.max(region.min()), hi.min(region.max()));
        lo.cmple(hi).all().then_some((lo, hi))
    }

    /// The corners of a box around the points of all rays from `span.start` to `span.end`, which are not negative. It holds
    /// the sums of all vectors as near to the middle ones as origins are and products of t with such directions, too.
    pub(super) fn bounds_in_space(&self, span: Span) -> (DVec3, DVec3) {
        let Self { origins: o, directions: d, .. } = self;
        let (t, half) = (0.5 * (span.start + span.end), 0.5 * (span.end - span.start));
        let middle = o.middle + t * d.middle;
        let rounding = ROUNDINGS * (o.size + span.end * d.size) + DVec3::splat(f64::MIN_POSITIVE);
        let radius = o.radius + half * d.middle.abs() + span.end * d.radius + rounding;
        (middle - radius, middle + radius)
    }

    /// Affine forms of x, y and z at the points of all rays in a stretch, its ends not negative: how they depend on column, row and
    /// t, counted from the middle in units that reach the ends. Gives the middle t and its unit as well.
    pub(super) fn forms(&self, span: Span) -> ([Affine; 3], (f64, f64)) {
        let Self { origins: o, directions: d, .. } = self;
        let t = 0.5 * (span.start + span.end);
        let unit = (1.0 + ROUNDINGS) * (span.end - t).max(t - span.start) + f64::MIN_POSITIVE;
        let middle = o.middle + t * d.middle;
        let [column, row] = self.across(t);
        let slopes = [self.radii[0] * column, self.radii[1] * row, unit * d.middle];
        // Of the product of t and a direction, what both add is left.
        let rest = o.rest + span.end * d.rest + unit * d.radius;
        let rest = rest + ROUNDINGS * (o.size + span.end * d.size) + DVec3::splat(f64::MIN_POSITIVE);
        let [a, b, c] = slopes;
        let form = |axis: usize| Affine {
            middle: middle[axis],
            slopes: DVec3::new(a[axis], b[axis], c[axis]),
            rest: rest[axis],
        };
        ([form(0), form(1), form(2)], (t, unit))
    }

    /// A stretch, from 0 on, that holds the part of every ray in the region, and ends before it starts when all miss it.
    /// `None` when the beam is so wide that the faces of the region do not bound it.
    pub(super) fn passage(&self, region: &Region) -> Option<Span> {
        let mut passage = Span { start: 0.0, end: f64::INFINITY };
        for axis in 0..3 {
            let around = |spread: &Spread| {
                let radius = spread.radius[axis];
                Interval::point(spread.middle[axis]).plus(Interval { lo: -radius, hi: radius })
            };
            let directions = around(&self.directions);
            if !directions.contains_zero() {
                let faces = Interval { lo: region.min()[axis], hi: region.max()[axis] };
                let t = faces.minus(around(&self.origins)).over(directions);
                passage = Span { start: passage.start.max(t.lo), end: passage.end.min(t.hi) };
            }
        }
        passage.end.is_finite().then_some(passage)
    }

    /// How many times longer than the beam is wide a stretch of it is; infinite for a single ray.
    pub(super) fn elongation(&self, span: Span) -> f64 {
        let [column, row] = self.across(0.5 * (span.start + span.end));
        let [across, along] = self.radii.map(|radius| 4.0 * radius * radius);
        let width = (across * column.length_squared()).max(along * row.length_squared());
        (span.end - span.start) * (self.directions.middle.length_squared() / width).sqrt()
    }

    /// How far a column and a row move the point at `t`.
    pub(super) fn across(&self, t: f64) -> [DVec3; 2] {
        let (o, d) = (&self.origins, &self.directions);
        [o.by_column + t * d.by_column, o.by_row + t * d.by_row]
    }
}

/// How many rays of a part of a tile meet the region. As both are convex, rays whose corners meet it all do.
pub(super) fn count_in(region: &Region, tile: &Tile<'_>, area: Area) -> u64 {
    let meets = |(column, row): (usize, usize)| region.clip(&tile.ray(column, row)).is_some();
    let count = (area.width * area.height) as u64;
    if area.corners().into_iter().all(meets) {
        return count;
    }
    if area.side() <= COUNTED {
        let columns = |row: usize| area.columns().filter(move |column| meets((*column, row))).count() as u64;
        return area.rows().map(columns).sum();
    }
    let misses = |passage: Span| passage.start > passage.end;
    if Beam::new(tile, area).passage(region).is_some_and(misses) {
        return 0;
    }
    area.quarters().map(|quarter| count_in(region, tile, quarter)).sum()
}

#[cfg(test)]
mod tests {
    use iso_expr::random::Random;

    use super::*;
    use crate::{Raster, Ray};

    #[test]
    fn rays_that_meet_the_region_are_counted() {
        let mut random = Random::new(9);
        let region = Region::new(DVec3::splat(-1.0), DVec3::splat(1.0)).unwrap();
        let [mut fewest, mut most] = [u64::MAX, 0];
        for round in 0..200 {
            let eye = DVec3::from_array([(); 3].map(|()| random.between(-4.0, 4.0)));
            let forward = -eye.normalize();
            let (right, down) = forward.any_orthonormal_pair();
            let pixel = random.between(0.01, 0.2);
            let raster = if round % 2 == 0 {
                Raster::Parallel { middle: eye, right: pixel * right, down: pixel * down, direction: forward }
            } else {
                Raster::Spreading { eye, forward, right: 0.1 * pixel * right, down: 0.1 * pixel * down }
            };
            let (width, height) = (1 + random.below(40), 1 + random.below(40));
            let corner = [random.below(60) as f64 - 50.0, random.below(60) as f64 - 50.5];
            let tile = Tile::of(&raster, corner, width, height);
            let expected = tile.rays().filter(|ray| region.clip(ray).is_some()).count() as u64;
            let area = Area { column: 0, row: 0, width, height };
            assert_eq!(count_in(&region, &tile, area), expected, "{raster:?}, {corner:?}, {width}×{height}");
            (fewest, most) = (fewest.min(expected), most.max(expected));
        }
        assert!(fewest == 0 && most > 500, "{fewest}..{most}");
    }

    #[test]
    fn beams_whose_rays_are_farther_apart_than_any_double_are_out_of_proportion() {
        let is_proportionate = |far: f64| {
            let rays =
                [-far, far, far, -far].map(|x| Ray { origin: DVec3::new(x, 0.1, -4.0), direction: DVec3::Z });
            let area = Area { column: 0, row: 0, width: 2, height: 2 };
            Beam::new(&Tile::listed(&rays, 2), area).is_proportionate()
        };
        assert!(is_proportionate(1.0));
        // From corner to corner both differences overflow, with unlike signs.
        assert!(!is_proportionate(1.7e308));
    }
}
