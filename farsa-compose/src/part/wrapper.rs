//! Wrappers.

use std::fmt;

use farsa_lab::Error;
use farsa_num::Stream;

use crate::part::keys::Keys;

/// A change of values on their way from a sensor or to a motor.
pub trait Filter {
    /// Resets the state at the start of a trial.
    fn reset(&mut self) {}

    /// Changes the values of all channels. `noise` is a random stream of this wrapper alone, of which a step may take
    /// 8 numbers per channel.
    fn pass(&mut self, values: &mut [f32], noise: &mut Stream);
}

/// A custom kind of wrapper. Its fields are the keys of the file.
pub trait WrapperPart: Keys {
    /// The filter of the values.
    type Filter: Filter + Clone + Send + 'static;

    /// Builds the filter for a sensor or motor of this number of channels.
    ///
    /// # Errors
    /// Returns an error if the filter cannot have these channels.
    fn filter(&self, channels: usize) -> Result<Self::Filter, Error>;
}

/// A filter of unknown type.
pub(crate) trait AnyFilter: Filter + Send {
    /// Clones the filter.
    fn boxed(&self) -> Box<dyn AnyFilter>;
}

impl<T: Filter + Clone + Send + 'static> AnyFilter for T {
    fn boxed(&self) -> Box<dyn AnyFilter> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn AnyFilter> {
    fn clone(&self) -> Self {
        (**self).boxed()
    }
}

impl fmt::Debug for dyn AnyFilter {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("AnyFilter")
    }
}
