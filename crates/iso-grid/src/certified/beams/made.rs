//! How F is made of smooth functions by minima and maxima.

use iso_expr::Extreme;
use pulp::Simd;

use crate::lanes::{Lanes, ROW, Row, parts};

/// More functions are left to smaller parts, where fewer of them matter. Measured in instructions, against four: of the models the tree takes 7 % fewer
/// and the rotunda 1 % more; with six 8 % fewer and 1 % more.
pub(super) const MOST: usize = 5;

/// How many combinations of signs there are, of which each is negative, unknown or positive.
const COMBINATIONS: usize = 3_usize.pow(MOST as u32);
const _: () = assert!(COMBINATIONS <= 1 << u8::BITS, "a byte tells each combination");

/// How far apart combinations stand in which a face has signs that are one apart.
const STEPS: [i32; MOST] = {
    let mut steps = [1; MOST];
    let mut face = 1;
    while face < MOST {
        steps[face] = 3 * steps[face - 1];
        face += 1;
    }
    steps
};

/// The sign of each face in all of them. Each stands at the place whose digits to the base of three are the signs of the faces, the first one's last,
/// and one more.
static OF_FACES: [[i8; COMBINATIONS]; MOST] = {
    let mut signs = [[0; COMBINATIONS]; MOST];
    let mut place = 0;
    while place < COMBINATIONS {
        let (mut face, mut digits) = (0, place);
        while face < MOST {
            signs[face][place] = (digits % 3) as i8 - 1;
            digits /= 3;
            face += 1;
        }
        place += 1;
    }
    signs
};

/// The signs of some faces, by their place among all combinations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Combination(u8);

impl Combination {
    /// The sign of a face: −1, 1, or 0 where it is not known.
    #[inline]
    pub(super) fn sign(self, face: usize) -> i8 {
        OF_FACES[face][usize::from(self.0)]
    }

    /// The one in which a face has this sign.
    #[inline]
    pub(super) fn with(self, face: usize, sign: i8) -> Self {
        Self((i32::from(self.0) + i32::from(sign - self.sign(face)) * STEPS[face]) as u8)
    }

    /// The one in which a face has the other sign.
    #[inline]
    pub(super) fn with_other(self, face: usize) -> Self {
        self.with(face, -self.sign(face))
    }

    /// That of these signs of all faces.
    #[cfg(test)]
    pub(super) fn of(signs: &[f64]) -> Self {
        Self(signs.iter().rev().fold(0, |place, sign| 3 * place + (sign + 1.0) as u8))
    }
}

/// What F, or a function of which it is made, comes to on a part.
pub(super) enum Made {
    /// It is of this sign everywhere.
    Signed(f64),
    /// It is the face of this number.
    Face(usize),
    /// It is zero where the least or the greatest of these is, and of the same sign elsewhere.
    Of(Extreme, Vec<Self>),
    /// It is the second where the face of this number is negative, and the third where that is positive; where that is zero, all three are the same.
    Choice(usize, Box<[Self; 2]>),
    /// It is the second where the first is positive, and nothing where that is negative.
    Within(Box<[Self; 2]>),
}

impl Made {
    /// Its sign in the first `count` combinations, NaN where it is nothing.
    fn signs(&self, count: usize) -> Vec<f64> {
        match self {
            Self::Signed(sign) => vec![*sign; count],
            Self::Face(number) => OF_FACES[*number][..count].iter().map(|sign| f64::from(*sign)).collect(),
            Self::Of(extreme, parts) => {
                let mut signs = vec![-deciding(*extreme); count];
                for part in parts {
                    let both = signs.iter_mut().zip(part.signs(count));
                    match extreme {
                        Extreme::Least => both.for_each(|(sign, of)| *sign = sign.min(of)),
                        Extreme::Greatest => both.for_each(|(sign, of)| *sign = sign.max(of)),
                    }
                }
                signs
            }
            Self::Choice(by, sides) => {
                let [below, above] = sides.each_ref().map(|side| side.signs(count));
                let sign = |(by, (below, above))| match by {
                    -1 => below,
                    0 if below != above => 0.0,
                    _ => above,
                };
                OF_FACES[*by].iter().copied().zip(below.into_iter().zip(above)).map(sign).collect()
            }
            Self::Within(both) => {
                let [margin, function] = both.each_ref().map(|made| made.signs(count));
                let sign = |(margin, function)| match margin {
                    ..0.0 => f64::NAN,
                    // Where the function is zero, the margin may be so too.
                    0.0 => 0.0,
                    _ => function,
                };
                margin.into_iter().zip(function).map(sign).collect()
            }
        }
    }

    /// Whether it is negative wherever one of some faces is, so that the first one that a ray meets decides.
    pub(super) fn is_union(&self) -> bool {
        match self {
            Self::Of(Extreme::Least, parts) => parts.iter().all(|part| matches!(part, Self::Face(_))),
            _ => false,
        }
    }

