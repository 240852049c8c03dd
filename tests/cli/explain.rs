//! `iso explain` and `iso bench`: what the program says about itself.

use crate::harness::Case;

const PAPER: &str = "(x^2+y^2-1)^2 + 4z^2 + 0.5x = 0.2";
const SECTIONS: [&str; 6] = ["tree", "program", "simplified", "gradient", "clif", "assembly"];

/// A heart is a difference of cubes, and a quartic a square of a square.
#[test]
fn a_function_with_the_same_signs_is_shown_where_rays_are_followed_by_one() {
    let case = Case::new();
    let heart = "(x^2 + 9/4y^2 + z^2 - 1)^3 = (x^2 + 9/80y^2) z^3";
    let explained = |formula: &str, more: &[&str]| {
        let flags = [&["explain", formula, "--json"], more].concat();
        case.run(&flags).exits(0).json()
    };
    let json = explained(heart, &[]);
    assert!(json["signs"]["text"].as_str().unwrap().contains("cbrt"));
    let square = explained("x^4 - 5x^2 + y^2 + z^2 = 1", &[]);
    assert!(square["signs"]["text"].as_str().unwrap().contains("- 2.5"), "{square}");
    assert_eq!(json["signs"]["size"], json["plan"]["operations"]["by_signs"]);
    // Boxes are fitted by signs whatever the method is.
    let kernels = explained(heart, &["--method", "grid"])["plan"]["kernels"].as_array().unwrap().clone();
    let fits = kernels.iter().find(|kernel| kernel["name"] == "value enclosures").unwrap();
    assert_eq!(fits["operations"], json["signs"]["size"]);
    for (formula, flags) in [(PAPER, vec![]), (heart, vec!["--method", "grid"])] {
        let json = explained(formula, &flags);
        assert_eq!(json["signs"]["text"], "F itself, as simplified", "{formula}");
        assert_eq!(json["signs"]["size"], json["simplified"]["size"], "{formula}");
        assert!(json["plan"]["operations"]["by_signs"].is_null(), "{formula}");
    }
}

#[test]
fn every_stage_is_shown() {
    let case = Case::new();
    let json = case.run(&["explain", PAPER, "--json"]).exits(0).json();
    let text = case.run(&["explain", PAPER]).exits(0).stdout();
    for section in SECTIONS {
        assert!(json[section]["size"].as_u64().unwrap() > 0, "{section}");
        assert!(json[section]["milliseconds"].as_f64().unwrap() >= 0.0, "{section}");
        assert!(!json[section]["text"].as_str().unwrap().is_empty(), "{section}");
        assert!(text.contains(section), "{section} in\n{text}");
    }
}

/// What a depth map of parallel rays does without.
#[test]
fn the_plan_of_a_depth_map_has_no_normals_and_no_grid() {
    let case = Case::new();
    let picture = [PAPER, "--ortho", "--depth", "depth.exr", "--json"];
    for (method, kernels) in [("certified", 4), ("direct", 1)] {
        let flags = [&picture[..], &["--method", method, "--box", "-1.5,1.5"]].concat();
        let json = case.run(&[&["explain"][..], &flags].concat()).exits(0).json();
        assert!(case.names().is_empty(), "nothing is drawn");
        let plan = &json["plan"];
        let decision = |group: &str, name: &str| {
            let lines = plan[group].as_array().unwrap();
            lines.iter().find(|line| line["name"] == name).unwrap_or_else(|| panic!("no {name}")).clone()
        };
        assert_eq!(decision("kernels", "gradients")["taken"], false);
        for pass in ["fit", "classify", "normals", "shade", "smooth"] {
            assert_eq!(decision("passes", pass)["taken"], false, "{method} {pass}");
            assert!(!decision("passes", pass)["reason"].as_str().unwrap().is_empty());
        }
        assert_eq!((&plan["kernels_compiled"], &plan["passes_skipped"]), (&kernels.into(), &5.into()));
        let values = decision("kernels", "values")["operations"].as_u64().unwrap();
        assert!(values < json["gradient"]["size"].as_u64().unwrap(), "the general kernel does more");

        let drawn = case.run(&[&["render"][..], &flags].concat()).exits(0).json();
        assert_eq!(&drawn["plan"], plan, "it was done as planned");
        assert_eq!(drawn["counters"]["gradient_evaluations"], 0);
        assert_eq!(drawn["counters"]["cells"], 0);
        assert_eq!(drawn["gradient_operations"].is_null(), method == "direct");
        let depth = case.content("depth.exr");
        let everything = ["-o", "iso.ppm", "--normals", "normals.exr", "--points", "points.csv"];
        case.run(&[&["render"][..], &flags, &everything].concat()).exits(0);
        assert_eq!(case.content("depth.exr"), depth, "{method}");
        for name in case.names() {
            std::fs::remove_file(case.path(&name)).unwrap();
        }
    }
}

