//! The shares of exponentials in a sum of them, by which smooth minima and maxima are differentiated.
//!
//! The derivative of ln(eᵃ + eᵇ) is a′·eᵃ/(eᵃ + eᵇ) + b′·eᵇ/(eᵃ + eᵇ). The quotients are no more than 1, in doubles too, for sums and
//! quotients are rounded monotonously. Interval arithmetic does not see that, and its quotients grow exponentially with
//! the box. Written as min(1, ·), which changes no value, they stay bounded.

use super::Chain;
use crate::{Node, NodeId, Operation};

/// Sums of more terms are differentiated like anything else.
const MOST_TERMS: usize = 64;

/// The terms of a sum.
struct Exponentials {
    terms: Vec<NodeId>,
    /// How many terms there are, constants included.
    count: usize,
}

/// The least and the greatest of some nodes.
#[derive(Default)]
struct Means {
    count: usize,
    least: Option<NodeId>,
    greatest: Option<NodeId>,
}

impl Means {
    fn include(&mut self, chain: &mut Chain<'_>, node: NodeId) {
        self.count += 1;
        let mut extreme = |operation, so_far: Option<NodeId>| {
            Some(so_far.map_or(node, |so_far| chain.apply(operation, &[so_far, node])))
        };
        self.least = extreme(Operation::Minimum, self.least);
        self.greatest = extreme(Operation::Maximum, self.greatest);
    }
}

impl Chain<'_> {
    /// derivative / sum
    pub(super) fn relative(&mut self, derivative: NodeId, sum: NodeId) -> NodeId {
        match self.exponentials(sum) {
            Some(exponentials) => self.distributed(derivative, sum, &exponentials),
            None => self.apply(Operation::Divide, &[derivative, sum]),
        }
    }

    /// exponential · derivative, where the derivative may be a quotient by a sum of which this exponential is a term
    pub(super) fn exponential_product(&mut self, exponential: NodeId, derivative: NodeId) -> Option<NodeId> {
        if let Node::Apply(Operation::Divide, [numerator, sum, _]) = self.program.node(derivative)
            && self.exponentials(sum).is_some_and(|exponentials| exponentials.terms.contains(&exponential))
        {
            let share = self.share(exponential, sum);
            return self.product(share, Some(numerator));
        }
        self.product(exponential, Some(derivative))
    }

    /// The exponentials among the terms of a sum, all of whose other terms are no less than zero.
    fn exponentials(&self, sum: NodeId) -> Option<Exponentials> {
        let (mut exponentials, mut terms) = (Vec::new(), vec![sum]);
        let mut count = 0;
        while let Some(term) = terms.pop() {
            match self.program.node(term) {
                Node::Apply(Operation::Add, [a, b, _]) => {
                    terms.extend([b, a]);
                    continue;
                }
                Node::Apply(Operation::Exp, _) => exponentials.push(term),
                Node::Constant(constant) if constant.enclosure().lo >= 0.0 => {}
                _ => return None,
            }
            count += 1;
            if count > MOST_TERMS {
                return None;
            }
        }
        (!exponentials.is_empty()).then_some(Exponentials { terms: exponentials, count })
    }

    /// A sum of multiples of the exponentials over their sum, term by term. It is a mean of what they are multiplied by, and is
    /// bounded by the least and the greatest of that.
    fn distributed(&mut self, derivative: NodeId, sum: NodeId, exponentials: &Exponentials) -> NodeId {
        let (mut total, mut terms) = (None, vec![derivative]);
        let mut means = Means::default();
        while let Some(term) = terms.pop() {
            if let Node::Apply(Operation::Add, [a, b, _]) = self.program.node(term) {
                terms.extend([b, a]);
                continue;
            }
            let Some((factor, exponential)) = self.multiple(term, &exponentials.terms) else {
                return self.apply(Operation::Divide, &[derivative, sum]);
            };
            let share = self.share(exponential, sum);
            let part = self.product(share, Some(factor));
            total = self.sum(total, part);
            means.include(self, factor);
        }
        if means.count < exponentials.count {
            let zero = self.literal(0.0);
            means.include(self, zero);
        }
        let total = total.expect("a sum has terms");
        let (Some(least), Some(greatest)) = (means.least, means.greatest) else { return total };
        let total = self.apply(Operation::Maximum, &[total, least]);
        self.apply(Operation::Minimum, &[total, greatest])
    }

    /// The exponential of which `term` is a multiple, as [`Chain::product`] writes products, and what it is multiplied by.
    fn multiple(&mut self, term: NodeId, exponentials: &[NodeId]) -> Option<(NodeId, NodeId)> {
        if exponentials.contains(&term) {
            return Some((self.literal(1.0), term));
        }
        let Node::Apply(Operation::Multiply, [a, b, _]) = self.program.node(term) else { return None };
        if exponentials.contains(&a) {
            return Some((b, a));
        }
        if exponentials.contains(&b) {
            return Some((a, b));
        }
        let Node::Apply(Operation::Multiply, [c, d, _]) = self.program.node(b) else { return None };
        exponentials.contains(&c).then(|| (self.apply(Operation::Multiply, &[a, d]), c))
    }

    /// exponential / sum
    fn share(&mut self, exponential: NodeId, sum: NodeId) -> NodeId {
        let quotient = self.apply(Operation::Divide, &[exponential, sum]);
        let one = self.literal(1.0);
        self.apply(Operation::Minimum, &[quotient, one])
    }
}
