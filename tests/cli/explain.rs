//! `iso explain` and `iso bench`: what the program says about itself.

use crate::harness::Case;

const PAPER: &str = "(x^2+y^2-1)^2 + 4z^2 + 0.5x = 0.2";
const SECTIONS: [&str; 6] = ["tree", "program", "simplified", "gradient", "clif", "assembly"];

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

#[test]
fn sections_can_be_chosen() {
    let case = Case::new();
    let arguments = ["explain", PAPER, "--section", "tree,clif", "--json"];
    let json = case.run(&arguments).exits(0).json();
    let sections: Vec<&String> = json.as_object().unwrap().keys().collect();
    assert_eq!(sections, ["clif", "tree"]);
}

/// The hint is said, and what is computed stays what was written.
#[test]
fn better_forms_are_named_but_not_used() {
    let case = Case::new();
    let sections = ["--section", "hints,program"];
    let text = case.run(&[&["explain", "exp(x) - 1 = y"][..], &sections].concat()).exits(0).stdout();
    assert!(text.contains("hints: 1 hints") && text.contains("expm1(x) keeps them"), "{text}");
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
    let json = case.run(&[&["bench", PAPER, "--json"][..], &flags].concat()).exits(0).json();
    for engine in ["interpreter", "native"] {
        for measure in
            ["point_nanoseconds", "batch_nanoseconds", "compile_milliseconds", "picture_milliseconds"]
        {
            assert!(json[engine][measure]["median"].as_f64().unwrap() >= 0.0, "{engine} {measure}");
        }
    }
    assert!(json["gain"]["batch"].as_f64().unwrap() > 0.0);
}
