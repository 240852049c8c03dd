//! Forms of functions that choose: of minima, absolute values and what their derivatives are made of.
//!
//! Where a choice is certain the form is the one chosen. Where it is not, it holds all that may be chosen.

use super::{Builder, Form, NodeId, Operation, ROUNDING};

/// What is known of the sign of a form.
struct Signed {
    /// 1 where it is certain, else 0.
    is_certain: NodeId,
    /// −1, 0 or 1, where it is certain.
    sign: NodeId,
    /// What the numbers do not exceed.
    magnitude: NodeId,
}

/// The positive part of a number is `weight` times that number, and no more than twice `half` besides.
struct Chord {
    /// From 0 to 1.
    weight: NodeId,
    /// 1 − `weight`.
    other: NodeId,
    half: NodeId,
}

impl Builder {
    /// Twice the positive part of x, less x.
    pub(super) fn absolute(&mut self, x: Form) -> Form {
        let Chord { weight, other, half } = self.chord(x);
        let sign = self.of(Operation::Subtract, weight, other);
        let middle = self.times(sign, x.middle);
        let off = self.scaled(2.0, half);
        let middle = self.of(Operation::Add, middle, off);
        let slopes = x.slopes.map(|slope| slope.map(|slope| self.times(sign, slope)));
        let magnitude = self.magnitude_of(sign);
        let rest = x.rest.map(|rest| self.times(magnitude, rest));
        let rest = self.0.sum(rest, Some(off));
        let size = self.larger(x.size);
        Form { middle, slopes, rest: self.rounded(rest, size), size }
    }

    /// The maximum for `toward` addition, the minimum for subtraction.
    ///
    /// For D = x − y between lo and hi, D's positive part is hi/(hi − lo)·D where D is lo or hi, and exceeds that by no more
    /// than it does at 0.
    pub(super) fn extremum(&mut self, x: Form, y: Form, toward: Operation) -> Form {
        let difference = match toward {
            Operation::Add => self.difference(x, y),
            _ => self.difference(y, x),
        };
        let Chord { weight, other, half } = self.chord(difference);
        let mixed = self.mixture((weight, other), x, y);
        let middle = self.of(toward, mixed.middle, half);
        let rest = self.0.sum(mixed.rest, Some(half));
        Form { middle, rest: self.rounded(rest, mixed.size), ..mixed }
    }

    /// The chord of the positive part of the numbers of a form.
    fn chord(&mut self, x: Form) -> Chord {
        let [zero, one] = [0.0, 1.0].map(|value| self.0.literal(value));
        let deviation = self.deviation(x).unwrap_or(zero);
        let rounding = self.scaled(ROUNDING, x.size);
        let deviation = self.of(Operation::Add, deviation, rounding);
        let most = self.of(Operation::Add, deviation, x.middle);
        let most = self.of(Operation::Maximum, most, zero);
        let least = self.of(Operation::Subtract, deviation, x.middle);
        let least = self.of(Operation::Maximum, least, zero);
        let width = self.of(Operation::Add, most, least);
        let width = self.larger(width);
        let weight = self.of(Operation::Divide, most, width);
        let other = self.of(Operation::Subtract, one, weight);
        let above = self.times(other, most);
        let below = self.times(weight, least);
        let off = self.of(Operation::Maximum, above, below);
        Chord { weight, other, half: self.scaled(0.5, off) }
    }

    pub(super) fn sign(&mut self, x: Form) -> Form {
        let Signed { is_certain, sign, .. } = self.signed(x);
        let [zero, one] = [0.0, 1.0].map(|value| self.0.literal(value));
        let middle = self.either(is_certain, sign, zero);
        let rest = self.either(is_certain, zero, one);
        Form { middle, slopes: [None; 3], rest: Some(rest), size: one }
    }

    /// 1 where x < y, 0 where x > y.
    pub(super) fn order(&mut self, x: Form, y: Form) -> Form {
        let difference = self.difference(y, x);
        let Signed { is_certain, sign, .. } = self.signed(difference);
        let half = self.0.literal(0.5);
        let truth = self.scaled(0.5, sign);
        let truth = self.of(Operation::Add, half, truth);
        self.truth(is_certain, truth)
    }

    /// 0 where x and y differ.
    pub(super) fn equality(&mut self, x: Form, y: Form) -> Form {
        let difference = self.difference(x, y);
        let Signed { is_certain, .. } = self.signed(difference);
        let zero = self.0.literal(0.0);
        self.truth(is_certain, zero)
    }

    /// `x` where `condition` is not zero, else `y`.
    pub(super) fn choice(&mut self, condition: Form, x: Form, y: Form) -> Form {
        let Signed { is_certain: is_true, magnitude, .. } = self.signed(condition);
        let [zero, half, one] = [0.0, 0.5, 1.0].map(|value| self.0.literal(value));
        let is_false = self.of(Operation::Equal, magnitude, zero);
        let weight = self.either(is_false, zero, half);
        let weight = self.either(is_true, one, weight);
        let other = self.of(Operation::Subtract, one, weight);
        let mixed = self.mixture((weight, other), x, y);
        let difference = self.difference(x, y);
        let magnitude = self.magnitude(difference);
        let between = self.scaled(0.5, magnitude);
        let is_known = self.of(Operation::Maximum, is_true, is_false);
        let off = self.either(is_known, zero, between);
        let rest = self.0.sum(mixed.rest, Some(off));
        Form { rest: self.rounded(rest, mixed.size), ..mixed }
    }

    /// A truth value that is known where it is certain.
    fn truth(&mut self, is_certain: NodeId, truth: NodeId) -> Form {
        let [zero, half, one] = [0.0, 0.5, 1.0].map(|value| self.0.literal(value));
        let middle = self.either(is_certain, truth, half);
        let rest = self.either(is_certain, zero, half);
        Form { middle, slopes: [None; 3], rest: Some(rest), size: one }
    }

    /// weight·x + other·y, for weights that sum up to 1.
    pub(super) fn mixture(&mut self, (weight, other): (NodeId, NodeId), x: Form, y: Form) -> Form {
        let mut mixed = |x: Option<NodeId>, y: Option<NodeId>| {
            let x = x.map(|x| self.times(weight, x));
            let y = y.map(|y| self.times(other, y));
            self.0.sum(x, y)
        };
        let middle = mixed(Some(x.middle), Some(y.middle)).expect("both are there");
        let slopes = [0, 1, 2].map(|place| mixed(x.slopes[place], y.slopes[place]));
        let rest = mixed(x.rest, y.rest);
        let size = self.of(Operation::Add, x.size, y.size);
        Form { middle, slopes, rest, size: self.larger(size) }
    }

    fn signed(&mut self, x: Form) -> Signed {
        let zero = self.0.literal(0.0);
        let deviation = self.deviation(x).unwrap_or(zero);
        let distance = self.distance(x.middle, deviation);
        Signed {
            is_certain: self.is_positive(distance),
            sign: self.0.apply(Operation::Sign, &[x.middle]),
            magnitude: self.magnitude(x),
        }
    }
}
