//! Help, completions, and command lines that make no sense.

use crate::harness::Case;

const COMMANDS: [&str; 9] =
    ["render", "eval", "trace", "explain", "bench", "engines", "report", "stress", "completions"];

#[test]
fn every_command_has_help_with_examples() {
    let case = Case::new();
    for command in COMMANDS {
        for help in ["-h", "--help"] {
            let text = case.run(&[command, help]).exits(0).stdout();
            assert!(text.contains("Examples:\n  iso "), "{command} {help}:\n{text}");
        }
    }
    let text = case.run(&["--help"]).exits(0).stdout();
    assert!(COMMANDS.iter().all(|command| text.contains(command)), "{text}");
    assert!(case.names().is_empty());
}

#[test]
fn formulas_in_the_help_are_understood() {
    let case = Case::new();
    let mut found = 0;
    for command in COMMANDS {
        let text = case.run(&[command, "--help"]).exits(0).stdout();
        for example in text.lines().filter(|line| line.trim_start().starts_with("iso ")) {
            let Some(formula) = example.split('\'').nth(1) else { continue };
            case.run(&["explain", formula, "--section", "tree"]).exits(0);
            found += 1;
        }
    }
    assert!(found > 20, "{found} formulas");
}

#[test]
fn the_version_is_the_packages() {
    Case::new().run(&["--version"]).exits(0).prints(concat!("iso ", env!("CARGO_PKG_VERSION"), "\n"));
}

#[test]
fn completions_exist_for_every_shell() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = Case::new().run(&["completions", shell]).exits(0).stdout();
        assert!(script.contains("render") && script.contains("show-status"), "{shell}");
    }
}

#[test]
fn bad_usage_exits_with_2() {
    let case = Case::new();
    let wrong: [&[&str]; 26] = [
        &[],
        &["draw"],
        &["render"],
        &["render", "x", "y"],
        &["render", "x", "--box", "1,2,3"],
        &["render", "x", "--box", "2,-2"],
        &["render", "x", "--box", "0,inf"],
        &["render", "x", "--size", "0x10"],
        &["render", "x", "--size", "99999x99999"],
        &["render", "x", "--level", "high"],
        &["render", "x", "--set", "a"],
        &["render", "x", "--engine", "fpga"],
        &["render", "x", "--method", "guess"],
        &["render", "x", "--method", "grid", "--grid", "0"],
        &["render", "x", "--method", "grid", "--grid", "4000000000"],
        &["render", "x", "--method", "grid", "--step", "0"],
        &["render", "x", "--method", "grid", "--tolerance", "-1"],
        &["render", "x", "--method", "grid", "--root-finder", "guess"],
        &["render", "x", "--threads", "-1"],
        &["render", "x", "--fov", "180"],
        &["render", "x", "--view-width", "3"],
        &["eval", "x"],
        &["eval", "x", "--points", "a.csv", "--boxes", "b.csv"],
        &["trace", "x"],
        &["bench", "x", "--runs", "0"],
        &["render", "a := 1; x = a", "--set", "a=2", "--sweep", "a=1:2"],
    ];
    for arguments in wrong {
        let run = case.run(arguments).exits(2);
        assert!(run.stdout().is_empty(), "{arguments:?}: {}", run.stdout());
        assert!(!run.stderr().is_empty(), "{arguments:?}");
    }
    assert!(case.names().is_empty(), "{:?}", case.names());
}

/// Defaults of lists are printed as lists are written.
#[test]
fn lists_are_shown_with_commas() {
    for (command, default) in [
        ("engines", "[default: 3,10,30,100,300,1000,3000,10000]"),
        ("engines", "[default: blobs,balls]"),
        ("report", "[default: certified,grid,octree,direct]"),
        ("report", "[default: 0,1e-6]"),
    ] {
        let help = Case::new().run(&[command, "-h"]).exits(0).stdout();
        let help = help.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(help.contains(default), "{default}: {help}");
    }
}

