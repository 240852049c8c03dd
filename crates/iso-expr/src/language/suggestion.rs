//! What an unknown name may have been meant to say.

use super::elsewhere::{not_here, written_here};
use super::scope::{Parameters, Scope};

/// Longer names are no slips of the hand, and comparing them would take long.
const LONGEST_NAME: usize = 32;

/// What to write in place of the unknown `name`, which a parenthesis follows if `is_called`.
pub(super) fn suggestion(
    name: &str,
    is_called: bool,
    scope: &Scope<'_>,
    parameters: &Parameters<'_>,
) -> Option<String> {
    if name.chars().count() > LONGEST_NAME {
        return None;
    }
    let mut values: Vec<&str> = parameters.keys().copied().collect();
    values.sort_unstable();
    values.extend(scope.values());
    let functions = scope.functions();
    let known: Vec<&str> = values.iter().chain(&functions).copied().collect();
    let as_case = || known.iter().find(|other| other.to_lowercase() == name.to_lowercase());
    let as_elsewhere = || match is_called {
        true => written_here(name),
        false => not_here(name).or_else(|| power(name, &values)),
    };
    let as_product = || product(name, &values).map(|product| call_of(product, is_called));
    let as_call = || functions_first(name, is_called, &values, &functions);
    as_case()
        .map(|other| format!("did you mean `{other}`?"))
        .or_else(as_elsewhere)
        .or_else(|| as_product().or_else(as_call).map(|text| format!("did you mean `{text}`?")))
        .or_else(|| nearest(name, known.iter().copied()).map(|other| format!("did you mean `{other}`?")))
}

/// `x2` as `x^2`, whose sign may be lost on the way from other texts.
fn power(name: &str, values: &[&str]) -> Option<String> {
    let of_value = |value: &&str| {
        let exponent = name.strip_prefix(*value)?;
        let is_number = !exponent.is_empty() && exponent.chars().all(|character| character.is_ascii_digit());
        is_number.then(|| format!("did you mean `{value}^{exponent}` or `{value}*{exponent}`?"))
    };
    values.iter().find_map(of_value)
}

/// `xy` as `x*y`, if it is made of known values and of digits.
fn product(name: &str, values: &[&str]) -> Option<String> {
    let digits =
        |rest: &str| rest.len() - rest.trim_start_matches(|character: char| character.is_ascii_digit()).len();
    // The factors that lead to each byte of the name, by the longest first factor.
    let mut factors: Vec<Option<Vec<&str>>> = vec![None; name.len() + 1];
    factors[0] = Some(Vec::new());
    for start in 0..name.len() {
        let Some(before) = factors[start].clone() else { continue };
        let rest = &name[start..];
        let lengths = values.iter().filter(|value| rest.starts_with(**value)).map(|value| value.len());
        for length in lengths.chain(Some(digits(rest)).filter(|length| *length > 0)) {
            let so_far = &mut factors[start + length];
            if so_far.as_ref().is_none_or(|factors| factors.len() > before.len() + 1) {
                *so_far = Some(before.iter().copied().chain([&rest[..length]]).collect());
            }
        }
    }
    factors.pop().flatten().map(|factors| factors.join("*"))
}

fn call_of(product: String, is_called: bool) -> String {
    if is_called { format!("{product}*(…)") } else { product }
}

/// `sinx` as `sin(x)`, and `xsin(…)` as `x*sin(…)`.
fn functions_first(name: &str, is_called: bool, values: &[&str], functions: &[&str]) -> Option<String> {
    let mut functions = functions.to_vec();
    functions.sort_by_key(|function| std::cmp::Reverse(function.len()));
    functions.into_iter().find_map(|function| match is_called {
        true => {
            let factor = product(name.strip_suffix(function)?, values)?;
            Some(format!("{factor}*{function}(…)"))
        }
        false => {
            let argument = product(name.strip_prefix(function)?, values)?;
            Some(format!("{function}({argument})"))
        }
    })
}

/// The first known name of several letters that the fewest slips turn into `name`, if they are few for its length.
pub(super) fn nearest<'n>(name: &str, known: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    let length = name.chars().count();
    let allowed = if length <= 1 || length > LONGEST_NAME { 0 } else { (length / 3).clamp(1, 3) };
    let lengths = (length - allowed).max(2)..=length + allowed;
    known
        .filter(|other| lengths.contains(&other.chars().count()))
        .map(|other| (slips(name, other), other))
        .filter(|&(slips, _)| slips <= allowed)
        .min_by_key(|&(slips, _)| slips)
        .map(|(_, other)| other)
}

/// How many letters inserted, left out, replaced or swapped with their neighbour turn `a` into `b`: the optimal string
/// alignment distance (Damerau 1964).
fn slips(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut rows: [Vec<usize>; 3] = [vec![], vec![], (0..=b.len()).collect()];
    for i in 1..=a.len() {
        rows.rotate_left(1);
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replaced = rows[1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut fewest = replaced.min(rows[1][j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                fewest = fewest.min(rows[0][j - 2] + 1);
            }
            row.push(fewest);
        }
        rows[2] = row;
    }
    rows[2][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_counted_as_damerau_does() {
        for (a, b, count) in [
            ("sin", "sin", 0),
            ("sni", "sin", 1),
            ("sen", "sin", 1),
            ("sqr", "sqrt", 1),
            ("", "abc", 3),
            ("coz", "sin", 3),
        ] {
            assert_eq!(slips(a, b), count, "{a} {b}");
            assert_eq!(slips(b, a), count, "{b} {a}");
        }
    }

    #[test]
    fn of_names_that_are_equally_near_the_usual_ones_are_meant() {
        for (formula, meant) in
            [("sen(x) = y", "`sin`"), ("sun(x) = y", "`sin`"), ("arcsen(x) = y", "`arcsin`")]
        {
            let help = crate::Ast::parse(formula).unwrap_err().help.unwrap();
            assert!(help.contains(meant), "{formula}: {help}");
        }
        assert_eq!(nearest("aa", ["ab", "ac"].into_iter()), Some("ab"));
        assert_eq!(nearest("aa", ["ac", "ab"].into_iter()), Some("ac"));
    }

    #[test]
    fn products_are_made_of_known_values() {
        let values = ["x", "y", "pi", "alpha"];
        assert_eq!(product("xy", &values).as_deref(), Some("x*y"));
        assert_eq!(product("2alphax".trim_start_matches('2'), &values).as_deref(), Some("alpha*x"));
        assert_eq!(product("x2y", &values).as_deref(), Some("x*2*y"));
        assert_eq!(product("xq", &values), None);
    }
}
