//! Functions of other programs, of shaders and of textbooks, and how the same is written here.

/// A call as it is known elsewhere, and what to write. `sqr` and the shapes whose names begin with `f_` are POV-Ray's (`functions.inc`),
/// `length` is GLSL's.
const CALLS: [(&str, &str); 21] = [
    ("sqr(u)", "u^2"),
    ("cube(u)", "u^3"),
    ("square(u)", "u^2"),
    ("cot(u)", "1/tan(u)"),
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
    ("union(u, v)", "min(u, v)"),
    ("intersection(u, v)", "max(u, v)"),
    ("difference(u, v)", "max(u, -v)"),
    ("f_sphere(x, y, z, r)", "sqrt(x^2 + y^2 + z^2) - r"),
    ("f_torus(x, y, z, a, b)", "hypot(hypot(x, z) - a, y) - b"),
];

/// How to write what a function of this name gives elsewhere.
pub(super) fn written_here(name: &str) -> Option<String> {
    let named = |(call, _): &&(&str, &str)| call.split('(').next() == Some(name);
    CALLS.iter().find(named).map(|(call, here)| format!("`{call}` is written `{here}`"))
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
    }
}
