//! What is up to taste: colours.

/// The colours of a picture, each as three sRGB bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// The side of the surface where F > C lies towards the viewer.
    pub outside: [u8; 3],
    /// The side where F < C does.
    pub inside: [u8; 3],
    /// What is seen where there is no surface.
    pub background: Background,
    /// Whether pixels that are not a plain hit or miss are painted over: touches green, undecided ones magenta. Undecided pixels are grey
    /// otherwise.
    pub shows_statuses: bool,
}

/// What is seen where there is no surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Background {
    /// One colour at the top of the picture that turns into another at its bottom, evenly in linear light.
    Colors {
        /// The colour at the top.
        top: [u8; 3],
        /// That at the bottom.
        bottom: [u8; 3],
    },
    /// Whatever the picture is laid upon, as [`Layers::coverage`](crate::Layers::coverage) says. Where nothing covers it, the picture is black.
    Transparent,
}

impl Look {
    /// An orange surface that is blue inside, in front of a bright sky.
    pub const DEFAULT: Self = Self {
        outside: [236, 156, 72],
        inside: [72, 138, 196],
        background: Background::Colors { top: [250, 251, 253], bottom: [206, 214, 224] },
        shows_statuses: false,
    };
}

impl Default for Look {
    fn default() -> Self {
        Self::DEFAULT
    }
}
