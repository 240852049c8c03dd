//! Edges and seams of bodies: parts on which F is put together by minima and maxima of several functions, each smooth by itself.
//!
//! Along a ray each of the functions changes its sign at its roots, of which it has no more than two. Elsewhere F has the sign that the minima
//! and maxima of all signs have. So the ray meets the body at the first root behind which that is another one than before.

use iso_expr::Extreme;
use pulp::{Simd, WithSimd};

use super::faces::{Face, Sought};
use super::grazing::DOUBTFUL;
use super::made::{Combination, Combinations, MOST, Made};
use super::packet::{OpenArea, Packet, Signed, for_all};
use super::pixels::{End, Pixels};
use super::signs::{Event, Root, Roots, Signs, count_together, hull};
use super::subdivision::{KnownAlong, Memory, Part, Subdivision};
use crate::area::Area;
use crate::lanes::{Lanes, ROW, Row, parts};
use crate::{Hit, Outcome, Span, Tile};

/// Roots of faces that are no farther apart, as part of t, are as close as a few roundings bring them: a body that is so thin, or a gap, cannot be
/// told from a contact.
const CLOSE: f64 = 64.0 * f64::EPSILON;

/// A ray of a part on which F may be zero, and what is known of each face along it.
#[derive(Clone, Debug)]
pub(crate) struct Meeting {
    /// The ray's column and row in the tile.
    position: (usize, usize),
    /// Before it F is not zero, and behind it nothing is asked for, since F has been zero there.
    asked: Span,
    /// The number of the face that is asked for first.
    likely: f64,
    /// The sign of each face at first, not known before it is asked for.
    signs: Combination,
    /// Whether each face could be told that was asked for.
    is_clear: bool,
    roots: Roots,
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

/// The search of a part for rays on which F may be zero.
struct Survey<'a> {
    rays: OpenArea<'a>,
    body: Body<'a>,
    packets: &'a mut Vec<Packet>,
    meetings: &'a mut Vec<Meeting>,
    /// Rays along which F is zero where one of the faces is, for each face.
    alone: &'a mut [Vec<Packet>; MOST],
}

/// What is made of faces, on a stretch.
struct Body<'a> {
    faces: &'a [Face],
    made: &'a Combinations,
    asked: Span,
}

impl Signed for Body<'_> {
    #[inline(always)]
    fn signs<S: Simd>(&self, simd: S, middle: &[Row; 2], radii: &[Row; 2]) -> Row {
        let asked = for_all(self.asked);
        let mut of_faces = [[0.0; ROW]; MOST];
        for (face, signs) in self.faces.iter().zip(&mut of_faces) {
            for part in 0..parts::<S>() {
                let at = |rows| Lanes::of_both(simd, rows, part);
                face.signs(at(middle), at(radii), at(&asked)).put(signs, part);
            }
        }
        self.made.of_rows(simd, &of_faces).map(|signs| self.made.sign(signs))
    }
}

impl WithSimd for Survey<'_> {
    /// Whether not too many rays may be followed in vain.
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        let Self { rays, body, packets, meetings, alone } = self;
        alone.iter_mut().for_each(Vec::clear);
        rays.pack(simd, &body, packets);
        let mut doubtful = 0.0;
        for packet in packets {
            let outlook = body.outlook(simd, packet, rays.area);
            let of_faces = body.made.of_rows(simd, &outlook.signs);
            for (lane, position) in packet.positions().enumerate() {
                let signs = of_faces[lane];
                if body.made.sign(signs) != 0.0 {
                    continue;
                }
                doubtful += 1.0 - outlook.is_likely[lane];
                if let Some(face) = body.made.face_alone(signs) {
                    packet.put_into(&mut alone[face], lane);
                } else {
                    meetings.push(Meeting {
                        position,
                        asked: body.asked,
                        likely: outlook.likely[lane],
                        signs,
                        is_clear: true,
                        roots: Roots::default(),
                    });
                }
            }
            if doubtful > DOUBTFUL {
                return false;
            }
        }
        true
    }
}

/// What is known of faces along rays side by side before any value is taken.
struct Outlook {
    /// The sign of each face, 0 where it is not known.
    signs: [Row; MOST],
    /// The number of the face that is likely to decide, and 1 where it is likely that any is met, or else 0.
    likely: Row,
    is_likely: Row,
}

