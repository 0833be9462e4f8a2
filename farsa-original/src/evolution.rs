//! The evolutionary algorithm.

use farsa_lab::Error;

use crate::ini::Group;
use crate::remarks::Remarks;
use crate::written::{Written, number};

/// The search and its runs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Evolution {
    generations: u64,
    search: Search,
    /// Seed of the first run. 0 is any seed.
    pub(super) seed: u64,
    /// Runs, each with its own seed.
    pub(super) replications: u64,
}

/// The algorithm.
#[derive(Clone, Debug, PartialEq)]
enum Search {
    /// One parent and one mutant, with the first and the last mutation rate and the step between them.
    OnePlusOne { first: f64, step: f64, last: f64 },
    /// Copies of the best individuals, mutated at one rate.
    Truncation { population: u64, parents: u64, rate: f64 },
}

/// Keys of xNES and of modular genomes, which steady state and generational search do not use.
const OF_OTHERS: [&str; 29] = [
    "mutationRange",
    "offspringMutRange",
    "useGaussian",
    "gaussianMean",
    "gaussianStdDev",
    "offspringStdDev",
    "variableStdDev",
    "numStartInd",
    "mutationLearningRate",
    "xnesCombination",
    "xnesCombinationType",
    "backPropOffspringUtilityRank",
    "backPropOffspringFitnessIncrease",
    "backPropOffspringFitnessIncreasePercentage",
    "pheGen",
    "standardNes",
    "minimization",
    "debugPrintInfoToFile",
    "dissociateInd",
    "dissociateCovMatrix",
    "specialUtilityRanking",
    "numModules",
    "crossoverRate",
    "modulesMutationRate",
    "mutateOnlyRelatives",
    "overwriteRate",
    "selectionType",
    "rankBasedProbability",
    "targetRetentionRate",
];

/// Most individuals of a strategy.
const MAX_INDIVIDUALS: u64 = 1_000_000;

impl Evolution {
    /// Reads the group of the genetic algorithm, `Evoga`.
    ///
    /// # Errors
    /// [`Error::Usage`] for too many individuals.
    pub(super) fn from_group(file: &str, group: &Group, remarks: &mut Remarks) -> Result<Self, Error> {
        let kind = group.kind(remarks);
        if let Some((name, entry)) = kind.filter(|(name, _)| name != "Evoga") {
            let why = format!("`{name}` is an algorithm of a plugin; what it shares with `Evoga` is read as that says");
            remarks.lost(group, entry, &why);
        }
        let generations = group.whole("ngenerations", 100, 1..=u64::from(u32::MAX) - 1, remarks);
        let replications = group.whole("nreplications", 10, 1..=1_000_000, remarks);
        let seed = group.whole("seed", 1234, 0..=u64::from(u32::MAX), remarks);
        let parents = group.whole("nreproducing", 20, 1..=MAX_INDIVIDUALS, remarks);
        let offspring = group.whole("noffspring", 5, 1..=MAX_INDIVIDUALS, remarks);
        let population = parents * offspring;
        if population > MAX_INDIVIDUALS / 2 {
            let most = MAX_INDIVIDUALS / 2;
            return Err(Error::Usage(format!("{file}: a population of {population} where {most} is the most")));
        }
        // Values from 1 on are percentages.
        let share = |rate: f64| if rate >= 1.0 { rate / 100.0 } else { rate };
        let last = share(group.number("mutation_rate", 0.05, 0.0..=100.0, remarks));
        let kind = group.word("evolutionType", "steadyState", remarks);
        let search = match &*kind {
            "generational" => generational(group, [parents, offspring], last, remarks),
            other => {
                if other != "steadystate" {
                    let why = "is no type of evolution that is known; taken for `steadyState`";
                    remarks.lost_or_default(group, group.find("evolutionType"), ["", ""], why);
                }
                steady_state(group, population, last, remarks)
            }
        };
        group.lost(&[("limitRetention", "false")], "no strategy here limits how many offspring stay", remarks);
        group.idle(&["savenbest", "savePopulationEachNGenerations", "saveRetetionStatistics"], SAVED, remarks);
        group.idle(&["numThreads"], "results are the same with any; `farsa run --threads` sets them", remarks);
        group.idle(&OF_OTHERS, "is of another kind of evolution", remarks);
        Ok(Self { generations, search, seed, replications })
    }

