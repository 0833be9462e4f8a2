//! Learning as a strategy: one individual, which is trained by an iteration after each generation.

use farsa_evo::{EvoError, Fitness, Population, RecordKind, Snapshot, Strategy};

use crate::error::Error;
use crate::experiment::evaluator::{Evaluator, Iteration};
use crate::experiment::genotype::Genotype;
use crate::experiment::settings::Setting;
use crate::strategy::any_strategy::AnyStrategy;
use crate::strategy::definition::{Diagnostics, DiagnosticsChart, StrategyDefinition, StrategyStart};
use crate::strategy::settings::GENERATIONS;

/// A strategy that only learns. Each generation consists of a single individual, so there is no selection. It is
/// first evaluated, and then trained by an iteration of [`Learner::iterate`](crate::advanced::Learner::iterate).
///
/// Note that the log of such a run repeats one fitness three times. You can find the errors in `learning.csv`.
#[derive(Debug, Clone, Copy)]
pub struct Learning;

impl StrategyDefinition for Learning {
    fn name(&self) -> &'static str {
        "learning"
    }

    fn summary(&self) -> &'static str {
        "Nothing is selected: one individual is trained by demonstrations after each generation."
    }

    fn settings(&self) -> Vec<Setting> {
        vec![Setting::whole(GENERATIONS, 300, 1..=i64::from(u32::MAX) - 1).doc(
            "Iterations of training, each after an evaluation of the network. A resumed run may change it, and nothing else.",
        )]
    }

    fn start(&self, start: &StrategyStart<'_>) -> Result<AnyStrategy, Error> {
        if start.populations != 1 {
            return Err(Error::Other(format!("{} populations that learn", start.populations)));
        }
        let mut evaluator = (start.evaluator)()?;
        let Some(learner) = evaluator.learner() else {
            return Err(Error::Other("has nothing to learn from: the strategy `learning` needs demonstrations, in a file by its table `learning`".into()));
        };
        let state = learner.initial_state(start.seed);
        let learned = learner.learned(&state);
        let genotype = Genotype::new(&evaluator.info().parameters, start.gene_bits);
        let population = individual(&genotype, &learned).map_err(|error| Error::Other(error.to_string()))?;
        let latest = None;
        Ok(AnyStrategy::from_words(Trainee {
            evaluator,
            genotype,
            seed: start.seed,
            generation: 0,
            latest,
            state,
            population,
        }))
    }

    fn diagnostics(&self) -> Option<Diagnostics> {
        const ERROR: DiagnosticsChart = DiagnosticsChart {
            title: "error of motor values",
            axis: "error",
            curves: &[("error before", "before the iteration"), ("error after", "after it")],
        };
        const SUCCESSES: DiagnosticsChart = DiagnosticsChart {
            title: "successes while guided",
            axis: "share",
            curves: &[("successes", "of the demonstrations")],
        };
        Some(Diagnostics { file: "learning", charts: &[ERROR, SUCCESSES] })
    }
}

/// An individual that learns.
struct Trainee {
    /// Whose learner is trained.
    evaluator: Box<dyn Evaluator>,
    genotype: Genotype,
    seed: u64,
    /// Number of iterations.
    generation: u32,
    latest: Option<Iteration>,
    /// State that iterations change.
    state: Vec<f64>,
    /// Individual alone.
    population: Population,
}

/// Builds the individual of what has been learned.
fn individual(genotype: &Genotype, learned: &[f64]) -> Result<Population, EvoError> {
    let expected = genotype.genes();
    let lengths = || EvoError::lengths(learned.len(), expected, expected);
    let genes = genotype.encode(learned).ok_or_else(lengths)?;
    let mut population = Population::new(1, genes.len())?;
    population.iter_mut().for_each(|genome| genome.copy_from_slice(&genes));
    Ok(population)
}

impl Strategy for Trainee {
    fn generation(&self) -> u32 {
        self.generation
    }

    fn ask(&self) -> &Population {
        &self.population
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        if fitness.len() != 1 {
            return Err(EvoError::fitness_count(1, fitness.len()));
        }
        let next = self.generation.checked_add(1).ok_or(EvoError::LastGeneration)?;
        let mut state = self.state.clone();
        let values = state.len() as u64;
        let refused = || EvoError::state_content("a number of values to learn from", values);
        let learner = self.evaluator.learner().ok_or_else(refused)?;
        let iteration = learner.iterate(&mut state, self.seed, self.generation).ok_or_else(refused)?;
        self.population = individual(&self.genotype, &learner.learned(&state))?;
        (self.generation, self.latest, self.state) = (next, Some(iteration), state);
        Ok(())
    }