impl Body<'_> {
    #[inline(always)]
    fn outlook<S: Simd>(&self, simd: S, packet: &Packet, area: Area) -> Outlook {
        let all = |number| Lanes::all(simd, number);
        let mut outlook =
            Outlook { signs: [[0.0; ROW]; MOST], likely: [f64::NAN; ROW], is_likely: [0.0; ROW] };
        for part in 0..parts::<S>() {
            let offsets = packet.offsets((simd, part), area);
            let asked = [all(self.asked.start), all(self.asked.end)];
            let (mut first, mut likely, mut is_likely) = (all(f64::NAN), all(f64::NAN), all(0.0));
            for (number, face) in self.faces.iter().enumerate() {
                let sign = face.signs(offsets, [all(0.0); 2], asked);
                sign.put(&mut outlook.signs[number], part);
                if !self.made.is_met(number) {
                    continue;
                }
                let is_open = sign.is_same(all(0.0));
                let way = face.bend.at(offsets).way_to_root(&face.bow);
                let is_there = is_open & way.abs().is_less(all(f64::INFINITY));
                is_likely = is_there.select(all(1.0), is_likely);
                // Of a union, the one that is met first decides, of an intersection the one that is met last.
                let is_last = self.made.extreme_of(number) == Some(Extreme::Greatest);
                let order = if is_last { -way } else { way };
                let is_first = is_open & !first.is_at_most(order);
                likely = is_first.select(all(number as f64), likely);
                first = is_first.select(order, first);
            }
            likely.put(&mut outlook.likely, part);
            is_likely.put(&mut outlook.is_likely, part);
        }
        outlook
    }
}

/// Rays that are to meet a face alone.
struct Alone<'a> {
    rays: (Area, &'a Tile<'a>),
    face: &'a Face,
    packets: &'a [Packet],
    asked: Span,
    pixels: &'a mut Vec<Pixels>,
}

impl WithSimd for Alone<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { rays, face, packets, asked, pixels } = self;
        pixels.clear();
        for packet in packets {
            pixels.push(face.met_by(simd, rays, (*packet, for_all(asked)), Sought::Likely));
        }
    }
}

/// Rays that are to meet a face.
struct Ask<'a> {
    rays: (Area, &'a Tile<'a>),
    face: &'a Face,
    sought: Sought,
    /// The numbers of their meetings, in order, and where they are to meet it.
    meetings: &'a [Meeting],
    asked: &'a [(usize, Span)],
    pixels: &'a mut Vec<Pixels>,
}

impl WithSimd for Ask<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { rays, face, sought, meetings, asked, pixels } = self;
        pixels.clear();
        for some in asked.chunks(ROW) {
            let (mut packet, mut wanted) = (Packet::default(), [[0.0; ROW]; 2]);
            for (lane, (number, Span { start, end })) in some.iter().enumerate() {
                packet.push(*number, meetings[*number].position);
                (wanted[0][lane], wanted[1][lane]) = (*start, *end);
            }
            pixels.push(face.met_by(simd, rays, (packet, wanted), sought));
        }
    }
}

