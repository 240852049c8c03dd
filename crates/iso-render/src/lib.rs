//! Scenes, cameras, shading and pictures of F(x, y, z) = C.
//!
//! A [`Plan`] says what a picture takes and what is left out. A [`Camera`] turns pixels into rays, [`render`] asks a tracer about them tile by tile on all cores, [`Shading`] turns
//! what was found into colours, and the resulting [`Picture`] writes itself to files.

mod camera;
mod clock;
mod color;
mod encode;
mod picture;
mod plan;
mod render;
mod shading;
mod size;
mod smooth;

pub use camera::{Camera, CameraError, Projection, View};
pub use clock::Stopwatch;
pub use color::{Color, color_from_srgb, srgb_from_color};
pub use encode::{EncodeError, ImageFormat};
pub use picture::{Layers, Picture, Status, StatusCounts};
pub use plan::{Buffer, Decision, Given, Pass, Plan, Wanted};
pub use render::{Progress, RenderError, Scene, render};
pub use shading::Shading;
pub use size::{Size, SizeError};
pub use smooth::Smoothing;
