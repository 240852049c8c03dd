//! Flags of `iso report`.

use std::ffi::OsString;
use std::num::NonZeroU32;
use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, ValueEnum};
use iso_grid::GridSettings;
use iso_render::Size;

use super::{CameraFlags, EngineName, LevelFlag, MethodName, RegionFlag, RootFinderName, ThreadsFlag};
use crate::values::{self, Setting};

const USAGE: &str = "iso report [OPTIONS] <FORMULA>\n       iso report [OPTIONS] --suite <SUITE>";

/// Measure what error each method and setting buys for what time
///
/// Draws a picture with every engine, method and setting in turns, and holds each pixel against what the certified method
/// proves of that pixel alone. The folder of the report gets report.csv, report.json, the page report.html, and its plots.
/// They are written anew while it goes on, so that an interrupted report is kept.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, after_help = EXAMPLES, override_usage = USAGE)]
pub(crate) struct ReportFlags {
    #[command(flatten)]
    pub(crate) subject: SubjectFlags,
    #[command(flatten)]
    pub(crate) level: LevelFlag,
    #[command(flatten)]
    pub(crate) region: RegionFlag,
    #[command(flatten)]
    pub(crate) camera: CameraFlags,
    #[command(flatten)]
    pub(crate) axes: AxesFlags,
    #[command(flatten)]
    pub(crate) sweep: SweepFlags,
    #[command(flatten)]
    pub(crate) threads: ThreadsFlag,
}

/// Which surfaces are drawn.
#[derive(Debug, Args)]
#[command(next_help_heading = "Formula")]
pub(crate) struct SubjectFlags {
    /// The formula; `@FILE` reads it from a file, `-` from standard input, `FILE.vm` is a model
    #[arg(value_name = "FORMULA", allow_hyphen_values = true, required_unless_present = "suite")]
    pub(crate) formula: Option<OsString>,

    /// Give a parameter of the formula another value; may be repeated
    #[arg(long = "set", value_name = "NAME=NUMBER")]
    pub(crate) settings: Vec<Setting>,

    /// Draw the scenes of a suite instead, in one report; they share the budget
    #[arg(long, value_name = "SUITE", value_enum, conflicts_with_all = ["formula", "settings", "level", "region"])]
    pub(crate) suite: Option<SuiteName>,
}

/// The suites of scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SuiteName {
    /// Surfaces that everybody draws
    Classic,
    /// Steep, thin, tiny and cancelling ones
    Stiff,
    /// Both, and poles, jumps, plateaus and the like
    All,
}

/// What is varied.
#[derive(Debug, Args)]
#[command(next_help_heading = "Axes of the sweep")]
pub(crate) struct AxesFlags {
    /// Methods of intersection
    #[arg(long, value_name = "METHOD,...", value_delimiter = ',', value_enum)]
    #[arg(default_value = "certified,grid,octree,direct")]
    pub(crate) methods: Vec<MethodName>,

    /// Engines
    #[arg(long, value_name = "ENGINE,...", value_delimiter = ',', value_enum, default_value = "jit,interp")]
    pub(crate) engines: Vec<EngineName>,

    /// Cells along every axis, for the methods grid and octree
    #[arg(long, value_name = "N,...", value_delimiter = ',', default_value = "8,15,30,60")]
    #[arg(value_parser = values::whole(1..=GridSettings::MOST_CELLS))]
    pub(crate) grids: Vec<u32>,

    /// Parts into which a cell beside the surface is cut, beside the default of each grid: 3 up to 20 cells, else 2
    #[arg(long, value_name = "M,...", value_delimiter = ',', default_value = "1,2,3")]
    #[arg(value_parser = values::whole(1..=GridSettings::LARGEST_REFINEMENT))]
    pub(crate) refines: Vec<u32>,

    /// Steps between samples, in parts of a cell; the method direct steps as for a grid of 30
    #[arg(long, value_name = "STEP,...", value_delimiter = ',', value_parser = values::step)]
    #[arg(default_value = "0.05,0.01")]
    pub(crate) steps: Vec<f64>,

    /// Root finders, for the methods that sample
    #[arg(long, value_name = "FINDER,...", value_delimiter = ',', value_enum)]
    #[arg(default_value = "bisection,itp,newton")]
    pub(crate) root_finders: Vec<RootFinderName>,

    /// Widths, relative to t, to which roots are narrowed; 0 goes on as far as the method does
    #[arg(long, value_name = "WIDTH,...", value_delimiter = ',', value_parser = values::tolerance)]
    #[arg(default_value = "0,1e-6")]
    pub(crate) tolerances: Vec<f64>,

    /// About how many operations the formulas have on which the engines are compared, beside the given one
    #[arg(long, value_name = "N,...", value_delimiter = ',')]
    #[arg(default_value = "3,10,30,100,300,1000,3000,10000")]
    #[arg(value_parser = values::whole(1..=50_000_u32))]
    pub(crate) sizes: Vec<u32>,

    /// Measure all combinations
    ///
    /// Without it, grids are combined with everything, and of engines, parts, steps and ways to find roots one at a time leaves the first
    /// of its list; ways to find roots vary in the middle one of the grids.
    #[arg(long)]
    pub(crate) cross: bool,
}

/// How it is measured, and where it goes.
#[derive(Debug, Args)]
#[command(next_help_heading = "Sweep")]
pub(crate) struct SweepFlags {
    /// The folder of the report; it is made if it is missing
    #[arg(short, long, value_name = "FOLDER", default_value = "report")]
    pub(crate) output: PathBuf,

    /// Width and height of the pictures
    #[arg(long, value_name = "WxH", value_parser = values::size, default_value = "256x256")]
    pub(crate) size: Size,

    /// How often each setting is measured
    #[arg(long, value_name = "N", default_value = "5", value_parser = values::times)]
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
  iso report 'sin(1/x) + y = z' --box 0.01,1 --methods grid,octree --grids 30,120 --steps 0.05
  iso report --suite classic --budget 10m -o classic/
  iso report @surface.txt --size 512x512 --runs 9 --budget 5m --json";
