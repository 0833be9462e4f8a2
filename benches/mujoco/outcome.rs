//! Outcomes in either engine: grasps from random starts, a sphere at rest, a finger that presses.

use std::sync::Arc;

use farsa::body::ports::Motor as _;
use farsa::body::robots::{ArmAndHand, Finger};
use farsa::body::{Pose, Twist};
use farsa::num::Scalar;
use farsa_experiments::reach_grasp_lift::{GraspPlan, Motors, Scene, Statics, Timetable};
use farsa_lab::EpisodeId;

use crate::drive::{Press, Sink, hold};
use crate::engine::Engine;
use crate::phase::{Failure, JOINTS, Phase};

/// When the hand has lifted and held still for a while, and for how long the sphere shall stay in it \[control steps\].
const LIFTED: usize = 500;
const HOLD: usize = 500;
/// The sphere counts as held when its center is this high \[m\], off the table, for the last second.
const HIGH: f64 = 0.05;
const SECOND: usize = 100;
/// The force of the finger [N].
const PRESSED: f64 = 5.0;

/// A scene at rest, the sphere lying on the table.
fn at_rest(scene: &Scene, q: &[f64], [x, y]: [f64; 2]) -> Phase {
    let at = [x, y, scene.config.sphere_radius].map(|x| x as f32);
    let q = core::array::from_fn(|i| q[i] as f32);
    Phase { contacts: true, q, v: [0.0; JOINTS], sphere: (Pose::at(at), Twist::default()), commands: Vec::new() }
}

/// Prints a line for each start: success of the grasp, slip in the hand in 5 s \[mm\], and the deepest contact
/// meanwhile \[um\].
///
/// The script reads the joints of its engine. It receives the displaced place of the sphere, or (`blind`) the one
/// without displacement.
pub(crate) fn grasps<E: Engine>(scene: &Arc<Scene>, engine: &mut E, starts: u32, blind: bool) -> Result<(), Failure> {
    let (statics, motors) = (Arc::new(Statics::new(scene)?), scene.motors()?);
    for start in 0..starts {
        let id = EpisodeId { seed: 1, generation: start / 4, trial: start % 4, ..EpisodeId::default() };
        let (q, place) = scene.start(id);
        let believed = if blind { scene.config.sphere_start(id.trial as usize) } else { place };
        let plan = GraspPlan::new(Timetable::default(), Arc::clone(&statics), &q, believed)?;
        let (held, slip, deepest) = grasp(scene, engine, &motors, &plan, &at_rest(scene, &q, place))?;
        println!("{} {slip:.6} {deepest:.3}", u8::from(held));
    }
    Ok(())
}

fn grasp<E: Engine>(
    scene: &Scene,
    engine: &mut E,
    motors: &Motors,
    plan: &GraspPlan,
    phase: &Phase,
) -> Result<(bool, f64, f64), Failure> {
    let steps = LIFTED + HOLD;
    let mut seen = engine.start(phase, steps)?;
    let (mut first, mut up, mut deepest) = (seen.held, 0, 0.0_f64);
    for step in 0..steps {
        if step == LIFTED {
            first = seen.held;
        }
        let mut sink = Sink::default();
        let outputs = plan.outputs(&seen, step as f64 * scene.config.time_step);
        motors.clone().drive(&outputs, &mut sink);
        seen = engine.step(&sink.words())?;
        let high = seen.height >= HIGH && seen.contact(scene.sphere_on_table).force <= 0.0;
        up = if high { up + 1 } else { 0 };
        if step >= LIFTED {
            deepest = seen.touching.iter().map(|touching| touching.depth).fold(deepest, f64::max);
        }
    }
    let slip: f64 = (0..3).map(|k| (seen.held[k] - first[k]) * (seen.held[k] - first[k])).sum();
    Ok((up >= SECOND, Scalar::sqrt(slip) * 1e3, deepest * 1e6))
}

/// A line: how deep the sphere has sunk into the table after 5 s of rest \[um\], and with what force \[N\].
pub(crate) fn rest<E: Engine>(scene: &Scene, engine: &mut E) -> Result<(), Failure> {
    let statics = Statics::new(scene)?;
    let (q, place) = scene.start(EpisodeId::default());
    let nothing = Press { body: ArmAndHand::PALM, point: scene.arm.palm_centre, force: 0.0 };
    let mut seen = engine.start(&at_rest(scene, &q, place), HOLD)?;
    for _ in 0..HOLD {
        seen = engine.step(&hold(&statics, &seen, &q, &nothing))?;
    }
    let force = seen.contact(scene.sphere_on_table).force;
    println!("{:.4} {force:.4}", (scene.config.sphere_radius - seen.height) * 1e6);
    Ok(())
}

/// A line: how deep the index finger's tip presses into the table \[um\] and with what force \[N\], means of the last
/// second of 6.
///
/// The finger is bent, and the arm presses it down. The force is regulated to [`PRESSED`].
pub(crate) fn press<E: Engine>(scene: &Scene, engine: &mut E) -> Result<(), Failure> {
    let statics = Statics::new(scene)?;
    let (body, point) = scene.arm.fingertip(Finger::Index);
    let phalanges = ArmAndHand::phalange_colliders(Finger::Index);
    let tip = &scene.robot.colliders[phalanges[2]];
    let pair = scene.robot.pair(&tip.name, "table").ok_or("no pair of fingertip and table")?;
    let place = [0.22, -0.18];
    // The palm as high as lets the fingertip's surface touch the table.
    let mut height = 0.08;
    let mut wanted = statics.above(place, height)?;
    for _ in 0..2 {
        wanted = statics.above(place, height)?;
        wanted[12..15].copy_from_slice(&[-0.6, -0.6, -0.6]);
        let at = statics.tree().poses(&wanted)[body.index()].transform(point);
        height -= at[2] - scene.arm.phalange_radii[2];
    }
    let steps = 600;
    let mut seen = engine.start(&at_rest(scene, &wanted, [0.35, 0.15]), steps)?;
    let (mut force, mut mean) = (PRESSED, [0.0; 2]);
    for step in 0..steps {
        seen = engine.step(&hold(&statics, &seen, &wanted, &Press { body, point, force }))?;
        let touching = seen.contact(pair);
        force += 0.02 * (PRESSED - touching.force);
        if let Some(other) = seen.touching.iter().find(|other| ![pair, scene.sphere_on_table].contains(&other.pair)) {
            return Err(format!("pair {} touches too", other.pair.index()).into());
        }
        if step + SECOND >= steps {
            mean = [mean[0] + touching.depth / SECOND as f64, mean[1] + touching.force / SECOND as f64];
        }
    }
    println!("{:.4} {:.4}", mean[0] * 1e6, mean[1]);
    Ok(())
}
