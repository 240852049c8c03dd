//! `iso report`: error against run time.

use serde_json::Value;

use crate::harness::{Case, Run};

/// A ball that lies between the points of a grid of 8 cells from -2 to 2, the nearest of which is 0.43 from its centre.
const HIDDEN_BALL: &str = "(x - 0.25)^2 + (y - 0.25)^2 + (z - 0.25)^2 = 0.04";
/// Settings of the tests' sweep: four methods on two engines.
const SETTINGS: usize = 8;

fn report(case: &Case, more: &[&str]) -> Run {
    let mut arguments = vec!["report", HIDDEN_BALL, "--box", "-2,2", "--size", "64x48", "--grids", "8"];
    arguments.extend([
        "--steps",
        "0.05",
        "--refines",
        "3",
        "--root-finders",
        "bisection",
        "--tolerances",
        "0",
    ]);
    arguments.extend(["--runs", "2", "--sizes", "3,40", "-o", "out"]);
    arguments.extend(more);
    case.run(&arguments)
}

fn runs(report: &Value) -> &[Value] {
    report["formulas"][0]["runs"].as_array().unwrap()
}

#[test]
fn what_methods_miss_is_counted() {
    let json = report(&Case::new(), &["--json"]).exits(0).json();
    assert_eq!(runs(&json).len(), SETTINGS);
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
    let advice = json["formulas"][0]["advice"].as_str().unwrap();
    assert!(advice.starts_with("Use --method ") && advice.contains("no wrong pixel"), "{advice}");
}

#[test]
fn phases_add_up_and_engines_agree() {
    let json = report(&Case::new(), &["--json"]).exits(0).json();
    const PHASES: [&str; 5] = ["compile", "preprocess", "trace", "shade", "other"];
    for run in runs(&json) {
        let times = &run["milliseconds"];
        for kind in ["middle", "middle_processor"] {
            let time = |phase: &str| times[kind][phase].as_f64().unwrap_or(0.0);
            let (parts, total) = (PHASES.map(time), time("total"));
            assert!((parts.iter().sum::<f64>() - total).abs() <= 1e-9 * total, "{kind} of {run}");
            assert!(parts.iter().all(|&part| part >= -1e-9 * total), "{kind} of {run}");
        }
        for phase in PHASES.into_iter().chain(["total"]) {
            let spread = &times["spread"][phase];
            let [least, median, greatest] =
                ["least", "median", "greatest"].map(|key| spread[key].as_f64().unwrap());
            let middle = times["middle"][phase].as_f64().unwrap();
            assert!(least <= median && median <= greatest, "{phase} of {run}");
            assert!(least <= middle && middle <= greatest, "{phase} of {run}");
        }
    }
    let (native, interpreted) = runs(&json).split_at(SETTINGS / 2);
    for (one, other) in native.iter().zip(interpreted) {
        assert_eq!((&one["method"], &one["quality"]), (&other["method"], &other["quality"]));
        assert_eq!(one["counters"], other["counters"]);
    }
}

/// Every element of an XML file, looked at by `check`.
fn check_elements(case: &Case, name: &str, check: impl Fn(roxmltree::Node)) {
    let text = String::from_utf8(case.content(name)).unwrap();
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    let document = roxmltree::Document::parse_with_options(&text, options);
    let document = document.unwrap_or_else(|error| panic!("{name}: {error}\n{text}"));
    document.descendants().filter(|node| node.is_element()).for_each(check);
    assert!(!text.contains("url(") && !text.contains("@import"), "{name}");
}

#[test]
fn the_page_is_well_formed_and_needs_nothing_else() {
    let case = Case::new();
    report(&case, &["--grids", "8,20"]).exits(0);
    let plots = ["wrong", "distance", "cells", "preprocess", "trace", "evaluations", "missed", "memory"];
    let plots = plots.map(|plot| format!("out/plots/{plot}.svg"));
    for name in plots.iter().map(String::as_str).chain(["out/report.html"]) {
        check_elements(&case, name, |element| {
            assert!(!["script", "link", "iframe"].contains(&element.tag_name().name()), "{name}");
            for reference in ["src", "href"] {
                let address = element.attribute(reference).unwrap_or("data:image/png;base64,");
                assert!(address.starts_with("data:image/png;base64,"), "{name}: {address}");
            }
            for attribute in element.attributes() {
                assert!(!attribute.value().contains("NaN"), "{name}: {}", attribute.value());
            }
        });
    }
    let page = String::from_utf8(case.content("out/report.html")).unwrap();
    let images = page.matches("data:image/png;base64,").count();
    assert_eq!(images, 4, "the proven picture, and one for each method that samples");
    assert!(page.contains("stroke-dasharray") && page.contains("<title>--method grid"), "{page}");
}

#[test]
fn the_table_has_a_row_for_each_run_and_all_columns_are_documented() {
    let case = Case::new();
    report(&case, &[]).exits(0);
    let content = case.content("out/report.csv");
    let mut table = csv::Reader::from_reader(&content[..]);
    let headers = table.headers().unwrap().clone();
    let records: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    assert_eq!(records.len(), SETTINGS);
    let documentation = include_str!("../../docs/report.md");
    for column in &headers {
        // Columns of phases and deviations are documented by their parts.
        let parts = column.split_once('_').map_or([column, column], |(what, figure)| [what, figure]);
        let is_documented =
            [column, parts[0]].iter().any(|name| documentation.contains(&format!("`{name}`")));
        assert!(is_documented, "{column} is not in docs/report.md");
    }
}

