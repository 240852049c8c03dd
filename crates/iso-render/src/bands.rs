//! A picture cut into bands of rows, so that threads write into it at once.

use std::iter::repeat_with;
use std::sync::Mutex;

use glam::{DVec3, Vec3};
use iso_grid::Outcome;

use crate::mosaic::{Strip, TILE};
use crate::{Picture, Status};

/// Some rows of every layer of a picture; layers that the picture does not keep are empty.
pub(crate) struct Band<'a> {
    is_clear: bool,
    pub(crate) color: &'a mut [[u8; 3]],
    pub(crate) coverage: &'a mut [u8],
    pub(crate) depth: Strip<'a, f64>,
    pub(crate) normals: Strip<'a, Vec3>,
    pub(crate) points: Strip<'a, DVec3>,
    pub(crate) statuses: &'a mut [Status],
    pub(crate) outcomes: &'a mut [Outcome],
}

impl<'a> Band<'a> {
    /// The bands of a row of tiles each, from top to bottom.
    pub(crate) fn all(picture: &'a mut Picture) -> Vec<Mutex<Self>> {
        let pixels = TILE as usize * picture.size.width() as usize;
        let count = picture.size.height().div_ceil(TILE);
        let mut color = cut(&mut picture.color, pixels);
        let mut coverage = cut(&mut picture.coverage, pixels);
        let mut depth = picture.depth.strips();
        let mut normals = picture.normals.strips();
        let mut points = picture.points.strips();
        let mut statuses = cut(&mut picture.statuses, pixels);
        let mut outcomes = cut(&mut picture.outcomes, pixels);
        let band = || {
            Mutex::new(Self {
                is_clear: false,
                color: color(),
                coverage: coverage(),
                depth: depth(),
                normals: normals(),
                points: points(),
                statuses: statuses(),
                outcomes: outcomes(),
            })
        };
        repeat_with(band).take(count as usize).collect()
    }

    /// Says of all pixels that nothing is there, if that was not done before. Colours are left as they are.
    ///
    /// Whole rows take a third of the time that their parts take tile by tile.
    pub(crate) fn clear(&mut self) {
        if !self.is_clear {
            self.is_clear = true;
            self.coverage.fill(0);
            self.depth.clear();
            self.normals.clear();
            self.points.clear();
            self.statuses.fill(Status::Miss);
            self.outcomes.fill(Outcome::Miss);
        }
    }
}

/// Gives one part of so many pixels after the other, at last empty ones.
fn cut<'a, T>(layer: &'a mut [T], pixels: usize) -> impl FnMut() -> &'a mut [T] {
    let mut parts = layer.chunks_mut(pixels);
    move || parts.next().unwrap_or_default()
}
