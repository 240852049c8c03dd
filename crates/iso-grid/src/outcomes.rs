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
    /// plateau. Of several such places in a row, as on a plateau, t is the first one as far as the method can tell.
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
    /// Where brackets start, and where they end. They mean nothing for misses.
    brackets: [Vec<f64>; 2],
    /// Whether none was changed since all were made misses.
    are_misses: bool,
}

impl Outcomes {
    /// Makes them misses, so many of them.
    pub fn reset(&mut self, count: usize) {
        if self.are_misses && self.len() == count {
            return;
        }
        self.are_misses = true;
        self.kinds.clear();
        self.kinds.resize(count, OutcomeKind::Miss);
        self.distances.clear();
        self.distances.resize(count, f64::NAN);
        self.brackets.iter_mut().for_each(|ends| ends.resize(count, f64::NAN));
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
        let [start, end] = self.brackets.each_ref().map(|ends| ends[number]);
        let bracket = Span { start, end };
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
        self.are_misses = false;
        self.kinds[number] = outcome.into();
        self.distances[number] = t;
        (self.brackets[0][number], self.brackets[1][number]) = (bracket.start, bracket.end);
    }

    /// Makes `N` of them hits, from this number on: at these distances, in brackets with these starts and ends.
    pub(crate) fn put_hits<const N: usize>(
        &mut self,
        first: usize,
        distances: &[f64; N],
        brackets: &[[f64; N]; 2],
    ) {
        self.are_misses = false;
        let numbers = first..first + N;
        self.kinds[numbers.clone()].fill(OutcomeKind::Hit);
        self.distances[numbers.clone()].copy_from_slice(distances);
        for (ends, brackets) in self.brackets.iter_mut().zip(brackets) {
            ends[numbers.clone()].copy_from_slice(brackets);
        }
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
            all.brackets.iter_mut().for_each(|ends| ends.push(f64::NAN));
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
        let changes: [fn(&mut Outcomes, Hit); 3] = [
            |_, _| {},
            |outcomes, hit| outcomes.set(1, Outcome::Hit(hit)),
            |outcomes, Hit { t, bracket }| outcomes.put_hits(1, &[t], &[[bracket.start], [bracket.end]]),
        ];
        for (count, change) in
            [2, 5, 5, 5].into_iter().flat_map(|count| changes.map(|change| (count, change)))
        {
            outcomes.reset(count);
            assert_eq!(outcomes, vec![Outcome::Miss; count].into_iter().collect());
            assert!(are(outcomes.distances(), &vec![f64::NAN; count]));
            change(&mut outcomes, hit);
        }
        outcomes.reset(0);
        assert!(outcomes.is_empty());
    }

    #[test]
    fn hits_are_put_side_by_side() {
        let mut outcomes = Outcomes::default();
        outcomes.reset(4);
        outcomes.set(3, Outcome::Undecided(Span { start: 1.0, end: 2.0 }));
        outcomes.put_hits(1, &[1.5, 2.5], &[[1.0, 2.0], [1.75, 3.0]]);
        let hit = |t, start, end| Outcome::Hit(Hit { t, bracket: Span { start, end } });
        let last = Outcome::Undecided(Span { start: 1.0, end: 2.0 });
        assert!(outcomes.iter().eq([Outcome::Miss, hit(1.5, 1.0, 1.75), hit(2.5, 2.0, 3.0), last]));
    }

    fn are(distances: &[f64], expected: &[f64]) -> bool {
        distances.iter().map(|t| t.to_bits()).eq(expected.iter().map(|t| t.to_bits()))
    }
}
