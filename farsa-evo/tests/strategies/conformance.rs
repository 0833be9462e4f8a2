//! The conformance check on strategies with flaws, and the snapshot intervals of the built-in strategies.

use crate::errors;
use farsa_evo::coevolution::Populations;
use farsa_evo::covariance::{
    CholeskyCmaEs, CmaEs, CmaEsConfig, CmaEsRestarts, CmaEsRestartsConfig, RestartSchedule, SeparableCmaEs,
    SeparableCmaEsConfig,
};
use farsa_evo::pareto::{Nsga2, Nsga2Config};
use farsa_evo::real::{
    EvolutionStrategy, EvolutionStrategyConfig, RealGa, RealGaConfig, SteadyState, SteadyStateConfig,
};
use farsa_evo::words::{GaConfig, TruncationGa};
use farsa_evo::{EvoError, Fitness, Population, Record, RecordEntry, RecordKind, Snapshot, Strategy, check_strategy};

#[derive(Clone, Copy, PartialEq)]
enum Flaw {
    None,
    /// The state lacks a number that later generations depend on.
    Forgets,
    /// The state lacks a number of the diagnostics.
    SaysLess,
    /// The state differs after it was restored.
    SavesMore,
    /// The diagnostics grow with each generation.
    SaysMore,
    /// A new instance has an empty state.
    SavesLate,
    /// The snapshot interval is shorter than a generation.
    SavesTooOften,
}

/// Genes that are the sum of all finite reported fitness.
struct Summing {
    flaw: Flaw,
    generation: u32,
    total: f64,
    population: Population<f64>,
    restored: bool,
}

impl Summing {
    fn new(flaw: Flaw) -> Result<Self, EvoError> {
        Ok(Self { flaw, generation: 0, total: 1.0, population: Population::new(3, 2)?, restored: false })
    }
}

impl Strategy<f64> for Summing {
    fn generation(&self) -> u32 {
        self.generation
    }
    fn ask(&self) -> &Population<f64> {
        &self.population
    }
    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        if fitness.len() != 3 {
            return Err(errors::fitness_count(3, fitness.len()));
        }
        self.generation += 1;
        self.total += fitness.iter().map(|fitness| fitness.get()).filter(|value| value.is_finite()).sum::<f64>();
        let shown = if self.flaw == Flaw::SaysLess { 0.0 } else { self.total };
        self.population.iter_mut().flatten().for_each(|gene| *gene = shown);
        Ok(())
    }
    fn record_kind(&self) -> RecordKind {
        RecordKind::Genomes
    }
    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        (self.flaw != Flaw::SavesLate || self.generation > 0).then_some(self)
    }
    fn diagnostics(&self) -> Vec<f64> {
        match self.flaw {
            Flaw::Forgets => vec![],
            Flaw::SaysMore => vec![0.5; self.generation as usize],
            _ => vec![self.total],
        }
    }
}

impl Snapshot for Summing {
    fn snapshot_interval(&self) -> u32 {
        u32::from(self.flaw != Flaw::SavesTooOften)
    }
    fn save(&self) -> Vec<u8> {
        let mut state = self.generation.to_le_bytes().to_vec();
        state.extend(self.population.as_slice()[0].to_le_bytes());
        if !matches!(self.flaw, Flaw::Forgets | Flaw::SaysLess) {
            state.extend(self.total.to_le_bytes());
        }
        state.push(u8::from(self.flaw == Flaw::SavesMore && self.restored));
        state
    }
    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
        let (expected, found) = (self.save().len(), state.len());
        if expected != found {
            return Err(errors::state_length(expected, found));
        }
        let real = |at: usize| f64::from_le_bytes(*state[at..].first_chunk().unwrap());
        self.generation = u32::from_le_bytes(*state.first_chunk().unwrap());
        self.population.iter_mut().flatten().for_each(|gene| *gene = real(4));
        if found > 13 {
            self.total = real(12);
        }
        self.restored = true;
        Ok(())
    }
}

