//! What a group says, asked for key by key.

use std::ops::RangeInclusive;

use crate::ini::{Entry, Group};
use crate::remarks::Remarks;

impl Group {
    /// The line of a key that has been read.
    pub(super) fn find(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().rfind(|entry| entry.key == key)
    }

    /// What a key says, if it stands there; of several the last one, as of an editor that appends.
    pub(super) fn text(&self, key: &'static str, remarks: &mut Remarks) -> Option<&Entry> {
        remarks.ask(self, key);
        let mut found: Vec<&Entry> = self.entries.iter().filter(|entry| entry.key == key).collect();
        let last = found.pop()?;
        remarks.take(last);
        for other in found {
            remarks.lost(self, other, "stands twice, which the original refuses; the last one counts here");
        }
        Some(last)
    }

    /// The word of a key in small letters, or what it is by default.
    pub(super) fn word(&self, key: &'static str, default: &str, remarks: &mut Remarks) -> String {
        self.text(key, remarks).map_or_else(|| default.into(), |entry| entry.value.to_ascii_lowercase())
    }

    /// The type of what the group describes, without the name of its library.
    pub(super) fn kind(&self, remarks: &mut Remarks) -> Option<(String, &Entry)> {
        let entry = self.text("type", remarks)?;
        let name = entry.value.rsplit("::").next().unwrap_or_default();
        Some((name.into(), entry))
    }

    /// Yes or no.
    pub(super) fn flag(&self, key: &'static str, default: bool, remarks: &mut Remarks) -> bool {
        let Some(entry) = self.text(key, remarks) else { return default };
        match &*entry.value.to_ascii_lowercase() {
            "true" | "t" | "yes" | "y" | "on" | "1" => true,
            "false" | "f" | "no" | "n" | "off" | "0" => false,
            _ => {
                remarks.lost(self, entry, &format!("is neither true nor false; taken for {default}"));
                default
            }
        }
    }

    /// A whole number within limits.
    pub(super) fn whole(
        &self,
        key: &'static str,
        default: u64,
        limits: RangeInclusive<u64>,
        remarks: &mut Remarks,
    ) -> u64 {
        let Some(entry) = self.text(key, remarks) else { return default };
        let value = entry.value.parse::<u64>().ok().filter(|value| limits.contains(value));
        value.unwrap_or_else(|| {
            let (from, to) = (limits.start(), limits.end());
            remarks.lost(self, entry, &format!("is no whole number from {from} to {to}; taken for {default}"));
            default
        })
    }

    /// A number within limits.
    pub(super) fn number(
        &self,
        key: &'static str,
        default: f64,
        limits: RangeInclusive<f64>,
        remarks: &mut Remarks,
    ) -> f64 {
        let Some(entry) = self.text(key, remarks) else { return default };
        let value = entry.value.parse::<f64>().ok().filter(|value| limits.contains(value));
        value.unwrap_or_else(|| {
            let (from, to) = (limits.start(), limits.end());
            remarks.lost(self, entry, &format!("is no number from {from} to {to}; taken for {default}"));
            default
        })
    }

    /// Keys whose values change nothing that comes out here.
    pub(super) fn idle(&self, keys: &[&'static str], why: &str, remarks: &mut Remarks) {
        for key in keys {
            if let Some(entry) = self.text(key, remarks) {
                remarks.idle(self, entry, why);
            }
        }
    }

    /// Keys that nothing here has a word for; with their default they say nothing.
    pub(super) fn lost(&self, keys: &[(&'static str, &str)], why: &str, remarks: &mut Remarks) {
        for (key, default) in keys {
            if let Some(entry) = self.text(key, remarks) {
                if entry.value.eq_ignore_ascii_case(default) {
                    remarks.idle(self, entry, "is the original's default, and so it is here");
                } else {
                    remarks.lost(self, entry, why);
                }
            }
        }
    }
}
