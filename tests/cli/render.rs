//! `iso render`: pictures.

use crate::harness::{Case, Run};

const SPHERE: &str = "x^2 + y^2 + z^2 = 1";
const TORUS: &str = "(sqrt(x^2 + y^2) - 1.2)^2 + z^2 = 0.25";

fn render(case: &Case, formula: &str, more: &[&str]) -> Run {
    let mut arguments = vec!["render", formula, "--size", "48x32"];
    arguments.extend(more);
    case.run(&arguments)
}

#[test]
fn a_picture_is_written_without_being_asked_where() {
    let case = Case::new();
    let run = render(&case, SPHERE, &[]).exits(0).prints("");
    assert_eq!(case.names(), ["iso.png"]);
    assert!(run.stderr().starts_with("iso.png: 48x32 pixels: "), "{}", run.stderr());
    let size = image::image_dimensions(case.path("iso.png")).unwrap();
    assert_eq!(size, (48, 32));
}

#[test]
fn quiet_runs_say_nothing() {
    render(&Case::new(), SPHERE, &["--quiet"]).exits(0).prints("").reports("");
}

#[test]
fn every_format_can_be_written() {
    let case = Case::new();
    for extension in ["png", "jpg", "webp", "tif", "bmp", "ppm", "qoi", "gif", "PNG"] {
        let name = format!("out.{extension}");
        render(&case, SPHERE, &["-o", &name, "-q"]).exits(0);
        let format = image::ImageFormat::from_extension(extension).unwrap();
        let picture = image::load_from_memory_with_format(&case.content(&name), format).unwrap().into_rgb8();
        assert_eq!(picture.dimensions(), (48, 32), "{name}");
        // Light behind, the surface's warm colour before it.
        let [behind, before] = [(0, 0), (24, 16)].map(|(column, row)| picture.get_pixel(column, row).0);
        assert!(behind[2] > 200 && before[0] > before[2], "{name}: {behind:?} {before:?}");
    }
}

#[test]
fn pictures_go_to_standard_output() {
    let case = Case::new();
    render(&case, SPHERE, &["-o", "a.png", "-q"]).exits(0);
    let run = render(&case, SPHERE, &["-o", "-"]).exits(0);
    assert_eq!(run.bytes(), case.content("a.png"));
    assert!(run.stderr().starts_with("-: 48x32 pixels: "), "{}", run.stderr());
    render(&case, SPHERE, &["-o", "-", "--json"]).exits(2).mentions("both go to standard output");
    render(&case, SPHERE, &["-o", "-", "--turntable"])
        .exits(2)
        .mentions("a sequence has no place in standard output");
    assert_eq!(case.names(), ["a.png"]);
}

#[test]
fn the_picture_shows_the_sphere() {
    let case = Case::new();
    let ortho = ["--ortho", "--view-width", "4", "--size", "200x200", "--json"];
    let mut arguments = vec!["render", SPHERE];
    arguments.extend(ortho);
    let json = case.run(&arguments).exits(0).json();
    let hits = json["pixels"]["hit"].as_f64().unwrap() + json["pixels"]["touch"].as_f64().unwrap();
    // The disk of radius 50 pixels has this area; a pixel's middle decides whether the pixel counts.
    let area = std::f64::consts::PI * 2500.0;
    assert!((hits - area).abs() < 30.0, "{hits} pixels of {area}");
    assert_eq!(json["pixels"]["undecided"], 0);
}

/// Of a sphere in the middle that reaches to 0.88 of the picture's edge; in a box that was asked for, the box does to 0.96.
#[test]
fn the_surface_fills_the_picture_and_a_box_does_where_it_is_given() {
    let case = Case::new();
    let hits = |formula: &str, more: &[&str]| {
        let flags = [&["--ortho", "--size", "200x200", "--json"], more].concat();
        render(&case, formula, &flags).exits(0).json()["pixels"]["hit"].as_f64().unwrap()
    };
    let area = std::f64::consts::PI * 88.0 * 88.0;
    for formula in [SPHERE, "(x - 70)^2 + y^2 + (z + 1)^2 = 0.01"] {
        let hits = hits(formula, &[]);
        assert!((0.97 * area..1.03 * area).contains(&hits), "{formula}: {hits} pixels of {area}");
    }
    let steiner = hits("x^2 y^2 + y^2 z^2 + z^2 x^2 = x y z", &[]);
    assert!(steiner > 0.25 * 4e4, "{steiner} pixels");
    let along_y = ["--yaw", "0", "--pitch", "0", "--box", "-2,2"];
    let area = std::f64::consts::PI * 48.0 * 48.0;
    let in_box = hits(SPHERE, &along_y);
    assert!((in_box - area).abs() < 30.0, "{in_box} pixels of {area}");
}

