//! Mean slopes of F near a point, for its normal where derivatives cannot be computed.

use std::iter;

use glam::DVec3;

use crate::normals::unit_of;

/// How far from a point F is taken, as powers of two of the [scale](Around::scale). Mean slopes are off from derivatives by the third derivative times
/// a sixth of the step's square, and by F's rounding errors over the step.
const STEPS: [i32; 5] = [-18, -22, -26, -30, -34];

/// A point whose normal is asked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Around {
    pub(crate) point: DVec3,
    /// The largest of the coordinates that it was computed from.
    pub(crate) scale: f64,
}

impl Around {
    /// At how many points F is to be taken.
    pub(crate) const POINTS: usize = 1 + 6 * STEPS.len();

    /// Where F is to be taken: at the point, and step by step before and behind it along each axis.
    pub(crate) fn points(self) -> impl Iterator<Item = DVec3> {
        let Self { point, .. } = self;
        let beside = self.steps().into_iter().flat_map(move |step| {
            DVec3::AXES.into_iter().flat_map(move |axis| [point - step * axis, point + step * axis])
        });
        iter::once(point).chain(beside)
    }

    fn steps(self) -> [f64; STEPS.len()] {
        STEPS.map(|power| self.scale * 2_f64.powi(power))
    }

    /// The direction of F's mean slopes along the axes, of these `values` at all [points](Self::points): over the step from which the next longer and
    /// the next shorter one change it least. NaN where no three of them have slopes, for which F is to be finite on a side of the point along each
    /// axis, and there too if only on one.
    pub(crate) fn normal(self, values: &[f64]) -> DVec3 {
        let (here, beside) = values.split_first().expect("F is taken at the point itself");
        let mut beside = beside.as_chunks::<2>().0.iter();
        let normals = self.steps().map(|step| {
            let slopes = DVec3::AXES.map(|axis| {
                let at = self.point.dot(axis);
                let &[before, behind] = beside.next().expect("F is taken along each axis");
                mean_slope([(at - step, before), (at, *here), (at + step, behind)])
            });
            unit_of(DVec3::from_array(slopes))
        });
        let changes = normals.windows(3).map(|of| (of[0].distance(of[1]) + of[1].distance(of[2]), of[1]));
        let least = changes.filter(|(change, _)| !change.is_nan()).min_by(|a, b| a.0.total_cmp(&b.0));
        least.map_or(DVec3::NAN, |(_, normal)| normal)
    }
}

/// The slope of a function between places where it has these values: from before a point to behind it, or on one side where that is not finite.
fn mean_slope([before, here, behind]: [(f64, f64); 3]) -> f64 {
    let slopes = [(before, behind), (here, behind), (before, here)].map(|(a, b)| (b.1 - a.1) / (b.0 - a.0));
    slopes.into_iter().find(|slope| slope.is_finite()).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn normal_of(function: impl Fn(DVec3) -> f64, point: DVec3) -> DVec3 {
        let around = Around { point, scale: 1.0 };
        let values: Vec<_> = around.points().map(function).collect();
        assert_eq!(values.len(), Around::POINTS);
        around.normal(&values)
    }

    /// Of third derivatives up to 10¹² times the slopes.
    #[test]
    fn mean_slopes_of_smooth_functions_are_derivatives_to_single_precision() {
        let point = DVec3::new(0.3, -0.2, 0.9);
        let waves = |frequency: f64| move |p: DVec3| (frequency * p.x).sin() / frequency + 2.0 * p.y - p.z;
        for frequency in [1.0, 1e3, 1e6] {
            let expected = DVec3::new((frequency * point.x).cos(), 2.0, -1.0).normalize();
            let found = normal_of(waves(frequency), point);
            assert!(found.distance(expected) < 1e-6, "{frequency}: {found}, not {expected}");
        }
    }

    #[test]
    fn a_function_with_an_end_has_slopes_on_one_side() {
        for end in [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Z] {
            let function = |p: DVec3| match p.dot(end) > 0.0 {
                true => f64::NAN,
                false => p.dot(DVec3::new(2.0, 3.0, 6.0)),
            };
            let found = normal_of(function, DVec3::ZERO);
            assert!(found.distance(DVec3::new(2.0, 3.0, 6.0) / 7.0) < 1e-15, "{found}");
        }
    }

    #[test]
    fn where_there_are_no_slopes_there_is_no_normal() {
        let functions: [fn(DVec3) -> f64; 3] = [
            |p| if p.x == 0.0 { p.y } else { f64::NAN },
            |p| if p.y == 0.0 { p.x } else { f64::INFINITY },
            |_| 1.0,
        ];
        for function in functions {
            assert!(normal_of(function, DVec3::ZERO).is_nan());
        }
    }
}
