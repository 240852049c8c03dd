//! Flags that say which surface is meant.

use std::ffi::OsString;

use clap::Args;

use crate::values::{self, Setting};

/// The formula and its parameters.
#[derive(Debug, Args)]
#[command(next_help_heading = "Formula")]
pub(crate) struct FormulaFlags {
    /// The formula; `@FILE` reads it from a file, `-` from standard input, `FILE.vm` is a model
    ///
    /// An equation such as `x^2 + y^2 = z`, or an expression F that stands for F = C (see `--level`). Definitions may come
    /// before it: `a := 2; r := sqrt(x^2 + y^2); r^a = z`. docs/formulas.md describes the whole language,
    /// and the form of models, which have one operation a line.
    #[arg(value_name = "FORMULA", allow_hyphen_values = true)]
    pub(crate) formula: OsString,

    /// Give a parameter of the formula another value; may be repeated
    #[arg(long = "set", value_name = "NAME=NUMBER")]
    pub(crate) settings: Vec<Setting>,
}

/// The level of the surface.
#[derive(Debug, Args)]
#[command(next_help_heading = "Formula")]
pub(crate) struct LevelFlag {
    /// The level C of an expression F, for the surface F = C [default: 0]
    #[arg(long, value_name = "C", value_parser = values::finite, allow_hyphen_values = true)]
    pub(crate) level: Option<f64>,
}
