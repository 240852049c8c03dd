//! Flags of `iso render`.

use std::path::PathBuf;

use clap::Args;
use iso_render::{Size, Smoothing};

use super::{
    BackgroundFlag, CameraFlags, EngineFlag, FormulaFlags, LevelFlag, LimitFlags, MethodFlags, PaintFlags,
    SequenceFlags, ThreadsFlag,
};
use crate::values;

/// Draw a surface
///
/// Every pixel ends as hit, touch (the surface is met but not crossed, as by a double root), miss or undecided. The default
/// method proves hits and misses; the others sample.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct RenderFlags {
    #[command(flatten)]
    pub(crate) picture: PictureFlags,
    #[command(flatten)]
    pub(crate) paint: PaintFlags,
    #[command(flatten)]
    pub(crate) engine: EngineFlag,
    #[command(flatten)]
    pub(crate) threads: ThreadsFlag,
    #[command(flatten)]
    pub(crate) limit: LimitFlags,
    #[command(flatten)]
    pub(crate) sequence: SequenceFlags,
    #[command(flatten)]
    pub(crate) summary: SummaryFlags,
}

/// A picture: all that a plan of it depends on, and from where it is seen.
#[derive(Debug, Args)]
pub(crate) struct PictureFlags {
    #[command(flatten)]
    pub(crate) formula: FormulaFlags,
    #[command(flatten)]
    pub(crate) level: LevelFlag,
    #[command(flatten)]
    pub(crate) method: MethodFlags,
    #[command(flatten)]
    pub(crate) camera: CameraFlags,
    #[command(flatten)]
    pub(crate) output: LayerFlags,
}

/// What is written.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub(crate) struct LayerFlags {
    /// The picture; its extension says the format: png, jpg, webp, tif, bmp, ppm, qoi or gif; `-` is standard output, as png [default:
    /// iso.png, if nothing else is written]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,

    /// Width and height in pixels; one number is a square
    #[arg(long, value_name = "WxH", value_parser = values::size, default_value = "512x512")]
    pub(crate) size: Size,

    /// Smooth edges: draw N by N pixels for each pixel of the picture and average them
    #[arg(long, value_name = "N", value_parser = values::smoothing, default_value = "1")]
    #[arg(conflicts_with_all = ["depth", "normals", "points"])]
    pub(crate) smooth: Smoothing,

    /// Write the distance along each ray, as the channel Z of an OpenEXR file; nan where nothing was found
    #[arg(long, value_name = "FILE.exr")]
    pub(crate) depth: Option<PathBuf>,

    /// Write the unit normals, as the channels N.X, N.Y and N.Z of an OpenEXR file
    #[arg(long, value_name = "FILE.exr")]
    pub(crate) normals: Option<PathBuf>,

    /// Write a table with a row for each pixel: column,row,status,t,x,y,z,nx,ny,nz
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) points: Option<PathBuf>,

    // The last, for what follows would have its heading.
    #[command(flatten)]
    pub(crate) background: BackgroundFlag,
}

/// What is said when the picture is done.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub(crate) struct SummaryFlags {
    /// Print one JSON object with sizes, the plan, pixels by status, counters and milliseconds
    #[arg(long)]
    pub(crate) json: bool,

    /// Print no summary and no progress
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

const EXAMPLES: &str = "\
Examples:
  iso render '(x^2+y^2-1)^2 + 4z^2 + 0.5x = 0.2' -o doi.png
  iso render 'x^4 - 5x^2 + y^4 - 5y^2 + z^4 - 5z^2 + 11.8' --box -3,3 --ortho --view-width 8
  iso render 'sin(x)cos(y) + sin(y)cos(z) + sin(z)cos(x)' --level 0.3 --box -4,4 --yaw -20 --pitch 40
  iso render 'x^4 + y^4 + z^4 = 1' --smooth 3 -o figure.png
  iso render 'x^2 + y^2 = z^2 + 0.1 where z^2 < 3' --colors gold,teal --background none -o logo.png
  iso render '-x^2 - y^2 - z^2' --level -1 --method grid --grid 60 --json
  iso render @heart.txt --set a=0.5 --size 1920x1080 -o heart.png --points points.csv
  iso render 'x^2 + y^2 = z' --ortho --depth depth.exr
  iso render 'x^4 + y^4 + z^4 = 1' --turntable -o spin.gif
  iso render 'a := 2; x^a + y^a + z^a = 1' --sweep a=2:8 --frames 50 -o grow.png";
