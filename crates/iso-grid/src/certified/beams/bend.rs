//! F over a stretch of a beam to second order.

use glam::DVec3;
use iso_expr::{Decorated, Decoration, Interval};
use pulp::Simd;

use super::beam::Beam;
use super::course::Course;
use super::form::{Ball, ROUNDING};
use crate::lanes::Lanes;

/// F near a point of a beam: for the ray that is a columns and b rows off its middle, F at `t` is
/// `value` · (1, a, b, a², a·b, b²) up to `value_error`, its derivative by t there is `slope` · (1, a, b) up to `slope_error`, and its
/// second derivative by t is in `curvature` on all of the stretch.
///
/// This is Taylor's theorem: the gradient of F is Lipschitz continuous on a box that holds the stretch, and its generalised
/// derivatives there are enclosed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bend {
    pub(super) t: f64,
    value: [f64; 6],
    value_error: f64,
    slope: [f64; 3],
    pub(super) slope_error: f64,
    pub(super) curvature: Interval,
}

/// Vectors, or the rows of matrices, no farther from `middle` than `radius`, component by component.
#[derive(Clone, Copy)]
struct Rows<const N: usize> {
    middle: [DVec3; N],
    radius: [DVec3; N],
}

impl<const N: usize> Rows<N> {
    fn around(intervals: [[Interval; 3]; N]) -> Self {
        let balls = intervals.map(|row| row.map(Ball::around));
        Self {
            middle: balls.map(|row| row.map(|ball| ball.middle).into()),
            radius: balls.map(|row| row.map(|ball| ball.radius).into()),
        }
    }
}

/// The product of a matrix, given by its rows, and a vector.
fn product(rows: &[DVec3; 3], vector: DVec3) -> DVec3 {
    DVec3::from_array(rows.map(|row| row.dot(vector)))
}

