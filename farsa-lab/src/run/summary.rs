//! Result of a run.

use std::path::{Path, PathBuf};

use serde::{Serialize, Serializer};

use crate::escaped::OneLine;
use crate::experiment::outcome::NO_CRITERION;
use crate::figures::significant::{counted, percent, remark, scored, significant};
use crate::run::records::{Best, Champions};

/// Result of a run.
#[derive(Debug, Serialize)]
pub(crate) struct Summary {
    #[serde(serialize_with = "displayed")]
    pub(crate) directory: PathBuf,
    pub(crate) experiment: String,
    pub(crate) condition: String,
    pub(crate) seed: u64,
    pub(crate) generations: u32,
    /// Evaluations by this process, without those of earlier sessions.
    pub(crate) evaluations: u64,
    /// Failed evaluations of all sessions.
    pub(crate) failed: u64,
    pub(crate) seconds: f64,
    /// Test of the champion, where one is asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) test: Option<ChampionTest>,
    /// Combination of the trials into the fitness. Empty for a single trial and for a run of an earlier process.
    #[serde(skip)]
    pub(crate) combined: String,
    /// Champion of the first population. `None` if no generation was left.
    pub(crate) champion: Option<Winner>,
    /// Champions of all populations, if there are several.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) champions: Vec<Winner>,
}

/// Serializes a path that need not be UTF-8.
fn displayed<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(&path.display())
}

#[derive(Debug, Clone, Serialize)]
pub(crate) struct Winner {
    /// Population, if there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) population: Option<String>,
    pub(crate) generation: u32,
    pub(crate) individual: u32,
    pub(crate) fitness: f64,
}

/// Test of a champion on fresh starts.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct ChampionTest {
    pub(crate) trials: usize,
    pub(crate) broken_down: usize,
    /// Share of the trials that succeeded, `None` without one.
    pub(crate) success: Option<f64>,
    /// False for a task that does not define success.
    #[serde(skip)]
    pub(crate) has_criterion: bool,
    /// Mean fitness of the trials, `None` if all broke down.
    pub(crate) fitness: Option<f64>,
}

impl ChampionTest {
    /// Formats the share of successes and the mean fitness of a trial.
    pub(crate) fn cells(test: Option<&Self>) -> [String; 2] {
        let Some(&Self { success, has_criterion, fitness, .. }) = test else { return ["–".into(), "–".into()] };
        let success = if has_criterion { percent(success.unwrap_or(f64::NAN)) } else { NO_CRITERION.into() };
        [success, fitness.map_or_else(|| "–".into(), significant)]
    }
}

impl Winner {
    /// Formats the fitness, unless every evaluation of its generation failed.
    fn scored(&self, combined: &str) -> String {
        let fitness = scored(self.fitness);
        if self.fitness.is_finite() {
            fitness + &remark(combined)
        } else {
            fitness + ", all evaluations of this generation failed"
        }
    }

    /// Lists the champions of all populations with the given names.
    pub(crate) fn from_champions(champions: &Champions, names: &[String]) -> Vec<Self> {
        let Champions { generation, best, .. } = champions;
        let winner = |(number, &Best { individual, fitness, .. }): (usize, &Best)| Self {
            population: names.get(number).filter(|_| best.len() > 1).cloned(),
            generation: *generation,
            individual,
            fitness: fitness.get(),
        };
        best.iter().enumerate().map(winner).collect()
    }
}

/// Formats a number of generations that are all finished.
pub(crate) fn finished_already(generations: u32) -> String {
    match generations {
        1 => "the only generation is finished already".into(),
        _ => format!("all {generations} generations are finished already"),
    }
}

impl Summary {
    /// Formats the summary as one line, and the test of the champion as a second one.
    pub(crate) fn text(&self) -> String {
        let Some(test) = &self.test else { return self.line() };
        let [success, fitness] = ChampionTest::cells(Some(test));
        let broken_down = match test.broken_down {
            0 => String::new(),
            failed => format!(", {failed} broke down"),
        };
        let success = if test.has_criterion { format!("success {success}") } else { format!("{success} of success") };
        format!(
            "{}\ntest of {}: {success}, mean fitness of a trial {fitness}{broken_down}",
            self.line(),
            counted(test.trials, "trial")
        )
    }

    fn line(&self) -> String {
        let directory = OneLine(self.directory.display());
        let generations = counted(self.generations as usize, "generation");
        if let [Winner { generation, .. }, ..] = self.champions.as_slice() {
            let all = self.champions.iter().map(|winner| {
                let (name, individual) = (winner.population.as_deref().unwrap_or_default(), winner.individual);
                format!("{} individual {individual}, {}", OneLine(name), winner.scored(&self.combined))
            });
            let all = all.collect::<Vec<_>>().join("; ");
            let champions = format!("champions of generation {generation}: {all}");
            return format!("{directory}: {generations}; {champions}{}", self.failures());
        }
        match &self.champion {
            None => format!("{directory}: {}", finished_already(self.generations)),
            Some(winner @ Winner { generation, individual, .. }) => format!(
                "{directory}: {generations}; champion: individual {individual} of generation {generation}, \
                 {}{}",
                winner.scored(&self.combined),
                self.failures()
            ),
        }
    }

    /// Formats the number of failed evaluations, if there are any.
    fn failures(&self) -> String {
        match self.failed {
            0 => String::new(),
            1 => "; 1 evaluation failed".into(),
            failed => format!("; {failed} evaluations failed"),
        }
    }

    /// Gets the fitness of the first champion, unless every evaluation of its generation failed.
    pub(crate) fn fitness(&self) -> Option<f64> {
        self.champion.as_ref().map(|champion| champion.fitness).filter(|fitness| fitness.is_finite())
    }
}
