//! What a plan leaves out is not done, and changes no bit of what is left.

use std::sync::Arc;

use glam::{DVec3, Vec3};
use iso_expr::{Ast, Axis, Interpreter, Program};
use iso_grid::{GridSettings, Kernel, Method, Region, RootFinding, Surface};
use iso_render::{
    Buffer, Camera, Given, Layers, Look, Mosaic, Pass, Picture, Plan, Projection, Scene, Shading, Size,
    Smoothing, View, Wanted, render,
};

const PAPER: &str = "(x^2+y^2-1)^2 + 4z^2 + 0.5x = 0.2";
const DEPTH: Layers = Layers { color: false, depth: true, ..Layers::COLOR };
const ORTHOGRAPHIC: Projection = Projection::Orthographic { view_width: None };

fn methods() -> [Method; 4] {
    [
        Method::CERTIFIED,
        Method::Grid(GridSettings::new([12, 10, 9])),
        Method::Octree(GridSettings::new([12; 3])),
        Method::Direct { step: GridSettings::STEP, roots: RootFinding::PAPER },
    ]
}

fn program(formula: &str) -> Program {
    Ast::parse(formula).unwrap().lower(&[]).unwrap().program().simplified()
}

fn wanted(program: &Program, method: Method, layers: Layers) -> Wanted<'_> {
    Wanted {
        program,
        method,
        has_parameters: false,
        projection: Some(ORTHOGRAPHIC),
        box_is_given: true,
        layers,
        smoothing: Smoothing::NONE,
    }
}

/// A picture, and the kernels that were compiled for it.
fn draw(program: &Program, plan: &Plan) -> (Picture, Vec<Kernel>) {
    let size = Size::new(60, 40).unwrap();
    let surface = Surface::new(Arc::new(Interpreter), program.clone());
    let region = Region::new(DVec3::splat(-1.5), DVec3::splat(1.5)).unwrap();
    let camera = Camera::new(View::DEFAULT, ORTHOGRAPHIC, &region, size).unwrap();
    let shading = Shading::new(&camera, &Look::DEFAULT);
    let tracer = plan.tracer(&surface, region).unwrap();
    let scene =
        Scene { plan, surface: &surface, tracer: tracer.as_ref(), camera: &camera, shading: &shading };
    let picture = render(&scene, size, &|_, _| {}).unwrap();
    assert!(picture.counts.hit > 100, "{:?}", picture.counts);
    (picture, Kernel::ALL.into_iter().filter(|kernel| surface.is_compiled(*kernel)).collect())
}

fn planned(plan: &Plan) -> Vec<Kernel> {
    plan.compiled_ahead().collect()
}

fn folded(plan: &Plan) -> Vec<Given> {
    plan.constants().iter().filter(|given| given.taken).map(|given| given.subject).collect()
}

fn bits(points: &Mosaic<DVec3>) -> Vec<[u64; 3]> {
    points.iter().map(|point| point.to_array().map(f64::to_bits)).collect()
}

fn bits_of_normals(normals: &Mosaic<Vec3>) -> Vec<[u32; 3]> {
    normals.iter().map(|normal| normal.to_array().map(f32::to_bits)).collect()
}

#[test]
fn the_kernels_compiled_are_the_planned_ones() {
    let program = program(PAPER);
    for method in methods() {
        for layers in [Layers::ALL, Layers::COLOR, DEPTH, Layers { normals: true, ..DEPTH }] {
            let plan = Plan::new(&wanted(&program, method, layers));
            assert_eq!(draw(&program, &plan).1, planned(&plan), "{method:?} {layers:?}");
        }
    }
}

