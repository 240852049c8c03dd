//! Rays that graze the surface: parts on which F is not monotone along rays, but bends one way.

use std::ops::RangeInclusive;

use glam::DVec3;
use iso_expr::{Decorated, Interval};
use pulp::{Simd, WithSimd};

use super::bend::Bend;
use super::faces::{Face, Outline};
use super::packet::{OpenArea, Packet, Signed, for_all};
use super::pixels::{End, Pixels};
use super::subdivision::{KnownAlong, Memory, Part, Subdivision};
use crate::lanes::{Lanes, ROW, Row, parts};
use crate::{Kernel, Span, Tile};

/// Second derivatives are asked for beams of so many columns or rows: they say little about larger ones, and a single ray is not worth
/// it.
pub(super) const SIZES: RangeInclusive<usize> = 2..=32;

/// Beams of more columns or rows are cut, unless F bends everywhere alike, or is made of functions there of which the first that a ray meets decides.
pub(super) const LARGE: usize = 16;

/// How many powers of two there are up to the largest of these sizes, 1 included.
const CLASSES: usize = SIZES.end().ilog2() as usize + 1;

/// After so many attempts in a tile that helped less often than once in so many, no more are made.
const ENOUGH: u32 = 6;
const SELDOM: u32 = 2;

/// A beam is cut when more rays are likely to be followed in vain.
pub(super) const DOUBTFUL: f64 = 64.0;

/// Longer stretches, compared to the beam's width, are cut first.
const LONG: f64 = 2.5;

/// How often second derivatives were asked for in a tile, and how often they helped, for beams up to each power of two.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Attempts {
    made: [u32; CLASSES],
    helped: [u32; CLASSES],
}

impl Attempts {
    fn class(size: usize) -> usize {
        size.next_power_of_two().trailing_zeros() as usize
    }

    /// Whether they hardly ever helped with beams of such a size.
    fn are_vain(&self, size: usize) -> bool {
        let class = Self::class(size);
        self.made[class] >= ENOUGH && SELDOM * self.helped[class] < self.made[class]
    }

    fn note(&mut self, size: usize, helped: bool) {
        let class = Self::class(size);
        self.made[class] += 1;
        self.helped[class] += u32::from(helped);
    }
}

