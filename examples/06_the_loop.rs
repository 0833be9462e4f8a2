//! The four-line loop on the whole robot: read, step, drive, step. No framework object owns it.
//!
//! `cargo run --example 06_the_loop [ticks]`

use std::error::Error;

use farsa::body::motors::{Muscles, ServoGroup};
use farsa::body::ports::{ActuatorId, Channels, Contacts, Kinematics, Motor, PairId, Sensor, World as _};
use farsa::body::robot::Robot;
use farsa::body::robots::{ArmAndHand, Finger, Tabletop};
use farsa::body::sensors::{Axes, JointPosition, Point, Signal, TargetPosition, Touch};
use farsa::evo::words::{GeneRange, decode, randomize};
use farsa::nn::{Controller, Leak, LeakyLayout, LeakyNetwork, LeakyParameter};
use farsa::num::{Digest, Domain, Stream};
use farsa::physics::articulated::{Model, Options, World};

/// Sensed joints of the hand, in addition to the seven of the arm.
const HAND: [usize; 10] = [8, 9, 10, 13, 14, 17, 18, 21, 22, 16];

/// The pairs of the scene that one of these colliders shares with the sphere or the table.
fn skin(robot: &Robot, own: &[usize]) -> Result<Touch<Vec<PairId>>, Box<dyn Error>> {
    let names = own.iter().map(|collider| &robot.colliders[*collider].name);
    let pairs = names.flat_map(|name| [robot.pair("sphere", name), robot.pair("table", name)]).flatten();
    Ok(Touch::new(pairs.collect(), 3.0)?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let ticks: u32 = std::env::args().nth(1).map_or(Ok(600), |text| text.parse())?;
    println!("digest of all states: {:#018x}", run(ticks)?);
    Ok(())
}

/// Runs the given number of ticks of 10 ms and returns a fingerprint of all states, which `tests/golden.rs` guards.
pub(crate) fn run(ticks: u32) -> Result<u64, Box<dyn Error>> {
    // Body and world.
    let arm = ArmAndHand::default();
    let robot = Tabletop::default().scene(&arm)?;
    let mut world = World::new(Model::<f32>::new(&robot, &Options::default())?);

    // 17 joints, 6 patches of skin, the sphere's place in the palm's axes [cm], 3 labels: 29 channels.
    let mut joints = Vec::new();
    for number in (1..=7).chain(HAND) {
        let [low, high] = robot.segments[number - 1].joint.range.map(|q| q as f32);
        joints.push(JointPosition::new(ArmAndHand::joints()[number - 1], low, high)?);
    }
    let mut patches = Vec::new();
    for finger in Finger::ALL {
        patches.push(skin(&robot, &ArmAndHand::phalange_colliders(finger))?);
    }
    patches.push(skin(&robot, &ArmAndHand::ARM_COLLIDERS[2..])?);
    let palm = Point { body: ArmAndHand::PALM, at: arm.palm_centre.map(|x| x as f32) };
    let target = TargetPosition::new(Point::origin(Tabletop::SPHERE), palm, Axes::Body, 100.0)?;
    let mut sensors = (joints, patches, target, Signal::<3>::one_hot(0, 50.0));

    // 14 muscles, 9 groups of servos: 23 channels.
    let muscles: Vec<Muscles> = (0..7).map(|i| Muscles::new(ActuatorId(i))).collect();
    let groups: Result<Vec<_>, _> = arm.servo_groups().into_iter().map(ServoGroup::new).collect();
    let mut motors = (muscles, groups?);

    // A random network between the two.
    let (inputs, outputs) = (sensors.channels(), motors.channels());
    let layout = LeakyLayout::new(inputs, 12, outputs);
    let mut genome = vec![0; layout.parameter_count()];
    randomize(&mut genome, &mut Stream::new(1, Domain::InitialGenome, 0, 0, 0));
    let leaks = layout.range(LeakyParameter::Leak);
    let ranges = [GeneRange::new(leaks.start, -6.0, 6.0)?, GeneRange::new(leaks.len(), 0.0, 1.0)?];
    let mut parameters = vec![0.0; layout.parameter_count()];
    decode(&genome, &ranges, &mut parameters)?;
    let mut net = LeakyNetwork::new(layout, Leak::Filter, parameters, vec![0.0; layout.state_len()])?;
    println!("{inputs} sensors, {} parameters, {outputs} motors", layout.parameter_count());

    let (mut x, mut y) = (vec![0.0; inputs], vec![0.0; outputs]);
    let mut digest = Digest::new();
    for tick in 0..ticks {
        sensors.read(&world, &mut x);
        net.step(&x, &mut y);
        motors.drive(&y, &mut world);
        world.step();

        digest.add_f32s(world.state());
        if tick % 100 == 99 {
            let [px, py, pz] = palm.position(&world).map(|x| 100.0 * x);
            let sphere = 100.0 * world.pose(Tabletop::SPHERE).position[2];
            let touching = (0..world.pairs() as u16).filter(|i| world.pair_contact(PairId(*i)).points > 0).count();
            println!(
                "{:>3} s: palm at ({px:.1}, {py:.1}, {pz:.1}) cm, sphere {sphere:.2} cm high, {touching} pairs touch",
                (tick + 1) / 100
            );
        }
    }
    assert!(world.is_finite(), "the world is still a world");
    assert!(y.iter().all(|y| (0.0..=1.0).contains(y)), "outputs are in [0, 1]");
    Ok(digest.finish())
}
