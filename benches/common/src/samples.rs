//! Repeated measurements and how far they spread.

use std::fmt;
use std::time::{Duration, Instant};

/// Measurements of one quantity, in the order in which they were taken.
#[derive(Clone, Debug, Default)]
pub struct Samples(Vec<f64>);

impl Samples {
    /// Adds one measurement.
    pub fn push(&mut self, value: f64) {
        self.0.push(value);
    }

    /// All measurements in order.
    pub fn values(&self) -> &[f64] {
        &self.0
    }

    /// Each measurement as a multiple of the one taken in the same turn of `other`.
    pub fn over(&self, other: &Self) -> Self {
        Self(self.0.iter().zip(&other.0).map(|(a, b)| a / b).collect())
    }

    /// The median and the quartiles around it.
    ///
    /// # Panics
    /// When nothing was measured.
    pub fn spread(&self) -> Spread {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        Spread {
            lower: quantile(&sorted, 0.25),
            median: quantile(&sorted, 0.5),
            upper: quantile(&sorted, 0.75),
        }
    }
}

impl FromIterator<f64> for Samples {
    fn from_iter<T: IntoIterator<Item = f64>>(values: T) -> Self {
        Self(values.into_iter().collect())
    }
}

/// Between which values the middle half of some measurements lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// A quarter of the measurements is below.
    pub lower: f64,
    /// Half of the measurements is below.
    pub median: f64,
    /// A quarter of the measurements is above.
    pub upper: f64,
}

/// The median, then both quartiles in brackets. The precision counts significant digits; it is 3 by default.
impl fmt::Display for Spread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = f.precision().unwrap_or(3);
        let text = [self.median, self.lower, self.upper].map(|value| rounded(value, digits));
        f.pad(&format!("{} [{}..{}]", text[0], text[1], text[2]))
    }
}

/// `value` with at least this many significant digits, all those before the point included.
pub fn rounded(value: f64, digits: usize) -> String {
    let before_point = if value == 0.0 { 1 } else { value.abs().log10().floor() as i64 + 1 };
    let after_point = usize::try_from(digits as i64 - before_point).unwrap_or(0);
    format!("{value:.after_point$}")
}

/// The value below which a part of the sorted values lies, interpolated between neighbours.
fn quantile(sorted: &[f64], part: f64) -> f64 {
    let place = part * (sorted.len() - 1) as f64;
    let (below, above) = (place.floor() as usize, place.ceil() as usize);
    sorted[below] + (place - place.floor()) * (sorted[above] - sorted[below])
}

/// Something that is measured, and what it took, in seconds a call.
pub struct Contender<'a> {
    /// Its name in tables.
    pub name: &'static str,
    /// Does once what is measured.
    pub run: Box<dyn FnMut() + 'a>,
    /// Seconds a call, one for each turn.
    pub seconds: Samples,
}

impl<'a> Contender<'a> {
    /// A contender that was not measured yet.
    pub fn new(name: &'static str, run: impl FnMut() + 'a) -> Self {
        Self { name, run: Box::new(run), seconds: Samples::default() }
    }

    /// Seconds that one of `calls` calls takes.
    fn time(&mut self, calls: u32) -> f64 {
        let start = Instant::now();
        for _ in 0..calls {
            (self.run)();
        }
        start.elapsed().as_secs_f64() / f64::from(calls)
    }
}

/// Measures the contenders in turns, so that whatever slows the machine down for a while slows all of them down.
///
/// Each is called once to warm up. In each of the `turns` it is called as often as `least` takes, at least once.
pub fn measure_in_turns(contenders: &mut [Contender<'_>], turns: usize, least: Duration) {
    let calls: Vec<u32> = contenders
        .iter_mut()
        .map(|contender| {
            contender.time(1);
            let mut calls = 1;
            while contender.time(calls) * f64::from(calls) < least.as_secs_f64() {
                calls *= 2;
            }
            calls
        })
        .collect();
    for _ in 0..turns {
        for (contender, calls) in contenders.iter_mut().zip(&calls) {
            let seconds = contender.time(*calls);
            contender.seconds.push(seconds);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_are_interpolated() {
        let samples: Samples = [4.0, 1.0, 3.0, 2.0].into_iter().collect();
        assert_eq!(samples.spread(), Spread { lower: 1.75, median: 2.5, upper: 3.25 });
    }

    #[test]
    fn spreads_are_printed_with_significant_digits() {
        let spread = Spread { lower: 0.01234, median: 1234.4, upper: 0.0 };
        assert_eq!(spread.to_string(), "1234 [0.0123..0.00]");
    }
}
