//! The one table of operations.
//!
//! Parser, printer, derivatives, interpreter, native code, intervals and tests all read it. `CONTRIBUTING.md` says where
//! else a new operation is told of.

mod derivative;
mod squaring;
mod table;
pub(crate) mod value;

pub use derivative::Chain;
pub(crate) use derivative::MeanByShares;
pub use squaring::by_squaring;
use table::Row;
pub use value::Value;

use crate::interval::Extension;

/// What a node of a program does with its operands.
///
/// Values are IEEE 754 binary64, rounded to nearest, ties to even. Elementary functions are correctly rounded (CORE-MATH).
/// A NaN operand gives a NaN wherever the operand counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u8)]
pub enum Operation {
    /// a + b
    Add,
    /// a − b
    Subtract,
    /// a · b
    Multiply,
    /// a / b
    Divide,
    /// −a
    Negate,
    /// |a|
    Absolute,
    /// −1, 0 or 1; the sign of a zero is kept
    Sign,
    /// The lesser of a and b; b when they are equal
    Minimum,
    /// The greater of a and b; b when they are equal
    Maximum,
    /// a multiplied by itself; the second operand is a constant, an integer from 2 to [`Operation::LARGEST_POWER`]
    IntegerPower,
    /// a to the power b, defined for a > 0, for a = 0 where b > 0, and 0⁰ = 1
    Power,
    /// √a
    SquareRoot,
    /// ∛a, defined for negative a too
    CubeRoot,
    /// √(a² + b²)
    Hypotenuse,
    /// eᵃ
    Exp,
    /// 2ᵃ
    Exp2,
    /// eᵃ − 1
    ExpM1,
    /// The natural logarithm of a
    Ln,
    /// The logarithm of a to base 2
    Log2,
    /// The logarithm of a to base 10
    Log10,
    /// The natural logarithm of 1 + a
    Ln1P,
    /// sin a, in radians
    Sin,
    /// cos a, in radians
    Cos,
    /// tan a, in radians
    Tan,
    /// arcsin a
    Asin,
    /// arccos a
    Acos,
    /// arctan a
    Atan,
    /// The angle of the point (b, a), above −π and up to π; at the origin, where it is undefined, its double is 0
    Atan2,
    /// sinh a
    Sinh,
    /// cosh a
    Cosh,
    /// tanh a
    Tanh,
    /// arsinh a
    Asinh,
    /// arcosh a
    Acosh,
    /// artanh a
    Atanh,
    /// The greatest integer not above a
    Floor,
    /// The least integer not below a
    Ceil,
    /// The integer nearest to a, ties to even
    Round,
    /// a without its fraction
    Truncate,
    /// a − b·⌊a/b⌋, the remainder with the sign of b
    Modulo,
    /// 1 where a < b, else 0; NaN where either is
    Less,
    /// 1 where a ≤ b, else 0; NaN where either is
    LessOrEqual,
    /// 1 where a = b, else 0; NaN where either is
    Equal,
    /// b where a is neither zero nor NaN, c where a is zero, NaN where a is
    Select,
}

impl Operation {
    /// The largest exponent that [`Operation::IntegerPower`] takes; the parser makes larger integer powers of several.
    pub const LARGEST_POWER: u32 = 1024;

    /// Every operation, in the order of the table.
    pub fn all() -> impl Iterator<Item = Self> {
        table::ROWS.iter().map(|row| row.operation)
    }

    /// The operation's place in the table, for code that must name it by number.
    pub const fn index(self) -> usize {
        self as usize
    }

    fn row(self) -> &'static Row {
        &table::ROWS[self.index()]
    }

    /// How many operands it takes: 1, 2 or 3.
    pub fn arity(self) -> usize {
        match self.row().value {
            Value::Unary(_) => 1,
            Value::Binary(_) => 2,
            Value::Ternary(_) => 3,
        }
    }

    /// The name by which it is printed.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The names by which formulas call it with all its operands; none for those written as signs.
    pub fn calls(self) -> &'static [&'static str] {
        self.row().calls
    }

    /// Its value in doubles: the reference for every engine.
    pub fn value(self) -> Value {
        self.row().value
    }

    /// Its extension to intervals: the reference for every engine.
    pub fn extension(self) -> Extension {
        self.row().extension
    }

    /// Adds the derivative of a node that applies this operation to the chain's program; `None` where it is zero.
    pub fn derivative(self, chain: &mut Chain<'_>) -> Option<crate::NodeId> {
        (self.row().derivative)(chain)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_stand_in_the_order_of_the_enumeration() {
        for (place, row) in table::ROWS.iter().enumerate() {
            assert_eq!(row.operation.index(), place, "{:?}", row.operation);
        }
        assert_eq!(Operation::Select.index() + 1, table::ROWS.len());
    }

    #[test]
    fn no_two_operations_answer_to_one_call() {
        let mut calls: Vec<_> = Operation::all().flat_map(Operation::calls).collect();
        calls.sort();
        let count = calls.len();
        calls.dedup();
        assert_eq!(calls.len(), count);
    }
}
