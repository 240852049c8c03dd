//! The functions of which a body is made by minima, maxima and choices, in any order, each smooth by itself. On a part most of them are of one sign.

use std::rc::Rc;
use std::sync::Arc;

use iso_expr::{Composition, Decorated, Decoration, Extreme, Interval};
use pulp::Simd;

use super::bend::Bend;
use super::bows::Bow;
use super::course::ways;
use super::form::{Form, Gradient};
use super::grazing::LARGE;
use super::made::{MOST, Made, deciding};
use super::packet::Packet;
use super::pixels::Pixels;
use super::subdivision::{Faces, Known, Part, Subdivision};
use crate::area::Area;
use crate::certified::kernels::{Kernels, bounds_between};
use crate::certified::side::side;
use crate::lanes::{Lanes, Row, parts};
use crate::{Kernel, Tile};

/// With more open ones on the way, no others are asked for: it is unlikely that those decide enough.
const TOO_MANY: usize = 8;

/// Of functions of more operations values are asked for first, which take much less time than gradients and most often tell a sign.
const LONG: u64 = 100;

/// One of the functions of which F is made, or F itself, where it may have roots, to first order.
pub(super) struct Outline {
    /// The number of its kernels.
    pub(super) kernels: u32,
    pub(super) form: Form,
    /// It and its gradient in the middle of the part.
    pub(super) jet: [Interval; 4],
}

/// The same to second order.
pub(super) struct Face {
    /// The number of its kernels.
    pub(super) kernels: u32,
    /// The function, or its negative: as `bow` has it.
    pub(super) bend: Bend,
    pub(super) bow: Bow,
}

impl Face {
    /// The signs of the function itself on all rays no more than `radii` columns and rows from those that are so many off the middle, where they
    /// are certain on a stretch, or else 0.
    #[inline(always)]
    pub(super) fn signs<S: Simd>(
        &self,
        middle: [Lanes<S>; 2],
        radii: [Lanes<S>; 2],
        stretch: [Lanes<S>; 2],
    ) -> Lanes<S> {
        let all = |number| middle[0].all_be(number);
        let course = self.bend.around(middle, radii);
        course.sign_between(ways(stretch, all(self.bend.t)), &self.bow) * all(self.bow.sign)
    }

    /// Rays that are to meet the face in what is wanted. Those on which its sign is known there are free.
    #[inline(always)]
    pub(super) fn met_by<S: Simd>(
        &self,
        simd: S,
        (area, tile): (Area, &Tile<'_>),
        (packet, wanted): (Packet, [Row; 2]),
        sought: Sought,
    ) -> Pixels {
        let mut pixels = Pixels::new(packet, packet.rays(simd, tile), wanted, &self.bow);
        for part in 0..parts::<S>() {
            let course = self.bend.at(packet.offsets((simd, part), area));
            let t = pixels.t(simd, part);
            let sign = match sought {
                Sought::Likely => Lanes::all(simd, 0.0),
                _ => course.sign_between(ways(pixels.wanted(simd, part), t), &self.bow),
            };
            let way = match sought {
                Sought::Second => course.way_to_second_root(&self.bow),
                _ => course.way_to_root(&self.bow),
            };
            pixels.begin((simd, part), &course, (sign, way), &self.bow);
        }
        if sought == Sought::Second {
            pixels.rise();
        }
        pixels
    }
}

/// Which root of a face is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sought {
    /// The first one, and there is likely to be one.
    Likely,
    /// The first one, if there is one.
    First,
    /// The second one of a face that bends, behind the root where it falls, or its negative: where that rises again.
    Second,
}

