//! A bound on the memory of a reader, by an allocator that counts.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::Once;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use toml_parser::Source;
use toml_parser::lexer::TokenKind;

/// Bytes that any reader may take.
const SPARE: usize = 1 << 20;
/// Bytes that it may take for each byte of its input.
const EACH: usize = 16;
/// Additional bytes for each token of TOML, for the tree of the crate `toml`. See [`bounded_toml`].
const EACH_TOKEN: usize = 128;
/// Additional bytes for a point, `=` and `[`, which begin a table. Its first key reserves space for eleven. A part of an
/// experiment (`[[sensors]]`) takes as much for all settings of such a part.
const EACH_OF_TABLES: usize = 1200;

struct Counting;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

static NOW: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);
/// The largest share of the limit so far: bytes taken, bytes of the input, and the share in thousandths.
static MOST: [AtomicUsize; 3] = [const { AtomicUsize::new(0) }; 3];
static AT_EXIT: Once = Once::new();

fn grown(bytes: usize) {
    let now = NOW.fetch_add(bytes, Relaxed).wrapping_add(bytes);
    PEAK.fetch_max(now, Relaxed);
}

// SAFETY: all calls go to the system's allocator, and the rest only changes numbers.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        grown(layout.size());
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        grown(layout.size());
        // SAFETY: as the caller promises.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(place, layout) }
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if size >= layout.size() {
            grown(size - layout.size());
        } else {
            NOW.fetch_sub(layout.size() - size, Relaxed);
        }
        // SAFETY: as the caller promises.
        unsafe { System.realloc(place, layout, size) }
    }
}

// SAFETY: this function of C has this signature (C11, 7.22.4.2). It may be called at any time with a function that does not
// unwind, and `tell` only reads numbers and writes a line.
unsafe extern "C" {
    safe fn atexit(done: extern "C" fn()) -> i32;
}

extern "C" fn tell() {
    let [used, input, share] = MOST.each_ref().map(|number| number.load(Relaxed));
    let share = share as f64 / 10.0;
    eprintln!("most memory: {used} bytes at once for an input of {input} bytes, {share} % of what is allowed");
}

/// Runs a reader of an input with the given number of bytes.
///
/// # Panics
/// When it takes more than 16 times as many bytes at once, and 1 MiB.
pub fn bounded<T>(input: usize, read: impl FnOnce() -> T) -> T {
    bounded_by(input, || 0, read)
}

/// Runs a reader of TOML, whose tree takes memory for each token.
///
/// # Panics
/// When it takes more than that, 128 bytes for each token and 1200 for one that can begin a table.
pub fn bounded_toml<T>(text: &str, read: impl FnOnce() -> T) -> T {
    bounded_by(text.len(), || tree(text), read)
}

/// Returns the bytes that the tree of a text may take. The definition of an experiment is a string of several lines, which is
/// read as a separate text.
fn tree(text: &str) -> usize {
    let tokens = Source::new(text).lex().map(|token| match token.kind() {
        TokenKind::Dot | TokenKind::Equals | TokenKind::LeftSquareBracket => EACH_OF_TABLES,
        TokenKind::MlBasicString | TokenKind::MlLiteralString => {
            let span = token.span();
            // The text within the quotes is shorter, so this ends.
            EACH_TOKEN + tree(text[span.start()..span.end()].trim_matches(['"', '\'']))
        }
        _ => EACH_TOKEN,
    });
    tokens.sum()
}

fn bounded_by<T>(input: usize, more: impl FnOnce() -> usize, read: impl FnOnce() -> T) -> T {
    AT_EXIT.call_once(|| {
        atexit(tell);
    });
    let before = NOW.load(Relaxed);
    PEAK.store(before, Relaxed);
    let result = read();
    let used = PEAK.load(Relaxed).saturating_sub(before);
    let mut allowed = input.saturating_mul(EACH).saturating_add(SPARE);
    let share = |allowed: usize| used.saturating_mul(1000) / allowed;
    // Counting tokens takes time, so they are only counted when the result can matter.
    if used > allowed || share(allowed) > MOST[2].load(Relaxed) {
        allowed = allowed.saturating_add(more());
    }
    if share(allowed) > MOST[2].load(Relaxed) {
        for (most, number) in MOST.iter().zip([used, input, share(allowed)]) {
            most.store(number, Relaxed);
        }
    }
    assert!(used <= allowed, "an input of {input} bytes took {used} bytes at once, where {allowed} are allowed");
    result
}
