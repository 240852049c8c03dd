//! Flags of `iso report`.

use std::num::NonZeroU32;
use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use iso_grid::GridSettings;
use iso_render::Size;

use super::{CameraFlags, FormulaFlags, LevelFlag, RegionFlag, ThreadsFlag};
use crate::values;

/// Measure what error each method and setting buys for what time
///
/// Draws one picture with every engine, method and setting in turns, and holds each pixel against what the certified method
/// proves of that pixel alone. The folder of the report gets report.csv, report.json, the page report.html, and its plots
/// error.svg and cells.svg. They are written anew after every measurement, so that an interrupted report is kept.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct ReportFlags {
    #[command(flatten)]
    pub(crate) formula: FormulaFlags,
    #[command(flatten)]
    pub(crate) level: LevelFlag,
    #[command(flatten)]
    pub(crate) region: RegionFlag,
    #[command(flatten)]
    pub(crate) camera: CameraFlags,
    #[command(flatten)]
    pub(crate) sweep: SweepFlags,
    #[command(flatten)]
    pub(crate) threads: ThreadsFlag,
}

/// What is measured.
#[derive(Debug, Args)]
#[command(next_help_heading = "Sweep")]
pub(crate) struct SweepFlags {
    /// The folder of the report; it is made if it is missing
    #[arg(short, long, value_name = "FOLDER", default_value = "report")]
    pub(crate) output: PathBuf,

    /// Cells along every axis, for the methods grid and octree
    #[arg(long, value_name = "N,...", value_delimiter = ',', default_values_t = [8, 15, 30, 60])]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=i64::from(GridSettings::MOST_CELLS)))]
    pub(crate) grids: Vec<u32>,

    /// Steps between samples, in parts of a cell; the method direct steps as for a grid of 30
    #[arg(long, value_name = "STEP,...", value_delimiter = ',', value_parser = values::step)]
    #[arg(default_values = ["0.05", "0.01"])]
    pub(crate) steps: Vec<f64>,

    /// Width and height of the picture
    #[arg(long, value_name = "WxH", value_parser = values::size, default_value = "256x256")]
    pub(crate) size: Size,

    /// How often each setting is measured
    #[arg(long, value_name = "N", default_value = "5")]
    pub(crate) runs: NonZeroU32,

    /// Begin no measurement after this time, such as 90s or 2m
    #[arg(long, value_name = "TIME", value_parser = values::duration, default_value = "60s")]
    pub(crate) budget: Duration,

    /// Print the report as one JSON object, too
    #[arg(long)]
    pub(crate) json: bool,
}

const EXAMPLES: &str = "\
Examples:
  iso report '(x^2+y^2-1)^2 + 4z^2 + 0.5x = 0.2' --budget 60s -o report/
  iso report 'sin(1/x) + y = z' --box 0.01,1 --grids 30,120 --steps 0.05
  iso report @surface.txt --size 512x512 --runs 9 --budget 5m --json";
