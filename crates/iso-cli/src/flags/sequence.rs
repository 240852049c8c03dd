//! Flags of sequences of pictures.

use clap::Args;

use crate::values::{self, Sweep};

/// How the pictures of a sequence differ.
#[derive(Debug, Args)]
#[command(next_help_heading = "Sequence", allow_negative_numbers = true)]
pub(crate) struct SequenceFlags {
    /// Walk once around the surface, counter-clockwise seen from above
    #[arg(long, conflicts_with = "eye")]
    pub(crate) turntable: bool,

    /// Let a parameter of the formula run from one value to another; may be repeated
    #[arg(long, value_name = "NAME=FROM:TO")]
    pub(crate) sweep: Vec<Sweep>,

    /// How many pictures; they become an animation where the picture is a .gif, as iso.gif where none is named, and numbered files else
    /// [default: 36]
    #[arg(long, value_name = "N", value_parser = values::whole(2..=1000_u32))]
    pub(crate) frames: Option<u32>,
}

impl SequenceFlags {
    /// Whether there is a sequence.
    pub(crate) fn is_wanted(&self) -> bool {
        self.turntable || !self.sweep.is_empty()
    }

    /// How many pictures it has.
    pub(crate) fn count(&self) -> u32 {
        self.frames.unwrap_or(36)
    }
}