impl Subdivision<'_> {
    /// Follows each ray of a part on which F is made by minima and maxima of a few functions that each bend one way or are monotone; says
    /// whether it did.
    pub(super) fn follow_edge(&mut self, part: &Part) -> bool {
        if !self.is_fit(part) {
            return false;
        }
        let mut outlines = Vec::new();
        let Some(faces) = self.faces_of(part.kernels) else { return false };
        let is_union = matches!(*faces, Composition::Extreme(Extreme::Least, _));
        if self.size(part) > LARGE && !is_union {
            return false;
        }
        if matches!(*faces, Composition::Choice { .. }) && self.kernels(part.kernels).have_forms() {
            // Those hold across kinks inside a function, and say as much.
            return false;
        }
        match self.made_of_several(part, (part.kernels, &faces), &mut outlines) {
            Some(Made::Signed(_)) => true,
            Some(Made::Face(number)) => {
                self.follow_face(part, &outlines[number]);
                true
            }
            Some(made) if outlines.len() <= MOST && (self.size(part) <= LARGE || made.is_union()) => {
                let faces: Option<Vec<_>> = outlines.iter().map(|outline| self.face(part, outline)).collect();
                faces.is_some_and(|faces| self.follow_made(part, &faces, &made))
            }
            _ => false,
        }
    }

    /// Goes on with a part on which F has the sign of one function.
    fn follow_face(&mut self, part: &Part, outline: &Outline) {
        let part = Part { kernels: outline.kernels, form: outline.form, ..*part };
        let Some(part) = part.narrowed() else { return };
        if self.follow_even(&part) {
            return;
        }
        let face = self.face(&part, outline);
        if !face.is_some_and(|face| self.follow_smooth(&part, &face)) {
            let (lo, hi) = self.beam(part.beam).bounds_in_space(part.form.reach);
            let kernels = self.kernels(part.kernels).within(bounds_between(lo, hi));
            let kernels = self.number_of(Arc::new(kernels));
            self.divide(&Part { kernels, ..part });
        }
    }

    /// How the kernels of a number are made of others, if they have kinks.
    pub(super) fn faces_of(&mut self, kernels: u32) -> Option<Faces> {
        if let Known::Everywhere(known) | Known::OnSlab(known) = &self.faces[kernels as usize] {
            return known.clone();
        }
        let asked = Arc::clone(self.kernels(kernels));
        let is_made = asked.may_be_shortened() || asked.are_cut();
        let found = is_made.then(|| self.certified.places.composition(&asked)).flatten();
        // What simplifying cuts anew is followed as it is: there may be thousands of such cuts inside each other.
        let found = found
            .filter(|faces| !matches!(faces, Composition::Within { function, .. } if function.are_cut()));
        let found = found.map(|faces| Rc::new(faces.of_each(|face| self.number_of_face(face))));
        self.faces[kernels as usize] = Known::Everywhere(found.clone());
        found
    }

    /// The number of kernels of a function that others are made of, the same in all places: where F has its sign is said by a part, not by them.
    fn number_of_face(&mut self, face: &Arc<Kernels>) -> u32 {
        if let Some(number) = self.memory.numbers.get(&face.identity()) {
            return *number;
        }
        let number = self.number_of(Arc::clone(face));
        self.memory.numbers.insert(face.identity(), number);
        number
    }

    /// What a function with kinks comes to on a part, and the functions of which it is made there; `None` where it may be undefined.
    fn made_of_several(
        &mut self,
        part: &Part,
        (kernels, faces): (u32, &Composition<u32>),
        outlines: &mut Vec<Outline>,
    ) -> Option<Made> {
        match faces {
            Composition::Extreme(extreme, faces) => {
                self.made_of_extreme(part, kernels, (*extreme, faces), outlines)
            }
            Composition::Choice { by, below, above } => {
                self.made_of_sides(part, *by, [*below, *above], outlines)
            }
            Composition::Within { function, margin } => {
                self.made_within(part, (*function, *margin), outlines)
            }
        }
    }

    /// What one of two functions comes to on a part, by the sign of a third one.
    fn made_of_sides(
        &mut self,
        part: &Part,
        by: u32,
        [below, above]: [u32; 2],
        outlines: &mut Vec<Outline>,
    ) -> Option<Made> {
        let by = match self.made(part, by, outlines)? {
            Made::Signed(sign) => return self.made(part, if sign < 0.0 { below } else { above }, outlines),
            Made::Face(by) => by,
            Made::Of(..) | Made::Choice(..) | Made::Within(..) => return None,
        };
        let sides = [self.made(part, below, outlines)?, self.made(part, above, outlines)?];
        Some(match sides {
            [Made::Signed(below), Made::Signed(above)] if below == above => Made::Signed(below),
            sides => Made::Choice(by, Box::new(sides)),
        })
    }

    /// What a function comes to on a part where a margin is not negative. Nothing is met where it is.
    fn made_within(
        &mut self,
        part: &Part,
        (function, margin): (u32, u32),
        outlines: &mut Vec<Outline>,
    ) -> Option<Made> {
        let margin = match self.made(part, margin, outlines)? {
            Made::Signed(sign) if sign < 0.0 => return Some(Made::Signed(1.0)),
            Made::Signed(_) => return self.made(part, function, outlines),
            margin => margin,
        };
        Some(match self.made(part, function, outlines)? {
            Made::Signed(sign) => Made::Signed(sign),
            function => Made::Within(Box::new([margin, function])),
        })
    }

    /// What a minimum or a maximum comes to on a part.
    fn made_of_extreme(
        &mut self,
        part: &Part,
        kernels: u32,
        (extreme, numbers): (Extreme, &[u32]),
        outlines: &mut Vec<Outline>,
    ) -> Option<Made> {
        let before = outlines.len();
        let (mut parts, mut is_decided) = (Vec::new(), false);
        for number in numbers {
            match self.made(part, *number, outlines)? {
                Made::Signed(sign) => is_decided |= sign == deciding(extreme),
                made => parts.push(made),
            }
            // Where one of the others is undefined, so is the whole.
            if is_decided && self.kernels(kernels).are_defined_everywhere() {
                break;
            }
        }
        if is_decided {
            outlines.truncate(before);
            return Some(Made::Signed(deciding(extreme)));
        }
        Some(match parts.len() {
            0 => Made::Signed(-deciding(extreme)),
            1 => parts.swap_remove(0),
            _ => Made::Of(extreme, parts),
        })
    }

    /// What a function of which F is made comes to on a part. `None` as well where too many are open.
    fn made(&mut self, part: &Part, kernels: u32, outlines: &mut Vec<Outline>) -> Option<Made> {
        // Bodies that touch have faces in common.
        let is_same = |outline: &Outline| self.kernels(outline.kernels).are_alike(self.kernels(kernels));
        if let Some(known) = outlines.iter().position(is_same) {
            return Some(Made::Face(known));
        }
        match self.faces_of(kernels) {
            // What has no sign in some places tells nothing of what is made of it.
            Some(faces) if matches!(*faces, Composition::Within { .. }) => return None,
            Some(faces) => return self.made_of_several(part, (kernels, &faces), outlines),
            None => {}
        }
        let (t, center) = self.center(part);
        let bounds = self.beam(part.beam).bounds_in_space(part.form.reach);
        if self.kernels(kernels).operations(Kernel::Values) > LONG {
            let [value]: [Decorated; 1] = self.enclose_one(kernels, Kernel::ValueEnclosures, bounds)?;
            if value.decoration < Decoration::Defined {
                return None;
            }
            if let Some(side) = side(value.interval) {
                return Some(Made::Signed(side.sign()));
            }
        }
        let both = [(center, center), bounds];
        let [jet, over_all] = self.enclose_all(kernels, Kernel::GradientEnclosures, both)?;
        if over_all[0].decoration < Decoration::Defined {
            // Where one of its functions is undefined, it is so itself, whatever sign the others have.
            return None;
        }
        let jet = jet.map(|found| found.interval);
        let gradient = Gradient::new(over_all)?;
        let form = Form::new(self.beam(part.beam), part.form.reach, (t, center), jet[0], &gradient);
        if let Some(sign) = form.sign() {
            return Some(Made::Signed(sign));
        }
        outlines.push(Outline { kernels, form, jet });
        (outlines.len() <= TOO_MANY).then(|| Made::Face(outlines.len() - 1))
    }

    /// A function of which F is made, or F itself, to second order; `None` where it is not smooth, or neither bends one way nor is monotone.
    pub(super) fn face(&mut self, part: &Part, &Outline { kernels, form, jet }: &Outline) -> Option<Face> {
        let bend = self.expand(part, self.center(part), jet, kernels)?;
        let error = self.error_of_values(part, kernels)?;
        let bow = Bow::new((&bend, part.form.reach), form.slope, error, self.tolerance(part))?;
        let bend = if bow.sign < 0.0 { bend.negated() } else { bend };
        Some(Face { kernels, bend, bow })
    }
}