/// A picture in which something is missing says why.
#[test]
fn notes_say_what_a_picture_does_not_show() {
    let case = Case::new();
    let noted = |formula: &str, more: &[&str]| {
        let json = render(&case, formula, &[&["--json"], more].concat()).exits(0).reports("").json();
        json["notes"]
            .as_array()
            .unwrap()
            .iter()
            .map(|note| note.as_str().unwrap().to_owned())
            .collect::<Vec<_>>()
    };
    assert!(noted(SPHERE, &[]).is_empty());
    assert!(noted(SPHERE, &["--box", "-2,2"]).is_empty());
    let away = ["--eye", "0,-5,0", "--target", "0,-9,0"];
    for (formula, more, expected) in [
        ("x^2 + y^2 + z^2 = -1", &[][..], "x -2..2, y -2..2, z -2..2, is on the surface"),
        (SPHERE, &["--box", "-0.5,0.5"], "no point of the box, x -0.5..0.5"),
        ("sqrt(-1 - x^2) = z", &[], "F is defined nowhere in the box"),
        ("2 = 1", &[], "does not depend on x, y or z"),
        ("1 = 1", &[], "all of the box is the surface"),
        (SPHERE, &away, "the camera looks past the box"),
        ("(x - 0.1)^2 + y^2 + z^2 = 0", &["--box", "-2,2"], "it may consist of points and curves"),
        ("x^2 + y^2 = 1", &[], "the surface goes on outside of the box that is shown, x -1.09..1.09"),
        (
            "z = tan(x*y)",
            &[],
            "it is not known whether the surface goes on outside of the box that is shown, x -2..2",
        ),
        ("r := 1; s := r; x^2 + y^2 + z^2 = r", &[], "`s` is defined, but not used"),
        ("floor(x^2 + y^2 + z^2) = 3", &[], "in grey: --show-status paints them magenta"),
        ("x^2 + y^2 + z^2 = 1e-8", &["--box", "-2,2", "--method", "grid"], "--method certified proves"),
    ] {
        let notes = noted(formula, more);
        assert!(notes.len() == 1 && notes[0].contains(expected), "{formula}: {notes:?}");
    }
    assert!(noted("floor(x^2 + y^2 + z^2) = 3", &["--show-status"]).is_empty());
}

#[test]
fn the_report_has_its_keys() {
    let case = Case::new();
    for method in ["certified", "grid", "octree", "direct"] {
        let json = render(&case, SPHERE, &["--json", "--method", method]).exits(0).reports("").json();
        assert_eq!(
            (&json["width"], &json["height"], &json["method"]),
            (&48.into(), &32.into(), &method.into())
        );
        for phase in ["parse", "compile", "preprocess", "trace", "shade", "encode"] {
            assert!(json["milliseconds"][phase].as_f64().unwrap() >= 0.0, "{phase}");
        }
        let pixels =
            ["hit", "touch", "miss", "undecided"].map(|status| json["pixels"][status].as_u64().unwrap());
        assert_eq!(pixels.iter().sum::<u64>(), 48 * 32);
        assert_eq!(json["counters"]["rays"], 48 * 32);
        let kernels = if method == "certified" { 5 } else { 3 };
        assert_eq!(json["plan"]["kernels_compiled"], kernels, "{method}");
    }
}

