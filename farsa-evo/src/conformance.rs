//! A check that a strategy follows the rules. You can use this to test your own strategies.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use farsa_num::{Domain, Stream};

use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::gene::Gene;
use crate::recording::{Record, RecordWriter};
use crate::score_shape::ScoreShape;
use crate::scores::Scores;
use crate::strategy::Member;
use crate::strategy::{RecordKind, Strategy};

/// Checks over the given number of generations that a strategy follows the rules of [`Strategy`]. Use this in the tests
/// of a custom strategy. Note that `fresh` must return the same strategy each time.
///
/// The check covers these rules:
///
/// - `ask` returns the same genomes twice. A second strategy with the same fitness returns the same genomes and
///   [`diagnostics`](Strategy::diagnostics), also through a [`Record`] and through a saved state after every generation.
/// - A wrong number of values, or scores of another shape, is an error and changes nothing.
/// - Generations are counted, and each population has a champion.
/// - With [`RecordKind::Order`], other values of the same order change nothing.
/// - A generation in which some or all evaluations failed does not stop the search.
/// - The members of a [`Collection`](crate::Collection) are evaluated individuals with their scores.
/// - With [`Opponents`](crate::Opponents), all individuals have the same number of opponents, one of each other population.
///
/// ```
/// use farsa_evo::check_strategy;
/// use farsa_evo::words::{GaConfig, TruncationGa};
///
/// let config = GaConfig { population: 10, parents: 5, ..GaConfig::new(4) };
/// check_strategy(|| TruncationGa::new(config, 7), 20)?;
/// # Ok::<(), String>(())
/// ```
///
/// # Errors
/// A message with the broken rule and the generation.
pub fn check_strategy<G, S>(fresh: impl Fn() -> Result<S, EvoError>, generations: u32) -> Result<(), String>
where
    G: Gene,
    S: Strategy<G>,
{
    let made = || fresh().map_err(|error| format!("cannot be made: {error}"));
    let (mut strategy, mut again) = (made()?, made()?);
    let mut record = Record::new(&mut strategy).map_err(|error| format!("no record: {error}"))?;
    let mut writer = RecordWriter::new(&mut again).map_err(|error| format!("no record elsewhere: {error}"))?;
    let mut asked: Vec<u64> = Vec::new();
    let mut history: Vec<Scores> = Vec::new();
    let mut numbers = None;
    for generation in 0..generations {
        let wrong = |what: &str| format!("generation {generation}: {what}");
        if strategy.generation() != generation {
            return Err(wrong("another number of generation"));
        }
        let digest = strategy.ask().digest();
        if digest != strategy.ask().digest() || digest != again.ask().digest() {
            return Err(wrong("other genomes where the same are asked for"));
        }
        asked.push(digest);
        let count = strategy.ask().len();
        if !count.is_multiple_of(strategy.populations()) {
            return Err(wrong("populations of unequal sizes"));
        }
        let shape = strategy.score_shape();
        opponents(&strategy).map_err(|what| wrong(&what))?;
        let scores = scores(generation, count, shape);
        let fitness = scores.fitness();
        refuses(&mut strategy, &scores).map_err(|what| wrong(&what))?;
        let champions = strategy.champions(&strategy.ranked_by(&fitness));
        let size = count / strategy.populations();
        if !champions.iter().copied().map(|best| best / size).eq(0..strategy.populations()) {
            return Err(wrong("names other champions than one of each population"));
        }
        // Another fitness of the same order has to do where only the order counts.
        let other: Vec<Fitness> = match strategy.record_kind() {
            RecordKind::Order => fitness.iter().map(|fitness| rising(*fitness)).collect(),
            _ => fitness.clone(),
        };
        let (told, told_again) = if shape == ScoreShape::FITNESS {
            (record.tell(&mut strategy, &fitness), writer.tell(&mut again, &other))
        } else {
            (record.tell_scores(&mut strategy, &scores), writer.tell_scores(&mut again, &scores))
        };
        told.map_err(|error| wrong(&format!("cannot be told: {error}")))?;
        told_again.map_err(|error| wrong(&format!("cannot be told by value: {error}")))?;
        if writer.entry() != record.entry(generation) {
            return Err(wrong("is recorded otherwise the second time"));
        }
        let (said, said_again) = (strategy.diagnostics(), again.diagnostics());
        if !said.iter().map(|x| x.to_bits()).eq(said_again.iter().map(|x| x.to_bits())) {
            return Err(wrong("says other numbers of itself the second time"));
        }
        if *numbers.get_or_insert(said.len()) != said.len() {
            return Err(wrong("says another count of numbers of itself than before"));
        }
        again = restored(again, made()?).map_err(|what| wrong(&what))?;
        history.push(scores);
        if let Some(collection) = strategy.collection() {
            kept(&collection.members(), &history).map_err(|what| wrong(&what))?;
        }
    }
    if strategy.record_kind() == RecordKind::Genomes {
        return Ok(());
    }
    for (generation, digest) in (0..).zip(&asked) {
        let mut rebuilt = made()?;
        let done = record.rebuild(&mut rebuilt, generation);
        done.map_err(|error| format!("generation {generation}: cannot be rebuilt: {error}"))?;
        if rebuilt.ask().digest() != *digest {
            return Err(format!("generation {generation}: has other genomes when it is rebuilt"));
        }
    }
    Ok(())
}

