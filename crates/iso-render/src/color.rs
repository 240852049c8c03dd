//! Colours in linear light, and their bytes in sRGB (IEC 61966-2-1).

use std::sync::LazyLock;

use glam::DVec3;

/// A colour as red, green and blue in linear light, 1 being the brightest that a picture shows.
pub type Color = DVec3;

/// The colour of three sRGB bytes.
pub fn color_from_srgb(bytes: [u8; 3]) -> Color {
    DVec3::from_array(bytes.map(|byte| BYTES[usize::from(byte)]))
}

/// The nearest three sRGB bytes; what is brighter than 1 becomes 1.
pub fn srgb_from_color(color: Color) -> [u8; 3] {
    let borders = &*BORDERS;
    color.to_array().map(|component| {
        // NaN and what is negative count as no light.
        let part = (component * PARTS as f64) as usize;
        let mut byte = borders.passed.get(part).copied().unwrap_or(u8::MAX);
        while byte < u8::MAX && borders.ends[usize::from(byte)] <= component {
            byte += 1;
        }
        byte
    })
}

/// Linear light of an sRGB component from 0 to 255.
fn linear(component: f64) -> f64 {
    let encoded = component / 255.0;
    if encoded <= 0.040_45 { encoded / 12.92 } else { core_math::pow((encoded + 0.055) / 1.055, 2.4) }
}

/// The linear light of each byte.
static BYTES: LazyLock<[f64; 256]> = LazyLock::new(|| std::array::from_fn(|byte| linear(byte as f64)));

/// Into how many equal parts linear light is cut to find its byte in.
const PARTS: usize = 4096;

/// Where bytes end.
struct Borders {
    /// The linear light at which each byte gives way to the next.
    ends: [f64; 255],
    /// How many of those lie before each part: the byte at which it begins.
    passed: [u8; PARTS],
}

static BORDERS: LazyLock<Borders> = LazyLock::new(|| {
    let ends: [f64; 255] = std::array::from_fn(|byte| linear(byte as f64 + 0.5));
    let passed = std::array::from_fn(|part| {
        let start = part as f64 / PARTS as f64;
        ends.partition_point(|end| *end <= start) as u8
    });
    Borders { ends, passed }
});

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_survive_the_way_to_linear_light_and_back() {
        for byte in 0..=255 {
            assert_eq!(srgb_from_color(color_from_srgb([byte, 255 - byte, 0])), [byte, 255 - byte, 0]);
        }
    }

    #[test]
    fn every_light_has_the_byte_whose_borders_it_lies_between() {
        for step in 0..1_000_000 {
            let light = f64::from(step) / 999_999.0;
            let [byte, ..] = srgb_from_color(DVec3::splat(light)).map(f64::from);
            assert!(byte == 0.0 || linear(byte - 0.5) <= light, "{light}");
            assert!(byte == 255.0 || light < linear(byte + 0.5), "{light}");
        }
    }

    #[test]
    fn light_out_of_range_is_clipped() {
        assert_eq!(srgb_from_color(DVec3::new(-1.0, 7.0, f64::NAN)), [0, 255, 0]);
    }

    /// Reference values of IEC 61966-2-1: half of the light is byte 188, byte 128 is 21.6 % of the light.
    #[test]
    fn middle_grey_is_where_the_standard_has_it() {
        assert_eq!(srgb_from_color(DVec3::splat(0.5)), [188; 3]);
        assert!((color_from_srgb([128; 3]).x - 0.215_860_5).abs() < 1e-7);
    }
}
