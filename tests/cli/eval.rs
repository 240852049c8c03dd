//! `iso eval`: values at points and enclosures over boxes.

use crate::harness::Case;

const ENGINES: [&str; 2] = ["jit", "interp"];

#[test]
fn values_stand_in_the_order_of_the_points() {
    let case = Case::new();
    case.file("points.csv", "# places\nz,name,x,y\n3,a,1,2\n0,b,-1,1e-3\n");
    for engine in ENGINES {
        let arguments = ["eval", "x + 10y + 100z", "--points", "points.csv", "--engine", engine];
        case.run(&arguments).exits(0).prints("value\n321\n-0.99\n");
    }
}

#[test]
fn gradients_stand_beside_the_values() {
    let case = Case::new();
    case.file("points.csv", "x,y,z\n1,2,3\n0,0,0\n");
    for engine in ENGINES {
        let arguments =
            ["eval", "x^2 y + sqrt(z)", "--points", "points.csv", "--gradient", "--engine", engine];
        let table = case.run(&arguments).exits(0).stdout();
        let rows: Vec<&str> = table.lines().collect();
        assert_eq!(rows[0], "value,dx,dy,dz");
        assert_eq!(rows[1], "3.732050807568877,4,1,0.2886751345948129");
        assert!(rows[2].starts_with("0,0,0,"), "{}", rows[2]);
    }
}

#[test]
fn results_do_not_take_the_place_of_what_is_read() {
    let case = Case::new();
    let points = "x,y,z\n1,2,3\n";
    case.file("points.csv", points);
    case.run(&["eval", "x", "--points", "points.csv", "-o", "./points.csv"]).exits(2).reports(
        "error: the results would take the place of points.csv, which is read\n  help: give the results another name\n",
    );
    assert_eq!(case.content("points.csv"), points.as_bytes());
    case.file("plane.txt", "x");
    case.run(&["eval", "@plane.txt", "--at", "1,2,3", "-o", "plane.txt"])
        .exits(2)
        .mentions("plane.txt, which is read");
    assert_eq!(case.content("plane.txt"), b"x");
}

#[test]
fn what_is_undefined_has_no_derivatives() {
    let case = Case::new();
    case.run(&["eval", "ln(x)", "--at=-2,0,0", "--gradient"])
        .exits(0)
        .prints("value,dx,dy,dz\nnan,nan,nan,nan\n");
    let with_errors = case.run(&["eval", "ln(x)", "--at=-2,0,0", "--gradient", "--error"]).exits(0).stdout();
    assert_eq!(with_errors.lines().last(), Some(&*["nan"; 12].join(",")));
    case.file("boxes.csv", "x_lo,x_hi,y_lo,y_hi,z_lo,z_hi\n-3,-2,0,0,0,0\n0.5,1.5,0,0,0,0\n");
    let undefined = case.run(&["eval", "ln(x)", "--boxes", "boxes.csv", "--gradient"]).exits(0).stdout();
    assert_eq!(undefined.lines().nth(1), Some(&*["empty,empty,trv"; 4].join(",")));
    let jumps = case.run(&["eval", "floor(x)", "--boxes", "boxes.csv", "--gradient"]).exits(0).stdout();
    assert_eq!(jumps.lines().nth(2), Some("0,1,def,0,0,trv,0,0,trv,0,0,trv"));
}

#[test]
fn points_can_be_given_without_a_table() {
    let case = Case::new();
    for engine in ENGINES {
        let arguments = ["eval", "x y", "--level", "1", "--at", "-1/2,4,0", "--at=0,0,0", "--gradient"];
        let arguments = [&arguments[..], &["--engine", engine]].concat();
        case.run(&arguments).exits(0).prints("value,dx,dy,dz\n-3,4,-0.5,0\n-1,0,0,0\n");
    }
    case.run(&["eval", "x", "--at", "1,2"]).exits(2).mentions("expected 3 numbers (x,y,z), found 2");
    case.run(&["eval", "x = 1", "--level", "1", "--at", "1,2,3"]).exits(2).mentions("leave out --level");
    case.run(&["eval", "x"]).exits(2).mentions("--at <X,Y,Z>|--points <FILE.csv>|--boxes <FILE.csv>");
}

#[test]
fn an_equation_is_its_left_side_minus_its_right_side() {
    let case = Case::new();
    case.file("points.csv", "x,y,z\n5,3,0\n");
    case.run(&["eval", "x = y", "--points", "points.csv"]).exits(0).prints("value\n2\n");
}