#[test]
fn nothing_is_compiled_ahead_of_large_formulas_of_which_less_is_left_in_places() {
    let ball = |n: u32| format!("(x-{n}/15+1)^2 + (y-sin({n}))^2 + z^2 - 0.1");
    let union = (0..30).map(ball).reduce(|union, ball| format!("min({union}, {ball})")).unwrap();
    let program = program(&union);
    for method in methods() {
        for layers in [Layers::ALL, DEPTH] {
            let plan = Plan::new(&wanted(&program, method, layers));
            let (_, compiled) = draw(&program, &plan);
            assert_eq!(compiled, planned(&plan), "{method:?}");
            assert_eq!(compiled.is_empty(), matches!(method, Method::Certified { .. }), "{method:?}");
        }
    }
    let certified = Method::CERTIFIED;
    let fitted = Plan::new(&Wanted { box_is_given: false, ..wanted(&program, certified, Layers::ALL) });
    assert_eq!(planned(&fitted), [Kernel::ValueEnclosures], "a box is fitted by it");
}

#[test]
fn layers_left_out_are_not_computed_and_change_no_other() {
    let program = program(PAPER);
    for method in methods() {
        let (all, _) = draw(&program, &Plan::new(&wanted(&program, method, Layers::ALL)));
        assert!(all.counters.gradient_evaluations > 0);
        let every_choice = (0..128).map(|choice| {
            let chosen = |layer: u32| choice >> layer & 1 == 1;
            Layers {
                color: chosen(0),
                depth: chosen(1),
                normals: chosen(2),
                points: chosen(3),
                statuses: chosen(4),
                outcomes: chosen(5),
                coverage: chosen(6),
            }
        });
        for layers in every_choice {
            let plan = Plan::new(&wanted(&program, method, layers));
            let (picture, _) = draw(&program, &plan);
            let full = |wanted: bool| if wanted { all.size.pixels() } else { 0 };
            assert_eq!(*picture.color, all.color[..full(layers.color)], "{method:?} {layers:?}");
            assert_eq!(*picture.coverage, all.coverage[..full(layers.coverage)]);
            let bits_of_depths =
                |depths: &Mosaic<f64>| depths.iter().map(|t| t.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits_of_depths(&picture.depth), bits_of_depths(&all.depth)[..full(layers.depth)]);
            assert_eq!(
                bits_of_normals(&picture.normals),
                bits_of_normals(&all.normals)[..full(layers.normals)]
            );
            assert_eq!(bits(&picture.points), bits(&all.points)[..full(layers.points)]);
            assert_eq!(picture.statuses, all.statuses[..full(layers.statuses)]);
            assert_eq!(picture.outcomes, all.outcomes[..full(layers.outcomes)]);
            assert_eq!(picture.counts, all.counts);
            assert_eq!(picture.counters.gradient_evaluations > 0, plan.runs(Pass::Normals));
            let kept: Vec<bool> = plan.buffers().iter().map(|buffer| buffer.taken).collect();
            let Layers { color, coverage, depth, normals, points, statuses, outcomes } = layers;
            assert_eq!(kept, [color, coverage, depth, normals, points, statuses, outcomes]);
            assert_eq!(plan.buffers()[2].subject, Buffer::Depth);
        }
    }
}

#[test]
fn cells_are_classified_ahead_by_the_methods_that_say_so() {
    let program = program(PAPER);
    for method in methods() {
        let plan = Plan::new(&wanted(&program, method, DEPTH));
        let surface = Surface::new(Arc::new(Interpreter), program.clone());
        let region = Region::new(DVec3::splat(-1.5), DVec3::splat(1.5)).unwrap();
        let preprocessing = plan.tracer(&surface, region).unwrap().preprocessing();
        assert_eq!(preprocessing.cells > 0, plan.runs(Pass::Classify), "{method:?}");
        assert_eq!(preprocessing.preprocess_evaluations > 0, plan.runs(Pass::Classify), "{method:?}");
    }
}

