//! Layouts of block networks with a static lifetime, because networks borrow their layout.

use std::sync::{Mutex, PoisonError};

use farsa_nn::block::BlockLayoutBuf;

/// Leaks a layout, once for all equal ones.
pub(crate) fn static_layout(layout: BlockLayoutBuf) -> &'static BlockLayoutBuf {
    static LAYOUTS: Mutex<Vec<&BlockLayoutBuf>> = Mutex::new(Vec::new());
    let mut layouts = LAYOUTS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(equal) = layouts.iter().find(|other| ***other == layout) {
        return equal;
    }
    let layout: &'static BlockLayoutBuf = Box::leak(Box::new(layout));
    layouts.push(layout);
    layout
}
