//! Regions of surfaces of which it is known where they are.

use super::*;
use crate::testing::surface_of;

/// What is found around the surface of a formula.
pub(super) fn around(formula: &str) -> Fitted {
    Fitted::around(&surface_of(formula), &mut Workspace::default()).unwrap()
}

fn fitted(formula: &str) -> Region {
    around(formula).region
}

/// The region holds the box from `min` to `max`, and is no more than a tenth of its longest side larger.
fn assert_close(formula: &str, min: DVec3, max: DVec3) {
    let region = fitted(formula);
    let slack = 0.1 * (max - min).max_element();
    assert!(
        (min - region.min()).min_element() >= 0.0 && (region.max() - max).min_element() >= 0.0,
        "{region:?}"
    );
    assert!((min - region.min()).max_element() <= slack, "{formula}: {region:?}");
    assert!((region.max() - max).max_element() <= slack, "{formula}: {region:?}");
}

#[test]
fn bounded_surfaces_of_any_size_are_framed() {
    for radius in [1e-3, 0.1, 1.0, 1.999, 2.0, 3.0, 100.0, 500.0] {
        let formula = format!("x^2 + y^2 + z^2 = {}", radius * radius);
        assert_close(&formula, DVec3::splat(-radius), DVec3::splat(radius));
    }
    let ellipsoid = "(x - 5)^2 + (y/2)^2 + (z + 1)^2 = 1";
    assert_close(ellipsoid, DVec3::new(4.0, -2.0, -2.0), DVec3::new(6.0, 2.0, 0.0));
}

#[test]
fn parts_apart_from_each_other_are_framed_together() {
    let two = "min(x^2 + y^2 + z^2 - 1, (x - 10)^2 + y^2 + z^2 - 1)";
    assert_close(two, DVec3::splat(-1.0), DVec3::new(11.0, 1.0, 1.0));
    let small = "(x^2 + y^2 + z^2 - 1)*((x - 3)^2 + y^2 + z^2 - 0.25)";
    assert_close(small, DVec3::splat(-1.0), DVec3::new(3.5, 1.0, 1.0));
    assert!(!around(two).goes_on && !around(small).goes_on);
}

/// Cells at the faces of a cube are open, for intervals are wide there, and the surface does not reach them.
#[test]
fn wide_intervals_at_the_faces_of_a_cube_do_not_cut_a_surface_off() {
    // Half its diameters are √20 and 1/√2.9 along x ± y, so that x and y reach √(20/2 + 1/5.8).
    let side = (10.0_f64 + 1.0 / 5.8).sqrt();
    // The chair of the books, whose feet are more than 6 from its middle along each axis.
    let chair = "(x^2 + y^2 + z^2 - 23.75)^2 = 0.8((z - 5)^2 - 2x^2)((z + 5)^2 - 2y^2)";
    for (formula, reached) in [("x^2 + y^2 + z^2 - 1.9x*y = 1", side), (chair, 6.0)] {
        let Fitted { region, goes_on, .. } = around(formula);
        let [from, to] = [region.min(), region.max()].map(|corner| corner.x.abs());
        assert!(
            !goes_on && !around(formula).is_cut_off && from >= reached && to >= reached && from + to <= 16.0,
            "{region:?}"
        );
    }
}

/// Both fill a small part of any cell in which they are found first.
#[test]
fn small_parts_far_away_are_framed_as_well() {
    for x in [30.0, 300.0] {
        let two = format!("min(x^2 + y^2 + z^2, (x - {x})^2 + y^2 + z^2) = 1");
        let region = fitted(&two);
        assert!(region.min().x <= -1.0 && region.max().x >= x + 1.0, "{region:?}");
    }
}

