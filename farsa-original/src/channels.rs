//! What sensors and motors have in common: names, channels, noise.

use std::collections::BTreeSet;

use farsa_lab::Error;

use crate::ini::{Entry, Group, Ini};
use crate::remarks::Remarks;
use crate::written::{Written, name, number};

/// The most sensors, and the most motors.
pub(super) const MOST_PARTS: usize = 100;
/// How deep devices with noise may stand within each other.
const MOST_WRAPPED: usize = 8;

/// A sensor or a motor as it is written.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Part {
    /// What it is called there, as a name here.
    pub(super) name: Option<String>,
    pub(super) kind: &'static str,
    /// Keys and values, as TOML.
    pub(super) options: Vec<(&'static str, String)>,
    /// Wrappers, as TOML, in the order of the list here.
    pub(super) wrappers: Vec<String>,
    /// How many channels it has.
    pub(super) channels: u64,
}

impl Part {
    pub(super) fn new(kind: &'static str, channels: u64) -> Self {
        Self { kind, channels, ..Self::default() }
    }

    /// The same with an option.
    pub(super) fn with(mut self, key: &'static str, value: impl std::fmt::Display) -> Self {
        self.options.push((key, value.to_string()));
        self
    }

    /// Leaves a name out that another of the parts has already.
    pub(super) fn name_once(&mut self, names: &mut BTreeSet<String>) {
        if let Some(own) = self.name.take() {
            // A name that is not given is the kind.
            if names.insert(own.clone()) {
                self.name = Some(own);
                return;
            }
        }
        let own = (1..).map(|n| if n == 1 { self.kind.to_owned() } else { format!("{}-{n}", self.kind) });
        let own = own.take(names.len() + 1).find(|own| !names.contains(own)).unwrap_or_default();
        names.insert(own.clone());
        self.name = (own != self.kind).then_some(own);
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

/// A device of the original, with the noise that its groups ask for.
#[derive(Debug)]
pub(super) struct Device<'i> {
    pub(super) group: &'i Group,
    /// Its type, and the line that says so.
    pub(super) kind: String,
    pub(super) entry: &'i Entry,
    pub(super) name: Option<String>,
    /// From the device outwards: noise, and whether its values are cut where those of the device end.
    pub(super) noise: Vec<(String, bool)>,
}

impl<'i> Device<'i> {
    /// Reads a group: `NoisyInput` and `NoisyOutput` are noise around the device in their group `within`.
    ///
    /// # Errors
    /// [`Error::Usage`] for groups within groups within groups.
    pub(super) fn from_group(
        file: &str,
        ini: &'i Ini,
        group: &'i Group,
        within: &str,
        remarks: &mut Remarks,
    ) -> Result<Option<Self>, Error> {
        let (mut group, mut noise, mut own_name) = (group, Vec::new(), None);
        for _ in 0..MOST_WRAPPED {
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
        Err(Error::Usage(format!("{file} line {}: more than {MOST_WRAPPED} devices within each other", group.line)))
    }

    /// The wrappers of its noise, in the order of values that come from it, cut at both ends.
    pub(super) fn noisy_values(&self, [low, high]: [f64; 2]) -> Vec<String> {
        let cut = saturate(low, high);
        self.noise.iter().flat_map(|(noise, _)| [noise.clone(), cut.clone()]).collect()
    }

    /// The wrappers of its noise on values that go to it; its own noise is not cut.
    pub(super) fn noisy_commands(&self) -> Vec<String> {
        // The last of a motor's list is the first that a value meets.
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

/// The wrapper of a group's noise, if it asks for some.
fn read_noise(group: &Group, remarks: &mut Remarks) -> Option<String> {
    let kind = group.word("noiseType", "nonoise", remarks);
    let range = group.number("noiseRange", 0.0, 0.0..=1e6, remarks);
    match &*kind {
        "nonoise" => None,
        // It goes half the range to both sides.
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

/// Which channels of a device are used: so many of the first, and the channels among them that are silenced.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Selection {
    pub(super) first: u64,
    pub(super) silent: Vec<[u64; 2]>,
}

impl Selection {
    /// Reads `activeSensors`, a 0 or a 1 for each of `count` sensors, of which the original's first is number `turn` here.
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

    /// The wrappers that silence channels.
    pub(super) fn lesions(&self) -> impl Iterator<Item = String> + '_ {
        self.silent.iter().map(|[from, to]| format!("{{ kind = \"lesion\", channels = [{from}, {to}] }}"))
    }
}
