//! Tests of the program `iso` as its users meet it: command lines in, files, text and exit codes out.

mod harness;

mod engines;
mod eval;
mod explain;
mod formulas;
mod limits;
mod render;
mod report;
mod sequence;
mod stress;
mod trace;
mod usage;
