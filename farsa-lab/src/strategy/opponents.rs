//! Opponents of an individual of one of several populations, in a run and in a replay.

use std::ops::Range;

use crate::error::Error;
use crate::experiment::genotype::Genotype;
use crate::strategy::any_strategy::{AnyStrategy, Genome};
use crate::strategy::history::History;

/// An individual of another population.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Opponent {
    /// Best of an earlier generation.
    Champion { population: usize, generation: u32 },
    /// One of the same generation, counted through all populations.
    Peer(usize),
}

/// A generation of several populations and its trials.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pairing {
    pub(crate) generation: u32,
    pub(crate) populations: usize,
    /// Individuals of each population.
    pub(crate) size: usize,
    /// Trials of an individual.
    pub(crate) trials: usize,
}

impl Pairing {
    /// Finds the generation whose champions are the opponents in a trial. In the first half of the trials, trial t
    /// uses generation g - 1 - t. In the other half the trials use the middles of equal parts of all earlier
    /// generations.
    ///
    /// Against the latest champions alone, populations chase each other in circles and lose earlier skills. Source: the
    /// hall of fame of \[Rosin1997\]. Deviation: its champions are spread evenly, not drawn.
    fn earlier(self, trial: u32) -> Option<u32> {
        let latest = u32::try_from(self.trials.div_ceil(2)).unwrap_or(u32::MAX);
        match trial.checked_sub(latest) {
            None => self.generation.checked_sub(1)?.checked_sub(trial),
            Some(part) => {
                let (parts, before) = ((self.trials / 2).max(1) as u64, self.generation.checked_sub(latest)?);
                let middle = u64::from(before) * (2 * u64::from(part) + 1) / (2 * parts);
                (before > 0).then(|| u32::try_from(middle).map_or(before - 1, |middle| middle.min(before - 1)))
            }
        }
    }

    /// Iterates over the opponents of an individual in a trial, one of each other population: champions, or without a
    /// champion the individual of the trial's number.
    pub(crate) fn opponents(self, individual: usize, trial: u32) -> impl Iterator<Item = Opponent> {
        let Self { populations, size, .. } = self;
        let earlier = self.earlier(trial);
        let others = (0..populations).filter(move |population| *population != individual / size);
        others.map(move |population| match earlier {
            Some(generation) => Opponent::Champion { population, generation },
            None => Opponent::Peer(population * size + trial as usize % size),
        })
    }
}

/// Rebuilds the genomes that an individual met in each of some trials, rebuilt.
pub(crate) fn opponents_of(
    history: &History<'_>,
    generation: u32,
    individual: usize,
    wanted: Range<u32>,
    trials: usize,
) -> Result<Vec<Vec<Genome>>, Error> {
    if let Some(met) = history.opponents_of(generation, individual, wanted.clone())? {
        return Ok(met);
    }
    let meeting = Pairing { generation, populations: history.populations(), size: history.size(), trials };
    let mut places = Vec::new();
    for trial in wanted {
        for opponent in meeting.opponents(individual, trial) {
            places.push(match opponent {
                Opponent::Peer(individual) => (generation, individual),
                Opponent::Champion { population, generation } => {
                    (generation, history.champion(population, generation).ok_or_else(|| history.missing(generation))?)
                }
            });
        }
    }
    let others = (meeting.populations - 1).max(1);
    Ok(history.genomes(&places)?.chunks(others).map(<[_]>::to_vec).collect())
}

/// Finds the parameters of the opponents that a strategy chose, trial after trial, individual after individual.
/// Returns none if it chooses none, or for genomes of another experiment.
pub(crate) fn chosen(search: &AnyStrategy, genotype: &Genotype, trials: usize) -> Option<Vec<Vec<f32>>> {
    let mut parameters = Vec::new();
    for trial in 0..u32::try_from(trials).ok()? {
        for individual in 0..search.individuals() {
            for genome in search.opponents_of(individual, trial)? {
                parameters.push(genome.decode(genotype)?);
            }
        }
    }
    Some(parameters)
}

/// Champions of every generation. Empty for a single population.
#[derive(Debug, Default)]
pub(crate) struct HallOfFame {
    /// For every generation the parameters of each population's champion.
    champions: Vec<Vec<Vec<f32>>>,
}

impl HallOfFame {
    /// Gets the champions of all finished generations.
    pub(crate) fn before(history: &History<'_>, genotype: &Genotype) -> Result<Self, Error> {
        let populations = history.populations();
        let mut hall = Self::default();
        if populations > 1 {
            history.visit(0..history.finished(), |generation, genomes| {
                let champions = (0..populations).map(|population| {
                    let best = history.champion(population, generation)?;
                    genomes.get(best)?.decode(genotype)
                });
                hall.add(champions.collect::<Option<_>>().ok_or_else(|| history.missing(generation))?);
                Ok(())
            })?;
        }
        Ok(hall)
    }

    /// Builds it from the champions' parameters of every generation and population.
    pub(crate) fn from_champions(champions: Vec<Vec<Vec<f32>>>) -> Self {
        Self { champions }
    }

    /// Parameters of each population's champion, per generation.
    pub(crate) fn champions(&self) -> &[Vec<Vec<f32>>] {
        &self.champions
    }

