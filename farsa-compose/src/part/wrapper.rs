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

    /// Returns true if a motor keeps its last command in the step of the last values.
    fn holds(&self) -> bool {
        false
    }

    /// Returns true if the filter may draw numbers. Noise of other wrappers depends on it.
    fn is_random(&self) -> bool {
        true
    }
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

    /// Returns the number of values that the filter keeps for each channel.
    fn memory(&self) -> usize {
        1
    }

    /// Describes the change for exports, by default by the registered name.
    fn about(&self) -> Option<String> {
        None
    }
}

/// A wrapper of unknown type.
pub(crate) trait AnyWrapper {
    fn filter(&self, channels: usize) -> Result<Box<dyn AnyFilter>, Error>;
    fn memory(&self) -> usize;
    fn about(&self) -> Option<String>;
}

impl<T: WrapperPart> AnyWrapper for T {
    fn filter(&self, channels: usize) -> Result<Box<dyn AnyFilter>, Error> {
        Ok(Box::new(WrapperPart::filter(self, channels)?))
    }

    fn memory(&self) -> usize {
        WrapperPart::memory(self)
    }

    fn about(&self) -> Option<String> {
        WrapperPart::about(self)
    }
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
