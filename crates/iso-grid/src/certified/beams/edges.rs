//! Edges and seams of bodies: parts on which F is put together by minima and maxima of several functions, each smooth by itself.
//!
//! Along a ray each of the functions changes its sign at its roots, of which it has no more than two. Elsewhere F has the sign that the minima
//! and maxima of all signs have. So the ray meets the body at the first root behind which that is another one than before.

use iso_expr::Extreme;

use super::faces::{Face, MOST, Made};
use super::grazing::{BLOCK, DOUBTFUL};
use super::pixels::{End, Ended, Pixel, halves_from};
use super::subdivision::{Part, Subdivision};
use crate::area::Area;
use crate::{Hit, Span};

/// A ray of a part, and what is known of each face along it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    /// Which ray of the tile.
    place: usize,
    /// F is not zero before, and its first root lies before the end if it is known to have one.
    asked: Span,
    /// The number of the face that is asked for first.
    likely: usize,
    known: [Known; MOST],
}

/// What is known of a face along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Known {
    /// Nothing yet.
    Unasked,
    /// It has this sign at first, and changes it at these roots.
    Course { sign: f64, roots: [Option<Hit>; 2] },
    /// Not enough.
    Unclear,
}

impl Known {
    fn signed(sign: f64) -> Self {
        Self::Course { sign, roots: [None; 2] }
    }
}

/// What roots of faces mean that cannot be told apart.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Event {
    /// F is not zero there.
    Nothing,
    /// The ray meets the body.
    Meeting(Hit),
    /// F may be zero there, and has the same sign behind.
    Contact,
    /// F may be zero there, and too little is known of it.
    Unclear,
}

/// How the signs of faces change along a ray.
struct Signs<'a> {
    faces: &'a [Face],
    made: &'a Made,
    signs: [f64; MOST],
    /// How wide the enclosure of a root may be.
    tolerance: f64,
}

impl Meeting {
    /// Learns how the pursuit of a face ended, which is part of F as `of` says. Where F is no greater than the face, or no less, its first root
    /// cannot be behind one at which the face falls, or before it.
    fn learn(&mut self, number: usize, end: End, (of, tolerance): (Option<Extreme>, f64)) {
        self.known[number] = match (self.known[number], end) {
            (Known::Unasked, End::Free(sign)) => Known::signed(sign),
            (Known::Unasked, End::Hit(hit, sign)) => Known::Course { sign, roots: [Some(hit), None] },
            (Known::Course { sign, roots: [first, None] }, End::Hit(second, _)) => {
                Known::Course { sign, roots: [first, Some(second)] }
            }
            (known @ Known::Course { .. }, End::Free(_)) => known,
            _ => Known::Unclear,
        };
        if let Known::Course { sign: 1.0, roots: [Some(Hit { bracket, .. }), _] } = self.known[number] {
            match of {
                Some(Extreme::Least) => self.asked.end = self.asked.end.min(bracket.end + tolerance),
                Some(Extreme::Greatest) => self.asked.start = self.asked.start.max(bracket.start - tolerance),
                None => {}
            }
        }
    }

    /// The sign of each face at first, if it is known.
    fn signs(&self, faces: &[Face]) -> Option<[f64; MOST]> {
        let mut signs = [0.0; MOST];
        for (known, number) in self.known.iter().zip(0..faces.len()) {
            let Known::Course { sign, .. } = known else { return None };
            signs[number] = *sign;
        }
        Some(signs)
    }

    /// Puts the roots of faces in order, each with the number of its face.
    fn put_roots(&self, found: &mut Vec<(usize, Hit)>) {
        found.clear();
        for (number, known) in self.known.iter().enumerate() {
            if let Known::Course { roots, .. } = known {
                found.extend(roots.iter().flatten().map(|root| (number, *root)));
            }
        }
        if found.len() > 1 {
            found.sort_by(|(_, a), (_, b)| a.bracket.start.total_cmp(&b.bracket.start));
        }
    }
}