#[test]
fn the_report_says_where_the_rays_are() {
    let case = Case::new();
    for more in [&["--fov", "40"][..], &["--ortho"], &["--ortho", "--eye", "1,2,3"]] {
        let flags = [&["--json", "--points", "points.csv"], more].concat();
        let json = render(&case, SPHERE, &flags).exits(0).reports("").json();
        let camera = &json["camera"];
        let vector = |name: &str| [0, 1, 2].map(|axis| camera[name][axis].as_f64().unwrap());
        let (right, down) = (vector("right"), vector("down"));
        let at = |from: [f64; 3], [a, b]: [f64; 2]| {
            [0, 1, 2].map(|axis| from[axis] + a * right[axis] + b * down[axis])
        };
        let table = String::from_utf8(case.content("points.csv")).unwrap();
        let mut hits = 0;
        for line in table.lines().filter(|line| line.contains("hit")) {
            let number = |column: usize| line.split(',').nth(column).unwrap().parse::<f64>().unwrap();
            let place = [number(0) + 0.5 - 24.0, number(1) + 0.5 - 16.0];
            let (origin, direction) = match camera["projection"].as_str().unwrap() {
                "orthographic" => (at(vector("middle"), place), vector("direction")),
                "perspective" => (vector("eye"), at(vector("forward"), place)),
                other => panic!("{other}"),
            };
            let length = direction.iter().map(|part| part * part).sum::<f64>().sqrt();
            for axis in 0..3 {
                let expected = origin[axis] + number(3) * direction[axis] / length;
                assert!((expected - number(4 + axis)).abs() < 1e-12, "{more:?}: {line}");
            }
            hits += 1;
        }
        assert!(hits > 50, "{more:?}: {hits} hits");
    }
}

/// Engines have one name, that of the command line.
#[test]
fn what_programs_read_names_engines_as_they_are_asked_for() {
    let case = Case::new();
    for engine in ["jit", "interp"] {
        let json = render(&case, SPHERE, &["--engine", engine, "--json"]).exits(0).json();
        assert_eq!(json["engine"], engine);
    }
    let stress = case.run(&["stress", "--case", "double_sphere", "--size", "2x2", "--json"]).exits(0).json();
    let runs = stress[0]["runs"].as_array().unwrap();
    assert!(
        ["jit", "interp"].iter().all(|engine| runs.iter().any(|run| run["engine"] == *engine)),
        "{stress}"
    );
}

#[test]
fn the_picture_is_the_same_on_any_threads_and_engine() {
    let case = Case::new();
    for method in ["certified", "grid", "octree", "direct"] {
        for (engine, threads) in [("jit", "1"), ("jit", "2"), ("interp", "1"), ("interp", "2")] {
            let name = format!("{method}-{engine}-{threads}.ppm");
            let flags = [
                "--method",
                method,
                "--engine",
                engine,
                "--threads",
                threads,
                "-o",
                &name,
                "--size",
                "100x80",
            ];
            case.run(&[&["render", TORUS, "-q"][..], &flags].concat()).exits(0);
            assert_eq!(case.content(&name), case.content(&format!("{method}-jit-1.ppm")), "{name}");
        }
    }
}

#[test]
fn depths_normals_and_points_are_written() {
    let case = Case::new();
    let flags = ["--depth", "depth.exr", "--normals", "normals.exr", "--points", "points.csv", "-q"];
    render(&case, SPHERE, &flags).exits(0);
    // Nothing else was asked for.
    assert_eq!(case.names(), ["depth.exr", "normals.exr", "points.csv"]);
    let table = String::from_utf8(case.content("points.csv")).unwrap();
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("column,row,status,t,x,y,z,nx,ny,nz"));
    let mut hits = 0;
    for line in lines {
        let fields: Vec<&str> = line.split(',').collect();
        let numbers: Vec<f64> = fields[3..].iter().map(|field| field.parse().unwrap()).collect();
        match fields[2] {
            "hit" => {
                let radius = numbers[1].hypot(numbers[2]).hypot(numbers[3]);
                assert!((radius - 1.0).abs() < 1e-9, "{line}");
                assert!((0..3).all(|axis| (numbers[4 + axis] - numbers[1 + axis]).abs() < 1e-7), "{line}");
                hits += 1;
            }
            "miss" => assert!(numbers.iter().all(|number| number.is_nan()), "{line}"),
            other => panic!("a sphere has no pixel that is {other}"),
        }
    }
    assert!(hits > 50, "{hits} hits");
}

#[test]
fn statuses_are_shown_when_asked() {
    let case = Case::new();
    let double = "(x^2 + y^2 + z^2 - 1)^2 = 0";
    render(&case, double, &["-o", "plain.ppm", "-q"]).exits(0);
    render(&case, double, &["-o", "shown.ppm", "-q", "--show-status"]).exits(0);
    assert_ne!(case.content("plain.ppm"), case.content("shown.ppm"));
}

