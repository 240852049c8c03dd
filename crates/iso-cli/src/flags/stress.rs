//! Flags of `iso stress`.

use std::path::PathBuf;

use clap::Args;
use iso_render::Size;

use super::ThreadsFlag;
use crate::values;

/// Run the suite of hard cases: cliffs, poles, jumps, nearly touching sheets and the like
///
/// Every case is traced by every method on both engines. What the engines compute must agree bit for bit, values must lie in
/// their enclosures, and what the certified method proves must agree with what is known of the surface; the other
/// methods are held against it.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, after_help = EXAMPLES)]
pub(crate) struct StressFlags {
    /// Run this case alone
    #[arg(long, value_name = "NAME")]
    pub(crate) case: Option<String>,

    /// The width and height of each picture in pixels
    #[arg(long, value_name = "WxH", default_value = "48x48", value_parser = values::size)]
    pub(crate) size: Size,

    /// Print all figures as JSON, in place of the table
    #[arg(long)]
    pub(crate) json: bool,

    /// Write a page with a picture of each case for each method
    #[arg(long, value_name = "FILE.html")]
    pub(crate) html: Option<PathBuf>,

    /// Write what is promised, what is left open and why, and a table of all cases, as `docs/stability.md` is written
    #[arg(long, value_name = "FILE.md")]
    pub(crate) markdown: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) threads: ThreadsFlag,
}

const EXAMPLES: &str = "\
Examples:
  iso stress
  iso stress --case shell_1e-6 --size 256x256 --html shell.html
  iso stress --json --size 16x16
  iso stress --markdown docs/stability.md

Exit codes: 0 every promise held, 1 one did not, 2 bad usage.";
