//! What holds of the engine as a whole: threads, limits, listings.

use std::sync::Arc;
use std::thread;

use iso_expr::random::Random;
use iso_expr::{Ast, Axis, BatchKernel, CompileError, Engine, Operation, Program, Scratch};
use iso_jit::{Jit, Kind};

/// x + 1·y + 2·x + 3·y …: as deep as it is long.
fn deep_program(terms: u32) -> Program {
    let mut program = Program::new();
    let (x, y) = (program.variable(Axis::X), program.variable(Axis::Y));
    let mut sum = x;
    for term in 1..=terms {
        let factor = program.literal(f64::from(term));
        let product = program.apply(Operation::Multiply, &[if term % 2 == 0 { x } else { y }, factor]);
        sum = program.apply(Operation::Add, &[sum, product]);
    }
    program.set_outputs(vec![sum]);
    program
}

/// The kernel's value at (x, y, 0).
fn value(kernel: &dyn BatchKernel, x: f64, y: f64) -> f64 {
    let mut values = [0.0];
    kernel.evaluate(&mut Scratch::default(), &[&[x], &[y], &[0.0]], &mut values);
    values[0]
}

#[test]
fn kernels_outlive_their_engine_and_move_between_threads() {
    let kernel = Jit::new().unwrap().batch(&deep_program(4)).unwrap();
    let users: Vec<_> = (0..4)
        .map(|place| {
            let kernel = Arc::clone(&kernel);
            thread::spawn(move || value(&*kernel, f64::from(place), 1.0))
        })
        .collect();
    drop(kernel);
    let values: Vec<_> = users.into_iter().map(|user| user.join().unwrap()).collect();
    assert_eq!(values, [4.0, 11.0, 18.0, 25.0]);
}

#[test]
fn threads_compile_at_the_same_time() {
    let jit = Arc::new(Jit::new().unwrap());
    let compilers: Vec<_> = (0..4)
        .map(|seed| {
            let jit = Arc::clone(&jit);
            thread::spawn(move || {
                let mut random = Random::new(seed);
                for terms in 0..40 {
                    let kernel = jit.batch(&deep_program(terms)).unwrap();
                    let (x, y) = (random.below(9) as u32, random.below(9) as u32);
                    let sum: u32 = (1..=terms).map(|term| term * if term % 2 == 0 { x } else { y }).sum();
                    assert_eq!(value(&*kernel, f64::from(x), f64::from(y)), f64::from(x + sum));
                    jit.boxes(&random.program(8)).unwrap();
                }
            })
        })
        .collect();
    for compiler in compilers {
        compiler.join().unwrap();
    }
}

#[test]
fn large_and_deep_programs_need_little_stack() {
    let compiler = thread::Builder::new().stack_size(2 << 20).spawn(|| {
        let jit = Jit::new().unwrap();
        let terms = 10_000;
        let kernel = jit.batch(&deep_program(terms)).unwrap();
        // Sums of integers below 2⁵³ are exact.
        assert_eq!(value(&*kernel, 1.0, 1.0), 1.0 + f64::from(terms * (terms + 1) / 2));
        jit.boxes(&deep_program(2000)).unwrap();
    });
    compiler.unwrap().join().unwrap();
}

#[test]
fn programs_beyond_the_limits_are_refused() {
    let jit = Jit::new().unwrap();
    let refusal = jit.batch(&deep_program(60_000)).err().unwrap();
    assert!(matches!(refusal, CompileError::TooLarge { engine: "jit", given: 120_000, .. }), "{refusal}");
    // So many values at once that they overflow the stack, not the limit of operations.
    let refusal = jit.batch(&Random::new(1).wide_program(45_000)).err().unwrap();
    assert!(matches!(refusal, CompileError::FrameTooLarge { engine: "jit", .. }), "{refusal}");
}

#[test]
fn listings_show_the_code() {
    let jit = Jit::new().unwrap();
    let program = deep_program(3);
    for (kind, ty) in [(Kind::Point, "f64"), (Kind::Batch, "f64x2"), (Kind::Boxes, "f64x2")] {
        let listing = jit.listing(&program, kind).unwrap();
        assert!(listing.clif.contains("fmul") && listing.clif.contains(ty), "{}", listing.clif);
        assert!(listing.assembly.contains("ret"), "{}", listing.assembly);
        assert!(listing.code_bytes > 50 && listing.compile_time.as_nanos() > 0);
    }
}

#[test]
fn a_point_takes_one_instruction_for_two_divisions() {
    let jit = Jit::new().unwrap();
    for (formula, expected) in
        [("1/x + 1/y + z/(x + y) + x/(y + z)", 2), ("1/(1 + 1/x)", 2), ("sqrt(x) - sqrt(y)", 1)]
    {
        let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
        let listing = jit.listing(&program, Kind::Point).unwrap();
        let written = ["fdiv", "sqrt"].map(|name| listing.clif.matches(name).count());
        assert_eq!(written.iter().sum::<usize>(), expected, "{}", listing.clif);
    }
}
