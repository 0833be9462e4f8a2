//! A controller as a header and a source file in C99.

mod arithmetic;
mod blocks;
mod calls;
mod channels;
mod code;
mod integers;
mod reals;
mod rows;
mod source;

use crate::error::Error;
use crate::experiment::controller_export::ControllerExport;
pub use crate::export::c::source::CFiles;
use crate::export::c::source::Source;

impl ControllerExport {
    /// Writes the network in single precision, with the bits of the Rust network.
    ///
    /// `name` begins every public name in C, and `about` the comment of the header.
    ///
    /// # Errors
    /// Returns [`Error::Usage`] for an invalid name and for outputs that exceed single precision in the self-test, and
    /// [`Error::Other`] if the parameters do not fit the network.
    pub fn c(&self, name: &str, about: &str) -> Result<CFiles, Error> {
        self.check(name)?;
        let code = reals::code(&self.network)?;
        let rows = rows::reals(&self.network)?;
        Ok(Source { name, about, controller: self, code, rows }.files())
    }

    /// Writes a leaky network in integers, with the bits of [`farsa_nn::quantized::QuantizedNetwork`].
    ///
    /// Inputs have 9 fraction bits, which cover \[-64, 64).
    ///
    /// # Errors
    /// Returns [`Error::Usage`] for an invalid name, for another kind of network, and for weights whose sums exceed 32
    /// bits.
    pub fn c_integers(&self, name: &str, about: &str) -> Result<CFiles, Error> {
        self.check(name)?;
        let network = integers::Quantized::new(&self.network)?;
        let (code, rows) = (network.code(), network.rows()?);
        Ok(Source { name, about, controller: self, code, rows }.files())
    }

    /// Checks that a name begins an identifier of C, and that every input and output has a name.
    fn check(&self, name: &str) -> Result<(), Error> {
        let letters = name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
        if !letters || !name.starts_with(|first: char| first.is_ascii_alphabetic()) {
            let nearest = identifier(name);
            return Err(Error::Usage(format!(
                "{name:?} does not begin a name in C: letters, digits and _, a letter first, for example {nearest}"
            )));
        }
        let channels = [self.sensors.len(), self.motors.len()];
        if channels != self.network.shape() {
            let [inputs, outputs] = self.network.shape();
            return Err(Error::Other(format!(
                "{} sensors and {} motors for a network of {inputs} inputs and {outputs} outputs",
                channels[0], channels[1]
            )));
        }
        Ok(())
    }
}

/// Returns the nearest name that is valid in C.
fn identifier(name: &str) -> String {
    let letters = name.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '_' });
    let name: String = letters.collect();
    if name.starts_with(|first: char| first.is_ascii_alphabetic()) { name } else { format!("controller_{name}") }
}
