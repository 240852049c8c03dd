//! Enclosures hold the real values of the operation, by proof rather than by comparison with rounded values: a value
//! rounded to nearest lies in an interval that was not rounded outwards, too.

use super::*;

const TINY: f64 = f64::from_bits(1);

/// Bounds that surely hold a real number, which may be equal to one another or infinite.
type Bounds = (f64, f64);

/// Where the operation is undefined as a real function.
fn is_undefined(operation: Operation, [a, b, c]: Point3) -> bool {
    match operation {
        Operation::Divide | Operation::Modulo => b == 0.0,
        Operation::Power => a < 0.0 || (a == 0.0 && b < 0.0),
        Operation::SquareRoot => a < 0.0,
        Operation::Ln | Operation::Log2 | Operation::Log10 => a <= 0.0,
        Operation::Ln1P => a <= -1.0,
        Operation::Asin | Operation::Acos => a.abs() > 1.0,
        Operation::Atanh => a.abs() >= 1.0,
        Operation::Acosh => a < 1.0,
        Operation::Atan2 => a == 0.0 && b == 0.0,
        _ => nearest(operation, [a, b, c]).is_nan(),
    }
}

/// The range of the operation as a real function.
fn range(operation: Operation) -> Bounds {
    match operation {
        Operation::Sin | Operation::Cos | Operation::Tanh => (-1.0, 1.0),
        Operation::Cosh => (1.0, f64::INFINITY),
        Operation::ExpM1 => (-1.0, f64::INFINITY),
        _ => (f64::NEG_INFINITY, f64::INFINITY),
    }
}

/// Bounds of the real number whose nearest double is `nearest` and which lies on the side of it that `excess` says.
fn beside(nearest: f64, excess: f64) -> Bounds {
    if nearest.is_infinite() {
        return if nearest > 0.0 { (f64::MAX, nearest) } else { (nearest, f64::MIN) };
    }
    (
        if excess < 0.0 { nearest.next_down() } else { nearest },
        if excess > 0.0 { nearest.next_up() } else { nearest },
    )
}

/// Bounds of the real number whose nearest double is `nearest`, a zero having its sign.
fn around(nearest: f64) -> Bounds {
    if nearest == 0.0 {
        return if nearest.is_sign_negative() { (-TINY, 0.0) } else { (0.0, TINY) };
    }
    (beside(nearest, -1.0).0, beside(nearest, 1.0).1)
}

/// Bounds of a + b (Knuth, 'The Art of Computer Programming', volume 2, section 4.2.2).
fn sum(a: f64, b: f64) -> Bounds {
    let sum = a + b;
    let rounded_b = sum - a;
    let rounded_a = sum - rounded_b;
    let excess = (a - rounded_a) + (b - rounded_b);
    if excess.is_nan() { around(sum) } else { beside(sum, excess) }
}

/// Bounds of the number `nearest` whose excess was computed by a fused operation on numbers of about the size of `scale`,
/// which has the sign of the true excess unless it underflows.
fn fused(nearest: f64, excess: f64, scale: f64) -> Bounds {
    let may_underflow = scale.abs() < 1e-280;
    if may_underflow || excess.is_nan() { around(nearest) } else { beside(nearest, excess) }
}

/// Bounds of the real value of an operation where it is defined, at most one double apart on either side of the nearest.
fn bounds(operation: Operation, point: Point3) -> Bounds {
    let value = nearest(operation, point);
    let [a, b, _] = point;
    let (lo, hi) = match operation {
        Operation::Add => sum(a, b),
        Operation::Subtract => sum(a, -b),
        Operation::Multiply if a != 0.0 && b != 0.0 => fused(value, a.mul_add(b, -value), value),
        Operation::Divide if a != 0.0 => fused(value, -value.mul_add(b, -a) * b.signum(), a),
        Operation::SquareRoot if a != 0.0 => fused(value, -value.mul_add(value, -a), a),
        Operation::Modulo => {
            let remainder = a % b;
            sum(remainder, if remainder != 0.0 && (remainder < 0.0) != (b < 0.0) { b } else { 0.0 })
        }
        Operation::Atan2 if a == 0.0 => (value, if b < 0.0 { value.next_up() } else { value }),
        Operation::Power if a == 0.0 => (value, value),
        _ if is_exact(operation) || (value == 0.0 && point[..operation.arity()].contains(&0.0)) => {
            (value, value)
        }
        _ => around(value),
    };
    let (least, most) = range(operation);
    (lo.max(least), hi.min(most))
}

