//! Laws of actuators, joints and contacts, against closed forms and naive models, in one world and in lanes.
#![allow(missing_docs, clippy::unwrap_used)]

mod commands;
mod cylinder;
mod restitution;
mod speed;

use farsa_body::ports::{Actuated, ActuatorId, Arrange, BodyId, Handles, JointId};
#[cfg(feature = "lanes")]
use farsa_body::ports::{Snapshot as _, World as _};
use farsa_num::Stream;
use farsa_physics::articulated::Model;
#[cfg(feature = "lanes")]
use farsa_physics::articulated::{Batch, LANES, World};

/// A world or a lane that a test drives.
pub(crate) trait Driven:
    Arrange + Actuated + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>
{
}

impl<W: Arrange + Actuated + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>> Driven for W {}

/// Compares every word of the lanes with the world alone after each step, at every instruction set of this machine.
#[cfg(feature = "lanes")]
pub(crate) fn lanes_have_the_bits_of_the_world(
    model: &Model<f32>,
    steps: usize,
    drive: impl Fn(&mut dyn Driven, &mut Stream, usize),
) {
    use farsa_num::{Domain, Instructions};
    let stream = |lane: usize| Stream::new(59, Domain::General, lane as u32, 0, 0);
    let mut truths = Vec::new();
    for lane in 0..16 {
        let (mut world, mut stream) = (World::new(model.clone()), stream(lane));
        let mut bits = Vec::new();
        for step in 0..steps {
            drive(&mut world, &mut stream, step);
            world.step();
            bits.push(world.state().iter().map(|x| x.to_bits()).collect::<Vec<_>>());
        }
        truths.push(bits);
    }
    for level in Batch::instructions().chain([Instructions::Fallback]) {
        for lanes in LANES {
            let mut batch = Batch::new(model.clone(), lanes, level).unwrap();
            let mut streams: Vec<Stream> = (0..lanes).map(stream).collect();
            let mut own = vec![0.0_f32; model.state_len()];
            for step in 0..steps {
                for (lane, stream) in streams.iter_mut().enumerate() {
                    drive(&mut batch.lane(lane), stream, step);
                }
                batch.step();
                for (lane, truth) in truths.iter().enumerate().take(lanes) {
                    batch.lane(lane).save(&mut own);
                    let equal = own.iter().zip(&truth[step]).all(|(x, bits)| x.to_bits() == *bits);
                    assert!(equal, "{level:?}: lane {lane} of {lanes} differs at step {step}");
                }
            }
        }
    }
}

/// Without lanes, nothing is compared.
#[cfg(not(feature = "lanes"))]
pub(crate) fn lanes_have_the_bits_of_the_world(
    _: &Model<f32>,
    _: usize,
    _: impl Fn(&mut dyn Driven, &mut Stream, usize),
) {
}
