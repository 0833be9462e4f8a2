//! Strategies with several scores per individual: refused shapes, records, and coupled populations.

use crate::errors;
use farsa_evo::coevolution::Populations;
use farsa_evo::{EvoError, Fitness, Population, Record, ScoreShape, Scores, Snapshot, Strategy, check_strategy};
use farsa_num::{Domain, Stream};

const SHAPE: ScoreShape = ScoreShape::new(2, 1);

/// Half of it descends from the individual with the largest second objective, half from the one with the largest measure.
#[derive(Clone, Debug, PartialEq)]
struct Extremes {
    generation: u32,
    population: Population,
    /// Accepts scores of any shape.
    careless: bool,
}

impl Extremes {
    fn new(careless: bool) -> Result<Self, EvoError> {
        Ok(Self { generation: 0, population: Population::new(6, 2)?, careless })
    }

    fn next(&mut self, best: [usize; 2]) {
        self.generation += 1;
        let old = self.population.clone();
        for (individual, genes) in self.population.iter_mut().enumerate() {
            let mut stream = Stream::new(1, Domain::Mutation, 0, individual as u32, self.generation);
            let parent = old.get(best[individual % 2]).unwrap();
            genes.iter_mut().zip(parent).for_each(|(gene, parent)| *gene = parent ^ (1 << stream.below(16)));
        }
    }
}

impl Strategy for Extremes {
    fn generation(&self) -> u32 {
        self.generation
    }

    fn ask(&self) -> &Population {
        &self.population
    }

    fn score_shape(&self) -> ScoreShape {
        SHAPE
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        if self.careless && fitness.len() == self.population.len() {
            self.next([0, 0]);
            return Ok(());
        }
        SHAPE.check(ScoreShape::FITNESS)
    }

    fn tell_scores(&mut self, scores: &Scores) -> Result<(), EvoError> {
        scores.check(SHAPE, self.population.len())?;
        let largest = |value: &dyn Fn(usize) -> f64| {
            (0..scores.len()).max_by(|a, b| value(*a).total_cmp(&value(*b)).then(b.cmp(a))).unwrap()
        };
        self.next([largest(&|i| scores.objectives(i)[1]), largest(&|i| scores.measures(i)[0].abs())]);
        Ok(())
    }
}

impl Snapshot for Extremes {
    fn save(&self) -> Vec<u8> {
        let genes = self.population.as_slice().iter().flat_map(|gene| gene.to_le_bytes());
        self.generation.to_le_bytes().into_iter().chain(genes).collect()
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
        let wrong = errors::state_length(28, state.len());
        let (generation, genes) = state.split_first_chunk::<4>().filter(|_| state.len() == 28).ok_or(wrong)?;
        self.generation = u32::from_le_bytes(*generation);
        let genes = genes.as_chunks::<2>().0.iter().map(|gene| u16::from_le_bytes(*gene));
        self.population.iter_mut().flatten().zip(genes).for_each(|(gene, saved)| *gene = saved);
        Ok(())
    }
}

fn judge(genes: &[u16], row: &mut [f64]) {
    let [a, b] = [0, 1].map(|i| f64::from(genes[i].count_ones()));
    row.copy_from_slice(&[a, -b, 0.5 * a - b]);
    if genes[0].is_multiple_of(7) && genes[0] != 0 {
        row[1] = f64::NAN;
    }
}

fn scores(strategy: &impl Strategy) -> Scores {
    let mut values = vec![0.0; strategy.ask().len() * 3];
    strategy.ask().iter().zip(values.chunks_mut(3)).for_each(|(genes, row)| judge(genes, row));
    Scores::nan_as_failed(SHAPE, values).unwrap()
}

#[test]
fn it_conforms() {
    check_strategy(|| Extremes::new(false), 20).unwrap();
    check_strategy(|| Populations::new(2, 1, |_| Extremes::new(false)), 20).unwrap();
    let error = check_strategy(|| Extremes::new(true), 20).unwrap_err();
    assert_eq!(error, "generation 0: takes judgements of another shape, or is changed by them");
}

