//! Shaded pictures, in the format of a file's extension.

use std::io::{Seek, Write};
use std::path::Path;

use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::codecs::pnm::{PnmEncoder, PnmSubtype, SampleEncoding};
use image::{ExtendedColorType, ImageEncoder};

use crate::{EncodeError, Picture};

/// A file format for shaded pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageFormat(image::ImageFormat);

impl ImageFormat {
    /// The usual one: exact, and small.
    pub const PNG: Self = Self(image::ImageFormat::Png);

    /// The file name extensions that can be written.
    pub const EXTENSIONS: [&'static str; 10] =
        ["png", "jpg", "jpeg", "webp", "tif", "tiff", "bmp", "ppm", "qoi", "gif"];

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

    /// Whether pictures keep a [transparent background](crate::Background::Transparent).
    pub fn has_transparency(self) -> bool {
        use image::ImageFormat::{Png, Qoi, WebP};
        matches!(self.0, Png | Qoi | WebP)
    }

    /// The most columns and rows that a file holds.
    pub fn longest_side(self) -> u32 {
        match self.0 {
            image::ImageFormat::Jpeg | image::ImageFormat::Gif => u32::from(u16::MAX),
            image::ImageFormat::WebP => 1 << 14,
            _ => u32::MAX,
        }
    }
}

impl Picture {
    /// Writes the shaded layer in `format`, and its coverage where there is one and the format [keeps it](ImageFormat::has_transparency).
    ///
    /// # Errors
    /// When the format cannot hold a picture of this size, or writing fails.
    pub fn write_color(&self, format: ImageFormat, mut writer: impl Write + Seek) -> Result<(), EncodeError> {
        let (width, height) = (self.size.width(), self.size.height());
        let with_coverage: Vec<u8>;
        let (bytes, color) = if self.coverage.is_empty() || !format.has_transparency() {
            (self.color.as_flattened(), ExtendedColorType::Rgb8)
        } else {
            let pixels = self.color.iter().zip(self.coverage.iter());
            with_coverage =
                pixels.flat_map(|(&[red, green, blue], alpha)| [red, green, blue, *alpha]).collect();
            (&with_coverage[..], ExtendedColorType::Rgba8)
        };
        match format.0 {
            // The picture is waited for: half the compression time for a few per cent of size.
            image::ImageFormat::Png => {
                PngEncoder::new_with_quality(writer, CompressionType::Fast, FilterType::Adaptive)
                    .write_image(bytes, width, height, color)?;
            }
            image::ImageFormat::Jpeg => {
                JpegEncoder::new_with_quality(writer, 95).write_image(bytes, width, height, color)?;
            }
            // The usual form, which is not what is chosen for a name by itself.
            image::ImageFormat::Pnm => {
                PnmEncoder::new(writer)
                    .with_subtype(PnmSubtype::Pixmap(SampleEncoding::Binary))
                    .write_image(bytes, width, height, color)?;
            }
            other => image::write_buffer_with_format(&mut writer, bytes, width, height, color, other)?,
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::super::testing::picture;
    use super::*;
    use crate::Size;

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

    #[test]
    fn formats_hold_their_longest_sides_and_no_longer_ones() {
        for extension in ["jpg", "gif", "webp"] {
            let format = ImageFormat::of(Path::new("a").with_extension(extension).as_path()).unwrap();
            for (width, fits) in [(format.longest_side(), true), (format.longest_side() + 1, false)] {
                let mut picture = Picture::empty(Size::new(width, 1).unwrap());
                picture.color = vec![[0; 3]; width as usize].into();
                let written = picture.write_color(format, &mut Cursor::new(Vec::new()));
                assert_eq!(written.is_ok(), fits, "{extension}, {width} columns");
            }
        }
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

    /// Of the forms of its family, the one that programs read.
    #[test]
    fn a_pixmap_is_one() {
        let mut file = Cursor::new(Vec::new());
        picture().write_color(ImageFormat::of(Path::new("a.ppm")).unwrap(), &mut file).unwrap();
        assert!(file.get_ref().starts_with(b"P6\n"));
    }

    #[test]
    fn coverage_is_kept_where_there_is_transparency() {
        let mut picture = picture();
        picture.coverage = vec![0, 255, 128, 7, 255, 0].into();
        for extension in ImageFormat::EXTENSIONS {
            let format = ImageFormat::of(&Path::new("a").with_extension(extension)).unwrap();
            let mut file = Cursor::new(Vec::new());
            picture.write_color(format, &mut file).unwrap();
            let read = image::load_from_memory_with_format(file.get_ref(), format.0).unwrap();
            let alphas: Vec<_> = read.to_rgba8().pixels().map(|pixel| pixel[3]).collect();
            let kept = if format.has_transparency() { &*picture.coverage } else { &[255; 6] };
            assert_eq!(alphas, kept, "{extension}");
        }
    }
}
