//! Flags of `iso explain`.

use clap::{Args, ValueEnum};

use super::PictureFlags;

/// Show what a picture takes, and what becomes of its formula on the way to machine code
///
/// The options say which picture, as those of `iso render` do. The plan says what is computed for such a picture, what is left out, and why; nothing is
/// drawn. The stages of the formula come with their sizes and the times that they took.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct ExplainFlags {
    #[command(flatten)]
    pub(crate) picture: PictureFlags,
    #[command(flatten)]
    pub(crate) sections: SectionFlags,
}

/// What is shown.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub(crate) struct SectionFlags {
    /// Show these sections only; separated by commas [default: all]
    #[arg(long = "section", value_name = "SECTIONS", value_enum, value_delimiter = ',')]
    pub(crate) sections: Vec<Section>,

    /// The kernel whose intermediate code and machine code are shown
    #[cfg(feature = "jit")]
    #[arg(long, value_name = "KERNEL", value_enum, default_value_t = KernelName::Point)]
    pub(crate) kernel: KernelName,

    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

/// The plan, and the stages on the way to machine code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Section {
    /// What the picture takes, what is left out, and why
    Plan,
    /// The formula as it was understood
    Tree,
    /// The program as the tree is lowered to it
    Program,
    /// Where the formula loses digits that an equal one keeps
    Hints,
    /// The program after simplification
    Simplified,
    /// The function with the same signs that rays are followed by, often F itself
    Signs,
    /// The program that rays are followed by with its three derivatives, after simplification
    Gradient,
    /// Cranelift's intermediate code
    #[cfg(feature = "jit")]
    Clif,
    /// Machine code
    #[cfg(feature = "jit")]
    Assembly,
}

/// What a kernel runs over.
#[cfg(feature = "jit")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum KernelName {
    /// F at one point
    Point,
    /// F at many points, in lanes
    Batch,
    /// Enclosures of F over many boxes
    Boxes,
}

const EXAMPLES: &str = "\
Examples:
  iso explain '(x^2+y^2-1)^2 + 4z^2 + 0.5x = 0.2'
  iso explain '(x^2+y^2-1)^2 + 4z^2 + 0.5x = 0.2' --section plan --ortho --depth depth.exr
  iso explain 'x^3 y + sin(x)' --section simplified,gradient
  iso explain 'x^2 + y^2 - z' --section assembly --kernel batch
  iso explain @surface.txt --json";
