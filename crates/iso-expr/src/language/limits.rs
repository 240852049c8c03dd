//! What a formula may ask for at most. Every limit is far above what a surface needs, and keeps time and memory bounded.

/// The longest text, in bytes.
pub const LARGEST_TEXT: usize = 1 << 20;

/// The longest text of a model, in bytes.
pub const LARGEST_MODEL: usize = 8 << 20;

/// How deep parentheses, calls, bars and root signs may stand inside each other.
pub const DEEPEST_NESTING: usize = 256;

/// The most operations of a lowered program.
pub const MOST_OPERATIONS: usize = 100_000;

/// The most terms that lowering visits, each call of a function anew: definitions that call each other may multiply a
/// short text into endless work without adding one operation.
pub const MOST_STEPS: usize = 1 << 22;
