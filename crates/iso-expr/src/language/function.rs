//! The functions that formulas can call.
//!
//! Most are operations and take their names from the one table of operations. The derived ones are written in the
//! language itself, in `prelude.iso`: to add one, add its line there.

use std::sync::LazyLock;

use super::ast::{Definition, DefinitionId};
use super::parse::parse_prelude;
use crate::Operation;

/// What a call calls.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Function {
    /// An operation with all its operands.
    Operation(Operation),
    /// An operation of two operands, taken over two or more from left to right.
    Fold(Operation),
    /// A function of the prelude.
    Prelude(DefinitionId),
    /// A function that the formula defines.
    Defined(DefinitionId),
}

/// How many arguments a function takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ArgumentCount {
    Exactly(usize),
    AtLeast(usize),
}

impl ArgumentCount {
    pub(super) fn allows(self, given: usize) -> bool {
        match self {
            Self::Exactly(expected) => given == expected,
            Self::AtLeast(fewest) => given >= fewest,
        }
    }

    /// The count in words.
    pub(super) fn shown(self) -> String {
        match self {
            Self::Exactly(1) => "1 argument".to_owned(),
            Self::Exactly(expected) => format!("{expected} arguments"),
            Self::AtLeast(fewest) => format!("{fewest} or more arguments"),
        }
    }
}

/// Operations taken over any number of arguments.
const FOLDS: [Operation; 2] = [Operation::Minimum, Operation::Maximum];

static PRELUDE: LazyLock<Vec<Definition>> = LazyLock::new(|| parse_prelude(include_str!("prelude.iso")));

/// The definitions of the derived functions.
pub(super) fn prelude() -> &'static [Definition] {
    &PRELUDE
}

impl Function {
    /// The operation that goes by this name.
    pub(super) fn operation(name: &str) -> Option<Self> {
        let operation = Operation::all().find(|operation| operation.calls().contains(&name));
        let fold = || FOLDS.into_iter().find(|operation| operation.name() == name);
        operation.map(Self::Operation).or_else(|| fold().map(Self::Fold))
    }

    /// Every name by which an operation is called, the usual ones before others of the same operations.
    pub(super) fn operation_names() -> impl Iterator<Item = &'static str> {
        let usual = Operation::all().filter_map(|operation| operation.calls().first());
        let others = Operation::all().flat_map(|operation| operation.calls().iter().skip(1));
        usual.copied().chain(FOLDS.into_iter().map(Operation::name)).chain(others.copied())
    }

    /// The name by which it is printed; `definitions` are those of the formula.
    pub(super) fn name(self, definitions: &[Definition]) -> &str {
        match self {
            Self::Operation(operation) => operation.calls()[0],
            Self::Fold(operation) => operation.name(),
            Self::Prelude(id) => &prelude()[id.index()].name,
            Self::Defined(id) => &definitions[id.index()].name,
        }
    }
}
