//! The shares of exponentials in a sum of them, by which smooth minima and maxima are differentiated.
//!
//! The derivative of ln(eᵃ + eᵇ) is a′·eᵃ/(eᵃ + eᵇ) + b′·eᵇ/(eᵃ + eᵇ). Interval arithmetic does not see that both exponentials of a
//! quotient are one, and its quotients grow exponentially with the box. 1/(1 + eᵇ⁻ᵃ) is the same, takes a and b once each, and is all but
//! certain where one of them is far below the other. It takes an exponential for each pair of terms, and so of many terms
//! the quotient remains, written as min(1, ·): that changes no value, for sums and quotients are rounded monotonously, and is bounded.

use super::Chain;
use crate::{Node, NodeId, Operation, Program};

/// Sums of more terms, and sums of more multiples of them, are differentiated like anything else.
const MOST_TERMS: usize = 64;

/// Of more terms shares are quotients.
const MOST_PAIRED: usize = 4;

/// The terms of a sum.
struct Exponentials {
    /// All but the constants.
    terms: Vec<NodeId>,
    constants: Vec<NodeId>,
}

impl Exponentials {
    fn count(&self) -> usize {
        self.terms.len() + self.constants.len()
    }

    fn are_paired(&self) -> bool {
        self.count() <= MOST_PAIRED
    }
}

/// own·s + other·(1 − s), as the derivative of the logarithm of two exponentials is written: s is the share of one of them.
pub(crate) struct MeanByShares {
    pub(crate) share: NodeId,
    /// What is multiplied by the share, factor by factor.
    pub(crate) own: Vec<NodeId>,
    /// What is multiplied by the other's share.
    pub(crate) other: Vec<NodeId>,
}

/// A multiple of 1/(1 + eᵇ⁻ᵃ).
struct MultipleOfShare {
    share: NodeId,
    /// The exponents b and a.
    exponents: (NodeId, NodeId),
    factors: Vec<NodeId>,
}

impl Program {
    /// Whether a sum of two terms is a mean by the shares of two exponentials.
    pub(crate) fn mean_by_shares(&self, a: NodeId, b: NodeId) -> Option<MeanByShares> {
        let [own, other] = [self.multiple_of_share(a)?, self.multiple_of_share(b)?];
        let (least, most) = own.exponents;
        let make_whole = other.exponents == (most, least);
        make_whole.then_some(MeanByShares { share: own.share, own: own.factors, other: other.factors })
    }

    /// A share times a factor, as [`Chain::product`] writes products; simplifying puts constants in front.
    fn multiple_of_share(&self, term: NodeId) -> Option<MultipleOfShare> {
        let (mut factors, mut rest) = (Vec::new(), term);
        loop {
            if let Some(exponents) = self.exponents_of_share(rest) {
                return Some(MultipleOfShare { share: rest, exponents, factors });
            }
            let Node::Apply(Operation::Multiply, [a, b, _]) = self.node(rest) else { return None };
            let is_first = self.exponents_of_share(a).is_some();
            let (next, factor) = if is_first { (a, b) } else { (b, a) };
            factors.push(factor);
            rest = next;
        }
    }

    /// The exponents b and a of a share 1/(1 + eᵇ⁻ᵃ).
    fn exponents_of_share(&self, quotient: NodeId) -> Option<(NodeId, NodeId)> {
        let Node::Apply(Operation::Divide, [one, whole, _]) = self.node(quotient) else { return None };
        let Node::Apply(Operation::Add, [own, other, _]) = self.node(whole) else { return None };
        let Node::Apply(Operation::Exp, [difference, ..]) = self.node(other) else { return None };
        let Node::Apply(Operation::Subtract, [b, a, _]) = self.node(difference) else { return None };
        [one, own].into_iter().all(|id| self.node(id) == Node::ONE).then_some((b, a))
    }

    /// Whether a node is a sum of exponentials and positive constants, and not of too many.
    pub(crate) fn is_sum_of_exponentials(&self, sum: NodeId) -> bool {
        self.exponentials(sum).is_some()
    }

    /// Whether it is, and of so many terms that quotients stand for their shares.
    pub(crate) fn has_quotients_for_shares(&self, sum: NodeId) -> bool {
        self.exponentials(sum).is_some_and(|exponentials| !exponentials.are_paired())
    }

    /// Whether a node is [such a sum](Self::is_sum_of_exponentials), and `part` is the sum of all or of some of its terms.
    pub(crate) fn is_part_of_exponentials(&self, part: NodeId, sum: NodeId) -> bool {
        let mut ahead = vec![sum];
        let mut parts = std::iter::from_fn(|| {
            let part = ahead.pop()?;
            if let Node::Apply(Operation::Add, [a, b, _]) = self.node(part) {
                ahead.extend([a, b]);
            }
            Some(part)
        });
        self.is_sum_of_exponentials(sum) && parts.any(|other| other == part)
    }

