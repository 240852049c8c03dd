//! Cameras: which ray belongs to which pixel.
//!
//! z points up. Orbiting cameras look at the middle of a region, or of a sphere in it; yaw 0 and pitch 0 look along +y with x to the right.

use glam::DVec3;
use iso_grid::{Fitted, Raster, Ray, Region, Sphere, Tile};
use thiserror::Error;

use crate::Size;

/// Where the camera stands and what it looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum View {
    /// On a sphere around what it looks at.
    Orbit {
        /// Degrees around the z axis, counter-clockwise seen from above; 0 stands on the −y side.
        yaw: f64,
        /// Degrees above the xy plane; 90 looks straight down.
        pitch: f64,
        /// Distance from the target, in world units; by default as far as the picture needs to show all that is to be seen around its middle.
        distance: Option<f64>,
        /// The point in the middle of the picture; by default the middle of what is to be seen.
        target: Option<DVec3>,
    },
    /// Anywhere, looking anywhere.
    LookAt {
        /// Where the camera stands.
        eye: DVec3,
        /// The point in the middle of the picture.
        target: DVec3,
        /// A direction that points up in the picture; it need not be perpendicular to the line of sight. By default z, or y where that is
        /// along z.
        up: Option<DVec3>,
    },
}

/// How space is projected onto the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Rays spread from the eye.
    Perspective {
        /// The angle between the upper and the lower edge, in degrees, between 0 and 180.
        fov: f64,
    },
    /// Parallel rays.
    Orthographic {
        /// The width of the picture in world units; by default as wide as what is to be seen needs.
        view_width: Option<f64>,
    },
}

/// The angles of the default view.
const YAW: f64 = 30.0;
const PITCH: f64 = 25.0;

/// A surface that [faces](iso_grid::Facing::towards) the camera less than this is seen from its edge, ten degrees off on an average.
const EDGE: f64 = 0.03;

/// The sides, in degrees, from one of which such a surface is seen instead.
const OTHER_YAWS: [f64; 3] = [-30.0, 75.0, -75.0];

impl View {
    /// From the front, a little to the right and above.
    pub const DEFAULT: Self = Self::Orbit { yaw: YAW, pitch: PITCH, distance: None, target: None };

    /// The default view of a surface: [`View::DEFAULT`], or from another side if that one shows its edge.
    pub fn of(fitted: &Fitted) -> Self {
        let faces = |yaw| fitted.facing.map_or(1.0, |facing| facing.towards(outward(yaw, PITCH).0));
        let better = |best, yaw| if faces(yaw) > faces(best) { yaw } else { best };
        let others = OTHER_YAWS.into_iter().filter(|_| faces(YAW) < EDGE);
        Self::Orbit { yaw: others.fold(YAW, better), pitch: PITCH, distance: None, target: None }
    }
}

impl Projection {
    /// A perspective like that of a short telephoto lens.
    pub const DEFAULT: Self = Self::Perspective { fov: 30.0 };
}

/// Why a camera cannot be set up.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CameraError {
    /// A number is out of its range.
    #[error("{what} must be {range}, not {given:?}")]
    OutOfRange {
        /// What the number is.
        what: &'static str,
        /// What it may be.
        range: &'static str,
        /// What it was.
        given: f64,
    },
    /// Eye and target are the same point, or farther apart than any double.
    #[error(
        "the eye and the target are at the same place, or farther apart than any double, so there is no direction to look in"
    )]
    NoDirection,
    /// The up direction is zero or along the line of sight.
    #[error("the up direction is zero or runs along the line of sight; choose one across it")]
    NoUp,
}

/// Rays for the pixels of a picture of given size.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    raster: Raster,
    /// The middle of the picture, in pixels.
    middle: [f64; 2],
}

impl Camera {
    /// A camera for pictures of `size` that show all of `region`.
    ///
    /// # Errors
    /// When a number is out of range or the directions are degenerate.
    pub fn new(view: View, projection: Projection, region: &Region, size: Size) -> Result<Self, CameraError> {
        Self::looking_at(view, projection, &Fitted::from(*region), size)
    }

