//! `archive.csv` and its picture: the elites of an archive, or a front.

use farsa_evo::{Collection, Member, ScoreShape};

use crate::error::Error;
use crate::experiment::behavior::Behavior;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::parameter::Parameter;
use crate::figures::scatter::Scatter;
use crate::store::directory::Directory;
use crate::store::replace::replace;
use crate::strategy::any_strategy::AnyStrategy;

/// Names of the scores.
pub(crate) struct CollectionTable {
    /// Objectives, the fitness first.
    objectives: Vec<String>,
    measures: Vec<Parameter>,
}

impl CollectionTable {
    /// Creates the table of a strategy with an archive or front, and `None` for another.
    pub(crate) fn new(search: &AnyStrategy, evaluator: &dyn Evaluator) -> Option<Self> {
        search.collection()?;
        let ScoreShape { objectives, measures, .. } = search.score_shape();
        let behaviour = evaluator.behavior();
        let others = behaviour.map(Behavior::objectives).unwrap_or_default();
        let values = behaviour.map(Behavior::measures).unwrap_or_default();
        Some(Self {
            objectives: ["fitness".into()].into_iter().chain(others).take(objectives).collect(),
            measures: values.into_iter().take(measures).collect(),
        })
    }

    /// Writes the table and the picture.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub(crate) fn write(&self, search: &AnyStrategy, directory: &Directory, title: &str) -> Result<(), Error> {
        let members = members(search);
        let [csv, svg] = directory.diagnostics("archive");
        replace(&csv, &self.csv(&members).map_err(|why| Error::damaged(&csv, why))?)?;
        replace(&svg, self.picture(&members, title).as_bytes())
    }

    /// Draws the archive or front.
    pub(crate) fn drawn(&self, search: &AnyStrategy, title: &str) -> String {
        self.picture(&members(search), title)
    }

    /// Writes a line for each member, with the numbers for `farsa replay`.
    fn csv(&self, members: &[Member<'_>]) -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let names = self.objectives.iter().chain(self.measures.iter().map(|value| &value.name));
        writer.write_record(["cell", "generation", "individual"].into_iter().chain(names.map(String::as_str)))?;
        for member in members {
            let cell = member.cell.map_or_else(String::new, |cell| cell.to_string());
            let origin = [cell, member.generation.to_string(), member.individual.to_string()];
            // The debug form is the shortest that reads back as the same number.
            let numbers = member.objectives.iter().chain(member.measures).map(|x| format!("{x:?}"));
            writer.write_record(origin.into_iter().chain(numbers))?;
        }
        writer.into_inner().map_err(|error| csv::Error::from(std::io::Error::other(error.to_string())))
    }

    /// Draws the first two measures, or one and the fitness, or the first two objectives.
    fn picture(&self, members: &[Member<'_>], title: &str) -> String {
        let mut axes: Vec<(&str, Option<[f64; 2]>)> =
            self.measures.iter().map(|value| (value.name.as_str(), Some(value.ends))).collect();
        axes.extend(self.objectives.iter().map(|name| (name.as_str(), None)));
        let place = |member: &Member<'_>| {
            let mut numbers = member.measures.iter().chain(member.objectives).copied();
            [numbers.next().unwrap_or(0.0), numbers.next().unwrap_or(0.0)]
        };
        let best = |member: &Member<'_>| member.objectives.first().copied().unwrap_or(f64::NAN);
        let points: Vec<([f64; 2], f64)> = members.iter().map(|member| (place(member), best(member))).collect();
        let axis = |number: usize| axes.get(number).copied().unwrap_or(("", None));
        let title = format!("{title}: {} kept", members.len());
        let (names, ranges) = ([axis(0).0, axis(1).0], [axis(0).1, axis(1).1]);
        Scatter { title: &title, axes: names, ranges, shade: "fitness", points: &points }.draw()
    }
}

/// Returns all members, sorted by cell, fitness and origin.
fn members(search: &AnyStrategy) -> Vec<Member<'_>> {
    let mut members = search.collection().map_or_else(Vec::new, Collection::members);
    members.sort_by(|a, b| {
        let best = |member: &Member<'_>| member.objectives.first().copied().unwrap_or(f64::NAN);
        let by_objective = || best(b).total_cmp(&best(a));
        let by_origin = || (a.generation, a.individual).cmp(&(b.generation, b.individual));
        a.cell.cmp(&b.cell).then_with(by_objective).then_with(by_origin)
    });
    members
}
