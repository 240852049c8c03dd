//! From the formula on the command line to the program of F − C.

use std::borrow::Cow;
use std::ffi::OsStr;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use iso_expr::limits::{LARGEST_MODEL, LARGEST_TEXT};
use iso_expr::{Ast, Formula, FormulaError, Program};

use crate::failure::Failure;
use crate::flags::FormulaFlags;
use crate::values::Setting;

/// A formula as it was given, not yet known to be text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Source {
    /// What it is called in reports: `formula`, or the name of its file.
    pub(crate) name: String,
    bytes: Vec<u8>,
}

/// What a formula is called that was given as such.
const TYPED: &str = "formula";

/// Whether the file of this name holds a model.
fn is_model(name: impl AsRef<Path>) -> bool {
    name.as_ref().extension().is_some_and(|extension| extension.eq_ignore_ascii_case("vm"))
}

/// A formula that was read.
pub(crate) enum Text {
    /// In the language of formulas.
    Formula(Ast),
    /// A model, one operation a line.
    Model(Formula),
}

impl Source {
    /// Takes the argument itself, or reads the file of `@file` or `model.vm`, or standard input for `-`.
    pub(crate) fn read(argument: &OsStr) -> Result<Self, Failure> {
        let (name, read) = match argument.as_encoded_bytes() {
            b"-" => ("standard input".to_owned(), read_up_to(LARGEST_TEXT, io::stdin().lock())),
            b"@" => return Err(Failure::usage("`@` names no file", "write `@formula.txt`")),
            bytes => match file_of(argument) {
                Some(path) => (path.display().to_string(), read_file(&path)),
                None => (TYPED.to_owned(), Ok(bytes.to_vec())),
            },
        };
        match read {
            Ok(bytes) => Ok(Self { name, bytes }),
            Err(error) => Err(Failure::Read { path: name.into(), error }),
        }
    }

    /// The tree, or the model when the name is that of one.
    pub(crate) fn parse(&self) -> Result<Text, Failure> {
        let text = iso_expr::decode(&self.bytes).and_then(|text| match is_model(&self.name) {
            true => Formula::read_model(text).map(Text::Model),
            false => Ast::parse(text).map(Text::Formula),
        });
        text.map_err(|error| self.wrong(error))
    }

    /// The program of a text of this source, with other values for some of its parameters.
    pub(crate) fn lower(&self, text: &Text, settings: &[Setting]) -> Result<Formula, Failure> {
        let is_repeated = |&(place, setting): &(usize, &Setting)| {
            settings[..place].iter().any(|earlier| earlier.name == setting.name)
        };
        if let Some((_, setting)) = settings.iter().enumerate().find(is_repeated) {
            let problem = format!("several values are given to {}", setting.name);
            return Err(Failure::usage(problem, "leave out all but one of them"));
        }
        let settings: Vec<(String, f64)> =
            settings.iter().map(|setting| (setting.name.clone(), setting.value)).collect();
        match text {
            Text::Formula(ast) => ast.lower(&settings).map_err(|error| self.wrong(error)),
            Text::Model(formula) if settings.is_empty() => Ok(formula.clone()),
            Text::Model(_) => Err(Failure::usage(
                format!("{} is a model, which has no parameters", self.name),
                "leave out --set and --sweep",
            )),
        }
    }

    /// The text; what is not UTF-8 is replaced.
    pub(crate) fn text(&self) -> Cow<'_, str> {
        String::from_utf8_lossy(&self.bytes)
    }

    fn wrong(&self, error: FormulaError) -> Failure {
        let text = self.text();
        let error = match self.name == TYPED && Path::new(&*text).is_file() {
            true => error.with_help(format!("there is a file of this name: write `@{text}` to read it")),
            false => error,
        };
        Failure::Formula { source_text: Box::new(self.clone()), error: Box::new(error) }
    }
}

/// The file that a formula is read from, `@file` or `model.vm`; `None` of one that was typed.
pub(crate) fn file_of(argument: &OsStr) -> Option<PathBuf> {
    let argument = argument.to_string_lossy();
    match argument.strip_prefix('@') {
        Some(path) => Some(path.into()),
        None => is_model(&*argument).then(|| argument.into_owned().into()),
    }
}

/// What is in a file.
fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    let largest = if is_model(path) { LARGEST_MODEL } else { LARGEST_TEXT };
    read_up_to(largest, File::open(path)?)
}

/// What a source holds, or so much of it that it is seen to be longer than the largest that is allowed.
fn read_up_to(largest: usize, source: impl Read) -> io::Result<Vec<u8>> {
    /// The last character may be cut, and then is left out.
    const LONGEST_CHARACTER: usize = 4;
    let mut content = Vec::new();
    source.take((largest + LONGEST_CHARACTER) as u64).read_to_end(&mut content)?;
    if content.len() > largest
        && let Err(error) = str::from_utf8(&content)
        && error.error_len().is_none()
    {
        content.truncate(error.valid_up_to());
    }
    Ok(content)
}

/// Reads and understands the formula that `flags` name.
pub(crate) fn understand(flags: &FormulaFlags) -> Result<Formula, Failure> {
    let source = Source::read(&flags.formula)?;
    source.lower(&source.parse()?, &flags.settings)
}

/// The program of F − C. An equation has its level built in, so that giving another one is an error.
pub(crate) fn minus_level(formula: &Formula, level: Option<f64>) -> Result<Program, Failure> {
    match level {
        None => Ok(formula.program().clone()),
        Some(level) if formula.is_equation() => Err(Failure::usage(
            format!("a level ({level}) is given with an equation, which needs none"),
            "the surface of left = right is where left − right = 0: leave out --level, or write (left) - (right)",
        )),
        Some(level) => Ok(formula.minus_level(level)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_are_read_no_further_than_they_may_be_long() {
        let read = |text: &[u8]| read_up_to(5, text.chain(io::repeat(b'x')).take(100)).unwrap();
        assert_eq!(read(b"ab"), b"abxxxxxxx");
        // A character that is cut is left out.
        assert_eq!(read("12345678π".as_bytes()), b"12345678");
        assert_eq!(read_up_to(5, &b"ab"[..]).unwrap(), b"ab");
    }
}
