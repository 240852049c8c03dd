//! How long one evaluation takes.

use std::hint::black_box;
use std::time::Duration;

use glam::DVec3;
use iso_expr::{BatchKernel, PointKernel, Scratch};
use iso_grid::Region;

use crate::clock::timed;

/// Evaluations are repeated until they take about this long.
const LONG_ENOUGH: Duration = Duration::from_millis(5);

/// Points at which a formula of one output is evaluated.
pub(crate) struct SpreadPoints([Vec<f64>; 3]);

impl SpreadPoints {
    /// How many there are.
    const COUNT: usize = 4096;

    /// Points spread evenly over the region.
    pub(crate) fn over(region: &Region) -> Self {
        let points: Vec<DVec3> = spread(region).take(Self::COUNT).collect();
        Self([0, 1, 2].map(|axis| points.iter().map(|point| point[axis]).collect()))
    }

    /// Nanoseconds of one evaluation when each point is asked for by itself.
    pub(crate) fn one_by_one(&self, kernel: &dyn PointKernel) -> f64 {
        let (mut scratch, mut value) = (Scratch::default(), [0.0]);
        let [x, y, z] = &self.0;
        nanoseconds_each(|| {
            for ((&x, &y), &z) in x.iter().zip(y).zip(z) {
                kernel.evaluate(&mut scratch, x, y, z, &mut value);
                black_box(&mut value);
            }
        })
    }

    /// Nanoseconds of one evaluation when all points are asked for together.
    pub(crate) fn together(&self, kernel: &dyn BatchKernel) -> f64 {
        let (mut scratch, mut values) = (Scratch::default(), vec![0.0; Self::COUNT]);
        let [x, y, z] = &self.0;
        nanoseconds_each(|| {
            kernel.evaluate(&mut scratch, &[x, y, z], &mut values);
            black_box(&mut values);
        })
    }
}

/// Points spread evenly over a region, without end: the additive recurrence of Roberts (2018), whose steps are powers of the
/// root of x⁴ = x + 1.
pub(crate) fn spread(region: &Region) -> impl Iterator<Item = DVec3> + use<> {
    let (corner, extent) = (region.min(), region.extent());
    const ROOT: f64 = 1.220_744_084_605_759_5;
    let steps = DVec3::new(ROOT.powi(-1), ROOT.powi(-2), ROOT.powi(-3));
    (0_u32..).map(move |index| corner + extent * (0.5 + f64::from(index) * steps).fract())
}

/// Nanoseconds of one of the evaluations that `work` does at all points.
fn nanoseconds_each(mut work: impl FnMut()) -> f64 {
    let ((), once) = timed(&mut work);
    let repeats = (LONG_ENOUGH.as_secs_f64() / once.as_secs_f64().max(1e-9)).clamp(1.0, 1e4) as u32;
    let ((), all) = timed(|| (0..repeats).for_each(|_| work()));
    1e9 * all.as_secs_f64() / (f64::from(repeats) * SpreadPoints::COUNT as f64)
}
