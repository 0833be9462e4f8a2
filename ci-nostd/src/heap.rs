//! An allocator that hands out a fixed block from the front and takes nothing back.

use core::alloc::{GlobalAlloc, Layout};
use core::cell::UnsafeCell;
use core::ptr;
use core::sync::atomic::{AtomicUsize, Ordering};

const SIZE: usize = 8 << 20;

struct Heap {
    block: UnsafeCell<[u8; SIZE]>,
    used: AtomicUsize,
}

#[global_allocator]
static HEAP: Heap = Heap { block: UnsafeCell::new([0; SIZE]), used: AtomicUsize::new(0) };

/// Allocated bytes.
pub fn used() -> usize {
    HEAP.used.load(Ordering::Relaxed)
}

// SAFETY: the block is reached only through `alloc`, which gives every byte away once.
unsafe impl Sync for Heap {}

// SAFETY: `alloc` returns aligned, disjoint parts of the block, or null when it is used up.
unsafe impl GlobalAlloc for Heap {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let start = self.block.get().cast::<u8>();
        let mut taken = ptr::null_mut();
        let _ = self.used.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |used| {
            let skip = start.wrapping_add(used).align_offset(layout.align());
            let from = used.checked_add(skip)?;
            let end = from.checked_add(layout.size()).filter(|end| *end <= SIZE)?;
            taken = start.wrapping_add(from);
            Some(end)
        });
        taken
    }

    unsafe fn dealloc(&self, _: *mut u8, _: Layout) {}
}
