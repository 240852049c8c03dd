//! Flags of `iso bench`.

use std::num::NonZeroU32;

use clap::Args;
use iso_render::Size;

use super::{FormulaFlags, LevelFlag, MethodFlags, ThreadsFlag};
use crate::values;

/// Measure the interpreter against native code
///
/// Both engines run in turns, so that a change of the machine's speed meets both; medians stand beside the least and greatest
/// measurement.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, after_help = EXAMPLES)]
pub(crate) struct BenchFlags {
    #[command(flatten)]
    pub(crate) formula: FormulaFlags,
    #[command(flatten)]
    pub(crate) level: LevelFlag,
    #[command(flatten)]
    pub(crate) method: MethodFlags,
    #[command(flatten)]
    pub(crate) measurement: MeasurementFlags,
    #[command(flatten)]
    pub(crate) threads: ThreadsFlag,
}

/// What is measured.
#[derive(Debug, Args)]
#[command(next_help_heading = "Measurement")]
pub(crate) struct MeasurementFlags {
    /// Width and height of the picture
    #[arg(long, value_name = "WxH", value_parser = values::size, default_value = "256x256")]
    pub(crate) size: Size,

    /// How often everything is measured
    #[arg(long, value_name = "N", default_value = "9", value_parser = values::times)]
    pub(crate) runs: NonZeroU32,

    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

const EXAMPLES: &str = "\
Examples:
  iso bench '(x^2+y^2-1)^2 + 4z^2 + 0.5x = 0.2'
  iso bench 'sin(x)cos(y) + sin(y)cos(z) + sin(z)cos(x)' --box -6,6 --method grid --threads 1
  iso bench @surface.txt --size 512x512 --runs 21 --json";
