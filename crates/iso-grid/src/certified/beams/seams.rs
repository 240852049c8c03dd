//! Seams of unions: parts on which F is the least of several functions, each smooth by itself.
//!
//! Where a ray comes from outside, all functions are positive, and F falls to zero with the one that does so first: its root is the
//! first root of F if all others are positive up to there.

use iso_expr::Extreme;

use super::faces::{Face, MOST, undecided};
use super::grazing::{BLOCK, DOUBTFUL};
use super::pixels::{End, Ended, halves_from};
use super::subdivision::{Part, Subdivision};
use crate::{Hit, Span};

/// A ray of a part, and what is known of its first root so far.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Approach {
    /// Which ray of the tile.
    place: usize,
    /// The number of the face that it is likely to meet.
    likely: usize,
    found: Found,
}

/// The first root of the faces that were asked.
#[derive(Clone, Copy, Debug)]
enum Found {
    /// They have none.
    Nothing,
    Hit(Hit),
    /// They do not tell.
    Unclear,
}

impl Approach {
    /// Where a root of another face would come first.
    fn wanted(&self, Span { start, end }: Span) -> Span {
        match self.found {
            Found::Hit(hit) => Span { start, end: hit.bracket.end },
            Found::Nothing | Found::Unclear => Span { start, end },
        }
    }

    /// Learns how the pursuit of a face ended. Of two roots the first one is in neither's bracket behind the other's end.
    fn learn(&mut self, end: End) {
        self.found = match (self.found, end) {
            (Found::Nothing, End::Hit(hit)) => Found::Hit(hit),
            (Found::Hit(known), End::Hit(hit)) => {
                let start = known.bracket.start.min(hit.bracket.start);
                let end = known.bracket.end.min(hit.bracket.end);
                Found::Hit(Hit { t: known.t.min(hit.t).min(end), bracket: Span { start, end } })
            }
            _ => Found::Unclear,
        };
    }
}

