//! The signs of faces along a ray, and what their changes mean for what is made of them.

use smallvec::SmallVec;

use super::made::{Combination, Combinations, MOST};
use crate::{Hit, Span};

/// Where faces change their signs along a ray, in order: mostly few.
#[derive(Clone, Debug, Default)]
pub(super) struct Roots(SmallVec<[Root; 4]>);

/// Where a face changes its sign along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Root {
    /// The number of the face.
    pub(super) face: usize,
    pub(super) hit: Hit,
}

/// What roots of faces mean that cannot be told apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Event {
    /// F is not zero there.
    Nothing,
    /// The ray meets the body at the face of this number.
    Meeting(usize, Hit),
    /// F may be zero there, and has the same sign behind.
    Contact,
    /// F may be zero there, and too little is known of it.
    Unclear,
}

/// How the signs of faces change along a ray.
pub(super) struct Signs<'a> {
    pub(super) made: &'a Combinations,
    pub(super) signs: Combination,
    /// Whether each face is monotone along rays.
    pub(super) are_monotone: [bool; MOST],
    /// How wide the enclosure of a root may be.
    pub(super) tolerance: f64,
}

impl Roots {
    #[inline]
    pub(super) fn add(&mut self, root: Root) {
        self.0.push(root);
        let mut place = self.0.len() - 1;
        while place > 0 && self.0[place].hit.bracket.start < self.0[place - 1].hit.bracket.start {
            self.0.swap(place - 1, place);
            place -= 1;
        }
    }

    pub(super) fn in_order(&self) -> &[Root] {
        &self.0
    }
}

impl Signs<'_> {
    /// Goes on behind roots whose brackets overlap those of others. A face that bends may have both of its roots among them.
    pub(super) fn pass(&mut self, roots: &[Root]) -> Event {
        let known = self.signs;
        let before = self.made.sign(known);
        self.signs = roots.iter().fold(known, |signs, root| signs.with_other(root.face));
        // Where F begins or ends it is not zero.
        let is_other = self.made.sign(self.signs) * before < 0.0;
        // Where F is zero, one of those is that it may be.
        let met = || roots.iter().filter(|root| self.made.is_met(root.face));
        let Some(first) = met().next() else {
            return if is_other { Event::Unclear } else { Event::Nothing };
        };
        // What F comes to whatever signs these faces have, and if one alone has its own.
        let others = roots.iter().fold(known, |signs, root| signs.with(root.face, 0));
        if self.made.sign(others) != 0.0 {
            return Event::Nothing;
        }
        if self.made.may_be_nothing(known, roots.iter().map(|root| root.face)) {
            // It may be zero before it ends, or would be behind.
            return Event::Unclear;
        }
        if let [root] = roots {
            return if is_other { Event::Meeting(root.face, root.hit) } else { Event::Nothing };
        }
        let decides = |&&Root { face, .. }: &&Root| {
            let with = |sign| self.made.sign(others.with(face, sign));
            with(known.sign(face)) == before && with(-known.sign(face)) == -before
        };
        if let Some(root) = met().find(decides) {
            return Event::Meeting(root.face, root.hit);
        }
        let rises = |root: &Root| known.sign(root.face) < 0;
        let is_alike = |root: &Root| self.are_monotone[root.face] && rises(root) == rises(first);
        let is_simple = met().all(is_alike);
        let bracket = hull(roots);
        match (is_other, is_simple) {
            (true, true) if bracket.end - bracket.start <= self.tolerance => {
                Event::Meeting(first.face, Hit { bracket, ..first.hit })
            }
            (true, _) => Event::Unclear,
            // What is made of functions that all rise or all fall does so too, and has the same sign at both ends.
            (false, true) => Event::Nothing,
            (false, false) => Event::Contact,
        }
    }
}

/// What holds all brackets.
pub(super) fn hull(roots: &[Root]) -> Span {
    let brackets = roots.iter().map(|root| root.hit.bracket);
    let nothing = Span { start: f64::INFINITY, end: f64::NEG_INFINITY };
    brackets.fold(nothing, |hull, Span { start, end }| Span {
        start: if start < hull.start { start } else { hull.start },
        end: if end > hull.end { end } else { hull.end },
    })
}

/// How many of the first roots cannot be told apart.
pub(super) fn count_together(roots: &[Root]) -> usize {
    let is_apart = |count: &usize| hull(&roots[..*count]).end < roots[*count].hit.bracket.start;
    (1..roots.len()).find(is_apart).unwrap_or(roots.len())
}

#[cfg(test)]
mod tests {
    use iso_expr::Extreme;

    use super::*;
    use crate::certified::beams::made::Made;

