//! Animations: pictures that follow each other in one GIF file.

use std::io::Write;
use std::time::Duration;

use image::codecs::gif::{GifEncoder, Repeat};
use image::{Delay, Frame, RgbaImage};

use crate::{EncodeError, Picture};

/// How well 256 colours are chosen for each picture, from 1, the best, to 30: a tenth of the time for hardly a difference.
const SPEED: i32 = 10;

/// An animated GIF, which begins again when it is over. It is whole once this is dropped.
pub struct Animation<W: Write>(GifEncoder<W>);

impl<W: Write> Animation<W> {
    /// How long each picture is shown.
    pub const PICTURE: Duration = Duration::from_millis(50);

    /// An animation without pictures yet.
    ///
    /// # Errors
    /// When writing fails.
    pub fn new(writer: W) -> Result<Self, EncodeError> {
        let mut encoder = GifEncoder::new_with_speed(writer, SPEED);
        encoder.set_repeat(Repeat::Infinite)?;
        Ok(Self(encoder))
    }

    /// Adds the shaded layer of a picture.
    ///
    /// # Errors
    /// When the format cannot hold a picture of this size, or writing fails.
    pub fn add(&mut self, picture: &Picture) -> Result<(), EncodeError> {
        let pixels =
            picture.color.iter().flat_map(|&[red, green, blue]| [red, green, blue, u8::MAX]).collect();
        let image = RgbaImage::from_raw(picture.size.width(), picture.size.height(), pixels)
            .expect("a picture has as many pixels as its size says");
        Ok(self.0.encode_frame(Frame::from_parts(
            image,
            0,
            0,
            Delay::from_saturating_duration(Self::PICTURE),
        ))?)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use image::AnimationDecoder;
    use image::codecs::gif::GifDecoder;

    use super::super::testing::picture;
    use super::*;

    #[test]
    fn animations_read_back_as_written() {
        let (first, mut second) = (picture(), picture());
        second.color.reverse();
        let mut bytes = Vec::new();
        let mut animation = Animation::new(&mut bytes).unwrap();
        for picture in [&first, &second] {
            animation.add(picture).unwrap();
        }
        drop(animation);
        let frames = GifDecoder::new(Cursor::new(bytes)).unwrap().into_frames().collect_frames().unwrap();
        assert_eq!(frames.len(), 2);
        for (frame, picture) in frames.iter().zip([first, second]) {
            assert_eq!(Duration::from(frame.delay()), Animation::<Vec<u8>>::PICTURE);
            // Six colours fit into a palette.
            let colors = frame.buffer().pixels().map(|pixel| [pixel[0], pixel[1], pixel[2]]);
            assert_eq!(colors.collect::<Vec<_>>(), *picture.color);
        }
    }
}