/// Neither like the surface nor like the background.
#[test]
fn what_is_undecided_is_grey() {
    let case = Case::new();
    render(&case, "floor(x^2 + y^2 + z^2) = 3", &["-o", "shell.ppm", "-q"]).exits(0);
    let file = case.content("shell.ppm");
    let pixels = &file[file.len() - 3 * 48 * 32..];
    assert_eq!(pixels[3 * (16 * 48 + 24)..][..3], [112, 112, 118]);
}

/// The picture that is drawn with these flags, each pixel as red, green, blue and alpha.
fn drawn(flags: &[&str]) -> image::RgbaImage {
    let case = Case::new();
    render(&case, "x^2 + y^2 + z^2 = 1", &[&["--box", "-1.5,1.5", "-o", "a.png", "-q"], flags].concat())
        .exits(0);
    image::open(case.path("a.png")).unwrap().into_rgba8()
}

#[test]
fn colours_are_those_asked_for() {
    // The corner is background, and the middle the sphere.
    let corners = |flags: &[&str]| [(0, 0), (0, 31)].map(|(x, y)| drawn(flags).get_pixel(x, y).0);
    assert_eq!(corners(&["--background", "navy,navy"]), [[0, 0, 128, 255]; 2]);
    assert_eq!(corners(&["--background", "#0a141e"]), [[10, 20, 30, 255]; 2]);
    let [top, bottom] = corners(&["--background", "black,white"]);
    assert!(top[0] < 50 && bottom[0] > 240, "{top:?} above {bottom:?}");
    let middle = |flags: &[&str]| drawn(flags).get_pixel(24, 16).0;
    let [red, green, blue, _] = middle(&["--colors", "red"]);
    assert!(red > 150 && green == blue && green < 100, "{red} {green} {blue}");
    // Only the second colour is seen of a ball with its inside out.
    let inside_out = |flags: &[&str]| {
        let case = Case::new();
        let flags = [&["--box", "-1.5,1.5", "-o", "a.png", "-q"], flags].concat();
        render(&case, "1 - x^2 - y^2 - z^2", &flags).exits(0);
        image::open(case.path("a.png")).unwrap().into_rgba8()
    };
    assert_eq!(inside_out(&["--colors", "red, lime"]), drawn(&["--colors", "lime"]));
    assert_eq!(drawn(&["--colors", "#ec9c48,#488ac4"]), drawn(&[]));
}

#[test]
fn a_background_may_be_left_out() {
    let (opaque, transparent) = (drawn(&[]), drawn(&["--background", "none"]));
    for (pixel, other) in transparent.pixels().zip(opaque.pixels()) {
        let expected = if pixel[3] == 0 { [0; 4] } else { other.0 };
        assert_eq!(pixel.0, expected);
    }
    let smooth = drawn(&["--background", "none", "--smooth", "4"]);
    let covered: f64 = smooth.pixels().map(|pixel| f64::from(pixel[3]) / 255.0).sum();
    let hits =
        drawn(&["--background", "none", "--size", "192x128"]).pixels().filter(|pixel| pixel[3] > 0).count();
    assert!((covered - hits as f64 / 16.0).abs() < 0.3, "{covered} pixels of {hits} sixteenths");
    // No edge is mixed with what is not there.
    assert!(smooth.pixels().all(|pixel| pixel[3] == 0 || pixel[0] > 60), "dark edges");
}

#[test]
fn colours_that_cannot_be_drawn_are_refused() {
    let case = Case::new();
    for (flags, expected) in [
        (["--colors", "redd"], "expected a colour such as `orange` or `#3a7bd5`, found `redd`"),
        (["--colors", "red,green,blue"], "expected 1 colour or 2, found 3"),
        (["--colors", "add"], "expected a colour such as `orange` or `#3a7bd5`, found `add`"),
        (["--colors", "transparent"], "`transparent` is transparent; only --background none is"),
        (["--background", "red,none"], "expected a colour such as `orange` or `#3a7bd5`, found `none`"),
    ] {
        render(&case, SPHERE, &flags).exits(2).mentions(expected);
    }
    for flags in [&["--colors", "red"][..], &["--background", "red"], &["--show-status"]] {
        let problem = format!("{} is given, but no shaded picture is written", flags[0]);
        let flags = [flags, &["--depth", "a.exr"]].concat();
        render(&case, SPHERE, &flags).exits(2).mentions(&problem);
    }
    for name in ["a.jpg", "a.gif", "a.bmp", "a.tif"] {
        let run = render(&case, SPHERE, &["--background", "none", "-o", name]);
        run.exits(2).mentions("this format has no transparency");
    }
    let run = render(&case, SPHERE, &["--background", "none", "--turntable"]);
    run.exits(2).mentions("choose a .png, .webp or .qoi file");
    assert!(case.names().is_empty());
}

