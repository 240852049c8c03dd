//! Points of rays that are followed side by side, gathered for one call of a kernel.

use glam::DVec3;
use iso_expr::{BatchKernel, Scratch};

use crate::lanes::{ROW, Row};

/// Rows of points coordinate by coordinate, and room for what a kernel says of them.
///
/// Memory is kept, and what stands in it, for to fill it again would take as long as many a kernel.
#[derive(Debug, Default)]
pub(crate) struct PointRows {
    /// How many rows there are; more of them may be in memory.
    count: usize,
    coordinates: [Vec<Row>; 3],
    /// Of the ray at each point, for slopes.
    directions: [Vec<Row>; 3],
    /// What all that stands in `directions` is, if all of it is the same.
    common: Option<DVec3>,
    values: Vec<Row>,
}

/// Rows of points, coordinate by coordinate, to be written to.
pub(crate) type Coordinates<'a> = [&'a mut [Row]; 3];

/// One of them.
#[inline(always)]
pub(crate) fn row_of<'a>([x, y, z]: &'a mut Coordinates<'_>, number: usize) -> [&'a mut Row; 3] {
    [&mut x[number], &mut y[number], &mut z[number]]
}

impl PointRows {
    /// So many rows of points in place of all others.
    pub(crate) fn replace(&mut self, count: usize) -> Coordinates<'_> {
        self.count = count;
        self.coordinates.each_mut().map(|rows| room(rows, count))
    }

    /// Leaves the first rows, so many of them.
    pub(crate) fn truncate(&mut self, count: usize) {
        self.count = self.count.min(count);
    }

    /// Makes these the directions of the rays, row by row. What stands behind them means nothing.
    pub(crate) fn aim_each<'a>(&mut self, directions: impl Iterator<Item = &'a [Row; 3]>) {
        self.common = None;
        let [x, y, z] = self.directions.each_mut().map(|rows| room(rows, self.count).iter_mut());
        x.zip(y).zip(z).zip(directions).for_each(|(((x, y), z), each)| [*x, *y, *z] = *each);
    }

    /// Makes this the direction of all rays.
    pub(crate) fn aim(&mut self, direction: DVec3) {
        if self.common == Some(direction) && self.directions[0].len() >= self.count {
            return;
        }
        for (rows, component) in self.directions.iter_mut().zip(direction.to_array()) {
            room(rows, self.count);
            rows.fill([component; ROW]);
        }
        self.common = Some(direction);
    }

    /// All `outputs` of the kernel at all points, those of row `i` of output `k` in row `k·count + i`, and the rows of points, so that others can be
    /// written in their place.
    pub(crate) fn evaluate(
        &mut self,
        kernel: &dyn BatchKernel,
        scratch: &mut Scratch,
        outputs: usize,
    ) -> (&[Row], Coordinates<'_>) {
        let [x, y, z] = first(&self.coordinates, self.count);
        let values = room(&mut self.values, outputs * self.count);
        kernel.evaluate(scratch, &[x, y, z], values.as_flattened_mut());
        (values, self.coordinates.each_mut().map(|rows| &mut rows[..self.count]))
    }

    /// F and its slope along the directions at all points, in the same way.
    pub(crate) fn slopes(
        &mut self,
        kernel: &dyn BatchKernel,
        scratch: &mut Scratch,
    ) -> (&[Row], Coordinates<'_>) {
        let [x, y, z] = first(&self.coordinates, self.count);
        let [dx, dy, dz] = first(&self.directions, self.count);
        let values = room(&mut self.values, 2 * self.count);
        kernel.evaluate(scratch, &[x, y, z, dx, dy, dz], values.as_flattened_mut());
        (values, self.coordinates.each_mut().map(|rows| &mut rows[..self.count]))
    }
}

/// The numbers of so many rows, coordinate by coordinate.
fn first(vectors: &[Vec<Row>; 3], count: usize) -> [&[f64]; 3] {
    vectors.each_ref().map(|rows| rows[..count].as_flattened())
}

/// So many rows, for which memory is taken if needed.
fn room(rows: &mut Vec<Row>, count: usize) -> &mut [Row] {
    rows.resize(count.max(rows.len()), Row::default());
    &mut rows[..count]
}

#[cfg(test)]
mod tests {
    use iso_expr::{Ast, Engine, Interpreter};

    use super::*;

    /// Whatever more stood in memory before.
    #[test]
    fn kernels_see_the_rows_that_were_put_last() {
        let program = Ast::parse("x + 2y + 3z * z").unwrap().lower(&[]).unwrap().minus_level(1.0);
        let [values, slopes] = [program.clone(), program.with_slope()]
            .map(|program| Interpreter.batch(&program.simplified()).unwrap());
        let (mut points, mut scratch) = (PointRows::default(), Scratch::default());
        let direction = |place: usize| [1.0, 0.5, 0.25 * place as f64];
        for (turn, count) in [3, 1, 2, 5, 4].into_iter().enumerate() {
            let at = |place: usize| [1, 10, 100].map(|scale| (scale * (8 * turn + place)) as f64);
            let of = |[x, y, z]: [f64; 3]| x + 2.0 * y + 3.0 * z * z - 1.0;
            // More than are left of them.
            let mut rows = points.replace(count + turn);
            for place in 0..count {
                let row = row_of(&mut rows, place);
                row.into_iter().zip(at(place)).for_each(|(row, number)| *row = [number; ROW]);
            }
            points.truncate(count);
            let expected: Vec<_> = (0..count).map(|place| [of(at(place)); ROW]).collect();
            assert_eq!(points.evaluate(&*values, &mut scratch, 1).0, expected);

            let one = DVec3::new(1.0, -1.0, turn as f64 / 2.0);
            for is_common in [true, false, true] {
                if is_common {
                    points.aim(one);
                } else {
                    let each: Vec<_> =
                        (0..count + 2).map(|place| direction(place).map(|number| [number; ROW])).collect();
                    points.aim_each(each.iter());
                }
                let slope = |place: usize| {
                    let [dx, dy, dz] = if is_common { one.to_array() } else { direction(place) };
                    dx + 2.0 * dy + 6.0 * at(place)[2] * dz
                };
                let [found, along] = points.slopes(&*slopes, &mut scratch).0.split_at(count).into();
                assert_eq!(found, expected);
                assert_eq!(along, (0..count).map(|place| [slope(place); ROW]).collect::<Vec<_>>());
            }
        }
    }
}
