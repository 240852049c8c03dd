use super::PARTS;
use crate::program::tests::twofold::{ARITHMETIC, Twofold, exact};
use crate::random::Random;
use crate::{Ast, Engine, Interpreter, Interval, Operation, Program, Scratch};

/// Numbers of a form: middle, slopes and rest.
type Form = [f64; PARTS];

/// What has forms beside arithmetic; those that are continuous come first.
const OTHERS: [Operation; 11] = [
    Operation::CubeRoot,
    Operation::Hypotenuse,
    Operation::Exp,
    Operation::Ln,
    Operation::Sin,
    Operation::Cos,
    Operation::Sign,
    Operation::Less,
    Operation::LessOrEqual,
    Operation::Equal,
    Operation::Select,
];

/// How many of these are continuous.
const CONTINUOUS: usize = 6;

/// Forms of x, y and z around a point, so wide.
fn arguments(random: &mut Random, width: f64) -> [Form; 3] {
    [(); 3].map(|()| {
        let mut part = |width: f64| width * random.between(-1.0, 1.0);
        let (middle, slopes) = (part(3.0), [part(width), part(width), part(width)]);
        // No less than what the coordinates of points are rounded by, if they are.
        let rest = if width > 0.0 { part(0.1 * width).abs() + 1e-14 } else { 0.0 };
        [middle, slopes[0], slopes[1], slopes[2], rest]
    })
}

/// Three numbers from −1 to 1, often ends.
fn symbols(random: &mut Random) -> [f64; 3] {
    [(); 3].map(|()| match random.below(4) {
        0 => -1.0,
        1 => 1.0,
        _ => random.between(-1.0, 1.0),
    })
}

/// A number of a form, for these symbols.
fn member(random: &mut Random, [middle, a, b, c, rest]: Form, symbols: [f64; 3]) -> f64 {
    let off = 0.9 * rest * random.between(-1.0, 1.0);
    middle + (a * symbols[0] + b * symbols[1] + c * symbols[2]) + off
}

/// The middle of the numbers of a form for these symbols, nearly exactly.
fn line([middle, a, b, c, _]: Form, symbols: [f64; 3]) -> Twofold {
    let term = |slope: f64, symbol: f64| Twofold(slope, 0.0).times(Twofold(symbol, 0.0));
    let slopes = [a, b, c].into_iter().zip(symbols).map(|(slope, symbol)| term(slope, symbol));
    slopes.fold(Twofold(middle, 0.0), Twofold::plus)
}

fn form_of(program: &Program, arguments: [Form; 3]) -> Form {
    program.evaluate(arguments.concat()).try_into().expect("a form has five parts")
}

fn is_known(form: &Form) -> bool {
    form.iter().all(|part| part.is_finite())
}

#[test]
fn values_of_arithmetic_are_in_their_forms() {
    let mut random = Random::new(11);
    let mut compared = 0;
    let mut tightest: f64 = 0.0;
    for round in 0..6000 {
        let program = random.program_of(1 + round % 20, &ARITHMETIC);
        let forms = program.with_forms().expect("arithmetic has forms");
        let width = [0.0, 1e-9, 1e-3, 0.1, 0.5][round % 5];
        let arguments = arguments(&mut random, width);
        let form = form_of(&forms, arguments);
        if !is_known(&form) {
            continue;
        }
        for _ in 0..20 {
            let symbols = symbols(&mut random);
            let point = arguments.map(|argument| member(&mut random, argument, symbols));
            let exact = exact(&program, point)[0];
            assert!(!exact.0.is_nan() || form[4] > 1e200, "{point:?} of\n{program}");
            let Twofold(off, _) = exact.plus(line(form, symbols).negated());
            if off.is_nan() {
                continue; // Products of doubles near the largest are too large for two.
            }
            assert!(off.abs() <= form[4], "off by {off}, not {}, at {symbols:?} of\n{program}", form[4]);
            if width > 0.0 && form[4] < 1e-10 {
                tightest = tightest.max(off.abs() / form[4]);
            }
            compared += 1;
        }
    }
    assert!(compared > 50_000, "only {compared} values were compared");
    assert!(tightest > 0.3, "forms use {tightest} of their rest");
}