#[test]
fn a_surface_that_goes_on_elsewhere_is_said_to() {
    let oval = around("y^2 + z^2 = x*(x - 1)*(x - 5)");
    assert!(oval.goes_on && oval.region.max().x < 1.2, "{oval:?}");
    let through_corners = ["z", "x = 1", "x = y", "x - y = 1", "max(x, y)"];
    let others = ["sin(x) = cos(y) + sin(z)", "x^2 + y^2 = 9", "z = x*y", "x = 10"];
    for formula in others.into_iter().chain(through_corners) {
        assert!(around(formula).goes_on, "{formula}");
    }
    for formula in [
        "x^2 + y^2 + z^2 = 1",
        "x^2 + y^2 + z^2 = 4",
        "max(abs(x), abs(y), abs(z)) = 2",
        "x^4 + y^4 + z^4 = 3*x^2 + 7",
        "x^2 + y^2 + z^2 = -1",
    ] {
        let Fitted { goes_on, is_cut_off, .. } = around(formula);
        assert!(!goes_on && !is_cut_off, "{formula}");
    }
}

/// A sign that changes at a pole or at a jump proves nothing.
#[test]
fn a_surface_that_may_go_on_is_cut_off() {
    for formula in ["z = tan(x*y)", "z = floor(x) + floor(y)", "z = mod(x, 1)"] {
        let found = around(formula);
        assert!(found.is_cut_off && !found.goes_on, "{formula}");
        let other = around("x^2 + y^2 + z^2 = 100");
        assert!(found.hull(&found).unwrap().is_cut_off && !found.hull(&other).unwrap().is_cut_off);
    }
}

#[test]
fn corners_of_the_cube_before_are_no_points_outside_of_it() {
    let mut workspace = Workspace::default();
    let mut holds_points = |formula| {
        let surface = surface_of(formula);
        let kernel = &**surface.over_boxes(Kernel::ValueEnclosures).unwrap();
        // From (2, 0, 0) to (3, 1, 1), beside the cube of half side 2.
        cube(8.0).holds_points(&[IVec3::new(10, 8, 8)], 16, kernel, &mut workspace)
    };
    assert!(holds_points("x = 3") && holds_points("x = 2.5"));
    assert!(!holds_points("x = 2") && !holds_points("x^2 + y^2 + z^2 = 4"));
}

/// Intervals are wide here, so that all cells stay open, far from the sphere too; and a pole is no surface.
#[test]
fn what_is_not_proven_is_not_said_to_go_on() {
    let sphere = "x^2 + y^2 + z^2 - 1 + 20((x - y)^2 - x^2 + 2x*y - y^2)";
    for formula in [sphere, "1/(x - 20)"] {
        assert!(!around(formula).goes_on, "{formula}");
    }
}

/// Intervals are wide, and from a larger cube on the region would be: 1.125 instead of 35 of 32 parts.
#[test]
fn a_larger_cube_is_taken_only_if_it_holds_more() {
    let region = fitted("x^2 + y^2 + z^2 - 1 + ((x - y)^2 - x^2 + 2x*y - y^2)/4");
    assert_eq!((region.min(), region.max()), (DVec3::splat(-1.09375), DVec3::splat(1.09375)));
}

#[test]
fn what_is_far_away_is_looked_for_there() {
    assert_close(
        "(x - 3000)^2 + y^2 + z^2 = 1",
        DVec3::new(2999.0, -1.0, -1.0),
        DVec3::new(3001.0, 1.0, 1.0),
    );
    assert_close("x^2 + y^2 + z^2 = 1e12", DVec3::splat(-1e6), DVec3::splat(1e6));
}

#[test]
fn what_is_met_first_in_the_largest_of_the_near_cubes_is_no_scrap() {
    assert_close("x^2 + y^2 + z^2 = 490000", DVec3::splat(-700.0), DVec3::splat(700.0));
    for formula in ["x = 300", "x = 1000", "x^2 + y^2 = 90000"] {
        assert!(around(formula).goes_on, "{formula}");
    }
}

