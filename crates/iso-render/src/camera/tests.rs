use std::sync::Arc;

use iso_expr::{Ast, Interpreter};
use iso_grid::{Surface, Workspace};

use super::*;

const CLOSE: f64 = 1e-12;

fn region() -> Region {
    Region::new(DVec3::new(-1.0, -2.0, -3.0), DVec3::new(3.0, 2.0, 1.0)).unwrap()
}

fn orbit(yaw: f64, pitch: f64) -> View {
    View::Orbit { yaw, pitch, distance: None, target: None }
}

#[test]
fn yaw_zero_looks_along_y_with_x_to_the_right() {
    let camera =
        Camera::new(orbit(0.0, 0.0), Projection::DEFAULT, &region(), Size::new(64, 48).unwrap()).unwrap();
    assert!((camera.forward() - DVec3::Y).length() < CLOSE);
    assert!((camera.right() - DVec3::X).length() < CLOSE);
    assert!((camera.up() - DVec3::Z).length() < CLOSE);
}

#[test]
fn cameras_orbit_their_target() {
    let size = Size::new(2, 2).unwrap();
    let target = DVec3::new(2.5, -1.0, 0.5);
    for projection in [Projection::DEFAULT, Projection::Orthographic { view_width: None }] {
        for distance in [None, Some(7.0)] {
            let view = |target| View::Orbit { yaw: 20.0, pitch: 35.0, distance, target };
            let [there, usual] = [Some(target), None]
                .map(|target| Camera::new(view(target), projection, &region(), size).unwrap());
            let from_there = |camera: &Camera, from: DVec3| camera.raster.ray(0.0, 0.0).origin - from;
            let eye = from_there(&there, target);
            assert!(eye.cross(there.forward()).length() < CLOSE && eye.dot(there.forward()) < 0.0);
            assert_eq!(there.forward(), usual.forward());
            // As large as in the picture of the middle.
            let scales = [&there, &usual].map(|camera| camera.ray(0, 0).origin - camera.ray(1, 0).origin);
            assert!((scales[0] - scales[1]).length() < CLOSE);
            if matches!(projection, Projection::Perspective { .. }) {
                assert!((eye - from_there(&usual, region().center())).length() < CLOSE);
            } else if distance.is_none() {
                assert!(eye.length() > region().extent().length());
            }
        }
    }
}

#[test]
fn pitch_ninety_looks_straight_down() {
    let camera =
        Camera::new(orbit(0.0, 90.0), Projection::DEFAULT, &region(), Size::new(64, 48).unwrap()).unwrap();
    assert!((camera.forward() + DVec3::Z).length() < CLOSE);
    assert!((camera.up() - DVec3::Y).length() < CLOSE);
}

/// The corners of the region are inside the picture, and some come close to its edge.
#[test]
fn the_whole_region_is_in_the_picture() {
    let region = region();
    let (half, center) = (0.5 * region.extent(), region.center());
    for (width, height) in [(100, 100), (300, 100), (100, 300)] {
        for projection in [Projection::DEFAULT, Projection::Orthographic { view_width: None }] {
            let size = Size::new(width, height).unwrap();
            let camera = Camera::new(View::DEFAULT, projection, &region, size).unwrap();
            let farthest = (0..8)
                .map(|corner| {
                    let signs =
                        DVec3::from_array([1, 2, 4].map(|bit| if corner & bit == 0 { -1.0 } else { 1.0 }));
                    let [column, row] = project(&camera, center + signs * half);
                    let (across, along) =
                        (2.0 * column / f64::from(width) - 1.0, 2.0 * row / f64::from(height) - 1.0);
                    across.abs().max(along.abs())
                })
                .fold(0.0, f64::max);
            assert!((farthest - FILLED).abs() < 1e-9, "{width}x{height} {projection:?}: {farthest}");
        }
    }
}

/// Its outline is inside the picture, and comes close to its edge.
#[test]
fn all_of_a_sphere_is_in_the_picture() {
    let sphere = Sphere { center: DVec3::new(0.5, -0.2, 0.1), radius: 0.3 };
    let fitted = Fitted { sphere: Some(sphere), ..region().into() };
    for (width, height) in [(100, 100), (300, 100), (100, 300)] {
        for projection in [Projection::DEFAULT, Projection::Orthographic { view_width: None }] {
            let size = Size::new(width, height).unwrap();
            let camera = Camera::looking_at(View::DEFAULT, projection, &fitted, size).unwrap();
            let mut farthest: f64 = 0.0;
            for step in 0..360 {
                let angle = f64::from(step).to_radians();
                // Seen from the eye, the outline is a little nearer than the middle.
                for tilt in 0..90 {
                    let tilt = f64::from(tilt).to_radians();
                    let across = angle.cos() * camera.right() + angle.sin() * camera.up();
                    let outward = tilt.cos() * across - tilt.sin() * camera.forward();
                    let [column, row] = project(&camera, sphere.center + sphere.radius * outward);
                    let [column, row] = [
                        (column - camera.middle[0]) / camera.middle[0],
                        (row - camera.middle[1]) / camera.middle[1],
                    ];
                    farthest = farthest.max(column.abs()).max(row.abs());
                }
            }
            let off = (farthest - FILLED_BY_SPHERE).abs();
            assert!(off < 1e-4, "{width}x{height} {projection:?}: {farthest}");
        }
    }
}

