//! What is said of an expression that cannot be read.

use std::ops::Range;

use super::elsewhere::FINITE;
use super::error::{FormulaError, FormulaErrorKind};
use super::function::ArgumentCount;
use super::item::{Item, Kind, shortened};
use super::scope::{Parameters, Scope};
use super::suggestion::suggestion;

/// How statements are parted.
const WHERE_LINES_END: &str = "a statement ends with its line, unless an operator stands at the end or at the start of the next one, or \
                               inside parentheses";

/// A name that means nothing; `next` stands after it. It may begin a statement and be all of an equation's left side, but for arguments.
pub(super) fn unknown_name(
    item: &Item<'_>,
    next: &Item<'_>,
    is_left_side: bool,
    scope: &Scope<'_>,
    parameters: &Parameters<'_>,
) -> FormulaError {
    let is_called = next.kind == Kind::open;
    let name = shortened(item.text);
    if item.text == "log" {
        return bare_logarithm(item.span());
    }
    let help = match (suggestion(item.text, is_called, scope, parameters), is_left_side) {
        (Some(help), true) if !is_called => {
            let end = if help.ends_with('?') { "" } else { "." };
            format!("{help}{end} To define it, write `{name} := …`")
        }
        (Some(help), _) => help,
        (None, true) if is_called => {
            format!("leave out `{name}(…) =` before a formula, or define it: `{name}(u) := …`")
        }
        (None, true) => format!("to define it, write `{name} := …`"),
        (None, false) if is_called => format!("define it before: `{name}(u) := …`"),
        (None, false) => format!("the coordinates are x, y and z; define others before: `{name} := 1`"),
    };
    let kind = match is_called {
        true => FormulaErrorKind::UnknownFunction { name },
        false => FormulaErrorKind::UnknownName { name },
    };
    FormulaError::new(kind, item.span()).with_help(help)
}

/// A function's name without a parenthesis after it; `pattern` is how it should look if it takes more than one argument.
pub(super) fn missing_arguments(item: &Item<'_>, next: &Item<'_>, pattern: Option<String>) -> FormulaError {
    if item.text == "log" {
        return bare_logarithm(item.span());
    }
    let name = shortened(item.text);
    let help = match next.kind {
        _ if let Some(pattern) = pattern => format!("it is called as `{}`", shortened(&pattern)),
        Kind::name | Kind::number | Kind::pi | Kind::tau => {
            format!("write `{name}({})`", shortened(next.text))
        }
        Kind::power | Kind::superscript => {
            let inverse = match item.text {
                "sin" | "cos" | "tan" | "sinh" | "cosh" | "tanh" => {
                    format!("; the inverse function is `a{name}(x)`")
                }
                _ => String::new(),
            };
            format!("write the power after the arguments: `{name}(x)^2`{inverse}")
        }
        _ => format!("its arguments stand in parentheses: `{name}(…)`"),
    };
    FormulaError::new(FormulaErrorKind::MissingArguments { name }, item.span()).with_help(help)
}

fn bare_logarithm(span: Range<usize>) -> FormulaError {
    let help = "write `ln(x)` for base e, `log2(x)`, `log10(x)`, or `log(b, x)` for base b";
    FormulaError::new(FormulaErrorKind::BareLogarithm, span).with_help(help)
}

/// A call with the wrong number of arguments; `pattern` is how it should look.
pub(super) fn argument_count(
    name: &str,
    given: usize,
    expected: ArgumentCount,
    span: Range<usize>,
    pattern: String,
) -> FormulaError {
    if name == "log" && given == 1 {
        return bare_logarithm(span);
    }
    let pattern = match (name, given) {
        ("atan" | "arctan", 2) => "atan2(y, x)".to_owned(),
        ("hypot", 3) => "hypot(hypot(a, b), c)".to_owned(),
        _ => pattern,
    };
    let kind =
        FormulaErrorKind::ArgumentCount { function: shortened(name), given, expected: expected.shown() };
    FormulaError::new(kind, span).with_help(format!("it is called as `{}`", shortened(&pattern)))
}

/// A bracket that nothing closes.
pub(super) fn unclosed(open: &Item<'_>) -> FormulaError {
    match open.kind {
        Kind::bar => FormulaError::new(FormulaErrorKind::UnclosedBar, open.span())
            .with_help("bars that stand inside each other are clearer as `abs(…)`"),
        _ => FormulaError::new(FormulaErrorKind::UnclosedParenthesis, open.span()).with_help("add `)`"),
    }
}

/// A comma outside of a function's arguments.
pub(super) fn stray_comma(item: &Item<'_>, is_between_numbers: bool) -> FormulaError {
    FormulaError::new(FormulaErrorKind::StrayComma, item.span()).with_help(match is_between_numbers {
        true => "decimals are written with a point, as in `0.5`",
        false => {
            "commas part the arguments of functions; `z(x, y) = …` is written `z = …`, and `;` or a new line ends a definition"
        }
    })
}

