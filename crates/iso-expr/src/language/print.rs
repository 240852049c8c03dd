//! The canonical text of a formula: as few parentheses as its tree needs, every product written out, one line.

use std::fmt::{self, Display, Formatter};

use super::ast::{Ast, Definition, Infix, Precedence, Prefix, Term, TermId, Tree};
use super::domain::Domain;

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
        if let Some(Domain { condition, .. }) = &self.domain {
            f.write_str(" where ")?;
            write_expression(f, condition, Precedence::Or, names)?;
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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::ast::{DefinitionId, NamedConstant};
    use super::super::function::Function;
    use super::*;
    use crate::{Axis, Operation};

    /// An expression that is not in a [`Tree`] yet.
    #[derive(Clone, Debug)]
    enum Sketch {
        Leaf(Term),
        Prefix(Prefix, Box<Sketch>),
        Infix(Infix, Box<(Sketch, Sketch)>),
        Call(Function, Vec<Sketch>),
    }

    impl Sketch {
        fn draw(&self, tree: &mut Tree) -> TermId {
            let term = match self {
                Self::Leaf(term) => term.clone(),
                Self::Prefix(prefix, operand) => Term::Prefix(*prefix, operand.draw(tree)),
                Self::Infix(infix, operands) => {
                    Term::Infix(*infix, operands.0.draw(tree), operands.1.draw(tree))
                }
                Self::Call(function, arguments) => {
                    Term::Call(*function, arguments.iter().map(|argument| argument.draw(tree)).collect())
                }
            };
            tree.push(term)
        }
    }

    const PREFIXES: [Prefix; 2] = [Prefix::Negate, Prefix::Not];

    const INFIXES: [Infix; 13] = [
        Infix::Or,
        Infix::And,
        Infix::Less,
        Infix::LessOrEqual,
        Infix::Greater,
        Infix::GreaterOrEqual,
        Infix::Equal,
        Infix::NotEqual,
        Infix::Add,
        Infix::Subtract,
        Infix::Multiply,
        Infix::Divide,
        Infix::Power,
    ];

    /// Functions with how many arguments they are given.
    const FUNCTIONS: [(Function, usize); 6] = [
        (Function::Operation(Operation::Sin), 1),
        (Function::Operation(Operation::Select), 3),
        (Function::Fold(Operation::Minimum), 2),
        (Function::Fold(Operation::Maximum), 4),
        (Function::Prelude(DefinitionId(0)), 1),
        (Function::Defined(DefinitionId(1)), 2),
    ];

    fn drawn(sketch: &Sketch) -> Tree {
        let mut tree = Tree::default();
        sketch.draw(&mut tree);
        tree
    }

    /// Expressions in which `a` stands for definition 0 and `f` for definition 1.
    fn expressions(uses_definitions: bool) -> impl Strategy<Value = Sketch> {
        let numbers = prop_oneof![(0u8..9).prop_map(f64::from), any::<f64>().prop_map(f64::abs)];
        let numbers = numbers.prop_filter("literals are finite", |value| value.is_finite());
        let leaf = prop_oneof![
            numbers.prop_map(Term::Number),
            proptest::sample::select(&Axis::ALL[..]).prop_map(Term::Variable),
            proptest::sample::select(&NamedConstant::ALL[..]).prop_map(Term::Constant),
            Just(if uses_definitions { Term::Value(DefinitionId(0)) } else { Term::Number(0.5) }),
        ];
        let functions = &FUNCTIONS[..FUNCTIONS.len() - usize::from(!uses_definitions)];
        leaf.prop_map(Sketch::Leaf).prop_recursive(6, 48, 4, move |inner| {
            let pair = (inner.clone(), inner.clone());
            let arguments = proptest::collection::vec(inner.clone(), 4);
            prop_oneof![
                (proptest::sample::select(&PREFIXES[..]), inner)
                    .prop_map(|(prefix, it)| Sketch::Prefix(prefix, Box::new(it))),
                (proptest::sample::select(&INFIXES[..]), pair)
                    .prop_map(|(infix, it)| Sketch::Infix(infix, Box::new(it))),
                (proptest::sample::select(functions), arguments)
                    .prop_map(|((function, count), it)| Sketch::Call(function, it[..count].to_vec())),
            ]
        })
    }

    /// Two operands with one of these operators between them.
    fn joined(
        infixes: &'static [Infix],
        operands: BoxedStrategy<(Sketch, Sketch)>,
    ) -> impl Strategy<Value = Sketch> {
        (proptest::sample::select(infixes), operands)
            .prop_map(|(infix, it)| Sketch::Infix(infix, Box::new(it)))
    }

    /// Conditions that cut a surface.
    fn domains() -> impl Strategy<Value = Domain> {
        let pair = (expressions(true), expressions(true));
        let inequality = joined(&INFIXES[2..6], pair.boxed());
        let condition = inequality.prop_recursive(3, 6, 2, |inner| {
            let negated = inner.clone().prop_map(|it| Sketch::Prefix(Prefix::Not, Box::new(it)));
            prop_oneof![negated, joined(&INFIXES[..2], (inner.clone(), inner).boxed())]
        });
        condition.prop_map(|sketch| Domain::new(drawn(&sketch)).expect("it is made of inequalities"))
    }

    fn definition(name: &str, parameters: &[&str], body: Tree) -> Definition {
        let parameters = parameters.iter().map(|&name| name.to_owned()).collect();
        Definition { name: name.to_owned(), parameters, body, is_constant: false, span: 0..0 }
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

        #[test]
        fn canonical_text_parses_to_the_same_tree(
            value in expressions(false),
            body in expressions(false),
            left in expressions(true),
            right in proptest::option::of(expressions(true)),
            domain in proptest::option::of(domains()),
        ) {
            let body = with_parameters(drawn(&body));
            let definitions = vec![definition("a", &[], drawn(&value)), definition("f", &["u", "x"], body)];
            let ast = Ast { definitions, left: drawn(&left), right: right.as_ref().map(drawn), domain };
            let text = ast.to_string();
            let again = Ast::parse(&text).map_err(|error| TestCaseError::fail(format!("{text}: {error}")))?;
            prop_assert_eq!(&again, &ast, "{}", text);
        }
    }

    /// The tree with the parameter x in place of the coordinate, which it hides.
    fn with_parameters(tree: Tree) -> Tree {
        let mut copy = Tree::default();
        for term in tree.terms() {
            copy.push(match term {
                Term::Variable(Axis::X) => Term::Parameter(1),
                Term::Variable(Axis::Y) => Term::Parameter(0),
                term => term.clone(),
            });
        }
        copy
    }
}
