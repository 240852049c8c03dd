//! The raw flags of the command line, as clap reads them. Commands check them before they compute
//! anything ([`crate::commands`]).

mod bench;
mod camera;
mod engines;
mod eval;
mod explain;
mod formula;
mod limit;
mod look;
mod method;
mod render;
mod report;
mod sequence;
mod stress;
mod tables;
mod tip;
mod trace;

pub(crate) use bench::BenchFlags;
pub(crate) use camera::CameraFlags;
pub(crate) use engines::EnginesFlags;
pub(crate) use eval::{EvalFlags, PlacesFlags};
#[cfg(feature = "jit")]
pub(crate) use explain::KernelName;
pub(crate) use explain::{ExplainFlags, Section};
pub(crate) use formula::{FormulaFlags, LevelFlag};
pub(crate) use limit::LimitFlags;
pub(crate) use look::{BackgroundFlag, PaintFlags};
pub(crate) use method::{
    EngineFlag, EngineName, MethodFlags, MethodName, RegionFlag, RootFinderName, ThreadsFlag,
};
pub(crate) use render::{LayerFlags, PictureFlags, RenderFlags, SummaryFlags};
pub(crate) use report::{AxesFlags, ReportFlags, SuiteName};
pub(crate) use sequence::SequenceFlags;
pub(crate) use stress::StressFlags;
pub(crate) use tables::TableFlags;
pub(crate) use tip::with_tip;
pub(crate) use trace::TraceFlags;

use clap::{Parser, Subcommand, ValueEnum};
use clap_complete::Shell;

/// See F(x, y, z) = C.
#[derive(Debug, Parser)]
#[command(name = "iso", version, about = "See F(x, y, z) = C", long_about = LONG_ABOUT, after_help = EXAMPLES, max_term_width = 100)]
#[command(arg_required_else_help = true, propagate_version = true)]
#[command(args_override_self = true)]
pub(crate) struct Flags {
    /// What to do.
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// What `iso` can do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Draw a surface
    Render(Box<RenderFlags>),
    /// Evaluate a formula at points or over boxes
    Eval(EvalFlags),
    /// Follow rays to the surface
    Trace(TraceFlags),
    /// Show what a picture takes, and what becomes of its formula
    Explain(Box<ExplainFlags>),
    /// Measure the interpreter against native code
    Bench(BenchFlags),
    /// Measure the interpreter against native code as formulas and pictures grow
    Engines(EnginesFlags),
    /// Measure what error each method and setting buys for what time
    Report(Box<ReportFlags>),
    /// Run the suite of hard cases and hold every method against what is proven
    Stress(StressFlags),
    /// Write a completion script for a shell
    #[command(after_help = COMPLETION_EXAMPLES)]
    Completions {
        /// The shell
        shell: Shell,
    },
}

/// The name of a value on the command line, and in all that programs read.
pub(crate) fn name_of(value: impl ValueEnum) -> String {
    value.to_possible_value().expect("no value is hidden").get_name().to_owned()
}

const LONG_ABOUT: &str = "\
iso draws the surface on which a formula F(x, y, z) has the value C. It compiles the formula to native code, \
follows a ray for every pixel, and by default proves what it draws.";

const EXAMPLES: &str = "\
Examples:
  iso render 'x^2 + y^2 + z^2 = 1' -o sphere.png
  iso render 'cos(x) + cos(y) + cos(z)' --level 0.5 --box -6,6 -o cosines.png
  iso render @heart.txt --set a=2 --size 1024x1024
  iso eval 'sin(x)*y' --points points.csv --gradient
  iso explain 'x^2 + y^2 - z'

Exit codes: 0 done, 1 failed, 2 bad usage or bad formula, 3 stopped by --time-limit, 130 stopped by Ctrl-C or \
a signal to end.";

const COMPLETION_EXAMPLES: &str = "\
Examples:
  iso completions bash > ~/.local/share/bash-completion/completions/iso
  iso completions zsh > ~/.zfunc/_iso
  iso completions fish > ~/.config/fish/completions/iso.fish";

#[cfg(test)]
mod tests {
    use clap::{CommandFactory, Parser};

    use super::Flags;

    #[test]
    fn the_flags_are_consistent() {
        Flags::command().debug_assert();
    }

    /// Where examples of command lines stand, beside the help of each command.
    const DOCUMENTS: [(&str, &str); 2] = [
        ("README.md", include_str!("../../../../README.md")),
        ("docs/usage.md", include_str!("../../../../docs/usage.md")),
    ];

    /// The words of a command line: what stands in quotes is one, and what follows `#` or goes on to a file is none.
    fn words(line: &str) -> Vec<String> {
        let mut words = Vec::new();
        for (place, part) in line.split('\'').enumerate() {
            if place % 2 == 1 {
                words.push(part.to_owned());
                continue;
            }
            let end = part.find(['#', '>']).unwrap_or(part.len());
            words.extend(part[..end].split_whitespace().map(str::to_owned));
            if end < part.len() {
                break;
            }
        }
        words
    }

    /// What a command line gives to the program.
    fn arguments(line: &str) -> Option<&str> {
        ["iso ", "cargo run --release -- "].into_iter().find_map(|name| line.strip_prefix(name))
    }

    /// The command lines of a text, without the program's name: whole lines, and what stands between backticks but for commands alone.
    fn command_lines(text: &str) -> impl Iterator<Item = &str> {
        let lines = text.lines().map(str::trim);
        let spans = text.lines().flat_map(|line| line.split('`').skip(1).step_by(2));
        lines.chain(spans).filter_map(arguments).filter(|line| line.contains(' '))
    }

    /// An option that gets another name must get it everywhere.
    #[test]
    fn examples_of_help_and_documents_are_understood() {
        let command = Flags::command();
        let helps = [&command].into_iter().chain(command.get_subcommands()).map(|command| {
            let help = command.get_after_help().expect("every command has examples");
            (command.get_name().to_owned(), help.to_string())
        });
        let documents = DOCUMENTS.map(|(name, text)| (name.to_owned(), text.to_owned()));
        for (name, text) in helps.chain(documents) {
            let mut found = 0;
            for line in command_lines(&text) {
                found += 1;
                let line = line.replace("SHELL", "bash").replace("COMMAND", "render");
                let read = Flags::try_parse_from([vec!["iso".to_owned()], words(&line)].concat());
                let problem = read.err().filter(clap::Error::use_stderr);
                assert!(problem.is_none(), "{name}: {line}: {}", problem.unwrap());
            }
            assert!(found > 1, "{name}: {found} examples");
        }
    }

    /// A parser that makes another type than that of its field is found out when the flag is read.
    #[test]
    fn values_are_of_the_types_of_their_flags() {
        for line in [
            "render x --threads 2 --sweep a=0:1 --frames 3 --grid 4,5,6 --refine 2 --size 8x9 --smooth 2 --box -1,1 --time-limit 2s",
            "eval x --at 1,2,3",
            "trace x --ray 0,0,0,1,0,0 --threads 1",
            "explain x --grid 3 --level 2 --size 5",
            "bench x --runs 2 --threads 1 --size 9",
            "engines --sizes 8 --sides 9 --runs 2 --threads 1",
            "report x --grids 4,5 --refines 2,3 --steps 0.1 --sizes 8 --runs 2",
            "stress --threads 1",
            "completions bash",
        ] {
            let read = Flags::try_parse_from(["iso"].into_iter().chain(line.split(' ')));
            assert!(read.is_ok(), "{line}: {}", read.unwrap_err());
        }
    }
}
