//! Programs as WebAssembly modules of interactive pages.

use crate::live::session::LiveSession;
use crate::run::laboratory::Laboratory;

/// State of a module: its buffer for requests, its last answer and its agent.
///
/// [`live_module!`](crate::live_module) exports these methods.
#[derive(Default)]
pub struct LiveModule {
    input: Vec<u8>,
    output: String,
    session: Option<LiveSession>,
}

impl LiveModule {
    /// Returns a buffer for a text of the given number of bytes.
    pub fn input(&mut self, length: usize) -> *mut u8 {
        self.input = vec![0; length];
        self.input.as_mut_ptr()
    }

    /// Opens the agent of the script in the input, and returns the length of the answer. It is empty, or the text of the
    /// error.
    pub fn open(&mut self, laboratory: &Laboratory<'_>) -> usize {
        let script = self.take_input();
        match LiveSession::open(laboratory, &script) {
            Ok(session) => {
                self.session = Some(session);
                self.store(String::new())
            }
            Err(error) => self.store(error.to_string()),
        }
    }

    /// Answers the request in the input, and returns the length of the answer.
    pub fn answer(&mut self) -> usize {
        let request = self.take_input();
        let answer = self.session.as_mut().map(|session| session.answer(&request));
        self.store(answer.unwrap_or_else(|| r#"{"error":"no agent is open"}"#.into()))
    }

    /// Returns the start of the answer.
    pub fn output(&self) -> *const u8 {
        self.output.as_ptr()
    }

    fn store(&mut self, answer: String) -> usize {
        self.output = answer;
        self.output.len()
    }

    fn take_input(&mut self) -> String {
        String::from_utf8_lossy(&std::mem::take(&mut self.input)).into_owned()
    }
}

/// Exports the functions by which an interactive page runs a laboratory as a WebAssembly module. `$laboratory` is a
/// function that returns the [`Laboratory`](crate::Laboratory).
///
/// Texts are exchanged through memory. `input` returns a buffer for a request. `open` and `answer` consume that buffer
/// and return the length of their answer, which starts at `output`.
#[macro_export]
macro_rules! live_module {
    ($laboratory:path) => {
        const _: () = {
            use std::cell::RefCell;

            use $crate::advanced::LiveModule;

            std::thread_local! {
                static MODULE: RefCell<LiveModule> = RefCell::default();
            }

            // SAFETY: no other function of the module has one of these names.
            #[unsafe(no_mangle)]
            extern "C" fn input(length: usize) -> *mut u8 {
                MODULE.with_borrow_mut(|module| module.input(length))
            }

            // SAFETY: as above.
            #[unsafe(no_mangle)]
            extern "C" fn open() -> usize {
                MODULE.with_borrow_mut(|module| module.open(&$laboratory()))
            }

            // SAFETY: as above.
            #[unsafe(no_mangle)]
            extern "C" fn answer() -> usize {
                MODULE.with_borrow_mut(LiveModule::answer)
            }

            // SAFETY: as above.
            #[unsafe(no_mangle)]
            extern "C" fn output() -> *const u8 {
                MODULE.with_borrow(LiveModule::output)
            }
        };
    };
}

/// Makes a program with the command of a laboratory. Compiled to WebAssembly, the program is the module of its
/// interactive pages.
///
/// `$laboratory` is a function that returns the [`Laboratory`](crate::Laboratory). Where the program is compiled to
/// WebAssembly, this crate has no default features.
///
/// ```
/// use farsa_lab::Laboratory;
///
/// fn laboratory() -> Laboratory<'static> {
///     Laboratory::new(&[])
/// }
///
/// farsa_lab::main!(laboratory);
/// ```
#[macro_export]
macro_rules! main {
    ($laboratory:path) => {
        #[cfg(not(target_family = "wasm"))]
        fn main() -> std::process::ExitCode {
            $laboratory().main()
        }

        #[cfg(target_family = "wasm")]
        fn main() {}

        #[cfg(target_family = "wasm")]
        $crate::live_module!($laboratory);
    };
}