    fn root(face: usize, start: f64, end: f64) -> Root {
        Root { face, hit: Hit { t: 0.5 * (start + end), bracket: Span { start, end } } }
    }

    fn of(extreme: Extreme, parts: impl IntoIterator<Item = Made>) -> Made {
        Made::Of(extreme, parts.into_iter().collect())
    }

    fn least(faces: impl IntoIterator<Item = usize>) -> Made {
        of(Extreme::Least, faces.into_iter().map(Made::Face))
    }

    fn greatest(faces: impl IntoIterator<Item = usize>) -> Made {
        of(Extreme::Greatest, faces.into_iter().map(Made::Face))
    }

    fn passed<const N: usize>(made: &Made, signs: [f64; N], roots: &[Root]) -> Event {
        let (made, are_monotone) = (&Combinations::new(made, MOST), std::array::from_fn(|face| face != 3));
        let signs: [f64; MOST] = std::array::from_fn(|face| signs.get(face).copied().unwrap_or(0.0));
        Signs { made, signs: Combination::of(&signs), are_monotone, tolerance: 0.5 }.pass(roots)
    }

    const POSITIVE: [f64; MOST] = [1.0; MOST];

    #[test]
    fn a_union_is_met_at_the_first_root_and_an_intersection_at_the_last() {
        let [first, second] = [root(0, 1.0, 1.1), root(1, 2.0, 2.1)];
        for (made, expected) in [(least([0, 1]), first), (greatest([0, 1]), second)] {
            let made = &Combinations::new(&made, MOST);
            let mut signs =
                Signs { made, signs: Combination::of(&POSITIVE), are_monotone: [true; MOST], tolerance: 0.5 };
            let found = [first, second].map(|root| signs.pass(&[root]));
            let meeting = Event::Meeting(expected.face, expected.hit);
            let meetings = found.into_iter().filter(|event| *event == meeting).count();
            assert_eq!(meetings, 1, "{found:?}");
            assert!(found.contains(&Event::Nothing));
        }
    }

    /// At a ridge or in a groove, where it cannot be told which face is met.
    #[test]
    fn roots_at_which_all_faces_fall_are_met_together() {
        let roots = [root(0, 1.0, 1.2), root(1, 1.1, 1.3)];
        for (made, bent) in [(least([0, 1]), least([0, 3])), (greatest([0, 1]), greatest([0, 3]))] {
            let Event::Meeting(_, hit) = passed(&made, POSITIVE, &roots) else { panic!("no meeting") };
            assert_eq!(hit.bracket, Span { start: 1.0, end: 1.3 });
            // Too far from each other to be one root, or of a face that may have turned.
            assert_eq!(passed(&made, POSITIVE, &[root(0, 1.0, 1.4), root(1, 1.3, 1.7)]), Event::Unclear);
            assert_eq!(passed(&bent, POSITIVE, &[root(0, 1.0, 1.2), root(3, 1.1, 1.3)]), Event::Unclear);
        }
    }

    #[test]
    fn a_body_without_thickness_is_a_contact() {
        let roots = [root(0, 1.0, 1.2), root(1, 1.1, 1.3)];
        assert_eq!(passed(&greatest([0, 1]), [1.0, -1.0], &roots), Event::Contact);
        // So is a gap without width, from inside.
        assert_eq!(passed(&least([0, 1]), [-1.0, 1.0], &roots), Event::Contact);
    }

    #[test]
    fn faces_that_decide_nothing_do_not_matter() {
        // A face of a part that is cut away rises where another part is met.
        let cut = || of(Extreme::Greatest, [Made::Face(1), Made::Face(2)]);
        let made = of(Extreme::Least, [Made::Face(0), cut()]);
        let roots = [root(0, 1.0, 1.2), root(1, 1.1, 1.3)];
        assert_eq!(passed(&made, [1.0, -1.0, 1.0], &roots), Event::Meeting(0, roots[0].hit));
        assert_eq!(passed(&cut(), [0.0, -1.0, 1.0], &[roots[1]]), Event::Nothing);
        let both = of(Extreme::Greatest, [least([0, 1]), Made::Face(2)]);
        assert_eq!(passed(&both, [1.0, -1.0, 1.0], &roots), Event::Nothing);
    }

