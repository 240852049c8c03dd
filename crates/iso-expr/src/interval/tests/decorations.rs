//! Known enclosures and decorations, from the definitions of IEEE 1788-2015 (clauses 9.1, 10.5 and 11, and table 9.1).

use super::*;

/// Operation, operands and result. Operands have the decoration that their ends allow.
const CASES: &str = "
    Add           [1, 2] [3, 4]              = [4, 6] common
    Add           [0, 0] [0, 0]              = [0, 0] common
    Add           [1, inf] [1, 2]            = [2, inf] continuous
    Add           [1, 1e308] [0, 1.7e308]    = [1, inf] continuous
    Subtract      [1, 2] [1, 2]              = [-1, 1] common
    Subtract      empty [1, 2]               = empty trivial
    Multiply      [-1, 2] [-3, 4]            = [-6, 8] common
    Multiply      [0, 0] entire              = [0, 0] continuous
    Multiply      [0, 1] [0, inf]            = [0, inf] continuous
    Multiply      [-1, 0] [-1, 0]            = [0, 1] common

    Divide        [1, 2] [4, 8]              = [0.125, 0.5] common
    Divide        [1, 2] [0, 1]              = [1, inf] trivial
    Divide        [1, 2] [-1, 0]             = [-inf, -1] trivial
    Divide        [-2, -1] [0, 1]            = [-inf, -1] trivial
    Divide        [1, 2] [-1, 1]             = entire trivial
    Divide        [0, 1] [0, 1]              = [0, inf] trivial
    Divide        [-1, 1] [0, 1]             = entire trivial
    Divide        [0, 0] [-1, 1]             = [0, 0] trivial
    Divide        [0, 0] [0, 0]              = empty trivial
    Divide        [1, 2] [0, 0]              = empty trivial
    Divide        [1, 2] [4, inf]            = [0, 0.5] continuous
    Divide        [1, inf] [1, inf]          = [0, inf] continuous
    Divide        [-inf, 0] [-inf, 0]        = [0, inf] trivial

    Negate        [-1, 2]                    = [-2, 1] common
    Absolute      [-3, 2]                    = [0, 3] common
    Absolute      [-inf, -2]                 = [2, inf] continuous
    Minimum       [1, 5] [2, 3]              = [1, 3] common
    Maximum       [1, 5] [2, inf]            = [2, inf] continuous

    IntegerPower  [-2, 1] [2, 2]             = [0, 4] common
    IntegerPower  [-2, 1] [3, 3]             = [-8, 1] common
    IntegerPower  [0, 0] [2, 2]              = [0, 0] common
    IntegerPower  entire [2, 2]              = [0, inf] continuous
    IntegerPower  [1, 1e200] [2, 2]          = [1, inf] continuous
    Power         [4, 9] [0.5, 0.5]          = [2, 3] common
    Power         [0, 4] [0.5, 0.5]          = [0, 2] common
    Power         [-1, 4] [0.5, 0.5]         = [0, 2] trivial
    Power         [-2, -1] [2, 2]            = empty trivial
    Power         [0, 2] [-1, -1]            = [0.5, inf] trivial
    Power         [0, 2] [0, 1]              = [0, 2] defined
    Power         [0, 2] [0, 0]              = [1, 1] continuous
    Power         [0, 0] [1, 2]              = [0, 0] common
    Power         [0, 0] [-2, -1]            = empty trivial
    Power         [0, 0] [-1, 1]             = [0, 1] trivial
    Power         [1, 2] entire              = [0, inf] continuous
    SquareRoot    [0, 4]                     = [0, 2] common
    SquareRoot    [-1, 4]                    = [0, 2] trivial
    SquareRoot    [-2, -1]                   = empty trivial
    SquareRoot    [4, inf]                   = [2, inf] continuous
    CubeRoot      [-8, 27]                   = [-2, 3] common
    Hypotenuse    [-3, 3] [4, 4]             = [4, 5] common

    Exp           [-inf, 0]                  = [0, 1] continuous
    Exp           [0, 1000]                  = [1, inf] continuous
    ExpM1         entire                     = [-1, inf] continuous
    Ln            [1, inf]                   = [0, inf] continuous
    Ln            [0, 1]                     = [-inf, 0] trivial
    Ln            [-1, 0]                    = empty trivial
    Log2          [-1, 8]                    = [-inf, 3] trivial
    Log10         [1, 1000]                  = [0, 3] common
    Ln1P          [-1, 0]                    = [-inf, 0] trivial
    Ln1P          [-2, -1]                   = empty trivial
    Tanh          entire                     = [-1, 1] continuous
    Cosh          [-0.0, 0]                  = [1, 1] common
    Cosh          entire                     = [1, inf] continuous
    Asin          [-0, 0]                    = [0, 0] common
    Asin          [-2, 0]                    = [-1.5707963267948968, 0] trivial
    Asin          [2, 3]                     = empty trivial
    Acos          [-1, 1]                    = [0, 3.1415926535897936] common
    Acos          [1, 2]                     = [0, 0] trivial
    Acosh         [1, inf]                   = [0, inf] continuous
    Acosh         [0, 1]                     = [0, 0] trivial
    Acosh         [-1, 0.5]                  = empty trivial
    Atanh         [0, 1]                     = [0, inf] trivial
    Atanh         [1, 2]                     = empty trivial
    Atanh         entire                     = entire trivial

    Sin           [-1, 4]                    = [-0.8414709848078965, 1] common
    Sin           [0, 6.4]                   = [-1, 1] common
    Sin           entire                     = [-1, 1] continuous
    Sin           [1e22, 1e22]               = [-0.8522008497671888, -0.8522008497671888] common
    Cos           [-1, 1]                    = [0.5403023058681398, 1] common
    Cos           [3, 4]                     = [-1, -0.6536436208636119] common
    Tan           [-1, 1]                    = [-1.5574077246549023, 1.5574077246549023] common
    Tan           [1, 2]                     = entire trivial
    Tan           [1.5707963267948966, 1.5707963267948968] = entire trivial
    Tan           [2, 4]                     = [-2.185039863261519, 1.1578212823495775] common

    Atan2         [1, 1] [-1, 1]             = [0.7853981633974483, 2.356194490192345] common
    Atan2         [-1, 1] [-2, -1]           = [-3.1415926535897936, 3.1415926535897936] defined
    Atan2         [-1, 0] [-2, -1]           = [-3.1415926535897936, 3.1415926535897936] defined
    Atan2         [0, 1] [-1, -1]            = [2.356194490192345, 3.1415926535897936] continuous
    Atan2         [0, 0] [-2, -1]            = [3.141592653589793, 3.1415926535897936] continuous
    Atan2         [0, 0] [1, 2]              = [0, 0] common
    Atan2         [-1, 1] [0, 1]             = [-1.5707963267948968, 1.5707963267948968] trivial
    Atan2         [0, 0] [0, 0]              = empty trivial
    Atan2         [-1, 1] [1, 1]             = [-0.7853981633974484, 0.7853981633974484] common
    Atan2         [1, inf] entire            = [0, 3.1415926535897936] continuous

    Floor         [1.25, 1.75]               = [1, 1] common
    Floor         [1, 1.75]                  = [1, 1] continuous
    Floor         [1.25, 2]                  = [1, 2] defined
    Floor         entire                     = entire defined
    Ceil          [1.25, 2]                  = [2, 2] continuous
    Ceil          [-0.5, -0.25]              = [0, 0] common
    Round         [0.75, 1.25]               = [1, 1] common
    Round         [0.5, 0.5]                 = [0, 0] continuous
    Round         [1.5, 2.5]                 = [2, 2] continuous
    Round         [0.5, 1]                   = [0, 1] defined
    Truncate      [-0.5, 0.5]                = [0, 0] common
    Truncate      [1, 1.5]                   = [1, 1] continuous
    Truncate      [-1, -0.5]                 = [-1, 0] defined
    Truncate      [-1.5, -1]                 = [-1, -1] continuous
    Sign          [1, 2]                     = [1, 1] common
    Sign          [0, 0]                     = [0, 0] continuous
    Sign          [0, 1]                     = [0, 1] defined
    Sign          [-1, 1]                    = [-1, 1] defined

    Modulo        [5.25, 5.75] [1, 1]        = [0.25, 0.75] common
    Modulo        [5, 5.75] [1, 1]           = [0, 0.75] continuous
    Modulo        [4.75, 5.25] [1, 1]        = [0, 1] defined
    Modulo        [-0.5, -0.25] [1, 1]       = [0.5, 0.75] common
    Modulo        [0.25, 0.5] [-1, -1]       = [-0.75, -0.5] common
    Modulo        [0.25, 0.5] [1, inf]       = [0.25, 0.5] continuous
    Modulo        [1, 2] [-1, 1]             = [-1, 1] trivial
    Modulo        [1, 2] [0, 0]              = empty trivial
    Modulo        entire [1, 2]              = [0, 2] defined

    Less          [1, 2] [3, 4]              = [1, 1] common
    Less          [1, 2] [2, 3]              = [0, 1] defined
    Less          [2, 3] [1, 2]              = [0, 0] continuous
    Less          [3, 4] [1, 2]              = [0, 0] common
    LessOrEqual   [1, 2] [2, 3]              = [1, 1] continuous
    LessOrEqual   [2, 3] [1, 2]              = [0, 1] defined
    Equal         [1, 1] [1, 1]              = [1, 1] continuous
    Equal         [1, 2] [3, 4]              = [0, 0] common
    Equal         [1, 2] [2, 3]              = [0, 1] defined

    Select        [1, 2] [3, 4] [5, 6]       = [3, 4] common
    Select        [1, 2] [3, inf] empty      = [3, inf] continuous
    Select        [0, 0] [3, 4] [5, 6]       = [5, 6] common
    Select        [0, 1] [3, 4] [5, 6]       = [3, 6] defined
    Select        [0, 1] [3, 4] empty        = [3, 4] trivial
    Select        empty [3, 4] [5, 6]        = empty trivial
