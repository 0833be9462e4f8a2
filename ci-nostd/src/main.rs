//! Links FARSA's libraries into a program without std, calls into each of them, and returns the failure as its exit code.
//!
//! A crate that links std brings a second panic handler. A crate that needs a heap without the feature `alloc` misses the allocator.
//! This program does not build in either case.
//!
//! `unsafe` is confined to this program: it has no std to start it, so it exports the C library's entry point, and with
//! `alloc` it brings an allocator.
#![no_std]
#![no_main]

#[cfg(feature = "alloc")]
extern crate alloc;

#[cfg(feature = "alloc")]
mod allocations;
#[cfg(feature = "alloc")]
mod heap;
#[cfg(feature = "alloc")]
mod whole;

use core::hint::black_box;

use farsa::body::actuators::{Law, Torque};
use farsa::body::motors::TorqueMotor;
use farsa::body::ports::{Actuated, ActuatorId, Channels, Handles, JointId, Joints, Motor, Sensor};
use farsa::body::sensors::JointPosition;
use farsa::nn::block::{Architecture, BlockLayout, BlockNetwork, BlockPlan};
use farsa::nn::bytes::{Aligned, BlockNetworkBytes, PerceptronBytes};
use farsa::nn::{Controller, Ctrnn, CtrnnLayout, Leak, LeakyLayout, LeakyNetwork, Perceptron};
use farsa::num::{Digest, Domain, Stream};
use farsa::physics::articulated::Spatial;

// The C library's start-up code calls `main`, and the linker gets the library from here.
// SAFETY: the block declares nothing.
#[link(name = "c")]
unsafe extern "C" {}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}

// The toolchain's `core` and `alloc` for this host are compiled to unwind and name these two functions. A program that aborts never
// calls them.
// SAFETY: the names belong to std, which is not here.
#[unsafe(no_mangle)]
extern "C" fn rust_eh_personality() {}
// SAFETY: the same.
#[unsafe(no_mangle)]
extern "C" fn _Unwind_Resume() -> ! {
    loop {}
}

/// A board with one joint and one motor on it.
struct Board {
    angle: f32,
    torque: f32,
}

impl Handles for Board {
    type Body = ();
    type Joint = JointId;
    type Actuator = ActuatorId;
}

impl Joints for Board {
    fn position(&self, _: JointId) -> f32 {
        self.angle
    }
    fn speed(&self, _: JointId) -> f32 {
        0.0
    }
}

impl Actuated for Board {
    fn command(&mut self, _: ActuatorId, value: [f32; 2]) {
        let motor = Law::Torque(Torque { limit: 1.0 });
        self.torque = motor.effort(self.angle, 0.0, value).torque;
    }
}

const LAYOUT: LeakyLayout = LeakyLayout::new(1, 2, 1);
static PARAMETERS: [f32; LAYOUT.parameter_count()] = [1.0, -1.0, 0.5, 0.0, 0.0, 0.5, 2.0, -2.0, 0.1, 0.1, 0.5, 0.5];

const PLAN: BlockPlan = Architecture::elman(1, 2, 1).plan();
const BLOCKS: BlockLayout = PLAN.layout();
const CONTINUOUS: CtrnnLayout = CtrnnLayout::new(1, 2, 1);

/// The other networks, from constants.
fn other_networks() -> Result<(), i32> {
    let mut blocks =
        BlockNetwork::new(BLOCKS, Leak::Filter, [0.5; BLOCKS.parameter_count()], [0.0; BLOCKS.state_len()])
            .map_err(|_| 6)?;
    let mut continuous =
        Ctrnn::new(CONTINUOUS, 0.1, [1.0; CONTINUOUS.parameter_count()], [0.0; CONTINUOUS.state_len()])
            .map_err(|_| 7)?;
    let (mut y, mut z) = ([0.0], [0.0]);
    for _ in 0..100 {
        blocks.step(&[1.0], &mut y);
        continuous.step(&y, &mut z);
    }
    if 0.5 < y[0] && y[0] < 1.0 && y[0] < z[0] && z[0] < 1.0 { Ok(()) } else { Err(8) }
}

/// Networks of bytes, without a heap.
fn networks_of_bytes() -> Result<(), i32> {
    let mut flash = Aligned([0; BlockNetworkBytes::byte_count(&BLOCKS)]);
    BlockNetworkBytes::write(BLOCKS, Leak::Filter, 0, &[0.5; BLOCKS.parameter_count()], &mut flash.0).map_err(|_| 9)?;
    let bytes = BlockNetworkBytes::read(&flash.0).map_err(|_| 20)?;
    bytes.expect(BLOCKS, Leak::Filter).map_err(|_| 21)?;
    let parameters = bytes.parameters().map_err(|_| 22)?;
    let mut blocks = BlockNetwork::new(BLOCKS, bytes.leak(), parameters, [0.0; BLOCKS.state_len()]).map_err(|_| 23)?;
    let mut flash = Aligned([0; PerceptronBytes::byte_count(1, 1)]);
    PerceptronBytes::write(1, 1, 1.0, 0, &[1.0, 0.0], &mut flash.0).map_err(|_| 24)?;
    let bytes = PerceptronBytes::read(&flash.0).map_err(|_| 25)?;
    let parameters = bytes.parameters().map_err(|_| 26)?;
    let mut layer = Perceptron::new(bytes.inputs(), bytes.outputs(), bytes.slope(), parameters).map_err(|_| 27)?;
    let (mut y, mut z) = ([0.0], [0.0]);
    blocks.step(&[1.0], &mut y);
    layer.step(&y, &mut z);
    if 0.5 < y[0] && y[0] < 1.0 && 0.5 < z[0] && z[0] < y[0] { Ok(()) } else { Err(28) }
}

/// The four-line loop on a board: 0 if it ran, else the number of what failed.
fn on_a_board() -> Result<(), i32> {
    let mut sensor = JointPosition::new(JointId(0), -1.0, 1.0).map_err(|_| 1)?;
    let mut motor = TorqueMotor::new(ActuatorId(0), 1.0).map_err(|_| 2)?;
    let mut net = LeakyNetwork::new(LAYOUT, Leak::Filter, &PARAMETERS, [0.0; LAYOUT.state_len()]).map_err(|_| 3)?;
    let mut board = Board { angle: 0.0, torque: 0.0 };
    let mut noise = Stream::new(1, Domain::Sensor, 0, 0, 0);
    let mut digest = Digest::new();
    let (mut x, mut y) = ([0.0], [0.0]);
    if sensor.channels() != 1 {
        return Err(4);
    }
    for _ in 0..1000 {
        sensor.read(&board, &mut x);
        net.step(&x, &mut y);
        motor.drive(&y, &mut board);
        board.angle = (board.angle + 0.01 * board.torque + 0.01 * noise.normal()).clamp(-1.0, 1.0);
        digest.add_f32(board.angle);
    }
    let twist = Spatial::<f32> { angular: [0.0, 0.0, 1.0], linear: [0.0; 3] };
    if !(0.0..=1.0).contains(&y[0]) || black_box(digest.finish()) == 0 || (twist + twist).angular[2] != 2.0 {
        return Err(5);
    }
    Ok(())
}

// SAFETY: the one `main` of the program, with the C library's signature less the arguments, which C allows.
#[unsafe(no_mangle)]
extern "C" fn main() -> i32 {
    if let Err(what) = on_a_board().and_then(|()| other_networks()).and_then(|()| networks_of_bytes()) {
        return what;
    }
    #[cfg(feature = "alloc")]
    if let Err(what) = whole::runs().and_then(|()| allocations::steps_take_none()) {
        return what;
    }
    0
}
