//! `iso trace`: rays, from a table or not.

use crate::harness::Case;

const RAYS: &str = "\
# towards a unit sphere, past it, away from it, from inside, and with a direction of length 2
name,ox,oy,oz,dx,dy,dz
towards,-3,0,0,1,0,0
past,-3,1.5,0,1,0,0
away,-3,0,0,-1,0,0
inside,0,0,0,0,0,1
fast,0,-3,0,0,2,0
";

/// Rows of the result: the status and the nine numbers.
fn rows(table: &str) -> Vec<(String, [f64; 9])> {
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("status,t,t_lo,t_hi,x,y,z,nx,ny,nz"));
    lines
        .map(|line| {
            let (status, numbers) = line.split_once(',').unwrap();
            let numbers: Vec<f64> = numbers.split(',').map(|number| number.parse().unwrap()).collect();
            (status.to_owned(), numbers.try_into().unwrap())
        })
        .collect()
}

#[test]
fn rays_end_where_the_sphere_is() {
    let case = Case::new();
    case.file("rays.csv", RAYS);
    for method in ["certified", "grid", "octree", "direct"] {
        for engine in ["jit", "interp"] {
            let flags = ["--rays", "rays.csv", "--method", method, "--engine", engine, "-o", "hits.csv"];
            let mut arguments = vec!["trace", "x^2 + y^2 + z^2 = 1"];
            arguments.extend(flags);
            case.run(&arguments).exits(0).prints("").reports("");
            let table = String::from_utf8(case.content("hits.csv")).unwrap();
            let rows = rows(&table);
            let statuses: Vec<&str> = rows.iter().map(|(status, _)| status.as_str()).collect();
            assert_eq!(statuses, ["hit", "miss", "miss", "hit", "hit"], "{method} {engine}");
            let expected =
                [(0, 2.0, [-1.0, 0.0, 0.0]), (3, 1.0, [0.0, 0.0, 1.0]), (4, 1.0, [0.0, -1.0, 0.0])];
            for (row, t, point) in expected {
                let found = rows[row].1;
                assert!((found[0] - t).abs() < 1e-9, "{method} {engine}: {found:?}");
                assert!(found[1] <= found[0] && found[0] <= found[2], "{method} {engine}: {found:?}");
                for axis in 0..3 {
                    assert!((found[3 + axis] - point[axis]).abs() < 1e-9, "{method} {engine}: {found:?}");
                    assert!((found[6 + axis] - point[axis]).abs() < 1e-9, "{method} {engine}: {found:?}");
                }
            }
            assert!(rows[1].1.iter().all(|number| number.is_nan()), "{table}");
        }
    }
}

#[test]
fn rays_can_be_given_without_a_table() {
    let case = Case::new();
    let run = |flags: &[&str]| case.run(&[&["trace", "x^2 + y^2 + z^2 = 1"], flags].concat());
    let found = run(&["--ray", "-3,0,0,2,0,0", "--ray=-3,2,0,1,0,0", "--json"]).exits(0).json();
    assert_eq!(found[0]["status"], "hit");
    assert_eq!([&found[0]["t"], &found[0]["x"], &found[0]["nx"]], [1.0, -1.0, -1.0]);
    assert_eq!([&found[1]["status"], &found[1]["t"]], ["miss", "nan"]);
    assert_eq!(found.as_array().unwrap().len(), 2);
    run(&["--ray", "0,0,0,0,0,0"]).exits(2).mentions("the direction is zero");
    run(&["--ray", "0,0,0"]).exits(2).mentions("expected 6 numbers");
    run(&[]).exits(2).mentions("--ray <OX,OY,OZ,DX,DY,DZ>|--rays <FILE.csv>");
}

#[test]
fn the_result_is_the_same_on_any_number_of_threads() {
    let case = Case::new();
    let rays: String =
        (0..3000).map(|ray| format!("-3,{},0.1,1,0.01,0\n", f64::from(ray) / 1000.0 - 1.5)).collect();
    case.file("rays.csv", format!("ox,oy,oz,dx,dy,dz\n{rays}"));
    let run = |threads| {
        let arguments = ["trace", "x^4 + y^4 + z^4 = 1", "--rays", "rays.csv", "--threads", threads];
        case.run(&arguments).exits(0).stdout()
    };
    let alone = run("1");
    assert_eq!(alone.lines().count(), 3001);
    assert_eq!(alone, run("2"));
}

#[test]
fn the_region_bounds_the_search() {
    let case = Case::new();
    case.file("rays.csv", "ox,oy,oz,dx,dy,dz\n-3,0,0,1,0,0\n");
    let run = |region| {
        let arguments = ["trace", "x", "--level", "1.5", "--rays", "rays.csv", "--box", region];
        rows(&case.run(&arguments).exits(0).stdout())[0].0.clone()
    };
    assert_eq!(run("-2,2"), "hit");
    assert_eq!(run("-1,1"), "miss");
    assert_eq!(run("1,-1,-1,2,1,1"), "hit");
}

#[test]
fn a_ray_that_misses_the_box_is_not_said_to_miss_the_surface() {
    let case = Case::new();
    let run = |flags: &[&str]| case.run(&[&["trace", "z = 0", "--ray", "2.5,0,5,0,0,-1"], flags].concat());
    run(&[])
        .exits(0)
        .mentions("note: the surface goes on outside of the box in which rays are followed, x -2..2");
    run(&["--box", "-2,2"]).exits(0).reports("");
    let through = case.run(&["trace", "z = 0", "--ray", "1,0,5,0,0,-1"]).exits(0).reports("");
    assert_eq!(rows(&through.stdout())[0].0, "hit");
}

#[test]
fn rays_that_are_none_are_refused() {
    let case = Case::new();
    case.file("still.csv", "ox,oy,oz,dx,dy,dz\n0,0,0,1,0,0\n0,0,0,0,0,0\n");
    case.file("endless.csv", "ox,oy,oz,dx,dy,dz\n0,0,0,inf,0,0\n");
    case.file("partial.csv", "ox,oy,oz,dx,dy\n0,0,0,1,0\n");
    for (name, report) in [
        ("still.csv", "error: still.csv:3: the direction (dx, dy, dz) is zero\n"),
        ("endless.csv", "error: endless.csv:2: a ray needs six finite numbers\n"),
        ("partial.csv", "error: partial.csv:1: there is no column `dz`; the columns are ox,oy,oz,dx,dy\n"),
    ] {
        case.run(&["trace", "x", "--rays", name]).exits(2).prints("").reports(report);
    }
}
