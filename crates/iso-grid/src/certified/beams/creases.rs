//! Edges where faces of a body meet: parts on which F is the greatest of several functions, each smooth by itself.
//!
//! Where a ray comes from outside, F falls to zero with the function that does so last: a root of one function, at which it
//! falls, is the first root of F if all others are negative there, for before it F is no less than that function. If another one is
//! positive there, the root of F lies behind, where that one falls.

use iso_expr::Extreme;

use super::bend::Course;
use super::bows::ways;
use super::faces::{Face, MOST, undecided};
use super::grazing::{BLOCK, DOUBTFUL};
use super::pixels::{End, Ended, Pixel, halves_from};
use super::subdivision::{Part, Subdivision};
use crate::{Hit, Kernel, Span, Workspace};

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
    /// Follows each ray of a part on which F is the greatest of these faces; says whether it did.
    pub(super) fn follow_crease(&mut self, part: &Part, faces: &[Face]) -> bool {
        let Some(mut pixels) = self.start_on_faces(part, faces) else { return false };
        let mut ended = std::mem::take(&mut self.memory.ended);
        // A ray goes on from face to face, each time farther along; few go back to one.
        for _ in 0..faces.len() {
            for (number, face) in faces.iter().enumerate() {
                let mut on_face = std::mem::take(&mut pixels[number]);
                self.pursue(&mut on_face, face.kernels, &face.bow, &mut ended);
                for Ended { place, end } in ended.drain(..) {
                    match end {
                        End::Hit(hit) => self.go_on(part, faces, (place, number, hit), &mut pixels),
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

    /// The rays of a part that may have a root, by the face that each is likely to meet; `None` when too many may be followed in
    /// vain.
    fn start_on_faces(&mut self, part: &Part, faces: &[Face]) -> Option<Vec<Vec<Pixel>>> {
        let area = self.beam(part.beam).area;
        let mut pixels: Vec<Vec<Pixel>> = faces.iter().map(|_| Vec::new()).collect();
        let mut lost = Vec::new();
        let mut doubtful = 0;
        for block in area.blocks(BLOCK) {
            if !self.is_open(block) {
                continue;
            }
            let Some(undecided) = undecided(area, block, part, (Extreme::Greatest, faces)) else { continue };
            let (first_column, first_row) = area.offset(block.column, block.row);
            for (row, b) in block.rows().zip(halves_from(first_row)) {
                for (column, a) in block.columns().zip(halves_from(first_column)) {
                    let place = row * self.tile.width() + column;
                    if !self.memory.open[place] {
                        continue;
                    }
                    match likely((faces, undecided), (a, b), part.stretch) {
                        Likely::Nothing => {}
                        Likely::Unclear => lost.push(place),
                        Likely::Face(number, course, way) => {
                            let face = &faces[number];
                            let ways = ways(part.stretch, face.bend.t);
                            doubtful += usize::from(course.is_doubtful(way, ways, &face.bow));
                            let ray = self.tile.ray(column, row);
                            let spans = [part.stretch, part.form.reach];
                            pixels[number].push(face.met_by((place, ray), spans, (&course, way)));
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

    /// Ends a ray that meets the face of a number, or goes on with it to the next face.
    fn go_on(
        &mut self,
        part: &Part,
        faces: &[Face],
        (place, number, hit): (usize, usize, Hit),
        pixels: &mut [Vec<Pixel>],
    ) {
        match self.next(part, faces, (place, number, hit)) {
            Next::Nothing => {}
            Next::Meet => {
                self.settle(Ended { place, end: End::Hit(hit) }, part.kernels);
            }
            Next::Pursue(number) => {
                let wanted = Span { start: hit.bracket.start, end: part.stretch.end };
                pixels[number].push(self.on_face(part, &faces[number], place, wanted));
            }
            Next::Search => {
                // F is positive before the root, which is enclosed so closely that little is left to search around it.
                let behind = Span { start: hit.bracket.end, end: part.stretch.end };
                for stretch in [hit.bracket, behind] {
                    if self.memory.open[place] {
                        self.search_one(self.position(place), stretch, part.kernels);
                    }
                }
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
                let margin = margin + face.bow.error() + (end - start) * face.steepest;
                let value = self.value_at((column, row), hit.t, face.kernels);
                (value.abs() > margin).then(|| value.signum())
            });
            match sign {
                Some(sign) if sign < 0.0 => {}
                Some(_) if face.bow.rises() => return Next::Nothing,
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
        points.evaluate(kernels.over_points(Kernel::Values), scratch, 1)[0]
    }
}

/// What a ray is likely to meet.
enum Likely {
    /// It has no root in the part.
    Nothing,
    /// The face of this number, which is `Course` in the middle of the part, about so far from there.
    Face(usize, Course, f64),
    /// Faces do not tell.
    Unclear,
}

/// What a ray is likely to meet that is so many columns and rows off the middle: of those faces that are not known to be negative, the one
/// that falls to zero last.
fn likely((faces, undecided): (&[Face], [bool; MOST]), (a, b): (f64, f64), stretch: Span) -> Likely {
    let (mut last, mut farthest) = (Likely::Unclear, f64::NEG_INFINITY);
    let mut are_negative = true;
    for (number, face) in faces.iter().enumerate().filter(|(number, _)| undecided[*number]) {
        let course = face.bend.at(a, b);
        match face.sign(&course, stretch) {
            Some(sign) if sign > 0.0 => return Likely::Nothing,
            Some(_) => continue,
            None => are_negative = false,
        }
        let way = course.way_to_root(&face.bow);
        if !face.bow.rises() && way > farthest {
            (last, farthest) = (Likely::Face(number, course, way), way);
        }
    }
    if are_negative { Likely::Nothing } else { last }
}