    /// Notes the faces that it may be.
    fn note_faces(&self, are_faces: &mut [bool; MOST]) {
        match self {
            Self::Signed(_) => {}
            Self::Face(number) => are_faces[*number] = true,
            Self::Of(_, parts) => parts.iter().for_each(|part| part.note_faces(are_faces)),
            Self::Choice(_, sides) => sides.iter().for_each(|side| side.note_faces(are_faces)),
            Self::Within(both) => both[1].note_faces(are_faces),
        }
    }
}

/// The sign of F for all signs that its faces may have, NaN where it is nothing.
pub(super) struct Combinations {
    /// How many faces there are.
    faces: usize,
    /// In their order.
    of: Vec<f64>,
    /// Whether F is the least or the greatest of each face and what else there may be.
    direct: [Option<Extreme>; MOST],
    /// Whether F may be zero where each face is, and not only made otherwise before and behind it.
    are_met: [bool; MOST],
    /// Whether F is nothing for some signs.
    is_cut: bool,
}

impl Combinations {
    /// Those of what is made of so many faces.
    pub(super) fn new(made: &Made, faces: usize) -> Self {
        let mut found = Self {
            faces,
            of: made.signs(3_usize.pow(faces as u32)),
            direct: [None; MOST],
            are_met: [false; MOST],
            is_cut: matches!(made, Made::Within(_)),
        };
        made.note_faces(&mut found.are_met);
        if let Made::Of(extreme, parts) = made {
            for part in parts {
                if let Made::Face(number) = part {
                    found.direct[*number] = Some(*extreme);
                }
            }
        }
        found
    }

    /// The sign of F where faces have these, 0 where that is not known, NaN where F is nothing.
    #[inline]
    pub(super) fn sign(&self, of_faces: Combination) -> f64 {
        self.of[usize::from(of_faces.0)]
    }

    /// The combinations along rays side by side in which faces have these signs.
    #[inline(always)]
    pub(super) fn of_rows<S: Simd>(&self, simd: S, of_faces: &[Row; MOST]) -> [Combination; ROW] {
        let all = |number| Lanes::all(simd, number);
        let mut places = [0.0; ROW];
        for part in 0..parts::<S>() {
            let mut place = all(0.0);
            for row in of_faces[..self.faces].iter().rev() {
                place = all(3.0) * place + (Lanes::of(simd, row, part) + all(1.0));
            }
            place.put(&mut places, part);
        }
        places.map(|place| Combination(whole(place)))
    }

    /// The face whose sign is not known, if that is one alone, and F has its sign.
    #[inline]
    pub(super) fn face_alone(&self, of_faces: Combination) -> Option<usize> {
        let mut open = (0..self.faces).filter(|face| of_faces.sign(*face) == 0);
        let (face, None) = (open.next()?, open.next()) else { return None };
        let with = |sign| self.sign(of_faces.with(face, sign));
        (self.is_met(face) && with(-1) < 0.0 && with(1) > 0.0).then_some(face)
    }

    /// Whether F may be nothing where some of these faces have the other sign.
    pub(super) fn may_be_nothing(&self, of_faces: Combination, other: impl Iterator<Item = usize>) -> bool {
        if !self.is_cut {
            return false;
        }
        let mut all = vec![of_faces];
        for face in other {
            for place in 0..all.len() {
                all.push(all[place].with_other(face));
            }
        }
        all.into_iter().any(|signs| self.sign(signs).is_nan())
    }

    /// Whether F may be zero where a face is.
    pub(super) fn is_met(&self, face: usize) -> bool {
        self.are_met[face]
    }

    /// Whether F is the least or the greatest of a face and what else there may be.
    pub(super) fn extreme_of(&self, face: usize) -> Option<Extreme> {
        self.direct[face]
    }
}

/// A number that is whole and less than 256, from its bits: a cast has to care for all others, which takes longer.
#[inline(always)]
fn whole(number: f64) -> u8 {
    const LARGE: f64 = (1u64 << 52) as f64;
    (LARGE + number).to_bits() as u8
}

