//! Programs whose value is the greatest of several.

use super::{Node, NodeId, Program};
use crate::Operation;

impl Program {
    /// The programs of which this one's only output is the greatest value everywhere, if it is a maximum: two or more.
    pub fn greatest_of(&self) -> Option<Vec<Self>> {
        let [output] = self.outputs[..] else { return None };
        let (mut open, mut operands) = (vec![output], Vec::<NodeId>::new());
        while let Some(id) = open.pop() {
            match self.node(id) {
                Node::Apply(Operation::Maximum, [a, b, _]) => open.extend([b, a]),
                _ if operands.contains(&id) => {}
                _ => operands.push(id),
            }
        }
        let alone = |operand| {
            let mut program = self.clone();
            program.outputs = vec![operand];
            program.pruned()
        };
        (operands.len() > 1).then(|| operands.into_iter().map(alone).collect())
    }
}

#[cfg(test)]
mod tests {
    use crate::Ast;

    #[test]
    fn nested_maxima_are_one() {
        let read = |text: &str| Ast::parse(text).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
        let operands = read("max(x^2 - 1, max(y, z + 3), y)").greatest_of().unwrap();
        assert_eq!(operands.len(), 3);
        for text in ["x^2 - 1", "y", "z + 3"] {
            assert!(operands.contains(&read(text)), "{text} is not one of {operands:?}");
        }
        assert!(read("1 + max(x, y)").greatest_of().is_none());
        assert!(read("min(x, y)").greatest_of().is_none());
    }
}
