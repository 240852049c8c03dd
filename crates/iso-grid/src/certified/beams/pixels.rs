//! Rays of a part along which F may bend, followed each for its own by values of F. Where F is monotone, they are followed
//! [side by side](super::bundle).

use super::bows::{Bow, Bowed};
use super::subdivision::Subdivision;
use crate::{Hit, Kernel, Ray, Span, Workspace};

/// How many values of F a ray is given at most before it is searched for its own.
pub(super) const STEPS: usize = 10;

/// A ray that may have a root in a part, and what is known of F along it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pixel {
    /// Which ray of the tile it is, or of some that are pursued together.
    pub(super) place: usize,
    pub(super) ray: Ray,
    /// Where the part's certificate holds inside the region.
    pub(super) reach: Span,
    /// Where a root is looked for: everything before it is free of roots.
    pub(super) wanted: Span,
    /// Where F is to be taken next, inside `reach`.
    pub(super) t: f64,
    pub(super) known: Bowed,
}

/// What a value told of a pixel.
pub(super) enum Verdict {
    /// There is no root where one is looked for: F has this sign there.
    Free(f64),
    /// There is one: `wanted` encloses it, and t is about where it is.
    Hit,
    /// Another place is nearer to the root.
    Open,
    /// Single values do not tell.
    Lost,
}

/// How the pursuit of a ray ended.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ended {
    /// The place of its pixel.
    pub(super) place: usize,
    pub(super) end: End,
}

/// An end of a pursuit.
#[derive(Clone, Copy, Debug)]
pub(super) enum End {
    /// There is no root, and F has this sign.
    Free(f64),
    /// There is one, and F has this sign before it.
    Hit(Hit, f64),
    /// The stretch is to be searched otherwise.
    Lost(Span),
}

impl Subdivision<'_> {
    /// Goes on with each ray to its root in the part, and notes how it ended.
    pub(super) fn pursue(
        &mut self,
        mut pixels: &mut [Pixel],
        kernels: u32,
        bow: &Bow,
        ended: &mut Vec<Ended>,
    ) {
        for step in 1..=STEPS {
            if pixels.is_empty() {
                break;
            }
            let count = self.approach(pixels, (kernels, bow), step == STEPS, ended);
            pixels = &mut pixels[..count];
        }
    }

    /// Ends a ray that was pursued by kernels of a number, or searches it.
    pub(super) fn settle(&mut self, Ended { place, end }: Ended, kernels: u32) {
        match end {
            End::Free(_) => {}
            End::Hit(hit, _) => self.meet(place, hit, kernels),
            End::Lost(wanted) => {
                self.search_one(self.position(place), wanted);
            }
        }
    }

    /// Takes F at each pixel's t, and counts the pixels that are nearer to their roots by that, which are then in front. The last
    /// time, those are searched each for its own.
    fn approach(
        &mut self,
        pixels: &mut [Pixel],
        (kernels, bow): (u32, &Bow),
        is_last: bool,
        ended: &mut Vec<Ended>,
    ) -> usize {
        let Workspace { points, scratch, counters, .. } = &mut *self.workspace;
        let of_part = &self.kernels[kernels as usize];
        points.replace(pixels.iter().map(|pixel| (&pixel.ray, pixel.t)));
        counters.trace_evaluations += pixels.len() as u64;
        counters.operations += of_part.charge(Kernel::Values, pixels.len());
        let values = points.evaluate(of_part.over_points(Kernel::Values), scratch, 1);
        let mut kept = 0;
        for number in 0..pixels.len() {
            let pixel = &mut pixels[number];
            let place = pixel.place;
            match pixel.look(values[number], bow) {
                Verdict::Open if !is_last => {
                    if kept < number {
                        pixels[kept] = pixels[number];
                    }
                    kept += 1;
                }
                Verdict::Open | Verdict::Lost => ended.push(Ended { place, end: End::Lost(pixel.wanted) }),
                Verdict::Free(sign) => ended.push(Ended { place, end: End::Free(sign) }),
                Verdict::Hit => {
                    let hit = Hit { t: pixel.t, bracket: pixel.wanted };
                    ended.push(Ended { place, end: End::Hit(hit, pixel.sign_before(bow)) });
                }
            }
        }
        kept
    }
}

/// Numbers from a whole or half one on, one apart. Exact.
pub(super) fn halves_from(first: f64) -> impl Iterator<Item = f64> {
    std::iter::successors(Some(first), |number| Some(number + 1.0))
}