/// Checks that all individuals have the same number of opponents and an objective for each.
fn opponents<G: Gene, S: Strategy<G>>(strategy: &S) -> Result<(), String> {
    let Some(opponents) = strategy.opponents() else { return Ok(()) };
    let (count, all) = (opponents.count(), strategy.ask().len());
    if count == 0 || strategy.score_shape() != ScoreShape::new(1 + count, 0) {
        return Err(format!("says whom {count} opponents are, and is judged by {}", strategy.score_shape()));
    }
    let genes = strategy.ask().genome_len();
    let others = |individual, opponent| {
        let met = opponents.opponents_of(individual, opponent);
        met.iter().all(|genome| genome.len() == genes).then_some(met.len())
    };
    let wanted = Some(strategy.populations() - 1);
    let everyone = (0..all).all(|individual| (0..count).all(|opponent| others(individual, opponent) == wanted));
    let nobody = others(all, 0) == Some(0) && others(0, count) == Some(0);
    if everyone && nobody { Ok(()) } else { Err("names opponents other than one of each other population".into()) }
}

/// Checks that members are distinct individuals of past generations, with the scores of their evaluations.
fn kept(members: &[Member<'_>], history: &[Scores]) -> Result<(), String> {
    let mut origins = Vec::with_capacity(members.len());
    for &Member { objectives, measures, generation, individual, .. } in members {
        let told = history.get(generation as usize);
        let same =
            told.is_some_and(|told| (told.objectives(individual), told.measures(individual)) == (objectives, measures));
        if !same {
            return Err(format!("keeps an individual {individual} of generation {generation} that it was not told of"));
        }
        origins.push((generation, individual));
    }
    origins.sort_unstable();
    if origins.windows(2).any(|pair| pair[0] == pair[1]) { Err("keeps an individual twice".into()) } else { Ok(()) }
}

/// Returns a fresh strategy with the state of another, after checking that the two are equal and that a truncated state is
/// an error. A strategy without saved states is returned itself.
fn restored<G: Gene, S: Strategy<G>>(mut strategy: S, mut fresh: S) -> Result<S, String> {
    let Some(state) = strategy.snapshot().map(|snapshot| snapshot.save()) else { return Ok(strategy) };
    if strategy.snapshot().is_some_and(|snapshot| snapshot.snapshot_interval() == 0) {
        return Err("wants 0 generations between its states, where 1 is the least".into());
    }
    let Some(snapshot) = fresh.snapshot() else { return Err("saves states, and when it is fresh none".into()) };
    snapshot.restore(&state).map_err(|error| format!("cannot be restored: {error}"))?;
    if snapshot.restore(&state[..state.len().saturating_sub(1)]).is_ok() {
        return Err("takes a state that is too short".into());
    }
    if snapshot.save() != state {
        return Err("saves another state than the one that it was restored from".into());
    }
    let same = fresh.generation() == strategy.generation() && fresh.ask().digest() == strategy.ask().digest();
    if same { Ok(fresh) } else { Err("is another after its state was restored".into()) }
}

/// Checks that too few scores, scores of another shape and fitness instead of scores are errors that change nothing.
fn refuses<G: Gene, S: Strategy<G>>(strategy: &mut S, scores: &Scores) -> Result<(), String> {
    let (shape, digest) = (scores.shape(), strategy.ask().digest());
    let (generation, count) = (strategy.generation(), scores.len());
    let other = ScoreShape::new(shape.objectives + 1, shape.measures);
    let few = strategy.tell(&scores.fitness()[1..]).is_ok()
        || strategy.tell_scores(&self::scores(generation, count - 1, shape)).is_ok();
    if few || strategy.ask().digest() != digest {
        return Err("takes too few values, or is changed by them".into());
    }
    let others = strategy.tell_scores(&self::scores(generation, count, other)).is_ok()
        || shape != ScoreShape::FITNESS && strategy.tell(&scores.fitness()).is_ok();
    if others || strategy.ask().digest() != digest || strategy.generation() != generation {
        return Err("takes judgements of another shape, or is changed by them".into());
    }
    Ok(())
}

/// Scores of no meaning: fitness, as below, then more numbers of the same kind.
fn scores(generation: u32, count: usize, shape: ScoreShape) -> Scores {
    let mut stream = Stream::new(u64::from(generation), Domain::General, 1, 0, 0);
    let mut row = |fitness: Fitness| {
        let mut row = Vec::with_capacity(shape.width());
        row.push(fitness.get());
        row.extend((1..shape.width()).map(|_| 0.25 * f64::from(stream.below(30)) - 3.0));
        row
    };
    let values: Vec<f64> = values(generation, count).into_iter().flat_map(&mut row).collect();
    Scores::nan_as_failed(shape, values).unwrap_or_else(|_| Scores::from_fitness(&[]))
}

/// Fitness of no meaning: in every fifth generation all alike, in every seventh all failed, else some failed and some equal.
fn values(generation: u32, count: usize) -> Vec<Fitness> {
    let mut stream = Stream::new(u64::from(generation), Domain::General, 0, 0, 0);
    let mut one = || match (generation % 5, generation % 7) {
        (_, 6) => Fitness::WORST,
        (4, _) => Fitness::nan_as_failed(1.5),
        _ if stream.uniform_f64() < 0.1 => Fitness::WORST,
        _ => Fitness::nan_as_failed(0.5 * f64::from(stream.below(40)) - 10.0),
    };
    (0..count).map(|_| one()).collect()
}

/// Another fitness of the same order.
fn rising(fitness: Fitness) -> Fitness {
    let x = fitness.get();
    Fitness::nan_as_failed(if fitness.is_failed() { x } else { x * x * x + 7.0 * x })
}
