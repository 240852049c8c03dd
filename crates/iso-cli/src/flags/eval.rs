//! Flags of `iso eval`.

use std::path::PathBuf;

use clap::{ArgGroup, Args};
use glam::DVec3;

use super::{EngineFlag, FormulaFlags, LevelFlag, TableFlags};
use crate::values;

/// Evaluate a formula at points or over boxes
///
/// The value of an equation is its left side minus its right side, and that of an expression is less by `--level`. Numbers
/// are written with the digits that read back to the same float.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, after_help = EXAMPLES, group = ArgGroup::new("places").required(true))]
pub(crate) struct EvalFlags {
    #[command(flatten)]
    pub(crate) formula: FormulaFlags,
    #[command(flatten)]
    pub(crate) level: LevelFlag,
    #[command(flatten)]
    pub(crate) places: PlacesFlags,
    #[command(flatten)]
    pub(crate) table: TableFlags,
    #[command(flatten)]
    pub(crate) engine: EngineFlag,
}

/// Where the formula is evaluated, and what of it.
#[derive(Debug, Args)]
#[command(next_help_heading = "Places and values")]
pub(crate) struct PlacesFlags {
    /// A point; may be repeated
    #[arg(long, value_name = "X,Y,Z", group = "places", allow_hyphen_values = true, value_parser = values::vector)]
    pub(crate) at: Vec<DVec3>,

    /// A table of points with the columns x,y,z; `-` is standard input
    #[arg(long, value_name = "FILE.csv", group = "places")]
    pub(crate) points: Option<PathBuf>,

    /// A table of boxes with the columns x_lo,x_hi,y_lo,y_hi,z_lo,z_hi; `-` is standard input
    #[arg(long, value_name = "FILE.csv", group = "places")]
    pub(crate) boxes: Option<PathBuf>,

    /// Add the derivatives along x, y and z
    #[arg(long)]
    pub(crate) gradient: bool,

    /// Add to each value a bound of its rounding error, and how many digits it may have lost
    #[arg(long, conflicts_with = "boxes")]
    pub(crate) error: bool,
}

const EXAMPLES: &str = "\
Columns of the result: value (and dx,dy,dz) at points; lo,hi,decoration (and dx_lo,dx_hi,dx_decoration and so on) over boxes.
The decoration says what is known of the formula on the box: com (defined, continuous, bounded), dac (defined, continuous),
def (defined) or trv (nothing).
With --error, each column v of a value is followed by v_error and v_digits_lost: the exact value is no further from v than v_error,
so that as many of a double's 16 digits may be wrong. It is inf where no bound is known, and nan where the formula is undefined.

Examples:
  iso eval 'sin(x)*y + z' --at pi/2,2,1 --gradient
  iso eval 'sqrt(x^2 + y^2) - z' --points points.csv
  iso eval 'sqrt(x^2 + y^2) - z' --points points.csv --gradient -o values.csv
  iso eval '(1 - cos(x))/x^2' --points points.csv --error
  iso eval '1/x + y z' --boxes boxes.csv";