    /// A camera for pictures of `size` that look into a region and show all of the sphere in it, if there is one, or else all of the region.
    ///
    /// # Errors
    /// When a number is out of range or the directions are degenerate.
    pub fn looking_at(
        view: View,
        projection: Projection,
        fitted: &Fitted,
        size: Size,
    ) -> Result<Self, CameraError> {
        let (width, height) = (f64::from(size.width()), f64::from(size.height()));
        if let Projection::Perspective { fov } = projection {
            checked("the field of view", "between 0 and 180 degrees", fov, 0.0 < fov && fov < 180.0)?;
        }
        let frame = Frame { fitted, projection, aspect: width / height };
        let (eye, forward, up) = place(view, &frame)?;
        let right = forward.cross(up).normalize();
        let down = forward.cross(right);
        let raster = match projection {
            Projection::Perspective { fov } => {
                let spacing = 2.0 * half_height(fov) / height;
                Raster::Spreading { eye, forward, right: spacing * right, down: spacing * down }
            }
            Projection::Orthographic { view_width } => {
                let view_width = view_width.unwrap_or_else(|| frame.view_width(right, down));
                checked(
                    "the view width",
                    "positive",
                    view_width,
                    view_width > 0.0 && view_width.is_finite(),
                )?;
                let spacing = view_width / width;
                Raster::Parallel {
                    middle: eye,
                    right: spacing * right,
                    down: spacing * down,
                    direction: forward,
                }
            }
        };
        Ok(Self { raster, middle: [0.5 * width, 0.5 * height] })
    }

    /// The rays of the pictures that it takes, counted from the middle.
    pub fn raster(&self) -> &Raster {
        &self.raster
    }

    /// The ray through the middle of a pixel. Its direction has length 1 up to rounding, so t is a distance.
    pub fn ray(&self, column: u32, row: u32) -> Ray {
        let [across, along] = self.offset(column, row);
        self.raster.ray(across, along)
    }

    /// The rays through the middles of the pixels of a rectangle, whose first pixel is in this column and row.
    pub fn tile(&self, column: u32, row: u32, width: u32, height: u32) -> Tile<'_> {
        Tile::of(&self.raster, self.offset(column, row), width as usize, height as usize)
    }

    /// How far a pixel is from the middle of the picture.
    fn offset(&self, column: u32, row: u32) -> [f64; 2] {
        [f64::from(column) + 0.5 - self.middle[0], f64::from(row) + 0.5 - self.middle[1]]
    }

    /// The unit vector into the picture.
    pub fn forward(&self) -> DVec3 {
        match self.raster {
            Raster::Parallel { direction, .. } => direction,
            Raster::Spreading { forward, .. } => forward,
        }
    }

    /// The unit vector towards the right edge of the picture.
    pub fn right(&self) -> DVec3 {
        let (Raster::Parallel { right, .. } | Raster::Spreading { right, .. }) = self.raster;
        moderate(right).0.normalize()
    }

    /// The unit vector towards the upper edge of the picture.
    pub fn up(&self) -> DVec3 {
        let (Raster::Parallel { down, .. } | Raster::Spreading { down, .. }) = self.raster;
        -moderate(down).0.normalize()
    }
}

/// Half the height of the picture at distance 1.
fn half_height(fov: f64) -> f64 {
    core_math::tan(0.5 * fov.to_radians())
}

/// What it takes to show a sphere in a region, or all of the region.
struct Frame<'a> {
    fitted: &'a Fitted,
    projection: Projection,
    /// Width by height of the picture.
    aspect: f64,
}

/// The part of the picture, in each direction from its middle, that the region may fill.
const FILLED: f64 = 0.96;

/// The part that the sphere may fill: there is something in most directions, and a region has but eight corners.
const FILLED_BY_SPHERE: f64 = 0.88;

impl Frame<'_> {
    /// The corners of the region, seen from the middle of what is shown.
    fn corners(&self) -> impl Iterator<Item = DVec3> {
        let Fitted { region, .. } = self.fitted;
        let (half, off) = (0.5 * region.extent(), region.center() - self.fitted.center());
        (0..8).map(move |corner| {
            off + half * DVec3::from_array([1, 2, 4].map(|bit| if corner & bit == 0 { -1.0 } else { 1.0 }))
        })
    }

    /// How far from the middle an eye must stand that looks along `forward`, so that the sphere is in the picture, or every corner. Parallel
    /// rays show as much from anywhere, and begin in front of the region where they are so far `off` the middle.
    fn distance(&self, forward: DVec3, up: DVec3, off: DVec3) -> f64 {
        let Fitted { region, sphere, .. } = self.fitted;
        let Projection::Perspective { fov } = self.projection else {
            let off = [region.extent(), region.center() - self.fitted.center(), off];
            return off.map(length).into_iter().sum();
        };
        let distance_of_sphere = |sphere: Sphere| {
            // Rays that touch it are off the middle by the angle with this tangent.
            let tangent = FILLED_BY_SPHERE * half_height(fov) * self.aspect.min(1.0);
            sphere.radius * (1.0 + tangent * tangent).sqrt() / tangent
        };
        let right = forward.cross(up).normalize();
        let up = right.cross(forward);
        let reach = FILLED * half_height(fov);
        let distances = self.corners().map(|corner| {
            let across = (corner.dot(right).abs() / self.aspect).max(corner.dot(up).abs());
            across / reach - corner.dot(forward)
        });
        let distance = distances.fold(0.0, f64::max);
        sphere.map_or(distance, |sphere| distance.min(distance_of_sphere(sphere)))
    }

    /// The width of a picture of parallel rays that shows the sphere, or every corner.
    fn view_width(&self, right: DVec3, down: DVec3) -> f64 {
        let width_of_sphere = |sphere: Sphere| 2.0 * sphere.radius * self.aspect.max(1.0) / FILLED_BY_SPHERE;
        let widths = self
            .corners()
            .map(|corner| corner.dot(right).abs().max(corner.dot(down).abs() * self.aspect) * 2.0 / FILLED);
        let width = widths.fold(0.0, f64::max);
        self.fitted.sphere.map_or(width, |sphere| width.min(width_of_sphere(sphere)))
    }
}

