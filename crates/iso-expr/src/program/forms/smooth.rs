//! Forms of smooth maxima, ln(eˣ + eʸ), and of the shares that exponentials have in a sum of them.
//!
//! Taken apart they would be off by exponentials of deviations. As functions of the exponents they are tame: a smooth maximum is
//! convex, its slopes are shares, which lie between 0 and 1, and all that bends it is that one share gives way to the other.

use super::{Builder, Form, NodeId, Operation};
use crate::operation::MeanByShares;
use crate::{Constant, Node, Program};

/// No curvature of ln(1 + eˣ) exceeds it.
const STEEPEST_OF_MAXIMA: f64 = 0.25;

/// No curvature of 1/(1 + e⁻ˣ) exceeds it: the largest is 1/(6·√3).
const STEEPEST_OF_SHARES: f64 = 0.09623;

/// By so much more than 1 bounds that take exponentials are multiplied: the exponents are differences, rounded, and no larger than
/// 746 where that matters.
const MARGIN: f64 = 1.0 + 1.0 / (1u64 << 32) as f64;

/// A share that deviates more is bounded by its range, not by its slope.
const FAR: f64 = 2.0;

/// The share of eˣ in eˣ + 1, at a number x.
struct Share {
    value: NodeId,
    /// What is left, the share of 1.
    complement: NodeId,
    /// Its derivative, which is the product of both. At a distance d it is no more than eᵈ times as large.
    slope: NodeId,
    /// ln(1 + e⁻ˡˣˡ): how far the smooth maximum of x and 0 is above the greater one.
    softness: NodeId,
}

impl Builder {
    /// The logarithm of a [sum of exponentials](Program::is_sum_of_exponentials); `None` of another sum. `forms` are those of the nodes
    /// of `source`.
    pub(super) fn logarithm_of_sum(&mut self, source: &Program, sum: NodeId, forms: &[Form]) -> Option<Form> {
        source.is_sum_of_exponentials(sum).then(|| self.logarithm_of_terms(source, sum, forms))?
    }

    fn logarithm_of_terms(&mut self, source: &Program, sum: NodeId, forms: &[Form]) -> Option<Form> {
        match source.node(sum) {
            Node::Apply(Operation::Exp, [exponent, ..]) => Some(forms[exponent.index()]),
            Node::Apply(Operation::Add, [a, b, _]) => {
                let a = self.logarithm_of_terms(source, a, forms)?;
                let b = self.logarithm_of_terms(source, b, forms)?;
                Some(self.smooth_maximum(a, b))
            }
            Node::Constant(constant) if constant.is_exact() && constant.value() > 0.0 => {
                let value = self.0.literal(constant.value());
                let logarithm = self.0.apply(Operation::Ln, &[value]);
                Some(self.known(logarithm))
            }
            _ => None,
        }
    }

    /// The reciprocal of 1 and a sum of exponentials; `None` of another sum.
    pub(super) fn share_in_sum(&mut self, source: &Program, sum: NodeId, forms: &[Form]) -> Option<Form> {
        let Node::Apply(Operation::Add, [a, b, _]) = source.node(sum) else { return None };
        let is_one = |id| source.node(id) == Node::ONE;
        let others = if is_one(a) { b } else { a };
        if !is_one(a) && !is_one(b) {
            return None;
        }
        let exponent = self.logarithm_of_sum(source, others, forms)?;
        let exponent = self.negative(exponent);
        Some(self.share(exponent))
    }

    /// s·x + (1 − s)·y = w·x + (1 − w)·y + (s − w)·(x − y) for the share s with the middle w. As a sum of products it would not be known that both
    /// shares make a whole.
    pub(super) fn mean(&mut self, mean: &MeanByShares, forms: &[Form]) -> Form {
        let share = forms[mean.share.index()];
        let [x, y] = [&mean.own, &mean.other].map(|factors| {
            let forms = factors.iter().map(|factor| forms[factor.index()]);
            let product = forms.reduce(|product, factor| self.product(factor, product));
            product.unwrap_or_else(|| self.constant(Constant::ONE))
        });
        let one = self.0.literal(1.0);
        let rest_of_whole = self.of(Operation::Subtract, one, share.middle);
        let mixed = self.mixture((share.middle, rest_of_whole), x, y);
        let difference = self.difference(x, y);
        let magnitude = self.magnitude_of(difference.middle);
        let slopes = [0, 1, 2].map(|place| {
            let shift = share.slopes[place].map(|slope| self.times(difference.middle, slope));
            self.0.sum(mixed.slopes[place], shift)
        });
        let of_share = share.rest.map(|rest| self.times(magnitude, rest));
        let of_both = self.product_of_deviations(share, difference);
        let rest = self.0.sum(mixed.rest, of_share);
        let rest = self.0.sum(rest, of_both);
        // A share deviates by less than 1, so that this is no less than each of the parts.
        Form { slopes, rest: self.rounded(rest, mixed.size), ..mixed }
    }

