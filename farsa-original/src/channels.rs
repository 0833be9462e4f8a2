//! Names, channels and noise of sensors and motors.

use std::collections::BTreeSet;

use farsa_lab::Error;

use crate::ini::{Entry, Group, Ini};
use crate::remarks::Remarks;
use crate::written::{Written, name, number};

/// Most sensors, and most motors.
pub(super) const MAX_PARTS: usize = 100;
/// Most nested devices with noise.
const MAX_WRAPPED: usize = 8;

/// A sensor or a motor of the experiment file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Part {
    /// Its name in the configuration, as a valid name.
    pub(super) name: Option<String>,
    pub(super) kind: &'static str,
    /// Keys and values, as TOML.
    pub(super) options: Vec<(&'static str, String)>,
    /// Wrappers, as TOML, in the order of the experiment file.
    pub(super) wrappers: Vec<String>,
    /// Number of channels.
    pub(super) channels: u64,
}

impl Part {
    pub(super) fn new(kind: &'static str, channels: u64) -> Self {
        Self { kind, channels, ..Self::default() }
    }

    /// Adds an option.
    pub(super) fn with(mut self, key: &'static str, value: impl std::fmt::Display) -> Self {
        self.options.push((key, value.to_string()));
        self
    }

    /// Removes a name that an earlier part has.
    pub(super) fn name_once(&mut self, names: &mut BTreeSet<String>) {
        if let Some(name) = self.name.take() {
            // A part without a name is called by its kind.
            if names.insert(name.clone()) {
                self.name = Some(name);
                return;
            }
        }
        let name = (1..).map(|n| if n == 1 { self.kind.to_owned() } else { format!("{}-{n}", self.kind) });
        let name = name.take(names.len() + 1).find(|name| !names.contains(name)).unwrap_or_default();
        names.insert(name.clone());
        self.name = (name != self.kind).then_some(name);
    }

    pub(super) fn write(&self, table: &str, out: &mut Written) {
        out.table(table);
        if let Some(name) = &self.name {
            out.word("name", name);
        }
        out.word("kind", self.kind);
        for (key, value) in &self.options {
            out.set(key, value);
        }
        if !self.wrappers.is_empty() {
            out.set("wrappers", format!("[{}]", self.wrappers.join(", ")));
        }
    }
}

/// A device of the configuration, with the noise of its groups.
#[derive(Debug)]
pub(super) struct Device<'i> {
    pub(super) group: &'i Group,
    /// Type, and the line of the type.
    pub(super) kind: String,
    pub(super) entry: &'i Entry,
    pub(super) name: Option<String>,
    /// Noise from the device outwards, with true for noise that is cut at the ends of the device's values.
    pub(super) noise: Vec<(String, bool)>,
}

impl<'i> Device<'i> {
    /// Reads a group. `NoisyInput` and `NoisyOutput` add noise to the device in their group `within`.
    ///
    /// # Errors
    /// [`Error::Usage`] for too many nested groups.
    pub(super) fn from_group(
        file: &str,
        ini: &'i Ini,
        group: &'i Group,
        within: &str,
        remarks: &mut Remarks,
    ) -> Result<Option<Self>, Error> {
        let (mut group, mut noise, mut own_name) = (group, Vec::new(), None);
        for _ in 0..MAX_WRAPPED {
            own_name = own_name.or_else(|| group.text("name", remarks).and_then(|entry| name(&entry.value)));
            let Some((kind, entry)) = group.kind(remarks) else {
                remarks.unsaid(group, "type", "", "says not what it is");
                return Ok(None);
            };
            let wraps = kind == "NoisyInput" || kind == "NoisyOutput";
            noise.extend(read_noise(group, remarks).map(|noise| (noise, wraps)));
            if !wraps {
                noise.reverse();
                return Ok(Some(Self { group, kind, entry, name: own_name, noise }));
            }
            let Some(inner) = ini.group(&format!("{}/{within}", group.path)) else {
                remarks.lost(group, entry, &format!("has no group `{within}` to which it adds noise"));
                return Ok(None);
            };
            group = inner;
        }
        Err(Error::Usage(format!("{file} line {}: more than {MAX_WRAPPED} devices within each other", group.line)))
    }