/// A surface without z is the same as one whose z has no weight, which the plan cannot know. Enclosures can: theirs are
/// wider by a rounding, so that certified roots differ in the last bits.
#[test]
fn an_argument_that_is_not_taken_is_not_cut_along() {
    let (flat, full) = (program("x^2 + y^2 = 1"), program("x^2 + y^2 + 0*z = 1"));
    assert!(full.takes(Axis::Z), "or the test says nothing");
    let [_, sampling @ ..] = methods();
    for method in sampling {
        let plans = [&flat, &full]
            .map(|program| Plan::new(&wanted(program, method, Layers { color: false, ..Layers::ALL })));
        assert_eq!(plans.each_ref().map(|plan| plan.arguments()[2].taken), [false, true]);
        let [(picture, _), (other, _)] =
            [(&flat, &plans[0]), (&full, &plans[1])].map(|(program, plan)| draw(program, plan));
        assert_eq!(bits(&picture.points), bits(&other.points), "{method:?}");
        assert_eq!(bits_of_normals(&picture.normals), bits_of_normals(&other.normals), "{method:?}");
        assert_eq!(picture.statuses, other.statuses, "{method:?}");
    }
}

#[test]
fn boxes_are_fitted_and_pixels_averaged_only_when_asked_for() {
    let program = program(PAPER);
    let method = Method::Direct { step: GridSettings::STEP, roots: RootFinding::PAPER };
    let plain = wanted(&program, method, Layers::COLOR);
    let runs = |wanted: Wanted<'_>, pass| Plan::new(&wanted).runs(pass);
    assert!(!runs(plain, Pass::Fit) && runs(Wanted { box_is_given: false, ..plain }, Pass::Fit));
    let smooth = Wanted { smoothing: Smoothing::new(3).unwrap(), ..plain };
    assert!(!runs(plain, Pass::Smooth) && runs(smooth, Pass::Smooth));
    let fitting = Plan::new(&Wanted { box_is_given: false, ..plain });
    assert!(planned(&fitting).contains(&Kernel::ValueEnclosures));
}

/// Of the camera, kernels know at most whether its rays are parallel. Then the certified method takes slopes along their direction alone: of
/// Klein's bottle by fewer operations.
#[test]
fn parallel_rays_take_slopes_along_their_direction() {
    let bottle = "r := x^2+y^2+z^2; (r+2y-1)*((r-2y-1)^2-8z^2) + 16x z (r-2y-1) = 0";
    let program = program(bottle);
    let surface = Surface::new(Arc::new(Interpreter), program.clone());
    for method in methods() {
        let parallel = Plan::new(&wanted(&program, method, Layers::ALL));
        let spreading = Plan::new(&Wanted {
            projection: Some(Projection::DEFAULT),
            ..wanted(&program, method, Layers::ALL)
        });
        assert_eq!(folded(&spreading), [Given::Level]);
        let [parallel_kernels, spreading_kernels] = [&parallel, &spreading].map(planned);
        if method == Method::CERTIFIED {
            assert_eq!(folded(&parallel), [Given::Level, Given::Direction]);
            let [shared @ .., forms] = &parallel_kernels[..] else { panic!("there are kernels") };
            let [also_shared @ .., others] = &spreading_kernels[..] else { panic!("there are kernels") };
            assert_eq!((shared, *forms, *others), (also_shared, Kernel::ParallelForms, Kernel::Forms));
            let [few, many] = [*forms, *others].map(|kernel| surface.program_of(kernel).operations());
            assert!(5 * few < 4 * many, "{few} operations, {many} with the gradient");
        } else {
            assert_eq!((parallel_kernels, folded(&parallel)), (spreading_kernels, vec![Given::Level]));
        }
    }
}

#[test]
fn parameters_are_folded_where_there_are_some() {
    let program = program(PAPER);
    let plain = wanted(&program, Method::CERTIFIED, Layers::ALL);
    assert_eq!(folded(&Plan::new(&plain)), [Given::Level, Given::Direction]);
    let with_parameters = Plan::new(&Wanted { has_parameters: true, ..plain });
    assert_eq!(folded(&with_parameters), [Given::Level, Given::Parameters, Given::Direction]);
}
