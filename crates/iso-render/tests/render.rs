//! Pictures of a sphere, of which everything is known in closed form.

use std::sync::Arc;

use glam::{DVec3, Vec3};
use iso_expr::{Axis, Interpreter, NodeId, Operation, Program};
use iso_grid::{Method, Region, Stop, Surface};
use iso_render::{
    Camera, Layers, Look, Mosaic, Picture, Plan, Projection, Scene, Shading, Size, Smoothing, Status,
    StatusCounts, View, Wanted, render_over,
};

/// x² + y² + z² − 1
fn sphere() -> Program {
    let mut program = Program::new();
    let squares: Vec<NodeId> = Axis::ALL
        .into_iter()
        .map(|axis| {
            let variable = program.variable(axis);
            program.integer_power(variable, 2)
        })
        .collect();
    let one = program.literal(1.0);
    let sum =
        squares.into_iter().reduce(|sum, square| program.apply(Operation::Add, &[sum, square])).unwrap();
    let value = program.apply(Operation::Subtract, &[sum, one]);
    program.set_outputs(vec![value]);
    program
}

/// The sphere from the front, two pixels to a tenth of its radius.
fn picture(size: Size, threads: usize) -> Picture {
    picture_until(&Stop::default(), size, threads, u64::MAX)
}

/// The same, but `stop` is requested when so many pixels are done.
fn picture_until(stop: &Stop, size: Size, threads: usize, last: u64) -> Picture {
    let mut picture = Picture::empty(size);
    draw_over(&mut picture, stop, threads, last);
    picture
}

/// The same in the place of another picture.
fn draw_over(picture: &mut Picture, stop: &Stop, threads: usize, last: u64) {
    let size = picture.size;
    let program = sphere();
    let surface = Surface::new(Arc::new(Interpreter), program).stopped_by(stop.clone());
    let region = Region::new(DVec3::splat(-1.5), DVec3::splat(1.5)).unwrap();
    let view = View::Orbit { yaw: 0.0, pitch: 0.0, distance: Some(5.0), target: None };
    let projection = Projection::Orthographic { view_width: Some(0.05 * f64::from(size.width())) };
    let camera = Camera::new(view, projection, &region, size).unwrap();
    let plan = Plan::new(&Wanted {
        program: surface.program(),
        method: Method::CERTIFIED,
        has_parameters: false,
        projection: Some(projection),
        box_is_given: true,
        layers: Layers::ALL,
        smoothing: Smoothing::NONE,
    });
    let tracer = plan.tracer(&surface, region).unwrap();
    let shading = Shading::new(&camera, &Look::DEFAULT);
    let scene =
        Scene { plan: &plan, surface: &surface, tracer: tracer.as_ref(), camera: &camera, shading: &shading };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let progress = |done, _| {
        if done >= last {
            stop.request();
        }
    };
    pool.install(|| render_over(&scene, picture, &progress)).unwrap();
}

#[test]
fn depths_normals_points_and_statuses_are_those_of_the_sphere() {
    let size = Size::new(70, 50).unwrap();
    let picture = picture(size, 2);
    let mut hits = 0;
    for row in 0..size.height() {
        for column in 0..size.width() {
            let pixel = size.offset(column, row);
            let (x, z) = (0.05 * (f64::from(column) - 34.5), -0.05 * (f64::from(row) - 24.5));
            let height_squared = 1.0 - x * x - z * z;
            if height_squared < 0.0 {
                assert_eq!(picture.statuses[pixel], Status::Miss);
                assert!(picture.depth.get(pixel).is_nan() && picture.normals.get(pixel).is_nan());
                continue;
            }
            hits += 1;
            let point = DVec3::new(x, -height_squared.sqrt(), z);
            assert_eq!(picture.statuses[pixel], Status::Hit);
            assert!((picture.depth.get(pixel) - (5.0 + point.y)).abs() < 1e-11);
            assert!(picture.points.get(pixel).distance(point) < 1e-11);
            // Rounded to single precision.
            assert!(picture.normals.get(pixel).as_dvec3().distance(point) < 6e-8);
        }
    }
    assert!(hits > 1000);
    assert_eq!((picture.counts.hit, picture.counts.miss), (hits, 3500 - hits));
    assert_eq!(picture.counters.rays, 3500);
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let size = Size::new(67, 45).unwrap();
    let (one, three) = (picture(size, 1), picture(size, 3));
    assert_eq!(one.color, three.color);
    assert_eq!(
        one.depth.iter().map(|t| t.to_bits()).collect::<Vec<_>>(),
        three.depth.iter().map(|t| t.to_bits()).collect::<Vec<_>>()
    );
    assert_eq!(one.counts, three.counts);
    assert_eq!(one.outcomes, three.outcomes);
}

