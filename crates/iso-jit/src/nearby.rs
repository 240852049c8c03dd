//! Memory for code, near the code of this program.
//!
//! By default, Linux gives memory that is terabytes away from the program. A call to a place whose address differs from the caller's in bit 37 or
//! a higher one takes three cycles longer on AMD's Zen 4 than one to a nearer place, as measured by loops of calls: a third of what the
//! call of a small kernel takes.
//!
//! So memory is asked for below the program. That is a wish, not a demand: where something stands already, the system gives other
//! memory, and code runs there too.

use std::ffi::c_void;
use std::io;
use std::ptr::{self, NonNull};
use std::sync::atomic::{AtomicUsize, Ordering};

use cranelift_jit::{BranchProtection, JITMemoryKind, JITMemoryProvider};
use cranelift_module::{ModuleError, ModuleResult};
use rustix::mm::{MapFlags, MprotectFlags, ProtFlags, mmap_anonymous, mprotect, munmap};

/// The size of the processor's pages.
const PAGE: usize = 4096;

/// How far below this program's code the memory ends: more than programs are long, and so much less than 2³⁷ that bit 37 is
/// seldom another one.
const DISTANCE: usize = 1 << 30;

/// Over how many bytes the memory is spread before it begins anew: more than is in use at a time.
const SPREAD: usize = 1 << 30;

/// How many bytes all of this program's code took so far, what was given back included.
static TAKEN: AtomicUsize = AtomicUsize::new(0);

/// The memory of one module, kept until it is [freed](JITMemoryProvider::free_memory).
#[derive(Default)]
pub(crate) struct Nearby(Vec<Pages>);

/// Pages that this process mapped, and what they are for.
struct Pages {
    start: NonNull<c_void>,
    bytes: usize,
    kind: JITMemoryKind,
}

// SAFETY: any thread may use mapped memory, and change and end the mapping.
unsafe impl Send for Pages {}

impl Pages {
    /// New pages, writable so far.
    fn new(bytes: usize, kind: JITMemoryKind) -> io::Result<Self> {
        let bytes = bytes.max(1).next_multiple_of(PAGE);
        let wish = wish(TAKEN.fetch_add(bytes, Ordering::Relaxed));
        let access = ProtFlags::READ | ProtFlags::WRITE;
        // SAFETY: without `MapFlags::FIXED`, the address is a wish, and no other mapping is touched.
        let start = unsafe { mmap_anonymous(wish, bytes, access, MapFlags::PRIVATE) }?;
        let start = NonNull::new(start).ok_or(io::ErrorKind::OutOfMemory)?;
        Ok(Self { start, bytes, kind })
    }

    /// Allows what the pages are for, and nothing else.
    fn protect(&self) -> io::Result<()> {
        let access = match self.kind {
            JITMemoryKind::Executable => MprotectFlags::READ | MprotectFlags::EXEC,
            JITMemoryKind::ReadOnly => MprotectFlags::READ,
            JITMemoryKind::Writable => return Ok(()),
        };
        // SAFETY: the pages are this one's own, and nobody writes to them once they are finished.
        unsafe { mprotect(self.start.as_ptr(), self.bytes, access) }?;
        Ok(())
    }
}

/// Where to ask for memory after `taken` bytes: null where no address is below the program.
fn wish(taken: usize) -> *mut c_void {
    let code = wish as fn(usize) -> *mut c_void as usize / PAGE * PAGE;
    code.checked_sub(DISTANCE + SPREAD)
        .map_or(ptr::null_mut(), |lowest| ptr::without_provenance_mut(lowest + taken % SPREAD))
}

impl JITMemoryProvider for Nearby {
    /// Gives pages of their own to every function. Kernels are single functions.
    fn allocate(&mut self, size: usize, align: u64, kind: JITMemoryKind) -> io::Result<*mut u8> {
        assert!(align <= PAGE as u64, "pages are aligned to their size");
        let pages = Pages::new(size, kind)?;
        let start = pages.start.as_ptr().cast();
        self.0.push(pages);
        Ok(start)
    }

    unsafe fn free_memory(&mut self) {
        for Pages { start, bytes, .. } in self.0.drain(..) {
            // SAFETY: the pages are this one's own, and the caller says that nobody uses them any more. Were they not given back,
            // they would be lost, no more.
            let _ = unsafe { munmap(start.as_ptr(), bytes) };
        }
    }

    /// x86 needs nothing else: what is written is what all its cores execute. Branch protection is for other processors.
    fn finalize(&mut self, _: BranchProtection) -> ModuleResult<()> {
        self.0.iter().try_for_each(Pages::protect).map_err(|err| ModuleError::Allocation { err })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether something stands where it was wished for.
    fn is_near(address: *const u8) -> bool {
        (wish(0).addr()..wish(SPREAD - PAGE).addr()).contains(&address.addr())
    }

    #[test]
    fn code_is_near_the_program_and_runs() {
        let mut memory = Nearby::default();
        // mov eax, 42; ret
        let code = [0xb8, 42, 0, 0, 0, 0xc3];
        let starts: Vec<_> = [1, 9, 3]
            .into_iter()
            .map(|pages| {
                let start = memory.allocate(pages * PAGE, 16, JITMemoryKind::Executable).unwrap();
                assert!(is_near(start), "{start:p}");
                // SAFETY: there is room for so many bytes.
                unsafe { start.copy_from_nonoverlapping(code.as_ptr(), code.len()) };
                start
            })
            .collect();
        memory.finalize(BranchProtection::None).unwrap();
        for start in starts {
            // SAFETY: the code has the C convention and this type.
            let function: extern "C" fn() -> i32 = unsafe { std::mem::transmute(start) };
            assert_eq!(function(), 42);
        }
        // SAFETY: nobody calls it any more.
        unsafe { memory.free_memory() };
    }

    #[test]
    fn what_stands_at_the_wished_place_stays() {
        let place = wish(SPREAD / 2);
        let access = ProtFlags::READ | ProtFlags::WRITE;
        let mut starts = Vec::new();
        for value in 1..=3_u8 {
            // SAFETY: the address is a wish.
            let start = unsafe { mmap_anonymous(place, PAGE, access, MapFlags::PRIVATE) }.unwrap();
            // SAFETY: the page is writable.
            unsafe { start.cast::<u8>().write(value) };
            starts.push((start, value));
        }
        assert_eq!(starts[0].0, place);
        for (start, value) in starts {
            // SAFETY: the page is there until it is given back, which nobody else does.
            unsafe {
                assert_eq!(start.cast::<u8>().read(), value);
                munmap(start, PAGE).unwrap();
            }
        }
    }

    #[test]
    fn wishes_begin_anew_and_are_of_whole_pages() {
        assert_eq!(wish(SPREAD + PAGE), wish(PAGE));
        assert_eq!(wish(0).addr() % PAGE, 0);
        assert_eq!(wish(SPREAD - PAGE).addr() - wish(0).addr(), SPREAD - PAGE);
    }
}
