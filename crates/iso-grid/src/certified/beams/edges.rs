//! Edges and seams of bodies: parts on which F is put together by minima and maxima of several functions, each smooth by itself.
//!
//! Along a ray each of the functions changes its sign at its roots, of which it has no more than two. Elsewhere F has the sign that the minima
//! and maxima of all signs have. So the ray meets the body at the first root behind which that is another one than before.

use iso_expr::Extreme;

use super::faces::Face;
use super::grazing::{BLOCK, DOUBTFUL};
use super::made::{Combinations, MOST, Made};
use super::pixels::{End, Ended, Pixel, halves_from};
use super::subdivision::{Part, Subdivision};
use crate::area::Area;
use crate::{Hit, Outcome, Span};

/// Roots of faces that are no farther apart, as part of t, are as close as a few roundings bring them: a body that is so thin, or a gap, cannot be
/// told from a contact.
const CLOSE: f64 = 64.0 * f64::EPSILON;

/// A ray of a part on which F may be zero, and what is known of each face along it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    /// Which ray of the tile.
    place: usize,
    /// Before it F is not zero, and behind it nothing is asked for, since F has been zero there.
    asked: Span,
    /// The number of the face that is asked for first.
    likely: usize,
    /// The sign of each face at first, 0 before it is asked for.
    signs: [f64; MOST],
    /// Whether each face could be told that was asked for.
    is_clear: bool,
    roots: Roots,
}

/// Where faces change their signs along a ray, in order.
#[derive(Clone, Copy, Debug)]
struct Roots {
    all: [Root; 2 * MOST],
    count: usize,
}

/// Where a face changes its sign along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Root {
    /// The number of the face.
    face: usize,
    hit: Hit,
}

/// What roots of faces mean that cannot be told apart.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Event {
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
struct Signs<'a> {
    made: &'a Combinations,
    signs: [f64; MOST],
    /// Whether each face is monotone along rays.
    are_monotone: [bool; MOST],
    /// How wide the enclosure of a root may be.
    tolerance: f64,
}

impl Meeting {
    /// Asks no more for what cannot be the first root of F, where F is no greater than a face or no less, which has this root.
    fn narrow(&mut self, of: Option<Extreme>, (root, sign, tolerance): (Span, f64, f64)) {
        match of {
            Some(Extreme::Least) if sign > 0.0 => self.asked.end = self.asked.end.min(root.end + tolerance),
            Some(Extreme::Greatest) if sign > 0.0 => {
                self.asked.start = self.asked.start.max(root.start - tolerance);
            }
            _ => {}
        }
    }
}

/// None so far.
impl Default for Roots {
    fn default() -> Self {
        let none = Root { face: 0, hit: Hit { t: f64::NAN, bracket: Span::default() } };
        Self { all: [none; 2 * MOST], count: 0 }
    }
}

impl Roots {
    /// No face has more than two.
    fn add(&mut self, root: Root) {
        let mut place = self.count;
        while place > 0 && self.all[place - 1].hit.bracket.start > root.hit.bracket.start {
            self.all[place] = self.all[place - 1];
            place -= 1;
        }
        self.all[place] = root;
        self.count += 1;
    }

    fn in_order(&self) -> &[Root] {
        &self.all[..self.count]
    }
}

