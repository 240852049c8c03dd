//! `iso render --turntable` and `--sweep`: sequences of pictures.

use std::fs::File;
use std::io::BufReader;

use image::AnimationDecoder;
use image::codecs::gif::GifDecoder;
use serde_json::Value;

use crate::harness::Case;

const PAPER: &str = "(x^2+y^2-1)^2 + 4z^2 + 0.5x = 0.2";

fn sequence(case: &Case, formula: &str, more: &[&str]) -> Value {
    case.run(&[&["render", formula, "--size", "48x32", "--json"][..], more].concat()).exits(0).json()
}

fn each(json: &Value, pointer: &str) -> Vec<u64> {
    let frames = json["frames"].as_array().unwrap();
    frames.iter().map(|frame| frame.pointer(pointer).unwrap().as_u64().unwrap()).collect()
}

/// Each picture is the one that its camera sees, bit for bit, but what does not depend on the camera is done once.
#[test]
fn a_walk_around_the_surface_prepares_it_once() {
    for (method, kernels) in [("certified", 5), ("grid", 3), ("octree", 3), ("direct", 3)] {
        let case = Case::new();
        let flags = ["--method", method, "--depth", "depth.exr"];
        let walk = ["--turntable", "--frames", "3", "--yaw", "-30", "-o", "walk.ppm"];
        let json = sequence(&case, PAPER, &[&flags[..], &walk].concat());
        assert_eq!(each(&json, "/plan/kernels_compiled"), [kernels, 0, 0], "{method}");
        let prepared = each(&json, "/counters/preprocess_evaluations");
        assert_eq!((prepared[0] > 0, &prepared[1..]), (matches!(method, "grid" | "octree"), &[0, 0][..]));
        for (number, yaw) in ["-30", "90", "210"].into_iter().enumerate() {
            assert_eq!(json["frames"][number]["frame"]["yaw"], yaw.parse::<f64>().unwrap());
            let still = ["render", PAPER, "--size", "48x32", "-q", "--yaw", yaw, "-o", "still.ppm"];
            case.run(&[&still[..], &["--method", method, "--depth", "still.exr"]].concat()).exits(0);
            assert_eq!(
                case.content(&format!("walk-{number}.ppm")),
                case.content("still.ppm"),
                "{method} {yaw}"
            );
            assert_eq!(case.content(&format!("depth-{number}.exr")), case.content("still.exr"));
        }
    }
}

/// The box holds the surface for every value, so that the camera stands still, and kernels are compiled where the formula
/// changes.
#[test]
fn a_parameter_runs_from_end_to_end() {
    let case = Case::new();
    let flags = ["--sweep", "a=1:4", "--frames", "3", "-o", "grow.ppm"];
    let json = sequence(&case, "a := 9; x^2 + y^2 + z^2 = a^2", &flags);
    assert_eq!(case.names(), ["grow-0.ppm", "grow-1.ppm", "grow-2.ppm"]);
    assert_eq!(each(&json, "/plan/kernels_compiled"), [5, 5, 5]);
    let values = [0, 1, 2].map(|number| json["frames"][number]["frame"]["settings"][0]["value"].as_f64());
    assert_eq!(values, [1.0, 2.5, 4.0].map(Some));
    let hits = each(&json, "/pixels/hit");
    assert!(hits[0] < hits[1] && hits[1] < hits[2], "{hits:?}");
    for frame in json["frames"].as_array().unwrap() {
        assert!(
            frame["box_max"][0].as_f64().unwrap() >= 4.0 && frame["box_max"] == json["frames"][0]["box_max"]
        );
    }
    let pixels: u64 =
        ["hit", "touch", "miss"].map(|status| json["pixels"][status].as_u64().unwrap()).iter().sum();
    assert_eq!(pixels, 3 * 48 * 32);
}

#[test]
fn what_several_pictures_do_not_show_is_said_once() {
    let case = Case::new();
    let sweep = ["--box", "-2,2", "--sweep", "a=-3:1", "--frames", "5", "--size", "16", "-o", "grow.ppm"];
    let report =
        case.run(&[&["render", "a := 1; x^2 + y^2 + z^2 = a"][..], &sweep].concat()).exits(0).stderr();
    // With a = 0 there is a point, which no ray meets.
    assert!(report.contains("note on 1 of them: nothing is seen: no ray meets the surface"), "{report}");
    assert_eq!(
        report.matches("note on 3 of them: nothing is seen: no point of the box").count(),
        1,
        "{report}"
    );
}

#[test]
fn a_parameter_that_changes_nothing_costs_nothing() {
    let formula = "a := 2; b := 3; x^2 + y^2 + z^2 = a";
    let json = sequence(&Case::new(), formula, &["--sweep", "b=0:1", "--frames", "2"]);
    assert_eq!(each(&json, "/plan/kernels_compiled"), [5, 0]);
    assert_eq!(each(&json, "/counters/box_evaluations")[0], each(&json, "/counters/box_evaluations")[1]);
}

#[test]
fn an_animation_is_one_file() {
    let case = Case::new();
    let json = sequence(&case, PAPER, &["--turntable", "--frames", "4"]);
    assert_eq!((case.names(), &json["files"]), (vec!["iso.gif".to_owned()], &vec!["iso.gif"].into()));
    let file = BufReader::new(File::open(case.path("iso.gif")).unwrap());
    let frames = GifDecoder::new(file).unwrap().into_frames().collect_frames().unwrap();
    assert_eq!(frames.len(), 4);
    assert!(frames.iter().all(|frame| frame.buffer().dimensions() == (48, 32)));
    assert!(frames[0].buffer() != frames[1].buffer(), "the camera moves");
}

#[test]
fn sequences_that_make_no_sense_are_refused() {
    let case = Case::new();
    let refused = |flags: &[&str], why: &str| {
        case.run(&[&["render", PAPER][..], flags].concat()).exits(2).mentions(why);
    };
    refused(&["--frames", "3"], "nothing changes from picture to picture");
    refused(&["--sweep", "a=0:1"], "the formula has no parameter `a`");
    refused(&["--sweep", "a=0"], "expected NAME=FROM:TO");
    refused(&["--turntable", "--frames", "1"], "expected a whole number from 2 to 1000");
    refused(&["--turntable", "--eye", "1,2,3"], "cannot be used with");
    assert!(case.names().is_empty());
}
