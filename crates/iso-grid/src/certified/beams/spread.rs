//! Vectors of a tile's rays, origins or directions, as affine functions of column and row.

use glam::DVec3;

use crate::area::Area;
use crate::raster::Rays;
use crate::{Raster, Tile};

/// Of what is computed by a dozen roundings, none of them larger than half an ulp of some magnitude: what all of them may
/// come to, as part of that magnitude.
const ROUNDINGS: f64 = 16.0 * f64::EPSILON;

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
    /// What no component of any of the vectors exceeds.
    pub(super) size: DVec3,
}

impl Spread {
    /// The origins and the directions of the rays of an area.
    pub(super) fn of(tile: &Tile<'_>, area: Area) -> [Self; 2] {
        match tile.rays {
            Rays::Raster { raster, across, along } => {
                let first = area.offset_of_first();
                Self::of_raster(raster, [across + first.0, along + first.1], area.radii())
            }
            Rays::Listed(_) => Self::of_list(tile, area),
        }
    }

    /// The same for an area whose middle and radii are known in columns and rows of a raster.
    fn of_raster(raster: &Raster, [across, along]: [f64; 2], radii: [f64; 2]) -> [Self; 2] {
        let farthest = [across.abs() + radii[0], along.abs() + radii[1]];
        match *raster {
            Raster::Parallel { middle, right, down, direction } => {
                let magnitude = middle.abs() + farthest[0] * right.abs() + farthest[1] * down.abs();
                let origin = middle + (across * right + along * down);
                let origins = Self::new([origin, right, down], ROUNDINGS * magnitude, radii);
                [origins, Self::constant(direction)]
            }
            Raster::Spreading { eye, forward, right, down } => {
                let toward = forward + (across * right + along * down);
                let nearness = toward.length_recip();
                let direction = nearness * toward;
                let turn = |by: DVec3| nearness * (by - direction.dot(by) * direction);
                let reach = nearness * (radii[0] * right.length() + radii[1] * down.length());
                let rest = bend(reach) + ROUNDINGS * (1.0 + reach);
                let spread = [direction, turn(right), turn(down)];
                [Self::constant(eye), Self::new(spread, DVec3::splat(rest), radii)]
            }
        }
    }

    /// The same for any rays: affine functions through those at the corners, and how far the others are off.
    fn of_list(tile: &Tile<'_>, area: Area) -> [Self; 2] {
        let corners = area.corners().map(|(column, row)| tile.ray(column, row));
        let slope = |change: DVec3, length: usize| change / (2 * length.max(2) - 2) as f64;
        [false, true].map(|are_directions| {
            let vector = |ray: crate::Ray| if are_directions { ray.direction } else { ray.origin };
            let [a, b, c, d] = corners.map(vector);
            let middle = 0.25 * (a + b + c + d);
            let by_column = slope((b - a) + (d - c), area.width);
            let by_row = slope((c - a) + (d - b), area.height);
            let radii = area.radii();
            let mut deviation = DVec3::ZERO;
            for row in area.rows() {
                for column in area.columns() {
                    let (across, along) = area.offset(column, row);
                    let fitted = middle + (across * by_column + along * by_row);
                    deviation = deviation.max((vector(tile.ray(column, row)) - fitted).abs());
                }
            }
            let magnitude = middle.abs() + radii[0] * by_column.abs() + radii[1] * by_row.abs() + deviation;
            Self::new([middle, by_column, by_row], deviation + ROUNDINGS * magnitude, radii)
        })
    }

    fn new([middle, by_column, by_row]: [DVec3; 3], rest: DVec3, radii: [f64; 2]) -> Self {
        let rest = rest + DVec3::splat(f64::MIN_POSITIVE);
        let across = radii[0] * by_column.abs() + radii[1] * by_row.abs();
        let radius = (1.0 + ROUNDINGS) * (across + rest);
        Self { middle, by_column, by_row, rest, radius, size: (1.0 + ROUNDINGS) * (middle.abs() + radius) }
    }

    fn constant(vector: DVec3) -> Self {
        let none = DVec3::ZERO;
        Self { middle: vector, by_column: none, by_row: none, rest: none, radius: none, size: vector.abs() }
    }
}

/// How far (u + e)/|u + e| may be from its linear approximation in e, for a unit vector u and |e| ≤ `reach`.
///
/// Along a unit vector at an angle to v whose cosine is c, the second derivative of v/|v| has the length
/// √(1 + 2c² − 3c⁴)/|v|², which is no more than √(4/3)/|v|², and |v| ≥ 1 − |e|. Where that says little: the two are no
/// longer than 1 and 1 + |e|.
fn bend(reach: f64) -> f64 {
    if reach < 0.5 { 0.578 * (reach / (1.0 - reach)).powi(2) } else { 2.0 + reach }
}

#[cfg(test)]
mod tests {
    use iso_expr::random::Random;

    use super::*;

    /// A raster seen from anywhere, with pixels of any size.
    fn raster(random: &mut Random, is_parallel: bool) -> Raster {
        let mut vector = || DVec3::from_array([(); 3].map(|()| random.between(-3.0, 3.0)));
        let (middle, forward, up) = (vector(), vector().normalize(), vector());
        let spacing = 10f64.powf(vector().x);
        let right = spacing * forward.cross(up).normalize();
        let down = forward.cross(right);
        if is_parallel {
            Raster::Parallel { middle, right, down, direction: 0.7 * forward }
        } else {
            Raster::Spreading { eye: middle, forward, right, down }
        }
    }

    #[test]
    fn every_ray_of_an_area_is_in_its_spread() {
        let mut random = Random::new(5);
        let mut tightest = [f64::INFINITY; 2];
        for round in 0..400 {
            let raster = raster(&mut random, round % 2 == 0);
            let first = [(); 2].map(|()| random.below(2000) as f64 - 1000.5);
            let tile = Tile::of(&raster, first, 40, 33);
            let listed: Vec<_> = tile.rays().collect();
            for tile in [tile, Tile::listed(&listed, 40)] {
                let side = 1 + random.below(24);
                let area = Area {
                    column: random.below(16),
                    row: random.below(9),
                    width: side,
                    height: 1 + side / 2,
                };
                let spreads = Spread::of(&tile, area);
                for row in area.rows() {
                    for column in area.columns() {
                        let ray = tile.ray(column, row);
                        let (a, b) = area.offset(column, row);
                        for (which, vector) in [ray.origin, ray.direction].into_iter().enumerate() {
                            let spread = &spreads[which];
                            let affine = spread.middle + (a * spread.by_column + b * spread.by_row);
                            assert!((vector - affine).abs().cmple(spread.rest).all(), "{raster:?}, {area:?}");
                            assert!((vector - spread.middle).abs().cmple(spread.radius).all());
                            assert!(vector.abs().cmple(spread.size).all());
                            let rest = spread.rest.max_element();
                            if rest > 1e-12 && matches!(tile.rays, Rays::Raster { .. }) {
                                let used = (vector - affine).length();
                                tightest[which] = tightest[which].min(rest / used);
                            }
                        }
                    }
                }
            }
        }
        // The bound of directions is a bound for any angle: rays across it use most of it.
        assert!(tightest[1] < 2.5, "{tightest:?}");
    }
}
