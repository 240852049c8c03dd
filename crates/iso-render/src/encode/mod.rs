//! Writing pictures: shaded ones in the format of a file's extension, depths and normals as OpenEXR.

#[cfg(feature = "images")]
mod animation;
#[cfg(feature = "images")]
mod images;
#[cfg(feature = "openexr")]
mod openexr;

use thiserror::Error;

#[cfg(feature = "images")]
pub use animation::Animation;
#[cfg(feature = "images")]
pub use images::ImageFormat;

/// Why a picture could not be encoded.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EncodeError {
    /// The file's name ends in nothing that names a format.
    #[cfg(feature = "images")]
    #[error("{given} names no picture format that can be written; use one of {}", ImageFormat::EXTENSIONS.join(", "))]
    UnknownFormat {
        /// The extension as given, or a description where there is none.
        given: String,
    },
    /// The format cannot hold the picture, or writing failed.
    #[cfg(feature = "images")]
    #[error("the picture cannot be written: {0}")]
    Image(#[from] image::ImageError),
    /// Writing an OpenEXR file failed.
    #[cfg(feature = "openexr")]
    #[error("the OpenEXR file cannot be written: {0}")]
    OpenExr(#[from] exr::error::Error),
}

#[cfg(test)]
mod testing {
    use glam::Vec3;

    use crate::mosaic::Area;
    use crate::{Layers, Picture, Size};

    /// Six pixels, of which one shows something.
    pub(super) fn picture() -> Picture {
        let all = Layers { depth: true, normals: true, ..Layers::COLOR };
        let mut picture = Picture::empty(Size::new(3, 2).unwrap());
        picture.make_room(all).unwrap();
        picture.color = (0..6).map(|pixel| [pixel, 40 * pixel, 255 - pixel]).collect();
        let tile = Area::tiles(picture.size)[0];
        let is_found = |pixel| pixel == 4;
        let depth = (0..6).map(|pixel| if is_found(pixel) { 1.25 } else { f64::NAN });
        let normals = (0..6).map(|pixel| if is_found(pixel) { Vec3::new(0.0, -0.6, 0.8) } else { Vec3::NAN });
        picture.depth.strips()().put(tile, depth);
        picture.normals.strips()().put(tile, normals);
        picture
    }
}
