//! Functions of this process that native code calls: the values and extensions of operations that are not written out.

use std::collections::HashMap;

use cranelift_codegen::ir::{AbiParam, FuncRef, Function, Signature, types};
use cranelift_jit::JITModule;
use cranelift_module::{Linkage, Module};
use iso_expr::{Operation, Value};

use crate::{elementary, host, trampoline};

/// Begins the name of every function that native code calls, so that none is taken for another library's.
const PREFIX: &str = "iso_";

/// Begins the name of every function of several doubles at once.
const IN_LANES: &str = "iso_lanes_";

/// The function of the sines and cosines of several doubles.
const BOTH_IN_LANES: &str = "iso_both_in_lanes";

/// The function that applies interval extensions.
const EXTEND: &str = "iso_extend";

/// The function that applies interval extensions by values at the ends.
const EXTEND_BY_ENDS: &str = "iso_extend_by_ends";

/// The function that applies the extensions of sine and cosine.
const EXTEND_TO_BOTH: &str = "iso_extend_to_both";

/// The address of the function called `name`, if it is one of ours.
pub(crate) fn address(name: &str) -> Option<*const u8> {
    if name == EXTEND {
        return Some(trampoline::extend as *const u8);
    }
    if name == EXTEND_BY_ENDS {
        return Some(trampoline::extend_by_ends as *const u8);
    }
    if name == EXTEND_TO_BOTH {
        return Some(trampoline::extend_to_both as *const u8);
    }
    if name == BOTH_IN_LANES {
        return elementary::both_of_eight().map(|function| function as *const u8);
    }
    if let Some(name) = name.strip_prefix(IN_LANES) {
        return elementary::function(operation(name)?).map(|function| function as *const u8);
    }
    Some(match operation(name.strip_prefix(PREFIX)?)?.value() {
        Value::Unary(function) => function as *const u8,
        Value::Binary(function) => function as *const u8,
        Value::Ternary(function) => function as *const u8,
    })
}

/// The operation called `name`.
fn operation(name: &str) -> Option<Operation> {
    Operation::all().find(|operation| format!("{operation:?}") == name)
}

/// The functions that one kernel calls, declared as they are first needed.
pub(crate) struct Calls<'a> {
    module: &'a mut JITModule,
    declared: HashMap<String, FuncRef>,
    /// Whether the machine rounds doubles to integers without a call.
    pub(crate) rounds_natively: bool,
}

impl<'a> Calls<'a> {
    /// No functions yet.
    pub(crate) fn new(module: &'a mut JITModule) -> Self {
        let rounds_natively = host::rounds_natively(module.isa());
        Self { module, declared: HashMap::new(), rounds_natively }
    }

    /// The function that gives the value of `operation`, to be called from `kernel`.
    pub(crate) fn value(&mut self, kernel: &mut Function, operation: Operation) -> FuncRef {
        let operands = vec![AbiParam::new(types::F64); operation.arity()];
        self.declare(kernel, format!("{PREFIX}{operation:?}"), operands, vec![AbiParam::new(types::F64)])
    }

    /// The function that puts values of `operation` in the place of [`elementary::WIDTH`] arguments, if there is one, to be
    /// called from `kernel`.
    pub(crate) fn in_lanes(&mut self, kernel: &mut Function, operation: Operation) -> Option<FuncRef> {
        elementary::function(operation)?;
        let pointer = AbiParam::new(types::I64);
        Some(self.declare(kernel, format!("{IN_LANES}{operation:?}"), vec![pointer], Vec::new()))
    }

    /// The function that puts sines of [`elementary::WIDTH`] arguments in their place and cosines behind them, if there is one, to
    /// be called from `kernel`.
    pub(crate) fn both_in_lanes(&mut self, kernel: &mut Function) -> Option<FuncRef> {
        elementary::both_of_eight()?;
        let pointer = AbiParam::new(types::I64);
        Some(self.declare(kernel, BOTH_IN_LANES.to_owned(), vec![pointer], Vec::new()))
    }

    /// [`trampoline::extend`], to be called from `kernel`.
    pub(crate) fn extend(&mut self, kernel: &mut Function) -> FuncRef {
        let pointer = AbiParam::new(types::I64);
        let operands = vec![AbiParam::new(types::I8).uext(), pointer, pointer];
        self.declare(kernel, EXTEND.to_owned(), operands, Vec::new())
    }

    /// [`trampoline::extend_by_ends`], to be called from `kernel`.
    pub(crate) fn extend_by_ends(&mut self, kernel: &mut Function) -> FuncRef {
        let pointer = AbiParam::new(types::I64);
        let operands = vec![AbiParam::new(types::I8).uext(), pointer, pointer, pointer];
        self.declare(kernel, EXTEND_BY_ENDS.to_owned(), operands, Vec::new())
    }

    /// [`trampoline::extend_to_both`], to be called from `kernel`.
    pub(crate) fn extend_to_both(&mut self, kernel: &mut Function) -> FuncRef {
        let operands = vec![AbiParam::new(types::I64); 2];
        self.declare(kernel, EXTEND_TO_BOTH.to_owned(), operands, Vec::new())
    }

    fn declare(
        &mut self,
        kernel: &mut Function,
        name: String,
        params: Vec<AbiParam>,
        returns: Vec<AbiParam>,
    ) -> FuncRef {
        if let Some(function) = self.declared.get(&name) {
            return *function;
        }
        let signature = Signature { params, returns, ..self.module.make_signature() };
        let function = self.module.declare_function(&name, Linkage::Import, &signature);
        let function = self.module.declare_func_in_func(function.expect("a name has one signature"), kernel);
        self.declared.insert(name, function);
        function
    }
}