";

/// A line of a table: what is computed, and what stands behind the equals sign.
struct Case<'a> {
    text: &'a str,
    operation: Operation,
    operands: Vec<Interval>,
    expected: &'a str,
}

impl<'a> Case<'a> {
    fn all(table: &'a str) -> impl Iterator<Item = Self> {
        table.lines().map(str::trim).filter(|line| !line.is_empty()).map(Self::read)
    }

    fn read(text: &'a str) -> Self {
        let (given, expected) = text.split_once(" = ").expect("a case has a result");
        let (name, operands) = given.split_once(' ').expect("a case has operands");
        let operation = Operation::all()
            .find(|operation| format!("{operation:?}") == name)
            .unwrap_or_else(|| panic!("no operation {name}"));
        let operands = read_intervals(operands);
        assert_eq!(operands.len(), operation.arity(), "{text}");
        Self { text, operation, operands, expected }
    }

    fn run(&self) -> Decorated {
        let operand =
            |place: usize| Decorated::constant(*self.operands.get(place).unwrap_or(&self.operands[0]));
        extend(self.operation, [operand(0), operand(1), operand(2)])
    }

    /// How much wider than the tightest an end may be.
    fn ulps(&self) -> usize {
        match self.operation {
            Operation::IntegerPower => 3 * (self.operands[1].lo as usize - 1),
            _ => 1,
        }
    }
}

