//! A reader of xz as WebAssembly, for the pages of `farsa live`.
//!
//! The file goes in through memory, where `input` gives room for it; `unpack` says how many bytes it has become, which `output` points
//! to.

use std::cell::RefCell;

#[derive(Default)]
struct State {
    input: Vec<u8>,
    output: Vec<u8>,
}

thread_local! {
    static STATE: RefCell<State> = RefCell::default();
}

/// Room for a file of so many bytes.
// SAFETY: no other function of the module has this name.
#[unsafe(no_mangle)]
pub extern "C" fn input(length: usize) -> *mut u8 {
    STATE.with_borrow_mut(|state| {
        state.input = vec![0; length];
        state.input.as_mut_ptr()
    })
}

/// Unpacks the file that is the input; 0 where it is none.
// SAFETY: as above.
#[unsafe(no_mangle)]
pub extern "C" fn unpack() -> usize {
    STATE.with_borrow_mut(|state| {
        let input = std::mem::take(&mut state.input);
        state.output.clear();
        match lzma_rs::xz_decompress(&mut &input[..], &mut state.output) {
            Ok(()) => state.output.len(),
            Err(_) => 0,
        }
    })
}

/// Where what it has become is.
// SAFETY: as above.
#[unsafe(no_mangle)]
pub extern "C" fn output() -> *const u8 {
    STATE.with_borrow(|state| state.output.as_ptr())
}