#[test]
fn a_record_rebuilds_any_generation() {
    let mut strategy = Extremes::new(false).unwrap();
    let mut record = Record::new(&mut strategy).unwrap();
    let (mut asked, mut history) = (Vec::new(), Vec::new());
    for _ in 0..30 {
        asked.push(strategy.ask().clone());
        history.push(scores(&strategy));
        record.tell_scores(&mut strategy, history.last().unwrap()).unwrap();
    }
    assert!(history.iter().any(|scores| (0..6).any(|i| scores.is_failed(i))), "none failed");
    assert_eq!(record.bytes(), 30 * (1 + 6 * 3 * 8));
    for (generation, asked) in (0..).zip(&asked) {
        assert_eq!(&record.genomes(&mut Extremes::new(false).unwrap(), generation).unwrap(), asked);
        let fitness = history[generation as usize].fitness();
        assert_eq!(record.order(generation).unwrap()[0], record.champion(0, generation).unwrap());
        assert_eq!(fitness.iter().max(), Some(&fitness[record.champion(0, generation).unwrap()]));
    }
    // Entry by entry, like a file that grows with each generation.
    let mut read = Record::new(&mut Extremes::new(false).unwrap()).unwrap();
    (0..30).for_each(|generation| read.push(record.entry(generation).unwrap()).unwrap());
    assert_eq!(read, record);
    let mut damaged = record.entry(3).unwrap().frame.to_vec();
    damaged[1..9].fill(0xff);
    assert_eq!(read.push(farsa_evo::RecordEntry { frame: &damaged, state: None }), Err(EvoError::NanFitness));
    #[cfg(feature = "serde")]
    {
        let bytes = postcard::to_allocvec(&history).unwrap();
        assert_eq!(postcard::from_bytes::<Vec<Scores>>(&bytes).unwrap(), history);
        let nan = postcard::to_allocvec(&(SHAPE, [Some(1.0), Some(f64::NAN), Some(0.0)].as_slice())).unwrap();
        assert!(postcard::from_bytes::<Scores>(&nan).is_err());
        let mut bytes = postcard::to_allocvec(&record).unwrap();
        assert_eq!(postcard::from_bytes::<Record>(&bytes).unwrap(), record);
        // The kind, the objectives and the measures, followed by populations and the rest.
        assert_eq!(bytes[..6], [3, 2, 1, 1, 6, 2]);
        bytes[1] = 0;
        assert!(postcard::from_bytes::<Record>(&bytes).is_err());
    }
}

#[test]
fn other_shapes_are_refused_everywhere() {
    let mut strategy = Extremes::new(false).unwrap();
    let mut record = Record::new(&mut strategy).unwrap();
    let before = strategy.clone();
    let fitness = [Fitness::WORST; 6];
    let error = errors::score_shape(SHAPE, ScoreShape::FITNESS);
    let text =
        "1 objective and 0 descriptor values of each individual where 2 objectives and 1 descriptor value are expected";
    assert_eq!(error.to_string(), text);
    assert_eq!(strategy.tell(&fitness), Err(error.clone()));
    assert_eq!(record.tell(&mut strategy, &fitness), Err(error.clone()));
    assert_eq!(record.tell_scores(&mut strategy, &Scores::from_fitness(&fitness)), Err(error));
    let few = Scores::new(SHAPE, vec![0.0; 15]).unwrap();
    assert_eq!(strategy.tell_scores(&few), Err(errors::fitness_count(6, 5)));
    assert_eq!((strategy, record.generations()), (before, 0));

    // A strategy of plain fitness accepts scores of one objective only.
    let mut plain = farsa_evo::words::RandomSearch::new(2, 6, 1).unwrap();
    let scores = Scores::new(SHAPE, vec![0.0; 18]).unwrap();
    let many = errors::score_shape(ScoreShape::FITNESS, SHAPE);
    assert_eq!(plain.tell_scores(&scores), Err(many));
    plain.tell_scores(&Scores::from_fitness(&fitness)).unwrap();
    assert_eq!(plain.generation(), 1);
    // A record with another score shape belongs to another strategy.
    assert!(matches!(record.check(&plain), Err(EvoError::Record { .. })));
}

#[test]
fn zeros_have_the_same_bits_whatever_their_sign() {
    let scores = Scores::new(SHAPE, vec![-0.0; 3]).unwrap();
    assert!(scores.values().iter().all(|x| x.to_bits() == 0), "{scores:?}");
}

#[test]
fn scores_are_counted_by_rows() {
    for individuals in [0, 1, 5] {
        let scores = Scores::new(SHAPE, vec![0.0; 3 * individuals]).unwrap();
        assert_eq!((scores.len(), scores.is_empty()), (individuals, individuals == 0));
    }
}

#[test]
fn evolve_names_the_best_by_the_first_objective() {
    let mut strategy = Extremes::new(false).unwrap();
    let mut best = f64::NEG_INFINITY;
    let champion = strategy
        .evolve(40, |genes, row| {
            judge(genes, row);
            best = if row[1].is_nan() { best } else { best.max(row[0]) };
        })
        .unwrap();
    assert_eq!((strategy.generation(), champion.fitness.get()), (40, best));
    assert_eq!(f64::from(champion.genome[0].count_ones()), best);
}
