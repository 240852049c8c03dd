//! Writes gradients and interval kernels of the measured formulas as straight-line Rust.
//!
//! Values are written by hand, in `src/formulas.rs`. Derivatives come in too many equal forms for two authors to agree on
//! the order of operations, and so on every rounding; these are therefore written from the very programs that the engines
//! are given, one `let` an operation.

use std::fmt::Write as _;
use std::path::PathBuf;

use iso_benches::surfaces::Subject;
use iso_expr::{Node, NodeId, Operation, Program};

include!("src/measured.rs");

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=src/measured.rs");
    let mut code = String::new();
    for name in MEASURED {
        let subject = Subject::named(name).expect("measured formulas are among the benchmarks' surfaces");
        let value = subject.program().expect("the surface's formula is right");
        let gradient = value.with_gradient().simplified();
        let slope = value.with_slope().simplified();
        write_values(&mut code, &format!("{name}_gradient"), "", &gradient.with_powers_expanded());
        let direction = ", a3: f64, a4: f64, a5: f64";
        write_values(&mut code, &format!("{name}_slope"), direction, &slope.with_powers_expanded());
        write_boxes(&mut code, &format!("{name}_box"), &value);
        write_boxes(&mut code, &format!("{name}_box_gradient"), &gradient);
    }
    let folder = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo names the folder"));
    std::fs::write(folder.join("straight_line.rs"), code).expect("cargo's folder can be written to");
}

/// Writes a function of doubles, x, y, z and others, that gives the program's outputs.
fn write_values(code: &mut String, name: &str, others: &str, program: &Program) {
    let outputs = program.outputs().len();
    let write = |code: &mut String| -> std::fmt::Result {
        writeln!(
            code,
            "#[inline(always)]\npub(crate) fn {name}(x: f64, y: f64, z: f64{others}) -> [f64; {outputs}] {{"
        )?;
        for (id, node) in program.iter() {
            if let Node::Apply(operation, _) = node {
                let operands: Vec<_> =
                    node.operands().iter().map(|operand| value(program, *operand)).collect();
                writeln!(code, "    let v{} = {};", id.index(), value_of(*operation, &operands))?;
            }
        }
        let outputs: Vec<_> = program.outputs().iter().map(|output| value(program, *output)).collect();
        writeln!(code, "    [{}]\n}}", outputs.join(", "))
    };
    write(code).expect("strings have room");
}

fn value(program: &Program, id: NodeId) -> String {
    match program.node(id) {
        Node::Variable(argument) => argument.to_string(),
        Node::Constant(constant) => format!("({:?}_f64)", constant.value()),
        Node::Apply(..) => format!("v{}", id.index()),
    }
}

fn value_of(operation: Operation, operands: &[String]) -> String {
    match (operation, operands) {
        (Operation::Add | Operation::Subtract | Operation::Multiply | Operation::Divide, [a, b]) => {
            format!("{a} {} {b}", operation.name())
        }
        (Operation::Negate, [a]) => format!("-{a}"),
        _ => format!("operations::{}({})", function_name(operation), operands.join(", ")),
    }
}

/// The operation's name as Rust writes functions: `LessOrEqual` becomes `less_or_equal`.
fn function_name(operation: Operation) -> String {
    let mut name = String::new();
    for letter in format!("{operation:?}").chars() {
        if letter.is_uppercase() && !name.is_empty() {
            name.push('_');
        }
        name.push(letter.to_ascii_lowercase());
    }
    name
}

/// Writes a function of intervals that gives the program's outputs, or `None` when intervals in Rust lack an operation.
fn write_boxes(code: &mut String, name: &str, program: &Program) {
    let outputs = program.outputs().len();
    let steps: Option<Vec<_>> = program
        .iter()
        .filter_map(|(id, node)| match node {
            Node::Apply(operation, _) => Some((id, *operation, node.operands())),
            _ => None,
        })
        .map(|(id, operation, operands)| {
            Some(format!("        let v{} = {};\n", id.index(), interval_of(program, operation, operands)?))
        })
        .collect();
    let function = match steps {
        Some(steps) => {
            let results: Vec<_> = program.outputs().iter().map(|output| interval(program, *output)).collect();
            format!(
                "Some({{\n    #[inline(always)]\n    fn enclosures(x: Interval, y: Interval, z: Interval) -> [Interval; \
                 {outputs}] {{\n{}        [{}]\n    }}\n    enclosures\n}})",
                steps.concat(),
                results.join(", ")
            )
        }
        None => "None".to_owned(),
    };
    let constant = name.to_uppercase();
    writeln!(code, "pub(crate) const {constant}: Option<Enclose<{outputs}>> = {function};")
        .expect("strings have room");
}

fn interval(program: &Program, id: NodeId) -> String {
    match program.node(id) {
        Node::Variable(argument) => argument.to_string(),
        Node::Constant(constant) => {
            let enclosure = constant.enclosure();
            format!("Interval {{ lo: {:?}_f64, hi: {:?}_f64 }}", enclosure.lo, enclosure.hi)
        }
        Node::Apply(..) => format!("v{}", id.index()),
    }
}

fn interval_of(program: &Program, operation: Operation, operands: &[NodeId]) -> Option<String> {
    let operand = |place: usize| interval(program, operands[place]);
    let method = match operation {
        Operation::Add => "plus",
        Operation::Subtract => "minus",
        Operation::Multiply => "times",
        Operation::Divide => "over",
        Operation::Negate => return Some(format!("{}.negated()", operand(0))),
        Operation::IntegerPower => {
            let Node::Constant(exponent) = program.node(operands[1]) else { return None };
            return Some(format!("{}.to_the({})", operand(0), exponent.value()));
        }
        _ => return None,
    };
    Some(format!("{}.{method}({})", operand(0), operand(1)))
}