/// Whatever is out of range, the flag is named, and what it takes.
#[test]
fn settings_out_of_range_are_answered_with_the_range() {
    for (setting, range) in [
        ("--grid 0", "from 1 to 65536"),
        ("--grid 30,30,65537", "from 1 to 65536"),
        ("--refine 0", "from 1 to 64"),
        ("--refine 65", "from 1 to 64"),
        ("--step 1e-300", "from 1e-6 to 1"),
        ("--step 2", "from 1e-6 to 1"),
        ("--accuracy 100", "from 0 to 1"),
        ("--accuracy 0", "above zero"),
        ("--tolerance 2", "from 0 to 1"),
        ("--smooth 17", "from 1 to 16"),
    ] {
        let mut words = vec!["render", "x"];
        words.extend(setting.split(' '));
        let flag = format!("for '{} <", words[2]);
        Case::new().run(&words).exits(2).mentions("invalid value").mentions(&flag).mentions(range);
    }
    for (method, grid) in [("grid", "1000"), ("octree", "60000")] {
        Case::new()
            .run(&["render", "x^2+y^2+z^2=1", "--method", method, "--grid", grid, "--box", "-1,1"])
            .exits(2)
            .mentions("cells; at most")
            .mentions("help: choose a smaller --grid");
    }
}

/// Numbers below zero are told to be out of range, and not taken for options.
#[test]
fn numbers_below_zero_are_answered_with_the_range() {
    for (arguments, option) in [
        (&["trace", "x", "--ray", "0,0,0,1,1,1", "--accuracy", "-1"][..], "--accuracy"),
        (&["trace", "x", "--ray", "0,0,0,1,1,1", "--step", "-1"], "--step"),
        (&["render", "x", "--time-limit", "-1s"], "--time-limit"),
        (&["stress", "--threads", "-1"], "--threads"),
        (&["bench", "x", "--runs", "-1"], "--runs"),
        (&["report", "x", "--runs", "-1"], "--runs"),
        (&["engines", "--runs", "-1"], "--runs"),
    ] {
        Case::new().run(arguments).exits(2).mentions("invalid value").mentions(option);
    }
}

#[test]
fn a_formula_without_a_command_is_told_which() {
    let case = Case::new();
    case.run(&["x^2 + y^2 + z^2 = 1"])
        .exits(2)
        .mentions("tip: to draw a formula, write 'iso render FORMULA'");
    case.run(&["rendr", "x"]).exits(2).mentions("'render'");
}

#[test]
fn tips_tell_how_formulas_and_boxes_are_written() {
    let case = Case::new();
    for parts in [
        "render x^2 + y^2 = 1",
        "explain x -y^2",
        "eval x y",
        "report --grids 30 x + y",
        "report --methods grid x^2 + 1",
    ] {
        let parts: Vec<_> = parts.split(' ').collect();
        case.run(&parts).exits(2).mentions("tip: a formula stands in quotes");
    }
    for line in [
        "stress shell_1e-6",
        "completions bash foo",
        "explain x -q",
        "eval x --at 1,2,3 -a",
        "engines --nonsense",
        "trace x --ray 0,0,0,1,0,0 --nonsense",
        "engines --sizes 3 -q",
    ] {
        let run = case.run(&line.split(' ').collect::<Vec<_>>()).exits(2).mentions("unexpected argument");
        let said = run.stderr();
        let wrong = ["quotes", "as a value", "commas"];
        assert!(wrong.iter().all(|tip| !said.contains(tip)), "{line}: {said}");
    }
    for (line, list) in [
        ("engines --sizes 3 10 30", "--sizes 3,10"),
        ("engines --sides 64, 128", "--sides 64,128"),
        ("report x --grids 30 60", "--grids 30,60"),
        ("explain x --section plan tree", "--section plan,tree"),
    ] {
        let tip = format!("tip: a list is separated by commas: {list}\n");
        case.run(&line.split(' ').collect::<Vec<_>>()).exits(2).mentions(&tip);
    }
    case.run(&["render", "x", "--box=-1,1,-1,1,-1,1"]).exits(2).mentions("the order is xmin,ymin,zmin");
    case.run(&["render", "x", "--sizes", "5"]).exits(2).mentions("'--size'");
}

#[test]
fn pages_are_written_to_files() {
    let run = Case::new().run(&["stress", "--html", "-"]);
    run.exits(2).reports("error: `-` is standard output, where this cannot go\n  help: name a file\n");
}

#[test]
fn settings_of_another_method_are_refused() {
    Case::new().run(&["render", "x", "--grid", "30"]).exits(2).reports(
        "error: --grid has no meaning for the method certified\n  help: leave it out, or choose --method grid or octree\n",
    );
    for flags in [
        ["--method", "direct", "--grid", "30"],
        ["--method", "grid", "--accuracy", "1e-6"],
        ["--method", "certified", "--root-finder", "itp"],
        ["--method", "certified", "--tolerance", "1e-6"],
    ] {
        let mut arguments = vec!["render", "x"];
        arguments.extend(flags);
        Case::new().run(&arguments).exits(2).mentions("has no meaning for the method");
    }
}
