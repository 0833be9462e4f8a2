//! Parameters of a search, and those of the network.

use std::collections::BTreeMap;
use std::sync::Arc;

use farsa_lab::{Error, Parameter};

use crate::check::source::Source;
use crate::document::Network;
use crate::parts::network::AnyNetwork;

/// Origin of a network parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Origin {
    /// Searched parameter of this number.
    Searched(usize),
    Fixed(f32),
}

/// Searched parameters, and the mapping to those of the network. Copies share names and ranges, because each lane
/// of each thread has a copy and 828 000 parameters take 90 MB.
#[derive(Clone, Debug)]
pub(crate) struct Searched {
    parameters: Arc<[Parameter]>,
    origins: Arc<[Origin]>,
    /// All parameters of the network.
    own: Vec<f32>,
}

/// Largest magnitude of a fixed value.
const MAX_FIXED: f64 = 1e6;

impl Searched {
    /// Selects the searched parameters: all except the fixed ones, and one of each shared list. `given` contains
    /// further fixed values.
    pub(crate) fn new(
        all: Vec<Parameter>,
        given: &BTreeMap<String, f64>,
        network: &Network,
        source: &Source,
    ) -> Result<Self, Error> {
        let named = !network.fixed.is_empty() || !network.shared.is_empty();
        let numbers: BTreeMap<&str, usize> =
            all.iter().enumerate().filter(|_| named).map(|(own, known)| (&*known.name, own)).collect();
        let number = |name: &str, path: &str| {
            let found = numbers.get(name).copied();
            let names = all.iter().map(|known| known.name.as_str());
            found.ok_or_else(|| Error::unknown(&source.of(path), "parameter", name, names))
        };
        let mut fixed: Vec<Option<f64>> = all.iter().map(|known| given.get(&known.name).copied()).collect();
        for (name, value) in &network.fixed {
            let path = format!("/network/fixed/{name}");
            if value.abs() > MAX_FIXED {
                return Err(source.wrong(&path, format!("{value} is outside -{MAX_FIXED} to {MAX_FIXED}")));
            }
            fixed[number(name, &path)?] = Some(*value);
        }
        // The first of the equal parameters, for each parameter.
        let mut first: Vec<usize> = (0..all.len()).collect();
        let mut shared = vec![false; all.len()];
        for (list, names) in network.shared.iter().enumerate() {
            let mut leader = None;
            for (index, name) in names.iter().enumerate() {
                let path = format!("/network/shared/{list}/{index}");
                let own = number(name, &path)?;
                let leader = *leader.get_or_insert(own);
                if std::mem::replace(&mut shared[own], true) || fixed[own].is_some() {
                    return Err(source.wrong(&path, format!("`{name}` is shared or fixed already")));
                }
                if all[own].ends != all[leader].ends {
                    return Err(source.wrong(&path, format!("`{name}` has another range than those before it")));
                }
                first[own] = leader;
            }
        }
        // A shared list has the place of its first parameter in the search.
        let mut count = 0;
        let mut places_of: Vec<Option<usize>> = vec![None; all.len()];
        let mut kept = vec![false; all.len()];
        let origins = (0..all.len()).map(|own| match fixed[own] {
            Some(value) => Origin::Fixed(value as f32),
            None => Origin::Searched(*places_of[first[own]].get_or_insert_with(|| {
                kept[own] = true;
                count += 1;
                count - 1
            })),
        });
        let origins: Arc<[Origin]> = origins.collect();
        let own = vec![0.0; all.len()];
        let mut parameters: Vec<Parameter> =
            all.into_iter().zip(kept).filter_map(|(known, kept)| kept.then_some(known)).collect();
        if parameters.is_empty() {
            // Without searched parameters a search has one without effect.
            parameters.push(Parameter::new("none", [0.0, 1.0]));
        }
        Ok(Self { parameters: parameters.into(), origins, own })
    }

    /// Checks that the network accepts the fixed values.
    pub(crate) fn check(&self, network: &AnyNetwork, source: &Source) -> Result<(), Error> {
        // Ends of searched ranges are valid, so a rejection is due to a fixed value.
        let least = self.origins.iter().map(|origin| match origin {
            Origin::Searched(number) => self.parameters[*number].ends[0] as f32,
            Origin::Fixed(value) => *value,
        });
        let least: Vec<f32> = least.collect();
        if network.clone().load(&least) {
            return Ok(());
        }
        Err(source.wrong(
            "/network/fixed",
            "has values that the network cannot have: a leak is from 0 to 1, a time constant longer than a step",
        ))
    }

    /// Gets the searched parameters, with names and ranges.
    pub(crate) fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Returns all network parameters from searched ones. Returns `None` for another number of them.
    pub(crate) fn all(&mut self, searched: &[f32]) -> Option<&[f32]> {
        if searched.len() != self.parameters.len() {
            return None;
        }
        for (own, origin) in self.own.iter_mut().zip(&*self.origins) {
            *own = match origin {
                Origin::Searched(number) => searched[*number],
                Origin::Fixed(value) => *value,
            };
        }
        Some(&self.own)
    }
}
