//! Memory use of the recordings of a page or a picture.

use farsa_view::{Recording, Schema};

use crate::error::Error;
use crate::limits::Limits;

/// Room for recordings.
pub(crate) struct MemoryUse {
    left: usize,
    total: usize,
    recordings: usize,
}

impl MemoryUse {
    /// All of it.
    pub(crate) const fn new(limits: Limits) -> Self {
        Self { left: limits.recording_bytes, total: limits.recording_bytes, recordings: 0 }
    }

    /// A recording of nothing yet, which ends where no room is left.
    pub(crate) fn recording(&self, schema: Schema) -> Recording {
        Recording::new(schema).with_room(self.left)
    }

    /// Takes a recording's room once its trial is over.
    ///
    /// # Errors
    /// [`Error::Usage`] where the trial did not fit.
    pub(crate) fn add(&mut self, recording: &Recording) -> Result<(), Error> {
        if recording.is_cut() {
            let (steps, most) = (recording.times().len(), self.total >> 20);
            let until = recording.times().last().copied().unwrap_or(0.0);
            let which = match self.recordings {
                0 => "the trial".into(),
                before => format!("trial number {} of these", before + 1),
            };
            return Err(Error::Usage(format!(
                "{which} has more steps than fit into {most} MiB; {steps} do, until {until:.2} s: take one trial (--trial), a \
                 moment until then (`farsa draw --time`), or all steps as a table (`farsa replay --out`)"
            )));
        }
        self.left = self.left.saturating_sub(recording.bytes());
        self.recordings += 1;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_body::Recorder as _;

    #[test]
    fn all_recordings_share_the_room() {
        let mut kept = MemoryUse { left: 10_000, ..MemoryUse::new(Limits::DEFAULT) };
        let record = |kept: &MemoryUse, ticks: u32| {
            let mut recording = kept.recording(Schema::from_scalars(["x", "y"]));
            for tick in 0..ticks {
                recording.scalars(&[1.0, 2.0]);
                recording.tick(f64::from(tick));
            }
            recording
        };
        let first = record(&kept, 100);
        kept.add(&first).unwrap();
        assert_eq!(kept.left, 10_000 - first.bytes());
        let said = kept.add(&record(&kept, 10_000)).unwrap_err().to_string();
        assert!(said.starts_with("trial number 2 of these has more steps than fit into 256 MiB"), "{said}");
        let long = record(&kept, 10_000);
        let said = MemoryUse { left: 10_000, ..MemoryUse::new(Limits::DEFAULT) }.add(&long).unwrap_err().to_string();
        let steps = long.times().len();
        assert!(said.starts_with("the trial has more steps"), "{said}");
        assert!(said.contains(&format!("; {steps} do, until {}.00 s: ", steps - 1)), "{said}");
        // A recording that did not fit uses nothing.
        assert_eq!(kept.left, 10_000 - first.bytes());
    }
}