#[test]
fn outputs_that_cannot_be_written_are_known_before_the_work() {
    let case = Case::new();
    let unknown = render(&case, SPHERE, &["-o", "out.txt", "--size", "20000x20000"]);
    unknown.exits(2).mentions("names no picture format");
    render(&case, SPHERE, &["-o", "noextension"]).exits(2);
    render(&case, SPHERE, &["--depth", "depth.png"]).exits(2).mentions("--depth writes .exr files");
    let missing = render(&case, SPHERE, &["-o", "missing/out.png", "--size", "20000x20000"]);
    missing.exits(1).reports("error: cannot write missing/out.png: there is no folder missing\n");
    let unclear = render(&case, SPHERE, &["--size", "512,512"]);
    unclear.exits(2).mentions("expected pixels such as `640x480`, or `512` for a square, found `512,512`");
    let wide = render(&case, SPHERE, &["-o", "out.jpg", "--size", "70000x100"]);
    wide.exits(2).mentions("no more than 65535 columns and rows");
    let twice = render(&case, SPHERE, &["--depth", "same.exr", "--normals", "./same.exr"]);
    twice.exits(2).mentions("two layers go to one file, ./same.exr");
    std::fs::create_dir(case.path("folder.png")).unwrap();
    render(&case, SPHERE, &["-o", "folder.png"]).exits(1).mentions("it is a directory");
    assert_eq!(case.names(), ["folder.png"]);
}

#[test]
fn pictures_do_not_take_the_place_of_the_formula() {
    let case = Case::new();
    for (name, flags) in [
        ("shape.csv", &["--points", "./shape.csv"][..]),
        ("shape.png", &["-o", "shape.png"]),
        ("shape.gif", &["--turntable", "--frames", "2", "-o", "shape.gif"]),
        ("shape-1.exr", &["--turntable", "--frames", "2", "--depth", "shape.exr", "-o", "shape.gif"]),
    ] {
        case.file(name, SPHERE);
        let formula = format!("@{name}");
        render(&case, &formula, flags).exits(2).mentions(&format!("{name}, which is read"));
        assert_eq!(case.content(name), SPHERE.as_bytes());
    }
}

#[test]
fn a_failed_run_leaves_the_old_picture() {
    let case = Case::new();
    case.file("out.png", "the old one");
    render(&case, "x + (", &["-o", "out.png"]).exits(2);
    render(&case, SPHERE, &["-o", "out.png", "--points", "missing/points.csv"]).exits(1);
    assert_eq!(case.content("out.png"), b"the old one");
    render(&case, SPHERE, &["-o", "out.png"]).exits(0);
    assert_ne!(case.content("out.png"), b"the old one");
    assert_eq!(case.names(), ["out.png"]);
}

#[test]
fn cameras_can_stand_anywhere() {
    let case = Case::new();
    let plain = ["-o", "a.ppm", "-q", "--yaw", "0", "--pitch", "0", "--distance", "6"];
    render(&case, TORUS, &plain).exits(0);
    render(&case, TORUS, &["-o", "b.ppm", "-q", "--eye", "0,-6,0"]).exits(0);
    assert_eq!(case.content("a.ppm"), case.content("b.ppm"));
    // The same place, found from its target.
    let aside = ["--yaw", "0", "--pitch", "0", "--distance", "4", "--target", "0.5,-2,0.25"];
    render(&case, TORUS, &[&aside[..], &["-o", "a.ppm", "-q"]].concat()).exits(0);
    render(&case, TORUS, &["-o", "b.ppm", "-q", "--eye", "0.5,-6,0.25", "--target", "0.5,-2,0.25"]).exits(0);
    assert_eq!(case.content("a.ppm"), case.content("b.ppm"));
    render(&case, TORUS, &["--eye", "0,0,-6", "--up", "0,0,1"]).exits(2).mentions("up direction");
    // One that looks straight down has y upwards in the picture, as a yaw of 0 has.
    let above = ["-o", "a.ppm", "-q", "--yaw", "0", "--pitch", "90", "--distance", "6"];
    render(&case, TORUS, &above).exits(0);
    render(&case, TORUS, &["-o", "b.ppm", "-q", "--eye", "0,0,6"]).exits(0);
    assert_eq!(case.content("a.ppm"), case.content("b.ppm"));
    render(&case, TORUS, &["--eye", "1,1,1", "--yaw", "-3"]).exits(2).mentions("--yaw");
    render(&case, TORUS, &["--yaw", "-30", "--pitch", "-20", "-q"]).exits(0);
}

