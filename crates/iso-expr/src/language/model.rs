//! Models in the text form of fidget: one operation a line, `NAME OPERATION OPERANDS`, the last line being F.
//!
//! ```text
//! # A unit sphere.
//! _0 var-x
//! _1 square _0
//! _2 const 1
//! _3 sub _1 _2
//! ```
//!
//! The form is that of `fidget::context::Context::from_text` (<https://github.com/mkeeter/fidget>), and so is the meaning
//! of every operation, but for two things: constants are doubles, and what has a NaN for an operand that counts is undefined. The
//! surface of a model is F = 0.

use std::collections::HashMap;
use std::ops::Range;

use super::builder::Builder;
use super::error::{FormulaError, FormulaErrorKind};
use super::item::shortened;
use super::limits;
use super::lower::Formula;
use super::suggestion::nearest;
use crate::{Axis, NodeId, Operation};

impl Formula {
    /// Reads a model.
    ///
    /// # Errors
    /// When a line breaks the form, names what no line before it defines, or the model exceeds [`limits`].
    pub fn read_model(text: &str) -> Result<Self, FormulaError> {
        let allowed = limits::LARGEST_MODEL;
        if text.len() > allowed {
            return Err(FormulaError::new(FormulaErrorKind::TooLong { allowed }, allowed..allowed));
        }
        let mut model = Model { builder: Builder::default(), values: HashMap::new() };
        let mut last = None;
        // Editors of some systems begin a text with a mark.
        for line in text
            .trim_start_matches('\u{feff}')
            .lines()
            .map(str::trim)
            .filter(|line| !line.is_empty() && !line.starts_with('#'))
        {
            last = Some(model.read_line(text, line)?);
        }
        let Some(output) = last else {
            return Err(FormulaError::new(FormulaErrorKind::Empty, 0..0)
                .with_help("write one operation a line, such as `a var-x`; the last one is the surface"));
        };
        Ok(Self::of_program(model.builder.finish(output)))
    }
}

/// A word of a line, and its place in the text.
#[derive(Clone)]
struct Word<'a> {
    text: &'a str,
    span: Range<usize>,
}

impl<'a> Word<'a> {
    /// Words of `line`, which is a part of `text`.
    fn all(text: &'a str, line: &'a str) -> impl Iterator<Item = Self> {
        line.split_whitespace().map(|word| {
            let start = word.as_ptr() as usize - text.as_ptr() as usize;
            Word { text: word, span: start..start + word.len() }
        })
    }

    fn wrong(&self, kind: FormulaErrorKind) -> FormulaError {
        FormulaError::new(kind, self.span.clone())
    }
}

/// What a line computes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Code {
    Constant,
    Variable(Axis),
    /// An operation of the table.
    Apply(Operation),
    Square,
    /// Ties go away from zero.
    Round,
    /// 1 for zero, else 0.
    Not,
    /// −1, 0 or 1 as the first operand is below, equal to or above the second.
    Compare,
    /// The remainder that is not negative.
    Remainder,
    /// The second operand where the first is not zero, else the first.
    And,
    /// The first operand where it is not zero, else the second.
    Or,
}

/// Every operation of the form.
const CODES: [(&str, Code); 31] = [
    ("const", Code::Constant),
    ("var-x", Code::Variable(Axis::X)),
    ("var-y", Code::Variable(Axis::Y)),
    ("var-z", Code::Variable(Axis::Z)),
    ("abs", Code::Apply(Operation::Absolute)),
    ("neg", Code::Apply(Operation::Negate)),
    ("sqrt", Code::Apply(Operation::SquareRoot)),
    ("square", Code::Square),
    ("floor", Code::Apply(Operation::Floor)),
    ("ceil", Code::Apply(Operation::Ceil)),
    ("round", Code::Round),
    ("sin", Code::Apply(Operation::Sin)),
    ("cos", Code::Apply(Operation::Cos)),
    ("tan", Code::Apply(Operation::Tan)),
    ("asin", Code::Apply(Operation::Asin)),
    ("acos", Code::Apply(Operation::Acos)),
    ("atan", Code::Apply(Operation::Atan)),
    ("ln", Code::Apply(Operation::Ln)),
    ("exp", Code::Apply(Operation::Exp)),
    ("not", Code::Not),
    ("add", Code::Apply(Operation::Add)),
    ("sub", Code::Apply(Operation::Subtract)),
    ("mul", Code::Apply(Operation::Multiply)),
    ("div", Code::Apply(Operation::Divide)),
    ("min", Code::Apply(Operation::Minimum)),
    ("max", Code::Apply(Operation::Maximum)),
    ("atan2", Code::Apply(Operation::Atan2)),
    ("compare", Code::Compare),
    ("mod", Code::Remainder),
    ("and", Code::And),
    ("or", Code::Or),
];

impl Code {
    /// What `word` names.
    fn of(word: &Word<'_>) -> Result<Self, FormulaError> {
        let found = CODES.iter().find(|(name, _)| *name == word.text);
        found.map(|(_, code)| *code).ok_or_else(|| {
            let help = nearest(word.text, CODES.iter().map(|(name, _)| *name))
                .map(|near| format!("did you mean `{near}`?"));
            let name = shortened(word.text);
            word.wrong(FormulaErrorKind::UnknownOperation { name }).with_possible_help(help)
        })
    }

