//! Flags for what pictures look like.

use clap::Args;
use iso_render::{Background, Look};

use crate::values;

/// What pictures look like.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Look")]
pub(crate) struct LookFlags {
    /// The colour of the surface, such as `gold` or `#3a7bd5`, or that of the side where F > C and that of the other: `gold,#3a7bd5`
    /// [default: a soft orange and a soft blue]
    #[arg(long, value_name = "COLOR[,COLOR]", value_parser = values::colors)]
    colors: Option<[[u8; 3]; 2]>,

    /// The colour of the background, or those at its top and its bottom; `none` makes it transparent [default: a bright sky]
    #[arg(long, value_name = "COLOR[,COLOR]", value_parser = values::background)]
    background: Option<Background>,

    /// Paint over pixels that are not proven: touches green, undecided ones magenta
    #[arg(long)]
    show_status: bool,
}

impl LookFlags {
    pub(crate) fn look(&self) -> Look {
        let [outside, inside] = self.colors.unwrap_or([Look::DEFAULT.outside, Look::DEFAULT.inside]);
        let background = self.background.unwrap_or(Look::DEFAULT.background);
        Look { outside, inside, background, shows_statuses: self.show_status }
    }

    pub(crate) fn is_given(&self) -> bool {
        self.colors.is_some() || self.background.is_some()
    }

    pub(crate) fn is_transparent(&self) -> bool {
        self.background == Some(Background::Transparent)
    }
}
