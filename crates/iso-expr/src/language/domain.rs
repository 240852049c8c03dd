//! Where a formula counts: what stands after `where`.

use super::ast::{Infix, Prefix, Term, TermId, Tree};
use super::function::Function;
use crate::Operation;

/// A condition that cuts a surface.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Domain {
    /// As it was written.
    pub(super) condition: Tree,
    /// An expression that is positive where the condition holds, negative where it does not, and zero between.
    pub(super) margin: Tree,
}

impl Domain {
    /// `None` unless the condition is made of inequalities by `and`, `or` and `not`.
    pub(super) fn new(condition: Tree) -> Option<Self> {
        let mut are_conditions = vec![false; condition.terms().len()];
        are_conditions[condition.root().index()] = true;
        // Terms come after their operands.
        for place in (0..are_conditions.len()).rev() {
            if are_conditions[place] {
                for joined in joined(&condition.terms()[place]) {
                    are_conditions[joined.index()] = true;
                }
            }
        }
        let mut margin = Tree::default();
        for (term, is_condition) in condition.terms().iter().zip(are_conditions) {
            margin.push(if is_condition { margin_of(term)? } else { term.clone() });
        }
        Some(Self { condition, margin })
    }
}

/// The conditions that a condition joins.
fn joined(condition: &Term) -> impl Iterator<Item = TermId> {
    let joins = matches!(condition, Term::Infix(Infix::And | Infix::Or, ..) | Term::Prefix(Prefix::Not, _));
    condition.operands().filter(move |_| joins)
}

/// The margin of a condition that joins others by theirs, or compares.
fn margin_of(condition: &Term) -> Option<Term> {
    let of_both = |operation, one: &TermId, other: &TermId| {
        Term::Call(Function::Operation(operation), vec![*one, *other])
    };
    Some(match condition {
        Term::Infix(Infix::And, one, other) => of_both(Operation::Minimum, one, other),
        Term::Infix(Infix::Or, one, other) => of_both(Operation::Maximum, one, other),
        Term::Prefix(Prefix::Not, one) => Term::Prefix(Prefix::Negate, *one),
        Term::Infix(Infix::Less | Infix::LessOrEqual, less, more)
        | Term::Infix(Infix::Greater | Infix::GreaterOrEqual, more, less) => {
            Term::Infix(Infix::Subtract, *more, *less)
        }
        _ => return None,
    })
}