/// The sign that F has where any of its functions has it.
pub(super) fn deciding(extreme: Extreme) -> f64 {
    match extreme {
        Extreme::Least => -1.0,
        Extreme::Greatest => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of<const N: usize>(signs: [f64; N]) -> Combination {
        Combination::of(&signs)
    }

    #[test]
    fn combinations_tell_and_change_the_sign_of_each_face() {
        for signs in [[-1.0, 1.0, 0.0, 0.0, 1.0], [0.0; MOST], [1.0; MOST], [-1.0; MOST]] {
            let all = of(signs);
            for face in 0..MOST {
                assert_eq!(f64::from(all.sign(face)), signs[face]);
                for sign in [-1, 0, 1] {
                    let mut others = signs;
                    others[face] = f64::from(sign);
                    assert_eq!(all.with(face, sign), of(others));
                    assert_eq!(all.with(face, sign).with_other(face), all.with(face, -sign));
                }
            }
        }
    }

    /// A limb of a union: min(by < 0 ? a : b, c).
    #[test]
    fn choices_are_known_where_both_sides_are_the_same_or_the_side_is_known() {
        let limb = Made::Choice(0, Box::new([Made::Face(1), Made::Face(2)]));
        let made = Made::Of(Extreme::Least, vec![limb, Made::Face(3)]);
        let found = Combinations::new(&made, 4);
        for a in [-1.0, 0.0, 1.0] {
            for b in [-1.0, 0.0, 1.0] {
                for c in [-1.0, 0.0, 1.0] {
                    assert_eq!(found.sign(of([-1.0, a, b, c])), f64::min(a, c));
                    assert_eq!(found.sign(of([1.0, a, b, c])), f64::min(b, c));
                    let either = if a == b { a } else { 0.0 };
                    assert_eq!(found.sign(of([0.0, a, b, c])), f64::min(either, c));
                }
            }
        }
        assert_eq!([0, 1, 2, 3].map(|face| found.is_met(face)), [false, true, true, true]);
    }

    /// A part of a union that is cut: min(max(a, b), c).
    #[test]
    fn a_face_is_alone_where_the_sign_of_all_is_its_own() {
        let cut = Made::Of(Extreme::Greatest, vec![Made::Face(0), Made::Face(1)]);
        let made = Made::Of(Extreme::Least, vec![cut, Made::Face(2)]);
        let found = Combinations::new(&made, 3);
        assert_eq!(found.face_alone(of([0.0, -1.0, 1.0])), Some(0));
        assert_eq!(found.face_alone(of([1.0, -1.0, 0.0])), Some(2));
        // Behind the other side of the cut, and inside the other part, it decides nothing.
        assert_eq!(found.face_alone(of([0.0, 1.0, 1.0])), None);
        assert_eq!(found.face_alone(of([0.0, -1.0, -1.0])), None);
        assert_eq!(found.face_alone(of([0.0, 0.0, 1.0])), None);
        // What decides between two sides is never met.
        let limb = Made::Choice(0, Box::new([Made::Face(1), Made::Face(2)]));
        let found = Combinations::new(&limb, 3);
        assert_eq!(found.face_alone(of([0.0, -1.0, 1.0])), None);
        assert_eq!(found.face_alone(of([-1.0, 0.0, 1.0])), Some(1));
    }

    /// A sphere where either of two margins is positive, the first of which is the sphere's own.
    #[test]
    fn nothing_has_no_sign() {
        let margin = Made::Of(Extreme::Greatest, vec![Made::Face(0), Made::Face(1)]);
        let made = Made::Within(Box::new([margin, Made::Face(0)]));
        let found = Combinations::new(&made, 2);
        for (signs, expected) in [
            ([1.0, -1.0], 1.0),
            ([1.0, 0.0], 1.0),
            ([-1.0, 1.0], -1.0),
            ([0.0, 1.0], 0.0),
            ([-1.0, 0.0], 0.0),
            ([0.0, -1.0], 0.0),
        ] {
            assert_eq!(found.sign(of(signs)), expected, "{signs:?}");
        }
        let nothing = of([-1.0, -1.0]);
        assert!(found.sign(nothing).is_nan() && found.may_be_nothing(nothing, [].into_iter()));
        assert!(found.may_be_nothing(of([1.0, 1.0]), [0, 1].into_iter()));
        assert!(!found.may_be_nothing(of([1.0, 1.0]), [0].into_iter()));
        assert!(found.is_met(0) && !found.is_met(1));
        assert_eq!(found.face_alone(of([0.0, 1.0])), Some(0));
        assert_eq!(found.face_alone(of([0.0, -1.0])), None);
    }

    /// A corner is cut off a union: max(min(a, b, 1), c).
    #[test]
    fn combinations_are_those_of_minima_and_maxima() {
        let union = Made::Of(Extreme::Least, vec![Made::Face(0), Made::Face(1), Made::Signed(1.0)]);
        let made = Made::Of(Extreme::Greatest, vec![union, Made::Face(2)]);
        let found = Combinations::new(&made, 3);
        for a in [-1.0, 0.0, 1.0] {
            for b in [-1.0, 0.0, 1.0] {
                for c in [-1.0, 0.0, 1.0] {
                    let expected = f64::max(f64::min(a, b), c);
                    assert_eq!(found.sign(of([a, b, c])), expected, "{a}, {b}, {c}");
                    let mut of_faces = [a, b, c, 0.0, 0.0].map(|sign| [sign; ROW]);
                    of_faces[2][3] = 1.0;
                    let signs = found.of_rows(pulp::Scalar::new(), &of_faces).map(|signs| found.sign(signs));
                    let side_by_side = |lane: usize| if lane == 3 { 1.0 } else { expected };
                    assert_eq!(signs, std::array::from_fn(side_by_side), "{a}, {b}, {c}");
                }
            }
        }
        assert_eq!([0, 1, 2].map(|face| found.extreme_of(face)), [None, None, Some(Extreme::Greatest)]);
    }
}
