//! Sums, products and quotients of forms.

use super::{Builder, Form, NodeId, Operation, TINY};
use crate::operation::by_squaring;

impl Builder {
    pub(super) fn sum(&mut self, x: Form, y: Form) -> Form {
        let middle = self.of(Operation::Add, x.middle, y.middle);
        let slopes = [0, 1, 2].map(|place| self.0.sum(x.slopes[place], y.slopes[place]));
        self.combined(middle, slopes, x, y)
    }

    pub(super) fn difference(&mut self, x: Form, y: Form) -> Form {
        let middle = self.of(Operation::Subtract, x.middle, y.middle);
        let slopes = [0, 1, 2].map(|place| self.minus(x.slopes[place], y.slopes[place]));
        self.combined(middle, slopes, x, y)
    }

    /// a − b, where parts that are missing are zero.
    fn minus(&mut self, a: Option<NodeId>, b: Option<NodeId>) -> Option<NodeId> {
        match (a, b) {
            (Some(a), Some(b)) => Some(self.of(Operation::Subtract, a, b)),
            (a, b) => a.or_else(|| b.map(|b| self.negated(b))),
        }
    }

    /// What the product of both deviations from the middles does not exceed; `None` where one of the forms is one number.
    pub(super) fn product_of_deviations(&mut self, x: Form, y: Form) -> Option<NodeId> {
        let (x, y) = (self.deviation(x)?, self.deviation(y)?);
        Some(self.times(x, y))
    }

    /// A sum or difference with this middle and these slopes.
    fn combined(&mut self, middle: NodeId, slopes: [Option<NodeId>; 3], x: Form, y: Form) -> Form {
        let size = self.of(Operation::Add, x.size, y.size);
        let rest = self.0.sum(x.rest, y.rest);
        Form { middle, slopes, rest: self.rounded(rest, size), size }
    }

    pub(super) fn negative(&mut self, x: Form) -> Form {
        let middle = self.negated(x.middle);
        Form { middle, slopes: x.slopes.map(|slope| slope.map(|slope| self.negated(slope))), ..x }
    }

    /// (m + Δ)·(n + Δ′) = m·n + n·Δ + m·Δ′ + Δ·Δ′.
    pub(super) fn product(&mut self, x: Form, y: Form) -> Form {
        let middle = self.times(x.middle, y.middle);
        let slopes = [0, 1, 2].map(|place| {
            let of_y = y.slopes[place].map(|slope| self.times(x.middle, slope));
            let of_x = x.slopes[place].map(|slope| self.times(y.middle, slope));
            self.0.sum(of_y, of_x)
        });
        let [x_middle, y_middle] = [x.middle, y.middle].map(|middle| self.magnitude_of(middle));
        let of_y = y.rest.map(|rest| self.times(x_middle, rest));
        let of_x = x.rest.map(|rest| self.times(y_middle, rest));
        let of_both = self.product_of_deviations(x, y);
        let rest = self.0.sum(of_y, of_x);
        let rest = self.0.sum(rest, of_both);
        let size = self.times(x.size, y.size);
        let size = self.larger(size);
        Form { middle, slopes, rest: self.rounded(rest, size), size }
    }

    /// (m + Δ)² = m² + 2m·Δ + Δ², where 0 ≤ Δ² ≤ r² for the deviation r.
    pub(super) fn square(&mut self, x: Form) -> Form {
        let mut middle = self.times(x.middle, x.middle);
        let double = self.scaled(2.0, x.middle);
        let slopes = x.slopes.map(|slope| slope.map(|slope| self.times(double, slope)));
        let magnitude = self.magnitude_of(double);
        let mut rest = x.rest.map(|rest| self.times(magnitude, rest));
        if let Some(deviation) = self.deviation(x) {
            let half = self.scaled(0.5, deviation);
            let half = self.times(half, deviation);
            middle = self.of(Operation::Add, middle, half);
            rest = self.0.sum(rest, Some(half));
        }
        let size = self.times(x.size, x.size);
        let size = self.larger(size);
        Form { middle, slopes, rest: self.rounded(rest, size), size }
    }

    /// An integer power from 2 on, by squares of the base.
    pub(super) fn power(&mut self, base: Form, exponent: u32) -> Form {
        let power = by_squaring(base, exponent, |x, y| match y {
            Some(y) => self.product(x, y),
            None => self.square(x),
        });
        power.expect("exponents are positive")
    }

