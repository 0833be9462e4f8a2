//! A custom experiment: a cart learns to stop at the middle of its track.

use farsa_body::Recorder;
use farsa_lab::advanced::Description;
use farsa_lab::advanced::{Schema, record_row};
use farsa_lab::{Error, Evaluation, Evaluator, Outcome, Parameter, Setting, Settings, SimpleExperiment};
use farsa_lab::{Task, TaskInfo, cli};
use farsa_num::{Domain, Stream};

fn settings(condition: &str) -> Vec<Setting> {
    let friction = if condition == "smooth" { 0.0 } else { 0.5 };
    vec![
        Setting::whole("evolution.population", 20, 1..=1000).doc("Carts of a generation."),
        Setting::whole("evolution.parents", 5, 1..=1000).doc("Carts that have children."),
        Setting::number("cart.friction", friction, 0.0..=10.0).unit("1/s").doc("Deceleration per speed."),
        Setting::word("cart.motor", "linear", &["linear", "switched"]).doc("Continuous or full force."),
        Setting::whole("trial.steps", 500, 1..=1_000_000).doc("Steps of 10 ms."),
    ]
}

fn prepare(settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
    let (friction, steps) = (settings.number("cart.friction")?, settings.count("trial.steps")?);
    Ok(Box::new(Track { friction, steps: steps as u32, switched: settings.word("cart.motor")? == "switched" }))
}

struct Track {
    friction: f64,
    steps: u32,
    switched: bool,
}

impl Task for Track {
    fn info(&self) -> TaskInfo {
        let parameters = ["gain of position", "gain of speed"].map(|name| Parameter::new(name, [-8.0, 8.0]));
        let (network, steps) = ("2-1, linear".into(), self.steps as usize);
        TaskInfo {
            description: Description { network, parameters: 2, steps, step_seconds: 0.01, ..Description::default() },
            trials: 3,
            ..TaskInfo::new(parameters.into(), Schema::from_scalars(["position [m]", "speed [m/s]", "force [N]"]))
        }
    }
}

impl Evaluator for Track {
    fn evaluate(&mut self, evaluation: Evaluation<'_>, mut recorder: Option<&mut dyn Recorder>) -> Outcome {
        let Evaluation { parameters, id, .. } = evaluation;
        let mut start = Stream::new(id.seed, Domain::Start, id.trial, 0, id.generation);
        let (mut x, mut v) = (start.range_f64(-1.0, 1.0), start.range_f64(-1.0, 1.0));
        let [kx, kv] = [0, 1].map(|gain| f64::from(parameters[gain]));
        let mut fitness = 0.0;
        for step in 1..=self.steps {
            let force = (kx * x + kv * v).clamp(-1.0, 1.0);
            let force = if self.switched { force.signum() } else { force };
            v += 0.01 * (force - self.friction * v);
            x += 0.01 * v;
            fitness += 1.0 / (1.0 + x * x + v * v) / f64::from(self.steps);
            record_row(&mut recorder, 0.01 * f64::from(step), &[x, v, force]);
            if x.abs() > 5.0 {
                return Outcome::failed(); // Off the track.
            }
        }
        let success = x.abs() < 0.1 && v.abs() < 0.1;
        Outcome {
            terms: vec![fitness],
            steps: self.steps,
            success,
            notes: vec![("at [m]", x.into())],
            ..Outcome::default()
        }
    }
}

fn main() -> std::process::ExitCode {
    let (name, summary) = ("cart", "a cart learns to stop at the middle of its track");
    cli::main(&[&SimpleExperiment { name, summary, conditions: &["rough", "smooth"], settings, prepare }])
}