#[test]
fn summaries_say_what_was_drawn() {
    let case = Case::new();
    let formula = "a := 2; x^2 + y^2 + a*z^2";
    let json = render(&case, formula, &["--set", "a=3", "--level", "0.5", "--json"]).exits(0).json();
    assert_eq!((&json["formula"], &json["level"]), (&formula.into(), &0.5.into()));
    assert_eq!((&json["settings"][0]["name"], &json["settings"][0]["value"]), (&"a".into(), &3.0.into()));
    let json = render(&case, SPHERE, &["--json"]).exits(0).json();
    assert!(json["level"].is_null() && json["settings"].is_null(), "{json}");
}

#[test]
fn smooth_pictures_have_the_size_asked_for() {
    let case = Case::new();
    let json = render(&case, SPHERE, &["--smooth", "4", "--json"]).exits(0).json();
    assert_eq!((&json["width"], &json["height"]), (&48.into(), &32.into()));
    let drawn = ["hit", "touch", "miss", "undecided"].map(|status| json["pixels"][status].as_u64().unwrap());
    assert_eq!(drawn.iter().sum::<u64>(), 16 * 48 * 32);
    assert_eq!(image::image_dimensions(case.path("iso.png")).unwrap(), (48, 32));
    render(&case, SPHERE, &["--smooth", "2", "--depth", "depth.exr"]).exits(2).mentions("--smooth");
    render(&case, SPHERE, &["--smooth", "17"]).exits(2).mentions("from 1 to 16");
    case.run(&["render", SPHERE, "--size", "32768x32768", "--smooth", "2"]).exits(2).mentions("--smooth");
}

#[test]
fn a_formula_too_large_for_native_code_is_drawn_all_the_same() {
    let terms: Vec<String> = (0..4000).map(|term| format!("(x-{term}e-6)^2/4000")).collect();
    let formula = format!("{} + y^2 + z^2 = 1", terms.join("+"));
    let json =
        Case::new().run(&["render", &formula, "--size", "6", "--box", "-1.5,1.5", "--json"]).exits(0).json();
    assert!(json["gradient_operations"].as_u64().unwrap() > 10_000, "native code would do");
    assert!(json["pixels"]["hit"].as_u64().unwrap() > 0, "{json}");
}

#[test]
fn root_finders_draw_the_same_pixels_with_less_work() {
    let work = |finder: &str, tolerance: &str| {
        let flags = ["--method", "grid", "--root-finder", finder, "--tolerance", tolerance, "--json"];
        let json = render(&Case::new(), TORUS, &flags).exits(0).json();
        let count = |key: &str| json["counters"][key].as_u64().unwrap();
        (json["pixels"].clone(), count("trace_evaluations"), count("gradient_evaluations"))
    };
    let (bisected, most, normals) = work("bisection", "0");
    let (interpolated, fewer, same) = work("itp", "0");
    assert_eq!((&interpolated, same), (&bisected, normals));
    let (followed, fewest, gradients) = work("newton", "0");
    assert_eq!(followed, bisected);
    assert!(fewest < fewer && fewer < most && gradients > normals);
    let (coarse, least, _) = work("bisection", "1e-4");
    assert_eq!(coarse, bisected);
    assert!(least < most);
}

#[test]
fn a_surface_is_not_seen_from_its_edge_unless_that_is_asked_for() {
    let case = Case::new();
    let forward = |more: &[&str]| {
        let arguments = [&["render", "x + y + z = 1", "--size", "16", "--json"], more].concat();
        case.run(&arguments).exits(0).json()["camera"]["forward"].to_string()
    };
    let standard = forward(&["--yaw", "30", "--pitch", "25"]);
    assert_ne!(forward(&[]), standard);
    for more in [&["--yaw", "30"], &["--pitch", "25"], &["--box", "-2,2"]] {
        assert_eq!(forward(more), standard, "{more:?}");
    }
}
