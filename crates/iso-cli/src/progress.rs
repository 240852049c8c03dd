//! A progress bar for pictures that take a while.

use std::sync::OnceLock;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use iso_render::Stopwatch;

/// Work that takes less than this shows no bar.
const PATIENCE: Duration = Duration::from_millis(500);

/// A bar that appears on a terminal when the work takes longer than half a second.
pub(crate) struct Progress {
    watch: Stopwatch,
    is_wanted: bool,
    bar: OnceLock<ProgressBar>,
}

impl Progress {
    /// Begins now. Nothing is ever shown unless `is_wanted`, nor where standard error is no terminal.
    pub(crate) fn new(is_wanted: bool) -> Self {
        Self { watch: Stopwatch::start(), is_wanted, bar: OnceLock::new() }
    }

    /// Tells that `done` of `all` pixels are finished.
    pub(crate) fn report(&self, done: u64, all: u64) {
        if !self.is_wanted || self.watch.elapsed() < PATIENCE {
            return;
        }
        let bar = self.bar.get_or_init(|| {
            let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {eta} left")
                .expect("the template is well formed");
            ProgressBar::with_draw_target(Some(all), ProgressDrawTarget::stderr()).with_style(style)
        });
        bar.set_position(done);
    }

    /// Takes the bar away.
    pub(crate) fn finish(&self) {
        if let Some(bar) = self.bar.get() {
            bar.finish_and_clear();
        }
    }
}