impl Subdivision<'_> {
    /// Follows each ray of a part on which F is the least of these faces; says whether it did.
    pub(super) fn follow_seam(&mut self, part: &Part, faces: &[Face]) -> bool {
        let mut approaches = std::mem::take(&mut self.memory.approaches);
        approaches.clear();
        let is_followed = self.approach_faces(part, faces, &mut approaches);
        approaches.sort_unstable_by_key(|approach| approach.place);
        if is_followed {
            // First the likely roots, so that others are asked for in what is left before them.
            for is_first in [true, false] {
                for (number, face) in faces.iter().enumerate() {
                    let asked = |approach: &Approach| (approach.likely == number) == is_first;
                    self.pursue_face(part, face, &mut approaches, asked);
                }
            }
            for Approach { place, found, .. } in &approaches {
                match *found {
                    Found::Nothing => {}
                    Found::Hit(hit) => self.settle(Ended { place: *place, end: End::Hit(hit) }, part.kernels),
                    Found::Unclear => {
                        self.settle(Ended { place: *place, end: End::Lost(part.stretch) }, part.kernels);
                    }
                }
            }
        }
        self.memory.approaches = approaches;
        is_followed
    }

    /// Notes the rays of a part that may have a root; says whether not too many may be followed in vain.
    fn approach_faces(&mut self, part: &Part, faces: &[Face], approaches: &mut Vec<Approach>) -> bool {
        let area = self.beam(part.beam).area;
        let mut doubtful = 0;
        for block in area.blocks(BLOCK) {
            if !self.is_open(block) {
                continue;
            }
            let Some(undecided) = undecided(area, block, part, (Extreme::Least, faces)) else { continue };
            let (first_column, first_row) = area.offset(block.column, block.row);
            for (row, b) in block.rows().zip(halves_from(first_row)) {
                for (column, a) in block.columns().zip(halves_from(first_column)) {
                    let place = row * self.tile.width() + column;
                    if self.memory.open[place]
                        && let Some((approach, doubts)) =
                            self.approach_at(part, (faces, undecided), place, (a, b))
                    {
                        approaches.push(approach);
                        doubtful += doubts;
                    }
                }
            }
            if doubtful > DOUBTFUL {
                return false;
            }
        }
        true
    }

    /// A ray that is so many columns and rows off the middle, and how many of those faces that may have either sign it may be asked for in
    /// vain; `None` if it has no root.
    fn approach_at(
        &self,
        part: &Part,
        (faces, undecided): (&[Face], [bool; MOST]),
        place: usize,
        (a, b): (f64, f64),
    ) -> Option<(Approach, usize)> {
        let (mut likely, mut nearest, mut doubts) = (None, f64::INFINITY, 0);
        let mut found = Found::Nothing;
        for (number, face) in faces.iter().enumerate().filter(|(number, _)| undecided[*number]) {
            let course = face.bend.at(a, b);
            match face.sign(&course, part.stretch) {
                Some(sign) if sign < 0.0 => return None,
                Some(_) => continue,
                None => {}
            }
            if face.bow.rises() {
                // It may be negative from the start on.
                found = Found::Unclear;
            }
            let way = course.way_to_root(&face.bow);
            doubts += usize::from(!way.is_finite());
            if likely.is_none() || way < nearest {
                (likely, nearest) = (Some(number), way);
            }
        }
        likely.map(|likely| (Approach { place, likely, found }, doubts))
    }

    /// Pursues those rays that ask for a face, as far as its roots come first.
    fn pursue_face(
        &mut self,
        part: &Part,
        face: &Face,
        approaches: &mut [Approach],
        asked: impl Fn(&Approach) -> bool,
    ) {
        let area = self.beam(part.beam).area;
        let mut pixels = std::mem::take(&mut self.memory.bowed);
        pixels.clear();
        for approach in approaches.iter().filter(|approach| asked(approach)) {
            let (column, row) = self.position(approach.place);
            let (a, b) = area.offset(column, row);
            let wanted = approach.wanted(part.stretch);
            let is_settled = matches!(approach.found, Found::Unclear);
            if !is_settled && face.sign(&face.bend.at(a, b), wanted).is_none_or(|sign| sign < 0.0) {
                pixels.push(self.on_face(part, face, approach.place, wanted));
            }
        }
        let mut ended = std::mem::take(&mut self.memory.ended);
        self.pursue(&mut pixels, face.kernels, &face.bow, &mut ended);
        for Ended { place, end } in ended.drain(..) {
            let known = approaches.binary_search_by_key(&place, |approach| approach.place);
            approaches[known.expect("only these were pursued")].learn(end);
        }
        self.memory.ended = ended;
        self.memory.bowed = pixels;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hit(start: f64, end: f64) -> Hit {
        Hit { t: 0.5 * (start + end), bracket: Span { start, end } }
    }

    fn approach(ends: impl IntoIterator<Item = End>) -> Approach {
        let mut approach = Approach { place: 0, likely: 0, found: Found::Nothing };
        ends.into_iter().for_each(|end| approach.learn(end));
        approach
    }

    #[test]
    fn other_faces_are_asked_up_to_the_first_root_known() {
        let stretch = Span { start: 1.0, end: 2.0 };
        assert_eq!(approach([]).wanted(stretch), stretch);
        assert_eq!(approach([End::Hit(hit(1.5, 1.6))]).wanted(stretch), Span { start: 1.0, end: 1.6 });
    }

    #[test]
    fn the_first_of_two_roots_is_in_front() {
        for (roots, start, end) in [
            ([hit(1.5, 1.6), hit(1.2, 1.3)], 1.2, 1.3),
            ([hit(1.2, 1.3), hit(1.5, 1.6)], 1.2, 1.3),
            // They may be in any order.
            ([hit(1.2, 1.4), hit(1.3, 1.5)], 1.2, 1.4),
            ([hit(1.3, 1.4), hit(1.2, 1.5)], 1.2, 1.4),
        ] {
            let Found::Hit(found) = approach(roots.map(End::Hit)).found else { panic!("{roots:?}") };
            assert_eq!(found.bracket, Span { start, end }, "{roots:?}");
            assert!(start <= found.t && found.t <= end, "{roots:?}");
        }
    }

    #[test]
    fn what_is_lost_stays_unclear() {
        let lost = End::Lost(Span { start: 1.0, end: 2.0 });
        for ends in [[lost, End::Hit(hit(1.2, 1.3))], [End::Hit(hit(1.2, 1.3)), lost]] {
            assert!(matches!(approach(ends).found, Found::Unclear));
        }
    }
}
