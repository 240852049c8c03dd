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
    /// The programs of which this one's only output is the least or the greatest value everywhere, if it is a minimum or a maximum:
    /// two or more.
    pub fn extreme_of(&self) -> Option<(Extreme, Vec<Self>)> {
        let [output] = self.outputs[..] else { return None };
        let (extreme, wanted) = match self.node(output) {
            Node::Apply(Operation::Minimum, _) => (Extreme::Least, Operation::Minimum),
            Node::Apply(Operation::Maximum, _) => (Extreme::Greatest, Operation::Maximum),
            _ => return None,
        };
        let (mut open, mut operands) = (vec![output], Vec::<NodeId>::new());
        while let Some(id) = open.pop() {
            match self.node(id) {
                Node::Apply(operation, [a, b, _]) if operation == wanted => open.extend([b, a]),
                _ if operands.contains(&id) => {}
                _ => operands.push(id),
            }
        }
        let alone = |operand| {
            let mut program = self.clone();
            program.outputs = vec![operand];
            program.pruned()
        };
        (operands.len() > 1).then(|| (extreme, operands.into_iter().map(alone).collect()))
    }
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
    fn others_stay_whole() {
        assert!(read("1 + max(x, y)").extreme_of().is_none());
        let (extreme, operands) = read("min(x, max(y, z))").extreme_of().unwrap();
        assert_eq!((extreme, operands.len()), (Extreme::Least, 2));
        assert!(operands.contains(&read("max(y, z)")));
    }
}