#[test]
fn values_of_all_operations_are_in_their_forms() {
    let mut random = Random::new(12);
    let operations = [&ARITHMETIC[..], &OTHERS].concat();
    let mut compared = 0;
    for round in 0..8000 {
        let program = random.program_of(1 + round % 12, &operations);
        let forms = program.with_forms().expect("all of these have forms");
        let arguments = arguments(&mut random, [1e-9, 1e-3, 0.1, 0.5][round % 4]);
        compared += compare(&mut random, &program, (arguments, form_of(&forms, arguments)));
    }
    assert!(compared > 20_000, "only {compared} values were compared");
}

/// Holds values of a program at members of `arguments` against its form there, and counts them.
fn compare(random: &mut Random, program: &Program, (arguments, form): ([Form; 3], Form)) -> usize {
    if !is_known(&form) {
        return 0;
    }
    let value = Interpreter.boxes(program).unwrap();
    for _ in 0..10 {
        let symbols = symbols(random);
        let point = arguments.map(|argument| member(random, argument, symbols));
        let enclosure = crate::program::rounding::tests::enclose(&*value, 1, point.map(Interval::point))[0];
        let Interval { lo, hi } = enclosure.interval;
        let Twofold(middle, _) = line(form, symbols);
        let off = (lo - middle).max(middle - hi);
        let rest = form[4];
        assert!(off <= rest, "{lo} to {hi} is not {middle} ± {rest} at {symbols:?} of\n{program}");
    }
    10
}

#[test]
fn values_of_each_function_are_in_its_form() {
    let mut random = Random::new(17);
    for operation in &OTHERS[..CONTINUOUS] {
        let mut program = Program::new();
        let operands = crate::Axis::ALL.map(|axis| program.variable(axis));
        let output = program.apply(*operation, &operands[..operation.arity()]);
        program.set_outputs(vec![output]);
        let forms = program.with_forms().unwrap();
        let mut compared = 0;
        for round in 0..4000 {
            let arguments = arguments(&mut random, [1e-9, 1e-3, 0.1, 0.5][round % 4]);
            compared += compare(&mut random, &program, (arguments, form_of(&forms, arguments)));
        }
        assert!(compared > 10_000, "{operation:?}: only {compared} values were compared");
    }
}

/// What is left of a smooth maximum where it is told as one: its form is known wherever e to its deviation is.
#[test]
fn smooth_maxima_and_shares_are_in_their_forms() {
    let formulas = [
        "ln(exp(x) + exp(y))",
        "ln(exp(3x - y) + (exp(2y) + 2)) - ln(exp(z) + 0.5)",
        "1/(1 + exp(x))",
        "y/(exp(x - y) + 1) - 1/(1 + (exp(3x) + exp(z - x)))",
        "ln(exp(-8*ln(exp(x) + exp(y))) + exp(-8*z))/8",
        "ln(exp(3x - y) + exp(x*y - x))",
    ];
    let mut random = Random::new(16);
    for formula in formulas {
        let value = Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
        let mut slope = value.with_gradient().simplified();
        slope.set_outputs(vec![slope.outputs()[1]]);
        let programs = [value, slope.pruned()].map(|program| (program.with_forms().unwrap(), program));
        for round in 0..2000 {
            let arguments = arguments(&mut random, [1e-9, 1e-3, 0.1, 0.5, 3.0, 20.0][round % 6]);
            for (forms, program) in &programs {
                let form = form_of(forms, arguments);
                assert!(is_known(&form), "{form:?} of {formula} over {arguments:?}");
                compare(&mut random, program, (arguments, form));
            }
        }
    }
}