#[test]
fn known_cases() {
    for case in Case::all(CASES) {
        let (text, result) = (case.text, case.run());
        let (interval, decoration) = case.expected.rsplit_once(' ').expect("a result has a decoration");
        let tightest = read_intervals(interval)[0];
        assert_eq!(result.decoration.to_string(), decoration, "{text}, found {result}");
        assert!(is_as_tight(result.interval, tightest, case.ulps()), "{text}, found {result}");
    }
}

/// Results without any rounding outwards, so that zeros are not blurred: a square root of a sum of squares would else be
/// undefined on some of every box that touches zero.
const EXACT: &str = "
    Add           [1, 1] [-1, -1]            = [0, 0]
    Subtract      [0.1, 0.1] [0.1, 0.1]      = [0, 0]
    Multiply      [0, 0] [-1, 0.1]           = [0, 0]
    Divide        [0, 0] [-3, -0.1]          = [0, 0]
    IntegerPower  [0, 0] [2, 2]              = [0, 0]
    IntegerPower  [0, 0] [5, 5]              = [0, 0]
    SquareRoot    [0, 0]                     = [0, 0]
    CubeRoot      [0, 0]                     = [0, 0]
    Sin           [0, 0]                     = [0, 0]
    Tan           [0, 0]                     = [0, 0]
    Asin          [0, 0]                     = [0, 0]
    Atan          [0, 0]                     = [0, 0]
    Sinh          [0, 0]                     = [0, 0]
    Tanh          [0, 0]                     = [0, 0]
    Asinh         [0, 0]                     = [0, 0]
    Atanh         [0, 0]                     = [0, 0]
    ExpM1         [0, 0]                     = [0, 0]
    Ln1P          [0, 0]                     = [0, 0]
    Absolute      [-0.3, 0.1]                = [0, 0.3]
    Modulo        [0.1, 0.3] [1, 2]          = [0.1, 0.3]
    Sin           entire                     = [-1, 1]
