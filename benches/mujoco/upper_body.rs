//! Our side of the cost of the iCub's upper body. It measures the time of a dynamics step by the number of joints, and
//! writes the robot and the commands for MuJoCo. The script `upper_body.py` in this folder calls it.
//!
//! `export FOLDER`, `time SECONDS`.
#![allow(missing_docs)]

use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::time::Instant;

use farsa::body::actuators::Law;
use farsa::body::ports::{Actuated, ActuatorId, Arrange, BodyId, Contacts, JointId, PairId, Snapshot, World as _};
use farsa::body::robot::{Pair, Robot};
use farsa::body::robots::{ArmAndHand, Chain, Icub};
use farsa::num::{Domain, Stream, sin_cos};
use farsa::physics::articulated::{Batch, Model, Options, World};
use farsa_models::mjcf::{self, MjcfOptions};

type Failure = Box<dyn Error>;

/// Timed control steps, and the number by which a lane is ahead of its neighbor.
const STEPS: usize = 200;
const AHEAD: usize = 5;
/// Control steps for which a random target is held.
const HELD: usize = 20;
const PHASES: [&str; 2] = ["free", "random"];

/// A robot, where it starts and what it is commanded.
struct Case {
    name: &'static str,
    robot: Robot,
    start: Vec<f64>,
}

impl Case {
    fn icub(name: &'static str, actuated: &[Chain]) -> Result<Self, Failure> {
        let icub = Icub { actuated: actuated.to_vec(), ..Icub::default() };
        Ok(Self { name, robot: icub.robot()?, start: icub.start() })
    }

    fn all() -> Result<Vec<Self>, Failure> {
        use Chain::{LeftHand, Neck, RightArm, RightHand, Torso};
        let arm = ArmAndHand::default().robot()?;
        let start = arm.joints().map(|joint| arm.segments[joint.index()].joint.range).map(middle).collect();
        let whole = Self::icub("iCub", &Chain::ALL)?;
        Ok(vec![
            Self::icub("iCub, right arm", &[RightArm])?,
            Self { name: "arm and hand, muscles", robot: arm, start },
            Self::icub("iCub, right arm and hand", &[RightArm, RightHand])?,
            Self::icub("iCub without left arm", &[Torso, Neck, RightArm, LeftHand, RightHand])?,
            Self { name: "iCub with two more hands", ..with_more_hands(&whole) },
            whole,
        ])
    }

    /// The joint of an actuator and its limits, or none of a muscle pair.
    fn range(&self, actuator: usize) -> Option<(JointId, [f64; 2])> {
        let actuator = &self.robot.actuators[actuator];
        let range = self.robot.segments[actuator.joint.index()].joint.range;
        (!matches!(actuator.law, Law::MusclePair(_))).then_some((actuator.joint, range))
    }

    /// Returns commands of all actuators in every control step: `free`, sines about the start, or `random`, targets
    /// within the limits.
    fn commands(&self, phase: &str) -> Vec<Vec<[f32; 2]>> {
        let mut stream = Stream::new(1, Domain::Motor, 0, 0, 0);
        let joints: Vec<JointId> = self.robot.joints().collect();
        let count = self.robot.actuators.len();
        let waves: Vec<[f64; 2]> = (0..count).map(|_| [0.5 + stream.uniform_f64(), stream.uniform_f64()]).collect();
        let mut held = vec![[0.0; 2]; count];
        let mut all = Vec::new();
        for step in 0..STEPS + 16 * AHEAD {
            for (i, command) in held.iter_mut().enumerate() {
                let [hertz, shift] = waves[i];
                let sine = sin_cos(core::f64::consts::TAU * (0.01 * hertz * step as f64 + shift)).0;
                let renewed = step.is_multiple_of(HELD);
                match (phase, self.range(i)) {
                    ("free", Some((joint, range))) => {
                        let at = joints.iter().position(|other| *other == joint).map_or(0.0, |k| self.start[k]);
                        command[0] = (at + 0.1 + 0.1 * sine).clamp(range[0], range[1]) as f32;
                    }
                    ("free", None) => *command = [sine, -sine].map(|x| (0.5 + 0.4 * x) as f32),
                    (_, Some((_, [low, high]))) if renewed => command[0] = stream.range_f64(low, high) as f32,
                    (_, None) if renewed => *command = [stream.uniform(), stream.uniform()],
                    _ => {}
                }
            }
            all.push(held.clone());
        }
        all
    }
}

fn middle([low, high]: [f64; 2]) -> f64 {
    0.5 * (low + high)
}

/// A hundred joints: each palm carries a second hand like its first, in the same place but without pairs between both.
fn with_more_hands(whole: &Case) -> Case {
    let (mut robot, mut start) = (whole.robot.clone(), whole.start.clone());
    let first = Chain::LeftHand.bodies().start;
    let more = robot.segments.len() - first;
    let moved = |body: BodyId| if body.index() < first { body } else { BodyId(body.0 + more as u16) };
    for i in first..first + more {
        let mut segment = robot.segments[i].clone();
        segment.parent = segment.parent.map(moved);
        segment.name = format!("second_{}", segment.name);
        segment.joint.name = format!("second_{}", segment.joint.name);
        robot.add_segment(segment);
        start.push(whole.start[i]);
    }
    let colliders: Vec<usize> = (0..robot.colliders.len())
        .map(|i| {
            let mut collider = robot.colliders[i].clone();
            if collider.body.is_none_or(|body| body.index() < first) {
                return i;
            }
            collider.body = collider.body.map(moved);
            collider.name = format!("second_{}", collider.name);
            robot.add_collider(collider)
        })
        .collect();
    let groups = whole.robot.pairs.iter().filter_map(|pair| pair.group).max().map_or(0, |last| last + 1);
    for pair in &whole.robot.pairs {
        let second = pair.colliders.map(|i| colliders[i]);
        if second != pair.colliders {
            robot.pairs.push(Pair { colliders: second, group: pair.group.map(|group| group + groups), ..*pair });
        }
    }
    for actuator in whole.robot.actuators.iter().filter(|actuator| actuator.joint.index() >= first) {
        let joint = JointId(actuator.joint.0 + more as u16);
        robot.add_actuator(&format!("second_{}", actuator.name), joint, actuator.law);
    }
    Case { name: whole.name, robot, start }
}