#[test]
fn digits_read_back_to_the_same_float() {
    let case = Case::new();
    let values = [0.1, 1.0 / 3.0, -1e300, 5e-324, f64::MAX, -0.0, 123_456_789.123_456_78, 1e22];
    let rows: String = values.iter().map(|value| format!("{value:e},0,0\n")).collect();
    case.file("points.csv", format!("x,y,z\n{rows}nan,0,0\ninf,0,0\n"));
    let table = case.run(&["eval", "x", "--points", "points.csv"]).exits(0).stdout();
    let read: Vec<f64> = table.lines().skip(1).map(|line| line.parse().unwrap()).collect();
    for (value, read) in values.iter().zip(&read) {
        assert_eq!(value.to_bits(), read.to_bits(), "{value} {read}");
    }
    assert!(read[values.len()].is_nan() && read[values.len() + 1] == f64::INFINITY);
}

/// (x + 1)² − x² − 2x is 1 in exact arithmetic; at 2²⁷ + 1 its terms are too long for a double.
#[test]
fn errors_stand_beside_the_values_and_hold() {
    let case = Case::new();
    case.file("points.csv", "x,y,z\n0.5,0,0\n134217729,0,0\n-1e300,0,0\n");
    for engine in ENGINES {
        let arguments =
            ["eval", "(x + 1)^2 - x^2 - 2x", "--points", "points.csv", "--error", "--engine", engine];
        let table = case.run(&arguments).exits(0).stdout();
        let mut lines = table.lines();
        assert_eq!(lines.next(), Some("value,value_error,value_digits_lost"));
        let rows: Vec<[f64; 3]> = lines
            .map(|line| std::array::from_fn(|field| line.split(',').nth(field).unwrap().parse().unwrap()))
            .collect();
        for [value, error, _] in &rows[..2] {
            assert!((value - 1.0).abs() <= *error, "{table}");
        }
        assert!(rows[0][2] < 1.5 && 15.0 < rows[1][2], "{table}");
        assert!(rows[2][0].is_nan() && rows[2][1] == f64::INFINITY, "{table}");
    }
}

#[test]
fn tables_can_be_json() {
    let case = Case::new();
    case.file("points.csv", "x,y,z\n1,0,0\n1e300,0,0\n0,0,0\n").file("none.csv", "x,y,z\n");
    case.file("boxes.csv", "x_lo,x_hi,y_lo,y_hi,z_lo,z_hi\n-1,1,0,0,0,0\n");
    let json = |flags: &[&str]| case.run(&[&["eval", "1/x^2", "--json"], flags].concat()).exits(0).json();
    let points = json(&["--points", "points.csv", "--error"]);
    assert_eq!(points[0]["value"], 1);
    assert!((0.0..1e-15).contains(&points[0]["value_error"].as_f64().unwrap()));
    assert_eq!(points[2]["value"], "inf");
    assert_eq!(points.as_array().unwrap().len(), 3);
    assert_eq!(json(&["--points", "none.csv"]), serde_json::json!([]));
    assert_eq!(json(&["--boxes", "boxes.csv"])[0]["decoration"], "trv");
}

#[test]
fn errors_have_derivatives_too_but_no_boxes() {
    let case = Case::new();
    case.file("points.csv", "x,y,z\n3,0,0\n").file("boxes.csv", "x_lo,x_hi,y_lo,y_hi,z_lo,z_hi\n");
    let run = case.run(&["eval", "x", "--points", "points.csv", "--gradient", "--error"]).exits(0);
    assert!(run.stdout().ends_with("\n3,0,0.0,1,0,0.0,0,0,0.0,0,0,0.0\n"), "{}", run.stdout());
    case.run(&["eval", "x", "--boxes", "boxes.csv", "--error"]).exits(2).mentions("--error");
}

