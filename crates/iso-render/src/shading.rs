//! Shading: what a point of the surface looks like.

use glam::DVec3;
use iso_grid::Outcome;

use crate::color::{Color, color_from_srgb};
use crate::{Background, Camera, Look, Size};

/// Materials and lights. Both sides of the surface are lit alike and told apart by colour.
///
/// Three lights are fixed to the camera, so that a surface looks well from every side: a key light from the upper left, a
/// fill light from the right, and a head light. The highlight is Blinn's (1977).
#[derive(Clone, Debug)]
pub struct Shading {
    /// The side where F > C lies towards the viewer.
    outside: Color,
    /// The side where F < C lies towards the viewer.
    inside: Color,
    /// The surface where no normal is known.
    unlit: Color,
    /// Where it is not known whether there is a surface.
    unknown: Color,
    background: [Color; 2],
    /// How much of the ambient light comes from above rather than from all sides.
    sky: DVec3,
    lights: [Light; 3],
    shows_statuses: bool,
}

#[derive(Clone, Copy, Debug)]
struct Light {
    /// The unit vector towards the light.
    towards: DVec3,
    /// The unit vector halfway between the light and the viewer.
    halfway: DVec3,
    strength: f64,
    highlight: f64,
}

const AMBIENT: f64 = 0.14;

impl Shading {
    /// Pictures that look like this, with lights around `camera`.
    pub fn new(camera: &Camera, look: &Look) -> Self {
        let light = |right: f64, up: f64, back: f64, strength: f64, highlight: f64| {
            let towards = (right * camera.right() + up * camera.up() - back * camera.forward()).normalize();
            let halfway = (towards - camera.forward()).normalize();
            Light { towards, halfway, strength, highlight }
        };
        let background = match look.background {
            Background::Colors { top, bottom } => [top, bottom].map(color_from_srgb),
            Background::Transparent => [Color::ZERO; 2],
        };
        Self {
            outside: color_from_srgb(look.outside),
            inside: color_from_srgb(look.inside),
            unlit: color_from_srgb([150, 150, 150]),
            unknown: color_from_srgb([112, 112, 118]),
            background,
            sky: camera.up(),
            lights: [
                light(-0.55, 0.75, 0.65, 0.62, 0.22),
                light(0.85, 0.10, 0.55, 0.18, 0.0),
                light(0.0, 0.0, 1.0, 0.20, 0.04),
            ],
            shows_statuses: look.shows_statuses,
        }
    }

    /// The colour of a pixel from what its ray, which runs along `view`, found in front of `background`. `normal` points towards
    /// larger F; NaN where there is none.
    pub fn color(&self, outcome: &Outcome, normal: DVec3, view: DVec3, background: Color) -> Color {
        match outcome {
            Outcome::Miss => background,
            Outcome::Undecided(_) if self.shows_statuses => color_from_srgb([214, 40, 160]),
            // Neither the surface nor its absence is proven, and neither is drawn.
            Outcome::Undecided(_) => self.unknown,
            Outcome::Touch(_) if self.shows_statuses => {
                let lit = self.surface(normal, view);
                0.35 * lit + 0.65 * color_from_srgb([40, 170, 90])
            }
            Outcome::Hit(_) | Outcome::Touch(_) => self.surface(normal, view),
        }
    }

    /// What is seen in a row where nothing is found.
    pub fn background(&self, row: u32, size: Size) -> Color {
        let depth = (f64::from(row) + 0.5) / f64::from(size.height());
        let [top, bottom] = self.background;
        top.lerp(bottom, depth)
    }

    fn surface(&self, normal: DVec3, view: DVec3) -> Color {
        if normal.is_nan() {
            return self.unlit;
        }
        let facing = normal.dot(view);
        let (normal, material) = if facing <= 0.0 { (normal, self.outside) } else { (-normal, self.inside) };
        let mut diffuse = AMBIENT * (1.0 + 0.5 * normal.dot(self.sky));
        let mut highlight = 0.0;
        for light in &self.lights {
            // Light wraps a little around the surface, which keeps its dark side readable.
            let wrapped = (normal.dot(light.towards) + 0.25) / 1.25;
            diffuse += light.strength * wrapped.max(0.0);
            highlight += light.highlight * sixty_fourth_power(normal.dot(light.halfway).max(0.0));
        }
        let rim = 1.0 - facing.abs().min(1.0);
        material * diffuse * (1.0 - 0.35 * rim * rim * rim) + DVec3::splat(highlight)
    }
}

/// x⁶⁴ by squaring: the same on every machine, unlike a library's power.
fn sixty_fourth_power(x: f64) -> f64 {
    (0..6).fold(x, |power, _| power * power)
}