/// ∂/∂x ln(eˣ⁺ʸ + eˣ) is 1, although the shares of both change with y, and with 2x in the second place it is 1 + s for the share s of that.
#[test]
fn shares_of_a_whole_sum_up_to_one() {
    let form = |formula: &str| {
        let value = Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
        let mut slope = value.with_gradient().simplified();
        slope.set_outputs(vec![slope.outputs()[1]]);
        let arguments = [[0.0; PARTS], [0.0, 0.5, 0.0, 0.0, 0.0], [0.0; PARTS]];
        form_of(&slope.pruned().with_forms().unwrap(), arguments)
    };
    let [middle, slope, .., rest] = form("ln(exp(x + y) + exp(x))");
    assert!(
        (middle - 1.0).abs() < 1e-12 && slope.abs() < 1e-12 && rest < 1e-12,
        "{middle} + {slope}·e ± {rest}"
    );
    let [middle, slope, .., rest] = form("ln(exp(-3*(x + y)) + exp(-6*x))/-3");
    assert!((middle - 1.5).abs() < 1e-12 && (slope - 0.375).abs() < 1e-12, "{middle} + {slope}·e ± {rest}");
    assert!(rest < 0.12, "{rest}");
}

/// Written out, this sum has 10¹² terms.
#[test]
fn sums_of_shared_sums_are_not_written_out() {
    let mut program = Program::new();
    let [x, y, _] = crate::Axis::ALL.map(|axis| program.variable(axis));
    let mut sums = [x, y].map(|argument| program.apply(Operation::Exp, &[argument]));
    for _ in 0..58 {
        sums = [sums[1], program.apply(Operation::Add, &sums)];
    }
    let logarithm = program.apply(Operation::Ln, &[sums[1]]);
    program.set_outputs(vec![logarithm]);
    assert_eq!(program.with_forms().unwrap().outputs().len(), PARTS);
    assert!(program.with_slope().with_forms().is_some());
    assert_eq!(program.with_rounding().outputs().len(), 5);
}

/// The rest of a smooth maximum is ⅛r² where both are alike and deviate by r from each other, and nothing far from there.
#[test]
fn smooth_maxima_bend_only_where_both_count() {
    let program = Ast::parse("ln(exp(x) + exp(y))").unwrap().lower(&[]).unwrap().minus_level(0.0);
    let forms = program.with_forms().unwrap();
    let rest = |distance: f64, width: f64| {
        form_of(&forms, [[distance, width, 0.0, 0.0, 0.0], [0.0; PARTS], [0.0; PARTS]])[4]
    };
    let close = |found: f64, expected: f64| (found - expected).abs() < 1e-8 * expected + 1e-12;
    assert!(close(rest(0.0, 0.1), 0.5 * 0.125 * 0.01));
    assert!(close(rest(0.0, 40.0), 0.5 * 40.0));
    assert!(rest(30.0, 1.0) < 1e-12);
}

#[test]
fn gradients_of_what_has_branches_have_forms() {
    for formula in ["max(x, y) - min(x, z)^2", "abs(x - y)*sqrt(1 + x^2)", "exp(-x^2) + sin(y)/cos(z)"] {
        let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
        assert!(program.has_forms());
        let gradient = program.with_gradient().simplified();
        assert_eq!(gradient.with_forms().unwrap().outputs().len(), 4 * PARTS);
    }
    for formula in ["floor(x)", "if(x < y, x, z)", "atan(x)", "ln(exp(x) + exp(y) + exp(z) + exp(-x) + 1)"] {
        let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
        assert!(!program.has_forms(), "{formula}");
    }
}

/// Derivatives, and what simplifying makes of them, take no operation without a form.
#[test]
fn gradients_of_what_has_forms_have_forms() {
    let mut random = Random::new(14);
    let operations = [&ARITHMETIC[..], &OTHERS[..CONTINUOUS]].concat();
    for round in 0..2000 {
        let program = random.program_of(1 + round % 15, &operations).simplified();
        if program.has_forms() {
            assert!(program.with_gradient().simplified().with_forms().is_some(), "{program}");
            assert!(program.with_slope().simplified().with_forms().is_some(), "{program}");
        }
    }
}

