//! What to do about command lines that clap refuses, where it has no tip of its own.

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Command, CommandFactory};
use iso_expr::Axis;

use super::Flags;

/// The error with what to do about it where a formula stands in place of a command or is parted by a shell, and where a list is;
/// `words` are those of the command line.
pub(crate) fn with_tip(mut error: clap::Error, words: &[String]) -> clap::Error {
    let tip = match error.kind() {
        ErrorKind::InvalidSubcommand if error.get(ContextKind::SuggestedSubcommand).is_none() => {
            Some("to draw a formula, write 'iso render FORMULA'".to_owned())
        }
        ErrorKind::UnknownArgument => {
            error.get(ContextKind::InvalidArg).and_then(|given| of_unknown(&given.to_string(), words))
        }
        _ => None,
    };
    if let Some(tip) = tip {
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
    }
    error
}

/// The tip for a word that the command does not expect.
fn of_unknown(given: &str, words: &[String]) -> Option<String> {
    let flags = Flags::command();
    let command = flags.find_subcommand(words.get(1)?)?;
    if let Some(list) = parted_list(command, given, words) {
        return Some(format!("a list is separated by commas: {list}"));
    }
    let takes_formula = command.get_positionals().any(|argument| argument.get_id() == "formula");
    if takes_formula && may_be_of_formula(given) {
        let tip =
            "a formula stands in quotes, so that the shell takes it for one word: iso render 'x^2 + y^2 = 1'";
        return Some(tip.to_owned());
    }
    // In place of clap's advice to give it as a value, of which there is none to give.
    given.starts_with('-').then(|| format!("'iso {} --help' lists the options", command.get_name()))
}

/// The list that `given` goes on, as it should be written up to there.
fn parted_list(command: &Command, given: &str, words: &[String]) -> Option<String> {
    let end = words.iter().position(|word| word == given)?;
    let start = words[..end].iter().rposition(|word| word.starts_with('-'))?;
    let takes_list = command.get_arguments().any(|argument| {
        let is_it = argument.get_long().is_some_and(|long| words[start].strip_prefix("--") == Some(long));
        is_it && argument.get_value_delimiter().is_some()
    });
    let elements: Vec<&str> = words[start + 1..=end].iter().map(|word| word.trim_matches(',')).collect();
    let are_alike = [is_number, is_name].iter().any(|is_it| elements.iter().all(|element| is_it(element)));
    (takes_list && are_alike).then(|| format!("{} {}", words[start], elements.join(",")))
}

fn is_number(word: &str) -> bool {
    word.parse::<f64>().is_ok()
}

fn is_name(word: &str) -> bool {
    word.starts_with(char::is_alphabetic)
        && word.chars().all(|letter| letter.is_alphanumeric() || letter == '-')
}

/// Whether a word may be a part of a formula: what begins like a flag is one only if that is a coordinate's sign.
fn may_be_of_formula(word: &str) -> bool {
    let is_axis = |letter: char| Axis::ALL.iter().any(|axis| axis.name().starts_with(letter));
    match word.strip_prefix('-') {
        Some(rest) => {
            rest.starts_with(|first: char| first != '-' && (is_axis(first) || !first.is_alphabetic()))
        }
        None => true,
    }
}
