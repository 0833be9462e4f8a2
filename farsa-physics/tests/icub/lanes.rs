//! A lane of iCubs has the bits of the world alone, at every instruction set of this machine and every number of lanes.

use farsa_body::ports::{Contacts as _, PairId, Snapshot as _, World as _};
use farsa_body::robot::Robot;
use farsa_body::robots::{Chain, Icub, JointControl};
use farsa_num::{Digest, Instructions};
use farsa_physics::articulated::{Batch, LANES, Model, Options, World};

use crate::common::model;
use crate::random::{Babble, SPEED, start};

const WORLDS: usize = 16;
/// Control steps of every lane.
const STEPS: usize = 300;
/// A lane begins again every so often, not together with its neighbors.
const EPISODE_STEPS: usize = 120;

/// The episode that begins in a lane before a step, if one does.
fn begins(lane: usize, step: usize) -> Option<u32> {
    let shifted = step + 17 * lane;
    (step == 0 || shifted.is_multiple_of(EPISODE_STEPS)).then_some((lane + WORLDS * (shifted / EPISODE_STEPS)) as u32)
}

/// Fingerprints of the states of one lane after every step, and in how many of them something touches.
fn alone(icub: &Icub, robot: &Robot, model: &Model<f32>, lane: usize) -> (Vec<Digest>, usize) {
    let mut world = World::new(model.clone());
    let mut babble = Babble::new(robot, 2, 0, SPEED);
    let mut touching = 0;
    let digests = (0..STEPS).map(|step| {
        if let Some(episode) = begins(lane, step) {
            start(icub, robot, &mut world, episode, 0.1);
            babble = Babble::new(robot, 2, episode, SPEED);
        }
        babble.drive(&mut world);
        world.step();
        touching += usize::from((0..robot.pairs.len()).any(|p| world.touches(PairId(p as u16))));
        digest(world.state())
    });
    (digests.collect(), touching)
}

fn digest(state: &[f32]) -> Digest {
    let mut digest = Digest::new();
    digest.add_f32s(state);
    digest
}

fn together(icub: &Icub, robot: &Robot, model: &Model<f32>, lanes: usize, level: Instructions, truths: &[Vec<Digest>]) {
    let mut batch = Batch::new(model.clone(), lanes, level).unwrap();
    let mut babbles = vec![Babble::new(robot, 2, 0, SPEED); lanes];
    let mut own = vec![0.0; model.state_len()];
    for step in 0..STEPS {
        for (lane, babble) in babbles.iter_mut().enumerate() {
            let mut world = batch.lane(lane);
            if let Some(episode) = begins(lane, step) {
                start(icub, robot, &mut world, episode, 0.1);
                *babble = Babble::new(robot, 2, episode, SPEED);
            }
            babble.drive(&mut world);
        }
        batch.step();
        for (lane, truth) in truths.iter().enumerate().take(lanes) {
            batch.lane(lane).save(&mut own);
            let actuated = &icub.actuated;
            assert!(digest(&own) == truth[step], "{actuated:?} {level:?}: lane {lane} of {lanes} differs at {step}");
        }
    }
}

#[test]
fn every_lane_has_the_bits_of_the_world_alone() {
    use Chain::{LeftArm, LeftHand, RightArm, RightHand, Torso};
    use JointControl::{Position, Velocity};
    let variants: [(&[Chain], JointControl); 4] = [
        (&Chain::ALL, Position),
        (&Chain::ALL, Velocity),
        (&[Torso, LeftArm, RightArm], Velocity),
        (&[RightArm, RightHand, LeftHand], Position),
    ];
    for (actuated, control) in variants {
        let icub = Icub { actuated: actuated.to_vec(), control, ..Icub::default() };
        let robot = icub.robot().unwrap();
        let model = model::<f32>(&robot, Options::default());
        let (truths, touching): (Vec<_>, Vec<_>) = (0..WORLDS).map(|lane| alone(&icub, &robot, &model, lane)).unzip();
        println!("{actuated:?} {control:?}: steps with contacts {touching:?}");
        assert!(touching.iter().sum::<usize>() > WORLDS * STEPS / 20);
        for level in Batch::instructions().chain([Instructions::Fallback]) {
            for lanes in LANES {
                together(&icub, &robot, &model, lanes, level, &truths);
            }
        }
    }
}
