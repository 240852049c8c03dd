//! Elementary functions of forms, by Taylor's theorem around the middle. Here r is the form's deviation.

use super::{Builder, Form, NodeId, Operation};

/// eᵣ − 1 is at most 1.72·r for r ≤ 1, as it is convex.
const STEEPEST: f64 = 1.75;

impl Builder {
    /// √(m + Δ) = √m + Δ/(2√m) − (√(m + Δ) − √m)²/(2√m), where |√(m + Δ) − √m| ≤ r/(√m + √(m − r)).
    pub(super) fn square_root(&mut self, x: Form) -> Form {
        let root = self.0.apply(Operation::SquareRoot, &[x.middle]);
        let Some(deviation) = self.deviation(x) else { return self.known(root) };
        let distance = self.distance(x.middle, deviation);
        let least = self.0.apply(Operation::SquareRoot, &[distance]);
        let half = self.0.literal(0.5);
        let slope = self.of(Operation::Divide, half, root);
        let sum = self.of(Operation::Add, root, least);
        let change = self.of(Operation::Divide, deviation, sum);
        let bend = self.times(change, slope);
        let bend = self.times(bend, change);
        let half = self.scaled(0.5, bend);
        let middle = self.of(Operation::Subtract, root, half);
        let part = self.of(Operation::Divide, deviation, root);
        let size = self.of(Operation::Add, root, part);
        let size = self.larger(size);
        self.bent((middle, size), x, (slope, slope), half)
    }

    /// s = ∛(m + Δ) is c + Δ/(3c²) − q for c = ∛m, where q = (s − c)²·(2c + s)/(3c²) has c's sign and |s − c| ≤ r/(l² + l·|c| + c²) with l = ∛(|m| − r).
    pub(super) fn cube_root(&mut self, x: Form) -> Form {
        let root = self.0.apply(Operation::CubeRoot, &[x.middle]);
        let Some(deviation) = self.deviation(x) else { return self.known(root) };
        let distance = self.distance(x.middle, deviation);
        let stays_away = self.is_positive(distance);
        let distance = self.provided(stays_away, distance);
        let least = self.0.apply(Operation::CubeRoot, &[distance]);
        let (size, square) = (self.magnitude_of(root), self.times(root, root));
        let one = self.0.literal(1.0);
        let triple = self.scaled(3.0, square);
        let slope = self.of(Operation::Divide, one, triple);
        let sum = self.of(Operation::Add, least, size);
        let product = self.times(least, sum);
        let sum = self.of(Operation::Add, product, square);
        let change = self.of(Operation::Divide, deviation, sum);
        let part = self.times(deviation, slope);
        let tripled = self.scaled(3.0, size);
        let most = self.of(Operation::Add, tripled, part);
        let bend = self.times(most, slope);
        let bend = self.times(change, bend);
        let bend = self.times(change, bend);
        let half = self.scaled(0.5, bend);
        let sign = self.0.apply(Operation::Sign, &[root]);
        let shift = self.times(sign, half);
        let middle = self.of(Operation::Subtract, root, shift);
        let size = self.of(Operation::Add, size, part);
        let size = self.larger(size);
        self.bent((middle, size), x, (slope, slope), half)
    }

    /// √(x² + y²)
    pub(super) fn hypotenuse(&mut self, x: Form, y: Form) -> Form {
        let (x, y) = (self.square(x), self.square(y));
        let sum = self.sum(x, y);
        self.square_root(sum)
    }

    /// ln(m + Δ) = ln m + Δ/m − q, where 0 ≤ q ≤ ½r²/(m·(m − r)), for −ρ − ln(1 − ρ) = ½ρ² + ⅓ρ³ + … is no more than ½ρ²/(1 − ρ) for
    /// ρ = r/m < 1.
    pub(super) fn logarithm(&mut self, x: Form) -> Form {
        let value = self.0.apply(Operation::Ln, &[x.middle]);
        let Some(deviation) = self.deviation(x) else { return self.known(value) };
        let one = self.0.literal(1.0);
        let distance = self.distance(x.middle, deviation);
        let stays_away = self.is_positive(distance);
        let distance = self.provided(stays_away, distance);
        let slope = self.of(Operation::Divide, one, x.middle);
        let change = self.of(Operation::Divide, deviation, distance);
        let quarter = self.scaled(0.25, deviation);
        let half = self.times(quarter, slope);
        let half = self.times(half, change);
        let middle = self.of(Operation::Subtract, value, half);
        let size = self.magnitude_of(value);
        let size = self.of(Operation::Add, size, change);
        let size = self.larger(size);
        self.bent((middle, size), x, (slope, slope), half)
    }