/// The unit vector from a target to an eye that orbits it, and one that is up in the picture.
fn outward(yaw: f64, pitch: f64) -> (DVec3, DVec3) {
    // Correctly rounded functions, so that the camera is the same on every machine.
    let (sin_yaw, cos_yaw) = core_math::sincos(yaw.to_radians());
    let (sin_pitch, cos_pitch) = core_math::sincos(pitch.to_radians());
    let outward = DVec3::new(cos_pitch * sin_yaw, -cos_pitch * cos_yaw, sin_pitch);
    // Perpendicular to `outward` at every pitch, so that looking straight down has an up direction too.
    let up = DVec3::new(-sin_pitch * sin_yaw, sin_pitch * cos_yaw, cos_pitch);
    (outward, up)
}

/// The eye, the unit vector forward, and a direction that is up in the picture and not along `forward`.
fn place(view: View, frame: &Frame<'_>) -> Result<(DVec3, DVec3, DVec3), CameraError> {
    match view {
        View::Orbit { yaw, pitch, distance, target } => {
            checked("the yaw", "finite", yaw, yaw.is_finite())?;
            checked("the pitch", "between -90 and 90 degrees", pitch, pitch.abs() <= 90.0)?;
            let (outward, up) = outward(yaw, pitch);
            let center = frame.fitted.center();
            let target = target.unwrap_or(center);
            checked("the target", "finite", length(target), target.is_finite())?;
            let distance = distance.unwrap_or_else(|| frame.distance(-outward, up, target - center));
            checked("the distance", "positive", distance, distance > 0.0 && distance.is_finite())?;
            Ok((target + distance * outward, -outward, up))
        }
        View::LookAt { eye, target, up } => {
            let all = eye + target + up.unwrap_or_default();
            checked("the eye, the target and the up direction", "finite", length(all), all.is_finite())?;
            let forward = unit(target - eye).ok_or(CameraError::NoDirection)?;
            let is_along = |up: DVec3| forward.cross(up).length() < 1e-9;
            let up = match up {
                Some(up) => unit(up).filter(|up| !is_along(*up)).ok_or(CameraError::NoUp)?,
                None if is_along(DVec3::Z) => DVec3::Y,
                None => DVec3::Z,
            };
            Ok((eye, forward, up))
        }
    }
}

/// A vector in a size whose square neither overflows nor underflows, which changes no bit, and how many times as long as it was.
fn moderate(vector: DVec3) -> (DVec3, f64) {
    const LARGE: f64 = 1e150;
    let size = vector.abs().max_element();
    let factor = match size {
        LARGE.. => 2.0_f64.powi(-600),
        _ if size < 1.0 / LARGE => 2.0_f64.powi(600),
        _ => 1.0,
    };
    (factor * vector, factor)
}

/// How long a vector is, which may be as long as any double.
fn length(vector: DVec3) -> f64 {
    let (vector, factor) = moderate(vector);
    vector.length() / factor
}

/// The direction of a vector of any length but zero.
fn unit(vector: DVec3) -> Option<DVec3> {
    moderate(vector).0.try_normalize()
}

fn checked(what: &'static str, range: &'static str, given: f64, holds: bool) -> Result<(), CameraError> {
    if holds { Ok(()) } else { Err(CameraError::OutOfRange { what, range, given }) }
}

#[cfg(test)]
mod tests;