    /// Adds the champions of the generation that has just been finished.
    pub(crate) fn add(&mut self, champions: Vec<Vec<f32>>) {
        if champions.len() > 1 {
            self.champions.push(champions);
        }
    }

    /// Finds the parameters of all opponents, trial after trial, individual after individual. Returns none if an
    /// opponent is missing.
    pub(crate) fn opponents<'g>(&'g self, meeting: Pairing, peers: &'g [Vec<f32>]) -> Option<Vec<&'g [f32]>> {
        let mut parameters = Vec::new();
        for trial in 0..u32::try_from(meeting.trials).ok()? {
            for individual in 0..peers.len() {
                for opponent in meeting.opponents(individual, trial) {
                    parameters.push(match opponent {
                        Opponent::Champion { population, generation } => {
                            self.champions.get(generation as usize)?.get(population)?.as_slice()
                        }
                        Opponent::Peer(individual) => peers.get(individual)?.as_slice(),
                    });
                }
            }
        }
        Some(parameters)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::parameter::Parameter;
    use farsa_evo::coevolution::Populations;
    use farsa_evo::words::GaConfig;
    use farsa_evo::{Fitness, Record, Strategy};

    #[test]
    fn earlier_champions_come_first_then_peers() {
        let meeting = Pairing { generation: 2, populations: 3, size: 4, trials: 8 };
        let met = |individual, trial| meeting.opponents(individual, trial).collect::<Vec<_>>();
        let champion = |population, generation| Opponent::Champion { population, generation };
        assert_eq!(met(0, 0), [champion(1, 1), champion(2, 1)]);
        assert_eq!(met(7, 1), [champion(0, 0), champion(2, 0)]);
        assert_eq!(met(8, 2), [Opponent::Peer(2), Opponent::Peer(6)]);
        assert_eq!(met(3, 5), [Opponent::Peer(5), Opponent::Peer(9)]);
        assert_eq!(Pairing { populations: 1, ..meeting }.opponents(3, 0).count(), 0);
    }

    #[test]
    fn half_of_the_champions_are_the_latest_and_half_of_all_times() {
        let earlier = |generation, trials| {
            let meeting = Pairing { generation, populations: 2, size: 4, trials };
            (0..trials as u32).map(|trial| meeting.earlier(trial)).collect::<Vec<_>>()
        };
        assert_eq!(earlier(0, 6), [None; 6]);
        assert_eq!(earlier(2, 6), [Some(1), Some(0), None, None, None, None]);
        assert_eq!(earlier(4, 6), [Some(3), Some(2), Some(1), Some(0), Some(0), Some(0)]);
        assert_eq!(earlier(63, 6), [Some(62), Some(61), Some(60), Some(10), Some(30), Some(50)]);
        assert_eq!(earlier(10, 1), [Some(9)]);
        assert_eq!(earlier(12, 3), [Some(11), Some(10), Some(5)]);
        assert_eq!(earlier(u32::MAX, 2), [Some(u32::MAX - 1), Some((u32::MAX - 1) / 2)]);
    }

    #[test]
    fn a_run_meets_whom_its_record_remembers() {
        const TRIALS: usize = 3;
        let config = GaConfig { population: 6, parents: 2, mutation_rate: 0.2, ..GaConfig::new(3) };
        let genotype = Genotype::new(&vec![Parameter::new("", [0.0, 65535.0]); 3], 16);
        let mut strategy = Populations::truncation(&[config; 3], 4).unwrap();
        let mut record = Record::new(&mut strategy).unwrap();
        let mut hall = HallOfFame::default();
        let history = |record: &Record| {
            let fresh = move || Ok(AnyStrategy::from_words(Populations::truncation(&[config; 3], 4).unwrap()));
            History::new("record".into(), record.clone(), Box::new(fresh))
        };
        for generation in 0..7 {
            let meeting = Pairing { generation, populations: 3, size: 6, trials: TRIALS };
            let peers = genotype.decode_all(strategy.ask()).unwrap();
            let opponents = hall.opponents(meeting, &peers).unwrap();
            let resumed = HallOfFame::before(&history(&record), &genotype).unwrap();
            assert_eq!(resumed.opponents(meeting, &peers).unwrap(), opponents);
            assert_eq!(opponents.len(), TRIALS * 18 * 2);
            let opponents: Vec<Vec<f32>> = opponents.into_iter().map(<[f32]>::to_vec).collect();
            let fitness: Vec<_> =
                (0..18_u32).map(|i| Fitness::nan_as_failed(f64::from((i * 5 + generation) % 7))).collect();
            let best = strategy.champions(&fitness).iter().map(|&best| peers[best].clone()).collect();
            record.tell(&mut strategy, &fitness).unwrap();
            hall.add(best);
            let history = history(&record);
            for individual in 0..18 {
                let genes = opponents_of(&history, generation, individual, 0..TRIALS as u32, TRIALS).unwrap();
                for (trial, genes) in genes.iter().enumerate() {
                    let first = 2 * (18 * trial + individual);
                    let met: Vec<Vec<f32>> = genes.iter().map(|genes| genes.decode(&genotype).unwrap()).collect();
                    assert_eq!(met, opponents[first..first + 2]);
                }
            }
        }
    }
}