#[test]
fn enclosures_carry_decorations() {
    let case = Case::new();
    let header = "x_lo,x_hi,y_lo,y_hi,z_lo,z_hi\n";
    let boxes = "1,2,0,0,0,0\n-1,1,0,0,0,0\n-2,-1,0,0,0,0\n0,inf,0,0,0,0\n-inf,inf,0,0,0,0\n";
    case.file("boxes.csv", [header, boxes].concat());
    let expected = [
        (1.0, std::f64::consts::SQRT_2, "com"),
        (0.0, 1.0, "trv"),
        (f64::NAN, f64::NAN, "trv"),
        (0.0, f64::INFINITY, "dac"),
        (0.0, f64::INFINITY, "trv"),
    ];
    for engine in ENGINES {
        let run = case.run(&["eval", "sqrt(x)", "--boxes", "boxes.csv", "--engine", engine]).exits(0);
        let table = run.stdout();
        let mut lines = table.lines();
        assert_eq!(lines.next(), Some("lo,hi,decoration"));
        for (line, (lo, hi, decoration)) in lines.by_ref().zip(expected) {
            let fields: Vec<&str> = line.split(',').collect();
            assert_eq!(fields[2], decoration, "{line}");
            if lo.is_nan() {
                assert_eq!(fields[..2], ["empty", "empty"]);
                continue;
            }
            // A root is enclosed to one unit in the last place at each end, and the nearest double to √2 lies below it.
            let [found_lo, found_hi]: [f64; 2] = [fields[0].parse().unwrap(), fields[1].parse().unwrap()];
            assert!(lo.next_down() <= found_lo && found_lo <= lo, "{line}");
            assert!(hi <= found_hi && found_hi <= hi.next_up().next_up(), "{line}");
        }
        assert_eq!(lines.next(), None);
    }
}

#[test]
fn enclosures_of_derivatives_hold_them() {
    let case = Case::new();
    case.file("boxes.csv", "x_lo,x_hi,y_lo,y_hi,z_lo,z_hi\n1,2,3,4,-1,1\n");
    let arguments = ["eval", "x^2 + x y", "--boxes", "boxes.csv", "--gradient", "-o", "out.csv"];
    case.run(&arguments).exits(0).prints("");
    let table = String::from_utf8(case.content("out.csv")).unwrap();
    let (header, row) = table.split_once('\n').unwrap();
    assert_eq!(
        header,
        "lo,hi,decoration,dx_lo,dx_hi,dx_decoration,dy_lo,dy_hi,dy_decoration,dz_lo,dz_hi,dz_decoration"
    );
    let fields: Vec<&str> = row.trim_end().split(',').collect();
    let holds = |place: usize, least: f64, greatest: f64| {
        let ends: [f64; 2] = [fields[place].parse().unwrap(), fields[place + 1].parse().unwrap()];
        assert!(ends[0] <= least && greatest <= ends[1], "{ends:?} should hold [{least}, {greatest}]");
    };
    holds(0, 4.0, 12.0);
    holds(3, 5.0, 8.0);
    holds(6, 1.0, 2.0);
    holds(9, 0.0, 0.0);
}

#[test]
fn wrong_tables_say_where_and_exit_with_1() {
    let case = Case::new();
    case.file("no_z.csv", "x,y\n1,2\n");
    case.file("word.csv", "x,y,z\n1,2,3\n1,two,3\n");
    case.file("short.csv", "x,y,z\n1,2\n");
    case.file("empty.csv", "# nothing\n");
    case.file("bytes.csv", b"x,y,z\n\xff\xfe,0,0\n");
    case.file("crossed.csv", "x_lo,x_hi,y_lo,y_hi,z_lo,z_hi\n0,1,2,1,0,1\n");
    for (flag, name, report) in [
        ("--points", "no_z.csv", "error: no_z.csv:1: there is no column `z`; the columns are x,y\n"),
        ("--points", "word.csv", "error: word.csv:3: column `y`: expected a number, found `two`\n"),
        (
            "--points",
            "short.csv",
            "error: short.csv:2: column `z` is missing, for the row has only 2 of 3 columns\n",
        ),
        (
            "--points",
            "empty.csv",
            "error: empty.csv:1: expected a first line that names the columns x,y,z, but the file is empty\n",
        ),
        ("--points", "bytes.csv", "error: bytes.csv:2: column `x`: expected a number, found `��`\n"),
        ("--boxes", "crossed.csv", "error: crossed.csv:2: no number lies between y_lo = 2 and y_hi = 1\n"),
    ] {
        let run = case.run(&["eval", "x", flag, name, "-o", "out.csv"]);
        run.exits(2).prints("").reports(report);
    }
    case.run(&["eval", "x", "--points", "missing.csv"]).exits(2).mentions("missing.csv:1: cannot be read");
    assert!(!case.names().contains(&"out.csv".to_owned()));
}

#[test]
fn tables_come_from_standard_input() {
    let case = Case::new();
    let run = case.run_with_input(&["eval", "x y z", "--points", "-"], b"x,y,z\n2,3,4\n");
    run.exits(0).prints("value\n24\n");
}
