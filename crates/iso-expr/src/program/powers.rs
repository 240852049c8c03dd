//! Integer powers, written out as products.

use super::{Node, NodeId, Program};
use crate::Operation;
use crate::operation::by_squaring;

impl Program {
    /// A copy in which every integer power is written out as products, in the order that defines its value: squares of the
    /// base from the exponent's lowest bit up. Powers of one base share their squares.
    ///
    /// Values stay the same to the last bit. Kernels over points are made from this form; kernels over boxes are not, for
    /// an interval's square is narrower than its product with itself.
    pub fn with_powers_expanded(&self) -> Self {
        let mut program = Self::new();
        program.outputs = program.import_with(self, |program, node| match node {
            Node::Apply(Operation::IntegerPower, [base, exponent, _]) => program.products(base, exponent),
            node => program.intern(node),
        });
        program.pruned()
    }

    fn products(&mut self, base: NodeId, exponent: NodeId) -> NodeId {
        let exponent = self.exponent(exponent).expect("programs check the exponents of integer powers");
        let product =
            by_squaring(base, exponent, |a, b| self.apply(Operation::Multiply, &[a, b.unwrap_or(a)]));
        product.expect("exponents are positive")
    }
}
