//! The rows of the table of operations.

use super::{Chain, Operation, Value, derivative, value};
use crate::NodeId;
use crate::interval::{Extension, extension};

/// All that is known of one operation.
pub(super) struct Row {
    pub(super) operation: Operation,
    /// How it is printed.
    pub(super) name: &'static str,
    /// How formulas call it.
    pub(super) calls: &'static [&'static str],
    pub(super) value: Value,
    pub(super) extension: Extension,
    pub(super) derivative: fn(&mut Chain<'_>) -> Option<NodeId>,
}

macro_rules! rows {
    ($($operation:ident $arity:ident $name:literal [$($call:literal)*] $function:ident;)*) => {
        &[$(Row {
            operation: Operation::$operation,
            name: $name,
            calls: &[$($call),*],
            value: Value::$arity(value::$function),
            extension: Extension::$arity(extension::$function),
            derivative: derivative::$function,
        }),*]
    };
}

/// One row for each operation, in the order of [`Operation`]. The last column names the three functions that give its
/// value, its interval extension and its derivative, each in the module of that name.
pub(super) static ROWS: &[Row] = rows! {
    // operation   arity   printed       called by            functions
    Add            Binary  "+"           []                   add;
    Subtract       Binary  "-"           []                   subtract;
    Multiply       Binary  "*"           []                   multiply;
    Divide         Binary  "/"           []                   divide;
    Negate         Unary   "negate"      []                   negate;
    Absolute       Unary   "abs"         ["abs"]              absolute;
    Sign           Unary   "sign"        ["sign" "sgn"]       sign;
    Minimum        Binary  "min"         []                   minimum;
    Maximum        Binary  "max"         []                   maximum;
    IntegerPower   Binary  "^"           []                   integer_power;
    Power          Binary  "pow"         []                   power;
    SquareRoot     Unary   "sqrt"        ["sqrt"]             square_root;
    CubeRoot       Unary   "cbrt"        ["cbrt"]             cube_root;
    Hypotenuse     Binary  "hypot"       ["hypot"]            hypotenuse;
    Exp            Unary   "exp"         ["exp"]              exp;
    Exp2           Unary   "exp2"        ["exp2"]             exp2;
    ExpM1          Unary   "expm1"       ["expm1"]            exp_m1;
    Ln             Unary   "ln"          ["ln"]               ln;
    Log2           Unary   "log2"        ["log2"]             log2;
    Log10          Unary   "log10"       ["log10"]            log10;
    Ln1P           Unary   "log1p"       ["log1p"]            ln_1p;
    Sin            Unary   "sin"         ["sin"]              sin;
    Cos            Unary   "cos"         ["cos"]              cos;
    Tan            Unary   "tan"         ["tan"]              tan;
    Asin           Unary   "asin"        ["asin" "arcsin"]    asin;
    Acos           Unary   "acos"        ["acos" "arccos"]    acos;
    Atan           Unary   "atan"        ["atan" "arctan"]    atan;
    Atan2          Binary  "atan2"       ["atan2" "arctan2"]  atan2;
    Sinh           Unary   "sinh"        ["sinh"]             sinh;
    Cosh           Unary   "cosh"        ["cosh"]             cosh;
    Tanh           Unary   "tanh"        ["tanh"]             tanh;
    Asinh          Unary   "asinh"       ["asinh" "arcsinh" "arsinh"]  asinh;
    Acosh          Unary   "acosh"       ["acosh" "arccosh" "arcosh"]  acosh;
    Atanh          Unary   "atanh"       ["atanh" "arctanh" "artanh"]  atanh;
    Floor          Unary   "floor"       ["floor"]            floor;
    Ceil           Unary   "ceil"        ["ceil"]             ceil;
    Round          Unary   "round"       ["round"]            round;
    Truncate       Unary   "trunc"       ["trunc"]            truncate;
    Modulo         Binary  "mod"         ["mod"]              modulo;
    Less           Binary  "<"           []                   less;
    LessOrEqual    Binary  "<="          []                   less_or_equal;
    Equal          Binary  "=="          []                   equal;
    Select         Ternary "if"          ["if"]               select;
};