/// A character that the language does not use.
pub(super) fn stray(item: &Item<'_>) -> FormulaError {
    let character = item.text.chars().next().unwrap_or_default();
    let help = match character {
        '%' => Some("write `mod(a, b)` for the remainder of a divided by b, with the sign of b"),
        '[' | ']' => Some("use parentheses `(` `)`"),
        '{' | '}' => Some("use parentheses `(` `)`; a part of a surface is `F = C where x > 0`"),
        '&' => Some(
            "write `and` between conditions; `max(F, G)` is where both F and G are negative, `min(F, G)` where one of them is",
        ),
        '!' => Some("write `not`, or `!=` for inequality; there are no factorials but as products"),
        ':' => Some("write `:=` for a definition"),
        '.' => Some("a point stands in numbers only, as in `0.5`"),
        '\'' | '"' => Some("a formula is written without quotation marks"),
        '\\' => Some("LaTeX is not read: write `a/b`, `sqrt(a)`, `sin(a)`"),
        '∛' => Some("write `cbrt(a)`"),
        '∜' => Some("write `a^(1/4)`"),
        '÷' | '∕' => Some("write `/`"),
        '∗' => Some("write `*`"),
        '–' | '—' => Some("write `-`"),
        '∞' => Some(FINITE),
        '⌊' | '⌋' => Some("write `floor(a)`"),
        '⌈' | '⌉' => Some("write `ceil(a)`"),
        '±' | '∓' => Some("both signs at once are both factors of a product: `(x - 1)(x + 1) = 0`"),
        '≈' | '≡' | '≔' => {
            Some("write `=` between the two sides of an equation, `:=` for a definition")
        }
        '$' => Some("LaTeX is not read: leave out `$`"),
        '\u{200b}'..='\u{200f}' => Some("this is a character without width: leave it out"),
        '°' => Some("angles are in radians: write `*pi/180`"),
        '½' | '⅓' | '⅔' | '¼' | '¾' => Some("write fractions as `1/2`"),
        '₀'..='₉' => Some("write indices as digits: `x1`"),
        '_' => Some("digits are written without a break: `1000`; names begin with a letter"),
        '?' => Some("write `if(condition, a, b)`"),
        _ => None,
    };
    FormulaError::new(FormulaErrorKind::StrayCharacter { character }, item.span())
        .with_possible_help(help.map(str::to_owned))
}

/// Something else where an operand should start. `previous` is the last item on any line, `before` the last item.
pub(super) fn missing_operand(
    item: &Item<'_>,
    previous: Option<Item<'_>>,
    before: Option<Item<'_>>,
) -> FormulaError {
    let is_head = matches!(item.kind, Kind::function_head | Kind::value_head | Kind::define);
    let follows_line = before.is_some_and(|item| item.kind == Kind::newline);
    let ends = matches!(item.kind, Kind::EOI | Kind::semicolon) || is_head && follows_line;
    match previous {
        Some(operator) if ends && !is_statement_start(&operator) => {
            let kind = FormulaErrorKind::TrailingOperator { operator: operator.text.to_owned() };
            FormulaError::new(kind, operator.span()).with_help("give its right operand, or take it away")
        }
        _ if is_head => misplaced_definition(item),
        _ => {
            let kind = FormulaErrorKind::MissingOperand { found: item.shown() };
            let is_comment = item.text == "/" && before.is_some_and(|before| before.text == "/");
            let help = match (is_comment, follows_line) {
                (true, _) => Some("comments begin with `#`"),
                (_, true) => Some(WHERE_LINES_END),
                _ => None,
            };
            let help = help.map(str::to_owned);
            FormulaError::new(kind, item.span()).with_possible_help(help)
        }
    }
}

fn is_statement_start(item: &Item<'_>) -> bool {
    matches!(item.kind, Kind::semicolon | Kind::function_head | Kind::value_head)
}

/// An operand that follows another, but cannot be its factor.
pub(super) fn missing_operator(item: &Item<'_>) -> FormulaError {
    let help = match item.kind {
        Kind::cut => "one `where` stands behind the formula; `and` joins conditions",
        _ => "a number stands before what it multiplies; write `*` or `^` between two factors",
    };
    FormulaError::new(FormulaErrorKind::MissingOperator { found: item.shown() }, item.span()).with_help(help)
}

/// `:=` in the middle of an expression.
pub(super) fn misplaced_definition(item: &Item<'_>) -> FormulaError {
    FormulaError::new(FormulaErrorKind::MisplacedDefinition, item.span())
        .with_help("a statement of its own defines a name, `a := 1`, or a function, `f(u) := u^2`; `;` or a new line ends it")
}

/// `=` where only `==` can stand.
pub(super) fn equation_inside(item: &Item<'_>, in_brackets: bool) -> FormulaError {
    let help = match in_brackets {
        true => "write `==` to compare",
        false => {
            "write `==` to compare; `;` or a new line ends a definition, and the equation comes after it"
        }
    };
    FormulaError::new(FormulaErrorKind::EquationInside, item.span()).with_help(help)
}

/// Something else than inequalities behind `where`.
pub(super) fn no_domain(span: Range<usize>) -> FormulaError {
    FormulaError::new(FormulaErrorKind::NoDomain, span)
        .with_help("join them by `and`, `or` and `not`: `where x^2 + y^2 + z^2 < 4 and z > 0`")
}

/// A second statement that is no definition.
pub(super) fn second_formula(span: Range<usize>, both_are_equations: bool) -> FormulaError {
    match both_are_equations {
        true => FormulaError::new(FormulaErrorKind::TwoEquations, span)
            .with_help("a picture of both is the product of their left sides, each less its right side"),
        false => FormulaError::new(FormulaErrorKind::TwoFormulas, span)
            .with_help(format!("{WHERE_LINES_END}; definitions are written with `:=`")),
    }
}
