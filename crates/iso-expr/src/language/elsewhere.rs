//! Functions of other programs, of shaders and of textbooks, and how the same is written here.

/// A call as it is known elsewhere, and what to write. `sqr` and the shapes whose names begin with `f_` are POV-Ray's (`functions.inc`),
/// `length` is GLSL's.
const CALLS: [(&str, &str); 29] = [
    ("sqr(u)", "u^2"),
    ("cube(u)", "u^3"),
    ("square(u)", "u^2"),
    ("tg(u)", "tan(u)"),
    ("cot(u)", "1/tan(u)"),
    ("ctg(u)", "1/tan(u)"),
    ("arctg(u)", "atan(u)"),
    ("sec(u)", "1/cos(u)"),
    ("csc(u)", "1/sin(u)"),
    ("coth(u)", "1/tanh(u)"),
    ("sech(u)", "1/cosh(u)"),
    ("csch(u)", "1/sinh(u)"),
    ("sinc(u)", "sin(u)/u"),
    ("lg(u)", "log10(u)"),
    ("ld(u)", "log2(u)"),
    ("int(u)", "trunc(u)"),
    ("frac(u)", "fract(u)"),
    ("fmod(u, v)", "u - v*trunc(u/v)"),
    ("length(u, v, w)", "sqrt(u^2 + v^2 + w^2)"),
    ("norm(u, v, w)", "sqrt(u^2 + v^2 + w^2)"),
    ("sum(u, v)", "u + v"),
    ("where(x > 0, u, v)", "if(x > 0, u, v)"),
    ("iif(x > 0, u, v)", "if(x > 0, u, v)"),
    ("lerp(u, v, w)", "mix(u, v, w)"),
    ("union(u, v)", "min(u, v)"),
    ("intersection(u, v)", "max(u, v)"),
    ("difference(u, v)", "max(u, -v)"),
    ("f_sphere(x, y, z, r)", "sqrt(x^2 + y^2 + z^2) - r"),
    ("f_torus(x, y, z, a, b)", "hypot(hypot(x, z) - a, y) - b"),
];

/// Functions that other programs have and no formula here gives.
const SPECIAL: [&str; 15] = [
    "erf",
    "erfc",
    "gamma",
    "tgamma",
    "lgamma",
    "beta",
    "zeta",
    "j0",
    "besselj",
    "bessel",
    "factorial",
    "noise",
    "sn",
    "cn",
    "dn",
];

/// What surrounds formulas elsewhere.
const FRAMES: [&str; 7] =
    ["contourplot3d", "implicitplot3d", "implicit_plot3d", "isosurface", "function", "plot", "surface"];

/// What to do without infinity.
pub(super) const FINITE: &str = "numbers are finite: write one that is large enough, such as `1e9`";

/// Names of what is no number here.
const NO_NUMBERS: [&str; 5] = ["inf", "infinity", "infty", "oo", "nan"];

/// Libraries of functions, whose names precede those of the functions.
const LIBRARIES: [&str; 4] = ["math", "np", "numpy", "std"];

/// How to write what a function of this name gives elsewhere.
pub(super) fn written_here(name: &str) -> Option<String> {
    if SPECIAL.contains(&name) {
        return Some(format!("there is no `{name}` here: formulas are made of elementary functions"));
    }
    let named = |(call, _): &&(&str, &str)| call.split('(').next() == Some(name);
    CALLS.iter().find(named).map(|(call, here)| format!("`{call}` is written `{here}`"))
}

/// What to do about a name that stands elsewhere for something which is not here.
pub(super) fn not_here(name: &str) -> Option<String> {
    let name = name.to_lowercase();
    if NO_NUMBERS.contains(&&*name) {
        return Some(FINITE.to_owned());
    }
    if FRAMES.contains(&&*name) {
        return Some("write the formula alone, as in `x^2 + y^2 + z^2 = 1`".to_owned());
    }
    LIBRARIES.contains(&&*name).then(|| format!("functions have no library before them: leave out `{name}.`"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Ast;

    #[test]
    fn what_is_advised_is_understood_and_what_is_known_is_not_advised() {
        for (call, here) in CALLS {
            let define = "u := 0.5; v := 0.4; w := 0.3; r := 1; a := 1; b := 2; c := 3; ";
            Ast::parse(&format!("{define}{here} + x")).unwrap_or_else(|error| panic!("{here}: {error}"));
            let help = Ast::parse(&format!("{define}{call} + x")).unwrap_err().help.unwrap();
            assert!(help.contains(here), "{call}: {help}");
        }
        for (formula, expected) in [
            ("erf(x) = y", "there is no `erf` here"),
            ("x = Infinity", "numbers are finite"),
            ("math.sin(x) = y", "leave out `math.`"),
            ("function { x*x + y*y - 1 }", "write the formula alone"),
            ("ContourPlot3D[x == y, {x, -1, 1}]", "write the formula alone"),
            ("x + 1_000", "without a break"),
            ("z(x, y) = x^2", "is written `z = …`"),
            ("arctan(y, x) = z", "atan2(y, x)"),
        ] {
            let help = Ast::parse(formula).unwrap_err().help.unwrap();
            assert!(help.contains(expected), "{formula}: {help}");
        }
    }
}
