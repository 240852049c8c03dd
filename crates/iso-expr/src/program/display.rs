//! Programs as text, one operation a line.

use std::fmt::{self, Display, Formatter};

use super::{Node, NodeId, Program};
use crate::{Constant, Operation};

/// Lists the operations in order, `v7 = v3 * x`, then what each output is. Variables and constants stand where they are
/// used. A constant that no double equals is printed as the double that stands for it, after `≈`.
impl Display for Program {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for (id, node) in self.iter() {
            if let Node::Apply(operation, _) = node {
                write!(f, "v{} = ", id.index())?;
                self.write_application(f, *operation, node.operands())?;
                writeln!(f)?;
            }
        }
        for (place, output) in self.outputs.iter().enumerate() {
            match (self.outputs.len(), place) {
                (1, _) | (4, 0) => write!(f, "F")?,
                (4, _) => write!(f, "∂F/∂{}", super::Axis::ALL[place - 1].name())?,
                _ => write!(f, "output {}", place + 1)?,
            }
            writeln!(f, " = {}", Operand(self, *output))?;
        }
        Ok(())
    }
}

impl Program {
    fn write_application(
        &self,
        f: &mut Formatter<'_>,
        operation: Operation,
        operands: &[NodeId],
    ) -> fmt::Result {
        let name = operation.name();
        let is_sign = !name.starts_with(|first: char| first.is_alphabetic());
        match operands {
            [a] if operation == Operation::Negate => write!(f, "-{}", Operand(self, *a)),
            [a, b] if is_sign => write!(f, "{} {name} {}", Operand(self, *a), Operand(self, *b)),
            _ => {
                write!(f, "{name}(")?;
                for (place, operand) in operands.iter().enumerate() {
                    let separator = if place == 0 { "" } else { ", " };
                    write!(f, "{separator}{}", Operand(self, *operand))?;
                }
                write!(f, ")")
            }
        }
    }
}

/// A node where another one uses it.
struct Operand<'a>(&'a Program, NodeId);

impl Display for Operand<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0.node(self.1) {
            Node::Variable(axis) => write!(f, "{}", axis.name()),
            Node::Constant(constant) => write_constant(f, constant),
            Node::Apply(..) => write!(f, "v{}", self.1.index()),
        }
    }
}

fn write_constant(f: &mut Formatter<'_>, constant: Constant) -> fmt::Result {
    let named = [("pi", Constant::PI), ("tau", Constant::TAU), ("e", Constant::E)];
    if let Some((name, _)) = named.iter().find(|(_, named)| *named == constant) {
        return write!(f, "{name}");
    }
    if !constant.is_exact() {
        write!(f, "≈")?;
    }
    let value = constant.value();
    let has_common_size = value == 0.0 || !value.is_finite() || (1e-5..1e17).contains(&value.abs());
    if has_common_size { write!(f, "{value}") } else { write!(f, "{value:e}") }
}
