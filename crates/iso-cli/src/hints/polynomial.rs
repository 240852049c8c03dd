//! Polynomials of a coordinate that are written out in powers, and their form by Horner, which rounds less.
//!
//! Where the base is itself rounded, that rounding drowns the difference: such polynomials are left alone.

use std::cmp::Reverse;

use iso_expr::{Argument, Node, NodeId, Operation};

use super::{Hint, Parts};

/// The least degree of a polynomial that a hint is given for.
const LEAST_DEGREE: u32 = 3;
/// The fewest terms: with fewer, little is gained.
const FEWEST_TERMS: usize = 4;
/// The most terms: more than anybody writes by hand.
const MOST_TERMS: usize = 40;

/// What a part of a formula is as a polynomial in one coordinate, its base.
#[derive(Clone, Copy)]
enum Form {
    Constant,
    /// A power of the base, perhaps with a factor or a sign.
    Term {
        base: Argument,
        power: u32,
        is_bare: bool,
    },
    /// Several of these.
    Sum {
        base: Argument,
        terms: usize,
    },
    /// No polynomial that is written out.
    Other,
}

/// A power of the base with a sign and a factor.
struct Term {
    power: u32,
    is_negative: bool,
    /// Missing where it is 1.
    factor: Option<String>,
}

/// The hints for the largest parts that are polynomials written out.
pub(super) fn hints(parts: &Parts<'_>) -> Vec<(NodeId, Hint)> {
    let forms = forms(parts);
    let mut hints = Vec::new();
    let mut is_covered = vec![false; forms.len()];
    for (id, node) in parts.0.iter().rev() {
        if !matches!(forms[id.index()], Form::Sum { .. }) {
            continue;
        }
        if !is_covered[id.index()] {
            // What is no hint as a whole, as an equation with constants on both sides, may hold one.
            let Some(hint) = hint(parts, &forms, id) else { continue };
            hints.push((id, hint));
        }
        node.operands().iter().for_each(|operand| is_covered[operand.index()] = true);
    }
    hints
}

/// What every node is.
fn forms(parts: &Parts<'_>) -> Vec<Form> {
    let mut forms: Vec<Form> = Vec::with_capacity(parts.0.nodes().len());
    for node in parts.0.nodes() {
        let of = |operand: NodeId| forms[operand.index()];
        let form = match *node {
            Node::Constant(_) => Form::Constant,
            Node::Variable(base) => Form::Term { base, power: 1, is_bare: true },
            Node::Apply(Operation::Negate, [operand, ..]) => match of(operand) {
                Form::Term { base, power, .. } => Form::Term { base, power, is_bare: false },
                form => form,
            },
            Node::Apply(Operation::Add | Operation::Subtract, [left, right, _]) => sum(of(left), of(right)),
            Node::Apply(Operation::Multiply, [left, right, _]) => product(of(left), of(right)),
            Node::Apply(Operation::IntegerPower, [operand, exponent, _]) => match of(operand) {
                Form::Term { base, power: 1, is_bare } if is_bare => {
                    let power = parts.value(exponent).expect("the exponent is a constant") as u32;
                    Form::Term { base, power, is_bare }
                }
                _ => Form::Other,
            },
            Node::Apply(..) => Form::Other,
        };
        forms.push(form);
    }
    forms
}

fn sum(left: Form, right: Form) -> Form {
    let size = |form| match form {
        Form::Constant => Some((None, 1)),
        Form::Term { base, .. } => Some((Some(base), 1)),
        Form::Sum { base, terms } => Some((Some(base), terms)),
        Form::Other => None,
    };
    let (Some((left, left_terms)), Some((right, right_terms))) = (size(left), size(right)) else {
        return Form::Other;
    };
    let terms = left_terms + right_terms;
    match left.or(right) {
        None => Form::Constant,
        Some(base) if terms <= MOST_TERMS && right.is_none_or(|right| right == base) => {
            Form::Sum { base, terms }
        }
        Some(_) => Form::Other,
    }
}

fn product(left: Form, right: Form) -> Form {
    match (left, right) {
        (Form::Constant, Form::Constant) => Form::Constant,
        (Form::Constant, Form::Term { base, power, is_bare: true })
        | (Form::Term { base, power, is_bare: true }, Form::Constant) => {
            Form::Term { base, power, is_bare: false }
        }
        (
            Form::Term { base, power: one, is_bare: true },
            Form::Term { base: right, power: other, is_bare: true },
        ) if base == right => Form::Term { base, power: one.saturating_add(other), is_bare: true },
        _ => Form::Other,
    }
}

