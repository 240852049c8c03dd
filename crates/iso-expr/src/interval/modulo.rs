//! The remainder with the sign of the divisor.

use super::arithmetic::negate;
use super::rounding::{lesser, round_down};
use super::{Decorated, Decoration, Interval};

/// a − b·⌊a/b⌋. Undefined where b is zero; jumps where a/b is an integer.
pub(crate) fn modulo(a: Decorated, b: Decorated) -> Decorated {
    if a.interval.is_empty() | b.interval.is_empty() | (b.interval == Interval::point(0.0)) {
        Decorated::EMPTY
    } else if b.interval.contains_zero() {
        b.at_most(Decoration::Trivial)
    } else if b.interval.hi < 0.0 {
        negate(modulo_of_positive(negate(a), negate(b)))
    } else {
        modulo_of_positive(a, b)
    }
}

/// The remainder by divisors above zero.
fn modulo_of_positive(a: Decorated, b: Decorated) -> Decorated {
    let (x, y) = (a.interval, b.interval);
    let decoration = a.decoration.min(b.decoration);
    let least = floor_of_quotient(x.lo, if x.lo < 0.0 { y.lo } else { y.hi });
    let greatest = floor_of_quotient(x.hi, if x.hi < 0.0 { y.hi } else { y.lo });
    let interval = match least {
        Some(turns) if least == greatest => remainder(x, y, turns),
        _ => {
            return Decorated { interval: Interval::from_ends(0.0, y.hi), decoration }
                .at_most(Decoration::Defined);
        }
    };
    let touches_jump = interval.lo == 0.0;
    let enclosure = Decorated::enclosing(interval, decoration);
    if touches_jump { enclosure.at_most(Decoration::Continuous) } else { enclosure }
}

/// x − turns·y, which is known to lie from 0 to y.
fn remainder(x: Interval, y: Interval, turns: f64) -> Interval {
    if turns == 0.0 {
        return x;
    }
    let (least_y, most_y) = if turns > 0.0 { (y.hi, y.lo) } else { (y.lo, y.hi) };
    let lo = round_down((-turns).mul_add(least_y, x.lo));
    let hi = -round_down(turns.mul_add(most_y, -x.hi));
    Interval { lo, hi: lesser(hi, y.hi) }
}

/// ⌊x/y⌋ for real x and y > 0, either of which may also be a limit at infinity; None where it is not a double or no such
/// limit.
fn floor_of_quotient(x: f64, y: f64) -> Option<f64> {
    const LARGEST: f64 = (1u64 << 53) as f64;
    let quotient = x / y;
    if quotient == 0.0 {
        return Some(if x < 0.0 { -1.0 } else { 0.0 });
    }
    let floor = quotient.floor();
    if quotient.is_nan() || floor.abs() >= LARGEST {
        None
    } else if floor < quotient {
        // Integers are doubles here, so the real quotient lies between the same two.
        Some(floor)
    } else {
        // The real quotient may lie just below. The sign of a fused x − ⌊q⌋·y is exact.
        Some(if floor.mul_add(-y, x) < 0.0 { floor - 1.0 } else { floor })
    }
}