/// The picture is the right way up: the key light comes from the upper left.
#[test]
fn the_upper_left_of_a_sphere_is_brighter_than_the_lower_right() {
    let size = Size::new(60, 60).unwrap();
    let picture = picture(size, 1);
    let brightness = |column, row| picture.color[size.offset(column, row)].map(u32::from).iter().sum::<u32>();
    assert!(brightness(22, 22) > brightness(37, 37) + 100);
}

#[test]
fn nothing_is_left_of_a_picture_that_is_drawn_over() {
    let size = Size::new(200, 130).unwrap();
    let last = 2 * 64 * 64;
    let [whole, part] = [u64::MAX, last].map(|last| picture_until(&Stop::default(), size, 1, last));
    let (mut over_part, mut over_whole) = (part.clone(), whole.clone());
    draw_over(&mut over_part, &Stop::default(), 1, u64::MAX);
    draw_over(&mut over_whole, &Stop::default(), 1, last);
    for (found, expected) in [(over_part, whole), (over_whole, part)] {
        assert_eq!((found.counts, found.counters), (expected.counts, expected.counters));
        assert_eq!((found.color, found.statuses), (expected.color, expected.statuses));
        assert_eq!(found.outcomes, expected.outcomes);
        let bits = |depths: &Mosaic<f64>| depths.iter().map(f64::to_bits).collect::<Vec<_>>();
        assert_eq!(bits(&found.depth), bits(&expected.depth));
        let points = |points: &Mosaic<DVec3>| {
            points.iter().map(|point| point.to_array().map(f64::to_bits)).collect::<Vec<_>>()
        };
        assert_eq!(points(&found.points), points(&expected.points));
        let normals = |normals: &Mosaic<Vec3>| {
            normals.iter().map(|normal| normal.to_array().map(f32::to_bits)).collect::<Vec<_>>()
        };
        assert_eq!(normals(&found.normals), normals(&expected.normals));
    }
}

/// Whether other rays of a tile meet the surface or not.
#[test]
fn pixels_in_which_nothing_is_found_are_the_same_everywhere() {
    let size = Size::new(320, 130).unwrap();
    let picture = picture(size, 1);
    let bits = |pixel: usize| {
        let (depth, point, normal) =
            (picture.depth.get(pixel), picture.points.get(pixel), picture.normals.get(pixel));
        (depth.to_bits(), point.to_array().map(f64::to_bits), normal.to_array().map(f32::to_bits))
    };
    let [far, near] = [size.offset(0, 0), size.offset(130, 2)];
    let is_met = |column: u32| {
        let mut pixels = (0..64).flat_map(|row| (0..64).map(move |x| size.offset(column + x, row)));
        pixels.any(|pixel| picture.statuses[pixel] == Status::Hit)
    };
    assert!(!is_met(0) && is_met(128), "a tile without a hit, and one with hits");
    assert!([far, near].iter().all(|pixel| picture.statuses[*pixel] == Status::Miss));
    assert!(
        picture.depth.get(far).is_nan()
            && picture.points.get(far).is_nan()
            && picture.normals.get(far).is_nan()
    );
    let mut misses = (0..size.pixels()).filter(|pixel| picture.statuses[*pixel] == Status::Miss);
    assert!(misses.all(|pixel| bits(pixel) == bits(far)));
}

/// Pixels by status, counted one status after the other.
fn counts(statuses: &[Status]) -> StatusCounts {
    let of = |status| statuses.iter().filter(|found| **found == status).count() as u64;
    StatusCounts {
        hit: of(Status::Hit),
        touch: of(Status::Touch),
        miss: of(Status::Miss),
        undecided: of(Status::Undecided),
        unfinished: of(Status::Unfinished),
    }
}

#[test]
fn unfinished_pixels_are_marked_in_every_layer_and_finished_ones_are_as_ever() {
    let size = Size::new(200, 130).unwrap();
    let (whole, part) = (picture(size, 1), picture_until(&Stop::default(), size, 1, 2 * 64 * 64));
    for pixel in 0..size.pixels() {
        if part.statuses[pixel] == Status::Unfinished {
            assert_eq!(part.color[pixel], Picture::UNFINISHED);
            assert_eq!((part.depth.get(pixel), part.normals.get(pixel)), (f64::NEG_INFINITY, Vec3::ZERO));
            assert!(part.points.get(pixel).is_nan());
        } else {
            assert_eq!(part.statuses[pixel], whole.statuses[pixel]);
            assert_eq!(part.depth.get(pixel).to_bits(), whole.depth.get(pixel).to_bits());
            assert_eq!(part.color[pixel], whole.color[pixel]);
            assert_ne!(part.color[pixel], Picture::UNFINISHED);
        }
    }
    assert_eq!(part.counts, counts(&part.statuses));
    assert_eq!(part.counts.unfinished, size.pixels() as u64 - 2 * 64 * 64);
    assert_eq!(whole.counts, counts(&whole.statuses));
    assert_eq!(whole.counts.unfinished, 0);
}