fn is_exact(operation: Operation) -> bool {
    use Operation::*;
    matches!(
        operation,
        Negate
            | Absolute
            | Sign
            | Minimum
            | Maximum
            | Floor
            | Ceil
            | Round
            | Truncate
            | Less
            | LessOrEqual
            | Equal
            | Select
    )
}

/// Calls `check` with every operation, many boxes, points inside them, and the boxes' enclosures: a million points.
fn for_every_operation(seed: u64, check: impl Fn(Operation, Box3, Decorated, Point3)) {
    const BOXES: usize = 2_400;
    const POINTS: usize = 10;
    for operation in Operation::all() {
        let mut random = Random::new(seed ^ operation.index() as u64);
        for _ in 0..BOXES {
            let operands = random_box(&mut random, operation);
            let enclosure = extend(operation, operands);
            if has_empty(operation, operands) {
                let is_chosen = operation == Operation::Select && !operands[0].interval.is_empty();
                assert!(is_chosen || enclosure == Decorated::EMPTY, "{}", show(operation, operands));
                continue;
            }
            for _ in 0..POINTS {
                check(operation, operands, enclosure, random_point(&mut random, operands));
            }
        }
    }
}

#[test]
fn enclosures_hold_the_real_value_at_every_point() {
    for_every_operation(0x5eed, |operation, operands, enclosure, point| {
        if is_undefined(operation, point) {
            return;
        }
        let (lo, hi) = bounds(operation, point);
        let Interval { lo: least, hi: most } = enclosure.interval;
        assert!(
            least <= lo && hi <= most,
            "{} = {enclosure} lacks [{lo:e}, {hi:e}] at {point:?}",
            show(operation, operands)
        );
    });
}

/// Where an enclosure of one point may be wider: powers are multiplied out, remainders of huge quotients not computed.
fn is_wider(operation: Operation, [a, b, _]: Point3) -> bool {
    match operation {
        Operation::IntegerPower => b > 2.0,
        Operation::Modulo => (a / b).abs() >= 2f64.powi(53),
        _ => false,
    }
}

#[test]
fn points_are_enclosed_by_neighbours_of_the_nearest_double() {
    for_every_operation(0xfeed, |operation, _, _, point| {
        if is_undefined(operation, point) || is_wider(operation, point) {
            return;
        }
        let nearest = nearest(operation, point);
        let Interval { lo, hi } = extend(operation, point.map(|end| Decorated::argument(end, end))).interval;
        let (least, most) = (nearest.next_down(), nearest.next_up());
        assert!(
            least <= lo && hi <= most,
            "{operation:?} at {point:?} = [{lo:e}, {hi:e}] around {nearest:e}"
        );
    });
}

#[test]
fn only_trivial_enclosures_hold_undefined_points() {
    for_every_operation(0xdead, |operation, operands, enclosure, point| {
        let is_trivial = enclosure.decoration == Decoration::Trivial;
        if is_undefined(operation, point) {
            assert!(is_trivial, "{} = {enclosure} at {point:?}", show(operation, operands));
        }
        if enclosure.decoration == Decoration::Common {
            let is_bounded = enclosure.interval.is_bounded();
            assert!(is_bounded, "{} = {enclosure}", show(operation, operands));
        }
        assert!(is_trivial || !enclosure.interval.is_empty(), "{}", show(operation, operands));
    });
}

#[test]
fn integer_powers_are_within_the_stated_bound() {
    let mut random = Random::new(0xcafe);
    for _ in 0..100_000 {
        let (size, exponent) = (random.between(-60.0, 60.0).exp2(), 2 + random.below(30) as u32);
        let base = random.choose(&[-size, size]);
        let nearest = core_math::pow(base, f64::from(exponent));
        let Interval { lo, hi } = Interval::point(base).to_the(exponent);
        let ulps = |p: f64, q: f64| p.to_bits().abs_diff(q.to_bits());
        let bound = 3 * u64::from(exponent - 1);
        assert!(ulps(lo, nearest) <= bound && ulps(hi, nearest) <= bound, "{base}^{exponent} = [{lo}, {hi}]");
    }
}
