//! Published models in fidget's text form, one operation a line: `name operation operands`.

use std::collections::HashMap;
use std::error::Error;
use std::path::Path;

use iso_expr::{Axis, NodeId, Operation, Program};

/// Reads a model: the last line is the function.
///
/// # Errors
/// When the file cannot be read or a line is no operation.
pub fn read_model(path: &Path) -> Result<Program, Box<dyn Error>> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let mut program = Program::new();
    let mut places = HashMap::new();
    let mut last = None;
    for (number, line) in text.lines().enumerate() {
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let (name, node) = read_line(&mut program, &places, line)
            .ok_or_else(|| format!("{}, line {}: cannot read `{line}`", path.display(), number + 1))?;
        places.insert(name, node);
        last = Some(node);
    }
    program.set_outputs(vec![last.ok_or("the model is empty")?]);
    Ok(program.pruned())
}

fn read_line<'a>(
    program: &mut Program,
    places: &HashMap<&'a str, NodeId>,
    line: &'a str,
) -> Option<(&'a str, NodeId)> {
    let mut words = line.split_whitespace();
    let (name, operation) = (words.next()?, words.next()?);
    let mut operand = || places.get(words.next()?).copied();
    let node = match operation {
        "var-x" => program.variable(Axis::X),
        "var-y" => program.variable(Axis::Y),
        "var-z" => program.variable(Axis::Z),
        "const" => program.literal(words.next()?.parse().ok()?),
        "square" => {
            let base = operand()?;
            program.integer_power(base, 2)
        }
        _ => {
            let operation = named(operation)?;
            let operands: Option<Vec<_>> = (0..operation.arity()).map(|_| operand()).collect();
            program.apply(operation, &operands?)
        }
    };
    Some((name, node))
}

fn named(operation: &str) -> Option<Operation> {
    Some(match operation {
        "add" => Operation::Add,
        "sub" => Operation::Subtract,
        "mul" => Operation::Multiply,
        "div" => Operation::Divide,
        "neg" => Operation::Negate,
        "abs" => Operation::Absolute,
        "min" => Operation::Minimum,
        "max" => Operation::Maximum,
        "sqrt" => Operation::SquareRoot,
        "exp" => Operation::Exp,
        "ln" => Operation::Ln,
        "sin" => Operation::Sin,
        "cos" => Operation::Cos,
        "tan" => Operation::Tan,
        "asin" => Operation::Asin,
        "acos" => Operation::Acos,
        "atan" => Operation::Atan,
        "atan2" => Operation::Atan2,
        "floor" => Operation::Floor,
        "ceil" => Operation::Ceil,
        _ => return None,
    })
}
