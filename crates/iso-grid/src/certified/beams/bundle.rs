//! The rays of a tile as one bundle, and the beams that it is cut into.

use glam::DVec3;
use iso_expr::Interval;
use iso_expr::interval::{round_down, round_up};

use super::area::Area;
use crate::{Ray, Region, Span};

/// Components beyond this size are left to rays one by one: below it nothing here overflows.
const LARGEST: f64 = 1e100;

/// Columns and rows of a block, the smallest part of a tile whose own deviations are kept.
const BLOCK: usize = 8;

/// The rays of a tile, row by row, each near to an affine function of its column and its row.
///
/// Parallel rays of an even raster are such a function but for rounding, rays from one eye nearly so. Any rays may be
/// bundled: what is proven holds for all of them, but takes long where they deviate much.
pub(in crate::certified) struct Bundle<'a> {
    pub(super) rays: &'a [Ray],
    /// All columns and rows.
    pub(super) area: Area,
    origins: Affine,
    directions: Affine,
    /// How far origins and directions are from those, block by block, row by row.
    deviations: Vec<[Range; 2]>,
}

impl<'a> Bundle<'a> {
    /// Bundles rays that stand row by row. `None` when there are no rays, or they are not finite or out of all proportion.
    pub(in crate::certified) fn new(rays: &'a [Ray], width: usize) -> Option<Self> {
        let height = rays.len().checked_div(width)?;
        let area = Area { column: 0, row: 0, width, height };
        let corners = area.corners().map(|(column, row)| rays.get(row * width + column));
        let [Some(a), Some(b), Some(c), Some(d)] = corners else { return None };
        if !rays.iter().all(|ray| ray.origin.is_finite() && ray.direction.is_finite()) {
            return None;
        }
        let corners = [a, b, c, d];
        let mut bundle = Self {
            rays,
            area,
            origins: Affine::through(corners.map(|ray| ray.origin), area),
            directions: Affine::through(corners.map(|ray| ray.direction), area),
            deviations: Vec::new(),
        };
        bundle.deviations = area.blocks(BLOCK).map(|block| bundle.deviation(block)).collect();
        let size = bundle.beam(area).size();
        (size <= LARGEST).then_some(bundle)
    }

    /// How far the rays of `area` are from the affine functions.
    fn deviation(&self, area: Area) -> [Range; 2] {
        let mut deviation = [Range::EMPTY; 2];
        for row in area.rows() {
            let rays = &self.rays[row * self.area.width..][area.columns()];
            for (column, ray) in area.columns().zip(rays) {
                let (across, along) = self.area.offset(column, row);
                deviation[0].include(ray.origin - self.origins.at(across, along));
                deviation[1].include(ray.direction - self.directions.at(across, along));
            }
        }
        deviation
    }

    /// How many rays of a part of the tile meet the region. As both are convex, rays whose corners meet it all do.
    pub(super) fn count_in(&self, region: &Region, area: Area) -> u64 {
        let meets =
            |(column, row): (usize, usize)| region.clip(&self.rays[row * self.area.width + column]).is_some();
        let count = (area.width * area.height) as u64;
        if area.corners().into_iter().all(meets) {
            count
        } else if count == 1
            || self.beam(area).passage(region).is_some_and(|passage| passage.start > passage.end)
        {
            0
        } else {
            area.quarters().map(|quarter| self.count_in(region, quarter)).sum()
        }
    }

    /// The rays of a part of the tile.
    pub(super) fn beam(&self, area: Area) -> Beam {
        let mut deviation = [Range::EMPTY; 2];
        let blocks_in_row = self.area.width.div_ceil(BLOCK);
        for row in area.row / BLOCK..=area.last_row() / BLOCK {
            for column in area.column / BLOCK..=area.last_column() / BLOCK {
                let of_block = self.deviations[row * blocks_in_row + column];
                deviation = [0, 1].map(|place| deviation[place].hull(of_block[place]));
            }
        }
        let middle = self.area.offset_of_middle(area);
        let radii = [0.5 * (area.width - 1) as f64, 0.5 * (area.height - 1) as f64];
        let [origins, directions] = [(&self.origins, deviation[0]), (&self.directions, deviation[1])]
            .map(|(affine, deviation)| Spread::new(affine, self.area, middle, deviation, radii));
        Beam { area, radii, origins, directions }
    }
}

/// A vector as a function of column and row, both counted from the middle of the tile.
struct Affine {
    middle: DVec3,
    by_column: DVec3,
    by_row: DVec3,
}

impl Affine {
    /// The function that is nearest to the given ones at the corners, left to right and top to bottom.
    fn through([a, b, c, d]: [DVec3; 4], area: Area) -> Self {
        let slope = |change: DVec3, length: usize| change / (2 * length.max(2) - 2) as f64;
        Self {
            middle: 0.25 * (a + b + c + d),
            by_column: slope((b - a) + (d - c), area.width),
            by_row: slope((c - a) + (d - b), area.height),
        }
    }