impl Signs<'_> {
    /// Goes on behind roots of faces whose brackets overlap.
    fn pass(&mut self, roots: &[Root]) -> Event {
        let (before, known) = (self.made.sign(&self.signs), self.signs);
        roots.iter().for_each(|root| self.signs[root.face] = -known[root.face]);
        let is_other = self.made.sign(&self.signs) != before;
        // Where F is zero, one of those is that it may be.
        let met = || roots.iter().filter(|root| self.made.is_met(root.face));
        let Some(first) = met().next() else {
            return if is_other { Event::Unclear } else { Event::Nothing };
        };
        if let [root] = roots {
            return if is_other { Event::Meeting(root.face, root.hit) } else { Event::Nothing };
        }
        // What F comes to whatever signs these faces have, and if one alone has its own.
        let mut others = known;
        roots.iter().for_each(|root| others[root.face] = 0.0);
        if self.made.sign(&others) != 0.0 {
            return Event::Nothing;
        }
        let decides = |root: &&Root| {
            let signs = [known[root.face], -known[root.face]].map(|sign| {
                let mut signs = others;
                signs[root.face] = sign;
                self.made.sign(&signs)
            });
            signs == [before, -before]
        };
        if let Some(root) = met().find(decides) {
            return Event::Meeting(root.face, root.hit);
        }
        let rises = |root: &Root| known[root.face] < 0.0;
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
fn hull(roots: &[Root]) -> Span {
    let start = roots.iter().map(|root| root.hit.bracket.start).fold(f64::INFINITY, f64::min);
    let end = roots.iter().map(|root| root.hit.bracket.end).fold(f64::NEG_INFINITY, f64::max);
    Span { start, end }
}

/// How many of the first roots cannot be told apart.
fn count_together(roots: &[Root]) -> usize {
    let is_apart = |count: &usize| hull(&roots[..*count]).end < roots[*count].hit.bracket.start;
    (1..roots.len()).find(is_apart).unwrap_or(roots.len())
}

impl Subdivision<'_> {
    /// Follows each ray of a part on which F is made of these faces; says whether it did.
    pub(super) fn follow_made(&mut self, part: &Part, faces: &[Face], made: &Made) -> bool {
        let made = &Combinations::new(made, faces.len());
        let mut meetings = std::mem::take(&mut self.memory.meetings);
        meetings.clear();
        let is_followed = self.meet_faces(part, (faces, made), &mut meetings);
        if is_followed {
            // First the likely roots, so that others are asked for in what is left.
            for is_first in [true, false] {
                for (number, face) in faces.iter().enumerate() {
                    let asked = (number, face, made.extreme_of(number));
                    self.pursue_face(part, asked, is_first, &mut meetings);
                }
            }
            for meeting in &meetings {
                if !meeting.is_clear {
                    self.search_one(self.position(meeting.place), part.stretch);
                } else if meeting.roots.count > 0 {
                    self.end_at_faces(part, (faces, made), meeting);
                }
            }
        }
        self.memory.meetings = meetings;
        is_followed
    }

    /// Notes the rays of a part that may have a root; says whether not too many may be followed in vain.
    fn meet_faces(
        &self,
        part: &Part,
        (faces, made): (&[Face], &Combinations),
        meetings: &mut Vec<Meeting>,
    ) -> bool {
        let (tolerance, reach) = (self.tolerance(part), part.form.reach);
        let Span { start, end } = part.stretch;
        // A little beyond the stretch, so that all is known around a root in it.
        let asked =
            Span { start: (start - tolerance).max(reach.start), end: (end + tolerance).min(reach.end) };
        let area = self.beam(part.beam).area;
        let mut doubtful = 0;
        for block in area.blocks(BLOCK) {
            if !self.is_open(block) {
                continue;
            }
            let of_block = signs_on(area, block, asked, faces);
            if made.sign(&of_block) != 0.0 {
                continue;
            }
            let (first_column, first_row) = area.offset(block.column, block.row);
            for (row, b) in block.rows().zip(halves_from(first_row)) {
                for (column, a) in block.columns().zip(halves_from(first_column)) {
                    let place = row * self.tile.width() + column;
                    if self.memory.open[place]
                        && let Some((meeting, is_likely)) =
                            meeting((faces, made), of_block, (a, b), (place, asked))
                    {
                        doubtful += usize::from(!is_likely);
                        meetings.push(meeting);
                    }
                }
            }
            if doubtful > DOUBTFUL {
                return false;
            }
        }
        true
    }

    /// Pursues a face, part of F as `of` says, along those rays that do not know its sign: those that are likely to meet it, or all others.
    fn pursue_face(
        &mut self,
        part: &Part,
        (number, face, of): (usize, &Face, Option<Extreme>),
        is_first: bool,
        meetings: &mut [Meeting],
    ) {
        let tolerance = self.tolerance(part);
        let mut pixels = std::mem::take(&mut self.memory.bowed);
        let mut ended = std::mem::take(&mut self.memory.ended);
        pixels.clear();
        self.ask_face(part, (number, face), is_first, (meetings, &mut pixels));
        self.pursue(&mut pixels, face.kernels, &face.bow, &mut ended);
        pixels.clear();
        for Ended { place, end } in ended.drain(..) {
            let meeting = &mut meetings[place];
            match end {
                End::Free(sign) => meeting.signs[number] = sign,
                End::Lost(_) => meeting.is_clear = false,
                End::Hit(hit, sign) => {
                    meeting.signs[number] = sign;
                    meeting.narrow(of, (hit.bracket, sign, tolerance));
                    meeting.roots.add(Root { face: number, hit });
                    // Behind a root at which a part of a union falls, F is negative.
                    let is_last = of == Some(Extreme::Least) && sign > 0.0;
                    if face.bow.turns_after(sign) && !is_last {
                        pixels.extend(self.again(part, face, (place, meeting), hit.bracket.end));
                    }
                }
            }
        }
        self.pursue(&mut pixels, face.kernels, &face.bow, &mut ended);
        for Ended { place, end } in ended.drain(..) {
            match end {
                End::Free(_) => {}
                End::Lost(_) => meetings[place].is_clear = false,
                End::Hit(hit, _) => meetings[place].roots.add(Root { face: number, hit }),
            }
        }
        self.memory.ended = ended;
        self.memory.bowed = pixels;
    }

    /// Puts the rays that are to meet a face of this number among the pixels. Of others the sign is known by now.
    fn ask_face(
        &self,
        part: &Part,
        (number, face): (usize, &Face),
        is_first: bool,
        (meetings, pixels): (&mut [Meeting], &mut Vec<Pixel>),
    ) {
        let (area, reach) = (self.beam(part.beam).area, part.form.reach);
        for (place, meeting) in meetings.iter_mut().enumerate() {
            if meeting.signs[number] != 0.0 || (meeting.likely == number) != is_first {
                continue;
            }
            let (column, row) = self.position(meeting.place);
            let (a, b) = area.offset(column, row);
            // The likely one was asked before.
            let sign = if is_first { None } else { face.sign(&face.bend.at(a, b), meeting.asked) };
            match sign {
                Some(sign) => meeting.signs[number] = sign,
                None => {
                    let ray = (place, self.tile.ray(column, row));
                    pixels.push(face.met_by(ray, (a, b), [meeting.asked, reach]));
                }
            }
        }
    }

    /// A ray that is to meet a face again behind its first root, if it may.
    fn again(
        &self,
        part: &Part,
        face: &Face,
        (place, meeting): (usize, &Meeting),
        start: f64,
    ) -> Option<Pixel> {
        let (column, row) = self.position(meeting.place);
        let (a, b) = self.beam(part.beam).area.offset(column, row);
        let behind = Span { start, end: meeting.asked.end };
        let may_turn = behind.start < behind.end && face.sign(&face.bend.at(a, b), behind).is_none();
        let ray = (place, self.tile.ray(column, row));
        may_turn.then(|| face.met_again_by(ray, (a, b), [behind, part.form.reach]))
    }

    /// Ends a ray by its roots of faces, in their order, or goes on with it.
    fn end_at_faces(
        &mut self,
        part: &Part,
        (faces, made): (&[Face], &Combinations),
        Meeting { place, asked, signs, roots, .. }: &Meeting,
    ) {
        let (place, mut roots, mut known_to) = (*place, roots.in_order(), asked.end);
        let mut are_monotone = [true; MOST];
        are_monotone.iter_mut().zip(faces).for_each(|(is, face)| *is = face.bow.is_monotone());
        let mut signs = Signs { made, signs: *signs, are_monotone, tolerance: self.tolerance(part) };
        while !roots.is_empty() && self.memory.open[place] {
            let (together, others) = roots.split_at(count_together(roots));
            roots = others;
            let bracket = hull(together);
            if asked.end < bracket.start {
                break;
            }
            match signs.pass(together) {
                _ if bracket.end < asked.start => {}
                Event::Nothing => {}
                Event::Meeting(face, hit) => return self.meet(place, hit, faces[face].kernels),
                Event::Contact if bracket.end - bracket.start <= CLOSE * bracket.end => {
                    let t = bracket.start + 0.5 * (bracket.end - bracket.start);
                    return self.end(place, Outcome::Touch(Hit { t, bracket }));
                }
                Event::Contact => self.search_one(self.position(place), bracket),
                Event::Unclear => {
                    roots = &[];
                    known_to = bracket.end;
                    self.search_one(self.position(place), bracket);
                }
            }
        }
        let rest = Span { start: known_to, end: part.stretch.end };
        if self.memory.open[place] && rest.start < rest.end {
            self.search_one(self.position(place), rest);
        }
    }
}

