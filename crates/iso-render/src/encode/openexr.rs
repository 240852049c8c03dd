//! Depths and normals, as OpenEXR.

use std::io::{Seek, Write};

use exr::math::Vec2;
use exr::prelude::{Image, SpecificChannels, WritableImage};

use crate::{EncodeError, Picture};

impl Picture {
    /// Writes the depths as the one 32-bit float channel `Z` of an OpenEXR file; NaN where nothing was found,
    /// −∞ where pixels are unfinished.
    ///
    /// # Errors
    /// When writing fails.
    pub fn write_depth(&self, writer: impl Write + Seek) -> Result<(), EncodeError> {
        let channels = SpecificChannels::build()
            .with_channel("Z")
            .with_pixel_fn(|position: Vec2<usize>| (self.depth.get(self.pixel(position)) as f32,));
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
                <(f32, f32, f32)>::from(self.normals.get(self.pixel(position)))
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

    use super::super::testing::picture;

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
