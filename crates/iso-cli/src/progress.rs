//! What is shown while work takes a while.

use std::sync::OnceLock;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use iso_render::Stopwatch;

/// Work that takes less than this shows nothing.
const PATIENCE: Duration = Duration::from_millis(500);

/// How often the time that was waited is shown anew.
const TICK: Duration = Duration::from_millis(100);

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

/// Does work of which nobody knows how much is left, and says on a terminal what is waited for when it takes longer than half a second. Nothing is
/// shown unless `is_wanted`.
pub(crate) fn waiting<T>(what: &'static str, is_wanted: bool, work: impl FnOnce() -> T) -> T {
    if !is_wanted {
        return work();
    }
    let (done, is_done) = channel::<()>();
    thread::scope(|scope| {
        scope.spawn(move || {
            if is_done.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                let style = ProgressStyle::with_template("{spinner} {msg}, {elapsed}")
                    .expect("the template is well formed");
                let spinner = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr())
                    .with_style(style)
                    .with_message(what);
                spinner.enable_steady_tick(TICK);
                // Until the sender is dropped, which never sends.
                let _ = is_done.recv();
                spinner.finish_and_clear();
            }
        });
        let _done = done;
        work()
    })
}
