//! Another fitness for a task that there is: foraging, where the death of a robot costs.

use farsa_experiments::FORAGING;
use farsa_lab::advanced::Rescored;
use farsa_lab::{Error, Evaluator, Experiment, Note, Outcome, Setting, Settings, cli};

/// The task `foraging` with Kheperas, under two judges.
struct Judges;

impl Experiment for Judges {
    fn name(&self) -> &'static str {
        "judges"
    }
    fn summary(&self) -> &'static str {
        "do robots that forage stay alive if their death costs?"
    }
    fn conditions(&self) -> &'static [&'static str] {
        &["food", "lives"]
    }
    fn settings(&self, condition: &str) -> Vec<Setting> {
        let cost = if condition == "lives" { 10.0 } else { 0.0 };
        let mut table = FORAGING.settings("khepera");
        table.push(Setting::number("fitness.death", cost, 0.0..=1000.0).doc("Pieces of food that a death costs."));
        table
            .push(Setting::flag("fitness.per_survivor", false).doc("Whether food is counted per robot that is alive."));
        table
    }
    fn prepare(&self, _: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        let (robots, death) = (settings.count("team.robots")? as f64, settings.number("fitness.death")?);
        let per_survivor = settings.flag("fitness.per_survivor")?;
        let score = move |outcome: &Outcome| {
            let (food, deaths) = (noted(outcome, "food collected"), noted(outcome, "deaths"));
            let share = if per_survivor { robots / (robots - deaths) } else { 1.0 };
            vec![food * share, -death * deaths]
        };
        let task = FORAGING.prepare("khepera", settings)?;
        Ok(Box::new(Rescored::new(task, ["food", "cost of deaths"], score)))
    }
}

/// Returns a note of a trial by name. A missing note is NaN, which marks the trial as failed.
fn noted(outcome: &Outcome, name: &str) -> f64 {
    let note = outcome.notes.iter().find(|(other, _)| *other == name);
    if let Some((_, Note::Number(x))) = note { *x } else { f64::NAN }
}

fn main() -> std::process::ExitCode {
    cli::main(&[&Judges])
}