fn command<W: Actuated<Actuator = ActuatorId> + ?Sized>(world: &mut W, words: &[[f32; 2]]) {
    for (i, word) in words.iter().enumerate() {
        world.command(ActuatorId(i as u16), *word);
    }
}

/// The states in which control steps begin, from the case's start, and how many pairs touch in the timed ones on average.
fn beginnings(case: &Case, model: &Model<f32>, commands: &[Vec<[f32; 2]>]) -> (Vec<Vec<f32>>, f64) {
    let mut world = World::new(model.clone());
    for (joint, angle) in case.robot.joints().zip(&case.start) {
        world.place_joint(joint, *angle as f32, 0.0);
    }
    world.finish_placement();
    let (mut states, mut touching) = (Vec::new(), 0);
    for (step, words) in commands.iter().enumerate() {
        states.push(world.state().to_vec());
        command(&mut world, words);
        world.step();
        let pairs = (0..world.pairs()).filter(|pair| world.touches(PairId(*pair as u16))).count();
        touching += if step < STEPS { pairs } else { 0 };
    }
    (states, touching as f64 / STEPS as f64)
}

/// Microseconds per world and dynamics step: the least of a control step's repetitions is its own time.
fn time(batch: &mut Batch, states: &[Vec<f32>], commands: &[Vec<[f32; 2]>], seconds: f64, substeps: u32) -> f64 {
    let lanes = batch.lanes();
    let mut least = vec![f64::INFINITY; STEPS];
    let begin = Instant::now();
    while begin.elapsed().as_secs_f64() < seconds {
        for lane in 0..lanes {
            batch.lane(lane).restore(&states[AHEAD * lane]);
        }
        for (step, least) in least.iter_mut().enumerate() {
            let begin = Instant::now();
            for lane in 0..lanes {
                command(&mut batch.lane(lane), &commands[step + AHEAD * lane]);
            }
            batch.step();
            *least = least.min(begin.elapsed().as_secs_f64());
        }
    }
    1e6 * least.iter().sum::<f64>() / (STEPS * lanes) as f64 / f64::from(substeps)
}

/// A line for every robot, phase and kind of lanes: name, joints, pairs, lanes, phase, microseconds, pairs that touch.
fn times(seconds: f64) -> Result<(), Failure> {
    let options = Options::default();
    for case in Case::all()? {
        for phase in ["no pairs", "free", "random"] {
            let mut robot = case.robot.clone();
            if phase == "no pairs" {
                robot.pairs.clear();
            }
            let model = Model::<f32>::new(&robot, &options)?;
            let commands = case.commands(if phase == "no pairs" { "free" } else { phase });
            let (states, touching) = beginnings(&case, &model, &commands);
            for (set, lanes) in [("Avx2", 8), ("Avx512", 16)] {
                let found = Batch::instructions()
                    .find(|level| format!("{level:?}").to_lowercase().contains(&set.to_lowercase()));
                let Some(level) = found else { continue };
                let mut batch = Batch::new(model.clone(), lanes, level)?;
                let spent = time(&mut batch, &states, &commands, seconds, options.substeps);
                let (joints, pairs) = (robot.joints().count(), case.robot.pairs.len());
                println!("{}\t{joints}\t{pairs}\t{lanes} {set}\t{phase}\t{spent:.4}\t{touching:.1}", case.name);
            }
        }
    }
    Ok(())
}

/// Writes the robot for MuJoCo, and for each phase a file with the start and the commands of every control step, both
/// in the order of the joints.
fn export(folder: &Path) -> Result<(), Failure> {
    let case = Case::icub("iCub", &Chain::ALL)?;
    let options = Options::default();
    let time_step = options.time_step / f64::from(options.substeps);
    fs::write(
        folder.join("icub.xml"),
        mjcf::write(&case.robot, &MjcfOptions { time_step, ..MjcfOptions::default() })?,
    )?;
    for phase in PHASES {
        let mut text = String::new();
        for joint in case.robot.joints() {
            // Writing into a string cannot fail.
            let _ = write!(text, "{} ", case.robot.segments[joint.index()].joint.name);
        }
        let _ = writeln!(text);
        let start = case.start.iter().map(|angle| *angle as f32).collect();
        let commands = case.commands(phase).into_iter().take(STEPS);
        for row in core::iter::once(start).chain(commands.map(|words| words.iter().map(|word| word[0]).collect())) {
            let row: Vec<f32> = row;
            for x in row {
                let _ = write!(text, "{x:?} ");
            }
            let _ = writeln!(text);
        }
        fs::write(folder.join(format!("icub-{phase}.txt")), text)?;
    }
    Ok(())
}

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        // An argument of `cargo bench`, which measures nothing here.
        [.., "--bench"] => println!("benches/mujoco/run icub measures"),
        ["export", folder] => export(Path::new(folder))?,
        ["time", seconds] => times(seconds.parse()?)?,
        _ => return Err("export FOLDER | time SECONDS".into()),
    }
    Ok(())
}
