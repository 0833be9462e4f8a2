//! Which parameters of a network are searched for.

use std::collections::BTreeMap;
use std::sync::Arc;

use farsa_lab::{Error, Parameter};

use crate::check::places::Places;
use crate::document::Network;
use crate::parts::network::AnyNetwork;

/// From where a parameter of a network comes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Source {
    /// The parameter of this number among those that are searched for.
    Searched(usize),
    Fixed(f32),
}

/// The parameters that are searched for, and how all of a network's are made of them. Copies share what stays as it is: names
/// and ranges of 828 000 parameters took 90 MB, and every lane of every thread has a copy.
#[derive(Clone, Debug)]
pub(crate) struct Searched {
    parameters: Arc<[Parameter]>,
    sources: Arc<[Source]>,
    /// All of a network's.
    own: Vec<f32>,
}

/// The largest size of a value that is fixed.
const LARGEST: f64 = 1e6;

impl Searched {
    /// What is left of all parameters of a network without those that are fixed, by the document or beside it, and with one
    /// for all that are shared.
    ///
    /// # Errors
    /// [`Error::Unknown`] for a parameter that there is not, [`Error::Setting`] for one that stands twice, and for values
    /// and ranges that do not go together.
    pub(crate) fn new(
        all: Vec<Parameter>,
        beside: &BTreeMap<String, f64>,
        network: &Network,
        places: &Places,
    ) -> Result<Self, Error> {
        let named = !network.fixed.is_empty() || !network.shared.is_empty();
        let numbers: BTreeMap<&str, usize> =
            all.iter().enumerate().filter(|_| named).map(|(own, known)| (&*known.name, own)).collect();
        let number = |name: &str, path: &str| {
            let found = numbers.get(name).copied();
            let names = all.iter().map(|known| known.name.as_str());
            found.ok_or_else(|| Error::unknown(&places.of(path), "parameter", name, names))
        };
        let mut fixed: Vec<Option<f64>> = all.iter().map(|known| beside.get(&known.name).copied()).collect();
        for (name, value) in &network.fixed {
            let path = format!("/network/fixed/{name}");
            if value.abs() > LARGEST {
                return Err(places.wrong(&path, format!("{value} is outside -{LARGEST} to {LARGEST}")));
            }
            fixed[number(name, &path)?] = Some(*value);
        }
        // For each parameter the first of those that it is equal to.
        let mut first: Vec<usize> = (0..all.len()).collect();
        let mut shared = vec![false; all.len()];
        for (list, names) in network.shared.iter().enumerate() {
            let mut leader = None;
            for (index, name) in names.iter().enumerate() {
                let path = format!("/network/shared/{list}/{index}");
                let own = number(name, &path)?;
                let leader = *leader.get_or_insert(own);
                if std::mem::replace(&mut shared[own], true) || fixed[own].is_some() {
                    return Err(places.wrong(&path, format!("`{name}` is shared or fixed already")));
                }
                if all[own].ends != all[leader].ends {
                    return Err(places.wrong(&path, format!("`{name}` has another range than those before it")));
                }
                first[own] = leader;
            }
        }
        let mut count = 0;
        let mut places_of: Vec<Option<usize>> = vec![None; all.len()];
        let mut kept = vec![false; all.len()];
        let sources = (0..all.len()).map(|own| match fixed[own] {
            Some(value) => Source::Fixed(value as f32),
            None => Source::Searched(*places_of[first[own]].get_or_insert_with(|| {
                kept[own] = true;
                count += 1;
                count - 1
            })),
        });
        let sources: Arc<[Source]> = sources.collect();
        let own = vec![0.0; all.len()];
        let mut parameters: Vec<Parameter> =
            all.into_iter().zip(kept).filter_map(|(known, kept)| kept.then_some(known)).collect();
        if parameters.is_empty() {
            // One that nothing depends on: nothing is searched for.
            parameters.push(Parameter::new("none", [0.0, 1.0]));
        }
        Ok(Self { parameters: parameters.into(), sources, own })
    }

    /// Whether a network takes what is fixed.
    ///
    /// # Errors
    /// [`Error::Setting`] if it does not.
    pub(crate) fn check(&self, network: &AnyNetwork, places: &Places) -> Result<(), Error> {
        let least = self.sources.iter().map(|source| match source {
            Source::Searched(number) => self.parameters[*number].ends[0] as f32,
            Source::Fixed(value) => *value,
        });
        let least: Vec<f32> = least.collect();
        if network.clone().load(&least) {
            return Ok(());
        }
        Err(places.wrong(
            "/network/fixed",
            "has values that the network cannot have: a leak is from 0 to 1, a time constant longer than a step",
        ))
    }

    /// The parameters that are searched for, with names and ranges.
    pub(crate) fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// All of the network's parameters, of those that are searched for; `None` for another number of them.
    pub(crate) fn all(&mut self, searched: &[f32]) -> Option<&[f32]> {
        if searched.len() != self.parameters.len() {
            return None;
        }
        for (own, source) in self.own.iter_mut().zip(&*self.sources) {
            *own = match source {
                Source::Searched(number) => searched[*number],
                Source::Fixed(value) => *value,
            };
        }
        Some(&self.own)
    }
}
