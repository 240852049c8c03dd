//! `iso completions`: completion scripts for shells.

use clap::CommandFactory;
use clap_complete::Shell;

use crate::failure::Failure;
use crate::flags::Flags;
use crate::output::to_standard_output;

/// Writes the completion script for `shell` to standard output.
pub(crate) fn run(shell: Shell) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Flags::command(), "iso", &mut script);
    to_standard_output(|writer| writer.write_all(&script))
}
