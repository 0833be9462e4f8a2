//! Records with states: complete, truncated, read by entry, and written by a separate writer.

use farsa_evo::words::{GaConfig, TruncationGa};
use farsa_evo::{EvoError, Fitness, Population, Record, RecordWriter, Snapshot, Strategy};

/// A strategy with a snapshot every three generations.
struct Asking {
    search: TruncationGa,
    /// Padding of the state [bytes].
    more: usize,
}

impl Strategy for Asking {
    fn generation(&self) -> u32 {
        self.search.generation()
    }
    fn ask(&self) -> &Population {
        self.search.ask()
    }
    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        self.search.tell(fitness)
    }
    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        Some(self)
    }
}

impl Snapshot for Asking {
    fn save(&self) -> Vec<u8> {
        let mut state = self.search.save();
        state.resize(state.len() + self.more, 0);
        state
    }
    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
        self.search.restore(&state[..state.len() - self.more])
    }
    fn snapshot_interval(&self) -> u32 {
        3
    }
}

fn fresh() -> Asking {
    let search = TruncationGa::new(GaConfig { population: 10, parents: 5, ..GaConfig::new(500) }, 2).unwrap();
    Asking { search, more: 0 }
}

/// The fitness of a generation.
fn values(generation: u32) -> Vec<Fitness> {
    (0..10_u32).map(|i| Fitness::nan_as_failed(f64::from((7 * i + generation) % 10))).collect()
}

/// Ten generations.
fn recorded() -> Record {
    let mut slow = fresh();
    let mut record = Record::new(&mut slow).unwrap();
    for generation in 0..10 {
        record.tell(&mut slow, &values(generation)).unwrap();
    }
    record
}

#[test]
fn states_are_stored_at_the_interval_of_the_strategy() {
    let record = recorded();
    assert_eq!((record.size(), record.populations(), record.generations()), (10, 1, 10));
    let stored: Vec<u32> = (0..10).filter(|generation| record.entry(*generation).unwrap().state.is_some()).collect();
    assert_eq!(stored, [2, 5, 8]);
    // A truncated and continued record is equal, and so is one that is read by entry.
    let (mut cut, mut again) = (record.clone(), fresh());
    cut.truncate(4);
    cut.rebuild(&mut again, 4).unwrap();
    let mut read = Record::new(&mut fresh()).unwrap();
    for generation in 4..10 {
        cut.tell(&mut again, &values(generation)).unwrap();
    }
    for generation in 0..10 {
        read.push(record.entry(generation).unwrap()).unwrap();
    }
    assert!(cut == record && read == record);
    for generation in 0..10 {
        let mut rebuilt = fresh();
        record.rebuild(&mut rebuilt, generation).unwrap();
        assert_eq!(rebuilt.ask().digest(), record.genomes(&mut fresh(), generation).unwrap().digest());
    }
}

#[test]
fn the_snapshot_rate_halves_with_each_256_mib_of_states() {
    let mut large = Asking { more: 1 << 26, ..fresh() };
    let mut writer = RecordWriter::new(&mut large).unwrap();
    let stored = (0..60).filter(|&generation| {
        writer.tell(&mut large, &values(generation)).unwrap();
        writer.entry().unwrap().state.is_some()
    });
    assert_eq!(stored.collect::<Vec<u32>>(), [2, 5, 8, 11, 17, 23, 29, 35, 47, 59]);
}

#[test]
fn a_writer_writes_the_entries_of_a_record_from_any_generation() {
    let record = recorded();
    for first in 0..10 {
        let (mut before, mut strategy) = (record.clone(), fresh());
        before.truncate(first);
        before.rebuild(&mut strategy, first).unwrap();
        let mut writer = before.writer();
        assert_eq!((writer.generations(), writer.populations(), writer.entry()), (first, 1, None));
        assert!(writer.tell(&mut fresh(), &values(0)).is_err() == (first > 0), "another generation");
        let mut writer = before.writer();
        for generation in first..10 {
            writer.tell(&mut strategy, &values(generation)).unwrap();
            assert_eq!(writer.entry(), record.entry(generation), "{generation} from {first} on");
        }
        assert_eq!(writer.generations(), 10);
        assert!(writer.tell(&mut strategy, &values(0)[1..]).is_err());
        assert_eq!(writer.entry(), record.entry(9), "what is refused changes nothing");
    }
}
