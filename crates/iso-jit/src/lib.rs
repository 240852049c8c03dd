//! Compiles programs of iso-expr to native code with Cranelift.