    /// Returns the noise of a sensor as wrappers, each cut at both ends.
    pub(super) fn noisy_values(&self, [low, high]: [f64; 2]) -> Vec<String> {
        let cut = saturate(low, high);
        self.noise.iter().flat_map(|(noise, _)| [noise.clone(), cut.clone()]).collect()
    }

    /// Returns the noise of a motor as wrappers. The motor's own noise is not cut.
    pub(super) fn noisy_commands(&self) -> Vec<String> {
        // A motor applies the last wrapper of its list first.
        let cut = |(noise, wraps): &(String, bool)| {
            let mut both = if *wraps { vec![saturate(0.0, 1.0)] } else { Vec::new() };
            both.push(noise.clone());
            both
        };
        self.noise.iter().flat_map(cut).collect()
    }
}

fn saturate(low: f64, high: f64) -> String {
    format!("{{ kind = \"saturate\", low = {}, high = {} }}", number(low), number(high))
}

/// Returns the wrapper of a group's noise, if any.
fn read_noise(group: &Group, remarks: &mut Remarks) -> Option<String> {
    let kind = group.word("noiseType", "nonoise", remarks);
    let range = group.number("noiseRange", 0.0, 0.0..=1e6, remarks);
    match &*kind {
        "nonoise" => None,
        // The range is twice the amplitude.
        "uniform" => Some(format!("{{ kind = \"uniform-noise\", amplitude = {} }}", number(range / 2.0))),
        // The range is four standard deviations.
        "gaussian" => Some(format!("{{ kind = \"normal-noise\", deviation = {} }}", number(range / 4.0))),
        _ => {
            if let Some(entry) = group.find("noiseType") {
                remarks.lost(group, entry, "is no type of noise of the original; there is none here");
            }
            None
        }
    }
}

/// The used channels of a device: the first ones, and the silent channels among them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Selection {
    pub(super) first: u64,
    pub(super) silent: Vec<[u64; 2]>,
}

impl Selection {
    /// Reads `activeSensors`, a 0 or a 1 for each of `count` sensors. The first is number `turn` in the experiment
    /// file.
    pub(super) fn from_group(group: &Group, [count, turn]: [u64; 2], remarks: &mut Remarks) -> Self {
        let all = Self { first: count, silent: Vec::new() };
        let Some(entry) = group.text("activeSensors", remarks) else { return all };
        let mut active: Vec<bool> = entry.value.chars().map(|sign| sign == '1').collect();
        if active.len() as u64 == count {
            active.rotate_right(turn as usize);
        }
        let last = active.iter().rposition(|on| *on);
        let right = entry.value.chars().all(|sign| sign == '0' || sign == '1') && active.len() as u64 == count;
        let Some(last) = last.filter(|_| right) else {
            let why = format!("is not a 0 or a 1 for each of {count} sensors, of which one is 1; all are there");
            remarks.lost(group, entry, &why);
            return all;
        };
        let mut silent: Vec<[u64; 2]> = Vec::new();
        for channel in (0..last).filter(|channel| !active[*channel]).map(|channel| channel as u64) {
            match silent.last_mut() {
                Some([_, end]) if *end + 1 == channel => *end = channel,
                _ => silent.push([channel, channel]),
            }
        }
        if !silent.is_empty() {
            let why = "only the first sensors can be chosen; those between read 0 here and have weights of no effect";
            remarks.lost(group, entry, why);
        }
        Self { first: last as u64 + 1, silent }
    }

    /// Returns the wrappers of silent channels.
    pub(super) fn lesions(&self) -> impl Iterator<Item = String> + '_ {
        self.silent.iter().map(|[from, to]| format!("{{ kind = \"lesion\", channels = [{from}, {to}] }}"))
    }
}