    fn record_kind(&self) -> RecordKind {
        RecordKind::Genomes
    }

    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        Some(self)
    }

    fn diagnostics(&self) -> Vec<f64> {
        self.latest.map_or_else(Vec::new, |Iteration { before, after, successes }| vec![before, after, successes])
    }
}

impl Snapshot for Trainee {
    fn save(&self) -> Vec<u8> {
        let mut bytes = Vec::from(self.generation.to_le_bytes());
        bytes.extend(self.state.iter().flat_map(|value| value.to_le_bytes()));
        bytes
    }

    fn restore(&mut self, saved: &[u8]) -> Result<(), EvoError> {
        let expected = 4 + 8 * self.state.len();
        let lengths = || EvoError::state_length(expected, saved.len());
        let (generation, values) = saved.split_first_chunk::<4>().ok_or_else(lengths)?;
        let (values, rest) = values.as_chunks::<8>();
        if values.len() != self.state.len() || !rest.is_empty() {
            return Err(lengths());
        }
        let state: Vec<f64> = values.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect();
        let learner = self.evaluator.learner().ok_or_else(lengths)?;
        self.population = individual(&self.genotype, &learner.learned(&state))?;
        (self.generation, self.latest, self.state) = (u32::from_le_bytes(*generation), None, state);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::evaluator::{Evaluation, Learner, Task, TaskInfo};
    use crate::experiment::outcome::Outcome;
    use crate::experiment::parameter::Parameter;
    use crate::experiment::settings::Settings;
    use farsa_body::Recorder;
    use farsa_view::Schema;

    /// Learns from `seed` values, with one more gene after each iteration if there are two.
    struct Forgetful;

    impl Learner for Forgetful {
        fn initial_state(&self, seed: u64) -> Vec<f64> {
            vec![0.0; seed as usize]
        }
        fn iterate(&mut self, state: &mut [f64], _: u64, _: u32) -> Option<Iteration> {
            let [first, _] = state else { return None };
            *first += 1.0;
            Some(Iteration { before: 1.0, after: 0.5, successes: 0.0 })
        }
        fn learned(&self, state: &[f64]) -> Vec<f64> {
            vec![0.0; 1 + state.first().map_or(0, |value| *value as usize)]
        }
    }

    impl Task for Forgetful {
        fn info(&self) -> TaskInfo {
            TaskInfo::new(vec![Parameter::new("gene", [0.0, 1.0])], Schema::from_scalars(["none"]))
        }
    }

    impl Evaluator for Forgetful {
        fn evaluate(&mut self, _: Evaluation<'_>, _: Option<&mut dyn Recorder>) -> Outcome {
            Outcome::default()
        }
        fn learner(&mut self) -> Option<&mut dyn Learner> {
            Some(self)
        }
    }

    fn started(seed: u64) -> Box<dyn Strategy> {
        let settings = Settings::new(Learning.settings()).unwrap();
        let evaluator = || Ok(Box::new(Forgetful) as Box<dyn Evaluator>);
        let (populations, genes, gene_bits) = (1, 1, 16);
        let start = StrategyStart {
            populations,
            trials: 1,
            genes,
            gene_bits,
            objectives: 1,
            measures: &[],
            settings: &settings,
            seed,
            evaluator: &evaluator,
            limits: crate::limits::Limits::DEFAULT,
        };
        match Learning.start(&start).unwrap() {
            AnyStrategy::Words(strategy) => strategy,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn an_iteration_that_cannot_be_made_says_so_and_changes_nothing() {
        for (seed, says) in [(3, "3 is not a number of values to learn from"), (2, "2 genes, ranges for 1")] {
            let mut learning = started(seed);
            let before = (learning.ask().clone(), learning.snapshot().unwrap().save());
            let error = learning.tell(&[Fitness::WORST]).unwrap_err().to_string();
            assert!(error.starts_with(says), "{error}");
            assert_eq!((learning.ask().clone(), learning.snapshot().unwrap().save()), before);
        }
    }

    #[test]
    fn a_state_of_another_size_is_refused() {
        let mut learning = started(3);
        let saved = learning.snapshot().unwrap().save();
        assert_eq!(saved.len(), 28);
        assert!(learning.snapshot().unwrap().restore(&saved).is_ok());
        for bent in [&saved[..3], &saved[..20], &saved[..27], &[saved.as_slice(), &[0; 8]].concat()] {
            assert!(learning.snapshot().unwrap().restore(bent).is_err());
        }
    }
}
