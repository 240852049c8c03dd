//! Flags that say where and how the surface is looked for.

use clap::{Args, ValueEnum};
use iso_grid::{GridSettings, Region, RootFinder};

use crate::values;

/// The region.
#[derive(Debug, Args)]
#[command(next_help_heading = "Region and method")]
pub(crate) struct RegionFlag {
    /// The box in which the surface is looked for [default: one that fits it, or a part of it where it goes on for ever]
    ///
    /// `a,b` reaches from a to b along every axis; six numbers are xmin,ymin,zmin,xmax,ymax,zmax.
    #[arg(long = "box", value_name = "BOX", value_parser = values::region, allow_hyphen_values = true)]
    pub(crate) region: Option<Region>,
}

/// The region and the method of intersection.
#[derive(Debug, Args)]
#[command(next_help_heading = "Region and method")]
pub(crate) struct MethodFlags {
    #[command(flatten)]
    pub(crate) region: RegionFlag,

    /// The method of intersection
    #[arg(long, value_name = "METHOD", value_enum, default_value_t = MethodName::Certified)]
    pub(crate) method: MethodName,

    /// Cells of the grid along every axis, or i,j,k [default: 30]
    #[arg(long, value_name = "N", value_parser = values::counts(1..=GridSettings::MOST_CELLS))]
    pub(crate) grid: Option<[u32; 3]>,

    /// Parts into which a cell beside the surface is cut, along every axis or i,j,k [default: 2; 3 for grids up to 20]
    #[arg(long, value_name = "M", value_parser = values::counts(1..=GridSettings::LARGEST_REFINEMENT))]
    pub(crate) refine: Option<[u32; 3]>,

    /// The step between samples, in parts of the longest side of a cell [default: 0.05]
    #[arg(long, value_name = "STEP", value_parser = values::step)]
    pub(crate) step: Option<f64>,

    /// How the sampling methods find a root between samples of unlike sign [default: bisection]
    #[arg(long, value_name = "FINDER", value_enum)]
    pub(crate) root_finder: Option<RootFinderName>,

    /// The width, relative to t, to which the sampling methods narrow roots; 0 goes on to neighbouring floats [default: 0]
    #[arg(long, value_name = "WIDTH", value_parser = values::tolerance)]
    pub(crate) tolerance: Option<f64>,

    /// The width, relative to t, to which the certified method encloses roots; a coarse one may leave more contacts and near misses open [default:
    /// 1/256 of a pixel where only colours are written, else 1e-12]
    #[arg(long, value_name = "WIDTH", value_parser = values::accuracy)]
    pub(crate) accuracy: Option<f64>,
}

/// The engine that evaluates the formula.
#[derive(Debug, Args)]
#[command(next_help_heading = "Running")]
pub(crate) struct EngineFlag {
    /// The engine that evaluates the formula; the results are the same
    #[arg(long, value_name = "ENGINE", value_enum, default_value_t = EngineName::DEFAULT)]
    pub(crate) engine: EngineName,
}

/// How many threads work.
#[derive(Debug, Args)]
#[command(next_help_heading = "Running")]
pub(crate) struct ThreadsFlag {
    /// Threads that work at the same time; 0 for as many as there are cores
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = values::whole(0..=1024_u16))]
    pub(crate) threads: u16,
}

/// The methods of intersection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MethodName {
    /// Prove every pixel with intervals; nothing to tune
    Certified,
    /// Cut the box into cells, keep those whose corners differ in sign, sample inside them
    Grid,
    /// The same, hierarchically
    Octree,
    /// Sample along the whole ray
    Direct,
}

/// The root finders of the sampling methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum RootFinderName {
    /// Halve the interval, as the paper does
    Bisection,
    /// Interpolate, truncate and project: fewer points, and hardly ever more than bisection
    Itp,
    /// Follow the derivative along the ray, inside the interval; each point costs a gradient
    Newton,
}

impl From<RootFinderName> for RootFinder {
    fn from(name: RootFinderName) -> Self {
        match name {
            RootFinderName::Bisection => Self::Bisection,
            RootFinderName::Itp => Self::Itp,
            RootFinderName::Newton => Self::Newton,
        }
    }
}

/// The engines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum EngineName {
    /// Native code; not in programs that are built without it
    Jit,
    /// The interpreter
    Interp,
}

impl EngineName {
    /// The fastest engine that this program is built with.
    pub(crate) const DEFAULT: Self = if cfg!(feature = "jit") { Self::Jit } else { Self::Interp };
}
