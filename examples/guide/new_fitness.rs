//! Another fitness for a task that there is: foraging, where the death of a robot costs.

use farsa_experiments::{
    Description, Error, Experiment, Foraging, Job, Note, Outcome, Setting, Settings, Setup, Stage, Tape, cli,
};

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
        let mut table = Foraging.settings("khepera");
        table.push(Setting::number("fitness.death", cost, 0.0..=1000.0).doc("Pieces of food that a death costs."));
        table
            .push(Setting::flag("fitness.per_survivor", false).doc("Whether food is counted per robot that is alive."));
        table
    }
    fn prepare(&self, _: &str, settings: &Settings) -> Result<Box<dyn Setup>, Error> {
        Ok(Box::new(Judge {
            task: Foraging.prepare("khepera", settings)?,
            robots: settings.count("team.robots")? as f64,
            death: settings.number("fitness.death")?,
            per_survivor: settings.flag("fitness.per_survivor")?,
        }))
    }
}

struct Judge {
    task: Box<dyn Setup>,
    robots: f64,
    death: f64,
    per_survivor: bool,
}

/// What the task tells of a life under a name; NaN, so that no life counts, if it tells nothing of that name.
fn told(outcome: &Outcome, name: &str) -> f64 {
    let note = outcome.notes.iter().find(|(other, _)| *other == name);
    if let Some((_, Note::Number(x))) = note { *x } else { f64::NAN }
}

impl Setup for Judge {
    fn terms(&self) -> Vec<String> {
        vec!["food".into(), "cost of deaths".into()]
    }

    fn live(&mut self, genes: &[u16], job: Job, tape: &mut Tape<'_>) -> Outcome {
        let life = self.task.live(genes, job, tape);
        let (food, deaths) = (told(&life, "food collected"), told(&life, "deaths"));
        let share = if self.per_survivor { self.robots / (self.robots - deaths) } else { 1.0 };
        Outcome { terms: vec![food * share, -self.death * deaths], ..life }
    }

    /// The mean over the trials.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        let sum: f64 = trials.iter().flat_map(|outcome| &outcome.terms).sum();
        sum / trials.len() as f64
    }

    // All else is the task's.
    fn genes(&self) -> usize {
        self.task.genes()
    }
    fn trials(&self) -> usize {
        self.task.trials()
    }
    fn stage(&self) -> Stage {
        self.task.stage()
    }
    fn description(&self) -> Description {
        self.task.description()
    }
}

fn main() -> std::process::ExitCode {
    cli::main(&[&Judges])
}
