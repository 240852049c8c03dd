//! Writing pictures: shaded ones in the format of a file's extension, depths and normals as OpenEXR.

use std::io::{Seek, Write};
use std::path::Path;

use exr::math::Vec2;
use exr::prelude::{Image, SpecificChannels, WritableImage};
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use thiserror::Error;

use crate::Picture;

/// A file format for shaded pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageFormat(image::ImageFormat);

/// Why a picture could not be encoded.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EncodeError {
    /// The file's name ends in nothing that names a format.
    #[error("{given} names no picture format that can be written; use one of {}", ImageFormat::EXTENSIONS.join(", "))]
    UnknownFormat {
        /// The extension as given, or a description where there is none.
        given: String,
    },
    /// The format cannot hold the picture, or writing failed.
    #[error("the picture cannot be written: {0}")]
    Image(#[from] image::ImageError),
    /// Writing an OpenEXR file failed.
    #[error("the OpenEXR file cannot be written: {0}")]
    OpenExr(#[from] exr::error::Error),
}

impl ImageFormat {
    /// The file name extensions that can be written.
    pub const EXTENSIONS: [&'static str; 9] =
        ["png", "jpg", "jpeg", "webp", "tif", "tiff", "bmp", "ppm", "qoi"];

    /// The format that belongs to the extension of `path`.
    ///
    /// # Errors
    /// When there is no extension, or one that is not among [`ImageFormat::EXTENSIONS`].
    pub fn of(path: &Path) -> Result<Self, EncodeError> {
        let Some(extension) = path.extension().and_then(|extension| extension.to_str()) else {
            return Err(EncodeError::UnknownFormat { given: format!("“{}”", path.display()) });
        };
        let extension = extension.to_ascii_lowercase();
        let known = Self::EXTENSIONS.contains(&extension.as_str());
        match image::ImageFormat::from_extension(&extension) {
            Some(format) if known => Ok(Self(format)),
            _ => Err(EncodeError::UnknownFormat { given: format!("“.{extension}”") }),
        }
    }
}

impl Picture {
    /// Writes the shaded layer in `format`.
    ///
    /// # Errors
    /// When the format cannot hold a picture of this size, or writing fails.
    pub fn write_color(&self, format: ImageFormat, mut writer: impl Write + Seek) -> Result<(), EncodeError> {
        let (bytes, width, height) = (self.color.as_flattened(), self.size.width(), self.size.height());
        let rgb = ExtendedColorType::Rgb8;
        match format.0 {
            // The picture is waited for: half the compression time for a few per cent of size.
            image::ImageFormat::Png => {
                PngEncoder::new_with_quality(writer, CompressionType::Fast, FilterType::Adaptive)
                    .write_image(bytes, width, height, rgb)?;
            }
            image::ImageFormat::Jpeg => {
                JpegEncoder::new_with_quality(writer, 95).write_image(bytes, width, height, rgb)?;
            }
            other => image::write_buffer_with_format(&mut writer, bytes, width, height, rgb, other)?,
        }
        Ok(())
    }

    /// Writes the depths as the one 32-bit float channel `Z` of an OpenEXR file; NaN where nothing was found,
    /// −∞ where pixels are unfinished.
    ///
    /// # Errors
    /// When writing fails.
    pub fn write_depth(&self, writer: impl Write + Seek) -> Result<(), EncodeError> {
        let channels = SpecificChannels::build()
            .with_channel("Z")
            .with_pixel_fn(|position: Vec2<usize>| (self.depth[self.pixel(position)] as f32,));
        Ok(Image::from_channels(self.dimensions(), channels).write().non_parallel().to_buffered(writer)?)
    }

    /// Writes the normals as the three 32-bit float channels `N.X`, `N.Y` and `N.Z` of an OpenEXR file; NaN where there
    /// is none, zero where pixels are unfinished.
    ///
    /// # Errors
    /// When writing fails.
    pub fn write_normals(&self, writer: impl Write + Seek) -> Result<(), EncodeError> {
        let channels = SpecificChannels::build()
            .with_channel("N.X")
            .with_channel("N.Y")
            .with_channel("N.Z")
            .with_pixel_fn(|position: Vec2<usize>| {
                let normal = self.normals[self.pixel(position)].as_vec3();
                (normal.x, normal.y, normal.z)
            });
        Ok(Image::from_channels(self.dimensions(), channels).write().non_parallel().to_buffered(writer)?)
    }

    fn pixel(&self, position: Vec2<usize>) -> usize {
        position.y() * self.size.width() as usize + position.x()
    }

    fn dimensions(&self) -> (usize, usize) {
        (self.size.width() as usize, self.size.height() as usize)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use exr::prelude::{ReadChannels, ReadLayers, read};
    use glam::DVec3;

    use super::*;
    use crate::{Layers, Size};

    #[test]
    fn formats_come_from_extensions() {
        for extension in ImageFormat::EXTENSIONS {
            assert!(ImageFormat::of(Path::new(&format!("a.{extension}"))).is_ok(), "{extension}");
            assert!(ImageFormat::of(Path::new(&format!("a.{}", extension.to_uppercase()))).is_ok());
        }
        for path in ["a", "a.", "a.txt", ".png", "a.exr"] {
            assert!(
                matches!(ImageFormat::of(Path::new(path)), Err(EncodeError::UnknownFormat { .. })),
                "{path}"
            );
        }
    }

    fn picture() -> Picture {
        let all = Layers { depth: true, normals: true, ..Layers::COLOR };
        let mut picture = Picture::with_room(Size::new(3, 2).unwrap(), all).unwrap();
        picture.color = (0..6).map(|pixel| [pixel, 40 * pixel, 255 - pixel]).collect();
        picture.depth = vec![f64::NAN; 6];
        picture.depth[4] = 1.25;
        picture.normals[4] = DVec3::new(0.0, -0.6, 0.8);
        picture
    }

    #[test]
    fn lossless_formats_read_back_as_written() {
        let picture = picture();
        for extension in ["png", "webp", "tiff", "bmp", "ppm", "qoi"] {
            let format = ImageFormat::of(Path::new("a").with_extension(extension).as_path()).unwrap();
            let mut file = Cursor::new(Vec::new());
            picture.write_color(format, &mut file).unwrap();
            let read = image::load_from_memory_with_format(file.get_ref(), format.0).unwrap().into_rgb8();
            assert_eq!((read.dimensions(), read.as_raw().as_slice()), ((3, 2), picture.color.as_flattened()));
        }
    }

    #[test]
    fn depths_and_normals_read_back_as_written() {
        let picture = picture();
        let (mut depth, mut normals) = (Cursor::new(Vec::new()), Cursor::new(Vec::new()));
        picture.write_depth(&mut depth).unwrap();
        picture.write_normals(&mut normals).unwrap();
        assert_eq!(
            channels(depth),
            [("Z".to_owned(), vec![f32::NAN, f32::NAN, f32::NAN, f32::NAN, 1.25, f32::NAN])]
                .map(|(name, values)| (name, bits(&values)))
        );
        let found: Vec<_> = channels(normals).into_iter().map(|(name, bits)| (name, bits[4])).collect();
        assert_eq!(
            found,
            [("N.X", 0.0_f32), ("N.Y", -0.6), ("N.Z", 0.8)]
                .map(|(name, value)| (name.to_owned(), value.to_bits()))
        );
    }

    fn bits(values: &[f32]) -> Vec<u32> {
        values.iter().map(|value| value.to_bits()).collect()
    }

    fn channels(mut file: Cursor<Vec<u8>>) -> Vec<(String, Vec<u32>)> {
        file.set_position(0);
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes();
        let image = image.from_buffered(file).unwrap();
        let channels = image.layer_data.channel_data.list.into_iter();
        channels
            .map(|channel| {
                (channel.name.to_string(), bits(&channel.sample_data.values_as_f32().collect::<Vec<_>>()))
            })
            .collect()
    }
}