impl Signs<'_> {
    /// Goes on behind roots of faces whose brackets overlap.
    fn pass(&mut self, roots: &[(usize, Hit)]) -> Event {
        let (before, known) = (self.made.sign(&self.signs), self.signs);
        let rises = |(number, _): &(usize, Hit)| known[*number] < 0.0;
        roots.iter().for_each(|(number, _)| self.signs[*number] = -known[*number]);
        let is_other = self.made.sign(&self.signs) != before;
        if let [(_, hit)] = roots {
            return if is_other { Event::Meeting(*hit) } else { Event::Nothing };
        }
        // What F comes to whatever signs these faces have, and if one alone has its own.
        let mut others = known;
        roots.iter().for_each(|(number, _)| others[*number] = 0.0);
        if self.made.sign(&others) != 0.0 {
            return Event::Nothing;
        }
        let decides = |(number, _): &&(usize, Hit)| {
            let signs = [known[*number], -known[*number]].map(|sign| {
                let mut signs = others;
                signs[*number] = sign;
                self.made.sign(&signs)
            });
            signs == [before, -before]
        };
        if let Some((_, hit)) = roots.iter().find(decides) {
            return Event::Meeting(*hit);
        }
        let is_monotone = |(number, _): &(usize, Hit)| self.faces[*number].bow.is_monotone();
        let is_simple = roots.iter().all(|root| is_monotone(root) && rises(root) == rises(&roots[0]));
        let bracket = hull(roots);
        match (is_other, is_simple) {
            (true, true) if bracket.end - bracket.start <= self.tolerance => {
                Event::Meeting(Hit { bracket, ..roots[0].1 })
            }
            (true, _) => Event::Unclear,
            // What is made of functions that all rise or all fall does so too, and has the same sign at both ends.
            (false, true) => Event::Nothing,
            (false, false) => Event::Contact,
        }
    }
}

/// What holds all brackets.
fn hull(roots: &[(usize, Hit)]) -> Span {
    let start = roots.iter().map(|(_, hit)| hit.bracket.start).fold(f64::INFINITY, f64::min);
    let end = roots.iter().map(|(_, hit)| hit.bracket.end).fold(f64::NEG_INFINITY, f64::max);
    Span { start, end }
}

/// How many of the first roots cannot be told apart.
fn count_together(roots: &[(usize, Hit)]) -> usize {
    let is_apart = |count: &usize| hull(&roots[..*count]).end < roots[*count].1.bracket.start;
    (1..roots.len()).find(is_apart).unwrap_or(roots.len())
}

