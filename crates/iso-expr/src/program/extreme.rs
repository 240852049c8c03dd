//! Programs whose value is the least or the greatest of several.

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

impl Program {
    /// The programs of which this one's only output is the least or the greatest value everywhere, if it is a minimum or a maximum, or the
    /// negative of one: two or more. The negative of a minimum is the maximum of the negatives.
    pub fn extreme_of(&self) -> Option<(Extreme, Vec<Self>)> {
        let [output] = self.outputs[..] else { return None };
        let whole = self.without_negations(Signed { id: output, is_negative: false });
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
            let mut program = self.clone();
            let output = if is_negative { program.apply(Operation::Negate, &[id]) } else { id };
            program.outputs = vec![output];
            program.pruned()
        };
        (operands.len() > 1).then(|| (extreme, operands.into_iter().map(alone).collect()))
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

    /// The same value as the positive or the negative of one that is no negative itself.
    fn without_negations(&self, Signed { mut id, mut is_negative }: Signed) -> Signed {
        while let Node::Apply(Operation::Negate, [operand, ..]) = self.node(id) {
            (id, is_negative) = (operand, !is_negative);
        }
        Signed { id, is_negative }
    }
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

    fn read(text: &str) -> Program {
        Ast::parse(text).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified()
    }

    #[test]
    fn nested_maxima_are_one_and_so_are_nested_minima() {
        for (name, expected) in [("max", Extreme::Greatest), ("min", Extreme::Least)] {
            let text = format!("{name}(x^2 - 1, {name}(y, z + 3), y)");
            let (extreme, operands) = read(&text).extreme_of().unwrap();
            assert_eq!((extreme, operands.len()), (expected, 3));
            for text in ["x^2 - 1", "y", "z + 3"] {
                assert!(operands.contains(&read(text)), "{text} is not one of {operands:?}");
            }
        }
    }

    #[test]
    fn the_negative_of_a_minimum_is_a_maximum_of_negatives() {
        let (extreme, operands) = read("-min(x, -max(y, -(z + 3)))").extreme_of().unwrap();
        assert_eq!((extreme, operands.len()), (Extreme::Greatest, 3));
        for text in ["-x", "y", "-(z + 3)"] {
            assert!(operands.contains(&read(text)), "{text} is not one of {operands:?}");
        }
        // Beside each other, both signs are two values, and twice the same one is one.
        let (extreme, operands) = read("max(x, -(-y), y, -x)").extreme_of().unwrap();
        assert_eq!((extreme, operands.len()), (Extreme::Greatest, 3));
        let (extreme, operands) = read("-max(x, min(y, z))").extreme_of().unwrap();
        assert_eq!((extreme, operands.len()), (Extreme::Least, 2));
        assert!(operands.contains(&read("-min(y, z)")));
    }

    #[test]
    fn others_stay_whole() {
        assert!(read("1 + max(x, y)").extreme_of().is_none());
        let (extreme, operands) = read("min(x, max(y, z))").extreme_of().unwrap();
        assert_eq!((extreme, operands.len()), (Extreme::Least, 2));
        assert!(operands.contains(&read("max(y, z)")));
    }
}
