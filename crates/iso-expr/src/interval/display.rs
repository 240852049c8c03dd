//! Intervals as text.

use std::fmt;

use super::{Decorated, Decoration, Interval};

/// `[lo, hi]` with digits that read back to the same doubles, `-inf` and `inf` for infinite ends; `empty`.
impl fmt::Display for Interval {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            formatter.write_str("empty")
        } else {
            write!(formatter, "[{}, {}]", digits(self.lo), digits(self.hi))
        }
    }
}

/// `trivial`, `defined`, `continuous` or `common`.
impl fmt::Display for Decoration {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Trivial => "trivial",
            Self::Defined => "defined",
            Self::Continuous => "continuous",
            Self::Common => "common",
        })
    }
}

/// The interval, then the decoration.
impl fmt::Display for Decorated {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} {}", self.interval, self.decoration)
    }
}

/// The shortest digits of `end`, with an exponent where it is very large or small, and no sign on a zero.
fn digits(end: f64) -> String {
    let mut text = format!("{:?}", end + 0.0);
    if text.ends_with(".0") {
        text.truncate(text.len() - 2);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_written_by_their_ends() {
        let cases = [
            (Interval::point(0.0), "[0, 0]"),
            (Interval { lo: -1.0, hi: 0.1 }, "[-1, 0.1]"),
            (Interval { lo: 1e-300, hi: f64::MAX }, "[1e-300, 1.7976931348623157e308]"),
            (Interval::ENTIRE, "[-inf, inf]"),
            (Interval::EMPTY, "empty"),
        ];
        for (interval, text) in cases {
            assert_eq!(interval.to_string(), text);
        }
    }

    #[test]
    fn ends_read_back() {
        for end in [0.1, -1.0 / 3.0, f64::MIN_POSITIVE, f64::from_bits(1), 123_456_789.0, 1e17, f64::INFINITY]
        {
            assert_eq!(digits(end).parse(), Ok(end));
        }
    }
}
