//! Edges of bodies: parts on which F is the least or the greatest of several functions, each smooth by itself.
//!
//! A body may be put together by minima and maxima in any order. On a part most of its functions are of one sign, and what is left
//! of the others is often a minimum or a maximum alone.

use iso_expr::{Decoration, Extreme};

use super::bend::{Bend, Course};
use super::bows::{Bow, ways};
use super::form::{Form, Gradient};
use super::pixels::Pixel;
use super::subdivision::{Part, Subdivision};
use crate::area::Area;
use crate::{Kernel, Ray, Span};

/// More functions are left to smaller parts, where fewer of them matter.
pub(super) const MOST: usize = 4;

/// One of the functions of which F is the least or the greatest, where it may have roots.
pub(super) struct Face {
    /// The number of its kernels.
    pub(super) kernels: u32,
    /// To second order, or its negative: as `bow` has it.
    pub(super) bend: Bend,
    pub(super) bow: Bow,
    /// What no slope along a ray exceeds.
    pub(super) steepest: f64,
}

impl Face {
    /// The sign of the function itself where that is certain on a stretch of a ray on which it is `course`.
    #[inline]
    pub(super) fn sign(&self, course: &Course, stretch: Span) -> Option<f64> {
        course.sign_between(ways(stretch, self.bend.t), &self.bow).map(|sign| sign * self.bow.sign)
    }

    /// A ray on which the function is `course`, and which is to meet it in what is wanted, about so far from the middle of the part.
    #[inline]
    pub(super) fn met_by(
        &self,
        ray: (usize, Ray),
        [wanted, reach]: [Span; 2],
        (course, way): (&Course, f64),
    ) -> Pixel {
        let mut pixel = Pixel::starting(ray, [wanted, reach], course, &self.bow);
        if way.is_finite() {
            pixel.t = (pixel.t + way).max(reach.start).min(reach.end);
        }
        pixel
    }
}

/// What F, or a function of which it is made, comes to on a part.
enum Made {
    /// It is of this sign everywhere.
    Signed(f64),
    /// It is zero where the least or the greatest of these is, and of the same sign elsewhere.
    Of(Extreme, Vec<Face>),
}

/// The sign that F has where any of its functions has it.
fn deciding(extreme: Extreme) -> f64 {
    match extreme {
        Extreme::Least => -1.0,
        Extreme::Greatest => 1.0,
    }
}

impl Subdivision<'_> {
    /// Follows each ray of a part on which F is the least or the greatest of a few functions that each bend upwards or are monotone;
    /// says whether it did.
    pub(super) fn follow_edge(&mut self, part: &Part) -> bool {
        if !self.is_fit(part) {
            return false;
        }
        match self.made_of_several(part, part.kernels) {
            Some(Made::Signed(_)) => true,
            Some(Made::Of(Extreme::Least, faces)) => self.follow_seam(part, &faces),
            Some(Made::Of(Extreme::Greatest, faces)) => self.follow_crease(part, &faces),
            None => false,
        }
    }

    /// The numbers of the kernels of which those of a number are the least or the greatest, if they are.
    fn faces_of(&mut self, kernels: u32) -> Option<(Extreme, Vec<u32>)> {
        if !self.kernels(kernels).may_be_shortened() {
            return None;
        }
        if let Some(known) = self.faces.get(&kernels) {
            return known.clone();
        }
        let found = self.certified.places.faces(self.kernels(kernels));
        let found = found
            .map(|(extreme, faces)| (extreme, faces.into_iter().map(|face| self.number_of(face)).collect()));
        self.faces.insert(kernels, found.clone());
        found
    }

    /// What a minimum or a maximum comes to on a part; `None` if it is neither, or faces of it are not smooth or too many, or both
    /// minima and maxima are left.
    fn made_of_several(&mut self, part: &Part, kernels: u32) -> Option<Made> {
        let (extreme, numbers) = self.faces_of(kernels)?;
        let (mut faces, mut other) = (Vec::new(), None);
        for number in numbers {
            match self.made(part, number) {
                Some(Made::Signed(sign)) if sign == deciding(extreme) => return Some(Made::Signed(sign)),
                Some(Made::Signed(_)) => {}
                Some(Made::Of(of, found)) if of == extreme || found.len() == 1 => faces.extend(found),
                Some(mixed) if other.is_none() => other = Some(mixed),
                _ => return None,
            }
            if faces.len() > MOST {
                return None;
            }
        }
        match other {
            Some(_) if !faces.is_empty() => None,
            None if faces.is_empty() => Some(Made::Signed(-deciding(extreme))),
            Some(other) => Some(other),
            None => Some(Made::Of(extreme, faces)),
        }
    }

    /// What a function of which F is made comes to on a part: a face if it is smooth.
    fn made(&mut self, part: &Part, kernels: u32) -> Option<Made> {
        let (t, center) = self.center(part);
        let bounds = self.beam(part.beam).bounds_in_space(part.form.reach);
        let both = [(center, center), bounds];
        let [jet, over_all] = self.enclose_all(kernels, Kernel::GradientEnclosures, both)?;
        if over_all[0].decoration < Decoration::Defined {
            // Where one of its functions is undefined, it is so itself, whatever sign the others have.
            return None;
        }
        let jet = jet.map(|found| found.interval);
        if let Some(gradient) = Gradient::new(over_all) {
            let form = Form::new(self.beam(part.beam), part.form.reach, (t, center), jet[0], &gradient);
            if let Some(sign) = form.sign() {
                return Some(Made::Signed(sign));
            }
            if let Some(bend) = self.expand(part, (t, center), jet, kernels) {
                let error = self.error_of_values(part, kernels)?;
                let bow = Bow::new(&bend, form.slope, error, self.tolerance(part))?.falling()?;
                let bend = if bow.sign < 0.0 { bend.negated() } else { bend };
                let face = Face { kernels, bend, bow, steepest: form.slope.magnitude() };
                return Some(Made::Of(Extreme::Least, vec![face]));
            }
        }
        self.made_of_several(part, kernels)
    }

    /// A ray that is to meet a face in a stretch.
    pub(super) fn on_face(&self, part: &Part, face: &Face, place: usize, wanted: Span) -> Pixel {
        let (column, row) = self.position(place);
        let (a, b) = self.beam(part.beam).area.offset(column, row);
        let course = face.bend.at(a, b);
        let way = course.way_to_root(&face.bow);
        face.met_by((place, self.tile.ray(column, row)), [wanted, part.form.reach], (&course, way))
    }
}

/// Which faces of a part may have either sign on rays of a block of an area; `None` when none of these rays has a root there.
pub(super) fn undecided(
    area: Area,
    block: Area,
    part: &Part,
    (extreme, faces): (Extreme, &[Face]),
) -> Option<[bool; MOST]> {
    let [across, along] = block.radii();
    let (column, row) = area.offset(block.column, block.row);
    let mut are_undecided = [false; MOST];
    for (face, is_undecided) in faces.iter().zip(&mut are_undecided) {
        let course = face.bend.around((column + across, row + along), block.radii());
        match face.sign(&course, part.stretch) {
            Some(sign) if sign == deciding(extreme) => return None,
            Some(_) => {}
            None => *is_undecided = true,
        }
    }
    are_undecided.contains(&true).then_some(are_undecided)
}