    /// x·y, or x where y is 1.
    pub(super) fn multiple(&mut self, x: Form, y: Form) -> Form {
        let is_one = y.rest.is_none() && y.middle == self.0.literal(1.0);
        if is_one { x } else { self.product(y, x) }
    }

    /// x/y = c + (x − c·y)/n + (x − c·y)/n·(n/y − 1), where n is y's middle, c the quotient of the middles and |n/y − 1| ≤ r/(|n| − r) for y's
    /// deviation r. What x and y have in common cancels in x − c·y, as where x is a derivative of what y is a root of.
    pub(super) fn quotient(&mut self, x: Form, y: Form) -> Form {
        let (Some(_), Some(deviation)) = (self.deviation(x), self.deviation(y)) else {
            let reciprocal = self.reciprocal(y);
            return self.multiple(reciprocal, x);
        };
        let distance = self.distance(y.middle, deviation);
        let stays_away = self.is_positive(distance);
        let distance = self.provided(stays_away, distance);
        let middle = self.of(Operation::Divide, x.middle, y.middle);
        let one = self.0.literal(1.0);
        let inverse = self.of(Operation::Divide, one, y.middle);
        // Scaled before they are multiplied, so that what underflows is not made larger afterwards.
        let [x_slopes, y_slopes] =
            [x, y].map(|form| form.slopes.map(|slope| slope.map(|slope| self.times(slope, inverse))));
        let slopes = [0, 1, 2].map(|place| {
            let common = y_slopes[place].map(|slope| self.times(middle, slope));
            self.minus(x_slopes[place], common)
        });
        let [size_of_inverse, size_of_middle] = [inverse, middle].map(|number| self.magnitude_of(number));
        let [of_x, of_y] = [x, y].map(|form| form.rest.map(|rest| self.times(rest, size_of_inverse)));
        let of_y = of_y.map(|rest| self.times(size_of_middle, rest));
        let rest = self.0.sum(of_x, of_y);
        let linear = Form { middle, slopes, rest, size: size_of_middle };
        let bend = self.deviation(linear).map(|change| {
            let part = self.of(Operation::Divide, deviation, distance);
            self.times(change, part)
        });
        let rest = self.0.sum(rest, bend);
        let size = self.of(Operation::Divide, x.size, distance);
        let size = self.larger(size);
        Form { middle, slopes, rest: self.rounded(rest, size), size }
    }

    /// 1/(m + Δ) = 1/m − Δ/m² + Δ²/(m²·(m + Δ)), whose last term has the sign of m and is at most r²/(m²·(|m| − r)) for the
    /// deviation r.
    pub(super) fn reciprocal(&mut self, x: Form) -> Form {
        let one = self.0.literal(1.0);
        let inverse = self.of(Operation::Divide, one, x.middle);
        let magnitude = self.magnitude_of(inverse);
        let Some(deviation) = self.deviation(x) else {
            let size = self.larger(magnitude);
            return Form { middle: inverse, slopes: [None; 3], rest: self.rounded(None, size), size };
        };
        let distance = self.distance(x.middle, deviation);
        let stays_away = self.is_positive(distance);
        let distance = self.provided(stays_away, distance);
        let part = self.times(deviation, magnitude);
        let half = self.times(part, part);
        let half = self.scaled(0.5, half);
        let half = self.of(Operation::Divide, half, distance);
        let sign = self.times(x.middle, magnitude);
        let shift = self.times(sign, half);
        let middle = self.of(Operation::Add, inverse, shift);
        let slopes = x.slopes.map(|slope| {
            slope.map(|slope| {
                let part = self.times(slope, inverse);
                let part = self.times(part, inverse);
                self.negated(part)
            })
        });
        let rest = x.rest.map(|rest| {
            let part = self.times(rest, magnitude);
            self.times(part, magnitude)
        });
        let rest = self.0.sum(rest, Some(half));
        let size = self.of(Operation::Divide, one, distance);
        let size = self.larger(size);
        Form { middle, slopes, rest: self.rounded(rest, size), size }
    }

    /// A size that underflow does not reach.
    pub(super) fn larger(&mut self, size: NodeId) -> NodeId {
        let tiny = self.0.literal(TINY);
        self.of(Operation::Add, size, tiny)
    }
}
