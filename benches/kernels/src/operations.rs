//! Operations that Rust does not write as signs, with the values that the engines give them.

pub(crate) use core_math::{cos, sin};

#[inline(always)]
pub(crate) fn maximum(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

#[inline(always)]
pub(crate) fn less(a: f64, b: f64) -> f64 {
    truth(a, b, a < b)
}

#[inline(always)]
pub(crate) fn select(condition: f64, a: f64, b: f64) -> f64 {
    if condition.is_nan() {
        condition
    } else if condition != 0.0 {
        a
    } else {
        b
    }
}

#[inline(always)]
fn truth(a: f64, b: f64, holds: bool) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else if holds {
        1.0
    } else {
        0.0
    }
}
