//! Flags of `iso trace`.

use std::path::PathBuf;

use clap::{ArgGroup, Args};
use iso_grid::Ray;

use super::{EngineFlag, FormulaFlags, LevelFlag, LimitFlags, MethodFlags, TableFlags, ThreadsFlag};
use crate::values;

/// Follow rays to the surface
///
/// A ray is the points o + t·d with t ≥ 0, where d may have any length. Rows of the result are in the order of the rays.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, after_help = EXAMPLES, group = ArgGroup::new("origins").required(true))]
pub(crate) struct TraceFlags {
    #[command(flatten)]
    pub(crate) formula: FormulaFlags,
    #[command(flatten)]
    pub(crate) level: LevelFlag,
    #[command(flatten)]
    pub(crate) method: MethodFlags,
    #[command(flatten)]
    pub(crate) rays: RaysFlags,
    #[command(flatten)]
    pub(crate) table: TableFlags,
    #[command(flatten)]
    pub(crate) engine: EngineFlag,
    #[command(flatten)]
    pub(crate) threads: ThreadsFlag,
    #[command(flatten)]
    pub(crate) limit: LimitFlags,
}

/// The rays that are followed.
#[derive(Debug, Args)]
#[command(next_help_heading = "Rays")]
pub(crate) struct RaysFlags {
    /// A ray from a point along a direction; may be repeated
    #[arg(long, value_name = "OX,OY,OZ,DX,DY,DZ", group = "origins", allow_hyphen_values = true, value_parser = values::ray)]
    pub(crate) ray: Vec<Ray>,

    /// A table of rays with the columns ox,oy,oz,dx,dy,dz; `-` is standard input
    #[arg(long, value_name = "FILE.csv", group = "origins")]
    pub(crate) rays: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Columns of the result: status,t,t_lo,t_hi,x,y,z,nx,ny,nz. The status is hit, touch, miss, undecided or unfinished; t lies between t_lo
and t_hi, and the normal points towards larger F. What does not exist is nan.

Examples:
  iso trace 'x^2 + y^2 + z^2 = 1' --ray=-3,0,0,1,0,0 --json
  iso trace 'x^2 + y^2 + z^2 = 1' --rays rays.csv
  iso trace @surface.txt --rays rays.csv --box -3,3 --method grid --grid 60 -o hits.csv";
