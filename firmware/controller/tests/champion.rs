//! The expected results of boards.

use farsa_num::{Digest, Domain, Stream};
use firmware_controller::{ARM, Board, Control, LAYOUT, Pulse, Robot, noise_into, self_test};

/// `./ci firmware` and `./ci wasm` compare every target with these lines.
#[test]
fn the_self_test_has_its_hash() {
    let expected = include_str!("../../golden.txt");
    let mut robot = Robot::new().expect("the champion");
    for line in expected.lines().filter_map(|line| line.strip_prefix("hash ")) {
        let (steps, hash) = line.split_once(' ').expect("steps and hash");
        let steps: u32 = steps.parse().expect("a number");
        // The long one takes a minute without optimization, so it runs only by name.
        if steps <= 100_000 || std::env::var_os("FARSA_LONG").is_some() {
            assert_eq!(format!("{:016x}", self_test(&mut robot, steps)), hash, "{steps} steps");
        }
    }
}

#[test]
fn a_loop_drives_what_it_reads() {
    let mut robot = Robot::new().expect("the champion");
    let (mut board, mut noise) = (Board::new(), Stream::new(1, Domain::Sensor, 0, 0, 0));
    let mut driven = Vec::new();
    for _ in 0..100 {
        noise_into(&mut board, &mut noise);
        robot.tick(&mut board);
        assert!(board.widths.iter().all(|width| *width <= Pulse::TOP));
        driven.push(board.widths);
    }
    assert!((0..board.widths.len()).any(|motor| driven.iter().any(|widths| widths[motor] != driven[0][motor])));
    assert!(size_of::<Robot>() + size_of::<Board>() <= 1024, "{} bytes", size_of::<Robot>() + size_of::<Board>());
}

/// Boards also print these.
#[test]
fn what_boards_print_beside_it() {
    let golden = include_str!("../../golden.txt");
    let line =
        |name: &str| golden.lines().find_map(|line| line.strip_prefix(name)).expect("the line").trim().to_owned();

    let mut robot = Robot::new().expect("the champion");
    let (mut board, mut noise) = (Board::new(), Stream::new(1, Domain::Sensor, 0, 0, 0));
    let mut driven = Digest::new();
    for _ in 0..1000 {
        noise_into(&mut board, &mut noise);
        robot.tick(&mut board);
        robot.step(&[0.5; LAYOUT.sensors()]);
        board.widths.iter().for_each(|width| driven.add_bytes(&width.to_le_bytes()));
    }
    assert_eq!(format!("{:016x}", driven.finish()), line("driven"));

    let mut postures = Stream::new(1, Domain::Start, 0, 0, 0);
    let mut torques = Digest::new();
    for _ in 0..1000 {
        torques.add_f32s(&ARM.holding_torques(&core::array::from_fn(|_| postures.range(-1.5, 1.5))));
    }
    assert_eq!(format!("{:016x}", torques.finish()), line("torques"));
}