";

#[test]
fn exact_cases() {
    for case in Case::all(EXACT) {
        assert_eq!(case.run().interval, read_intervals(case.expected)[0], "{}", case.text);
    }
}

/// Whether `found` holds `tightest` and is at most `ulps` wider at each end.
fn is_as_tight(found: Interval, tightest: Interval, ulps: usize) -> bool {
    let widen = |Interval { lo, hi }: Interval| Interval { lo: lo.next_down(), hi: hi.next_up() };
    let widest = (0..ulps).fold(tightest, |widest, _| widen(widest));
    tightest.is_subset_of(found) && found.is_subset_of(widest)
}

/// Reads `[lo, hi]`, `empty` and `entire`, one after the other.
fn read_intervals(text: &str) -> Vec<Interval> {
    let words = text.replace("empty", "[nan, nan]").replace("entire", "[-inf, inf]");
    let read = |text: &str| {
        let (lo, hi) = text.trim().trim_start_matches('[').split_once(',').expect("an interval has two ends");
        let end = |text: &str| text.trim().parse::<f64>().expect("an end is a number");
        Interval::new(end(lo), end(hi)).unwrap_or(Interval::EMPTY)
    };
    words.split(']').filter(|text| !text.trim().is_empty()).map(read).collect()
}

#[test]
fn every_operation_has_a_known_case() {
    // These are monotone and defined everywhere; what is known of them is what is known of Exp or CubeRoot.
    let alike = [Operation::Exp2, Operation::Sinh, Operation::Asinh, Operation::Atan];
    for operation in Operation::all() {
        let has_case = Case::all(CASES).any(|case| case.operation == operation);
        assert!(has_case || alike.contains(&operation), "no case for {operation:?}");
    }
}

#[test]
fn a_condition_must_be_defined_and_is_known_beside_the_box_where_it_is_common() {
    let condition = |decoration| Decorated { interval: Interval { lo: 1.0, hi: 2.0 }, decoration };
    let branch = Decorated::argument(3.0, 4.0);
    let select = |decoration| extend(Operation::Select, [condition(decoration), branch, branch]).decoration;
    assert_eq!(select(Decoration::Common), Decoration::Common);
    assert_eq!(select(Decoration::Continuous), Decoration::Continuous);
    assert_eq!(select(Decoration::Defined), Decoration::Continuous);
    assert_eq!(select(Decoration::Trivial), Decoration::Trivial);
}