    fn at(&self, across: f64, along: f64) -> DVec3 {
        self.middle + across * self.by_column + along * self.by_row
    }
}

/// A box that some vectors lie in.
#[derive(Clone, Copy)]
struct Range {
    lo: DVec3,
    hi: DVec3,
}

impl Range {
    const EMPTY: Self = Self { lo: DVec3::INFINITY, hi: DVec3::NEG_INFINITY };

    fn include(&mut self, vector: DVec3) {
        (self.lo, self.hi) = (self.lo.min(vector), self.hi.max(vector));
    }

    fn hull(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }
}

/// Vectors `middle + a·by_column + b·by_row + rest`, where a and b are columns and rows counted from the middle of an area,
/// and `rest` is a vector with no component larger than the one of `rest`. Rounding is part of the rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spread {
    pub(super) middle: DVec3,
    pub(super) by_column: DVec3,
    pub(super) by_row: DVec3,
    pub(super) rest: DVec3,
    /// No component of any of the vectors is farther from that of `middle`.
    pub(super) radius: DVec3,
}

impl Spread {
    fn new(affine: &Affine, tile: Area, at: (f64, f64), deviation: Range, radii: [f64; 2]) -> Self {
        let Affine { by_column, by_row, .. } = *affine;
        let shift = 0.5 * (deviation.lo + deviation.hi);
        // The deviations were computed by five roundings, and the middle is by five more, none of them larger than half an ulp
        // of the sum of all magnitudes.
        let magnitude = affine.middle.abs()
            + tile.width as f64 * by_column.abs()
            + tile.height as f64 * by_row.abs()
            + deviation.lo.abs().max(deviation.hi.abs());
        let rounding = 16.0 * f64::EPSILON * magnitude + DVec3::splat(f64::MIN_POSITIVE);
        let rest = (deviation.hi - shift).max(shift - deviation.lo) + rounding;
        let across = radii[0] * by_column.abs() + radii[1] * by_row.abs();
        Self {
            middle: affine.at(at.0, at.1) + shift,
            by_column,
            by_row,
            rest,
            radius: (1.0 + 8.0 * f64::EPSILON) * (across + rest),
        }
    }

    /// What no component of any of the vectors exceeds.
    pub(super) fn largest(&self) -> DVec3 {
        (1.0 + f64::EPSILON) * (self.middle.abs() + self.radius)
    }

    /// The largest component of any of the vectors; NaN when one is NaN.
    fn size(&self) -> f64 {
        let sizes = self.largest().to_array();
        sizes.into_iter().fold(0.0, |largest, size| if size <= largest { largest } else { size })
    }
}

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
    /// The corners of a box around the points of all rays in the region from `span.start` to `span.end`, which are not
    /// negative. `None` when there are no such points.
    pub(super) fn bounds(&self, span: Span, region: &Region) -> Option<(DVec3, DVec3)> {
        let (lo, hi) = self.bounds_in_space(span);
        let (lo, hi) = (lo.max(region.min()), hi.min(region.max()));
        lo.cmple(hi).all().then_some((lo, hi))
    }

    /// The corners of a box around the points of all rays from `span.start` to `span.end`, which are not negative.
    pub(super) fn bounds_in_space(&self, span: Span) -> (DVec3, DVec3) {
        let Span { start, end } = span;
        let sides = [0, 1, 2].map(|axis| {
            let ends = |spread: &Spread| {
                let (middle, radius) = (spread.middle[axis], spread.radius[axis]);
                (round_down(middle - radius), round_up(middle + radius))
            };
            let ((o_lo, o_hi), (d_lo, d_hi)) = (ends(&self.origins), ends(&self.directions));
            let (way_lo, way_hi) = ((start * d_lo).min(end * d_lo), (start * d_hi).max(end * d_hi));
            (round_down(o_lo + round_down(way_lo)), round_up(o_hi + round_up(way_hi)))
        });
        (sides.map(|(lo, _)| lo).into(), sides.map(|(_, hi)| hi).into())
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

    /// How long a stretch of the beam from `span.start` to `span.end` is, and how wide, in units of space.
    pub(super) fn extent(&self, span: Span) -> (f64, f64) {
        let middle = 0.5 * (span.start + span.end);
        let [column, row] = self.across(middle);
        let width = 2.0 * (self.radii[0] * column.length()).max(self.radii[1] * row.length());
        ((span.end - span.start) * self.directions.middle.length(), width)
    }

    /// How far a column and a row move the point at `t`.
    pub(super) fn across(&self, t: f64) -> [DVec3; 2] {
        let (o, d) = (&self.origins, &self.directions);
        [o.by_column + t * d.by_column, o.by_row + t * d.by_row]
    }

    fn size(&self) -> f64 {
        let (origins, directions) = (self.origins.size(), self.directions.size());
        if origins <= directions { directions } else { origins }
    }
}