    /// How many words follow it.
    fn arity(self) -> usize {
        match self {
            Self::Variable(_) => 0,
            Self::Constant | Self::Square | Self::Round | Self::Not => 1,
            Self::Compare | Self::Remainder | Self::And | Self::Or => 2,
            Self::Apply(operation) => operation.arity(),
        }
    }
}

/// A model as far as it is read.
struct Model<'a> {
    builder: Builder,
    /// What each name stands for.
    values: HashMap<&'a str, NodeId>,
}

impl<'a> Model<'a> {
    /// Adds what a line that is not empty computes.
    fn read_line(&mut self, text: &'a str, line: &'a str) -> Result<NodeId, FormulaError> {
        let mut words = Word::all(text, line);
        let name = words.next().expect("a line that is not empty has a word");
        if self.values.contains_key(name.text) {
            return Err(name.wrong(FormulaErrorKind::DefinedTwice { name: shortened(name.text) }));
        }
        let operation = words.next().ok_or_else(|| {
            let kind = FormulaErrorKind::MissingOperation { name: shortened(name.text) };
            name.wrong(kind).with_help("each line is a name, an operation and its operands: `a add b c`")
        })?;
        let code = Code::of(&operation)?;
        // One word too many is enough to know that the line is wrong.
        let operands: Vec<_> = words.by_ref().take(code.arity() + 1).collect();
        if operands.len() != code.arity() {
            let given = operands.len() + words.count();
            return Err(operation.wrong(FormulaErrorKind::ArgumentCount {
                function: operation.text.to_owned(),
                given,
                expected: ["no operands", "one operand", "two operands"][code.arity()].to_owned(),
            }));
        }
        let node = match code {
            Code::Constant => self.constant(&operands[0])?,
            Code::Variable(axis) => self.builder.variable(axis),
            code => {
                let nodes = operands.iter().map(|word| self.value(word)).collect::<Result<Vec<_>, _>>()?;
                self.apply(code, &nodes).map_err(|error| FormulaError { span: name.span, ..error })?
            }
        };
        self.values.insert(name.text, node);
        Ok(node)
    }

    /// What a line before has computed.
    fn value(&self, word: &Word<'_>) -> Result<NodeId, FormulaError> {
        self.values.get(word.text).copied().ok_or_else(|| {
            word.wrong(FormulaErrorKind::UnknownName { name: shortened(word.text) })
                .with_help("a line may use what the lines before it define")
        })
    }

    fn constant(&mut self, word: &Word<'_>) -> Result<NodeId, FormulaError> {
        let number = || shortened(word.text);
        match word.text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(self.builder.literal(value)),
            Ok(_) => Err(word.wrong(FormulaErrorKind::NumberOutOfRange { number: number() })),
            Err(_) => Err(word.wrong(FormulaErrorKind::NotANumber { found: number() })),
        }
    }

    /// Adds an operation on nodes.
    fn apply(&mut self, code: Code, nodes: &[NodeId]) -> Result<NodeId, FormulaError> {
        use Operation::*;
        let builder = &mut self.builder;
        let (a, b) = (nodes[0], nodes[nodes.len() - 1]);
        match code {
            Code::Apply(operation) => builder.apply(operation, nodes),
            Code::Square => {
                let two = builder.literal(2.0);
                builder.power(a, two)
            }
            Code::Round => {
                let (half, zero) = (builder.literal(0.5), builder.literal(0.0));
                let whole = builder.apply(Truncate, &[a])?;
                // Exact.
                let fraction = builder.apply(Subtract, &[a, whole])?;
                let size = builder.apply(Absolute, &[fraction])?;
                let is_up = builder.apply(LessOrEqual, &[half, size])?;
                let sign = builder.apply(Sign, &[a])?;
                let step = builder.apply(Select, &[is_up, sign, zero])?;
                builder.apply(Add, &[whole, step])
            }
            Code::Not => {
                let zero = builder.literal(0.0);
                builder.apply(Equal, &[a, zero])
            }
            Code::Compare => {
                let [below, equal, above] = [-1.0, 0.0, 1.0].map(|value| builder.literal(value));
                let (is_below, is_above) = (builder.apply(Less, &[a, b])?, builder.apply(Less, &[b, a])?);
                let otherwise = builder.apply(Select, &[is_above, above, equal])?;
                builder.apply(Select, &[is_below, below, otherwise])
            }
            Code::Remainder => {
                let size = builder.apply(Absolute, &[b])?;
                builder.apply(Modulo, &[a, size])
            }
            Code::And => {
                let condition = builder.truth(a)?;
                builder.apply(Select, &[condition, b, a])
            }
            Code::Or => {
                let condition = builder.truth(a)?;
                builder.apply(Select, &[condition, a, b])
            }
            Code::Constant | Code::Variable(_) => unreachable!("they have no operands that are nodes"),
        }
    }
}

#[cfg(test)]
mod tests;