#[test]
fn every_flaw_is_reported() {
    check_strategy(|| Summing::new(Flaw::None), 8).unwrap();
    for (flaw, expected) in [
        (Flaw::Forgets, "generation 2: other genomes where the same are asked for"),
        (Flaw::SaysLess, "generation 1: says other numbers of itself the second time"),
        (Flaw::SavesMore, "generation 0: saves another state than the one that it was restored from"),
        (Flaw::SavesTooOften, "generation 0: wants 0 generations between its states, where 1 is the least"),
        (Flaw::SaysMore, "generation 1: says another count of numbers of itself than before"),
    ] {
        assert_eq!(check_strategy(|| Summing::new(flaw), 8).unwrap_err(), expected);
    }
    let late = check_strategy(|| Summing::new(Flaw::SavesLate), 8).unwrap_err();
    assert!(late.starts_with("no record: "), "{late}");
}

#[test]
fn a_recorded_nan_gene_is_named() {
    let mut strategy = Summing::new(Flaw::None).unwrap();
    let mut record = Record::new(&mut strategy).unwrap();
    record.tell(&mut strategy, &[Fitness::WORST; 3]).unwrap();
    let mut frame = record.entry(0).unwrap().frame.to_vec();
    // The position after the index of the champion.
    frame[1..9].copy_from_slice(&0x7ff8_0001_0203_0405_u64.to_le_bytes());
    record.push(RecordEntry { frame: &frame, state: None }).unwrap();
    let mut genomes = |generation| record.genomes(&mut strategy, generation);
    assert_eq!(genomes(0).unwrap().as_slice(), [0.0; 6]);
    assert_eq!(genomes(1), Err(errors::state_content("a gene", 0x7ff8_0001_0203_0405)));
}

/// Snapshot intervals bound the replay to about a second, by the total number of drawn genes, or by their cube.
#[test]
fn snapshot_intervals_follow_the_cost_of_replay() {
    let bounds = || vec![[-1.0, 1.0]; 250];
    let between = |mut strategy: Box<dyn Strategy<f64>>| strategy.snapshot().unwrap().snapshot_interval();
    let real_ga = |seed| RealGa::new(RealGaConfig { population: 40, ..RealGaConfig::new(bounds()) }, seed);
    assert_eq!(between(Box::new(real_ga(0).unwrap())), 2000);
    assert_eq!(between(Box::new(Populations::new(3, 0, real_ga).unwrap())), 2000);
    let config = SteadyStateConfig { population: 80, ..SteadyStateConfig::new(bounds()) };
    assert_eq!(between(Box::new(SteadyState::new(config, 0).unwrap())), 1000);
    let config = Nsga2Config { population: 20, ..Nsga2Config::new(bounds(), 2) };
    assert_eq!(between(Box::new(Nsga2::new(config, 0).unwrap())), 4000);
    let config = EvolutionStrategyConfig::new(vec![0.0; 250], 0.1);
    let strategy = EvolutionStrategy::new(config, 0).unwrap();
    let individuals = strategy.ask().len() as u32;
    assert_eq!(between(Box::new(strategy)), 80_000 / individuals);
    let config = || CmaEsConfig::new(vec![0.0; 100], 0.5);
    assert_eq!(between(Box::new(CmaEs::new(config(), 0).unwrap())), 20_000);
    assert_eq!(between(Box::new(CholeskyCmaEs::with_covariance(config(), 0).unwrap())), 100_000);
    assert_eq!(
        between(Box::new(SeparableCmaEs::with_covariance(SeparableCmaEsConfig::new(vec![0.0; 100], 0.5), 0).unwrap())),
        u32::MAX
    );
    let restarts = CmaEsRestartsConfig::new(config(), RestartSchedule::Ipop);
    assert_eq!(between(Box::new(CmaEsRestarts::new(restarts, 0).unwrap())), 20_000);
}

#[test]
fn a_strategy_without_diagnostics_has_no_numbers() {
    assert_eq!(TruncationGa::new(GaConfig::new(3), 0).unwrap().diagnostics(), []);
}
