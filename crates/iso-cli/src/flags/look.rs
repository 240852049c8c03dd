//! Flags for what pictures look like.

use clap::Args;
use iso_render::{Background, Look};

use crate::values;

/// What is behind the surface.
#[derive(Clone, Copy, Debug, Args)]
#[command(next_help_heading = "Look")]
pub(crate) struct BackgroundFlag {
    /// The colour of the background, or those at its top and its bottom; `none` makes it transparent [default: a bright sky]
    #[arg(long, value_name = "COLOR[,COLOR]", value_parser = values::background)]
    pub(crate) background: Option<Background>,
}

impl BackgroundFlag {
    pub(crate) fn is_transparent(self) -> bool {
        self.background == Some(Background::Transparent)
    }
}

/// What the surface looks like.
#[derive(Clone, Copy, Debug, Args)]
#[command(next_help_heading = "Look")]
pub(crate) struct PaintFlags {
    /// The colour of the surface, such as `gold` or `#3a7bd5`, or that of the side where F > C and that of the other: `gold,#3a7bd5`
    /// [default: a soft orange and a soft blue]
    #[arg(long, value_name = "COLOR[,COLOR]", value_parser = values::colors)]
    pub(crate) colors: Option<[[u8; 3]; 2]>,

    /// Paint over pixels that are not proven: touches green, undecided ones magenta
    #[arg(long)]
    pub(crate) show_status: bool,
}

impl PaintFlags {
    /// How a picture with this background is painted.
    pub(crate) fn look(self, background: BackgroundFlag) -> Look {
        let [outside, inside] = self.colors.unwrap_or([Look::DEFAULT.outside, Look::DEFAULT.inside]);
        let background = background.background.unwrap_or(Look::DEFAULT.background);
        Look { outside, inside, background, shows_statuses: self.show_status }
    }
}
