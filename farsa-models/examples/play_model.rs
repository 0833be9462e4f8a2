//! Plays commands with a model file in the articulated world: `play_model STEP < JOB > PATH`, for
//! `quality/locomotion/run`.
//!
//! STEP is the dynamics step [s]. JOB is JSON with `file`, `torso` (a body of the file), `interval` (the time between
//! commands [s]), `joints` and `commands` (a row per time, a desired position or effort per joint), `positions` (by
//! joint) and `free` (by body, position and quaternion w, x, y, z). PATH has a line with the place of the torso for
//! each row.

use std::collections::BTreeMap;
use std::io::{Read, Write};

use farsa_body::ports::{Actuated as _, Arrange as _, World as _};
use farsa_body::{Pose, Twist};
use farsa_models::{Imported, ReadOptions};
use farsa_physics::articulated::{Model, Options, World};
use serde::Deserialize;

#[derive(Deserialize)]
struct Job {
    file: String,
    torso: String,
    interval: f64,
    joints: Vec<String>,
    commands: Vec<Vec<f32>>,
    positions: BTreeMap<String, f32>,
    free: BTreeMap<String, [f64; 7]>,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let step: f64 = std::env::args().nth(1).ok_or("the dynamics step is missing")?.parse()?;
    let mut text = String::new();
    std::io::stdin().lock().read_to_string(&mut text)?;
    let job: Job = serde_json::from_str(&text)?;
    let imported = Imported::from_file(&job.file, &ReadOptions { between: 1e-6, ..ReadOptions::default() })?;
    let robot = &imported.robot;
    let frame = imported.frame(&job.torso).ok_or("no such torso")?;
    let torso = frame.body.ok_or("the torso does not move")?;
    let substeps = (job.interval / step).round() as u32;
    let gravity = imported.gravity.unwrap_or([0.0, 0.0, -9.81]);
    let options = Options { time_step: job.interval, substeps, gravity, ..Options::default() };
    let mut world = World::new(Model::<f64>::new(robot, &options)?);
    for (joint, q) in &job.positions {
        world.place_joint(robot.joint(joint).ok_or("no such joint")?, *q, 0.0);
    }
    for (body, [x, y, z, w, i, j, k]) in &job.free {
        let body = robot.body(body).ok_or("no such body")?;
        let pose = Pose { position: [*x, *y, *z], rotation: [*i, *j, *k, *w] };
        world.place_body(body, pose.cast(), Twist::default());
    }
    world.finish_placement();
    let motors: Option<Vec<_>> = job
        .joints
        .iter()
        .map(|joint| {
            let joint = robot.joint(joint)?;
            let motor = robot.actuators.iter().position(|actuator| actuator.joint == joint)?;
            robot.actuator(&robot.actuators[motor].name)
        })
        .collect();
    let motors = motors.ok_or("a joint has no actuator")?;
    let mut output = std::io::stdout().lock();
    for row in &job.commands {
        for (motor, command) in motors.iter().zip(row) {
            world.command(*motor, [*command, 0.0]);
        }
        world.step();
        let [x, y, z] = world.pose_of(torso).compose(&frame.placement).position;
        writeln!(output, "{x} {y} {z}")?;
    }
    Ok(())
}
