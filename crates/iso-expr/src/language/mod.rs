//! The language of formulas.
//!
//! ```text
//! # The paper's surface, scaled by a parameter.
//! a := 0.5
//! r := sqrt(x^2 + y^2)
//! square(u) := u^2
//! square(r² - 1) + 4z² + a x = 0.2
//! ```
//!
//! A formula is an equation, `lhs = rhs` or `lhs == rhs`, or an expression whose surfaces are its levels. Definitions stand
//! beside it in any order, parted by `;` or new lines: values, which are parameters when no coordinate counts in them, and
//! functions. A line goes on after an operator, before one that begins the next line, and inside parentheses; but a sign at the start of a
//! line that follows a definition begins the formula.
//!
//! | written | meaning |
//! |---|---|
//! | `or`, `and`, `not`, `< <= > >= == !=` | conditions, loosest first: 1 where they hold, 0 where not; any number but 0 holds |
//! | `a + b`, `a - b` | from left to right |
//! | `a*b`, `a/b`, `a b` | from left to right; a product without a sign is like any other, so that `1/2x` is (1/2)·x |
//! | `-a`, `√a` | of the power that follows: `-x^2` is −(x²), `√x²` is √(x²), and `√2x` is (√2)·x |
//! | `a^b`, `a**b`, `a²` | from right to left; the exponent may have a sign: `2^-3` |
//! | `f(a, b)`, `\|a\|`, `(a)` | a name that is no function is a factor: `x(y+1)` is x·(y+1) |
//!
//! `where` and a condition behind a formula leave of its surface what lies where that holds or just ceases to hold.
//!
//! An integer exponent that is constant means repeated multiplication, whatever the base; any other power is undefined
//! for a negative base. `e^a` is `exp(a)`. `round` rounds ties to even, and `mod(a, b)` has the sign of b.
//! `grammar.pest` lists the items of the language, `prelude.iso` its derived functions.

mod ast;
mod builder;
mod cursor;
mod definition;
mod domain;
mod elsewhere;
mod error;
mod expression;
mod fault;
mod function;
mod item;
pub mod limits;
mod lower;
mod model;
mod number;
mod outline;
mod parse;
mod print;
mod scope;
mod suggestion;
mod unused;

pub use ast::Ast;
pub use error::{FormulaError, FormulaErrorKind};
pub use lower::Formula;
pub use outline::Outline;
pub use parse::decode;
