//! Programs whose value is always that of one of several others.

use super::{Node, NodeId, Program};
use crate::Operation;

/// Which of several values one is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extreme {
    /// The least, as at the surface of a union.
    Least,
    /// The greatest, as at the surface of an intersection.
    Greatest,
}

/// How a continuous function is made of others that have fewer kinks.
#[derive(Clone, Debug, PartialEq)]
pub enum Composition<F> {
    /// The least or the greatest of two or more.
    Extreme(Extreme, Vec<F>),
    /// One function where a third one is negative, and another where that is positive. Where that is zero, both are the same.
    Choice {
        /// The function that decides.
        by: F,
        /// What is taken where it is negative.
        below: F,
        /// What is taken where it is positive.
        above: F,
    },
    /// One function where another one is not negative, and nothing elsewhere.
    Within {
        /// What is taken.
        function: F,
        /// What is negative wherever nothing is.
        margin: F,
    },
}

impl<F> Composition<F> {
    /// The functions.
    pub fn functions(&self) -> impl Iterator<Item = &F> {
        let (all, some): (&[F], [Option<&F>; 3]) = match self {
            Self::Extreme(_, all) => (all, [None; 3]),
            Self::Choice { by, below, above } => (&[], [Some(by), Some(below), Some(above)]),
            Self::Within { function, margin } => (&[], [Some(function), Some(margin), None]),
        };
        all.iter().chain(some.into_iter().flatten())
    }

    /// The same of what `make` makes of the functions.
    pub fn of_each<G>(&self, mut make: impl FnMut(&F) -> G) -> Composition<G> {
        match self {
            Self::Extreme(extreme, all) => Composition::Extreme(*extreme, all.iter().map(make).collect()),
            Self::Choice { by, below, above } => {
                Composition::Choice { by: make(by), below: make(below), above: make(above) }
            }
            Self::Within { function, margin } => {
                Composition::Within { function: make(function), margin: make(margin) }
            }
        }
    }
}

impl Program {
    /// How this program's only output is made of others: as a minimum or a maximum, or the negative of one, or else as what is left where 0·√m is
    /// taken from it, or by the minimum, the maximum or the absolute value inside it that is computed first, unless it has more operations than
    /// `longest_choice`. `None` where there is none.
    pub fn composition(&self, longest_choice: usize) -> Option<Composition<Self>> {
        let [output] = self.outputs[..] else { return None };
        let choice = || if self.operations() <= longest_choice { self.choice() } else { None };
        self.extreme_of(output).or_else(|| self.within()).or_else(choice)
    }

    /// The program of one of its values.
    fn of_value(&self, id: NodeId) -> Self {
        self.pruned_to(&[id])
    }

    /// The least or the greatest of two or more. The negative of a minimum is the maximum of the negatives.
    fn extreme_of(&self, output: NodeId) -> Option<Composition<Self>> {
        let whole = self.as_is(output);
        let (extreme, _) = self.as_extreme(whole)?;
        let (mut open, mut operands) = (vec![whole], Vec::new());
        while let Some(signed) = open.pop() {
            match self.as_extreme(signed) {
                Some((found, [a, b])) if found == extreme => open.extend([b, a]),
                _ if operands.contains(&signed) => {}
                _ => operands.push(signed),
            }
        }
        let alone = |Signed { id, is_negative }| {
            let mut program = self.of_value(id);
            if is_negative {
                program.outputs = vec![program.apply(Operation::Negate, &[program.outputs[0]])];
            }
            program
        };
        (operands.len() > 1).then(|| Composition::Extreme(extreme, operands.into_iter().map(alone).collect()))
    }

    /// Whether its only output is that of another program [within](Composition::Within) a margin, as where a formula is cut by `where`.
    pub fn is_cut(&self) -> bool {
        matches!(self.outputs[..], [output] if self.as_extreme(self.as_is(output)).is_none())
            && self.cuts().next().is_some()
    }

    /// Where it is cut. What chooses may leave that out, and be a number elsewhere.
    fn cuts(&self) -> impl Iterator<Item = Cut> {
        let chooses = |node: &Node| matches!(node, Node::Apply(Operation::Select, _));
        let is_whole = !self.nodes.iter().any(chooses);
        self.iter().filter(move |_| is_whole).filter_map(|(sum, node)| {
            let Node::Apply(Operation::Add, [a, b, _]) = *node else { return None };
            let [of_a, of_b] = [a, b].map(|id| self.margin_of(id));
            Some(Cut { sum, place: usize::from(of_a.is_some()), margin: of_a.or(of_b)? })
        })
    }