impl Subdivision<'_> {
    /// Follows each ray of a part on which F is made of these faces; says whether it did.
    pub(super) fn follow_made(&mut self, part: &Part, faces: &[Face], made: &Made) -> bool {
        let mut meetings = std::mem::take(&mut self.memory.meetings);
        meetings.clear();
        let is_followed = self.meet_faces(part, (faces, made), &mut meetings);
        if is_followed {
            // First the likely roots, so that others are asked for in what is left.
            for is_first in [true, false] {
                for (number, face) in faces.iter().enumerate() {
                    let is_asked = |meeting: &Meeting| (meeting.likely == number) == is_first;
                    self.pursue_face(
                        part,
                        (number, face, made.has_directly(number)),
                        &mut meetings,
                        is_asked,
                    );
                }
            }
            let mut roots = std::mem::take(&mut self.memory.roots);
            for meeting in &meetings {
                meeting.put_roots(&mut roots);
                self.end_at_faces(part, (faces, made), meeting, &roots);
            }
            self.memory.roots = roots;
        }
        self.memory.meetings = meetings;
        is_followed
    }

    /// Notes the rays of a part that may have a root; says whether not too many may be followed in vain.
    fn meet_faces(&self, part: &Part, (faces, made): (&[Face], &Made), meetings: &mut Vec<Meeting>) -> bool {
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

    /// Pursues a face, part of F as `of` says, along those rays that are to ask for it and do not know its sign.
    fn pursue_face(
        &mut self,
        part: &Part,
        (number, face, of): (usize, &Face, Option<Extreme>),
        meetings: &mut [Meeting],
        is_asked: impl Fn(&Meeting) -> bool,
    ) {
        let (area, reach) = (self.beam(part.beam).area, part.form.reach);
        let of = (of, self.tolerance(part));
        for is_second in [false, true] {
            // Behind a root at which a part of a union falls, F is negative.
            if is_second && (face.bow.is_monotone() || of.0 == Some(Extreme::Least)) {
                break;
            }
            let mut pixels = std::mem::take(&mut self.memory.bowed);
            pixels.clear();
            for (place, meeting) in meetings.iter_mut().enumerate().filter(|(_, meeting)| is_asked(meeting)) {
                let (column, row) = self.position(meeting.place);
                let ray = (place, self.tile.ray(column, row));
                pixels.extend(meeting.pixel(
                    (number, face),
                    area.offset(column, row),
                    (ray, reach),
                    is_second,
                ));
            }
            let mut ended = std::mem::take(&mut self.memory.ended);
            self.pursue(&mut pixels, face.kernels, &face.bow, &mut ended);
            for Ended { place, end } in ended.drain(..) {
                meetings[place].learn(number, end, of);
            }
            self.memory.ended = ended;
            self.memory.bowed = pixels;
        }
    }

    /// Ends a ray by what is known of faces along it, or goes on with it.
    fn end_at_faces(
        &mut self,
        part: &Part,
        (faces, made): (&[Face], &Made),
        meeting: &Meeting,
        roots: &[(usize, Hit)],
    ) {
        let Meeting { place, asked, .. } = *meeting;
        let Some(signs) = meeting.signs(faces) else {
            return self.settle(Ended { place, end: End::Lost(part.stretch) }, part.kernels);
        };
        let mut signs = Signs { faces, made, signs, tolerance: self.tolerance(part) };
        let (mut ahead, mut known_to) = (roots, asked.end);
        while !ahead.is_empty() && self.memory.open[place] {
            let (together, others) = ahead.split_at(count_together(ahead));
            ahead = others;
            let bracket = hull(together);
            if asked.end < bracket.start {
                break;
            }
            let end = match signs.pass(together) {
                _ if bracket.end < asked.start => continue,
                Event::Nothing => continue,
                Event::Meeting(hit) => End::Hit(hit, 0.0),
                Event::Contact => End::Lost(bracket),
                Event::Unclear => {
                    ahead = &[];
                    known_to = bracket.end;
                    End::Lost(bracket)
                }
            };
            self.settle(Ended { place, end }, part.kernels);
        }
        let rest = Span { start: known_to, end: part.stretch.end };
        if self.memory.open[place] && rest.start < rest.end {
            self.settle(Ended { place, end: End::Lost(rest) }, part.kernels);
        }
    }
}

impl Meeting {
    /// The ray as it is to meet a face, for the first time or the second, unless what is to be known is.
    fn pixel(
        &mut self,
        (number, face): (usize, &Face),
        at: (f64, f64),
        (ray, reach): ((usize, crate::Ray), Span),
        is_second: bool,
    ) -> Option<Pixel> {
        let course = face.bend.at(at.0, at.1);
        match (self.known[number], is_second) {
            (Known::Unasked, false) => {
                if let Some(sign) = face.sign(&course, self.asked) {
                    self.known[number] = Known::signed(sign);
                    return None;
                }
                Some(face.met_by(ray, at, [self.asked, reach]))
            }
            (Known::Course { sign, roots: [Some(first), None] }, true) if sign * face.bow.sign > 0.0 => {
                let behind = Span { start: first.bracket.end, end: self.asked.end };
                let may_rise = behind.start < behind.end && face.sign(&course, behind).is_none();
                may_rise.then(|| face.met_again_by(ray, at, [behind, reach]))
            }
            _ => None,
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
    (faces, made): (&[Face], &Made),
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
        let way = course.way_to_root(&face.bow);
        is_likely |= way.is_finite();
        // Of a union, the one that is met first decides, of an intersection the one that is met last.
        let order = if made.has_directly(number) == Some(Extreme::Greatest) { -way } else { way };
        if likely == usize::MAX || order < first {
            (likely, first) = (number, order);
        }
    }
    let known = |sign: f64| if sign == 0.0 { Known::Unasked } else { Known::signed(sign) };
    (made.sign(&signs) == 0.0).then(|| (Meeting { place, asked, likely, known: signs.map(known) }, is_likely))
}