#[test]
fn numbers_are_narrower_than_colours_unless_asked_otherwise() {
    let case = Case::new();
    for (flags, expected) in [
        (&["-o", "a.png"][..], "1/256 of a pixel"),
        (&["-o", "a.png", "--accuracy", "1e-5"], "1e-5 of the distance"),
        (&["--depth", "d.exr", "-o", "a.png"], "1e-12 of the distance"),
        (&["--normals", "n.exr"], "1e-12 of the distance"),
        (&["--points", "p.csv"], "1e-12 of the distance"),
        (&["--points", "p.csv", "--accuracy", "0.001"], "1e-3 of the distance"),
    ] {
        let flags = [&["explain", PAPER, "--section", "plan"], flags].concat();
        let text = case.run(&flags).exits(0).stdout();
        assert!(text.contains(&format!("roots are enclosed to {expected}\n")), "{text}");
        let json = case.run(&[&flags[..], &["--json"]].concat()).exits(0).json();
        assert_eq!(json["plan"]["accuracy"], expected);
    }
    let sampled = ["explain", PAPER, "--section", "plan", "--method", "grid", "--json"];
    assert!(case.run(&sampled).exits(0).json()["plan"]["accuracy"].is_null());
}

#[test]
fn the_plan_says_why() {
    let flags = ["explain", "x^2 + y^2 = 1", "--section", "plan", "--method", "grid"];
    let text = Case::new().run(&flags).exits(0).stdout();
    assert!(text.contains("z                   no  F does not depend on it: the cells along it"), "{text}");
    assert!(text.contains("fit                 yes no box is given"), "{text}");
}

/// What no picture could be written to is refused as when it is drawn; the disk is left alone.
#[test]
fn names_are_checked_as_those_of_pictures_are() {
    let case = Case::new();
    let explain = |flags: &[&str]| case.run(&[&["explain", PAPER, "--section", "plan"], flags].concat());
    for (flags, problem) in [
        (&["-o", "foo.bar"][..], "names no picture format"),
        (&["--depth", "d.png"], "--depth writes .exr files"),
        (&["--points", "p.txt"], "--points writes .csv files"),
        (&["-o", "a.jpg", "--background", "none"], "this format has no transparency"),
        (&["--background", "none", "--depth", "d.exr"], "no shaded picture is written"),
    ] {
        let said = explain(flags).exits(2).mentions(problem).stderr();
        let drawn = case.run(&[&["render", PAPER], flags].concat()).exits(2);
        assert_eq!(said, drawn.stderr());
    }
    explain(&["-o", "missing/folder/a.png"]).exits(0);
    assert!(case.names().is_empty());
}

/// Options that change nothing in a plan are told to be none.
#[test]
fn options_without_effect_are_refused() {
    for flag in [
        "--time-limit=1s",
        "--keep-partial",
        "--threads=1",
        "--engine=interp",
        "--show-status",
        "--colors=gold",
    ] {
        Case::new().run(&["explain", PAPER, flag]).exits(2).mentions("unexpected argument");
    }
}

#[test]
fn sections_can_be_chosen() {
    let case = Case::new();
    let arguments = ["explain", PAPER, "--section", "tree,clif", "--json"];
    let json = case.run(&arguments).exits(0).json();
    let sections: Vec<&String> = json.as_object().unwrap().keys().collect();
    assert_eq!(sections, ["clif", "tree"]);
}

/// A listing has its limit, which is no reason to show nothing else.
#[test]
fn what_is_too_large_for_a_listing_is_explained_nevertheless() {
    let formula = (1..700).map(|k| format!("{k}*(x+{k})*(y-{k})*z")).collect::<Vec<_>>().join("+");
    let text = Case::new().run(&["explain", &formula, "--kernel", "boxes"]).exits(0).stdout();
    assert!(text.contains("plan: ") && text.contains("the jit engine allows 3000"), "{text}");
}

/// The hint is said, and what is computed stays what was written.
#[test]
fn better_forms_are_named_but_not_used() {
    let case = Case::new();
    let sections = ["--section", "hints,program"];
    let text = case.run(&[&["explain", "exp(x) - 1 = y"][..], &sections].concat()).exits(0).stdout();
    assert!(text.contains("hints: 1 hint,") && text.contains("expm1(x) keeps more of them"), "{text}");
    assert!(text.contains("exp(x)\n") && !text.contains("= expm1"), "{text}");
    let json = case.run(&["explain", PAPER, "--json", "--section", "hints"]).exits(0).json();
    assert_eq!(json["hints"]["size"], 0);
}

#[test]
fn both_engines_are_measured() {
    let case = Case::new();
    let flags = ["--size", "16", "--runs", "2", "--method", "grid", "--grid", "8"];
    let text = case.run(&[&["bench", PAPER][..], &flags].concat()).exits(0).stdout();
    assert!(text.contains("interpreter") && text.contains("native code"), "{text}");
    assert!(text.contains("medians of 2 runs (") && text.starts_with("11 operations; "), "{text}");
    let once = case.run(&["bench", "x", "--size", "1", "--runs", "1"]).exits(0).stdout();
    assert!(once.contains("medians of 1 run (") && once.starts_with("0 operations; "), "{once}");
    let json = case.run(&[&["bench", PAPER, "--json"][..], &flags].concat()).exits(0).json();
    for engine in ["interp", "jit"] {
        for measure in
            ["point_nanoseconds", "batch_nanoseconds", "compile_milliseconds", "picture_milliseconds"]
        {
            assert!(json[engine][measure]["median"].as_f64().unwrap() >= 0.0, "{engine} {measure}");
        }
    }
    assert!(json["gain"]["batch"].as_f64().unwrap() > 0.0);
}
