//! Programs as text, one operation a line.

use std::fmt::{self, Display, Formatter};

use super::{Argument, Axis, Node, NodeId, Program};
use crate::{Constant, Operation};

/// Lists the operations in order, `v7 = v3 * x`, then what each output is. Variables and constants stand where they are
/// used. A constant that no double equals is printed as the double that stands for it, after `≈`.
impl Display for Program {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let listing = Listing::new(self);
        for (id, node) in self.iter() {
            if let Node::Apply(operation, _) = node {
                write!(f, "{} = ", listing.operand(id))?;
                listing.write_application(f, *operation, node.operands())?;
                writeln!(f)?;
            }
        }
        for (place, output) in self.outputs.iter().enumerate() {
            match (self.outputs.len(), place) {
                (1, _) | (4, 0) => write!(f, "F")?,
                (4, _) => write!(f, "∂F/∂{}", Axis::ALL[place - 1].name())?,
                _ => write!(f, "output {}", place + 1)?,
            }
            writeln!(f, " = {}", listing.operand(*output))?;
        }
        Ok(())
    }
}

/// A program whose operations are numbered from 1.
struct Listing<'a> {
    program: &'a Program,
    /// For each node how many operations stand up to it.
    numbers: Vec<usize>,
}

impl<'a> Listing<'a> {
    fn new(program: &'a Program) -> Self {
        let count = |operations: &mut usize, node: &Node| {
            *operations += usize::from(matches!(node, Node::Apply(..)));
            Some(*operations)
        };
        Self { program, numbers: program.nodes.iter().scan(0, count).collect() }
    }

    fn operand(&self, id: NodeId) -> Operand {
        Operand { node: self.program.node(id), number: self.numbers[id.index()] }
    }

    fn write_application(
        &self,
        f: &mut Formatter<'_>,
        operation: Operation,
        operands: &[NodeId],
    ) -> fmt::Result {
        let name = operation.name();
        let is_sign = !name.starts_with(|first: char| first.is_alphabetic());
        match operands {
            [a] if operation == Operation::Negate => write!(f, "-{}", self.operand(*a)),
            [a, b] if is_sign => write!(f, "{} {name} {}", self.operand(*a), self.operand(*b)),
            _ => {
                write!(f, "{name}(")?;
                for (place, operand) in operands.iter().enumerate() {
                    let separator = if place == 0 { "" } else { ", " };
                    write!(f, "{separator}{}", self.operand(*operand))?;
                }
                write!(f, ")")
            }
        }
    }
}

impl Display for Argument {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match Axis::ALL.get(self.index()) {
            Some(axis) => write!(f, "{}", axis.name()),
            None => write!(f, "a{}", self.index()),
        }
    }
}

/// A node where another one uses it.
struct Operand {
    node: Node,
    /// Of the operation, if it is one.
    number: usize,
}

impl Display for Operand {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.node {
            Node::Variable(argument) => write!(f, "{argument}"),
            Node::Constant(constant) => write_constant(f, constant),
            Node::Apply(..) => write!(f, "v{}", self.number),
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
