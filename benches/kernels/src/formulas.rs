//! The measured formulas as people write them in Rust, in the order of operations of their texts.

use core_math::{cos, sin};

use crate::operations::maximum;

#[inline(always)]
pub(crate) fn paper(x: f64, y: f64, z: f64) -> f64 {
    let ring = x * x + y * y - 1.0;
    ring * ring + 4.0 * (z * z) + 0.5 * x - 0.2
}

#[inline(always)]
pub(crate) fn tanglecube(x: f64, y: f64, z: f64) -> f64 {
    let (x2, y2, z2) = (x * x, y * y, z * z);
    x2 * x2 - 5.0 * x2 + y2 * y2 - 5.0 * y2 + z2 * z2 - 5.0 * z2 + 11.8
}

#[inline(always)]
pub(crate) fn heart(x: f64, y: f64, z: f64) -> f64 {
    let (x2, y2, z2) = (x * x, y * y, z * z);
    let ball = x2 + 2.25 * y2 + z2 - 1.0;
    let z3 = z * z2;
    ball * (ball * ball) - x2 * z3 - 0.1125 * y2 * z3
}

#[inline(always)]
pub(crate) fn barth(x: f64, y: f64, z: f64) -> f64 {
    const GOLDEN_SQUARED: f64 = 2.618033988749895;
    let (x2, y2, z2) = (x * x, y * y, z * z);
    let planes = 4.0 * (GOLDEN_SQUARED * x2 - y2) * (GOLDEN_SQUARED * y2 - z2) * (GOLDEN_SQUARED * z2 - x2);
    let ball = x2 + y2 + z2 - 1.0;
    maximum(planes - 4.23606797749979 * (ball * ball), x2 + y2 + z2 - 3.0)
}

#[inline(always)]
pub(crate) fn gyroid(x: f64, y: f64, z: f64) -> f64 {
    maximum(sin(x) * cos(y) + sin(y) * cos(z) + sin(z) * cos(x), x * x + y * y + z * z - 49.0)
}

#[inline(always)]
pub(crate) fn metaballs(x: f64, y: f64, z: f64) -> f64 {
    let field = |a: f64, b: f64, c: f64| 1.0 / (a * a + b * b + c * c);
    3.5 - field(x - 0.9, y, z) - field(x + 0.9, y, z) - field(x, y - 0.8, z) - field(x, y, z - 0.8)
}