impl Subdivision<'_> {
    /// Follows each ray of a part on which F is made of these faces; says whether it did.
    pub(super) fn follow_made(&mut self, part: &Part, faces: &[Face], made: &Made) -> bool {
        let made = &Combinations::new(made, faces.len());
        let mut meetings = std::mem::take(&mut self.memory.meetings);
        meetings.clear();
        let mut alone = std::mem::take(&mut self.memory.alone);
        let is_followed = self.meet_faces(part, (faces, made), (&mut meetings, &mut alone));
        if is_followed {
            for (face, packets) in faces.iter().zip(&alone) {
                self.follow_alone(part, face, packets);
            }
            // First the likely roots, so that others are asked for in what is left.
            for sought in [Sought::Likely, Sought::First] {
                for (number, face) in faces.iter().enumerate() {
                    let asked = (number, face, made.extreme_of(number));
                    self.pursue_face(part, asked, sought, &mut meetings);
                }
            }
            for meeting in &meetings {
                if !meeting.is_clear {
                    self.search_one(meeting.position, part.stretch, None);
                } else if !meeting.roots.in_order().is_empty() {
                    self.end_at_faces(part, (faces, made), meeting);
                }
            }
        }
        (self.memory.meetings, self.memory.alone) = (meetings, alone);
        is_followed
    }

    /// Notes the rays of a part that may have a root; says whether not too many may be followed in vain.
    fn meet_faces(
        &mut self,
        part: &Part,
        (faces, made): (&[Face], &Combinations),
        (meetings, alone): (&mut Vec<Meeting>, &mut [Vec<Packet>; MOST]),
    ) -> bool {
        let body = Body { faces, made, asked: self.asked(part) };
        let arch = self.workspace.arch;
        let Memory { beams, open, packets, .. } = &mut self.memory;
        let rays = OpenArea { area: beams[part.beam as usize].area, open };
        arch.dispatch(Survey { rays, body, packets, meetings, alone })
    }

    /// The stretch of a part, and a little more, so that all is known around a root in it.
    fn asked(&self, part: &Part) -> Span {
        let (tolerance, reach) = (self.tolerance(part), part.form.reach);
        let Span { start, end } = part.stretch;
        Span { start: (start - tolerance).max(reach.start), end: (end + tolerance).min(reach.end) }
    }

    /// Ends or goes on with rays that meet the body where they meet a face.
    fn follow_alone(&mut self, part: &Part, face: &Face, packets: &[Packet]) {
        if packets.is_empty() {
            return;
        }
        let mut pixels = std::mem::take(&mut self.memory.pixels);
        let rays = (self.beam(part.beam).area, &self.tile);
        let pixels_of = Alone { rays, face, packets, asked: self.asked(part), pixels: &mut pixels };
        self.workspace.arch.dispatch(pixels_of);
        self.pursue(&mut pixels, face.kernels, &face.bow);
        self.settle(&pixels, KnownAlong { kernels: face.kernels, span: self.asked(part) });
        self.memory.pixels = pixels;
    }

    /// Pursues a face, part of F as `of` says, along those rays that do not know its sign: those that are likely to meet it, or all others.
    fn pursue_face(
        &mut self,
        part: &Part,
        (number, face, of): (usize, &Face, Option<Extreme>),
        sought: Sought,
        meetings: &mut [Meeting],
    ) {
        let tolerance = self.tolerance(part);
        let mut asked = std::mem::take(&mut self.memory.asked);
        let mut pixels = std::mem::take(&mut self.memory.pixels);
        let is_asked = |meeting: &Meeting| {
            meeting.signs.sign(number) == 0 && (meeting.likely == number as f64) == (sought == Sought::Likely)
        };
        asked.clear();
        let each = meetings.iter().enumerate().filter(|(_, meeting)| is_asked(meeting));
        asked.extend(each.map(|(place, meeting)| (place, meeting.asked)));
        self.send(part, (face, sought), (meetings, &asked), &mut pixels);
        asked.clear();
        for (place, end) in pixels.iter().flat_map(Pixels::ends) {
            let meeting = &mut meetings[place];
            match end {
                End::Free(sign) => meeting.signs = meeting.signs.with(number, sign as i8),
                End::Lost(_) => meeting.is_clear = false,
                End::Hit(hit, sign) => {
                    meeting.signs = meeting.signs.with(number, sign as i8);
                    meeting.narrow(of, (hit.bracket, sign, tolerance));
                    meeting.roots.add(Root { face: number, hit });
                    // Behind a root at which a part of a union falls, F is negative.
                    let is_last = of == Some(Extreme::Least) && sign > 0.0;
                    let behind = Span { start: hit.bracket.end, end: meeting.asked.end };
                    if face.bow.turns_after(sign) && !is_last && behind.start < behind.end {
                        asked.push((place, behind));
                    }
                }
            }
        }
        self.send(part, (face, Sought::Second), (meetings, &asked), &mut pixels);
        for (place, end) in pixels.iter().flat_map(Pixels::ends) {
            match end {
                End::Free(_) => {}
                End::Lost(_) => meetings[place].is_clear = false,
                End::Hit(hit, _) => meetings[place].roots.add(Root { face: number, hit }),
            }
        }
        (self.memory.asked, self.memory.pixels) = (asked, pixels);
    }

    /// Sends rays that are asked for on their ways to a face, and ends them.
    fn send(
        &mut self,
        part: &Part,
        (face, sought): (&Face, Sought),
        (meetings, asked): (&[Meeting], &[(usize, Span)]),
        pixels: &mut Vec<Pixels>,
    ) {
        pixels.clear();
        if asked.is_empty() {
            return;
        }
        let rays = (self.beam(part.beam).area, &self.tile);
        self.workspace.arch.dispatch(Ask { rays, face, sought, meetings, asked, pixels });
        self.pursue(pixels, face.kernels, &face.bow);
    }

    /// Ends a ray by its roots of faces, in their order, or goes on with it.
    fn end_at_faces(
        &mut self,
        part: &Part,
        (faces, made): (&[Face], &Combinations),
        Meeting { position, asked, signs, roots, .. }: &Meeting,
    ) {
        let (column, row) = *position;
        let place = row * self.tile.width() + column;
        let (mut roots, mut known_to) = (roots.in_order(), asked.end);
        let mut are_monotone = [true; MOST];
        are_monotone.iter_mut().zip(faces).for_each(|(is, face)| *is = face.bow.is_monotone());
        let mut signs = Signs { made, signs: *signs, are_monotone, tolerance: self.tolerance(part) };
        while !roots.is_empty() && self.memory.open.holds(place) {
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
                Event::Contact => self.search_one(*position, bracket, None),
                Event::Unclear => {
                    roots = &[];
                    known_to = bracket.end;
                    self.search_one(*position, bracket, None);
                }
            }
        }
        let rest = Span { start: known_to, end: part.stretch.end };
        if self.memory.open.holds(place) && rest.start < rest.end {
            self.search_one(*position, rest, None);
        }
    }
}
