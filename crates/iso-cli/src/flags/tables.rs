//! Flags of commands that write a table.

use std::path::PathBuf;

use clap::Args;

use crate::table::Form;

/// How a table of results is written, and where.
#[derive(Debug, Args)]
#[command(next_help_heading = "Tables")]
pub(crate) struct TableFlags {
    /// Write one JSON object for each row, in an array, in place of comma-separated values
    #[arg(long)]
    pub(crate) json: bool,

    /// The table of results [default: standard output]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

impl TableFlags {
    /// How the table is written.
    pub(crate) fn form(&self) -> Form {
        if self.json { Form::Json } else { Form::Csv }
    }
}
