//! Flags of `iso engines`.

use std::num::NonZeroU32;
use std::path::PathBuf;
use std::time::Duration;

use clap::Args;

use super::ThreadsFlag;
use crate::scaling::Family;
use crate::values;

/// Measure the interpreter against native code as formulas and pictures grow
///
/// Formulas are made of as many like parts as wanted. Of each size, one evaluation, compiling and pictures by the method
/// certified are measured, both engines in turns. The folder gets evaluations.csv, pictures.csv and plots.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, after_help = EXAMPLES)]
pub(crate) struct EnginesFlags {
    /// What the formulas are made of
    #[arg(long, value_name = "FAMILY,...", value_delimiter = ',', value_enum, default_value = "blobs,balls")]
    pub(crate) families: Vec<Family>,

    /// About how many operations the formulas have
    #[arg(long, value_name = "N,...", value_delimiter = ',')]
    #[arg(default_value = "3,10,30,100,300,1000,3000,10000")]
    #[arg(value_parser = values::whole(1..=50_000_u32))]
    pub(crate) sizes: Vec<u32>,

    /// Width and height of the pictures
    #[arg(
        long,
        value_name = "PIXELS,...",
        value_delimiter = ',',
        default_value = "64,128,256,512,1024,2048,4096"
    )]
    #[arg(value_parser = values::whole(1..=16_384_u32))]
    pub(crate) sides: Vec<u32>,

    /// Leave out pictures that are expected to take longer than this
    #[arg(long, value_name = "TIME", value_parser = values::duration, default_value = "3s")]
    pub(crate) patience: Duration,

    /// How often everything is measured
    #[arg(long, value_name = "N", default_value = "3", value_parser = values::times)]
    pub(crate) runs: NonZeroU32,

    /// Begin no measurement after this time, such as 90s or 2m
    #[arg(long, value_name = "TIME", value_parser = values::duration, default_value = "3m")]
    pub(crate) budget: Duration,

    /// The folder of the results; it is made if it is missing
    #[arg(short, long, value_name = "FOLDER", default_value = "engines")]
    pub(crate) output: PathBuf,

    #[command(flatten)]
    pub(crate) threads: ThreadsFlag,
}

const EXAMPLES: &str = "\
Examples:
  iso engines -o engines/
  iso engines --families balls --sizes 10,100,1000 --sides 64,256,1024 --runs 5";
