//! What the pixels of a picture are worth, beside what is proven of them.

use iso_grid::{Ray, Surface, Workspace};
use iso_render::Picture;
use serde::Serialize;

use crate::comparison::{Answers, Distance, Verdict, compare};
use crate::engine::engine;
use crate::failure::Failure;
use crate::flags::EngineName;
use crate::measurement::Subject;

/// Judges a picture pixel by pixel. Both pictures have the layers `color` and `outcomes`.
pub(crate) fn verdicts(
    subject: &Subject,
    proven: &Picture,
    picture: &Picture,
) -> Result<Vec<Verdict>, Failure> {
    let size = subject.size;
    let rays: Vec<Ray> = (0..size.height())
        .flat_map(|row| (0..size.width()).map(move |column| (column, row)))
        .map(|(column, row)| subject.camera.ray(column, row))
        .collect();
    let surface = Surface::new(engine(EngineName::Jit)?, subject.program.clone());
    let mut workspace = Workspace::default();
    let mut answers = |picture: &Picture| {
        Answers::new(&surface, &mut workspace, &rays, picture.outcomes.iter().copied().collect())
    };
    Ok(compare(&surface, &rays, &answers(proven)?, &answers(picture)?)?)
}

/// Pixels by verdict, and how far right ones are from what is proven.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Quality {
    /// Pixels that show the proven root, or nothing where that is proven.
    pub(crate) right: usize,
    /// Pixels that show nothing, or a later root, where there is a root.
    pub(crate) missed: usize,
    /// Pixels that show a root where it is proven that there is none.
    #[serde(rename = "false")]
    pub(crate) made_up: usize,
    /// Pixels that the method left undecided, though it is proven how they end.
    pub(crate) undecided: usize,
    /// Pixels of which too little is proven to judge.
    pub(crate) open: usize,
    /// |t − t*| in units of x, y and z.
    pub(crate) distance: Deviation,
    /// |t − t*| in units in the last place of t*.
    pub(crate) ulps: Deviation,
    /// |F − C| at the points found.
    pub(crate) residual: Deviation,
    /// The angle between normals, in radians.
    pub(crate) angle: Deviation,
    /// The peak signal-to-noise ratio of the picture in decibels; none where the pictures are equal.
    pub(crate) psnr: Option<f64>,
    /// The greatest difference of a channel of a pixel, 0 to 255.
    pub(crate) worst_channel: u8,
}

impl Quality {
    /// What `verdicts` come to, and how far the picture's colours are from the proven one's.
    pub(crate) fn of(verdicts: &[Verdict], proven: &Picture, picture: &Picture) -> Self {
        let count = |wanted: fn(&Verdict) -> bool| verdicts.iter().filter(|verdict| wanted(verdict)).count();
        let deviation = |number: fn(&Distance) -> f64| {
            Deviation::of(verdicts.iter().filter_map(|verdict| match verdict {
                Verdict::Found(distance) => Some(number(distance)),
                _ => None,
            }))
        };
        let (psnr, worst_channel) = difference(&proven.color, &picture.color);
        Self {
            right: count(|verdict| matches!(verdict, Verdict::Found(_) | Verdict::Empty)),
            missed: count(|verdict| *verdict == Verdict::Missed),
            made_up: count(|verdict| *verdict == Verdict::False),
            undecided: count(|verdict| *verdict == Verdict::Undecided),
            open: count(|verdict| *verdict == Verdict::Open),
            distance: deviation(|distance| distance.length),
            ulps: deviation(|distance| distance.ulps),
            residual: deviation(|distance| distance.residual),
            angle: deviation(|distance| distance.angle),
            psnr,
            worst_channel,
        }
    }

    /// Pixels that are not as proven.
    pub(crate) fn wrong(&self) -> usize {
        self.missed + self.made_up + self.undecided
    }
}

/// How numbers that are best zero are spread; NaN where there are none.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Deviation {
    /// The greatest.
    pub(crate) max: f64,
    /// The mean.
    pub(crate) mean: f64,
    /// The 99.9th percentile: the least number that 99.9 % of all do not exceed.
    pub(crate) p999: f64,
}

impl Deviation {
    /// NaN among the numbers, as angles have where there is no normal, is left out.
    fn of(numbers: impl Iterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = numbers.filter(|number| !number.is_nan()).collect();
        sorted.sort_by(f64::total_cmp);
        let Some(&max) = sorted.last() else {
            return Self { max: f64::NAN, mean: f64::NAN, p999: f64::NAN };
        };
        let rank = (sorted.len() * 999).div_ceil(1000);
        Self { max, mean: sorted.iter().sum::<f64>() / sorted.len() as f64, p999: sorted[rank - 1] }
    }
}

/// The peak signal-to-noise ratio, none for equal pictures, and the greatest difference.
fn difference(expected: &[[u8; 3]], found: &[[u8; 3]]) -> (Option<f64>, u8) {
    let channels = expected.as_flattened().iter().zip(found.as_flattened());
    let differences: Vec<u8> = channels.map(|(one, other)| one.abs_diff(*other)).collect();
    let worst = differences.iter().copied().max().unwrap_or(0);
    let squares: u64 = differences.iter().map(|&difference| u64::from(difference).pow(2)).sum();
    let psnr =
        (squares > 0).then(|| 10.0 * (255.0f64.powi(2) * differences.len() as f64 / squares as f64).log10());
    (psnr, worst)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deviations_are_those_of_closed_forms() {
        let numbers = (1..=2000).rev().map(f64::from).chain([f64::NAN]);
        assert_eq!(Deviation::of(numbers), Deviation { max: 2000.0, mean: 1000.5, p999: 1998.0 });
        assert!(Deviation::of([].into_iter()).max.is_nan());
    }

    #[test]
    fn pictures_differ_by_decibels() {
        let black = [[0; 3]; 4];
        assert_eq!(difference(&black, &black), (None, 0));
        assert_eq!(difference(&black, &[[255; 3]; 4]), (Some(0.0), 255));
        let (psnr, worst) = difference(&[[0, 0, 0], [0, 0, 0]], &[[0, 0, 0], [0, 0, 51]]);
        // One channel of six is off by a fifth of the range: 10 log₁₀ (6 · 25).
        assert!((psnr.unwrap() - 10.0 * 150.0f64.log10()).abs() < 1e-12 && worst == 51);
    }
}
