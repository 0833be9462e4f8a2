//! A network of any kind.

use farsa_lab::Error;
use farsa_lab::advanced::Intervention;
use farsa_nn::{Ablatable, Controller, Lesion};

use crate::check::source::Source;
use crate::document::Document;
use crate::part::network::{AnyPartNetwork, Built, NetworkEnds};

/// A registered network.
#[derive(Clone, Debug)]
pub(crate) struct AnyNetwork(Box<dyn AnyPartNetwork>);

impl AnyNetwork {
    /// Builds the network of a document at rest, with its parameters.
    pub(crate) fn new(document: &Document, ends: &NetworkEnds<'_>, source: &Source) -> Result<(Self, Built), Error> {
        let kind = &document.network.kind;
        let part = source.registry.network(kind);
        let part = part.ok_or_else(|| source.wrong("/network", format!("`{}` is no network", kind.kind)))?;
        let made = part.and_then(|part| part.built(ends)).map_err(|error| source.at("/network", error))?;
        Ok((Self(made.network.clone()), made))
    }

    /// Makes a network one of any kind.
    pub(crate) fn of(network: impl AnyPartNetwork + 'static) -> Self {
        Self(Box::new(network))
    }

    /// Gets the network if it has this type.
    pub(crate) fn downcast<T: 'static>(&self) -> Option<&T> {
        (*self.0).as_any().downcast_ref()
    }

    /// Gets the network.
    pub(crate) fn part(&self) -> &dyn AnyPartNetwork {
        &*self.0
    }

    /// Loads the parameters of a search. Returns false for another number of them or for values out of range.
    pub(crate) fn load(&mut self, parameters: &[f32]) -> bool {
        self.0.load(parameters)
    }

    /// Edits the network's parameters for a test. Returns false for values out of range.
    pub(crate) fn edit(&mut self, change: &Intervention) -> bool {
        change.parameters.is_empty() || {
            let edited = change.edited(self.own_parameters()).into_owned();
            self.0.copy_parameters(&edited)
        }
    }

    /// Returns the parameters in the network's own order.
    pub(crate) fn own_parameters(&self) -> &[f32] {
        self.0.parameters()
    }

    /// Gets the number of values that the network keeps: parameters and state.
    pub(crate) fn values(&self) -> usize {
        self.own_parameters().len() + self.0.memory()
    }

    /// Returns the activations that recordings show.
    pub(crate) fn activations(&self) -> &[f32] {
        self.0.activations()
    }

    /// Describes the network in one line.
    pub(crate) fn summary(&self) -> String {
        self.0.summary()
    }
}

impl Controller for AnyNetwork {
    fn inputs(&self) -> usize {
        self.0.inputs()
    }

    fn outputs(&self) -> usize {
        self.0.outputs()
    }

    fn reset(&mut self) {
        self.0.reset();
    }

    #[inline]
    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        self.0.step(x, y);
    }
}

impl Ablatable for AnyNetwork {
    fn neurons(&self) -> usize {
        self.0.neurons()
    }

    fn step_ablated(&mut self, lesions: &[Lesion], x: &[f32], y: &mut [f32]) {
        self.0.step_ablated(lesions, x, y);
    }
}