    /// The m of 0·√m.
    pub(crate) fn margin_of(&self, id: NodeId) -> Option<NodeId> {
        let Node::Apply(Operation::Multiply, [a, b, _]) = self.node(id) else { return None };
        match (self.node(a), self.node(b)) {
            (Node::Constant(factor), Node::Apply(Operation::SquareRoot, [margin, ..]))
            | (Node::Apply(Operation::SquareRoot, [margin, ..]), Node::Constant(factor)) => {
                (factor.is_exact() && factor.value() == 0.0).then_some(margin)
            }
            _ => None,
        }
    }

    /// What is left where all of its cuts are numbers.
    fn within(&self) -> Option<Composition<Self>> {
        let cuts: Vec<Cut> = self.cuts().collect();
        let mut margins: Vec<NodeId> = cuts.iter().map(|cut| cut.margin).collect();
        margins.sort_unstable();
        margins.dedup();
        let mut margin = self.pruned_to(&margins);
        let least = margin.outputs.clone().into_iter();
        let least = least.reduce(|a, b| margin.apply(Operation::Minimum, &[a, b]))?;
        margin.set_outputs(vec![least]);
        let function = self.simplified_with(|_, id, operands| {
            let cut = cuts.binary_search_by_key(&id, |cut| cut.sum).ok()?;
            Some(operands[cuts[cut].place])
        });
        Some(Composition::Within { function, margin })
    }

    /// What `make` makes of it, where it is cut of what is left within.
    pub(super) fn with_what_is_cut(&self, make: impl Fn(&Self) -> Self) -> Self {
        match self.within() {
            Some(Composition::Within { function, margin }) => match make(&function) {
                made if made == function => self.clone(),
                made => made.cut_to(&margin),
            },
            _ => make(self),
        }
    }

    /// The same where `margin` is not negative, and nothing elsewhere.
    fn cut_to(mut self, margin: &Self) -> Self {
        let margin = self.import_with(margin, |program, node| program.intern(node))[0];
        let root = self.apply(Operation::SquareRoot, &[margin]);
        let zero = self.literal(0.0);
        let nothing = self.apply(Operation::Multiply, &[zero, root]);
        let output = self.apply(Operation::Add, &[self.outputs[0], nothing]);
        self.set_outputs(vec![output]);
        self
    }

    /// What it comes to by the sign of what decides its first kink.
    fn choice(&self) -> Option<Composition<Self>> {
        use Operation::{Absolute, Maximum, Minimum};
        let has_kink =
            |(_, node): &(NodeId, &Node)| matches!(node, Node::Apply(Minimum | Maximum | Absolute, _));
        let (kink, &Node::Apply(operation, _)) = self.iter().find(has_kink)? else { return None };
        let of_kink = self.of_value(kink);
        let by = of_kink.simplified_with(|simplifier, id, [a, b]| {
            (id == of_kink.outputs[0]).then(|| match operation {
                Absolute => a,
                _ => simplifier.apply(Operation::Subtract, &[a, b]),
            })
        });
        let [below, above] = [true, false].map(|is_below| {
            self.simplified_with(|simplifier, id, [a, b]| {
                (id == kink).then(|| match operation {
                    Absolute if is_below => simplifier.apply(Operation::Negate, &[a]),
                    Maximum if is_below => b,
                    Minimum if !is_below => b,
                    _ => a,
                })
            })
        });
        Some(Composition::Choice { by, below, above })
    }

    /// What a value is the least or the greatest of, if it is.
    fn as_extreme(&self, Signed { id, is_negative }: Signed) -> Option<(Extreme, [Signed; 2])> {
        let (is_least, a, b) = match self.node(id) {
            Node::Apply(Operation::Minimum, [a, b, _]) => (true, a, b),
            Node::Apply(Operation::Maximum, [a, b, _]) => (false, a, b),
            _ => return None,
        };
        let extreme = if is_least != is_negative { Extreme::Least } else { Extreme::Greatest };
        Some((extreme, [a, b].map(|id| self.without_negations(Signed { id, is_negative }))))
    }

    fn as_is(&self, id: NodeId) -> Signed {
        self.without_negations(Signed { id, is_negative: false })
    }

