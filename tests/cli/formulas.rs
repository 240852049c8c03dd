//! Formulas from everywhere, and what is said about wrong ones.

use std::ffi::{OsStr, OsString};

use crate::harness::{Case, Run};

fn render<A: AsRef<OsStr>>(case: &Case, formula: A, more: &[&str]) -> Run {
    let small = ["--size", "16", "--method", "grid", "--grid", "8", "-q"];
    let mut arguments: Vec<OsString> = vec!["render".into(), formula.as_ref().into()];
    arguments.extend(small.iter().chain(more).map(OsString::from));
    case.run_with_input(&arguments, b"x^2 + y^2 + z^2 = 1\n")
}

#[test]
fn a_formula_comes_from_the_argument_a_file_or_standard_input() {
    let case = Case::new();
    case.file("sphere.txt", "# a sphere\nx^2 + y^2 +\n  z^2 = 1\n");
    for (formula, output) in [
        ("x^2 + y^2 + z^2 = 1", "a.png"),
        ("@sphere.txt", "b.png"),
        ("-", "c.png"),
        ("-x^2 - y^2 - z^2 = -1", "d.png"),
    ] {
        render(&case, formula, &["-o", output]).exits(0).reports("");
    }
    assert_eq!(case.content("a.png"), case.content("b.png"));
    assert_eq!(case.content("a.png"), case.content("c.png"));
}

#[test]
fn parameters_are_set_on_the_command_line() {
    let case = Case::new();
    let formula = "a := 1; x^2 + y^2 + z^2 = a";
    render(&case, formula, &["--set", "a=2", "-o", "set.png"]).exits(0);
    render(&case, "x^2 + y^2 + z^2 = 2", &["-o", "written.png"]).exits(0);
    render(&case, formula, &["-o", "default.png"]).exits(0);
    assert_eq!(case.content("set.png"), case.content("written.png"));
    assert_ne!(case.content("set.png"), case.content("default.png"));
    render(&case, formula, &["--set", "b=2"]).exits(2).mentions("no parameter `b`");
}

#[test]
fn a_level_belongs_to_an_expression() {
    let case = Case::new();
    render(&case, "x^2 + y^2 + z^2", &["--level", "2", "-o", "level.png"]).exits(0);
    render(&case, "x^2 + y^2 + z^2 = 2", &["-o", "equation.png"]).exits(0);
    render(&case, "-x^2 - y^2 - z^2", &["--level", "-2", "-o", "negative.png"]).exits(0);
    assert_eq!(case.content("level.png"), case.content("equation.png"));
    render(&case, "x = 1", &["--level", "2"]).exits(2).reports(
        "error: a level (2) is given with an equation, which needs none\n  help: the surface of left = right is where left − \
         right = 0: leave out --level, or write (left) - (right)\n",
    );
}

#[test]
fn errors_stand_under_the_place() {
    let case = Case::new();
    for (formula, report) in [
        (
            "x^2 + sine(y)",
            "\
error: the function `sine` is unknown
 --> formula:1:7
  |
1 | x^2 + sine(y)
  |       ^^^^
  help: did you mean `sin`?
",
        ),
        (
            "√z·x² + 2xy",
            "\
error: the name `xy` is unknown
 --> formula:1:10
  |
1 | √z·x² + 2xy
  |          ^^
  help: did you mean `x*y`?
",
        ),
        (
            "a := 2\nlog(x) = a",
            "\
error: `log` alone does not say its base
 --> formula:2:1
  |
2 | log(x) = a
  | ^^^^^^
  help: write `ln(x)` for base e, `log2(x)`, `log10(x)`, or `log(b, x)` for base b
",
        ),
    ] {
        render(&case, formula, &[]).exits(2).prints("").reports(report);
    }
}

/// What people type who come from other programs.
#[test]
fn habits_from_elsewhere_are_answered() {
    let case = Case::new();
    case.file("ball.txt", "x^2 + y^2 + z^2 = 1");
    for (formula, expected) in [
        ("x2 + y2 = 1", "did you mean `x^2` or `x*2`?"),
        ("xy = 1", "did you mean `x*y`? To define it, write `xy := …`"),
        ("r = x^2; r", "to define it, write `r := …`"),
        ("sqr(x) = y", "`sqr(u)` is written `u^2`"),
        ("x mod 1 = y", "it is called as `mod(a, b)`"),
        ("sin x = y", "write `sin(x)`"),
        ("atan(y, x) = z", "it is called as `atan2(y, x)`"),
        ("hypot(x, y, z) = 1", "it is called as `hypot(hypot(a, b), c)`"),
        ("poly(x) = 1", "leave out `poly(…) =` before a formula"),
        ("a := 2 x = a", "`;` or a new line ends a definition, and the equation comes after it"),
        ("F(x, y, z) = x", "leave out `F(…) =` before a formula"),
        ("foo(x) + y", "define it before: `foo(u) := …`"),
        ("cube*x", "the coordinates are x, y and z"),
        ("x && y", "write `and` between conditions"),
        ("\\frac{x}{2}", "`\\` has no meaning in a formula"),
        ("x = 1 // a plane", "comments begin with `#`"),
        ("x = 30°", "angles are in radians"),
        ("sin^-1(x) = y", "the inverse function is `asin(x)`"),
        ("2∗x = y", "write `*`"),
        ("ball.txt", "there is a file of this name: write `@ball.txt` to read it"),
        ("@", "write `@formula.txt`"),
    ] {
        let report = render(&case, formula, &[]).exits(2).prints("").stderr();
        assert!(report.contains(expected), "{formula}: {report}");
    }
}