#[test]
fn of_two_regions_neither_may_hide_what_goes_on_outside_of_the_other() {
    let [near, far] = ["x^2 + y^2 = 1", "x^2 + y^2 + z^2 = 100"].map(around);
    assert!(near.goes_on && near.hull(&near).unwrap().goes_on);
    assert!(!near.hull(&far).unwrap().goes_on && !far.hull(&near).unwrap().goes_on);
}

#[test]
fn regions_without_a_hull_have_none() {
    let at = |from: f64, to: f64| Fitted::from(Region::new(DVec3::splat(from), DVec3::splat(to)).unwrap());
    assert!(at(-1e308, -9e307).hull(&at(9e307, 1e308)).is_err());
}

/// Nearer cubes show corners of the hyperboloid, and its waist is farther out.
#[test]
fn scraps_are_not_taken_for_the_surface() {
    let region = fitted("x^2 + y^2 - z^2 = 100");
    assert!(region.max().x >= 30.0, "{region:?}");
}

#[test]
fn flat_surfaces_keep_some_space_around_them() {
    let region = fitted("x^2 + y^2 + 1e6 z^2 = 1");
    assert!(region.extent().z >= 0.25 * region.extent().x - 1e-9 && region.extent().x < 2.3, "{region:?}");
}

#[test]
fn unbounded_surfaces_are_cut_off_where_they_go_on() {
    assert_eq!(fitted("x y = z"), Region::standard());
    let cylinder = fitted("x^2 + y^2 = 9");
    assert!(cylinder.extent().z == 16.0 && cylinder.extent().x <= 7.0, "{cylinder:?}");
}

/// Two of each axis's waves, as far as these can be seen at all; nothing changes for what is not that slow.
#[test]
fn surfaces_with_waves_are_shown_with_some_of_them() {
    use std::f64::consts::PI;
    for (formula, half_side) in [
        ("sin(x) = cos(y) + sin(z)", 2.0 * PI),
        ("sin(x/4) = cos(y/4) + sin(z/3)", 8.0 * PI),
        ("sin(7x) = cos(8y) + sin(9z)", 2.0),
        ("sin(x/1000) = y + z", 2.0),
    ] {
        let region = fitted(formula);
        assert!((region.max() - half_side).abs().max_element() < 1e-9, "{formula}: {region:?}");
    }
}

/// Faces at the end of whole waves, of steps and of planes. What only passes through faces moves none.
#[test]
fn no_face_lies_on_the_surface() {
    use std::f64::consts::PI;
    for (formula, half_sides) in [
        ("sin(x)*sin(y)*sin(z)", [2.0 * PI; 3].map(|half| (1.0 + 1.0 / 32.0) * half)),
        ("sin(pi x)*y", [2.0625, 2.0, 2.0]),
        ("sin(2pi x)*sin(2pi y)*z", [2.0625, 2.0625, 2.0]),
        ("x*y*(x - 2)*(x + 2)", [2.0625, 2.0, 2.0]),
        ("mod(x, 1)*y", [2.0625, 2.0, 2.0]),
        ("x*y = z", [2.0; 3]),
        ("z = tan(x*y)", [2.0; 3]),
        ("sin(x) = cos(y) + sin(z)", [2.0 * PI; 3]),
    ] {
        let (region, half) = (fitted(formula), DVec3::from_array(half_sides));
        let off = (region.min() + half).abs().max((region.max() - half).abs());
        assert!(off.max_element() < 1e-9, "{formula}: {region:?}");
    }
}

#[test]
fn a_single_point_keeps_a_region_around_it() {
    let region = fitted("(x - 1)^2 + y^2 + z^2 = 0");
    assert!(region.extent().min_element() > 1e-12 && region.extent().max_element() < 1e-6, "{region:?}");
}

#[test]
fn nothing_to_see_gives_the_standard_region() {
    for formula in ["x^2 + y^2 + z^2 = -1", "sqrt(-1 - x^2)", "1"] {
        assert_eq!(fitted(formula), Region::standard(), "{formula}");
    }
}
