//! Reports of failures on standard error, the only place that draws them.

use std::env;
use std::io::{self, IsTerminal, Write};
use std::ops::Range;

use iso_expr::{FormulaError, FormulaErrorKind};
use unicode_width::UnicodeWidthStr;

use crate::failure::Failure;
use crate::formula::Source;

/// The longest stretch of a line that is shown, in characters.
const WIDEST: usize = 100;

/// Reports `failure` on standard error.
pub(crate) fn print(failure: &Failure) {
    let text = report(failure, if wants_color() { Style::COLORED } else { Style::PLAIN });
    // There is nowhere left to report that reports cannot be written.
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// Colour is for terminals whose users did not refuse it (<https://no-color.org>).
fn wants_color() -> bool {
    let refused = env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    let dumb = env::var_os("TERM").is_some_and(|value| value == "dumb");
    io::stderr().is_terminal() && !refused && !dumb
}

/// What turns colours on and off.
struct Style {
    /// For what is wrong.
    red: &'static str,
    /// For what stands around it.
    blue: &'static str,
    off: &'static str,
}

impl Style {
    const PLAIN: Self = Self { red: "", blue: "", off: "" };
    const COLORED: Self = Self { red: "\u{1b}[1;31m", blue: "\u{1b}[1;34m", off: "\u{1b}[0m" };
}

fn report(failure: &Failure, style: Style) -> String {
    let Style { red, off, .. } = style;
    let mut report = format!("{red}error:{off} {failure}\n");
    let help = match failure {
        Failure::Formula { source_text, error } => {
            if has_a_place(error) {
                report.push_str(&place(source_text, error, &style));
            }
            error.help.as_deref()
        }
        Failure::Usage { help, .. } => help.as_deref(),
        _ => None,
    };
    if let Some(help) = help {
        report.push_str(&format!("  help: {help}\n"));
    }
    report
}

/// Whether the fault lies in the text rather than in the values given for its parameters.
fn has_a_place(error: &FormulaError) -> bool {
    !matches!(
        error.kind,
        FormulaErrorKind::UnknownParameter { .. }
            | FormulaErrorKind::NotAParameter { .. }
            | FormulaErrorKind::InfiniteParameter { .. }
    )
}

/// The line of the formula in which the error is, with carets under the place.
fn place(source: &Source, error: &FormulaError, style: &Style) -> String {
    let Style { red, blue, off } = style;
    let Excerpt { line, column, shown, marked } = Excerpt::around(&source.text(), error.span.clone());
    let number = line.to_string();
    let margin = " ".repeat(number.len());
    let before = " ".repeat(shown[..marked.start].width());
    let carets = "^".repeat(shown[marked].width().max(1));
    format!(
        "{blue}{margin}-->{off} {name}:{line}:{column}\n\
         {blue}{margin} |{off}\n\
         {blue}{number} |{off} {shown}\n\
         {blue}{margin} |{off} {before}{red}{carets}{off}\n",
        name = source.name,
    )
}

/// What is shown of a formula: one line, or a stretch of it when it is long.
#[derive(Debug, PartialEq, Eq)]
struct Excerpt {
    /// The line's number, from 1.
    line: usize,
    /// The place of the error in the whole line, in characters from 1.
    column: usize,
    /// What is shown of the line.
    shown: String,
    /// The place of the error in `shown`, in bytes.
    marked: Range<usize>,
}

impl Excerpt {
    fn around(text: &str, span: Range<usize>) -> Self {
        // An error at the end of the text is shown behind its last visible character.
        let start = text.floor_char_boundary(span.start.min(text.trim_end().len()));
        let end = text.ceil_char_boundary(span.end.min(text.len())).max(start);
        let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |length| start + length);
        let line_end = line_start + text[line_start..line_end].trim_end().len();

        let before = last_characters(&text[line_start..start], WIDEST / 2);
        let marked = first_characters(&text[start..end.min(line_end)], WIDEST);
        let after = first_characters(&text[start + marked.len()..line_end], WIDEST / 2);
        let is_cut_before = before.len() < start - line_start;
        let is_cut_after = start + marked.len() + after.len() < line_end;
        let ellipsis = |is_cut| if is_cut { "…" } else { "" };
        let [lead, marked, rest] = [
            [ellipsis(is_cut_before), before].concat(),
            marked.to_owned(),
            [after, ellipsis(is_cut_after)].concat(),
        ]
        .map(|part| visible(&part));
        Self {
            line: 1 + text[..line_start].matches('\n').count(),
            column: 1 + text[line_start..start].chars().count(),
            marked: lead.len()..lead.len() + marked.len(),
            shown: [lead, marked, rest].concat(),
        }
    }
}

/// Control characters, such as tabs and what steers terminals, as one visible character each.
fn visible(text: &str) -> String {
    text.chars()
        .map(|character| match character {
            '\t' => ' ',
            other if other.is_control() => char::REPLACEMENT_CHARACTER,
            other => other,
        })
        .collect()
}

fn first_characters(text: &str, count: usize) -> &str {
    let end = text.char_indices().nth(count).map_or(text.len(), |(end, _)| end);
    &text[..end]
}

fn last_characters(text: &str, count: usize) -> &str {
    let start = text.char_indices().rev().nth(count.saturating_sub(1)).map_or(0, |(start, _)| start);
    &text[start..]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn excerpt(text: &str, span: Range<usize>) -> (usize, usize, String, String) {
        let Excerpt { line, column, shown, marked } = Excerpt::around(text, span);
        let marked = shown[marked].to_owned();
        (line, column, shown, marked)
    }

    #[test]
    fn short_lines_are_shown_whole() {
        let (line, column, shown, marked) = excerpt("a := 1\nx + q\n# end", 11..12);
        assert_eq!((line, column, shown.as_str(), marked.as_str()), (2, 5, "x + q", "q"));
    }

    #[test]
    fn long_lines_are_shown_around_the_place() {
        let formula = format!("{}?{}", "+x".repeat(500_000), "+é".repeat(500_000));
        let (line, column, shown, marked) = excerpt(&formula, 1_000_000..1_000_001);
        assert_eq!((line, column, marked.as_str()), (1, 1_000_001, "?"));
        assert_eq!(shown.chars().count(), 2 + 2 * (WIDEST / 2) + 1);
        assert!(shown.starts_with("…+x") && shown.ends_with("é…"), "{shown}");
    }

    #[test]
    fn long_spans_are_cut() {
        let (_, _, shown, marked) = excerpt(&"(".repeat(10_000), 0..10_000);
        assert_eq!(marked.len(), WIDEST);
        assert!(shown.ends_with("(…"));
    }

    #[test]
    fn the_end_of_the_text_is_behind_its_last_character() {
        assert_eq!(Excerpt::around("sin(x\n\n", 7..7).marked, 5..5);
        assert_eq!(Excerpt::around("sin(x \r\n", 8..8).shown, "sin(x");
        assert_eq!(Excerpt::around("", 0..0).marked, 0..0);
    }

    #[test]
    fn places_inside_a_character_are_moved_to_its_edges() {
        assert_eq!(excerpt("é", 1..1).3, "é");
        assert_eq!(excerpt("éx", 1..2).3, "é");
    }

    #[test]
    fn control_characters_do_not_reach_the_terminal() {
        assert_eq!(excerpt("x\t\u{1b}[2J", 2..3).2, "x �[2J");
    }
}