impl Subdivision<'_> {
    /// Follows each ray of a part on which F bends one way; says whether it did.
    pub(super) fn follow_bent(&mut self, part: &Part) -> bool {
        let size = self.size(part);
        if !part.form.is_known()
            || !self.is_fit(part)
            || size > LARGE && !self.bends_evenly(part.kernels)
            || self.memory.attempts.are_vain(size)
        {
            return false;
        }
        let face = self.outline(part).and_then(|outline| self.face(part, &outline));
        self.memory.attempts.note(size, face.is_some());
        face.is_some_and(|face| self.follow_smooth(part, &face))
    }

    /// Follows each ray of a part on which F has the sign of a function that bends one way or is monotone; says whether it did.
    pub(super) fn follow_smooth(&mut self, part: &Part, face: &Face) -> bool {
        let mut pixels = std::mem::take(&mut self.memory.pixels);
        let is_followed = self.start_bent(part, face, &mut pixels);
        if is_followed {
            self.pursue(&mut pixels, face.kernels, &face.bow);
            self.settle(&pixels, KnownAlong { kernels: face.kernels, span: part.form.reach });
        }
        self.memory.pixels = pixels;
        is_followed
    }

    /// Ends rays that were pursued by what is known along them, or searches them.
    pub(super) fn settle(&mut self, pixels: &[Pixels], known: KnownAlong) {
        for (place, end) in pixels.iter().flat_map(Pixels::ends) {
            match end {
                End::Free(_) => {}
                End::Hit(hit, _) => self.meet(place, hit, known.kernels),
                End::Lost(wanted) => self.search_one(self.position(place), wanted, Some(known)),
            }
        }
    }

    /// F on a part to first order, where its second derivatives are likely to help.
    fn outline(&mut self, part: &Part) -> Option<Outline> {
        let &Part { kernels, form, .. } = part;
        self.kernels(kernels).over_boxes(Kernel::HessianEnclosures)?;
        let (_, center) = self.center(part);
        let jet = self.jet_at(center, kernels)?;
        Some(Outline { kernels, form, jet })
    }

    /// Whether second derivatives are likely to help with a part.
    pub(super) fn is_fit(&self, part: &Part) -> bool {
        part.is_inside && SIZES.contains(&self.size(part)) && self.is_short(part.beam, part.form.reach)
    }

    /// Whether second derivatives are the same everywhere, so that none takes an operation.
    fn bends_evenly(&self, kernels: u32) -> bool {
        let kernels = self.kernels(kernels);
        let [first, second] = [Kernel::GradientEnclosures, Kernel::HessianEnclosures];
        kernels.may_ask(second) && kernels.operations(first) == kernels.operations(second)
    }

    /// Whether a stretch of a beam is not much longer than the beam is wide.
    pub(super) fn is_short(&self, beam: u32, stretch: Span) -> bool {
        self.beam(beam).elongation(stretch) <= LONG
    }

    /// How many columns or rows the beam of a part has.
    pub(super) fn size(&self, part: &Part) -> usize {
        self.beam(part.beam).area.side()
    }

    /// The middle of a part.
    pub(super) fn center(&self, part: &Part) -> (f64, DVec3) {
        let (beam, reach) = (self.beam(part.beam), part.form.reach);
        let t = 0.5 * (reach.start + reach.end);
        (t, beam.origins.middle + t * beam.directions.middle)
    }

    /// F and its gradient at a point.
    pub(super) fn jet_at(&mut self, center: DVec3, kernels: u32) -> Option<[Interval; 4]> {
        let found = self.enclose_one(kernels, Kernel::GradientEnclosures, (center, center))?;
        Some(found.map(|found: Decorated| found.interval))
    }

    /// F by kernels of this number to second order around the middle of a part, where it and its gradient are `jet`.
    pub(super) fn expand(
        &mut self,
        part: &Part,
        center: (f64, DVec3),
        jet: [Interval; 4],
        kernels: u32,
    ) -> Option<Bend> {
        let bounds = self.beam(part.beam).bounds_in_space(part.form.reach);
        let hessian = self.enclose_one(kernels, Kernel::HessianEnclosures, bounds)?;
        Bend::new(self.beam(part.beam), center, jet, hessian)
    }

    /// How far values by kernels of this number may be off all over a part, if that is bounded.
    pub(super) fn error_of_values(&mut self, part: &Part, kernels: u32) -> Option<f64> {
        let reach = part.form.reach;
        let bounds = self.beam(part.beam).bounds(reach, &self.certified.region)?;
        let rounding = self.rounding((part.beam, kernels), bounds, |_, _| true)?;
        Some(rounding.error(self.beam(part.beam), reach))
    }

    /// How wide the enclosure of a root in a part may be.
    pub(super) fn tolerance(&self, part: &Part) -> f64 {
        self.certified.accuracy.of_neighbours(part.stretch, self.tile.spacing(part.stretch.start))
    }

    /// The rays of a part that are still followed and may have a root there; says whether not too many may be followed in vain.
    fn start_bent(&mut self, part: &Part, face: &Face, pixels: &mut Vec<Pixels>) -> bool {
        let arch = self.workspace.arch;
        let Memory { beams, open, packets, .. } = &mut self.memory;
        let rays = OpenArea { area: beams[part.beam as usize].area, open };
        let bent = Bent { face, stretch: part.stretch };
        arch.dispatch(Start { rays, tile: &self.tile, bent, packets, pixels })
    }
}

/// The search of a part for rays that may have a root.
struct Start<'a> {
    rays: OpenArea<'a>,
    tile: &'a Tile<'a>,
    bent: Bent<'a>,
    packets: &'a mut Vec<Packet>,
    pixels: &'a mut Vec<Pixels>,
}

/// A face on a stretch.
struct Bent<'a> {
    face: &'a Face,
    stretch: Span,
}

impl Signed for Bent<'_> {
    #[inline(always)]
    fn signs<S: Simd>(&self, simd: S, middle: &[Row; 2], radii: &[Row; 2]) -> Row {
        let (mut signs, stretch) = ([0.0; ROW], for_all(self.stretch));
        for part in 0..parts::<S>() {
            let at = |rows| Lanes::of_both(simd, rows, part);
            self.face.signs(at(middle), at(radii), at(&stretch)).put(&mut signs, part);
        }
        signs
    }
}

impl WithSimd for Start<'_> {
    /// Whether not too many rays may be followed in vain.
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        let Self { rays, tile, bent, packets, pixels } = self;
        let Bent { face: Face { bend, bow, .. }, stretch } = bent;
        rays.pack(simd, &bent, packets);
        let mut doubtful = 0.0;
        pixels.clear();
        for packet in packets {
            let mut some = Pixels::new(*packet, packet.rays(simd, tile), for_all(stretch), bow);
            for part in 0..parts::<S>() {
                let course = bend.at(packet.offsets((simd, part), rays.area));
                doubtful += some.start((simd, part), &course, bow);
            }
            if doubtful > DOUBTFUL {
                return false;
            }
            pixels.push(some);
        }
        true
    }
}
