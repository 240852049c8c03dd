//! How searches along rays end.

use crate::Span;

/// A point of the surface on a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Where on the ray, inside `bracket`.
    pub t: f64,
    /// A stretch that holds the root. Its meaning is the method's: between samples of unlike sign, or a proven enclosure.
    pub bracket: Span,
}

/// How the search for the first root along a ray ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// The ray crosses the surface.
    Hit(Hit),
    /// The ray comes so close to the surface that rounding cannot tell a contact from a near miss, as at a root of even multiplicity or a
    /// plateau.
    Touch(Hit),
    /// The method found no root. Whether that is proven is the method's to say.
    Miss,
    /// The method could not decide what happens in this stretch.
    Undecided(Span),
}

/// Which [`Outcome`] it is, without where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutcomeKind {
    /// [`Outcome::Hit`].
    Hit,
    /// [`Outcome::Touch`].
    Touch,
    /// [`Outcome::Miss`].
    Miss,
    /// [`Outcome::Undecided`].
    Undecided,
}

impl From<Outcome> for OutcomeKind {
    fn from(outcome: Outcome) -> Self {
        match outcome {
            Outcome::Hit(_) => Self::Hit,
            Outcome::Touch(_) => Self::Touch,
            Outcome::Miss => Self::Miss,
            Outcome::Undecided(_) => Self::Undecided,
        }
    }
}

/// The outcomes of some rays, in their order.
///
/// Their kinds, distances and brackets lie apart, since most of what is done with all of them takes only the first or the second, a
/// fraction of their memory.
#[derive(Clone, Debug, Default)]
pub struct Outcomes {
    kinds: Vec<OutcomeKind>,
    /// NaN but for hits and touches.
    distances: Vec<f64>,
    /// They mean nothing for misses.
    brackets: Vec<Span>,
}

impl Outcomes {
    /// Makes them misses, so many of them.
    pub fn reset(&mut self, count: usize) {
        self.kinds.clear();
        self.kinds.resize(count, OutcomeKind::Miss);
        self.distances.clear();
        self.distances.resize(count, f64::NAN);
        self.brackets.resize(count, Span::default());
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.kinds.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// The kind of each.
    pub fn kinds(&self) -> &[OutcomeKind] {
        &self.kinds
    }

    /// Where on its ray each of them is, NaN for those that are neither hits nor touches.
    pub fn distances(&self) -> &[f64] {
        &self.distances
    }

    /// The one of this number, below [`Outcomes::len`].
    #[inline]
    pub fn get(&self, number: usize) -> Outcome {
        let bracket = self.brackets[number];
        let hit = Hit { t: self.distances[number], bracket };
        match self.kinds[number] {
            OutcomeKind::Hit => Outcome::Hit(hit),
            OutcomeKind::Touch => Outcome::Touch(hit),
            OutcomeKind::Miss => Outcome::Miss,
            OutcomeKind::Undecided => Outcome::Undecided(bracket),
        }
    }

    /// Changes the one of this number, below [`Outcomes::len`].
    #[inline]
    pub fn set(&mut self, number: usize, outcome: Outcome) {
        let (t, bracket) = match outcome {
            Outcome::Hit(hit) | Outcome::Touch(hit) => (hit.t, hit.bracket),
            Outcome::Miss => (f64::NAN, Span::default()),
            Outcome::Undecided(stretch) => (f64::NAN, stretch),
        };
        self.kinds[number] = outcome.into();
        self.distances[number] = t;
        self.brackets[number] = bracket;
    }

    /// All of them.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Outcome> + '_ {
        (0..self.len()).map(|number| self.get(number))
    }
}

impl PartialEq for Outcomes {
    fn eq(&self, other: &Self) -> bool {
        self.iter().eq(other.iter())
    }
}

impl FromIterator<Outcome> for Outcomes {
    fn from_iter<I: IntoIterator<Item = Outcome>>(outcomes: I) -> Self {
        let mut all = Self::default();
        for (number, outcome) in outcomes.into_iter().enumerate() {
            all.kinds.push(OutcomeKind::Miss);
            all.distances.push(f64::NAN);
            all.brackets.push(Span::default());
            all.set(number, outcome);
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outcomes_come_back_as_they_were_put() {
        let bracket = Span { start: 1.0, end: 2.0 };
        let hit = Hit { t: 1.5, bracket };
        let each = [Outcome::Hit(hit), Outcome::Touch(hit), Outcome::Miss, Outcome::Undecided(bracket)];
        let mut outcomes: Outcomes = each.into_iter().collect();
        assert!(outcomes.iter().eq(each));
        assert_eq!(
            outcomes.kinds(),
            [OutcomeKind::Hit, OutcomeKind::Touch, OutcomeKind::Miss, OutcomeKind::Undecided]
        );
        assert!(are(outcomes.distances(), &[1.5, 1.5, f64::NAN, f64::NAN]));
        for (number, outcome) in each.into_iter().rev().enumerate() {
            outcomes.set(number, outcome);
        }
        assert!(outcomes.iter().eq(each.into_iter().rev()));
        assert!(are(outcomes.distances(), &[f64::NAN, f64::NAN, 1.5, 1.5]));
        for count in [2, 5, 0] {
            outcomes.reset(count);
            assert_eq!(outcomes, vec![Outcome::Miss; count].into_iter().collect());
            assert!(are(outcomes.distances(), &vec![f64::NAN; count]));
        }
    }

    fn are(distances: &[f64], expected: &[f64]) -> bool {
        distances.iter().map(|t| t.to_bits()).eq(expected.iter().map(|t| t.to_bits()))
    }
}
