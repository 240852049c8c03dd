//! `iso render`: pictures of surfaces.

mod request;
mod shots;

use std::io::{self, Write};

use crate::failure::Failure;
use crate::flags::{RenderFlags, SummaryFlags};
use crate::output::to_standard_output;
use crate::summary::{SequenceSummary, Summary};
use request::Request;

/// Draws a surface, once or as a sequence of pictures.
pub(crate) fn run(flags: RenderFlags) -> Result<(), Failure> {
    let speech = Speech::of(&flags.summary);
    let is_sequence = flags.sequence.is_wanted();
    let request = Request::resolve(flags)?;
    let (interruption, pixels) = (request.interruption.clone(), request.pixels());
    let summaries = request.fulfil(speech == Speech::Line)?;
    let drawn: u64 = summaries.iter().map(Summary::finished_pixels).sum();
    if is_sequence {
        say(speech, &SequenceSummary::of(summaries))?;
    } else {
        summaries.iter().try_for_each(|summary| say(speech, summary))?;
    }
    interruption.check_done(pixels - drawn, pixels, "pixels")
}

/// What is said when the pictures are done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Speech {
    Nothing,
    Line,
    Json,
}

impl Speech {
    fn of(flags: &SummaryFlags) -> Self {
        match (flags.json, flags.quiet) {
            (true, _) => Self::Json,
            (false, true) => Self::Nothing,
            (false, false) => Self::Line,
        }
    }
}

fn say(speech: Speech, summary: &(impl serde::Serialize + std::fmt::Display)) -> Result<(), Failure> {
    match speech {
        Speech::Json => to_standard_output(|writer| {
            serde_json::to_writer_pretty(&mut *writer, summary)?;
            writeln!(writer)
        }),
        Speech::Line => {
            // The picture is done: a summary that nobody can read does not spoil it.
            let _ = writeln!(io::stderr(), "{summary}");
            Ok(())
        }
        Speech::Nothing => Ok(()),
    }
}