impl Bend {
    /// F around the middle of a beam at `t`, where F and its gradient are `jet`. The `hessian` holds on a box around the stretch: F, its
    /// gradient and then its second derivatives, as [`Program::with_hessian`](iso_expr::Program::with_hessian) orders them. `None`
    /// where the gradient is not continuous, or nothing is bounded.
    pub(super) fn new(
        beam: &Beam,
        (t, center): (f64, DVec3),
        jet: [Interval; 4],
        hessian: [Decorated; 10],
    ) -> Option<Self> {
        let [over_all, first @ .., xx, xy, xz, yy, yz, zz] = hessian;
        let [x, y, z] = first;
        let is_smooth = [over_all, x, y, z].iter().all(|found| found.decoration >= Decoration::Continuous)
            && [xx, xy, xz, yy, yz, zz].iter().all(|found| found.decoration >= Decoration::Defined);
        if !is_smooth {
            return None;
        }
        let hessian = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]].map(|row| row.map(|found| found.interval));
        let [value, gradient @ ..] = jet;
        let bend = Self::expanded(beam, (t, center), Ball::around(value), gradient, hessian);
        let is_finite =
            bend.value_error.is_finite() && bend.slope_error.is_finite() && bend.curvature.is_bounded();
        is_finite.then_some(bend)
    }

    fn expanded(
        beam: &Beam,
        (t, center): (f64, DVec3),
        value: Ball,
        gradient: [Interval; 3],
        hessian: [[Interval; 3]; 3],
    ) -> Self {
        let (o, d) = (&beam.origins, &beam.directions);
        let Rows { middle: [g], radius: [g_radius] } = Rows::around([gradient]);
        let Rows { middle: h, radius: h_radius } = Rows::around(hessian);
        let (g_size, h_size) = (g.abs(), h.map(DVec3::abs));
        let h_most = [0, 1, 2].map(|row| h_size[row] + h_radius[row]);
        // From the center to the point at t on a ray: a·column + b·row, and no more than `off` besides.
        let [column, row] = beam.across(t);
        let shift = (o.middle - center) + t * d.middle;
        let off = shift.abs() + o.rest + t * d.rest + ROUNDING * (o.size + t * d.size + center.abs());
        let across = beam.radii[0] * column.abs() + beam.radii[1] * row.abs();

        let value_error = value.radius
            + g_radius.dot(across)
            + 0.5 * across.dot(product(&h_radius, across))
            + off.dot(g_size + g_radius + product(&h_most, across + off))
            + ROUNDING * (value.middle.abs() + g_size.dot(across) + across.dot(product(&h_size, across)));
        let slope_error = g_radius.dot(d.size)
            + g_size.dot(d.rest)
            + product(&h_size, across).dot(d.radius)
            + product(&h_radius, across).dot(d.size)
            + product(&h_most, off).dot(d.size)
            + ROUNDING * (g_size + product(&h_size, across)).dot(d.size);
        let (h_column, h_row) = (product(&h, column), product(&h, row));
        Self {
            t,
            value: [
                value.middle,
                g.dot(column),
                g.dot(row),
                0.5 * column.dot(h_column),
                row.dot(h_column),
                0.5 * row.dot(h_row),
            ],
            value_error: (1.0 + ROUNDING) * value_error + f64::MIN_POSITIVE,
            slope: [
                g.dot(d.middle),
                h_column.dot(d.middle) + g.dot(d.by_column),
                h_row.dot(d.middle) + g.dot(d.by_row),
            ],
            slope_error: (1.0 + ROUNDING) * slope_error + f64::MIN_POSITIVE,
            curvature: curvature(beam, hessian),
        }
    }

    /// The same of −F.
    pub(super) fn negated(self) -> Self {
        Self {
            value: self.value.map(|part| -part),
            slope: self.slope.map(|part| -part),
            curvature: self.curvature.negated(),
            ..self
        }
    }

    /// What is known at `t` of rays that are so many columns and rows off the middle.
    #[inline(always)]
    pub(super) fn at<S: Simd>(&self, [across, along]: [Lanes<S>; 2]) -> Course<S> {
        let all = |number| across.all_be(number);
        let [value, by_column, by_row, by_columns, by_both, by_rows] = self.value;
        let [slope, slope_by_column, slope_by_row] = self.slope;
        Course {
            value: all(value)
                + across * (all(by_column) + across * all(by_columns) + along * all(by_both))
                + along * (all(by_row) + along * all(by_rows)),
            value_error: all(self.value_error),
            slope: all(slope) + across * all(slope_by_column) + along * all(slope_by_row),
            slope_error: all(self.slope_error),
        }
    }

    /// What is known at `t` of all rays no more than `radii` columns and rows from those that are so many off the middle.
    #[inline(always)]
    pub(super) fn around<S: Simd>(&self, middle: [Lanes<S>; 2], radii: [Lanes<S>; 2]) -> Course<S> {
        let ([across, along], [a, b]) = (middle, radii);
        let all = |number| across.all_be(number);
        let [_, by_column, by_row, by_columns, by_both, by_rows] = self.value;
        let [_, slope_by_column, slope_by_row] = self.slope;
        let course = self.at(middle);
        let column = all(by_column) + across * all(2.0 * by_columns) + along * all(by_both);
        let row = all(by_row) + along * all(2.0 * by_rows) + across * all(by_both);
        let value = a * (column.abs() + a * all(by_columns.abs()) + b * all(by_both.abs()))
            + b * (row.abs() + b * all(by_rows.abs()));
        let slope = a * all(slope_by_column.abs()) + b * all(slope_by_row.abs());
        let (rounding, more) = (all(ROUNDING), all(1.0 + ROUNDING));
        Course {
            value_error: more * (course.value_error + value) + rounding * course.value.abs(),
            slope_error: more * (course.slope_error + slope) + rounding * course.slope.abs(),
            ..course
        }
    }
}

