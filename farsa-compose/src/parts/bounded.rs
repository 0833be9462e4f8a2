//! The sizes of networks.

use farsa_lab::Error;

/// The most parameters of a network, and the most values of its state. Fewer where readers are fuzzed, whose memory is to be
/// bounded by the length of a text: a few letters ask for a network of this size.
const MOST_VALUES: usize = if cfg!(fuzzing) { 2000 } else { 1_000_000 };

/// Refuses networks that would fill the memory.
///
/// # Errors
/// [`Error::Other`] with both numbers.
pub(crate) fn bounded(parameters: usize, state: usize) -> Result<(), Error> {
    for (what, count) in [("parameters", parameters), ("values to remember", state)] {
        if count > MOST_VALUES {
            return Err(Error::Other(format!("has {count} {what}; at most {MOST_VALUES} make a network")));
        }
    }
    Ok(())
}