/// The signs of faces on all rays of a block of an area, 0 where they are not known.
fn signs_on(area: Area, block: Area, asked: Span, faces: &[Face]) -> [f64; MOST] {
    let [across, along] = block.radii();
    let (column, row) = area.offset(block.column, block.row);
    let mut signs = [0.0; MOST];
    for (sign, face) in signs.iter_mut().zip(faces) {
        let course = face.bend.around((column + across, row + along), block.radii());
        *sign = face.sign(&course, asked).unwrap_or(0.0);
    }
    signs
}

/// A ray that is so many columns and rows off the middle, where faces have signs that are known all over its block or not; and whether it is
/// likely to meet a face. `None` if it has no root.
fn meeting(
    (faces, made): (&[Face], &Combinations),
    of_block: [f64; MOST],
    (a, b): (f64, f64),
    (place, asked): (usize, Span),
) -> Option<(Meeting, bool)> {
    let (mut signs, mut is_likely) = (of_block, false);
    let (mut likely, mut first) = (usize::MAX, f64::INFINITY);
    for (number, face) in faces.iter().enumerate().filter(|(number, _)| of_block[*number] == 0.0) {
        let course = face.bend.at(a, b);
        if let Some(sign) = face.sign(&course, asked) {
            signs[number] = sign;
            continue;
        }
        if !made.is_met(number) {
            continue;
        }
        let way = course.way_to_root(&face.bow);
        is_likely |= way.is_finite();
        // Of a union, the one that is met first decides, of an intersection the one that is met last.
        let order = if made.extreme_of(number) == Some(Extreme::Greatest) { -way } else { way };
        if likely == usize::MAX || order < first {
            (likely, first) = (number, order);
        }
    }
    let meeting = Meeting { place, asked, likely, signs, is_clear: true, roots: Roots::default() };
    (made.sign(&signs) == 0.0).then_some((meeting, is_likely))
}

