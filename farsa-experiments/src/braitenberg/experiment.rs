//! The experiment `braitenberg`: vehicles wired by hand.

use farsa_body::Recorder;
use farsa_body::robot::Robot;
use farsa_physics::arena::{Batch, World};

use crate::braitenberg::episode::{Config, LIGHTS, Vehicle, VehicleEpisode};
use farsa_lab::{
    ChannelGroup, Description, Error, Evaluation, Evaluator, Experiment, Exports, InWorld, Lanes, Note, Outcome,
    Parameter, Rollout, Setting, Settings, Task, TaskInfo, mean_of_trials,
};
use farsa_view::{Channel, Links, NodeParameters, Schema};

/// What four ways of wiring two light-driven wheels look like from outside \[Braitenberg1984, vehicles 2a to 3b\].
///
/// A Khepera with eight light sensors and a lamp. Nothing evolves: a run is one vehicle in one generation, and its one
/// gene means nothing; it is there so that `farsa run`, `test`, `replay`, `draw` and `report` work as for the others. What
/// is called fitness is how much nearer to the lamp the vehicle came \[m\].
///
/// Deviations: the source gives no numbers but the lamp's radius, and its vehicles have a sensor on either side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Braitenberg;

fn vehicle(condition: &str) -> Vehicle {
    Vehicle::ALL.into_iter().find(|vehicle| vehicle.name() == condition).unwrap_or(Vehicle::Fear)
}

impl Experiment for Braitenberg {
    fn name(&self) -> &'static str {
        "braitenberg"
    }

    fn summary(&self) -> &'static str {
        "four vehicles wired by hand flee from a lamp, attack it, love it, or explore; nothing evolves"
    }

    fn conditions(&self) -> &'static [&'static str] {
        &["2a", "2b", "3a", "3b"]
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        let config = Config::for_vehicle(vehicle(condition));
        let only_one = |key: &str, doc: &str| Setting::whole(key, 1, 1..=1).derived().doc(doc);
        vec![
            only_one("evolution.generations", "Nothing evolves: one generation."),
            only_one("evolution.population", "Nothing evolves: one vehicle."),
            only_one("evolution.parents", "Nothing evolves: one vehicle."),
            Setting::number("world.size", config.size, 0.2..=100.0)
                .unit("m")
                .doc("Side of the walled square in whose middle the lamp stands; wide, so that a vehicle that leaves is seen to."),
            Setting::number("world.time_step", config.time_step, 0.001..=0.2).unit("s").doc("Control step, as in `discrimination`."),
            Setting::whole("trial.count", i64::from(config.trials), 1..=100_000).doc("Trials, each with a start of its own."),
            Setting::whole("trial.steps", i64::from(config.steps), 1..=1_000_000).doc("Steps of a trial; collisions do not end it."),
            Setting::number("lamp.radius", config.lamp_radius, 0.001..=0.1).unit("m").given().doc("Radius of the lamp."),
            Setting::number("lamp.reference", config.reference, 0.001..=10.0).unit("m").doc(
                "Distance from which a sensor that looks at the lamp reads 1; light falls with the distance's square.",
            ),
            Setting::numbers("start.distance", &config.start, 0.05..=100.0)
                .unit("m")
                .doc("Least and greatest distance from the robot's centre to the lamp's at the start; direction and heading are uniform."),
            Setting::number("wiring.gain", config.gain, 0.0..=100.0)
                .doc("Weight of each light sensor, plus (2a, 2b) or minus (3a, 3b), in parts of the greatest wheel speed."),
            Setting::number("wiring.base", config.base, 0.0..=1.0)
                .doc("Wheel speed in the dark, in parts of the greatest: a little where light drives, half where it slows."),
        ]
    }

    fn gene_bits(&self) -> u32 {
        1
    }

    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        let start = settings.numbers("start.distance")?;
        let config = Config {
            vehicle: vehicle(condition),
            size: settings.number("world.size")?,
            time_step: settings.number("world.time_step")?,
            trials: settings.count("trial.count")? as u32,
            steps: settings.count("trial.steps")? as u32,
            lamp_radius: settings.number("lamp.radius")?,
            reference: settings.number("lamp.reference")?,
            start: [start[0], start[1]],
            gain: settings.number("wiring.gain")?,
            base: settings.number("wiring.base")?,
        };
        Ok(Box::new(evaluator(config)?))
    }
}

