//! Edges of bodies: parts on which F is the greatest of several functions, each smooth by itself.
//!
//! Where a ray comes from outside, F falls to zero with the function that does so last: a root of one function, at which it
//! falls, is the first root of F if all others are negative there, for before it F is no less than that function. If another one is
//! positive there, the root of F lies behind, where that one falls.

use std::ops::ControlFlow;

use super::arcs::{Arc, Bowed, ways};
use super::area::Area;
use super::bend::{Bend, Course};
use super::form::{Form, Gradient};
use super::grazing::{BLOCK, DOUBTFUL};
use super::pixels::{End, Ended, Pixel, halves_from};
use super::subdivision::{Part, Subdivision, enclose_one};
use crate::{Hit, Kernel, Span, Workspace};

/// More functions are left to smaller parts, where fewer of them matter.
const MOST: usize = 4;

/// One of the functions of which F is the greatest, where it may have roots.
struct Face {
    /// The number of its kernels.
    kernels: u32,
    /// To second order, or its negative: as `arc` has it.
    bend: Bend,
    arc: Arc,
    /// What no slope along a ray exceeds.
    steepest: f64,
}

impl Face {
    /// The sign of the function itself where that is certain on a stretch of a ray on which it is `course`.
    #[inline]
    fn sign(&self, course: &Course, stretch: Span) -> Option<f64> {
        course.sign_between(ways(stretch, self.bend.t), &self.arc).map(|sign| sign * self.arc.sign)
    }
}

/// What a ray is to do next.
enum Next {
    /// It has no root in the part.
    Nothing,
    /// It meets the body.
    Meet,
    /// The face of this number may be the one it meets.
    Pursue(usize),
    /// Faces do not tell.
    Search,
}