    /// The same value as the positive or the negative of one that is no negative itself.
    fn without_negations(&self, Signed { mut id, mut is_negative }: Signed) -> Signed {
        while let Node::Apply(Operation::Negate, [operand, ..]) = self.node(id) {
            (id, is_negative) = (operand, !is_negative);
        }
        Signed { id, is_negative }
    }
}

/// Where 0·√m is added to a value, which is so cut to where m is not negative.
struct Cut {
    sum: NodeId,
    /// Which operand of the sum is that value.
    place: usize,
    margin: NodeId,
}

/// A value, or its negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Signed {
    id: NodeId,
    is_negative: bool,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Ast;

    fn extreme_in(text: &str) -> (Extreme, Vec<Program>) {
        let Some(Composition::Extreme(extreme, operands)) = read(text).composition(usize::MAX) else {
            panic!("neither a minimum nor a maximum")
        };
        (extreme, operands)
    }

    fn read(text: &str) -> Program {
        Ast::parse(text).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified()
    }

    #[test]
    fn nested_maxima_are_one_and_so_are_nested_minima() {
        for (name, expected) in [("max", Extreme::Greatest), ("min", Extreme::Least)] {
            let text = format!("{name}(x^2 - 1, {name}(y, z + 3), y)");
            let (extreme, operands) = extreme_in(&text);
            assert_eq!((extreme, operands.len()), (expected, 3));
            for text in ["x^2 - 1", "y", "z + 3"] {
                assert!(operands.contains(&read(text)), "{text} is not one of {operands:?}");
            }
        }
    }

    #[test]
    fn the_negative_of_a_minimum_is_a_maximum_of_negatives() {
        let (extreme, operands) = extreme_in("-min(x, -max(y, -(z + 3)))");
        assert_eq!((extreme, operands.len()), (Extreme::Greatest, 3));
        for text in ["-x", "y", "-(z + 3)"] {
            assert!(operands.contains(&read(text)), "{text} is not one of {operands:?}");
        }
        // Beside each other, both signs are two values, and twice the same one is one.
        let (extreme, operands) = extreme_in("max(x, -(-y), y, -x)");
        assert_eq!((extreme, operands.len()), (Extreme::Greatest, 3));
        let (extreme, operands) = extreme_in("-max(x, min(y, z))");
        assert_eq!((extreme, operands.len()), (Extreme::Least, 2));
        assert!(operands.contains(&read("-min(y, z)")));
    }

    #[test]
    fn others_stay_whole() {
        assert!(read("1 + x").composition(usize::MAX).is_none());
        assert!(read("1 + max(x, y)").composition(1).is_none());
        let (extreme, operands) = extreme_in("min(x, max(y, z))");
        assert_eq!((extreme, operands.len()), (Extreme::Least, 2));
        assert!(operands.contains(&read("max(y, z)")));
    }

    #[test]
    fn what_is_cut_is_whole_within_its_margin() {
        for (text, expected) in [
            ("x^2 + y where z < 2", ["x^2 + y", "2 - z"]),
            ("3(x + 0sqrt(y)) + z", ["3x + z", "y"]),
            ("exp(x + 0sqrt(y)) * (0sqrt(1 - y) + z)", ["exp(x) * z", "min(y, 1 - y)"]),
            ("max(x, y) where x > z and z > 0", ["max(x, y)", "min(x - z, z)"]),
        ] {
            let [function, margin] = expected.map(read);
            let found = read(text).composition(usize::MAX);
            assert_eq!(found, Some(Composition::Within { function, margin }), "{text}");
            assert!(read(text).is_cut());
        }
        // Where the first is chosen, the root does not count.
        let chosen = read("if(x > 0, x, y + 0sqrt(z))").composition(usize::MAX);
        assert!(!matches!(chosen, Some(Composition::Within { .. })));
        assert!(!read("max(y + 0sqrt(z), x)").is_cut() && !read("y + 2sqrt(z)").is_cut());
    }

    /// Those computed first, which have no kinks of their own.
    #[test]
    fn kinks_inside_are_choices() {
        for (text, expected) in [
            ("1 + max(x, y)", ["x - y", "1 + y", "1 + x"]),
            ("1 + min(x, y)", ["x - y", "1 + x", "1 + y"]),
            ("1 + abs(x)", ["x", "1 + -x", "1 + x"]),
            ("(x - min(max(y, 0), 1))^2", ["y", "x^2", "(x - min(y, 1))^2"]),
        ] {
            let [by, below, above] = expected.map(read);
            assert_eq!(read(text).composition(4), Some(Composition::Choice { by, below, above }), "{text}");
        }
    }
}
