//! The one view that all programs are given: orthographic, turned as fidget's `View3` turns.
//!
//! fidget's camera looks along −z with +y up. `View3` turns the model under it: a point p of the picture's frame stands at
//! Rz(yaw)·Rx(pitch)·scale·p in the model. Its pixel (i, j) is sampled at i − w/2 and h/2 − j − 1 pixels from the middle,
//! half a pixel to the left of and below the pixel's middle, where the other programs sample.

use std::error::Error;

use fidget::gui::View3;
use glam::{DMat3, DVec3};
use iso_grid::Region;
use iso_render::{Camera, Projection, Size, View};

/// Degrees about the z axis.
const YAW: f64 = 30.0;
/// Degrees about the x axis, before the yaw.
const PITCH: f64 = -25.0;

/// A square picture of the ball of some radius around the origin.
#[derive(Clone, Copy, Debug)]
pub struct SquareView {
    /// Half the picture's width, in units of the surface's space.
    pub radius: f64,
    /// Pixels along a side, and voxels in depth for fidget.
    pub size: u32,
}

impl SquareView {
    /// To the right in the picture, up in it, and out of it.
    fn axes() -> DMat3 {
        DMat3::from_rotation_z(YAW.to_radians()) * DMat3::from_rotation_x(PITCH.to_radians())
    }

    /// The unit vector to the right in the picture.
    pub fn right() -> DVec3 {
        Self::axes().x_axis
    }

    /// The unit vector up in the picture.
    pub fn up() -> DVec3 {
        Self::axes().y_axis
    }

    /// The unit vector into the picture.
    pub fn forward() -> DVec3 {
        -Self::axes().z_axis
    }

    /// The width of a pixel.
    pub fn pixel(&self) -> f64 {
        2.0 * self.radius / f64::from(self.size)
    }

    /// From where rays start: in front of all that is looked for.
    pub fn eye(&self) -> DVec3 {
        self.target() - self.eye_distance() * Self::forward()
    }

    /// How far the eye is from the plane through the origin.
    pub fn eye_distance(&self) -> f64 {
        2.0 * self.radius
    }

    /// The point in the picture's middle, so that all programs sample where fidget does.
    fn target(&self) -> DVec3 {
        -0.5 * self.pixel() * (Self::right() + Self::up())
    }

    /// The camera of this project.
    ///
    /// # Errors
    /// When the radius is no positive number.
    pub fn camera(&self) -> Result<Camera, Box<dyn Error>> {
        let view = View::LookAt { eye: self.eye(), target: self.target(), up: Some(Self::up()) };
        let projection = Projection::Orthographic { view_width: Some(2.0 * self.radius) };
        Ok(Camera::new(view, projection, &self.region()?, self.size()?)?)
    }

    /// The picture's size, as this project names it.
    ///
    /// # Errors
    /// When it has no pixels or too many.
    pub fn size(&self) -> Result<Size, Box<dyn Error>> {
        Ok(Size::new(self.size, self.size)?)
    }

    /// Where this project looks for the surface: a cube as large as the one that fidget looks through.
    ///
    /// # Errors
    /// When the radius is no positive number.
    pub fn region(&self) -> Result<Region, Box<dyn Error>> {
        Ok(Region::new(DVec3::splat(-self.radius), DVec3::splat(self.radius))?)
    }

    /// The view as fidget has it.
    pub fn fidget(&self) -> View3 {
        let center = fidget::gui::View3::default().components().0;
        View3::from_components(center, self.radius as f32, YAW.to_radians() as f32, PITCH.to_radians() as f32)
    }
}
