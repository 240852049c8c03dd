//! Flags that say from where the surface is seen.

use clap::Args;
use glam::DVec3;

use crate::values;

/// The camera. By default it stands far enough away to see all that is found of the surface, or a box that is given.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Camera", allow_negative_numbers = true)]
pub(crate) struct CameraFlags {
    /// Degrees around the z axis, counter-clockwise from above; 0 looks along +y [default: 30, or another where that shows a surface from its edge]
    #[arg(long, value_name = "DEGREES", value_parser = values::finite, conflicts_with = "eye")]
    pub(crate) yaw: Option<f64>,

    /// Degrees above the xy plane; 90 looks straight down [default: 25]
    #[arg(long, value_name = "DEGREES", value_parser = values::finite, conflicts_with = "eye")]
    pub(crate) pitch: Option<f64>,

    /// The angle between the upper and the lower edge of the picture [default: 30]
    #[arg(long, value_name = "DEGREES", value_parser = values::finite, conflicts_with = "ortho")]
    pub(crate) fov: Option<f64>,

    /// The distance from the target [default: so far that all is seen]
    #[arg(long, value_name = "LENGTH", value_parser = values::positive, conflicts_with = "eye")]
    pub(crate) distance: Option<f64>,

    /// Look along parallel rays
    #[arg(long)]
    pub(crate) ortho: bool,

    /// The width of the picture in units of x, y and z [default: so wide that all is seen]
    #[arg(long, value_name = "LENGTH", value_parser = values::positive, requires = "ortho")]
    pub(crate) view_width: Option<f64>,

    /// Stand here instead of on a sphere around the target
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    pub(crate) eye: Option<DVec3>,

    /// Look there [default: the middle of what is seen]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    pub(crate) target: Option<DVec3>,

    /// Which direction is up in the picture [default: 0,0,1, or 0,1,0 for a view along z]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    #[arg(requires = "eye")]
    pub(crate) up: Option<DVec3>,
}