#[test]
fn axes_are_varied_one_at_a_time_unless_crossed() {
    let axes = ["--methods", "grid", "--engines", "jit", "--steps", "0.05,0.5", "--tolerances", "0,1e-4"];
    let flags = |more: &[&str]| -> Vec<String> {
        let arguments: Vec<&str> = axes.iter().chain(&["--json"]).chain(more).copied().collect();
        let json = report(&Case::new(), &arguments).exits(0).json();
        runs(&json).iter().map(|run| run["flags"].as_str().unwrap().to_owned()).collect()
    };
    let one_by_one = flags(&[]);
    let plain = "--method grid --engine jit --grid 8 --step";
    assert_eq!(
        one_by_one,
        [format!("{plain} 0.05"), format!("{plain} 0.5"), format!("{plain} 0.05 --tolerance 1e-4")]
    );
    assert_eq!(flags(&["--cross"])[3..], [format!("{plain} 0.5 --tolerance 1e-4")]);
}

#[test]
fn a_suite_is_one_report() {
    let case = Case::new();
    let arguments =
        ["report", "--suite", "stiff", "--size", "16", "--methods", "certified,direct", "--runs", "1"];
    let more = [
        "--engines",
        "jit",
        "--steps",
        "0.05",
        "--root-finders",
        "bisection",
        "--tolerances",
        "0",
        "-o",
        "out",
    ];
    let json = case.run(&[&arguments[..], &more, &["--json"]].concat()).exits(0).json();
    let formulas = json["formulas"].as_array().unwrap();
    let scenes: toml::Table = toml::from_str(include_str!("../../testdata/oracle/scenes.toml")).unwrap();
    let stiff =
        scenes["scene"].as_array().unwrap().iter().filter(|scene| {
            scene["tags"].as_array().unwrap().iter().any(|tag| tag.as_str() == Some("stiff"))
        });
    let names: Vec<&str> = stiff.map(|scene| scene["name"].as_str().unwrap()).collect();
    assert_eq!(formulas.iter().map(|formula| formula["name"].as_str().unwrap()).collect::<Vec<_>>(), names);
    let page = String::from_utf8(case.content("out/report.html")).unwrap();
    for name in names {
        assert!(page.contains(&format!("<h2 id=\"{name}\">")) && page.contains(&format!("href=\"#{name}\"")));
        assert!(!case.content(&format!("out/plots/{name}-wrong.svg")).is_empty());
    }
    for formula in formulas {
        let certified = &formula["runs"][0]["quality"];
        assert_eq!((&certified["missed"], &certified["false"]), (&0.into(), &0.into()), "{formula}");
    }
}

#[test]
fn a_suite_takes_no_formula() {
    let case = Case::new();
    case.run(&["report", HIDDEN_BALL, "--suite", "classic"]).exits(2).mentions("--suite");
    case.run(&["report"]).exits(2).mentions("FORMULA");
    assert!(case.names().is_empty());
}

#[test]
fn a_spent_budget_leaves_a_report_that_says_so() {
    let case = Case::new();
    let json = report(&case, &["--budget", "1ms", "--json"]).exits(0).json();
    assert!(json["formulas"].as_array().unwrap().is_empty() || runs(&json).len() < SETTINGS);
    assert!(json.to_string().contains("stopped early"), "{json}");
    assert!(!case.content("out/report.html").is_empty());
}

#[test]
fn the_file_that_the_formula_is_read_from_is_not_replaced() {
    let case = Case::new();
    case.file("report.csv", "x + y");
    case.run(&["report", "@report.csv", "-o", "."]).exits(2).mentions("would take the place of report.csv");
    assert_eq!(case.content("report.csv"), b"x + y");
}

#[test]
fn a_file_is_no_folder() {
    let case = Case::new();
    case.file("a.png", "");
    for (command, folder) in [("report", "a.png"), ("report", "a.png/b"), ("engines", "a.png")] {
        let formula = (command == "report").then_some("x");
        let words: Vec<&str> = [command].into_iter().chain(formula).chain(["-o", folder]).collect();
        case.run(&words).exits(2).reports("error: a.png is a file\n  help: name a folder\n");
    }
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

#[test]
fn growing_formulas_are_measured_by_both_engines() {
    let json = report(&Case::new(), &["--json"]).exits(0).json();
    let engines = json["engines"].as_array().unwrap();
    assert_eq!(engines[0]["operations"], 3);
    for evaluation in engines {
        for kind in ["point", "batch", "compile"] {
            let times = evaluation[kind].as_array().unwrap();
            assert!(times.len() == 2 && times.iter().all(|time| time["least"].as_f64().unwrap() > 0.0));
        }
    }
    let one_engine = report(&Case::new(), &["--engines", "jit", "--json"]).exits(0).json();
    assert_eq!(one_engine["engines"], Value::Array(Vec::new()));
}
