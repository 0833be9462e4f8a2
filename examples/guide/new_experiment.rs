//! A custom experiment: a Khepera learns to find a lamp.

use farsa::body::sensors::Beam;
use farsa::physics::arena::{Arena, Cylinder};
use farsa::prelude::*;
use farsa_lab::{cli, prelude::*};

const LAMP: [f64; 2] = [0.8, 0.4]; // meters

fn settings(_condition: &str) -> Vec<Setting> {
    vec![Setting::whole("trial.steps", 400, 1..=1_000_000).doc("Steps of 50 ms.")]
}

fn prepare(settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
    let (khepera, mut arena) = (MobileRobot::khepera(), Arena::walled(1.0, 0.8));
    arena.add_robot(khepera.clone(), [0.2, 0.4], 0.0);
    arena.add_cylinder(Cylinder { lamp: 1.0, ..Cylinder::new(LAMP, 0.01) });
    let robot = arena.parts(0);
    let eyes: LightSensors<Vec<Beam>> = LightSensors::for_robot(&khepera, robot.body, 0.5)?;
    let wheels = WheelVelocity::new(robot.motors, khepera.max_wheel_speed as f32)?;
    let control = Neurocontroller::new(eyes, wheels, 4, 8.0)?.with_schema(Schema::from_arena(&arena));
    let steps = settings.count("trial.steps")? as u32;
    let nearness = Nearness { robot: robot.body, steps: f64::from(steps), away: f64::NAN };
    let trials = Trials { count: 8, steps, time_step: 0.05 };
    Ok(Box::new(InWorld::in_arena(&arena, Controlled::new(control, nearness, trials))?))
}

#[derive(Clone)]
struct Nearness {
    robot: BodyId,
    steps: f64,
    away: f64,
}

impl Objective for Nearness {
    fn start<W: PlanarWorld>(&mut self, world: &mut W, id: EpisodeId) {
        let mut stream = Stream::new(id.seed, Domain::Start, id.trial, 0, id.generation);
        world.clear();
        world.place_body(self.robot, Pose::planar([0.2, 0.4], stream.range(-3.1, 3.1)), Twist::default());
        world.finish_placement();
    }
    fn reward<W: PlanarWorld>(&mut self, world: &W) -> f64 {
        let [x, y, _] = world.pose(self.robot).position.map(f64::from);
        self.away = ((x - LAMP[0]) * (x - LAMP[0]) + (y - LAMP[1]) * (y - LAMP[1])).sqrt();
        (1.0 - self.away).max(0.0) / self.steps
    }
    fn success(&self) -> Option<bool> {
        Some(self.away < 0.1)
    }
    fn values(&self) -> Vec<(&'static str, f64)> {
        vec![("to the lamp [m]", self.away)]
    }
}

fn main() -> std::process::ExitCode {
    let (name, summary) = ("phototaxis", "a Khepera learns to find a lamp");
    cli::main(&[&SimpleExperiment { name, summary, conditions: &[], settings, prepare }])
}
