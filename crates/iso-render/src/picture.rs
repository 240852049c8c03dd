//! Pictures: what was found, pixel by pixel.

use glam::{DVec3, Vec3};
use iso_grid::{Counters, Outcome, OutcomeKind};
use rayon::prelude::*;
use serde::Serialize;

use crate::{Layer, Mosaic, Size};

/// How the search for a pixel's surface ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The ray crosses the surface.
    Hit,
    /// The ray comes so close to the surface that rounding cannot tell a contact from a near miss.
    Touch,
    /// The ray meets no surface.
    Miss,
    /// The method could not decide.
    Undecided,
    /// Work was stopped before the pixel was finished.
    Unfinished,
}

impl From<OutcomeKind> for Status {
    fn from(kind: OutcomeKind) -> Self {
        match kind {
            OutcomeKind::Hit => Self::Hit,
            OutcomeKind::Touch => Self::Touch,
            OutcomeKind::Miss => Self::Miss,
            OutcomeKind::Undecided => Self::Undecided,
        }
    }
}

/// Pixels by status.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct StatusCounts {
    /// Pixels whose ray crosses the surface.
    pub hit: u64,
    /// Pixels whose ray comes so close to the surface that rounding cannot tell a contact from a near miss.
    pub touch: u64,
    /// Pixels whose ray meets no surface.
    pub miss: u64,
    /// Pixels that the method could not decide.
    pub undecided: u64,
    /// Pixels that were not finished when work was stopped.
    pub unfinished: u64,
}

impl StatusCounts {
    /// Those of pixels whose searches ended so.
    pub fn of(kinds: &[OutcomeKind]) -> Self {
        // As many as bytes can count, which are added up many at once.
        let few =
            |wanted, kinds: &[OutcomeKind]| kinds.iter().map(|kind| u8::from(*kind == wanted)).sum::<u8>();
        let of = |wanted| kinds.chunks(usize::from(u8::MAX)).map(|kinds| u64::from(few(wanted, kinds))).sum();
        let [hit, touch, undecided] = [OutcomeKind::Hit, OutcomeKind::Touch, OutcomeKind::Undecided].map(of);
        Self { hit, touch, miss: kinds.len() as u64 - (hit + touch + undecided), undecided, unfinished: 0 }
    }
}

impl std::ops::AddAssign for StatusCounts {
    fn add_assign(&mut self, other: Self) {
        self.hit += other.hit;
        self.touch += other.touch;
        self.miss += other.miss;
        self.undecided += other.undecided;
        self.unfinished += other.unfinished;
    }
}

/// Which buffers a picture keeps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Layers {
    /// The shaded picture.
    pub color: bool,
    /// How much of each pixel of the shaded picture shows something.
    pub coverage: bool,
    /// The distance along each ray.
    pub depth: bool,
    /// The unit normals.
    pub normals: bool,
    /// The points of the surface.
    pub points: bool,
    /// The status of each pixel.
    pub statuses: bool,
    /// How the search along each ray ended.
    pub outcomes: bool,
}

impl Layers {
    /// Everything.
    pub const ALL: Self = Self {
        color: true,
        coverage: true,
        depth: true,
        normals: true,
        points: true,
        statuses: true,
        outcomes: true,
    };
    /// The shaded picture alone.
    pub const COLOR: Self = Self {
        color: true,
        coverage: false,
        depth: false,
        normals: false,
        points: false,
        statuses: false,
        outcomes: false,
    };
}

