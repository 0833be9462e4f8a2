//! Typed access to the keys of a group.

use std::ops::RangeInclusive;

use crate::ini::{Entry, Group};
use crate::remarks::Remarks;

impl Group {
    /// Returns the line of a key that has been read.
    pub(super) fn find(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().rfind(|entry| entry.key == key)
    }

    /// Returns the value of a key, if any. The last one counts, as for an editor that appends.
    pub(super) fn text(&self, key: &'static str, remarks: &mut Remarks) -> Option<&Entry> {
        remarks.ask(self, key);
        let mut entries: Vec<&Entry> = self.entries.iter().filter(|entry| entry.key == key).collect();
        let last = entries.pop()?;
        remarks.take(last);
        for other in entries {
            remarks.lost(self, other, "stands twice, which the original refuses; the last one counts here");
        }
        Some(last)
    }

    /// Returns the lower-case word of a key, or a default.
    pub(super) fn word(&self, key: &'static str, default: &str, remarks: &mut Remarks) -> String {
        self.text(key, remarks).map_or_else(|| default.into(), |entry| entry.value.to_ascii_lowercase())
    }

    /// Returns the type of the group, without the name of its library.
    pub(super) fn kind(&self, remarks: &mut Remarks) -> Option<(String, &Entry)> {
        let entry = self.text("type", remarks)?;
        let name = entry.value.rsplit("::").next().unwrap_or_default();
        Some((name.into(), entry))
    }

    /// Returns a flag.
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

    /// Returns a whole number within limits.
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

    /// Returns a number within limits.
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

    /// Marks keys without effect.
    pub(super) fn idle(&self, keys: &[&'static str], why: &str, remarks: &mut Remarks) {
        for key in keys {
            if let Some(entry) = self.text(key, remarks) {
                remarks.idle(self, entry, why);
            }
        }
    }

    /// Marks keys that cannot be converted. Their default values have no effect.
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
