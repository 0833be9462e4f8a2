//! Result of a run.

use serde::Serialize;

use crate::escaped::OneLine;
use crate::figures::significant::significant;
use crate::run::records::{Best, Champions};

/// Result of a run.
#[derive(Debug, Serialize)]
pub(crate) struct Summary {
    pub(crate) directory: String,
    pub(crate) experiment: String,
    pub(crate) condition: String,
    pub(crate) seed: u64,
    pub(crate) generations: u32,
    /// Evaluations by this process, without those of earlier sessions.
    pub(crate) evaluations: u64,
    pub(crate) seconds: f64,
    /// Champion of the first population. `None` if no generation was left.
    pub(crate) champion: Option<Winner>,
    /// Champions of all populations, if there are several.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) champions: Vec<Winner>,
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

impl Winner {
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

impl Summary {
    /// Formats the summary as one line.
    pub(crate) fn text(&self) -> String {
        let (directory, generations) = (OneLine(&self.directory), self.generations);
        if let [Winner { generation, .. }, ..] = self.champions.as_slice() {
            let all = self.champions.iter().map(|Winner { population, individual, fitness, .. }| {
                let name = population.as_deref().unwrap_or_default();
                format!("{} individual {individual}, fitness {}", OneLine(name), significant(*fitness))
            });
            let all = all.collect::<Vec<_>>().join("; ");
            return format!("{directory}: {generations} generations; champions of generation {generation}: {all}");
        }
        match &self.champion {
            None => format!("{directory}: all {generations} generations are finished already"),
            Some(Winner { generation, individual, fitness, .. }) => format!(
                "{directory}: {generations} generations; champion: individual {individual} of generation {generation}, \
                 fitness {}",
                significant(*fitness)
            ),
        }
    }
}
