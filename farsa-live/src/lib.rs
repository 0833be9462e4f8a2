//! The reference experiments as WebAssembly, for the pages of `farsa live`.
//!
//! Texts are exchanged through memory. `input` returns a buffer for a request. `open` and `answer` consume that buffer and
//! return the length of their answer, which starts at `output`.

use std::cell::RefCell;

use farsa_lab::Laboratory;
use farsa_lab::advanced::{ExperimentFiles, LiveSession};

#[derive(Default)]
struct State {
    input: Vec<u8>,
    output: String,
    session: Option<LiveSession>,
}

thread_local! {
    static STATE: RefCell<State> = RefCell::default();
}

impl State {
    /// Stores an answer and returns its length.
    fn store(&mut self, answer: String) -> usize {
        self.output = answer;
        self.output.len()
    }

    fn take_input(&mut self) -> String {
        String::from_utf8_lossy(&std::mem::take(&mut self.input)).into_owned()
    }
}

/// The built-in experiments and those of files. A page only reads files, so it needs no schema and no templates.
fn laboratory() -> Laboratory<'static> {
    let files = ExperimentFiles {
        schema: |_| Ok(String::new()),
        templates: &[],
        crate_with_parts: &[],
        ..farsa_compose::FILES
    };
    Laboratory::new(&farsa_experiments::all()).with_files(files)
}

/// Returns a buffer for a text of the given number of bytes.
// SAFETY: no other function of the module has this name.
#[unsafe(no_mangle)]
pub extern "C" fn input(length: usize) -> *mut u8 {
    STATE.with_borrow_mut(|state| {
        state.input = vec![0; length];
        state.input.as_mut_ptr()
    })
}

/// Opens the agent of the script in the input. The answer is empty, or the text of the error.
// SAFETY: as above.
#[unsafe(no_mangle)]
pub extern "C" fn open() -> usize {
    STATE.with_borrow_mut(|state| {
        let script = state.take_input();
        match LiveSession::open(&laboratory(), &script) {
            Ok(session) => {
                state.session = Some(session);
                state.store(String::new())
            }
            Err(error) => state.store(error.to_string()),
        }
    })
}

/// Answers the request in the input.
// SAFETY: as above.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> usize {
    STATE.with_borrow_mut(|state| {
        let request = state.take_input();
        let answer = state.session.as_mut().map(|session| session.answer(&request));
        state.store(answer.unwrap_or_else(|| r#"{"error":"no agent is open"}"#.into()))
    })
}

/// Returns the start of the answer.
// SAFETY: as above.
#[unsafe(no_mangle)]
pub extern "C" fn output() -> *const u8 {
    STATE.with_borrow(|state| state.output.as_ptr())
}
