//! Code memory, in a process without other tests.
#![cfg(target_os = "linux")]

use std::fs;
use std::sync::Arc;

use iso_expr::random::Random;
use iso_expr::{Engine, Scratch};
use iso_jit::Jit;

/// The bytes of memory mapped by this process.
fn mapped_bytes() -> u64 {
    let pages = fs::read_to_string("/proc/self/statm").unwrap();
    4096 * pages.split(' ').next().unwrap().parse::<u64>().unwrap()
}

/// How many mappings of no file are executable. None is writable too.
fn anonymous_code() -> usize {
    let maps = fs::read_to_string("/proc/self/maps").unwrap();
    let modes = maps.lines().filter_map(|map| match map.split_whitespace().collect::<Vec<_>>()[..] {
        [_, mode, _, _, _] => Some(mode),
        _ => None,
    });
    let executable: Vec<_> = modes.filter(|mode| mode.contains('x')).collect();
    assert!(executable.iter().all(|mode| mode.starts_with("r-x")), "writable and executable:\n{maps}");
    executable.len()
}

#[test]
fn code_memory_is_given_back_and_never_both_writable_and_executable() {
    let jit = Jit::new().unwrap();
    let program = Random::new(1).program(10);
    let compile_and_drop = |count: usize| {
        for _ in 0..count {
            let kernel = jit.batch(&program).unwrap();
            let other_user = Arc::clone(&kernel);
            drop(kernel);
            let points = [&[1.0][..], &[2.0], &[3.0]];
            other_user.evaluate(&mut Scratch::default(), &points, &mut [0.0]);
            jit.point(&program).unwrap();
            jit.boxes(&program).unwrap();
        }
    };
    compile_and_drop(100);
    let before = mapped_bytes();
    compile_and_drop(1000);
    // Each of 3000 kernels takes at least one page, twelve million bytes in all.
    let kept = mapped_bytes().saturating_sub(before);
    assert!(kept < 2_000_000, "{kept} bytes are kept");

    assert_eq!(anonymous_code(), 0);
    let kernel = jit.batch(&program).unwrap();
    assert!(anonymous_code() > 0);
    drop(kernel);
    assert_eq!(anonymous_code(), 0);
}
