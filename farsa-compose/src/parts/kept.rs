//! Layouts of networks of blocks, which borrow theirs.

use std::sync::{Mutex, PoisonError};

use farsa_nn::block::BlockLayoutBuf;

/// A layout that lasts as long as the process: networks borrow theirs, and equal ones share one.
pub(crate) fn kept(layout: BlockLayoutBuf) -> &'static BlockLayoutBuf {
    static KEPT: Mutex<Vec<&BlockLayoutBuf>> = Mutex::new(Vec::new());
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = kept.iter().find(|known| ***known == layout) {
        return known;
    }
    let layout: &'static BlockLayoutBuf = Box::leak(Box::new(layout));
    kept.push(layout);
    layout
}
