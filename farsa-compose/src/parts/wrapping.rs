//! Registered wrappers of sensors and motors.

use farsa_body::ports::Channels;
use farsa_lab::Error;

use crate::check::registry::Registry;
use crate::check::source::Source;
use crate::document::Wrapper;
use crate::part::definition::Build;
use crate::part::wrapper::AnyWrapper;
use crate::parts::filtered::Filtered;
use crate::parts::sizes::MemoryBudget;

/// Size of a wrapper itself, in values.
const ITSELF: usize = 32;

/// Wraps a part as the wrapper at a path requires, within the memory budget.
pub(crate) fn wrap<T: Channels>(
    inner: T,
    wrapper: &Wrapper,
    budget: &mut MemoryBudget,
    path: &str,
    source: &Source,
) -> Result<Filtered<Box<T>>, Error> {
    let part = registered(wrapper, &source.registry);
    let part = part.ok_or_else(|| source.wrong(path, format!("`{}` is no wrapper", wrapper.kind)))?;
    let part = part.map_err(|error| source.at(path, error))?;
    budget.take(part.memory().saturating_mul(inner.channels()) + ITSELF, path, source)?;
    let filter = part.filter(inner.channels()).map_err(|error| source.at(path, error))?;
    Ok(Filtered::new(Box::new(inner), filter))
}

/// Reads the registered part of a wrapper, or returns `None` without one.
fn registered(wrapper: &Wrapper, registry: &Registry) -> Option<Result<Box<dyn AnyWrapper>, Error>> {
    let read = registry.find(&wrapper.kind, |build| if let Build::Wrapper(read) = build { Some(*read) } else { None });
    read.map(|read| read(&wrapper.keys))
}

/// Describes the changes of wrappers, in this order. Empty without any.
pub(crate) fn changes<'w>(wrappers: impl Iterator<Item = &'w Wrapper>, registry: &Registry) -> String {
    let change = |wrapper: &Wrapper| {
        let part = registered(wrapper, registry).and_then(Result::ok);
        part.and_then(|part| part.about()).unwrap_or_else(|| format!("`{}`", wrapper.kind))
    };
    wrappers.map(change).collect::<Vec<_>>().join(", then ")
}
