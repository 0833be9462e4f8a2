//! Errors as Python exceptions.

use farsa_lab::Error;
use pyo3::PyErr;
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError, PyRuntimeError, PyValueError};

/// Converts an error of the laboratory into the exception of its kind.
pub(crate) fn exception(error: &Error) -> PyErr {
    let text = error.to_string();
    match error {
        Error::Setting { .. } | Error::Usage(_) | Error::Several(_) => PyValueError::new_err(text),
        Error::Io { .. } | Error::File { .. } => PyOSError::new_err(text),
        Error::Interrupted { .. } => PyKeyboardInterrupt::new_err(text),
        _ => PyRuntimeError::new_err(text),
    }
}

/// Builds the exception of an object that another thread uses.
pub(crate) fn in_use(what: &str) -> PyErr {
    PyRuntimeError::new_err(format!("{what} is in use by another thread"))
}

/// Checks that this process created an object, because threads do not survive a fork.
pub(crate) fn check_process(what: &str, process: u32) -> Result<(), PyErr> {
    let now = std::process::id();
    if process == now {
        return Ok(());
    }
    Err(PyRuntimeError::new_err(format!("process {process} made {what}, which process {now} cannot use after a fork")))
}
