//! Code of an experiment that panics, caught.

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::fmt::Write as _;
use std::panic::{self, AssertUnwindSafe, PanicHookInfo};
use std::sync::Once;

/// Letters of a message that are kept.
const MAX_MESSAGE_CHARS: usize = 300;

thread_local! {
    /// Whether a panic of this thread is caught, so that it need not be printed.
    static WATCHED: Cell<bool> = const { Cell::new(false) };
    /// What the latest panic said.
    static SAID: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Runs `work` and returns what it returns or, if it panics, the message of the panic and its place in the source.
///
/// Nothing is printed. A stack overflow, an allocation that fails and a panic in a program built with `panic = "abort"` end
/// the process all the same.
pub(crate) fn catch_panic<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let before = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if WATCHED.try_with(Cell::get).unwrap_or(false) {
                // A thread that ends has no use for it.
                let _ = SAID.try_with(|said| said.replace(Some(message(info))));
            } else {
                before(info);
            }
        }));
    });
    let before = WATCHED.replace(true);
    let result = catch_printed_panic(work);
    WATCHED.set(before);
    result.map_err(|()| SAID.take().unwrap_or_else(|| "it said nothing".into()))
}

/// Runs `work` and returns what it returns unless it panics, which is printed as usual.
pub(crate) fn catch_printed_panic<T>(work: impl FnOnce() -> T) -> Result<T, ()> {
    let drop_quietly = |payload: Box<dyn Any + Send>| {
        // What a panic carries may panic when it is dropped; what that carries is left alone.
        if let Err(next) = panic::catch_unwind(AssertUnwindSafe(|| drop(payload))) {
            std::mem::forget(next);
        }
    };
    panic::catch_unwind(AssertUnwindSafe(work)).map_err(drop_quietly)
}

/// What a panic says, on one line, and where.
fn message(info: &PanicHookInfo<'_>) -> String {
    let payload = info.payload();
    let said = payload.downcast_ref::<&str>().copied().or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    let words = said.unwrap_or("no words").split_whitespace().collect::<Vec<_>>().join(" ");
    let mut text: String = words.chars().take(MAX_MESSAGE_CHARS).collect();
    if let Some(place) = info.location() {
        // Writing into a string cannot fail.
        let _ = write!(text, " ({}:{})", place.file(), place.line());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::panic_any;

    struct Bomb;

    impl Drop for Bomb {
        fn drop(&mut self) {
            panic!("the second");
        }
    }

    #[test]
    fn panics_become_their_messages() {
        assert_eq!(catch_panic(|| 7), Ok(7));
        let said = catch_panic(|| -> u8 { panic!("as\n planned: {}", 3) }).unwrap_err();
        assert!(said.starts_with("as planned: 3 (") && said.contains("catch_panic.rs:"), "{said}");
        let long = catch_panic(|| -> u8 { panic!("{}", "é".repeat(5000)) }).unwrap_err();
        assert!(long.chars().count() < MAX_MESSAGE_CHARS + 200, "{long}");
        let other = catch_panic(|| -> u8 { panic_any(7_u8) }).unwrap_err();
        assert!(other.starts_with("no words ("), "{other}");
        // The first panic was already caught when what it carries panics.
        assert!(catch_panic(|| -> u8 { panic_any(Bomb) }).is_err());
        let nested = catch_panic(|| catch_panic(|| -> u8 { panic!("inner") }).unwrap_err());
        assert!(nested.is_ok_and(|said| said.starts_with("inner")));
        assert!(!WATCHED.get());
    }
}
