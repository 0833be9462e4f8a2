//! A phase of motion that both engines are given: where it begins and what is commanded in it, as a file of numbers.

use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use farsa::body::actuators::Law;
use farsa::body::ports::{Actuated, ActuatorId, Arrange, Joints, Kinematics};
use farsa::body::robots::{ArmAndHand, Tabletop};
use farsa::body::{Pose, Twist};
use farsa::physics::articulated::{Model, Options, Precision, World};
use farsa_experiments::reach_grasp_lift::Scene;

pub(crate) type Failure = Box<dyn Error>;

pub(crate) const MUSCLES: usize = 7;
pub(crate) const JOINTS: usize = 27;
/// Activations of seven pairs, positions of twenty servos.
pub(crate) const WORDS: usize = 2 * MUSCLES + JOINTS - MUSCLES;
/// Control steps of a phase.
pub(crate) const STEPS: usize = 200;

/// Where a phase begins and what is commanded in it.
pub(crate) struct Phase {
    /// True if anything may touch anything.
    pub(crate) contacts: bool,
    pub(crate) q: [f32; JOINTS],
    pub(crate) v: [f32; JOINTS],
    pub(crate) sphere: (Pose, Twist),
    pub(crate) commands: Vec<[f32; WORDS]>,
}

impl Phase {
    pub(crate) fn at(world: &World<f32>) -> Self {
        let joints = ArmAndHand::joints();
        let sphere = (world.pose(Tabletop::SPHERE), world.velocity(Tabletop::SPHERE));
        let (q, v) = (joints.map(|joint| world.position(joint)), joints.map(|joint| world.speed(joint)));
        Self { contacts: true, q, v, sphere, commands: Vec::new() }
    }

    pub(crate) fn text(&self, scene: &Scene) -> String {
        let commands = self.commands.iter().flatten().map(|x| f64::from(*x));
        let mut text = self.start(scene, self.commands.len());
        for word in commands {
            // Writing into a string cannot fail.
            let _ = writeln!(text, "{word:?}");
        }
        text
    }

    /// Prints the muscles, the start of the phase, and the number of commands that follow.
    pub(crate) fn start(&self, scene: &Scene, commands: usize) -> String {
        let mut words: Vec<f64> = Vec::new();
        for actuator in &scene.robot.actuators {
            if let Law::MusclePair(m) = actuator.law {
                let [tension, arm, lower, upper] = [m.tension, m.moment_arm, m.lower, m.upper];
                words.extend([tension, arm, lower, upper, m.shortest, m.rest_length, m.longest, m.shape]);
                words.extend([m.passive_scale, m.viscosity]);
            }
        }
        let ([x, y, z, w], Twist { linear, angular }) = (self.sphere.0.rotation, self.sphere.1);
        let turned = [w, x, y, z];
        let state = self.q.iter().chain(&self.v).chain(&self.sphere.0.position);
        let state = state.chain(&turned).chain(&linear).chain(&angular);
        words.extend(state.map(|x| f64::from(*x)));
        words.extend([f64::from(u8::from(self.contacts)), commands as f64]);
        let mut text = String::new();
        for word in words {
            let _ = writeln!(text, "{word:?}");
        }
        text
    }

    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let words: Result<Vec<f32>, _> = fs::read_to_string(path)?.split_whitespace().map(str::parse).collect();
        let words = words?;
        let mut rest = words.get(10 * MUSCLES..).ok_or("no phase")?.iter().copied();
        let mut take = || rest.next().unwrap_or(f32::NAN);
        let q = core::array::from_fn(|_| take());
        let v = core::array::from_fn(|_| take());
        let position = core::array::from_fn(|_| take());
        let [w, x, y, z] = core::array::from_fn(|_| take());
        let (linear, angular) = (core::array::from_fn(|_| take()), core::array::from_fn(|_| take()));
        let contacts = take() > 0.0;
        let steps = take() as usize;
        let commands = (0..steps).map(|_| core::array::from_fn(|_| take())).collect();
        let sphere = (Pose { position, rotation: [x, y, z, w] }, Twist { linear, angular });
        Ok(Self { contacts, q, v, sphere, commands })
    }

    pub(crate) fn place<R: Precision>(&self, world: &mut World<R>) {
        world.clear();
        for (i, joint) in ArmAndHand::joints().into_iter().enumerate() {
            world.place_joint(joint, self.q[i], self.v[i]);
        }
        world.place_body(Tabletop::SPHERE, self.sphere.0, self.sphere.1);
        world.finish_placement();
    }
}

pub(crate) fn command<R: Precision>(world: &mut World<R>, words: &[f32; WORDS]) {
    for i in 0..JOINTS {
        let value = if i < MUSCLES { [words[2 * i], words[2 * i + 1]] } else { [words[MUSCLES + i], 0.0] };
        world.command(ActuatorId(i as u16), value);
    }
}

pub(crate) fn model<R: Precision>(scene: &Scene, substeps: u32, contacts: bool) -> Result<Model<R>, Failure> {
    let mut robot = scene.robot.clone();
    if !contacts {
        robot.pairs.clear();
    }
    Ok(Model::new(&robot, &Options { substeps, ..scene.config.options() })?)
}

pub(crate) fn world<R: Precision>(scene: &Scene, substeps: u32, contacts: bool) -> Result<World<R>, Failure> {
    Ok(World::new(model(scene, substeps, contacts)?))
}