/// Evaluates a vehicle under a configuration.
///
/// # Errors
/// [`Error::Setting`] for starts within the lamp or beyond the walls, [`Error::Other`] for values that make no world.
pub fn evaluator(config: Config) -> Result<InWorld<World, VehicleEpisode>, Error> {
    let radius = config.robot().radius;
    let [near, far] = config.start;
    let most = 0.5 * config.size - radius;
    if near < radius + config.lamp_radius || far > most || near > far {
        let least = radius + config.lamp_radius;
        let why = format!(
            "from {near} to {far} m: must rise and lie between {least:.3} m, the lamp, and {most:.3} m, the wall"
        );
        return Err(Error::setting("start.distance", why));
    }
    let arena = config.arena();
    let world = World::new(&arena).map_err(|error| Error::Other(format!("braitenberg: {error}")))?;
    let batch = move |lanes: Lanes| {
        Batch::new(&arena, lanes.count(), lanes.instructions()).map_err(|error| Error::Other(error.to_string()))
    };
    Ok(InWorld::new(world, VehicleEpisode::new(config)?).with_lanes(batch).with_displacements())
}

impl VehicleEpisode {
    fn schema(&self) -> Schema {
        let in_group = |group: &'static str| move |name: &str| Channel::new(name).group(group);
        let places =
            ["x [m]", "y [m]", "heading [rad]", "distance of the lamp [m]", "bearing of the lamp [rad]", "collisions"];
        let mut schema = Schema::from_arena(&self.config().arena())
            .with_sensors((1..=LIGHTS).map(|number| format!("light {number}")))
            .with_outputs(["left wheel", "right wheel"]);
        schema.outputs.iter_mut().chain(&mut schema.sensors).for_each(|channel| channel.range = Some([0.0, 1.0]));
        let wheels = [LIGHTS, LIGHTS + 2];
        Schema {
            scalars: places.map(in_group("place")).into(),
            links: vec![Links { from: [0, LIGHTS], to: wheels, first: 0 }],
            node_parameters: vec![NodeParameters {
                name: "speed in the dark".into(),
                nodes: wheels,
                first: 2 * LIGHTS,
            }],
            ..schema
        }
    }

    fn description(&self) -> Description {
        let config = self.config();
        let vehicle = config.vehicle;
        let meaning = "where the infrared sensors are, left to right and the two behind, 0 dark .. 1";
        Description {
            sensors: vec![ChannelGroup::new("light", LIGHTS, meaning)],
            motors: vec![ChannelGroup::new("wheels", 2, "left and right, 1/2 at rest .. 1 ahead, 1.1 turns/s")],
            network: format!(
                "vehicle {}: each side's light {} the {} wheel",
                vehicle.name(),
                if vehicle.excited() { "drives" } else { "slows" },
                if vehicle.crossed() { "other" } else { "same" },
            ),
            parameters: self.wiring().parameters.len(),
            steps: config.steps as usize,
            step_seconds: config.time_step,
        }
    }
}

impl Task for VehicleEpisode {
    /// Nothing evolves: one parameter that nothing depends on.
    fn info(&self) -> TaskInfo {
        TaskInfo {
            description: self.description(),
            trials: self.config().trials as usize,
            terms: vec!["approach [m]".into()],
            ..TaskInfo::new(vec![Parameter::new("none", [0.0, 1.0])], self.schema())
        }
    }

    /// The mean over the trials.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        mean_of_trials(trials)
    }

    fn exports(&self) -> Option<&dyn Exports> {
        Some(self)
    }
}

impl Exports for VehicleEpisode {
    fn robot(&self, _: Option<&[f32]>) -> Option<Robot> {
        Some(self.config().robot().description())
    }
}

impl Rollout for VehicleEpisode {
    fn load(&mut self, _: &Evaluation<'_>) -> bool {
        true
    }

    fn record_parameters(&self, recorder: &mut dyn Recorder) {
        recorder.parameters(&self.wiring().parameters);
    }

    fn outcome(&self) -> Outcome {
        let episode = self;
        let [start, end] = episode.distances();
        let [steps, collisions] = episode.steps();
        let off = episode.bearings().map(|bearing| bearing.abs().to_degrees());
        // 2b and 3a come near, 2a and 3b leave.
        let comes = episode.config().vehicle.crossed() == episode.config().vehicle.excited();
        Outcome {
            terms: vec![episode.approach()],
            steps,
            success: (end < start) == comes,
            notes: vec![
                ("distance at the start [m]", Note::from(start)),
                ("distance at the end [m]", Note::from(end)),
                ("lamp off ahead at the start [deg]", Note::from(off[0])),
                ("lamp off ahead at the end [deg]", Note::from(off[1])),
                ("steps in collision", Note::from(f64::from(collisions))),
            ],
            ..Outcome::default()
        }
    }
}
