//! What can be wrong with a formula.

use std::ops::Range;

use thiserror::Error;

/// Why a formula was refused, and where.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{kind}")]
pub struct FormulaError {
    /// What is wrong.
    pub kind: FormulaErrorKind,
    /// The bytes of the text at fault. Empty at the place where something is missing, and at the start where the fault
    /// lies in no part of the text.
    pub span: Range<usize>,
    /// What to write instead.
    pub help: Option<String>,
}

impl FormulaError {
    pub(super) fn new(kind: FormulaErrorKind, span: Range<usize>) -> Self {
        Self { kind, span, help: None }
    }

    /// The same with this help.
    #[must_use]
    pub fn with_help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }

    pub(super) fn with_possible_help(self, help: Option<String>) -> Self {
        Self { help, ..self }
    }
}

/// What can be wrong with a formula.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum FormulaErrorKind {
    /// The bytes are no text.
    #[error("the formula is not UTF-8 text: the byte 0x{byte:02x} stands at offset {offset}")]
    NotUtf8 {
        /// The first byte at fault.
        byte: u8,
        /// Where it stands.
        offset: usize,
    },
    /// There is nothing but blanks and comments.
    #[error("the formula is empty")]
    Empty,
    /// There are definitions alone.
    #[error("there are definitions, but no formula that uses them")]
    MissingFormula,
    /// The text is longer than [`LARGEST_TEXT`](super::limits::LARGEST_TEXT).
    #[error("the formula is longer than {allowed} bytes")]
    TooLong {
        /// The limit.
        allowed: usize,
    },
    /// It nests deeper than [`DEEPEST_NESTING`](super::limits::DEEPEST_NESTING).
    #[error("the formula is nested {given} levels deep; {allowed} are allowed")]
    TooDeep {
        /// The deepest nesting.
        given: usize,
        /// The limit.
        allowed: usize,
    },
    /// It takes more than [`MOST_OPERATIONS`](super::limits::MOST_OPERATIONS).
    #[error("the formula takes {given} operations or more; {allowed} are allowed")]
    TooManyOperations {
        /// How many there were when counting stopped.
        given: usize,
        /// The limit.
        allowed: usize,
    },
    /// Its definitions multiply beyond [`MOST_STEPS`](super::limits::MOST_STEPS).
    #[error(
        "the formula grows to {given} terms or more as its definitions are put in; {allowed} are allowed"
    )]
    TooManySteps {
        /// How many there were when counting stopped.
        given: usize,
        /// The limit.
        allowed: usize,
    },
    /// A character without a meaning here.
    #[error("`{}` has no meaning in a formula", readable(*.character))]
    StrayCharacter {
        /// The character.
        character: char,
    },
    /// A number too large or too small for a double.
    #[error("the number {number} is out of range")]
    NumberOutOfRange {
        /// The number as it stands, shortened when long.
        number: String,
    },
    /// A word of a model where a number should stand.
    #[error("expected a number, but found `{found}`")]
    NotANumber {
        /// What stands there, shortened when long.
        found: String,
    },
    /// A line of a model that names no operation.
    #[error("the line of `{name}` has no operation")]
    MissingOperation {
        /// The line's name.
        name: String,
    },
    /// An operation that models do not have.
    #[error("the operation `{name}` is unknown")]
    UnknownOperation {
        /// The name.
        name: String,
    },
    /// A name that nothing has.
    #[error("the name `{name}` is unknown")]
    UnknownName {
        /// The name.
        name: String,
    },
    /// A name followed by a parenthesis, which neither a function nor a value has.
    #[error("the function `{name}` is unknown")]
    UnknownFunction {
        /// The name.
        name: String,
    },
    /// `log` of one argument, which means base 10 in some tools and base e in others.
    #[error("`log` alone does not say its base")]
    BareLogarithm,
    /// A function's name without a parenthesis after it.
    #[error("the function `{name}` stands without its arguments")]
    MissingArguments {
        /// The function.
        name: String,
    },
    /// A call with too few or too many arguments.
    #[error("`{function}` takes {expected}, but {given} {} given", if *.given == 1 { "is" } else { "are" })]
    ArgumentCount {
        /// The function.
        function: String,
        /// How many arguments there are.
        given: usize,
        /// How many there should be, in words.
        expected: String,
    },
    /// An opening parenthesis without its closing one.
    #[error("this parenthesis is never closed")]
    UnclosedParenthesis,
    /// An opening bar without its closing one.
    #[error("this bar of an absolute value is never closed")]
    UnclosedBar,
    /// A closing parenthesis without its opening one.
    #[error("this parenthesis closes nothing")]
    UnopenedParenthesis,
    /// Something else where a number, a name or a parenthesis should stand.
    #[error("expected a number, a name or an opening parenthesis, but found {found}")]
    MissingOperand {
        /// What stands there.
        found: String,
    },
    /// The formula, or a definition, ends after an operator.
    #[error("nothing follows the operator `{operator}`")]
    TrailingOperator {
        /// The operator.
        operator: String,
    },
    /// A number follows an operand.
    #[error("expected an operator before {found}")]
    MissingOperator {
        /// What stands there.
        found: String,
    },
    /// A power of a power without parentheses, as in `x²^3`.
    #[error("a power after a superscript could mean two things")]
    StackedPowers,
    /// A comma that does not part the arguments of a function.
    #[error("this comma parts no arguments of a function")]
    StrayComma,
    /// `not` after an operator that binds more tightly.
    #[error("`not` after an operator needs parentheses")]
    MisplacedNot,
    /// A second equality sign.
    #[error("there are two equations")]
    TwoEquations,
    /// A second statement that is no definition.
    #[error("there are two formulas")]
    TwoFormulas,
    /// An inequality, or another condition, where an equation should stand.
    #[error("this is a condition, but a surface is given by an equation")]
    Condition,
    /// What follows `where` is not made of inequalities.
    #[error("`where` needs inequalities")]
    NoDomain,
    /// `=` inside parentheses, a condition or a definition.
    #[error("the equality sign `=` cannot stand inside an expression")]
    EquationInside,
    /// A comparison of a comparison.
    #[error("comparisons cannot be chained")]
    ChainedComparison,
    /// `:=` that does not stand after a new name at the start of a statement.
    #[error("a definition cannot stand here")]
    MisplacedDefinition,
    /// A definition of a name that the language has given a meaning.
    #[error("`{name}` is {meaning} and cannot be defined anew")]
    Reserved {
        /// The name.
        name: String,
        /// What it means.
        meaning: &'static str,
    },
    /// Two definitions of one name, or two parameters of one function.
    #[error("`{name}` is defined twice")]
    DefinedTwice {
        /// The name.
        name: String,
    },
    /// Definitions that lead back to themselves.
    #[error("`{}` is defined by itself: {}", .cycle[0], shown(.cycle))]
    Recursion {
        /// The names on the way, the first one again at the end.
        cycle: Vec<String>,
    },
    /// A value was given for a parameter that the formula does not define.
    #[error("the formula has no parameter `{name}`")]
    UnknownParameter {
        /// The name.
        name: String,
    },
    /// A value was given for a definition that is not a constant.
    #[error("`{name}` is {meaning}, not a parameter")]
    NotAParameter {
        /// The name.
        name: String,
        /// What it is.
        meaning: &'static str,
    },
    /// A parameter was given an infinite value or NaN.
    #[error("the parameter `{name}` must be a finite number")]
    InfiniteParameter {
        /// The name.
        name: String,
    },
}

/// A cycle of names, the middle of a long one left out.
fn shown(cycle: &[String]) -> String {
    const ENDS: usize = 4;
    if cycle.len() <= 2 * ENDS + 1 {
        return cycle.join(" → ");
    }
    let (first, last) = (&cycle[..ENDS], &cycle[cycle.len() - ENDS..]);
    format!("{} → … → {}", first.join(" → "), last.join(" → "))
}

/// A character as it is, unless nothing could be seen of it.
fn readable(character: char) -> String {
    match character {
        '\\' | '\'' | '"' => character.to_string(),
        other => other.escape_debug().to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::readable;

    #[test]
    fn characters_that_cannot_be_seen_are_named() {
        for (character, expected) in [
            ('\\', "\\"),
            ('\'', "'"),
            ('é', "é"),
            ('\u{200b}', "\\u{200b}"),
            ('\u{202e}', "\\u{202e}"),
            ('\t', "\\t"),
        ] {
            assert_eq!(readable(character), expected);
        }
    }
}
