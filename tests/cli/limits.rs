//! Work that ends before it is done: time limits and Ctrl-C.

use std::time::Duration;

use crate::harness::{Case, Run};

/// A picture that takes minutes, of tiles that take a moment each.
const LONG: [&str; 8] =
    ["render", "sin(9x)*sin(9y)*sin(9z) = 0.1", "--box", "-9,9", "--size", "3000", "-o", "out.ppm"];

/// Tries longer and longer times until a run ends after its first tile: how long that takes is the machine's to say.
fn until_something_is_finished(attempt: impl FnMut(Duration) -> Run) -> Run {
    let times = (0..8).map(|doublings| Duration::from_millis(400 << doublings));
    let mut runs = times.map(attempt);
    runs.find(|run| run.code().is_some() && !run.stderr().contains("before anything was finished"))
        .expect("a tile is finished within a minute")
}

/// How many pixels of `out.ppm` are black, the mark of unfinished ones.
fn black_pixels(case: &Case) -> u64 {
    let picture = image::open(case.path("out.ppm")).expect("the picture is whole").into_rgb8();
    assert_eq!(picture.dimensions(), (3000, 3000));
    picture.pixels().filter(|pixel| pixel.0 == [0; 3]).count() as u64
}

#[test]
fn a_time_limit_leaves_the_finished_tiles() {
    let case = Case::new();
    let run = until_something_is_finished(|time| {
        let limit = format!("{}ms", time.as_millis());
        case.run(&[&LONG[..], &["--time-limit", &limit, "--json"]].concat())
    });
    let run = run.exits(3).mentions("error: stopped by the time limit of ");
    let unfinished = run.json()["pixels"]["unfinished"].as_u64().unwrap();
    assert!(0 < unfinished && unfinished < 9_000_000, "{unfinished}");
    assert_eq!(black_pixels(&case), unfinished);
    let run = run.mentions(&format!(": {unfinished} of 9000000 pixels are unfinished"));
    drop(run.mentions("marked"));
    assert_eq!(case.names(), ["out.ppm"]);
}

#[test]
fn a_time_limit_that_is_not_reached_changes_nothing() {
    let case = Case::new();
    let sphere = ["render", "x^2 + y^2 + z^2 = 1", "--size", "80"];
    case.run(&[&sphere[..], &["-q", "-o", "free.ppm"]].concat()).exits(0);
    let limited =
        [&sphere[..], &["--json", "-o", "limited.ppm", "--time-limit", "1h", "--keep-partial"]].concat();
    assert_eq!(case.run(&limited).exits(0).json()["pixels"]["unfinished"], 0);
    assert_eq!(case.content("free.ppm"), case.content("limited.ppm"));
}

#[test]
fn a_time_limit_ends_preparations() {
    let case = Case::new();
    case.file("rays.csv", "ox,oy,oz,dx,dy,dz\n0,0,0,1,0,0\n");
    for method in ["grid", "octree"] {
        let flags = ["--method", method, "--grid", "600", "--box", "-9,9", "--time-limit", "1ms"];
        let formula = "sin(90x)*sin(90y)*sin(90z)";
        let report =
            "error: stopped by the time limit of 1ms before anything was finished; nothing is written\n";
        case.run(&[&["render", formula][..], &flags].concat()).exits(3).prints("").reports(report);
        let rays = ["trace", formula, "--rays", "rays.csv"];
        case.run(&[&rays[..], &flags].concat()).exits(3).prints("").reports(report);
    }
    assert_eq!(case.names(), ["rays.csv"]);
}

/// Whatever preparations do, here wait for rays that never come: the limit does not wait for them.
#[test]
fn a_time_limit_does_not_wait_for_preparations() {
    let case = Case::new();
    let arguments = ["trace", "x", "--rays", "-", "-o", "out.csv", "--time-limit", "100ms"];
    let report =
        "error: stopped by the time limit of 100ms before anything was finished; nothing is written\n";
    case.run_with_endless_input(&arguments).exits(3).prints("").reports(report);
    assert!(case.names().is_empty());
}

#[test]
fn rays_that_are_not_finished_say_so() {
    let case = Case::new();
    let rays: String =
        (0..300_000).map(|ray| format!("-9,{}e-5,0.1,1,0.01,0.013\n", ray - 150_000)).collect();
    case.file("rays.csv", format!("ox,oy,oz,dx,dy,dz\n{rays}"));
    let run = until_something_is_finished(|time| {
        let limit = format!("{}ms", time.as_millis());
        let formula = "sin(9x)*sin(9y)*sin(9z) = 1.0001";
        let slowly = ["--method", "direct", "--step", "0.005", "--threads", "1", "--time-limit", &limit];
        case.run(&[&["trace", formula, "--box", "-9,9", "--rays", "rays.csv"][..], &slowly].concat())
    });
    let run = run.exits(3).mentions(" of 300000 rays are unfinished");
    let unfinished =
        run.stdout().lines().filter(|line| *line == "unfinished,nan,nan,nan,nan,nan,nan,nan,nan,nan").count();
    assert!(0 < unfinished && unfinished < 300_000, "{unfinished}");
    assert_eq!(run.stdout().lines().count(), 300_001);
    drop(run.mentions(&format!(": {unfinished} of ")));
}

#[test]
fn times_that_are_none_are_refused() {
    for (time, report) in
        [("5d", "found the unit `d`"), ("0", "above zero"), ("soon", "found the unit `soon`")]
    {
        Case::new().run(&["render", "x", "--time-limit", time]).exits(2).mentions(report);
    }
}

#[cfg(unix)]
fn interrupted(case: &Case, (signal, time): (&str, Duration), more: &[&str]) -> Run {
    let started = case.start(&[&LONG[..], more].concat());
    std::thread::sleep(time);
    started.send(signal);
    started.end()
}

#[cfg(unix)]
#[test]
fn signals_leave_no_file() {
    let case = Case::new();
    case.file("out.ppm", "the old one");
    // That of Ctrl-C, a request to end, and that of a terminal that is closed.
    for signal in ["INT", "TERM", "HUP"] {
        // One that comes before the program listens ends it without an exit code.
        let times = (0..8).map(|doublings| Duration::from_millis(400 << doublings));
        let run = times.map(|time| interrupted(&case, (signal, time), &[])).find(|run| run.code().is_some());
        run.expect("iso listens within a minute").exits(130).prints("");
        assert_eq!(case.names(), ["out.ppm"]);
        assert_eq!(case.content("out.ppm"), b"the old one");
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_the_finished_tiles_when_asked_to() {
    let case = Case::new();
    let run =
        until_something_is_finished(|time| interrupted(&case, ("INT", time), &["--keep-partial", "--json"]));
    let run = run.exits(130).mentions("error: stopped by Ctrl-C: ");
    let unfinished = run.json()["pixels"]["unfinished"].as_u64().unwrap();
    assert!(0 < unfinished && unfinished < 9_000_000, "{unfinished}");
    assert_eq!(black_pixels(&case), unfinished);
    assert_eq!(case.names(), ["out.ppm"]);
}