/// The second derivatives along all rays of a beam.
fn curvature(beam: &Beam, hessian: [[Interval; 3]; 3]) -> Interval {
    let directions = [0, 1, 2].map(|axis| {
        let (middle, radius) = (beam.directions.middle[axis], beam.directions.radius[axis]);
        Interval::point(middle).plus(Interval { lo: -radius, hi: radius })
    });
    let mut sum = Interval::point(0.0);
    for (number, row) in hessian.into_iter().enumerate() {
        let along = directions[number];
        sum = sum.plus(row[number].times(along.times(along)));
        for other in number + 1..3 {
            // Twice, for the matrix is symmetric.
            let Interval { lo, hi } = row[other].times(along.times(directions[other]));
            sum = sum.plus(Interval { lo: 2.0 * lo, hi: 2.0 * hi });
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use iso_expr::random::Random;
    use iso_expr::{Ast, Interpreter, Scratch};
    use pulp::Scalar;

    use super::*;
    use crate::area::Area;
    use crate::batch::BoxBatch;
    use crate::{Kernel, Raster, Span, Surface, Tile};

    const FORMULAS: [&str; 5] = [
        "x^2 + y^2 + z^2 - 1",
        "x^4 - 5x^2 + y^4 - 5y^2 + z^4 - 5z^2 + 11.8",
        "sin(x)cos(y) + sin(y)cos(z) + sin(z)cos(x)",
        "exp(-x^2 - y z) + x/(4 + z)",
        "(x^2 + 2.25y^2 + z^2 - 1)^3 - x^2 z^3 - 0.1125y^2 z^3",
    ];

    struct Kernels {
        surface: Surface,
        boxes: BoxBatch,
        scratch: Scratch,
    }

    impl Kernels {
        /// F with its derivatives over a box.
        fn over(&mut self, lo: DVec3, hi: DVec3) -> [Decorated; 10] {
            self.boxes.replace(std::iter::once((lo, hi)));
            let kernel = &**self.surface.over_boxes(Kernel::HessianEnclosures).unwrap();
            self.boxes.evaluate(kernel, &mut self.scratch, 10);
            std::array::from_fn(|output| self.boxes.decorated(output, 0))
        }
    }

    fn vector(random: &mut Random) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| random.between(-1.0, 1.0)))
    }

    /// A raster of pixels of any size, and a part of it.
    fn tile(random: &mut Random, raster: &mut Option<Raster>) -> Area {
        let (eye, forward, up) = (vector(random), vector(random).normalize(), vector(random));
        let right = 10f64.powf(random.between(-4.0, -1.5)) * forward.cross(up).normalize();
        let down = forward.cross(right);
        *raster = Some(if random.below(2) == 0 {
            Raster::Parallel { middle: eye, right, down, direction: forward }
        } else {
            Raster::Spreading { eye, forward, right, down }
        });
        let side = 1 + random.below(16);
        Area { column: random.below(9), row: random.below(9), width: side, height: 1 + side / 2 }
    }

    #[test]
    fn every_ray_is_as_its_beam_says() {
        let mut random = Random::new(11);
        let mut bounded = 0;
        for round in 0..600 {
            let program = Ast::parse(FORMULAS[round % FORMULAS.len()]).unwrap().lower(&[]).unwrap();
            let surface = Surface::new(Arc::new(Interpreter), program.minus_level(0.0));
            let mut kernels = Kernels { surface, boxes: BoxBatch::default(), scratch: Scratch::default() };
            let mut raster = None;
            let area = tile(&mut random, &mut raster);
            let raster = raster.unwrap();
            let tile = Tile::of(&raster, [-12.5, -12.5], 25, 25);
            let beam = Beam::new(&tile, area);
            let start = random.between(0.1, 1.0);
            let reach = Span { start, end: start + 10f64.powf(random.between(-4.0, -0.7)) };
            let t = 0.5 * (reach.start + reach.end);
            let center = beam.origins.middle + t * beam.directions.middle;
            let [value, x, y, z, ..] = kernels.over(center, center).map(|found| found.interval);
            let (lo, hi) = beam.bounds_in_space(reach);
            let Some(bend) = Bend::new(&beam, (t, center), [value, x, y, z], kernels.over(lo, hi)) else {
                continue;
            };
            bounded += 1;
            for (row, column) in area.rows().flat_map(|row| area.columns().map(move |column| (row, column))) {
                let ray = tile.ray(column, row);
                let (a, b) = area.offset(column, row);
                let along = |found: [Interval; 3]| {
                    let products =
                        [0, 1, 2].map(|axis| found[axis].times(Interval::point(ray.direction[axis])));
                    products[0].plus(products[1]).plus(products[2])
                };
                let at = |kernels: &mut Kernels, t: f64| {
                    let point = ray.origin + t * ray.direction;
                    let off = 4.0 * f64::EPSILON * (point.abs() + DVec3::splat(t));
                    kernels.over(point - off, point + off).map(|found| found.interval)
                };
                let [value, x, y, z, ..] = at(&mut kernels, t);
                let slope = along([x, y, z]);
                let all = |numbers: [f64; 2]| numbers.map(|number| Lanes::all(Scalar::new(), number));
                let course = bend.at(all([a, b]));
                let around = bend.around(all([0.0; 2]), all(beam.radii));
                for (course, which) in [(course, "ray"), (around, "beam")] {
                    let is_in = |found: Interval, middle: Lanes<Scalar>, error: Lanes<Scalar>| {
                        // There is one of each.
                        let [middle, error] = [middle, error].map(Lanes::sum);
                        found.lo <= middle + error && middle - error <= found.hi
                    };
                    assert!(is_in(value, course.value, course.value_error), "{which}: {value}, {course:?}");
                    assert!(is_in(slope, course.slope, course.slope_error), "{which}: {slope}, {course:?}");
                }
                let [.., xx, xy, xz, yy, yz, zz] = at(&mut kernels, random.between(reach.start, reach.end));
                let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]].map(along);
                let curvature = along(rows);
                assert!(curvature.lo <= bend.curvature.hi && bend.curvature.lo <= curvature.hi);
            }
        }
        assert!(bounded > 500, "{bounded} beams");
    }
}
