//! Machine code in memory, from its making to its release.

use std::sync::{Arc, Mutex, PoisonError};

use cranelift_codegen::Context;
use cranelift_codegen::ir::Signature;
use cranelift_codegen::isa::TargetIsa;
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{Linkage, Module, default_libcall_names};
use iso_expr::CompileError;

use crate::engine::NAME;
use crate::host::Limits;
use crate::refused;
use crate::symbols::{self, Calls};

/// The largest stack frame that a kernel may have, in bytes: a quarter of the stack that threads commonly have.
const LARGEST_FRAME: u32 = 512 << 10;

/// A kernel before it is compiled.
pub(crate) trait Blueprint {
    /// The name in listings.
    const NAME: &'static str;

    /// How large a program it may be made of.
    const LIMITS: Limits;

    /// The compiled function's type, a pointer to a function of the C convention.
    type Function;

    /// Adds parameters and results to an empty signature of the machine's C calling convention.
    fn sign(&self, signature: &mut Signature);

    /// Writes the body, from the entry block, whose parameters are the function's, to the return.
    fn write(&self, builder: &mut FunctionBuilder<'_>, calls: &mut Calls<'_>);

    /// The compiled function.
    ///
    /// # Safety
    /// The code at `start` was compiled from this blueprint, and outlives every call of the function.
    unsafe fn function(&self, start: *const u8) -> Self::Function;
}

/// A compiled function, and the code that it needs for as long as it can be called.
pub(crate) struct Compiled<F> {
    pub(crate) function: F,
    _code: Code,
}

impl<F> Compiled<F> {
    /// Compiles `blueprint` for this process. `context` is an empty one; afterwards it tells what was made.
    pub(crate) fn new(
        isa: &Arc<dyn TargetIsa>,
        context: &mut Context,
        blueprint: &impl Blueprint<Function = F>,
    ) -> Result<Self, CompileError> {
        let mut code = Code::new(isa);
        let start = code.make(context, blueprint)?;
        // SAFETY: the code was made from this very blueprint, and stands beside the function from now on.
        let function = unsafe { blueprint.function(start) };
        Ok(Self { function, _code: code })
    }
}

/// The code of one kernel.
///
/// Its memory is writable while it is made and executable afterwards, never both, and is given back when this is
/// dropped. The module owns the memory; the mutex makes it shareable, though nobody asks it anything but to be dropped.
struct Code(Mutex<Option<JITModule>>);

impl Code {
    fn new(isa: &Arc<dyn TargetIsa>) -> Self {
        let mut builder = JITBuilder::with_isa(Arc::clone(isa), default_libcall_names());
        builder.symbol_lookup_fn(Box::new(symbols::address));
        #[cfg(all(target_os = "linux", target_arch = "x86_64"))]
        builder.memory_provider(Box::new(crate::nearby::Nearby::default()));
        Self(Mutex::new(Some(JITModule::new(builder))))
    }

    /// Writes, compiles and links the kernel; gives where its code begins.
    fn make<B: Blueprint>(
        &mut self,
        context: &mut Context,
        blueprint: &B,
    ) -> Result<*const u8, CompileError> {
        let module = self.0.get_mut().unwrap_or_else(PoisonError::into_inner);
        let module = module.as_mut().expect("the module is there until it is dropped");
        context.func.signature = module.make_signature();
        blueprint.sign(&mut context.func.signature);
        let function = module
            .declare_function(B::NAME, Linkage::Export, &context.func.signature)
            .map_err(|error| refused(&error))?;

        let mut memory = FunctionBuilderContext::new();
        let mut builder = FunctionBuilder::new(&mut context.func, &mut memory);
        let entry = builder.create_block();
        builder.append_block_params_for_function_params(entry);
        builder.switch_to_block(entry);
        blueprint.write(&mut builder, &mut Calls::new(module));
        builder.seal_all_blocks();
        builder.finalize(module.target_config());

        module.define_function(function, context).map_err(|error| refused(&error))?;
        let (given, allowed) = (frame_bytes(context), LARGEST_FRAME);
        if given > allowed {
            return Err(CompileError::FrameTooLarge { engine: NAME, given, allowed });
        }
        module.finalize_definitions().map_err(|error| refused(&error))?;
        Ok(module.get_finalized_function(function))
    }
}

/// The size of the compiled function's stack frame.
pub(crate) fn frame_bytes(context: &Context) -> u32 {
    let code = context.compiled_code().expect("the function is compiled");
    code.buffer.frame_layout().map_or(0, |frame| frame.frame_to_fp_offset)
}

impl Drop for Code {
    fn drop(&mut self) {
        let module = self.0.get_mut().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(module) = module {
            // SAFETY: a compiled function stands beside its code and only the kernel that holds both can call it; this is
            // the end of that kernel.
            unsafe { module.free_memory() };
        }
    }
}