/// A picture: the layers that were asked for, rows from top to bottom, and what they took.
///
/// Layers that were not asked for are empty. Each layer has a mark for pixels that are [`Status::Unfinished`].
#[derive(Clone, Debug)]
pub struct Picture {
    /// Width and height.
    pub size: Size,
    /// Red, green and blue bytes in sRGB; [`Picture::UNFINISHED`] where pixels are unfinished.
    pub color: Layer<[u8; 3]>,
    /// How much of each pixel shows something in front of the background, from 0 to 255: nothing but where [`Status::Miss`] is. Unfinished
    /// pixels are covered.
    pub coverage: Layer<u8>,
    /// The distance t along each ray; NaN where nothing was found, −∞ where pixels are unfinished.
    pub depth: Mosaic<f64>,
    /// Unit normals towards larger F, each coordinate rounded to single precision, as files hold them, for what takes longest on simple
    /// surfaces is to write them; NaN where nothing was found, zero where pixels are unfinished.
    pub normals: Mosaic<Vec3>,
    /// Points of the surface; NaN where nothing was found or pixels are unfinished.
    pub points: Mosaic<DVec3>,
    /// The status of each pixel.
    pub statuses: Vec<Status>,
    /// How the search along each ray ended.
    pub outcomes: Vec<Outcome>,
    /// Pixels by status.
    pub counts: StatusCounts,
    /// The work of tracing.
    pub counters: Counters,
    /// The share of the wall time spent on rays, in seconds: threads trace and shade in turns, so their common time is
    /// divided as the threads' own times are.
    pub trace_seconds: f64,
    /// The share of the wall time spent on normals and colours, in seconds.
    pub shade_seconds: f64,
}

impl Picture {
    /// The colour of unfinished pixels: black, which no lit surface and no background is.
    pub const UNFINISHED: [u8; 3] = [0; 3];

    /// A picture of this size that has no layers yet.
    pub fn empty(size: Size) -> Self {
        Self {
            size,
            color: Layer::default(),
            coverage: Layer::default(),
            depth: Mosaic::default(),
            normals: Mosaic::default(),
            points: Mosaic::default(),
            statuses: Vec::new(),
            outcomes: Vec::new(),
            counts: StatusCounts::default(),
            counters: Counters::default(),
            trace_seconds: 0.0,
            shade_seconds: 0.0,
        }
    }

    /// Makes room for `layers` and drops others. No pixel means anything then. `None` when memory does not suffice.
    pub(crate) fn make_room(&mut self, layers: Layers) -> Option<()> {
        let pixels = |wanted: bool| if wanted { self.size.pixels() } else { 0 };
        self.color.make_room(pixels(layers.color))?;
        self.coverage.make_room(pixels(layers.coverage))?;
        self.depth.make_room(layers.depth.then_some(self.size))?;
        self.normals.make_room(layers.normals.then_some(self.size))?;
        self.points.make_room(layers.points.then_some(self.size))?;
        make_room(&mut self.statuses, pixels(layers.statuses), Status::Unfinished)?;
        make_room(&mut self.outcomes, pixels(layers.outcomes), Outcome::Miss)
    }
}

/// Gives a layer so many pixels, filled by all threads where it is new: what takes time is that memory is first touched.
fn make_room<T: Copy + Send + Sync>(layer: &mut Vec<T>, pixels: usize, value: T) -> Option<()> {
    if layer.len() != pixels {
        *layer = Vec::new();
        layer.try_reserve_exact(pixels).ok()?;
        (0..pixels).into_par_iter().map(|_| value).collect_into_vec(layer);
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// More of one kind in a row than a byte counts.
    #[test]
    fn all_pixels_are_counted() {
        let kinds = [
            (OutcomeKind::Miss, 20_000),
            (OutcomeKind::Hit, 6_553),
            (OutcomeKind::Touch, 3),
            (OutcomeKind::Undecided, 7_000),
        ];
        let outcomes: Vec<_> = kinds.iter().flat_map(|&(kind, count)| vec![kind; count]).collect();
        let expected = StatusCounts { hit: 6_553, touch: 3, miss: 20_000, undecided: 7_000, unfinished: 0 };
        assert_eq!(StatusCounts::of(&outcomes), expected);
        assert_eq!(StatusCounts::of(&[]), StatusCounts::default());
    }
}
