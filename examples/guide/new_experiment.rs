//! An experiment of one's own: a Khepera learns to find a lamp.

use farsa::body::World as _;
use farsa::body::{Arrange as _, Beam, BodyId, Kinematics as _, LightSensors, MobileRobot, Pose, Twist, WheelVelocity};
use farsa::num::{Domain, Stream};
use farsa::physics::arena::{Arena, Cylinder, World};
use farsa_experiments::{Description, Error, Experiment, Job, Neurocontroller, Outcome, Setting, Settings, Setup};
use farsa_experiments::{Stage, Tape, cli};

const LAMP: [f64; 2] = [0.8, 0.4]; // metres
struct Phototaxis;

impl Experiment for Phototaxis {
    fn name(&self) -> &'static str {
        "phototaxis"
    }
    fn summary(&self) -> &'static str {
        "a Khepera learns to find a lamp"
    }
    fn settings(&self, _condition: &str) -> Vec<Setting> {
        vec![Setting::whole("trial.steps", 400, 1..=1_000_000).doc("Steps of 50 ms.")]
    }
    fn prepare(&self, _condition: &str, settings: &Settings) -> Result<Box<dyn Setup>, Error> {
        let (robot, mut arena) = (MobileRobot::khepera(), Arena::walled(1.0, 0.8));
        arena.add_robot(robot.clone(), [0.2, 0.4], 0.0);
        arena.add_cylinder(Cylinder { lamp: 1.0, ..Cylinder::new(LAMP, 0.01) });
        let parts = arena.parts(0);
        let eyes = LightSensors::of(&robot, parts.body, 0.5)?;
        let wheels = WheelVelocity::new(parts.motors, robot.max_wheel_speed as f32)?;
        let stage = Stage::of_arena(&arena).with_scalars(["to the lamp [m]"]);
        let control = Neurocontroller::new(eyes, wheels, 4, 8.0)?.on_stage(stage);
        let (world, robot) = (World::new(&arena)?, parts.body);
        Ok(Box::new(Lives { world, robot, control, steps: settings.count("trial.steps")? }))
    }
}

struct Lives {
    world: World,
    robot: BodyId,
    control: Neurocontroller<LightSensors<Vec<Beam>>, WheelVelocity>,
    steps: usize,
}

impl Setup for Lives {
    fn genes(&self) -> usize {
        self.control.genes()
    }
    fn trials(&self) -> usize {
        8
    }
    fn stage(&self) -> Stage {
        self.control.stage().clone()
    }
    fn description(&self) -> Description {
        self.control.description(self.steps, 0.05)
    }
    fn live(&mut self, genes: &[u16], job: Job, tape: &mut Tape<'_>) -> Outcome {
        let Ok(()) = self.control.begin(genes, tape) else { return Outcome::failed() };
        let mut start = Stream::new(job.seed, Domain::Start, job.trial, 0, job.generation);
        self.world.clear();
        self.world.place_body(self.robot, Pose::planar([0.2, 0.4], start.range(-3.1, 3.1)), Twist::default());
        self.world.arranged();
        let (mut near, mut away) = (0.0, f64::NAN);
        for step in 1..=self.steps {
            self.control.act(&mut self.world);
            self.world.step();
            let [x, y, _] = self.world.pose(self.robot).position.map(f64::from);
            away = ((x - LAMP[0]) * (x - LAMP[0]) + (y - LAMP[1]) * (y - LAMP[1])).sqrt();
            near += (1.0 - away).max(0.0) / self.steps as f64;
            self.control.tell(&self.world, tape);
            tape.row(step as f64 / 20.0, &[away]);
        }
        let notes = vec![("to go [m]", away.into())];
        Outcome { terms: vec![near], steps: self.steps as u32, success: away < 0.1, notes }
    }
}

fn main() -> std::process::ExitCode {
    cli::main(&[&Phototaxis])
}
