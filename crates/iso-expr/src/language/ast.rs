//! The syntax tree of a formula.

use std::ops::Range;

use super::domain::Domain;
use super::function::Function;
use crate::{Axis, Constant};

/// A formula as it was written, with every name resolved.
///
/// [`Ast::parse`] makes it, [`Ast::lower`] turns it into a program. Its `Display` is the canonical text, which parses to
/// an equal tree; [`Ast::outline`] shows its structure.
#[derive(Clone, Debug, PartialEq)]
pub struct Ast {
    pub(super) definitions: Vec<Definition>,
    /// The left side of an equation, or a bare expression.
    pub(super) left: Tree,
    /// The right side of an equation.
    pub(super) right: Option<Tree>,
    /// Where the formula counts, unless that is everywhere.
    pub(super) domain: Option<Domain>,
}

/// `name := body` or `name(parameters) := body`.
#[derive(Clone, Debug)]
pub(super) struct Definition {
    pub(super) name: String,
    /// The parameters of a function; none for a value.
    pub(super) parameters: Vec<String>,
    pub(super) body: Tree,
    /// Whether no coordinate is named in the body, nor in any definition that it uses.
    pub(super) is_constant: bool,
    /// Where the name stands.
    pub(super) span: Range<usize>,
}

impl Definition {
    /// Whether it is a parameter of the formula: a constant that may be given another value.
    pub(super) fn is_parameter(&self) -> bool {
        self.parameters.is_empty() && self.is_constant
    }
}

/// Where it stands in the text does not matter.
impl PartialEq for Definition {
    fn eq(&self, other: &Self) -> bool {
        (&self.name, &self.parameters, &self.body) == (&other.name, &other.parameters, &other.body)
    }
}

/// An expression: its terms, each after its operands. The last one is the root.
///
/// Equal expressions have equal trees, and nothing that is done with a tree has to recurse.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Tree {
    terms: Vec<Term>,
}

/// The place of a term in its [`Tree`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TermId(u32);

impl TermId {
    pub(super) fn index(self) -> usize {
        self.0 as usize
    }
}

/// The place of a definition among the definitions of a formula, or of the prelude.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct DefinitionId(pub(super) u32);

impl DefinitionId {
    pub(super) fn index(self) -> usize {
        self.0 as usize
    }
}

/// One number, name or application in an expression.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Term {
    /// A literal, finite and not negative.
    Number(f64),
    Variable(Axis),
    Constant(NamedConstant),
    /// A name defined in the formula.
    Value(DefinitionId),
    /// The parameter at this place of the function whose body this is.
    Parameter(u32),
    Prefix(Prefix, TermId),
    Infix(Infix, TermId, TermId),
    Call(Function, Vec<TermId>),
}

impl Term {
    /// The operands, from left to right.
    pub(super) fn operands(&self) -> impl DoubleEndedIterator<Item = TermId> {
        let (one, two, many): (Option<TermId>, Option<TermId>, &[TermId]) = match self {
            Self::Prefix(_, operand) => (Some(*operand), None, &[]),
            Self::Infix(_, left, right) => (Some(*left), Some(*right), &[]),
            Self::Call(_, arguments) => (None, None, arguments),
            _ => (None, None, &[]),
        };
        one.into_iter().chain(two).chain(many.iter().copied())
    }
}

impl Tree {
    pub(super) fn push(&mut self, term: Term) -> TermId {
        let id = TermId(self.terms.len() as u32);
        self.terms.push(term);
        id
    }

    pub(super) fn terms(&self) -> &[Term] {
        &self.terms
    }

    pub(super) fn term(&self, id: TermId) -> &Term {
        &self.terms[id.index()]
    }

    pub(super) fn root(&self) -> TermId {
        TermId(self.terms.len() as u32 - 1)
    }
}

/// A constant that has a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NamedConstant {
    Pi,
    E,
    Tau,
}

impl NamedConstant {
    pub(super) const ALL: [Self; 3] = [Self::Pi, Self::E, Self::Tau];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Pi => "pi",
            Self::E => "e",
            Self::Tau => "tau",
        }
    }

    pub(super) const fn value(self) -> Constant {
        match self {
            Self::Pi => Constant::PI,
            Self::E => Constant::E,
            Self::Tau => Constant::TAU,
        }
    }
}

/// How tightly a term holds together, loosest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Precedence {
    Or,
    And,
    Not,
    Comparison,
    Sum,
    Product,
    Sign,
    Power,
    Operand,
}

/// An operator in front of its operand. √ is a function that is written as one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Prefix {
    Negate,
    Not,
}

impl Prefix {
    pub(super) const fn precedence(self) -> Precedence {
        match self {
            Self::Negate => Precedence::Sign,
            Self::Not => Precedence::Not,
        }
    }

    pub(super) const fn sign(self) -> &'static str {
        match self {
            Self::Negate => "-",
            Self::Not => "not ",
        }
    }
}

/// An operator between its operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Infix {
    Or,
    And,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    NotEqual,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

impl Infix {
    pub(super) const fn precedence(self) -> Precedence {
        match self {
            Self::Or => Precedence::Or,
            Self::And => Precedence::And,
            Self::Less | Self::LessOrEqual | Self::Greater | Self::GreaterOrEqual => Precedence::Comparison,
            Self::Equal | Self::NotEqual => Precedence::Comparison,
            Self::Add | Self::Subtract => Precedence::Sum,
            Self::Multiply | Self::Divide => Precedence::Product,
            Self::Power => Precedence::Power,
        }
    }

    /// The canonical sign, with the blanks around it.
    pub(super) const fn sign(self) -> &'static str {
        match self {
            Self::Or => " or ",
            Self::And => " and ",
            Self::Less => " < ",
            Self::LessOrEqual => " <= ",
            Self::Greater => " > ",
            Self::GreaterOrEqual => " >= ",
            Self::Equal => " == ",
            Self::NotEqual => " != ",
            Self::Add => " + ",
            Self::Subtract => " - ",
            Self::Multiply => "*",
            Self::Divide => "/",
            Self::Power => "^",
        }
    }
}
