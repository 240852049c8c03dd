//! The corpus of `testdata/language`: what formulas mean, how they are printed, and what is said of wrong ones.
//!
//! `ISO_CASES=text` runs only the cases whose formula contains the text.

use std::fs;
use std::path::PathBuf;

use iso_expr::engine::{Engine, Scratch};
use iso_expr::{Ast, FormulaError, FormulaErrorKind, Interpreter, decode};
use serde::Deserialize;

/// One file of the corpus.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Topic {
    #[serde(default)]
    meaning: Vec<Meaning>,
    #[serde(default)]
    error: Vec<Wrong>,
}

/// A formula with its canonical text and its values.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Meaning {
    formula: String,
    prints: String,
    /// Values given in place of parameters.
    #[serde(default)]
    set: Vec<(String, f64)>,
    /// x, y, z and the value there: F for an expression, left less right side for an equation.
    #[serde(default)]
    at: Vec<[f64; 4]>,
    /// The greatest relative error of a value; exact when it is not given.
    #[serde(default)]
    within: f64,
    /// Whether it is an equation; not looked at when it is not given.
    equation: Option<bool>,
}

/// A formula that is refused.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Wrong {
    formula: String,
    #[serde(default)]
    set: Vec<(String, f64)>,
    /// The kind of error.
    kind: String,
    /// The place, as a caret under each character of a one-line formula.
    carets: Option<String>,
    /// The place, as the bytes from the first to the one after the last.
    span: Option<[usize; 2]>,
    /// What the message must contain.
    #[serde(default)]
    message: Vec<String>,
    /// What the help must contain.
    #[serde(default)]
    help: Vec<String>,
}

/// Every topic with the name of its file.
fn corpus() -> Vec<(String, Topic)> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../testdata/language");
    let mut files: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let read = |path: &PathBuf| {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let topic = toml::from_str(&fs::read_to_string(path).unwrap());
        (name.clone(), topic.unwrap_or_else(|error| panic!("{name}: {error}")))
    };
    files.iter().map(read).collect()
}

fn is_wanted(formula: &str) -> bool {
    std::env::var("ISO_CASES").map_or(true, |text| formula.contains(&text))
}

#[test]
fn formulas_mean_what_the_corpus_says() {
    let mut faults = Vec::new();
    for (file, topic) in corpus() {
        for case in topic.meaning.iter().filter(|case| is_wanted(&case.formula)) {
            faults.extend(
                check_meaning(case).err().map(|fault| format!("{file}: {:?}: {fault}", case.formula)),
            );
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

fn check_meaning(case: &Meaning) -> Result<(), String> {
    let ast = Ast::parse(&case.formula).map_err(|error| format!("{error} ({:?})", error.help))?;
    let printed = ast.to_string();
    if printed != case.prints {
        return Err(format!("it prints as {printed:?}"));
    }
    if Ast::parse(&printed).as_ref() != Ok(&ast) {
        return Err("its canonical text means something else".to_owned());
    }
    let formula = ast.lower(&case.set).map_err(|error| error.to_string())?;
    if case.equation.is_some_and(|equation| equation != formula.is_equation()) {
        return Err(format!("is_equation is {}", formula.is_equation()));
    }
    let kernel = Interpreter.point(formula.program()).map_err(|error| error.to_string())?;
    for [x, y, z, expected] in &case.at {
        let mut values = [0.0];
        kernel.evaluate(&mut Scratch::default(), *x, *y, *z, &mut values);
        let [value] = values;
        let agrees = value == *expected
            || value.is_nan() && expected.is_nan()
            || (value - expected).abs() <= case.within * expected.abs();
        if !agrees {
            return Err(format!("its value at {x}, {y}, {z} is {value:?}, not {expected:?}"));
        }
    }
    Ok(())
}

#[test]
fn wrong_formulas_are_refused_as_the_corpus_says() {
    let mut faults = Vec::new();
    for (file, topic) in corpus() {
        for case in topic.error.iter().filter(|case| is_wanted(&case.formula)) {
            faults
                .extend(check_error(case).err().map(|fault| format!("{file}: {:?}: {fault}", case.formula)));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

fn check_error(case: &Wrong) -> Result<(), String> {
    let Err(error) = Ast::parse(&case.formula).and_then(|ast| ast.lower(&case.set)) else {
        return Err("it is accepted".to_owned());
    };
    let FormulaError { kind, span, help } = &error;
    let kind = format!("{kind:?}");
    let name = kind.split(' ').next().unwrap_or_default();
    if name != case.kind {
        return Err(format!("it is refused as {kind}: {error}"));
    }
    let expected = expected_span(case);
    if expected.is_some_and(|expected| expected != (span.start, span.end)) {
        return Err(format!("the error stands at {span:?}, not at {expected:?}"));
    }
    let (message, help) = (error.to_string(), help.as_deref().unwrap_or_default());
    for (said, parts) in [(message.as_str(), &case.message), (help, &case.help)] {
        if let Some(part) = parts.iter().find(|part| !said.contains(part.as_str())) {
            return Err(format!("{part:?} is missing in {said:?}"));
        }
    }
    Ok(())
}

fn expected_span(case: &Wrong) -> Option<(usize, usize)> {
    let Some(carets) = &case.carets else {
        return case.span.map(|[start, end]| (start, end));
    };
    let byte =
        |place: usize| case.formula.char_indices().nth(place).map_or(case.formula.len(), |(byte, _)| byte);
    let blanks = carets.chars().take_while(|character| *character == ' ').count();
    Some((byte(blanks), byte(carets.chars().count())))
}

#[test]
fn bytes_that_are_no_text_are_refused_with_their_place() {
    assert_eq!(decode("x²".as_bytes()), Ok("x²"));
    let error = decode(b"x + \xffy").unwrap_err();
    assert_eq!(error.kind, FormulaErrorKind::NotUtf8 { byte: 0xff, offset: 4 });
    assert_eq!(error.span, 4..5);
    assert_eq!(decode("x²".as_bytes().split_last().unwrap().1).unwrap_err().span, 1..2);
}

#[test]
fn the_scenes_of_the_oracle_are_read() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../testdata/oracle/scenes.toml");
    let scenes: toml::Table = toml::from_str(&fs::read_to_string(path).unwrap()).unwrap();
    let scenes = scenes["scene"].as_array().unwrap();
    for scene in scenes {
        let text = scene["formula"].as_str().unwrap();
        let ast = Ast::parse(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(Ast::parse(&ast.to_string()), Ok(ast), "{text}");
    }
    assert!(!scenes.is_empty());
}
