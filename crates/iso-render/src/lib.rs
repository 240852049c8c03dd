//! Scenes, cameras, shading and pictures of F(x, y, z) = C.
//!
//! A [`Plan`] says what a picture takes and what is left out. A [`Camera`] turns pixels into rays, [`render`] asks a tracer
//! about them tile by tile on all cores, [`Shading`] turns what was found into colours, and the resulting [`Picture`] writes
//! itself to files: in the usual formats with the feature `images`, as OpenEXR with the feature `openexr`.

mod bands;
mod camera;
mod clock;
mod color;
#[cfg(any(feature = "images", feature = "openexr"))]
mod encode;
mod layer;
mod look;
mod mosaic;
mod picture;
mod plan;
mod render;
mod shading;
mod size;
mod smooth;

pub use camera::{Camera, CameraError, Projection, View};
pub use clock::Stopwatch;
pub use color::{Color, color_from_srgb, srgb_from_color};
#[cfg(any(feature = "images", feature = "openexr"))]
pub use encode::EncodeError;
#[cfg(feature = "images")]
pub use encode::{Animation, ImageFormat};
pub use layer::Layer;
pub use look::{Background, Look};
pub use mosaic::{Mosaic, Nothing};
pub use picture::{Layers, Picture, Status, StatusCounts};
pub use plan::{Buffer, Decision, Given, Pass, Plan, Wanted};
pub use render::{Progress, RenderError, Scene, render, render_over};
pub use shading::Shading;
pub use size::{Size, SizeError};
pub use smooth::Smoothing;

/// The examples of the documentation, as tests.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/library.md")]
struct LibraryExamples;