impl Subdivision<'_> {
    /// Follows each ray of a part on which F is the greatest of a few functions that each bend upwards or are monotone; says whether
    /// it did.
    pub(super) fn follow_crease(&mut self, part: &Part) -> bool {
        if !self.is_fit(part) {
            return false;
        }
        let numbers = self.faces_of(part.kernels);
        if numbers.is_empty() {
            return false;
        }
        let faces = match self.faces(part, &numbers) {
            ControlFlow::Continue(faces) => faces,
            ControlFlow::Break(is_done) => return is_done,
        };
        let Some(mut pixels) = self.start_on_faces(part, &faces) else { return false };
        let mut ended = std::mem::take(&mut self.memory.ended);
        // A ray goes on from face to face, each time farther along; few go back to one.
        for _ in 0..faces.len() {
            for (number, face) in faces.iter().enumerate() {
                let mut on_face = std::mem::take(&mut pixels[number]);
                self.pursue(&mut on_face, face.kernels, &face.arc, &mut ended);
                for Ended { place, end } in ended.drain(..) {
                    match end {
                        End::Hit(hit) => self.go_on(part, &faces, (place, number, hit), &mut pixels),
                        End::Lost(_) => self.settle(Ended { place, end }, part.kernels),
                    }
                }
            }
        }
        self.memory.ended = ended;
        for Pixel { place, wanted, .. } in pixels.into_iter().flatten() {
            self.settle(Ended { place, end: End::Lost(wanted) }, part.kernels);
        }
        true
    }

    /// The numbers of the kernels of which those of a number are the greatest; empty if they are no maximum.
    fn faces_of(&mut self, kernels: u32) -> Vec<u32> {
        if !self.kernels(kernels).may_be_shortened() {
            return Vec::new();
        }
        if let Some(known) = self.faces.get(&kernels) {
            return known.clone();
        }
        let found = self.certified.places.faces(self.kernels(kernels));
        let numbers: Vec<u32> = found.into_iter().map(|face| self.number_of(face)).collect();
        self.faces.insert(kernels, numbers.clone());
        numbers
    }

    /// The faces that may be zero in a part. Breaks with whether the part is done with: where one is positive everywhere, or all are
    /// negative, F has no root; and nothing is known where one is not smooth, or there are too many.
    fn faces(&mut self, part: &Part, numbers: &[u32]) -> ControlFlow<bool, Vec<Face>> {
        let (t, center) = self.center(part);
        let reach = part.form.reach;
        let mut faces = Vec::new();
        for &number in numbers {
            let jet = self.jet_at(center, number);
            let gradient = self.gradient_over(part, number);
            let Some(gradient) = gradient else { return ControlFlow::Break(false) };
            let form = Form::new(self.beam(part.beam), reach, (t, center), jet[0], &gradient);
            match form.sign() {
                Some(sign) if sign > 0.0 => return ControlFlow::Break(true),
                Some(_) => continue,
                None => {}
            }
            let face = self.expand(part, (t, center), jet, number).and_then(|bend| {
                let error = self.error_of_values(part, number)?;
                let arc = Arc::new(&bend, form.slope, error, self.tolerance(part))?.falling()?;
                let bend = if arc.sign < 0.0 { bend.negated() } else { bend };
                Some(Face { kernels: number, bend, arc, steepest: form.slope.magnitude() })
            });
            faces.extend(face);
            if faces.len() > MOST || faces.last().is_none_or(|face| face.kernels != number) {
                return ControlFlow::Break(false);
            }
        }
        if faces.is_empty() { ControlFlow::Break(true) } else { ControlFlow::Continue(faces) }
    }

    /// The gradients of a function over a part, where it is smooth.
    fn gradient_over(&mut self, part: &Part, kernels: u32) -> Option<Gradient> {
        let bounds = self.beam(part.beam).bounds_in_space(part.form.reach);
        let kernels = &self.kernels[kernels as usize];
        let kernel = (Kernel::GradientEnclosures, kernels.gradients());
        Gradient::new(enclose_one(self.workspace, kernels, kernel, bounds))
    }

    /// The rays of a part that may have a root, by the face that each is likely to meet; `None` when too many may be followed in
    /// vain.
    fn start_on_faces(&mut self, part: &Part, faces: &[Face]) -> Option<Vec<Vec<Pixel<Bowed>>>> {
        let area = self.beam(part.beam).area;
        let mut pixels: Vec<Vec<Pixel<Bowed>>> = faces.iter().map(|_| Vec::new()).collect();
        let mut lost = Vec::new();
        let mut doubtful = 0;
        for block in area.blocks(BLOCK) {
            if !self.is_open(block) || Self::is_free(area, block, part, faces) {
                continue;
            }
            let (first_column, first_row) = area.offset(block.column, block.row);
            for (row, b) in block.rows().zip(halves_from(first_row)) {
                for (column, a) in block.columns().zip(halves_from(first_column)) {
                    let place = row * self.tile.width() + column;
                    if !self.memory.open[place] {
                        continue;
                    }
                    match likely(faces, (a, b), part.stretch) {
                        Next::Nothing => {}
                        Next::Search | Next::Meet => lost.push(place),
                        Next::Pursue(number) => {
                            let (pixel, is_doubtful) =
                                self.on_face(part, &faces[number], place, part.stretch);
                            doubtful += usize::from(is_doubtful);
                            pixels[number].push(pixel);
                        }
                    }
                    if doubtful + lost.len() > DOUBTFUL {
                        return None;
                    }
                }
            }
        }
        for place in lost {
            self.settle(Ended { place, end: End::Lost(part.stretch) }, part.kernels);
        }
        Some(pixels)
    }

    /// Whether no ray of a block of an area has a root in a part.
    fn is_free(area: Area, block: Area, part: &Part, faces: &[Face]) -> bool {
        let [across, along] = block.radii();
        let (column, row) = area.offset(block.column, block.row);
        let mut are_negative = true;
        for face in faces {
            let course = face.bend.around((column + across, row + along), block.radii());
            match face.sign(&course, part.stretch) {
                Some(sign) if sign > 0.0 => return true,
                Some(_) => {}
                None => are_negative = false,
            }
        }
        are_negative
    }

    /// A ray that is to meet a face in a stretch, and whether that is doubtful.
    fn on_face(&self, part: &Part, face: &Face, place: usize, wanted: Span) -> (Pixel<Bowed>, bool) {
        let (column, row) = self.position(place);
        let (a, b) = self.beam(part.beam).area.offset(column, row);
        let course = face.bend.at(a, b);
        let ray = self.tile.ray(column, row);
        let reach = part.form.reach;
        let mut pixel = Pixel::starting((place, ray), [wanted, reach], &course, &face.arc);
        let way = course.way_to_root(&face.arc);
        if way.is_finite() {
            pixel.t = (pixel.t + way).max(reach.start).min(reach.end);
        }
        (pixel, course.is_doubtful(way, ways(wanted, face.bend.t), &face.arc))
    }

    /// Ends a ray that meets the face of a number, or goes on with it to the next face.
    fn go_on(
        &mut self,
        part: &Part,
        faces: &[Face],
        (place, number, hit): (usize, usize, Hit),
        pixels: &mut [Vec<Pixel<Bowed>>],
    ) {
        match self.next(part, faces, (place, number, hit)) {
            Next::Nothing => {}
            Next::Meet => {
                self.settle(Ended { place, end: End::Hit(hit) }, part.kernels);
            }
            Next::Pursue(number) => {
                let wanted = Span { start: hit.bracket.start, end: part.stretch.end };
                pixels[number].push(self.on_face(part, &faces[number], place, wanted).0);
            }
            Next::Search => {
                self.settle(Ended { place, end: End::Lost(part.stretch) }, part.kernels);
            }
        }
    }

    /// What is next after a root of the face of a number.
    fn next(&mut self, part: &Part, faces: &[Face], (place, number, hit): (usize, usize, Hit)) -> Next {
        let (column, row) = self.position(place);
        let (a, b) = self.beam(part.beam).area.offset(column, row);
        let Span { start, end } = hit.bracket;
        for (other, face) in faces.iter().enumerate() {
            if other == number {
                continue;
            }
            // All over the bracket the other face is to be below this one, too.
            let margin = (end - start) * faces[number].steepest;
            let mut course = face.bend.at(a, b);
            course.value_error += margin;
            let sign = face.sign(&course, hit.bracket).or_else(|| {
                let margin = margin + face.arc.error() + (end - start) * face.steepest;
                let value = self.value_at((column, row), hit.t, face.kernels);
                (value.abs() > margin).then(|| value.signum())
            });
            match sign {
                Some(sign) if sign < 0.0 => {}
                Some(_) if face.arc.rises() => return Next::Nothing,
                Some(_) => return Next::Pursue(other),
                None => return Next::Search,
            }
        }
        Next::Meet
    }

    /// What kernels of this number compute on a ray.
    fn value_at(&mut self, (column, row): (usize, usize), t: f64, kernels: u32) -> f64 {
        let ray = self.tile.ray(column, row);
        let kernels = &self.kernels[kernels as usize];
        let Workspace { points, scratch, counters, .. } = &mut *self.workspace;
        points.replace(std::iter::once((&ray, t)));
        counters.trace_evaluations += 1;
        counters.operations += kernels.charge(Kernel::Values, 1);
        points.evaluate(kernels.points(), scratch, 1)[0]
    }
}

/// What a ray is likely to meet that is so many columns and rows off the middle: the face that falls to zero last.
fn likely(faces: &[Face], (a, b): (f64, f64), stretch: Span) -> Next {
    let (mut last, mut farthest) = (None, f64::NEG_INFINITY);
    let mut are_negative = true;
    for (number, face) in faces.iter().enumerate() {
        let course = face.bend.at(a, b);
        match face.sign(&course, stretch) {
            Some(sign) if sign > 0.0 => return Next::Nothing,
            Some(_) => continue,
            None => are_negative = false,
        }
        let way = course.way_to_root(&face.arc);
        if !face.arc.rises() && way > farthest {
            (last, farthest) = (Some(number), way);
        }
    }
    match last {
        _ if are_negative => Next::Nothing,
        Some(number) => Next::Pursue(number),
        None => Next::Search,
    }
}
