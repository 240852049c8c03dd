//! `iso report`: error against run time.

use serde_json::Value;

use crate::harness::{Case, Run};

/// A ball that lies between the points of a grid of 8 cells from -2 to 2, the nearest of which is 0.43 from its centre.
const HIDDEN_BALL: &str = "(x - 0.25)^2 + (y - 0.25)^2 + (z - 0.25)^2 = 0.04";
const FILES: [&str; 5] = ["cells.svg", "error.svg", "report.csv", "report.html", "report.json"];

fn report(case: &Case, more: &[&str]) -> Run {
    let mut arguments = vec!["report", HIDDEN_BALL, "--box", "-2,2", "--size", "64x48", "--grids", "8"];
    arguments.extend(["--steps", "0.05", "--runs", "2", "-o", "out"]);
    arguments.extend(more);
    case.run(&arguments)
}

fn runs(report: &Value) -> &[Value] {
    report["runs"].as_array().unwrap()
}

#[test]
fn what_methods_miss_is_counted() {
    let json = report(&Case::new(), &["--json"]).exits(0).json();
    assert_eq!(runs(&json).len(), 8, "four methods on two engines");
    for run in runs(&json) {
        let quality = &run["quality"];
        let pixels =
            ["right", "missed", "false", "undecided", "open"].map(|key| quality[key].as_u64().unwrap());
        assert_eq!(pixels.iter().sum::<u64>(), 64 * 48, "{run}");
        let [_, missed, made_up, undecided, _] = pixels;
        assert_eq!((made_up, undecided), (0, 0), "{run}");
        let sees_nothing = ["grid", "octree"].contains(&run["method"].as_str().unwrap());
        assert_eq!(missed > 0, sees_nothing, "{run}");
        assert_eq!(quality["psnr"].is_null(), !sees_nothing, "{run}");
    }
    let advice = json["advice"].as_str().unwrap();
    assert!(advice.starts_with("Use --method ") && advice.contains("no wrong pixel"), "{advice}");
}

#[test]
fn phases_add_up_and_engines_agree() {
    let json = report(&Case::new(), &["--json"]).exits(0).json();
    for run in runs(&json) {
        let phases = &run["phases"];
        let time = |key: &str| phases[key].as_f64().unwrap();
        let parts = ["compile", "preprocess", "trace", "shade", "other"].map(time);
        let total = time("total");
        assert!((parts.iter().sum::<f64>() - total).abs() <= 1e-9 * total, "{run}");
        assert!(parts.iter().all(|&part| part >= 0.0), "{run}");
        let [least, median, greatest] =
            ["least", "median", "greatest"].map(|key| run["milliseconds"][key].as_f64().unwrap());
        assert!(least <= total && total <= median && median <= greatest, "{run}");
    }
    let (native, interpreted) = runs(&json).split_at(4);
    for (one, other) in native.iter().zip(interpreted) {
        assert_eq!((&one["method"], &one["quality"]), (&other["method"], &other["quality"]));
        assert_eq!(one["counters"], other["counters"]);
    }
}

#[test]
fn the_page_is_well_formed_and_needs_nothing_else() {
    let case = Case::new();
    report(&case, &[]).exits(0);
    for name in ["out/report.html", "out/error.svg", "out/cells.svg"] {
        let text = String::from_utf8(case.content(name)).unwrap();
        let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
        let document = roxmltree::Document::parse_with_options(&text, options);
        let document = document.unwrap_or_else(|error| panic!("{name}: {error}\n{text}"));
        for element in document.descendants().filter(|node| node.is_element()) {
            assert!(!["script", "link", "img", "iframe"].contains(&element.tag_name().name()), "{name}");
            for reference in ["src", "href"] {
                assert_eq!(element.attribute(reference), None, "{name}");
            }
            for attribute in element.attributes() {
                assert!(!attribute.value().contains("NaN"), "{name}: {}", attribute.value());
            }
        }
        assert!(!text.contains("url(") && !text.contains("@import"), "{name}");
    }
}

#[test]
fn the_table_has_a_row_for_each_run() {
    let case = Case::new();
    report(&case, &[]).exits(0);
    let mut names = std::fs::read_dir(case.path("out")).unwrap();
    let mut found = Vec::new();
    while let Some(Ok(entry)) = names.next() {
        found.push(entry.file_name().into_string().unwrap());
    }
    found.sort();
    assert_eq!(found, FILES);
    let content = case.content("out/report.csv");
    let mut table = csv::Reader::from_reader(&content[..]);
    assert_eq!(table.headers().unwrap().len(), 43);
    assert_eq!(table.records().map(Result::unwrap).count(), 8);
}

#[test]
fn a_spent_budget_leaves_a_report_that_says_so() {
    let case = Case::new();
    let json = report(&case, &["--budget", "1ms", "--json"]).exits(0).json();
    assert!(runs(&json).len() < 8);
    assert!(json["notes"].to_string().contains("stopped early"), "{json}");
    assert!(!case.content("out/report.html").is_empty());
}

#[test]
fn settings_out_of_range_are_known_before_anything_is_measured() {
    for (flag, value) in
        [("--grids", "0"), ("--grids", "99999999"), ("--steps", "0"), ("--steps", "2"), ("--budget", "soon")]
    {
        let case = Case::new();
        case.run(&["report", HIDDEN_BALL, flag, value]).exits(2).mentions(flag);
        assert!(case.names().is_empty());
    }
}
