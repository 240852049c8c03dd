//! Times on the wall and on processors, and how they spread.

use std::time::Duration;

use iso_render::Stopwatch;
use serde::Serialize;

/// Runs `work` and says how long it took on the clock on the wall.
pub(crate) fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let watch = Stopwatch::start();
    let result = work();
    (result, watch.elapsed())
}

/// A duration in milliseconds.
pub(crate) fn milliseconds(duration: Duration) -> f64 {
    1e3 * duration.as_secs_f64()
}

/// Milliseconds that the phases of a picture took.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(crate) struct Phases {
    /// From text to programs: parsing, lowering, simplifying.
    pub(crate) parse: f64,
    /// From programs to kernels: differentiating, compiling.
    pub(crate) compile: f64,
    /// What the method prepares before the first ray.
    pub(crate) preprocess: f64,
    /// Following rays.
    pub(crate) trace: f64,
    /// Normals and colours.
    pub(crate) shade: f64,
    /// From colours to files.
    pub(crate) encode: f64,
}

impl Phases {
    /// All phases together.
    pub(crate) fn total(&self) -> f64 {
        self.parse + self.compile + self.preprocess + self.trace + self.shade + self.encode
    }
}

impl std::ops::AddAssign for Phases {
    fn add_assign(&mut self, other: Self) {
        self.parse += other.parse;
        self.compile += other.compile;
        self.preprocess += other.preprocess;
        self.trace += other.trace;
        self.shade += other.shade;
        self.encode += other.encode;
    }
}

/// Runs `work` and adds its milliseconds to `phase`.
pub(crate) fn add_to<T>(phase: &mut f64, work: impl FnOnce() -> T) -> T {
    let (result, duration) = timed(work);
    *phase += milliseconds(duration);
    result
}

/// Milliseconds that something took.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(crate) struct Cost {
    /// On the clock on the wall.
    pub(crate) wall: f64,
    /// On processors, all threads together, where the system tells.
    pub(crate) processor: Option<f64>,
}

impl Cost {
    /// A part of it, from 0 to 1.
    pub(crate) fn share(self, part: f64) -> Self {
        Self { wall: part * self.wall, processor: self.processor.map(|processor| part * processor) }
    }
}

/// Runs `work` and says what it cost.
pub(crate) fn weighed<T>(work: impl FnOnce() -> T) -> (T, Cost) {
    let before = processor_time();
    let (result, wall) = timed(work);
    let processor = before.zip(processor_time()).map(|(before, after)| milliseconds(after - before));
    (result, Cost { wall: milliseconds(wall), processor })
}

/// A time after which nothing new is begun.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deadline {
    watch: Stopwatch,
    allowed: Duration,
}

impl Deadline {
    /// So long from now.
    pub(crate) fn after(allowed: Duration) -> Self {
        Self { watch: Stopwatch::start(), allowed }
    }

    /// No deadline.
    pub(crate) fn never() -> Self {
        Self::after(Duration::MAX)
    }

    /// A deadline that gives a fair part of the time that is left to the first of `claimants`.
    pub(crate) fn share(&self, claimants: usize) -> Self {
        let left = self.allowed.saturating_sub(self.watch.elapsed());
        Self::after(left / u32::try_from(claimants).unwrap_or(u32::MAX).max(1))
    }

    /// Whether it has come.
    pub(crate) fn is_over(&self) -> bool {
        self.watch.elapsed() >= self.allowed
    }
}

/// The time that all threads of this process spent on processors so far, where the system tells.
#[cfg(unix)]
fn processor_time() -> Option<Duration> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Some(Duration::new(time.tv_sec.try_into().ok()?, time.tv_nsec.try_into().ok()?))
}

/// The time that all threads of this process spent on processors so far, where the system tells.
#[cfg(not(unix))]
fn processor_time() -> Option<Duration> {
    None
}

/// How measurements of the same thing spread.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Spread {
    /// The middle measurement.
    pub(crate) median: f64,
    /// The least measurement.
    pub(crate) least: f64,
    /// The greatest measurement.
    pub(crate) greatest: f64,
}

impl Spread {
    /// The spread of at least one measurement.
    pub(crate) fn of(measurements: &[f64]) -> Self {
        let mut sorted = measurements.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (least, greatest) = (sorted[0], sorted[sorted.len() - 1]);
        let (below, above) = (sorted[(sorted.len() - 1) / 2], sorted[sorted.len() / 2]);
        Self { median: 0.5 * (below + above), least, greatest }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_orders_its_measurements() {
        let odd = Spread::of(&[3.0, 1.0, 2.0]);
        assert_eq!((odd.least, odd.median, odd.greatest), (1.0, 2.0, 3.0));
        let even = Spread::of(&[4.0, 1.0, 3.0, 2.0]);
        assert_eq!((even.least, even.median, even.greatest), (1.0, 2.5, 4.0));
    }
}
