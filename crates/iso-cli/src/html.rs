//! What goes into pages that need no other file.

use std::io::Cursor;
use std::path::Path;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use iso_render::{EncodeError, ImageFormat, Picture, Size};

/// Text as it may stand in HTML and SVG. Characters that these cannot hold are replaced.
pub(crate) fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\n' | '\t' => escaped.push(character),
            character if character.is_control() => escaped.push('\u{fffd}'),
            character => escaped.push(character),
        }
    }
    escaped
}

/// The address of an image that is part of the page itself: pixels row by row from the top, as PNG.
pub(crate) fn image_address(size: Size, color: Vec<[u8; 3]>) -> Result<String, EncodeError> {
    let picture = Picture { color: color.into(), ..Picture::empty(size) };
    let mut file = Cursor::new(Vec::new());
    picture.write_color(ImageFormat::of(Path::new("picture.png"))?, &mut file)?;
    Ok(format!("data:image/png;base64,{}", BASE64_STANDARD.encode(file.into_inner())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_cannot_break_out() {
        assert_eq!(escaped("a<b & \"c\" > d\u{1}"), "a&lt;b &amp; &quot;c&quot; &gt; d\u{fffd}");
    }
}
