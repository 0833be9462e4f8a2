//! Changes of texts: those of the fuzzer, and sometimes a part repeated many times, to find costs that grow faster than the
//! input.

use libfuzzer_sys::fuzzer_mutate;

/// Changes the first `size` bytes of `data` and returns how many there are then, at most `most`.
pub fn mutated(data: &mut [u8], size: usize, most: usize, seed: u32) -> usize {
    if seed % 16 > 0 || size == 0 {
        return fuzzer_mutate(data, size, most);
    }
    // Separate random numbers, so that the next draws of the library are unchanged.
    let mut state = seed | 1;
    let mut draw = |below: usize| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as usize % below.max(1)
    };
    let lines: Vec<usize> =
        std::iter::once(0).chain((0..size).filter(|at| data[*at] == b'\n').map(|at| at + 1)).collect();
    // Whole lines where there are some, else any part.
    let (start, end) = if lines.len() > 2 {
        let first = draw(lines.len() - 1);
        (lines[first], lines[(first + 1 + draw(4)).min(lines.len() - 1)])
    } else {
        let start = draw(size);
        (start, (start + 1 + draw(64)).min(size))
    };
    let part = data[start..end].to_vec();
    let rest = data[end..size].to_vec();
    let room = most.saturating_sub(size) / part.len().max(1);
    let times = (1 << draw(12)).min(room);
    let mut at = end;
    for _ in 0..times {
        data[at..at + part.len()].copy_from_slice(&part);
        at += part.len();
    }
    data[at..at + rest.len()].copy_from_slice(&rest);
    at + rest.len()
}

/// Has the fuzzer change texts by [`mutated`].
#[macro_export]
macro_rules! text {
    () => {
        libfuzzer_sys::fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
            $crate::mutated(data, size, max_size, seed)
        });
    };
}
