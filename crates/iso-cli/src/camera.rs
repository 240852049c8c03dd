//! From the camera's flags to a view and a projection.

use iso_grid::Fitted;
use iso_render::{Camera, CameraError, Projection, Size, View};

use crate::flags::CameraFlags;

/// The camera that `flags` describe, for pictures of `size` that look into a region, and there at what is found of the surface.
pub(crate) fn camera(flags: &CameraFlags, fitted: &Fitted, size: Size) -> Result<Camera, CameraError> {
    Camera::looking_at(view(flags, fitted), projection(flags), fitted, size)
}

fn view(flags: &CameraFlags, fitted: &Fitted) -> View {
    let is_default = flags.yaw.is_none() && flags.pitch.is_none();
    let View::Orbit { yaw, pitch, .. } = (if is_default { View::of(fitted) } else { View::DEFAULT }) else {
        unreachable!("cameras orbit the region by default");
    };
    match flags.eye {
        Some(eye) => {
            View::LookAt { eye, target: flags.target.unwrap_or_else(|| fitted.center()), up: flags.up }
        }
        None => View::Orbit {
            yaw: flags.yaw.unwrap_or(yaw),
            pitch: flags.pitch.unwrap_or(pitch),
            distance: flags.distance,
            target: flags.target,
        },
    }
}

/// The projection that `flags` describe.
pub(crate) fn projection(flags: &CameraFlags) -> Projection {
    match (flags.ortho, flags.fov) {
        (true, _) => Projection::Orthographic { view_width: flags.view_width },
        (false, Some(fov)) => Projection::Perspective { fov },
        (false, None) => Projection::DEFAULT,
    }
}