    /// At the joint of a limb, where face 0 decides which of two others is that of the body.
    #[test]
    fn a_ray_meets_one_of_two_sides_and_never_what_decides() {
        let limb = Made::Choice(0, Box::new([Made::Face(1), Made::Face(2)]));
        let signs = [-1.0, 1.0, 1.0];
        let [by, below, above] = [root(0, 1.0, 1.2), root(1, 1.1, 1.3), root(2, 1.15, 1.25)];
        assert_eq!(passed(&limb, signs, &[by]), Event::Nothing);
        assert_eq!(passed(&limb, signs, &[below]), Event::Meeting(1, below.hit));
        assert_eq!(passed(&limb, signs, &[above]), Event::Nothing);
        // Where it cannot be told which comes first, the body is met once.
        let Event::Meeting(1, hit) = passed(&limb, signs, &[by, below, above]) else { panic!("no meeting") };
        assert_eq!(hit.bracket, Span { start: 1.0, end: 1.3 });
        // One side rises again beyond: not met.
        assert_eq!(passed(&limb, [-1.0, 1.0, -1.0], &[above]), Event::Nothing);
        // The sides change their signs in opposite ways, and what is between them is not known.
        assert_eq!(passed(&limb, [-1.0, 1.0, -1.0], &[by, below, above]), Event::Contact);
    }

    /// A surface, face 0, within a ball, face 1, along a ray that enters the ball and leaves it.
    #[test]
    fn what_is_cut_is_met_where_it_is_something() {
        let cut = |inside| Made::Within(Box::new([inside, Made::Face(0)]));
        let ball = cut(Made::Face(1));
        let [surface, edge] = [root(0, 2.0, 2.1), root(1, 3.0, 3.1)];
        for (inside, expected) in [(1.0, Event::Meeting(0, surface.hit)), (-1.0, Event::Nothing)] {
            assert_eq!(passed(&ball, [1.0, inside], &[surface]), expected);
            assert_eq!(passed(&ball, [1.0, inside], &[edge]), Event::Nothing);
            // Whether the surface or its edge comes first is not known, nor whether a ray that dips out meets it.
            let near = root(1, 2.05, 2.2);
            assert_eq!(passed(&ball, [1.0, inside], &[surface, near]), Event::Unclear);
            let again = root(1, 2.15, 2.3);
            assert_eq!(passed(&ball, [1.0, inside], &[surface, near, again]), Event::Unclear);
        }
        // Where the surface is its own margin it is zero at its end.
        assert_eq!(passed(&cut(Made::Face(0)), POSITIVE, &[surface]), Event::Unclear);
        // In the other one of two balls it is something whatever this one does.
        let balls = cut(of(Extreme::Greatest, [Made::Face(1), Made::Face(2)]));
        let roots = [surface, root(1, 2.05, 2.2)];
        assert_eq!(passed(&balls, [1.0, 1.0, 1.0], &roots), Event::Meeting(0, surface.hit));
    }

    /// The middle one of three falls to zero with two of them, and the third rises: in between it may have been zero before.
    #[test]
    fn what_several_faces_decide_together_is_unclear() {
        let middle = of(Extreme::Greatest, [least([0, 1]), least([1, 2]), least([0, 2])]);
        let roots = [root(0, 1.0, 1.2), root(1, 1.1, 1.3), root(2, 1.1, 1.2)];
        assert_eq!(passed(&middle, [1.0, 1.0, -1.0], &roots), Event::Unclear);
    }

    /// A narrow face dips below zero and rises again while another one falls somewhere around.
    #[test]
    fn a_face_that_has_both_of_its_roots_among_others_is_as_it_was_before() {
        let made = least([3]);
        let made = of(Extreme::Least, [of(Extreme::Greatest, [0, 1, 2].map(Made::Face)), made]);
        let made = &Combinations::new(&made, MOST);
        let are_monotone = std::array::from_fn(|face| face != 0);
        let mut signs = Signs { made, signs: Combination::of(&POSITIVE), are_monotone, tolerance: 0.5 };
        assert_eq!(signs.pass(&[root(0, 1.0, 1.1), root(1, 1.05, 1.35), root(0, 1.3, 1.4)]), Event::Nothing);
        assert_eq!([0, 1, 2, 3].map(|face| signs.signs.sign(face)), [1, -1, 1, 1]);
        assert_eq!(signs.pass(&[root(2, 1.6, 1.7)]), Event::Nothing, "the first face is positive still");
    }

    #[test]
    fn roots_are_kept_in_order() {
        let mut roots = Roots::default();
        let [a, b, c] = [root(2, 1.0, 1.2), root(0, 1.1, 1.15), root(1, 1.3, 1.4)];
        [c, a, b].into_iter().for_each(|root| roots.add(root));
        assert_eq!(roots.in_order(), [a, b, c]);
    }

    #[test]
    fn roots_are_taken_together_as_far_as_their_brackets_overlap() {
        let roots = [root(0, 1.0, 1.2), root(1, 1.1, 1.15), root(2, 1.2, 1.3), root(3, 1.31, 1.4)];
        assert_eq!(
            [count_together(&roots), count_together(&roots[1..]), count_together(&roots[3..])],
            [3, 1, 1]
        );
    }
}