/// The hint for the part at `id`, if it is a polynomial whose terms may cancel.
fn hint(parts: &Parts<'_>, forms: &[Form], id: NodeId) -> Option<Hint> {
    let Form::Sum { base, .. } = forms[id.index()] else { return None };
    let mut terms = Vec::new();
    collect(parts, forms, (id, false), &mut terms);
    let base = &base.to_string();
    let written = written_out(base, &terms);
    terms.sort_by_key(|term| Reverse(term.power));
    let is_long = terms.len() >= FEWEST_TERMS && terms[0].power >= LEAST_DEGREE;
    let is_collected = terms.windows(2).all(|pair| pair[0].power > pair[1].power);
    (is_long && is_collected && may_cancel(&terms)).then(|| Hint {
        written,
        instead: nested(base, &terms),
        unless: None,
        reason: "powers and their sums are rounded before the terms cancel",
    })
}

/// Adds the terms of the part at `id`, which is negative or not, in the order in which they are written.
fn collect(parts: &Parts<'_>, forms: &[Form], (id, is_negative): (NodeId, bool), terms: &mut Vec<Term>) {
    match (forms[id.index()], parts.0.node(id)) {
        (Form::Constant, _) => terms.push(term(parts, 0, is_negative, Some(id))),
        (_, Node::Apply(Operation::Negate, [operand, ..])) => {
            collect(parts, forms, (operand, !is_negative), terms);
        }
        (Form::Term { power, is_bare: true, .. }, _) => terms.push(term(parts, power, is_negative, None)),
        (Form::Term { power, .. }, node) => {
            let is_constant = |operand: &&NodeId| matches!(forms[operand.index()], Form::Constant);
            let factor = node.operands().iter().find(is_constant).copied();
            terms.push(term(parts, power, is_negative, factor));
        }
        (Form::Sum { .. } | Form::Other, node) => {
            let is_difference = matches!(node, Node::Apply(Operation::Subtract, _));
            let &[left, right] = node.operands() else { unreachable!("a sum has two operands") };
            collect(parts, forms, (left, is_negative), terms);
            collect(parts, forms, (right, is_negative != is_difference), terms);
        }
    }
}

/// A term with the sign of its factor taken out.
fn term(parts: &Parts<'_>, power: u32, is_negative: bool, factor: Option<NodeId>) -> Term {
    match factor.map(|id| (id, parts.0.node(id))) {
        Some((_, Node::Apply(Operation::Negate, [operand, ..]))) => {
            term(parts, power, !is_negative, Some(operand))
        }
        factor => {
            let factor = factor.map(|(id, _)| parts.operand(id));
            match factor.as_deref().and_then(|factor| factor.strip_prefix('-')) {
                Some(size) => Term { power, is_negative: !is_negative, factor: Some(size.to_owned()) },
                None => Term { power, is_negative, factor },
            }
        }
    }
}

/// Whether there is a base for which not all terms have one sign.
fn may_cancel(terms: &[Term]) -> bool {
    let signs = |of: fn(&Term) -> bool| terms.iter().any(|term| of(term) != of(&terms[0]));
    signs(|term| term.is_negative) || signs(|term| term.is_negative != (term.power % 2 == 1))
}

/// a·uⁿ + b·uᵐ + …
fn written_out(base: &str, terms: &[Term]) -> String {
    let mut text = String::new();
    for term in terms {
        let product = match (&term.factor, term.power) {
            (Some(factor), 0) => factor.clone(),
            (Some(factor), power) => format!("{factor}*{}", raised(base, power)),
            (None, power) => raised(base, power),
        };
        text = added(&text, term.is_negative, &product);
    }
    text
}

/// ((a·uⁿ⁻ᵐ + b)·uᵐ⁻ᵏ + …, the terms in falling order.
fn nested(base: &str, terms: &[Term]) -> String {
    let mut text = String::new();
    for (place, term) in terms.iter().enumerate() {
        let next = terms.get(place + 1).map_or(0, |next| next.power);
        let drop = term.power - next;
        let is_first = place == 0;
        text = match &term.factor {
            Some(factor) => added(&text, term.is_negative, factor),
            None if is_first => added("", term.is_negative, &raised(base, drop)),
            None => added(&text, term.is_negative, "1"),
        };
        let is_raised = is_first && term.factor.is_none();
        if drop > 0 && !is_raised {
            let inner = if is_first { text } else { format!("({text})") };
            text = format!("{inner}*{}", raised(base, drop));
        }
    }
    text
}

fn raised(base: &str, power: u32) -> String {
    if power == 1 { base.to_owned() } else { format!("{base}^{power}") }
}

/// `sum` and one term more.
fn added(sum: &str, is_negative: bool, term: &str) -> String {
    match (sum.is_empty(), is_negative) {
        (true, false) => term.to_owned(),
        (true, true) => format!("-{term}"),
        (false, false) => format!("{sum} + {term}"),
        (false, true) => format!("{sum} - {term}"),
    }
}