    /// The exponentials among the terms of a sum, all of whose other terms are positive.
    fn exponentials(&self, sum: NodeId) -> Option<Exponentials> {
        let mut found = Exponentials { terms: Vec::new(), constants: Vec::new() };
        let mut parts = vec![sum];
        while let Some(part) = parts.pop() {
            match self.node(part) {
                Node::Apply(Operation::Add, [a, b, _]) => parts.extend([b, a]),
                Node::Apply(Operation::Exp, _) => found.terms.push(part),
                Node::Constant(constant) if constant.enclosure().lo > 0.0 => found.constants.push(part),
                _ => return None,
            }
            if found.count() > MOST_TERMS {
                return None;
            }
        }
        (!found.terms.is_empty()).then_some(found)
    }
}

impl Chain<'_> {
    /// derivative / sum
    pub(super) fn relative(&mut self, derivative: NodeId, sum: NodeId) -> NodeId {
        match self.program.exponentials(sum) {
            Some(exponentials) => self.distributed(derivative, sum, &exponentials),
            None => self.apply(Operation::Divide, &[derivative, sum]),
        }
    }

    /// exponential · derivative, where the derivative may be a quotient by a sum of which this exponential is a term
    pub(super) fn exponential_product(&mut self, exponential: NodeId, derivative: NodeId) -> Option<NodeId> {
        if let Node::Apply(Operation::Divide, [numerator, sum, _]) = self.program.node(derivative)
            && let Some(exponentials) = self.program.exponentials(sum)
            && exponentials.terms.contains(&exponential)
        {
            let share = self.share(exponential, sum, &exponentials);
            return self.product(share, Some(numerator));
        }
        self.product(exponential, Some(derivative))
    }

    /// A sum of multiples of the exponentials over their sum, exponential by exponential. It is a mean of what they are multiplied by. If
    /// quotients by the sum do not tell, it is bounded by the least and the greatest of that.
    fn distributed(&mut self, derivative: NodeId, sum: NodeId, exponentials: &Exponentials) -> NodeId {
        let Some(factors) = self.factors(derivative, &exponentials.terms) else {
            return self.apply(Operation::Divide, &[derivative, sum]);
        };
        let mut total = None;
        for &(exponential, factor) in &factors {
            let share = self.share(exponential, sum, exponentials);
            let part = self.product(share, Some(factor));
            total = self.sum(total, part);
        }
        let total = total.expect("a sum has terms");
        if exponentials.are_paired() {
            return total;
        }
        let is_whole = factors.len() == exponentials.count();
        let mut factors: Vec<_> = factors.into_iter().map(|(_, factor)| factor).collect();
        if !is_whole {
            factors.push(self.literal(0.0));
        }
        let mut extreme = |operation| {
            let factors = factors.iter().copied();
            factors
                .reduce(|so_far, factor| self.apply(operation, &[so_far, factor]))
                .expect("a sum has terms")
        };
        let (least, greatest) = (extreme(Operation::Minimum), extreme(Operation::Maximum));
        let total = self.apply(Operation::Maximum, &[total, least]);
        self.apply(Operation::Minimum, &[total, greatest])
    }

    /// Each of the exponentials with what it is multiplied by in a derivative, if that is a sum of such products and not of too many:
    /// a sum that is shared within itself would have far more terms than nodes.
    fn factors(&mut self, derivative: NodeId, exponentials: &[NodeId]) -> Option<Vec<(NodeId, NodeId)>> {
        let mut factors: Vec<(NodeId, NodeId)> = Vec::new();
        let (mut ahead, mut count) = (vec![derivative], 0);
        while let Some(term) = ahead.pop() {
            if let Node::Apply(Operation::Add, [a, b, _]) = self.program.node(term) {
                ahead.extend([b, a]);
                continue;
            }
            count += 1;
            if count > MOST_TERMS {
                return None;
            }
            let (factor, exponential) = self.multiple(term, exponentials)?;
            match factors.iter_mut().find(|(other, _)| *other == exponential) {
                Some((_, sum)) => *sum = self.apply(Operation::Add, &[*sum, factor]),
                None => factors.push((exponential, factor)),
            }
        }
        Some(factors)
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
    fn share(&mut self, exponential: NodeId, sum: NodeId, exponentials: &Exponentials) -> NodeId {
        let one = self.literal(1.0);
        if !exponentials.are_paired() {
            let quotient = self.apply(Operation::Divide, &[exponential, sum]);
            return self.apply(Operation::Minimum, &[quotient, one]);
        }
        let own = self.program.node(exponential).operands()[0];
        let mut others = exponentials.terms.clone();
        let place = others.iter().position(|term| *term == exponential).expect("it is one of the terms");
        others.remove(place);
        let exponents = others.into_iter().map(|term| self.program.node(term).operands()[0]);
        let mut exponents: Vec<_> = exponents.collect();
        exponents.extend(exponentials.constants.iter().map(|term| self.apply(Operation::Ln, &[*term])));
        let ratios = exponents.into_iter().map(|exponent| {
            let difference = self.apply(Operation::Subtract, &[exponent, own]);
            self.apply(Operation::Exp, &[difference])
        });
        let ratios: Vec<_> = ratios.collect();
        let others = ratios.into_iter().reduce(|sum, ratio| self.apply(Operation::Add, &[sum, ratio]));
        let Some(others) = others else { return one };
        let whole = self.apply(Operation::Add, &[one, others]);
        self.apply(Operation::Divide, &[one, whole])
    }
}
