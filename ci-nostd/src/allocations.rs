//! Once sensors, networks, motors and worlds are made, steps take nothing from the heap, which takes nothing back.

use alloc::vec;
use alloc::vec::Vec;

use farsa::body::motors::{Muscles, ServoGroup, WheelVelocity};
use farsa::body::ports::{Channels, Contacts, Motor, PairId, Sensor, World as _};
use farsa::body::robots::{ArmAndHand, MobileRobot, Tabletop};
use farsa::body::sensors::infrared::InfraredFormula;
use farsa::body::sensors::{JointPosition, JointSpeed, Touch, WheelSpeed};
use farsa::nn::block::{Architecture, BlockNetwork};
use farsa::nn::{Controller, Ctrnn, CtrnnLayout, Leak, LeakyLayout, LeakyNetwork};
use farsa::num::{Domain, Stream};
use farsa::physics::{arena, articulated};

use crate::heap;

const STEPS: usize = 2000;
/// Steps between two changes of the motor commands.
const HELD: usize = 20;
/// Wheeled robots in one arena, four columns of them.
const ROBOTS: u16 = 20;

/// Exit codes: a construction failed or nothing moved, and a step allocated.
const FAILED: i32 = 17;
const ALLOCATED: i32 = 18;

fn made<T, E>(result: Result<T, E>) -> Result<T, i32> {
    result.map_err(|_| FAILED)
}

/// Checks that `STEPS` steps allocate nothing and that at least one reports motion.
fn allocates_nothing(mut step: impl FnMut(usize) -> bool) -> Result<(), i32> {
    let (before, mut happened) = (heap::used(), false);
    for t in 0..STEPS {
        happened |= step(t);
    }
    if heap::used() != before {
        return Err(ALLOCATED);
    }
    if happened { Ok(()) } else { Err(FAILED) }
}

/// Checks the arm with table and sphere, an arena of Kheperas, networks, and both worlds in lanes with their feature.
pub fn steps_take_none() -> Result<(), i32> {
    // Shows that the counter works.
    let before = heap::used();
    if core::hint::black_box(vec![0_u8; 100]).len() > heap::used() - before {
        return Err(FAILED);
    }
    arm_and_hand()?;
    kheperas()?;
    networks()?;
    #[cfg(feature = "lanes")]
    lanes()?;
    Ok(())
}

fn fill(values: &mut [f32], stream: &mut Stream) {
    values.iter_mut().for_each(|value| *value = stream.uniform());
}

fn arm_and_hand() -> Result<(), i32> {
    let arm = ArmAndHand::default();
    let robot = made(Tabletop::default().scene(&arm))?;
    let mut world = articulated::World::new(made(articulated::Model::<f32>::new(&robot, &Default::default()))?);
    let ranges = ArmAndHand::joints().into_iter().zip(arm.arm_ranges);
    let positions = ranges.map(|(joint, [low, high])| JointPosition::new(joint, low as f32, high as f32));
    let mut positions = made(positions.collect::<Result<Vec<_>, _>>())?;
    let mut speeds: Vec<_> = ArmAndHand::joints().into_iter().map(JointSpeed::new).collect();
    let pairs = 0..world.pairs() as u16;
    let mut touch = made(Touch::new(pairs.clone().map(PairId).collect::<Vec<_>>(), 3.0))?;
    let mut muscles: Vec<_> = (0..7).map(|pair| Muscles::new(farsa::body::ports::ActuatorId(pair))).collect();
    let mut hand = made(arm.servo_groups().into_iter().map(ServoGroup::new).collect::<Result<Vec<_>, _>>())?;
    let mut stream = Stream::new(1, Domain::Motor, 0, 0, 0);
    let mut x = vec![0.0; positions.channels().max(speeds.channels())];
    let (mut y, mut z) = (vec![0.0; muscles.channels()], vec![0.0; hand.channels()]);
    let mut efforts = vec![0.0; world.velocities().len()];
    allocates_nothing(|t| {
        positions.read(&world, &mut x);
        speeds.read(&world, &mut x);
        touch.read(&world, &mut x);
        if t.is_multiple_of(HELD) {
            fill(&mut y, &mut stream);
            fill(&mut z, &mut stream);
        }
        muscles.drive(&y, &mut world);
        hand.drive(&z, &mut world);
        world.step();
        world.gravity_efforts(&mut efforts);
        // More than the sphere on the table: the hand touches something.
        world.is_finite() && pairs.clone().filter(|pair| world.touches(PairId(*pair))).count() > 1
    })
}