#[cfg(test)]
mod tests {
    use super::*;

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

    fn passed(made: &Made, signs: [f64; MOST], roots: &[Root]) -> Event {
        let made = &Combinations::new(made, MOST);
        Signs { made, signs, are_monotone: [true, true, true, false], tolerance: 0.5 }.pass(roots)
    }

    const POSITIVE: [f64; MOST] = [1.0; MOST];

    #[test]
    fn a_union_is_met_at_the_first_root_and_an_intersection_at_the_last() {
        let [first, second] = [root(0, 1.0, 1.1), root(1, 2.0, 2.1)];
        for (made, expected) in [(least([0, 1]), first), (greatest([0, 1]), second)] {
            let made = &Combinations::new(&made, MOST);
            let mut signs = Signs { made, signs: POSITIVE, are_monotone: [true; MOST], tolerance: 0.5 };
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
        assert_eq!(passed(&greatest([0, 1]), [1.0, -1.0, 0.0, 0.0], &roots), Event::Contact);
        // So is a gap without width, from inside.
        assert_eq!(passed(&least([0, 1]), [-1.0, 1.0, 0.0, 0.0], &roots), Event::Contact);
    }

    #[test]
    fn faces_that_decide_nothing_do_not_matter() {
        // A face of a part that is cut away rises where another part is met.
        let cut = || of(Extreme::Greatest, [Made::Face(1), Made::Face(2)]);
        let made = of(Extreme::Least, [Made::Face(0), cut()]);
        let roots = [root(0, 1.0, 1.2), root(1, 1.1, 1.3)];
        assert_eq!(passed(&made, [1.0, -1.0, 1.0, 0.0], &roots), Event::Meeting(0, roots[0].hit));
        assert_eq!(passed(&cut(), [0.0, -1.0, 1.0, 0.0], &[roots[1]]), Event::Nothing);
        let both = of(Extreme::Greatest, [least([0, 1]), Made::Face(2)]);
        assert_eq!(passed(&both, [1.0, -1.0, 1.0, 0.0], &roots), Event::Nothing);
    }

    /// At the joint of a limb, where face 0 decides which of two others is that of the body.
    #[test]
    fn a_ray_meets_one_of_two_sides_and_never_what_decides() {
        let limb = Made::Choice(0, Box::new([Made::Face(1), Made::Face(2)]));
        let signs = [-1.0, 1.0, 1.0, 0.0];
        let [by, below, above] = [root(0, 1.0, 1.2), root(1, 1.1, 1.3), root(2, 1.15, 1.25)];
        assert_eq!(passed(&limb, signs, &[by]), Event::Nothing);
        assert_eq!(passed(&limb, signs, &[below]), Event::Meeting(1, below.hit));
        assert_eq!(passed(&limb, signs, &[above]), Event::Nothing);
        // Where it cannot be told which comes first, the body is met once.
        let Event::Meeting(1, hit) = passed(&limb, signs, &[by, below, above]) else { panic!("no meeting") };
        assert_eq!(hit.bracket, Span { start: 1.0, end: 1.3 });
        // One side rises again beyond: not met.
        assert_eq!(passed(&limb, [-1.0, 1.0, -1.0, 0.0], &[above]), Event::Nothing);
        // The sides change their signs in opposite ways, and what is between them is not known.
        assert_eq!(passed(&limb, [-1.0, 1.0, -1.0, 0.0], &[by, below, above]), Event::Contact);
    }

    /// The middle one of three falls to zero with two of them, and the third rises: in between it may have been zero before.
    #[test]
    fn what_several_faces_decide_together_is_unclear() {
        let middle = of(Extreme::Greatest, [least([0, 1]), least([1, 2]), least([0, 2])]);
        let roots = [root(0, 1.0, 1.2), root(1, 1.1, 1.3), root(2, 1.1, 1.2)];
        assert_eq!(passed(&middle, [1.0, 1.0, -1.0, 0.0], &roots), Event::Unclear);
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