    /// e^(m + Δ) = e^m·(1 + Δ + q), where 0 ≤ q ≤ ½r²·eʳ. Nothing is said for r > 1.
    pub(super) fn exponential(&mut self, x: Form) -> Form {
        let value = self.0.apply(Operation::Exp, &[x.middle]);
        let Some(deviation) = self.deviation(x) else { return self.known(value) };
        let one = self.0.literal(1.0);
        let is_small = self.of(Operation::Less, deviation, one);
        let steepest = self.scaled(STEEPEST, deviation);
        let steepest = self.of(Operation::Add, one, steepest);
        let quarter = self.scaled(0.25, deviation);
        let square = self.times(quarter, deviation);
        let half = self.times(square, steepest);
        let half = self.times(value, half);
        let half = self.provided(is_small, half);
        let middle = self.of(Operation::Add, value, half);
        let part = self.times(value, deviation);
        let size = self.of(Operation::Add, middle, part);
        let size = self.of(Operation::Add, size, half);
        let size = self.larger(size);
        self.bent((middle, size), x, (value, value), half)
    }

    /// sin(m + Δ) = sin m + Δ·cos m − ½Δ²·sin m + q, where |q| ≤ r³/6.
    pub(super) fn sine(&mut self, x: Form) -> Form {
        let [sine, cosine] = [Operation::Sin, Operation::Cos].map(|wave| self.0.apply(wave, &[x.middle]));
        self.wave(x, sine, cosine)
    }

    /// cos(m + Δ) = cos m − Δ·sin m − ½Δ²·cos m + q, where |q| ≤ r³/6.
    pub(super) fn cosine(&mut self, x: Form) -> Form {
        let [sine, cosine] = [Operation::Sin, Operation::Cos].map(|wave| self.0.apply(wave, &[x.middle]));
        let slope = self.negated(sine);
        self.wave(x, cosine, slope)
    }

    /// A sine or cosine with this value and slope in the middle.
    fn wave(&mut self, x: Form, value: NodeId, slope: NodeId) -> Form {
        let Some(deviation) = self.deviation(x) else { return self.known(value) };
        let square = self.times(deviation, deviation);
        let quarter = self.scaled(0.25, square);
        let shift = self.times(quarter, value);
        let middle = self.of(Operation::Subtract, value, shift);
        let cube = self.times(deviation, square);
        let sixth = self.scaled(1.0 / 6.0, cube);
        let half = self.magnitude_of(shift);
        let half = self.of(Operation::Add, half, sixth);
        let one = self.0.literal(1.0);
        let size = self.of(Operation::Add, one, deviation);
        let size = self.of(Operation::Add, size, square);
        let size = self.of(Operation::Add, size, cube);
        let magnitude = self.magnitude_of(slope);
        self.bent((middle, size), x, (slope, magnitude), half)
    }

    /// A function of `x` with this middle and size, and this slope, given with its magnitude; it is off by `half` beside what it is
    /// for the rest of `x`.
    pub(super) fn bent(
        &mut self,
        (middle, size): (NodeId, NodeId),
        x: Form,
        (slope, magnitude): (NodeId, NodeId),
        half: NodeId,
    ) -> Form {
        let slopes = x.slopes.map(|part| part.map(|part| self.times(slope, part)));
        let rest = x.rest.map(|rest| self.times(magnitude, rest));
        let rest = self.0.sum(rest, Some(half));
        Form { middle, slopes, rest: self.rounded(rest, size), size }
    }

    /// The value of a function at one number.
    pub(super) fn known(&mut self, value: NodeId) -> Form {
        let size = self.magnitude_of(value);
        let size = self.larger(size);
        Form { middle: value, slopes: [None; 3], rest: self.rounded(None, size), size }
    }
}
