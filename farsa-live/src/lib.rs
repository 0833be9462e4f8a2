//! The reference experiments as WebAssembly, for the pages of `farsa live`.
//!
//! Texts go in and come out through memory: `input` gives room for one, `open` and `answer` take what was written there and say
//! how long their answer is, which `output` points to.

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
    /// Keeps an answer and says how long it is.
    fn say(&mut self, answer: String) -> usize {
        self.output = answer;
        self.output.len()
    }

    fn taken(&mut self) -> String {
        String::from_utf8_lossy(&std::mem::take(&mut self.input)).into_owned()
    }
}

/// The experiments, and those that files describe: to read them is all that a page wants of files.
fn laboratory() -> Laboratory<'static> {
    let files = ExperimentFiles { schema: String::new, templates: &[], ..farsa_compose::FILES };
    Laboratory::new(&farsa_experiments::all()).with_files(files)
}

/// Room for a text of so many bytes.
// SAFETY: no other function of the module has this name.
#[unsafe(no_mangle)]
pub extern "C" fn input(length: usize) -> *mut u8 {
    STATE.with_borrow_mut(|state| {
        state.input = vec![0; length];
        state.input.as_mut_ptr()
    })
}

/// Opens the agent of the script that is the input; the answer is empty, or says what is wrong.
// SAFETY: as above.
#[unsafe(no_mangle)]
pub extern "C" fn open() -> usize {
    STATE.with_borrow_mut(|state| {
        let script = state.taken();
        match LiveSession::open(&laboratory(), &script) {
            Ok(session) => {
                state.session = Some(session);
                state.say(String::new())
            }
            Err(error) => state.say(error.to_string()),
        }
    })
}

/// Answers the request that is the input.
// SAFETY: as above.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> usize {
    STATE.with_borrow_mut(|state| {
        let request = state.taken();
        let answer = state.session.as_mut().map(|session| session.answer(&request));
        state.say(answer.unwrap_or_else(|| r#"{"error":"no agent is open"}"#.into()))
    })
}

/// Where the answer is.
// SAFETY: as above.
#[unsafe(no_mangle)]
pub extern "C" fn output() -> *const u8 {
    STATE.with_borrow(|state| state.output.as_ptr())
}