#[test]
fn errors_in_files_name_the_file_and_the_line() {
    let case = Case::new();
    case.file("two.txt", "a := 2\r\nx + (y\r\n");
    render(&case, "@two.txt", &[]).exits(2).reports(
        "\
error: this parenthesis is never closed
 --> two.txt:2:5
  |
2 | x + (y
  |     ^
  help: add `)`
",
    );
}

#[test]
fn huge_wrong_formulas_have_small_reports() {
    let case = Case::new();
    case.file("parentheses.txt", "(".repeat(10_000));
    case.file("sum.txt", "+x".repeat(100_000) + "+?" + &"+y".repeat(100_000));
    case.file("megabyte.txt", "+x".repeat(1 << 20));
    for name in ["@parentheses.txt", "@sum.txt", "@megabyte.txt"] {
        let run = render(&case, name, &[]).exits(2);
        assert!(run.stderr().len() < 1000, "{name}: {} bytes", run.stderr().len());
    }
}

#[test]
fn formulas_are_read_no_further_than_they_may_be_long() {
    let case = Case::new();
    // A character of two bytes stands where reading ends.
    let text = format!("{}{}", "x".repeat((1 << 20) + 3), "π".repeat(1 << 20));
    case.file("long.txt", &text);
    for (formula, name) in [("-", "standard input"), ("@long.txt", "long.txt")] {
        let run = case.run_with_input(&["explain", formula], text.as_bytes()).exits(2);
        run.mentions("the formula is longer than 1048576 bytes").mentions(name);
    }
}

#[test]
fn formulas_that_are_no_text_are_refused() {
    let case = Case::new();
    case.file("latin1.txt", b"x + \xe9");
    render(&case, "@latin1.txt", &[]).exits(2).mentions("not UTF-8");
    #[cfg(unix)]
    {
        use std::os::unix::ffi::OsStrExt;
        render(&case, OsStr::from_bytes(b"x + \xff"), &[]).exits(2).mentions("not UTF-8");
    }
    render(&case, "", &[]).exits(2).mentions("empty");
}

#[test]
fn a_formula_that_cannot_be_read_exits_with_1() {
    let case = Case::new();
    render(&case, "@missing.txt", &[]).exits(2).mentions("cannot read missing.txt");
    render(&case, "@.", &[]).exits(2);
    assert!(case.names().is_empty());
}

#[test]
fn a_model_is_taken_wherever_a_formula_is() {
    let case = Case::new();
    case.file("ball.vm", "# a ball\n_0 var-x\n_1 square _0\n_2 var-y\n_3 square _2\n_4 add _1 _3\n_5 var-z\n_6 square _5\n_7 add _4 _6\n_8 const 1\n_9 sub _7 _8\n");
    case.file("points.csv", "x,y,z\n2,0,0\n");
    render(&case, "ball.vm", &["-o", "model.png"]).exits(0).reports("");
    render(&case, "@ball.vm", &["-o", "again.png"]).exits(0);
    render(&case, "x^2 + y^2 + z^2 - 1", &["-o", "formula.png"]).exits(0);
    assert_eq!(case.content("model.png"), case.content("formula.png"));
    assert_eq!(case.content("again.png"), case.content("formula.png"));
    case.run(&["eval", "ball.vm", "--points", "points.csv"]).exits(0).prints("value\n3\n");
    let explained = case.run(&["explain", "ball.vm", "--section", "program"]).exits(0).stdout();
    assert!(explained.starts_with("program: 6 operations"), "{explained}");
}

#[test]
fn a_wrong_model_is_refused_with_the_place() {
    let case = Case::new();
    case.file("wrong.vm", "_0 var-x\n_1 add _0 _7\n")
        .file("empty.vm", "\n# nothing\n")
        .file("bytes.vm", b"a \xff");
    render(&case, "wrong.vm", &[]).exits(2).mentions("`_7` is unknown").mentions("wrong.vm:2:11");
    render(&case, "empty.vm", &[]).exits(2).mentions("one operation a line");
    render(&case, "bytes.vm", &[]).exits(2).mentions("UTF-8");
    render(&case, "absent.vm", &[]).exits(2).mentions("absent.vm");
    case.file("x.vm", "_0 var-x\n");
    render(&case, "x.vm", &["--set", "a=1"]).exits(2).mentions("no parameters");
    assert_eq!(case.names(), ["bytes.vm", "empty.vm", "wrong.vm", "x.vm"]);
}

#[test]
fn what_needs_too_much_room_for_native_code_is_interpreted() {
    let case = Case::new();
    let ball =
        |number: u32| format!("sqrt((x - {number}/99)^2 + (y - {number}/77)^2 + (z - {number}/55)^2) - 0.15");
    let union = (0..130).map(ball).collect::<Vec<_>>().join(", ");
    let arguments = ["render", &format!("min({union})"), "--box", "-2,2", "--size", "8", "-q"];
    for (engine, output) in [("jit", "jit.png"), ("interp", "interp.png")] {
        case.run(&[&arguments[..], &["--engine", engine, "-o", output]].concat()).exits(0);
    }
    assert_eq!(case.content("jit.png"), case.content("interp.png"));
}

#[test]
fn a_parameter_has_one_value() {
    let case = Case::new();
    let twice = ["eval", "a := 1; a x", "--at", "1,2,3", "--set", "a=2", "--set", "a=3"];
    case.run(&twice).exits(2).mentions("several values are given to a");
    let swept = ["render", "a := 1; a x", "--sweep", "a=1:2", "--sweep", "a=5:9", "--frames", "2"];
    case.run(&swept).exits(2).mentions("several values are given to a");
}