/// As far as doubles go, for squares of lengths go half as far.
#[test]
fn cameras_see_regions_of_any_size() {
    let size = Size::new(100, 80).unwrap();
    for power in [-1000, -540, -500, 500, 540, 1000] {
        let half = 2_f64.powi(power);
        let region = Region::new(DVec3::splat(-half), DVec3::splat(half)).unwrap();
        let views = [View::DEFAULT, View::LookAt { eye: DVec3::splat(half), target: DVec3::ZERO, up: None }];
        for view in views {
            for projection in [Projection::DEFAULT, Projection::Orthographic { view_width: None }] {
                let camera = Camera::new(view, projection, &region, size).unwrap();
                for axis in [camera.forward(), camera.right(), camera.up()] {
                    assert!((axis.length() - 1.0).abs() < CLOSE, "{power} {view:?} {projection:?}: {axis}");
                }
            }
        }
    }
}

#[test]
fn a_region_that_is_smaller_than_the_sphere_is_shown_instead() {
    let (region, size) = (region(), Size::new(100, 80).unwrap());
    let sphere = Sphere { center: region.center(), radius: region.extent().length() };
    let [whole, looking] = [None, Some(sphere)].map(|sphere| {
        let fitted = Fitted { sphere, ..region.into() };
        Camera::looking_at(View::DEFAULT, Projection::DEFAULT, &fitted, size).unwrap().raster
    });
    assert_eq!(whole, looking);
}

/// Where a point appears in the picture, in pixels from its upper left corner.
fn project(camera: &Camera, point: DVec3) -> [f64; 2] {
    let (eye, right, down, depth) = match camera.raster {
        Raster::Spreading { eye, forward, right, down } => (eye, right, down, (point - eye).dot(forward)),
        Raster::Parallel { middle, right, down, .. } => (middle, right, down, 1.0),
    };
    let offset = (point - eye) / depth;
    let along = |axis: DVec3, middle: f64| middle + offset.dot(axis) / axis.length_squared();
    [along(right, camera.middle[0]), along(down, camera.middle[1])]
}

/// A middle that was computed is seldom straight below.
#[test]
fn y_is_up_where_one_looks_along_z() {
    let size = Size::new(8, 8).unwrap();
    for (eye, up) in [(DVec3::new(1e-17, 0.0, 5.0), DVec3::Y), (DVec3::new(5.0, 0.0, 1e-17), DVec3::Z)] {
        let view = View::LookAt { eye, target: DVec3::ZERO, up: None };
        let camera = Camera::new(view, Projection::DEFAULT, &region(), size).unwrap();
        assert!((camera.up() - up).length() < CLOSE, "{}", camera.up());
    }
}

#[test]
fn degenerate_views_are_refused() {
    let size = Size::new(8, 8).unwrap();
    let new = |view, projection| Camera::new(view, projection, &region(), size).map(|_| ());
    let look = |eye, target, up| new(View::LookAt { eye, target, up: Some(up) }, Projection::DEFAULT);
    assert_eq!(look(DVec3::ONE, DVec3::ONE, DVec3::Z), Err(CameraError::NoDirection));
    assert_eq!(look(DVec3::ZERO, DVec3::Z, DVec3::Z), Err(CameraError::NoUp));
    assert_eq!(look(DVec3::ZERO, DVec3::Y, DVec3::ZERO), Err(CameraError::NoUp));
    assert!(matches!(look(DVec3::NAN, DVec3::Y, DVec3::Z), Err(CameraError::OutOfRange { .. })));
    for fov in [0.0, 180.0, f64::NAN] {
        assert!(new(View::DEFAULT, Projection::Perspective { fov }).is_err());
    }
    assert!(new(View::DEFAULT, Projection::Orthographic { view_width: Some(0.0) }).is_err());
    assert!(new(orbit(0.0, 91.0), Projection::DEFAULT).is_err());
}

#[test]
fn surfaces_are_not_seen_from_their_edge() {
    let yaw = |formula: &str| {
        let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
        let surface = Surface::new(Arc::new(Interpreter), program);
        let fitted = Fitted::around(&surface, &mut Workspace::default()).unwrap();
        let View::Orbit { yaw, pitch, .. } = View::of(&fitted) else { panic!("a default view orbits") };
        let faces = fitted.facing.unwrap().towards(outward(yaw, pitch).0);
        assert!(faces > EDGE, "{formula}: {faces}");
        yaw
    };
    for formula in ["x + 2y + 3z = 6", "x + y + z = 1", "z = x", "2x + 3y + 4z = 12"] {
        assert!(OTHER_YAWS.contains(&yaw(formula)), "{formula}");
    }
    for formula in ["x^2 + y^2 + z^2 = 1", "z = 0.2", "x = 0.1", "x - y = 1", "z = x y", "x^2 + y^2 = z^2"] {
        assert_eq!(yaw(formula), YAW, "{formula}");
    }
    assert_eq!(View::of(&region().into()), View::DEFAULT);
}
