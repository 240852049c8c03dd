//! Isolation of the roots of a polynomial along a ray, by halving in the basis of Bernstein.

use iso_expr::Interval;
use iso_expr::interval::{round_down, round_up};

use super::line::Line;
use super::polynomial::Polynomial;
use super::side::side;
use crate::Span;

/// How often a stretch is halved at most.
const HALVINGS: u32 = 30;

/// How often a stretch is halved around a crossing, which interval arithmetic then takes over.
const CROSSING_HALVINGS: u32 = 16;

/// How many pieces of a stretch are judged. Only rounding can make so many; those left over count as open.
const PIECES: u64 = 1000;

/// The pieces of a stretch of a ray that may hold roots of a polynomial, front to back.
pub(super) struct Isolation<'a> {
    /// The number of coefficients of a piece.
    count: usize,
    memory: &'a mut Expansion,
    /// How many pieces were judged.
    pub(super) judged: u64,
}

/// Working memory.
#[derive(Debug, Default)]
pub(crate) struct Expansion {
    terms: Vec<Interval>,
    /// The coefficients of the pieces still to be judged, those of the nearest on top.
    coefficients: Vec<Interval>,
    /// The pieces still to be judged, the nearest on top.
    pieces: Vec<Piece>,
}

/// A piece of a stretch: where it starts and ends, enclosed, and how often the stretch was halved to get it.
#[derive(Clone, Copy, Debug)]
struct Piece {
    start: Interval,
    end: Interval,
    halvings: u32,
}

impl<'a> Isolation<'a> {
    /// All of a stretch of a ray, to be judged.
    pub(super) fn new(
        polynomial: &Polynomial,
        line: &Line<'_>,
        stretch: Span,
        memory: &'a mut Expansion,
    ) -> Self {
        let Expansion { terms, coefficients, pieces } = &mut *memory;
        let bounds = |t| line.bounds(Span { start: t, end: t });
        coefficients.clear();
        polynomial.expand(bounds(stretch.start), bounds(stretch.end), terms, coefficients);
        let (start, end) = (Interval::point(stretch.start), Interval::point(stretch.end));
        pieces.clear();
        pieces.push(Piece { start, end, halvings: 0 });
        Self { count: polynomial.degree() + 1, memory, judged: 0 }
    }

    /// The next piece that may hold roots. All between it and the one before is free of them.
    pub(super) fn next(&mut self) -> Option<Span> {
        let Expansion { coefficients, pieces, .. } = &mut *self.memory;
        while let Some(piece) = pieces.pop() {
            self.judged += 1;
            let first = coefficients.len() - self.count;
            match judge(&coefficients[first..], piece.halvings) {
                Verdict::Free => coefficients.truncate(first),
                Verdict::Halve if self.judged < PIECES => {
                    halve(coefficients, first);
                    let middle = piece.start.plus(piece.end).times(Interval::point(0.5));
                    let halvings = piece.halvings + 1;
                    pieces.push(Piece { start: middle, end: piece.end, halvings });
                    pieces.push(Piece { start: piece.start, end: middle, halvings });
                }
                Verdict::Open | Verdict::Halve => {
                    coefficients.truncate(first);
                    return Some(Span { start: piece.start.lo, end: piece.end.hi });
                }
            }
        }
        None
    }
}

/// What is to become of a piece.
enum Verdict {
    /// It holds no root.
    Free,
    /// It may hold roots, and halving it is not worth while.
    Open,
    Halve,
}

/// Judges a piece by its coefficients: without a change of sign there is no root, and when they all rise or all fall there
/// is no more than one.
fn judge(coefficients: &[Interval], halvings: u32) -> Verdict {
    let first = side(coefficients[0]);
    if first.is_some() && coefficients.iter().all(|coefficient| side(*coefficient) == first) {
        return Verdict::Free;
    }
    if coefficients.iter().all(|coefficient| side(*coefficient).is_none()) || halvings >= HALVINGS {
        return Verdict::Open;
    }
    let rises = coefficients.windows(2).all(|pair| pair[0].hi < pair[1].lo);
    let falls = coefficients.windows(2).all(|pair| pair[0].lo > pair[1].hi);
    if (rises || falls) && halvings >= CROSSING_HALVINGS { Verdict::Open } else { Verdict::Halve }
}

/// Replaces the coefficients from `first` on by those of the two halves, the nearer one last (de Casteljau's algorithm).
fn halve(coefficients: &mut Vec<Interval>, first: usize) {
    let count = coefficients.len() - first;
    coefficients.extend_from_within(first..);
    let (far, near) = coefficients[first..].split_at_mut(count);
    // Each round of means leaves the next coefficient of the near half in front, and the next of the far half behind.
    for (round, near) in near.iter_mut().enumerate() {
        *near = far[0];
        for place in 0..count - 1 - round {
            far[place] = mean(far[place], far[place + 1]);
        }
    }
}

/// Encloses the means of numbers of both intervals, up to half of the least double, which cannot hide a sign: what is left of zero in a mean is one
/// double at least. They are halved before they are added, for a sum that overflows would be no bound of anything once halved.
fn mean(a: Interval, b: Interval) -> Interval {
    Interval { lo: round_down(0.5 * a.lo + 0.5 * b.lo), hi: round_up(0.5 * a.hi + 0.5 * b.hi) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_have_the_coefficients_of_the_polynomial_on_them() {
        // u² on [0, 1] is (0, 0, 1); on [0, ½] it is (0, 0, ¼) and on [½, 1] it is (¼, ½, 1).
        let mut coefficients = [9.0, 0.0, 0.0, 1.0].map(Interval::point).to_vec();
        halve(&mut coefficients, 1);
        let expected = [9.0, 0.25, 0.5, 1.0, 0.0, 0.0, 0.25];
        assert_eq!(coefficients.len(), expected.len());
        for (found, expected) in coefficients.iter().zip(expected) {
            assert!(found.contains(expected) && found.width() < 1e-15, "{found} is not {expected}");
        }
    }

    #[test]
    fn a_mean_of_huge_numbers_is_a_number() {
        let huge = Interval::point(0.9 * f64::MAX);
        let found = mean(huge, huge);
        assert!(found.contains(0.9 * f64::MAX) && found.is_bounded(), "{found}");
    }

    #[test]
    fn signs_of_coefficients_tell_roots() {
        let judge = |coefficients: &[f64], halvings| {
            let coefficients: Vec<_> = coefficients.iter().copied().map(Interval::point).collect();
            judge(&coefficients, halvings)
        };
        assert!(matches!(judge(&[1.0, 0.5, 2.0], 0), Verdict::Free));
        assert!(matches!(judge(&[1.0, -0.1, 2.0], 0), Verdict::Halve));
        assert!(matches!(judge(&[1.0, -0.1, 2.0], HALVINGS), Verdict::Open));
        assert!(matches!(judge(&[1.0, 0.5, -2.0], 0), Verdict::Halve));
        assert!(matches!(judge(&[1.0, 0.5, -2.0], CROSSING_HALVINGS), Verdict::Open));
        assert!(matches!(judge(&[0.0, 0.0, 0.0], 0), Verdict::Open));
    }
}
