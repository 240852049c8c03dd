//! What a picture took, for programs (`--json`) and for people.

use std::io::{self, Write};

use iso_grid::Counters;
use iso_render::StatusCounts;
use serde::Serialize;

use crate::clock::Phases;
use crate::plan::PlanReport;

/// What a picture took. Its fields are the keys of `iso render --json`.
#[derive(Debug, Serialize)]
pub(crate) struct Summary {
    /// The files that were written.
    pub(crate) files: Vec<String>,
    /// The picture's width in pixels.
    pub(crate) width: u32,
    /// The picture's height in pixels.
    pub(crate) height: u32,
    /// The lower corner of the box.
    pub(crate) box_min: [f64; 3],
    /// The upper corner of the box.
    pub(crate) box_max: [f64; 3],
    /// The method of intersection.
    pub(crate) method: &'static str,
    /// The engine that evaluated the formula.
    pub(crate) engine: &'static str,
    /// Threads that worked.
    pub(crate) threads: usize,
    /// Operations of the simplified program of F − C.
    pub(crate) operations: usize,
    /// Operations of the simplified program of F − C and its gradient, if the gradient is needed.
    pub(crate) gradient_operations: Option<usize>,
    /// What was computed, what was left out, and why.
    pub(crate) plan: PlanReport,
    /// Drawn pixels by status: more than the picture has, if it is smoothed.
    pub(crate) pixels: StatusCounts,
    /// Counts of work.
    pub(crate) counters: Counters,
    /// Times.
    pub(crate) milliseconds: Phases,
}

impl Summary {
    /// Writes the summary as one JSON object.
    pub(crate) fn write_json(&self, writer: &mut dyn Write) -> io::Result<()> {
        serde_json::to_writer_pretty(&mut *writer, self)?;
        writeln!(writer)
    }

    /// The summary in one line.
    pub(crate) fn line(&self) -> String {
        let Self { pixels, milliseconds, .. } = self;
        let total = milliseconds.total();
        let times = [
            ("parse", milliseconds.parse),
            ("compile", milliseconds.compile),
            ("preprocess", milliseconds.preprocess),
            ("trace", milliseconds.trace),
            ("shade", milliseconds.shade),
            ("encode", milliseconds.encode),
        ];
        let unfinished = match pixels.unfinished {
            0 => String::new(),
            count => format!(", {count} unfinished"),
        };
        let times = times.map(|(phase, time)| format!("{phase} {time:.1}")).join(", ");
        format!(
            "{}: {}x{} pixels: {} hit, {} touch, {} miss, {} undecided{unfinished}; {total:.1} ms ({times})",
            self.files.join(", "),
            self.width,
            self.height,
            pixels.hit,
            pixels.touch,
            pixels.miss,
            pixels.undecided,
        )
    }
}