/// Twenty Kheperas between four walls.
fn square() -> arena::Arena {
    let mut square = arena::Arena::walled(0.6, 0.6);
    for i in 0..ROBOTS {
        let place = [0.1 + 0.1 * f64::from(i % 4), 0.1 + 0.1 * f64::from(i / 4)];
        square.add_robot(MobileRobot::khepera(), place, f64::from(i));
    }
    square
}

fn kheperas() -> Result<(), i32> {
    let robot = MobileRobot::khepera();
    let mut world = made(arena::World::new(&square()))?;
    let fastest = robot.max_wheel_speed as f32;
    let (mut rings, mut felt, mut wheels) = (Vec::new(), Vec::new(), Vec::new());
    for i in 0..usize::from(ROBOTS) {
        let parts = world.parts(i);
        rings.push(made(InfraredFormula::for_robot(&robot, parts.body))?);
        felt.push(made(WheelSpeed::new(parts.wheels, fastest))?);
        wheels.push(made(WheelVelocity::new(parts.motors, fastest))?);
    }
    let pairs = 0..world.pairs() as u16;
    let mut stream = Stream::new(2, Domain::Motor, 0, 0, 0);
    let (mut x, mut y) = (vec![0.0; rings.channels()], vec![0.0; wheels.channels()]);
    allocates_nothing(|t| {
        rings.read(&world, &mut x);
        felt.read(&world, &mut x);
        if t.is_multiple_of(HELD) {
            fill(&mut y, &mut stream);
        }
        wheels.drive(&y, &mut world);
        world.step();
        pairs.clone().any(|pair| world.touches(PairId(pair)))
    })
}

fn networks() -> Result<(), i32> {
    let leaky = LeakyLayout::new(29, 12, 23);
    let zeros = |len| vec![0.0; len];
    let parameters = vec![0.5; leaky.parameter_count()];
    let mut leaky = made(LeakyNetwork::new(leaky, Leak::Filter, parameters, zeros(leaky.state_len())))?;
    let plan = Architecture::elman(29, 12, 23).with_input_delay(2).plan();
    let layout = plan.layout();
    let parameters = vec![0.1; layout.parameter_count()];
    let mut blocks = made(BlockNetwork::new(layout, Leak::Filter, parameters, zeros(layout.state_len())))?;
    let layout = CtrnnLayout::new(29, 35, 23);
    let parameters = vec![1.0; layout.parameter_count()];
    let mut ctrnn = made(Ctrnn::new(layout, 0.1, parameters, zeros(layout.state_len())))?;
    let mut stream = Stream::new(3, Domain::Sensor, 0, 0, 0);
    let (mut x, mut y) = ([0.0; 29], [0.0; 23]);
    allocates_nothing(|_| {
        fill(&mut x, &mut stream);
        let mut happened = true;
        for network in [&mut leaky as &mut dyn Controller, &mut blocks, &mut ctrnn] {
            network.step(&x, &mut y);
            happened &= y.iter().all(|y| (0.0..=1.0).contains(y)) && y[0] != 0.0;
        }
        happened
    })
}

#[cfg(feature = "lanes")]
fn lanes() -> Result<(), i32> {
    use farsa::body::ports::{Actuated, ActuatorId};
    use farsa::num::Instructions;

    let robot = made(Tabletop::default().scene(&ArmAndHand::default()))?;
    let model = made(articulated::Model::new(&robot, &Default::default()))?;
    let mut batch = made(articulated::Batch::new(model, articulated::LANES[0], Instructions::baseline()))?;
    let mut stream = Stream::new(4, Domain::Motor, 0, 0, 0);
    allocates_nothing(|t| {
        let mut touching = false;
        for lane in 0..batch.lanes() {
            let mut lane = batch.lane(lane);
            touching |= (0..lane.pairs() as u16).filter(|pair| lane.touches(PairId(*pair))).count() > 1;
            for actuator in 0..if t.is_multiple_of(HELD) { 27 } else { 0 } {
                lane.command(ActuatorId(actuator), [stream.uniform(), stream.uniform()]);
            }
        }
        batch.step();
        touching
    })?;
    let mut batch = made(arena::Batch::new(&square(), articulated::LANES[0], Instructions::baseline()))?;
    let mut values = vec![0.0; batch.lanes()];
    let mut rings = vec![0.0; 8 * batch.lanes()];
    allocates_nothing(|t| {
        for actuator in 0..if t.is_multiple_of(HELD) { 2 * ROBOTS } else { 0 } {
            values.iter_mut().for_each(|value| *value = stream.range(-6.0, 6.0));
            batch.command(ActuatorId(actuator), &values);
        }
        batch.step();
        (0..usize::from(ROBOTS)).for_each(|robot| batch.infrared(robot, &mut rings));
        let lane = batch.lane(0);
        (0..lane.pairs() as u16).any(|pair| lane.touches(PairId(pair)))
    })
}
