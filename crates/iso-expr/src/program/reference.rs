//! The definition of a program's value, for tests to hold engines and passes to.

use super::{Node, Program};

impl Program {
    /// The outputs for these arguments, by the table alone.
    pub fn evaluate(&self, arguments: impl AsRef<[f64]>) -> Vec<f64> {
        let values = self.evaluate_nodes(arguments);
        self.outputs.iter().map(|output| values[output.index()]).collect()
    }

    /// Every node for these arguments, in turn by the table's value.
    pub fn evaluate_nodes(&self, arguments: impl AsRef<[f64]>) -> Vec<f64> {
        let mut values: Vec<f64> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            values.push(match node {
                Node::Variable(argument) => arguments.as_ref()[argument.index()],
                Node::Constant(constant) => constant.value(),
                Node::Apply(operation, operands) => {
                    operation.value().of(operands.map(|operand| values[operand.index()]))
                }
            });
        }
        values
    }
}

/// Panics unless both are NaN or have the same bits.
#[cfg(test)]
#[track_caller]
pub(crate) fn assert_same(given: f64, expected: f64, context: impl Fn() -> String) {
    let same = given.to_bits() == expected.to_bits() || (given.is_nan() && expected.is_nan());
    assert!(same, "{given:?} instead of {expected:?}\n{}", context());
}
