//! The report of a board: the lines that `./ci firmware` reads.

use core::hint::black_box;

use controller::{ARM, Board, Control, FixedRobot, LAYOUT, Robot, noise_into, self_test};
use e_puck::run_episode;
use farsa_nn::bytes::BytesError;
use farsa_num::{Digest, Domain, Stream};

use crate::{exit, say, say_hex, used};

/// Control steps that are counted.
const COUNTED: u32 = 1000;

/// Steps of the self-test: `FARSA_STEPS` when the program was built, else 100000.
const STEPS: u32 = match option_env!("FARSA_STEPS") {
    Some(steps) => parsed(steps),
    None => 100_000,
};

/// Steps of the recorded episode.
const STEPS_OF_EPISODE: u64 = e_puck::STEPS as u64;

const fn parsed(digits: &str) -> u32 {
    let (mut number, mut rest) = (0, digits.as_bytes());
    while let [digit, tail @ ..] = rest {
        number = 10 * number + (*digit - b'0') as u32;
        rest = tail;
    }
    number
}

/// Runs the self-test and the loop of the champion, prints the results and ends.
///
/// `instructions` counts the instructions since the start, as exactly as the processor can.
pub fn report(instructions: impl Fn() -> u64) -> ! {
    tell(Robot::new, ["driven", "hash"], instructions)
}

/// Runs them for the champion in integers.
pub fn report_fixed(instructions: impl Fn() -> u64) -> ! {
    tell(FixedRobot::new, ["driven-fixed", "hash-fixed"], instructions)
}

// The robot is built here, because an argument would be on the stack twice.
fn tell<R: Control>(
    robot: impl FnOnce() -> Result<R, BytesError>,
    [driven_name, hash_name]: [&str; 2],
    instructions: impl Fn() -> u64,
) -> ! {
    let Ok(mut robot) = robot() else { exit(false) };
    let mut board = Board::new();
    let mut noise = Stream::new(1, Domain::Sensor, 0, 0, 0);

    // The loop without the noise, then its network alone.
    let (mut ticks, mut network, mut driven) = (0, 0, Digest::new());
    let x = [R::HALF; LAYOUT.sensors()];
    for _ in 0..COUNTED {
        noise_into(&mut board, &mut noise);
        let begin = instructions();
        robot.tick(&mut board);
        let between = instructions();
        robot.step(&x);
        network += instructions().wrapping_sub(between);
        ticks += between.wrapping_sub(begin);
        board.widths.iter().for_each(|width| driven.add_bytes(&width.to_le_bytes()));
    }
    say("instructions-network", (network / u64::from(COUNTED)) as u32);
    say("instructions-loop", (ticks / u64::from(COUNTED)) as u32);
    say_hex(driven_name, driven.finish());
    say("ram", (size_of::<R>() + size_of::<Board>()) as u32);
    say("steps", STEPS);
    say_hex(hash_name, self_test(&mut robot, STEPS));
    say("stack", used());
    #[cfg(feature = "planted-panic")]
    say("never", [1, 2, 3][black_box(7)]);
    exit(true)
}

/// Computes the torques that hold the arm in random postures, prints the results and ends.
pub fn report_arm(instructions: impl Fn() -> u64) -> ! {
    let mut postures = Stream::new(1, Domain::Start, 0, 0, 0);
    let (mut spent, mut digest) = (0, Digest::new());
    for _ in 0..COUNTED {
        let q = core::array::from_fn(|_| postures.range(-1.5, 1.5));
        let begin = instructions();
        let torques = ARM.holding_torques(black_box(&q));
        spent += instructions().wrapping_sub(begin);
        digest.add_f32s(&torques);
    }
    say("instructions-gravity", (spent / u64::from(COUNTED)) as u32);
    say_hex("torques", digest.finish());
    say("stack", used());
    exit(true)
}

/// Drives the recorded episode of the e-puck, prints the results and ends.
pub fn report_e_puck(instructions: impl Fn() -> u64) -> ! {
    let mut spent = 0;
    let ran = run_episode(|tick| {
        let begin = instructions();
        tick();
        spent += instructions().wrapping_sub(begin);
    });
    let Ok((hash, safe)) = ran else { exit(false) };
    say("instructions-tick", (spent / STEPS_OF_EPISODE.max(1)) as u32);
    say_hex("episode", hash);
    say("safe", u32::from(safe));
    say("stack", used());
    #[cfg(feature = "planted-panic")]
    say("never", [1, 2, 3][black_box(7)]);
    exit(true)
}