/// The sum of the gradient's components times those of the direction, nearly exactly, is in the slope's form.
#[test]
fn slopes_are_in_their_forms() {
    let mut random = Random::new(15);
    let mut compared = 0;
    for round in 0..4000 {
        let program = random.program_of(1 + round % 12, &ARITHMETIC[..4]).simplified();
        let gradient = program.with_gradient();
        let forms = program.with_slope().simplified().with_forms().expect("arithmetic has forms");
        let direction = [(); 3].map(|()| random.between(-1.0, 1.0));
        let arguments = arguments(&mut random, [1e-9, 1e-3, 0.1][round % 3]);
        let found = forms.evaluate([&arguments.concat()[..], &direction].concat());
        let form: Form = found[PARTS..].try_into().unwrap();
        if !is_known(&form) || form[4] > 1e100 {
            continue;
        }
        for _ in 0..5 {
            let symbols = symbols(&mut random);
            let point = arguments.map(|argument| member(&mut random, argument, symbols));
            let partials = exact(&gradient, point);
            let products =
                partials[1..].iter().zip(direction).map(|(partial, d)| partial.times(Twofold(d, 0.0)));
            let slope = products.fold(Twofold(0.0, 0.0), Twofold::plus);
            let Twofold(off, _) = slope.plus(line(form, symbols).negated());
            if off.is_nan() {
                continue; // As above.
            }
            assert!(off.abs() <= form[4], "off by {off}, not {}, at {symbols:?} of\n{program}", form[4]);
            compared += 1;
        }
    }
    assert!(compared > 10_000, "only {compared} slopes were compared");
}

/// Over |x − 1| ≤ 0.1: x² = 1.005 + 0.2·e ± 0.005, and what values have in common cancels.
#[test]
fn forms_know_what_values_have_in_common() {
    let form = |formula: &str| {
        let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0);
        let [x, y, z] = [[1.0, 0.1, 0.0, 0.0, 0.0], [2.0, 0.0, 0.1, 0.0, 0.0], [0.0; PARTS]];
        form_of(&program.with_forms().unwrap(), [x, y, z])
    };
    let close = |found: Form, expected: Form| {
        let off = found.iter().zip(expected).map(|(found, expected)| (found - expected).abs());
        assert!(off.fold(0.0, f64::max) < 1e-12, "{found:?} is not {expected:?}");
    };
    close(form("x*x"), [1.005, 0.2, 0.0, 0.0, 0.005]);
    close(form("(x + y) - (x - y)"), [4.0, 0.0, 0.2, 0.0, 0.0]);
    close(form("x*y - y*x"), [0.0, 0.0, 0.0, 0.0, 0.02]);
    // 1/(1 + u) = 1 − u + u²/(1 + u), whose last term is from 0 to 0.01/0.9.
    close(form("1/x"), [1.0 + 0.005 / 0.9, -0.1, 0.0, 0.0, 0.005 / 0.9]);
    close(form("(x + x)/x"), [2.0, 0.0, 0.0, 0.0, 0.0]);
    // x/y = ½ + (x − ½y)/y, where (x − ½y)/2 is 0.05·e − 0.025·f, no more than 0.075, and y no less than 1.9.
    close(form("x/y"), [0.5, 0.05, -0.025, 0.0, 0.075 * 0.1 / 1.9]);
    close(form("max(x, y)"), [2.0, 0.0, 0.1, 0.0, 0.0]);
    assert!(form("1/(x - 1)")[4].is_nan() && form("sqrt(x - 1)")[4].is_nan());
}

/// What is multiplied by a weight may underflow.
#[test]
fn choices_of_the_least_doubles_are_in_their_forms() {
    for formula in ["abs(x)", "abs(-x)", "max(x, y)", "min(x, 2*x)"] {
        let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0);
        let forms = program.with_forms().unwrap();
        for value in [f64::from_bits(1), -f64::from_bits(3)] {
            let arguments = [[value, 0.0, 0.0, 0.0, 0.0], [0.0; PARTS], [0.0; PARTS]];
            compare(&mut Random::new(18), &program, (arguments, form_of(&forms, arguments)));
        }
    }
}

#[test]
fn engines_agree_on_forms() {
    let mut random = Random::new(13);
    let program = random.program_of(15, &ARITHMETIC).with_forms().unwrap();
    let arguments = arguments(&mut random, 0.1).concat();
    let slices: Vec<&[f64]> = arguments.chunks(1).collect();
    let mut found = [0.0; PARTS];
    Interpreter.batch(&program).unwrap().evaluate(&mut Scratch::default(), &slices, &mut found);
    for (found, expected) in found.into_iter().zip(program.evaluate(&arguments)) {
        crate::program::reference::assert_same(found, expected, || program.to_string());
    }
}
