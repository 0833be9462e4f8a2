//! Panics of an experiment's code, caught.

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::fmt::Write as _;
use std::panic::{self, AssertUnwindSafe, PanicHookInfo};
use std::sync::Once;

/// Letters of a message that are kept.
const MAX_MESSAGE_CHARS: usize = 300;

thread_local! {
    /// True if panics of this thread are caught and not printed.
    static WATCHED: Cell<bool> = const { Cell::new(false) };
    /// Message of the last panic.
    static SAID: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Runs `work` and returns its result, or the message and the place of a panic.
///
/// No message is printed. A stack overflow, a failed allocation and a panic in a program built with `panic = "abort"` still end
/// the process.
pub(crate) fn catch_panic<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let before = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if WATCHED.try_with(Cell::get).unwrap_or(false) {
                // An ending thread does not need the message.
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

/// Runs `work` and returns its result. A panic is printed as usual.
pub(crate) fn catch_printed_panic<T>(work: impl FnOnce() -> T) -> Result<T, ()> {
    let drop_quietly = |payload: Box<dyn Any + Send>| {
        // The payload of a panic may panic when it is dropped. The payload of that panic is leaked.
        if let Err(next) = panic::catch_unwind(AssertUnwindSafe(|| drop(payload))) {
            std::mem::forget(next);
        }
    };
    panic::catch_unwind(AssertUnwindSafe(work)).map_err(drop_quietly)
}

/// Formats the message of a panic on one line, with its place.
fn message(info: &PanicHookInfo<'_>) -> String {
    let payload = info.payload();
    let text = payload.downcast_ref::<&str>().copied().or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    let words = text.unwrap_or("no words").split_whitespace().collect::<Vec<_>>().join(" ");
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
        // The first panic is already caught when its payload panics.
        assert!(catch_panic(|| -> u8 { panic_any(Bomb) }).is_err());
        let nested = catch_panic(|| catch_panic(|| -> u8 { panic!("inner") }).unwrap_err());
        assert!(nested.is_ok_and(|said| said.starts_with("inner")));
        assert!(!WATCHED.get());
    }
}