    pub(super) fn write(&self, out: &mut Written) {
        out.table("[genome]");
        out.set("bits", 8);
        if matches!(self.search, Search::OnePlusOne { .. }) {
            out.table("[strategy]");
            out.word("name", "one-plus-one");
        }
        out.table("[evolution]");
        out.set("generations", self.generations);
        match &self.search {
            Search::OnePlusOne { first, step, last } => {
                out.word("mutation", "flip");
                out.set("first_rate", number(*first));
                out.set("rate_step", number(*step));
                out.set("last_rate", number(*last));
            }
            Search::Truncation { population, parents, rate } => {
                out.set("population", population);
                out.set("parents", parents);
                out.word("mutation", "flip");
                out.set("mutation_rate", number(*rate));
            }
        }
    }
}

const SAVED: &str = "a run here saves all that it takes to go on, to rebuild any generation and to test its champion";

/// Reads the steady state: each individual makes one mutant, and the better half of all survives.
fn steady_state(group: &Group, population: u64, last: f64, remarks: &mut Remarks) -> Search {
    let first = group.number("initial_mutation", 0.5, 0.0..=1.0, remarks);
    let step = group.number("mutation_decay", 0.01, 0.0..=1.0, remarks);
    let mean = group.flag("averageIndividualFitnessOverGenerations", true, remarks);
    group.idle(&["elitism"], "the steady state of the original does not use it", remarks);
    let entry = |key| group.find(key);
    if population == 1 {
        if !mean {
            let why = "`one-plus-one` takes the mean fitness of its parent over all its evaluations";
            remarks.lost_or_default(group, entry("averageIndividualFitnessOverGenerations"), ["", ""], why);
        }
        if first < last {
            let why = format!("the rate does not rise here: it is {last} from the first generation on");
            remarks.lost_or_default(group, entry("initial_mutation"), ["initial_mutation", "0.5"], &why);
        }
        return Search::OnePlusOne { first: first.max(last), step, last };
    }
    if first > last {
        let why = format!("the rate of `truncation` does not fall: it is {last} from the first generation on");
        remarks.lost_or_default(group, entry("initial_mutation"), ["initial_mutation", "0.5"], &why);
        remarks.lost_or_default(group, entry("mutation_decay"), ["mutation_decay", "0.01"], &why);
    }
    if mean {
        let why = "`truncation` compares the fitness of one generation, with parents that are evaluated anew in each";
        let key = "averageIndividualFitnessOverGenerations";
        remarks.lost_or_default(group, entry(key), [key, "true"], why);
    }
    // A generation consists of the parents and a mutant of each.
    Search::Truncation { population: 2 * population, parents: population, rate: last }
}

/// Reads the generational search: the best make copies, all of them mutated except those of the elite.
fn generational(group: &Group, [parents, offspring]: [u64; 2], rate: f64, remarks: &mut Remarks) -> Search {
    let elitism = group.flag("elitism", false, remarks);
    let entry = |key| group.find(key);
    let why = if elitism {
        "the first copy of each parent stays unchanged here, in place of all copies of the best one"
    } else {
        "the first copy of each parent stays unchanged here; there all copies mutate"
    };
    remarks.lost_or_default(group, entry("elitism"), ["elitism", "false"], why);
    group.idle(
        &["initial_mutation", "mutation_decay"],
        "generations of the original mutate at `mutation_rate`",
        remarks,
    );
    group.idle(&["averageIndividualFitnessOverGenerations"], "generations of the original do not use it", remarks);
    if offspring == 1 {
        let why = "with one copy of each parent nothing is selected there; here each has a mutant beside it";
        remarks.lost_or_default(group, entry("noffspring"), ["noffspring", "5"], why);
    }
    Search::Truncation { population: parents * offspring.max(2), parents, rate }
}