    /// ln(eˣ + eʸ). It exceeds its tangent plane by no more than half the greatest curvature times the square of the deviation of
    /// x − y, nor by more than that deviation.
    fn smooth_maximum(&mut self, x: Form, y: Form) -> Form {
        let difference = self.difference(x, y);
        let Share { value, complement, slope, softness } = self.share_at(difference.middle);
        let mut mixed = self.mixture((value, complement), x, y);
        let greater = self.of(Operation::Maximum, x.middle, y.middle);
        mixed.middle = self.of(Operation::Add, greater, softness);
        if let Some(deviation) = self.deviation(difference) {
            let growth = self.0.apply(Operation::Exp, &[deviation]);
            let bend = self.bend(slope, growth, deviation, STEEPEST_OF_MAXIMA);
            let off = self.of(Operation::Minimum, bend, deviation);
            let half = self.scaled(0.5, off);
            mixed.middle = self.of(Operation::Add, mixed.middle, half);
            mixed.rest = self.0.sum(mixed.rest, Some(half));
        }
        let one = self.0.literal(1.0);
        let size = self.of(Operation::Add, mixed.size, one);
        Form { rest: self.rounded(mixed.rest, size), size, ..mixed }
    }

    /// 1/(1 + e⁻ˣ)
    fn share(&mut self, x: Form) -> Form {
        let Share { value, complement, slope, .. } = self.share_at(x.middle);
        let Some(deviation) = self.deviation(x) else { return self.known(value) };
        let [zero, one, far] = [0.0, 1.0, FAR].map(|value| self.0.literal(value));
        let is_near = self.of(Operation::Less, deviation, far);
        let growth = self.0.apply(Operation::Exp, &[deviation]);
        let bend = self.bend(slope, growth, deviation, STEEPEST_OF_SHARES);
        // The logarithms of a share and of its complement have slopes between −1 and 1.
        let mut most_of = |share| {
            let most = self.times(share, growth);
            let most = self.scaled(MARGIN, most);
            self.of(Operation::Minimum, most, one)
        };
        let (most, least) = (most_of(value), most_of(complement));
        let least = self.of(Operation::Subtract, one, least);
        let sum = self.of(Operation::Add, least, most);
        let between = self.scaled(0.5, sum);
        let width = self.of(Operation::Subtract, most, least);
        let width = self.scaled(0.5, width);
        let middle = self.either(is_near, value, between);
        let slope = self.either(is_near, slope, zero);
        let off = self.either(is_near, bend, width);
        let size = self.of(Operation::Add, one, deviation);
        self.bent((middle, size), x, (slope, slope), off)
    }

    /// How far a function of a form with this deviation is at most from its tangent, if its curvature is no more than `steepest`, nor than
    /// `growth`, e to the deviation, times `slope`.
    fn bend(&mut self, slope: NodeId, growth: NodeId, deviation: NodeId, steepest: f64) -> NodeId {
        let curvature = self.times(slope, growth);
        let curvature = self.scaled(MARGIN, curvature);
        let steepest = self.0.literal(steepest);
        let curvature = self.of(Operation::Minimum, curvature, steepest);
        let half = self.scaled(0.5, deviation);
        let half = self.times(half, deviation);
        self.times(half, curvature)
    }

    fn share_at(&mut self, x: NodeId) -> Share {
        let [zero, one] = [0.0, 1.0].map(|value| self.0.literal(value));
        let distance = self.magnitude_of(x);
        let distance = self.negated(distance);
        let lesser = self.0.apply(Operation::Exp, &[distance]);
        let sum = self.of(Operation::Add, one, lesser);
        let greater_share = self.of(Operation::Divide, one, sum);
        let lesser_share = self.times(lesser, greater_share);
        let is_positive = self.of(Operation::Less, zero, x);
        Share {
            value: self.either(is_positive, greater_share, lesser_share),
            complement: self.either(is_positive, lesser_share, greater_share),
            slope: self.times(greater_share, lesser_share),
            softness: self.0.apply(Operation::Ln, &[sum]),
        }
    }
}
