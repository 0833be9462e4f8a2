//! An experiment of one's own: a cart learns to stop at the middle of its track.

use farsa_lab::{ChannelGroup, Description, Experiment, Job, Outcome, Setting, Settings, Setup, Stage, Tape, cli};
use farsa_num::{Domain, Stream};

struct Cart;

impl Experiment for Cart {
    fn name(&self) -> &'static str {
        "cart"
    }
    fn summary(&self) -> &'static str {
        "a cart learns to stop at the middle of its track"
    }
    fn conditions(&self) -> &'static [&'static str] {
        &["rough", "smooth"]
    }
    fn settings(&self, condition: &str) -> Vec<Setting> {
        let friction = if condition == "smooth" { 0.0 } else { 0.5 };
        vec![
            Setting::whole("evolution.population", 20, 1..=1000).doc("Carts of a generation."),
            Setting::whole("evolution.parents", 5, 1..=1000).doc("Carts that have children."),
            Setting::number("cart.friction", friction, 0.0..=10.0).unit("1/s").doc("Deceleration per speed."),
            Setting::word("cart.motor", "linear", &["linear", "switched"]).doc("Continuous or full force."),
            Setting::whole("trial.steps", 500, 1..=1_000_000).doc("Steps of 10 ms."),
        ]
    }
    fn prepare(&self, _: &str, settings: &Settings) -> Result<Box<dyn Setup>, farsa_lab::Error> {
        let (friction, steps) = (settings.number("cart.friction")?, settings.count("trial.steps")?);
        Ok(Box::new(Track { friction, steps: steps as u32, switched: settings.word("cart.motor")? == "switched" }))
    }
}

struct Track {
    friction: f64,
    steps: u32,
    switched: bool,
}

impl Setup for Track {
    fn genes(&self) -> usize {
        2
    }
    fn trials(&self) -> usize {
        3
    }
    fn stage(&self) -> Stage {
        Stage::of_scalars(["position [m]", "speed [m/s]", "force [N]"])
    }
    fn description(&self) -> Description {
        let sensors = vec![ChannelGroup::new("state", 2, "position [m] and speed [m/s]")];
        let motors = vec![ChannelGroup::new("force", 1, "-1 to 1 N")];
        let (network, steps) = ("2-1, linear".into(), self.steps as usize);
        Description { sensors, motors, network, parameters: 2, steps, step_seconds: 0.01 }
    }
    fn live(&mut self, genes: &[u16], job: Job, tape: &mut Tape<'_>) -> Outcome {
        let mut start = Stream::new(job.seed, Domain::Start, job.trial, 0, job.generation);
        let (mut x, mut v) = (start.range_f64(-1.0, 1.0), start.range_f64(-1.0, 1.0));
        let [kx, kv] = [0, 1].map(|gene| f64::from(genes[gene]) / 4096.0 - 8.0);
        let mut fitness = 0.0;
        for step in 1..=self.steps {
            let force = (kx * x + kv * v).clamp(-1.0, 1.0);
            let force = if self.switched { force.signum() } else { force };
            v += 0.01 * (force - self.friction * v);
            x += 0.01 * v;
            fitness += 1.0 / (1.0 + x * x + v * v) / f64::from(self.steps);
            tape.row(0.01 * f64::from(step), &[x, v, force]);
            if x.abs() > 5.0 {
                return Outcome::failed(); // Off the track.
            }
        }
        let success = x.abs() < 0.1 && v.abs() < 0.1;
        Outcome { terms: vec![fitness], steps: self.steps, success, notes: vec![("at [m]", x.into())] }
    }
}

fn main() -> std::process::ExitCode {
    cli::main(&[&Cart])
}
