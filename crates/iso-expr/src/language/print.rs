//! The canonical text of a formula: as few parentheses as its tree needs, every product written out, one line.

use std::fmt::{self, Display, Formatter};

use super::ast::{Ast, Definition, Infix, Precedence, Prefix, Term, TermId, Tree};

/// Parses to an equal tree, as long as the text stays within the limit of length.
impl Display for Ast {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for definition in &self.definitions {
            f.write_str(&definition.name)?;
            if !definition.parameters.is_empty() {
                write!(f, "({})", definition.parameters.join(", "))?;
            }
            f.write_str(" := ")?;
            let names = Names { definitions: &self.definitions, parameters: &definition.parameters };
            write_expression(f, &definition.body, Precedence::Or, names)?;
            f.write_str("; ")?;
        }
        // Outside of parentheses a formula has no comparisons: `(x < 1)` keeps its own.
        let names = Names { definitions: &self.definitions, parameters: &[] };
        write_expression(f, &self.left, Precedence::Sum, names)?;
        if let Some(right) = &self.right {
            f.write_str(" = ")?;
            write_expression(f, right, Precedence::Sum, names)?;
        }
        Ok(())
    }
}

/// What the names in a tree are.
#[derive(Clone, Copy)]
pub(super) struct Names<'a> {
    pub(super) definitions: &'a [Definition],
    pub(super) parameters: &'a [String],
}

/// What is still to be written.
enum Piece {
    Term(TermId, Precedence),
    Text(&'static str),
}

/// Writes a tree, in parentheses unless it holds together at least as tightly as `tightness`.
fn write_expression(
    f: &mut Formatter<'_>,
    tree: &Tree,
    tightness: Precedence,
    names: Names<'_>,
) -> fmt::Result {
    let mut pieces = vec![Piece::Term(tree.root(), tightness)];
    while let Some(piece) = pieces.pop() {
        match piece {
            Piece::Text(text) => f.write_str(text)?,
            Piece::Term(id, tightness) => {
                let term = tree.term(id);
                if precedence(term) < tightness {
                    f.write_str("(")?;
                    pieces.push(Piece::Text(")"));
                }
                write_start(f, term, names, &mut pieces)?;
            }
        }
    }
    Ok(())
}

/// Writes what a term starts with, and leaves the rest to `pieces`, the next one last.
fn write_start(f: &mut Formatter<'_>, term: &Term, names: Names<'_>, pieces: &mut Vec<Piece>) -> fmt::Result {
    match term {
        Term::Prefix(prefix, operand) => {
            pieces.push(Piece::Term(*operand, prefix.precedence()));
            f.write_str(prefix.sign())
        }
        Term::Infix(infix, left, right) => {
            let (left_tightness, right_tightness) = tightness(*infix);
            pieces.push(Piece::Term(*right, right_tightness));
            pieces.push(Piece::Text(infix.sign()));
            pieces.push(Piece::Term(*left, left_tightness));
            Ok(())
        }
        Term::Call(function, arguments) => {
            pieces.push(Piece::Text(")"));
            for (place, argument) in arguments.iter().enumerate().rev() {
                pieces.push(Piece::Term(*argument, Precedence::Or));
                pieces.push(Piece::Text(if place == 0 { "(" } else { ", " }));
            }
            f.write_str(function.name(names.definitions))
        }
        _ => write_leaf(f, term, names),
    }
}

/// Writes a term without operands, or the operator or function of one that has some.
pub(super) fn write_leaf(f: &mut Formatter<'_>, term: &Term, names: Names<'_>) -> fmt::Result {
    match term {
        Term::Number(value) => {
            let digits = format!("{value:?}");
            f.write_str(digits.strip_suffix(".0").unwrap_or(&digits))
        }
        Term::Variable(axis) => f.write_str(axis.name()),
        Term::Constant(constant) => f.write_str(constant.name()),
        Term::Value(id) => f.write_str(&names.definitions[id.index()].name),
        Term::Parameter(place) => f.write_str(&names.parameters[*place as usize]),
        Term::Prefix(Prefix::Negate, _) => f.write_str("negate"),
        Term::Prefix(Prefix::Not, _) => f.write_str("not"),
        Term::Infix(infix, ..) => f.write_str(infix.sign().trim()),
        Term::Call(function, _) => f.write_str(function.name(names.definitions)),
    }
}

fn precedence(term: &Term) -> Precedence {
    match term {
        Term::Prefix(prefix, _) => prefix.precedence(),
        Term::Infix(infix, ..) => infix.precedence(),
        _ => Precedence::Operand,
    }
}

/// How tightly the left and the right operand must hold together to stand without parentheses.
fn tightness(infix: Infix) -> (Precedence, Precedence) {
    match infix.precedence() {
        Precedence::Or => (Precedence::Or, Precedence::And),
        Precedence::And => (Precedence::And, Precedence::Not),
        Precedence::Comparison => (Precedence::Sum, Precedence::Sum),
        Precedence::Sum => (Precedence::Sum, Precedence::Product),
        Precedence::Product => (Precedence::Product, Precedence::Sign),
        // An exponent may have a sign: 2^-3.
        _ => (Precedence::Operand, Precedence::Sign),
    }
}
