//! A lane of a batch is the world alone, bit for bit: the whole scene at every instruction set of this machine.
#![allow(missing_docs, clippy::unwrap_used)]
#![cfg(feature = "lanes")]

mod channels;
mod common;
mod sliding;

use std::cell::RefCell;

use channels::channels_conform;
use common::{Babble, commands, drive, first_point, model, points_of, scene, start};
use farsa_body::motors::ServoRange;
use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, Hit, JointId, Joints, Kinematics, PairContact, PairId,
    Rays, Snapshot, World as _,
};
use farsa_body::robot::{
    Collider, Impedance, Joint, MassProperties, Robot, Segment, Shape, SoftContact, Stop, Surface,
};
use farsa_body::robots::ArmAndHand;
use farsa_body::testing::{Probe, check_arrange, check_rays, check_world};
use farsa_body::{Pose, Twist};
use farsa_num::{Digest, Domain, Instructions, Stream, sin_cos};
use farsa_physics::articulated::{Batch, LANES, Lane, Model, ModelError, Options, World};

/// Control steps of every lane. Ten times as many with `FARSA_LONG=1`.
fn steps() -> usize {
    if std::env::var_os("FARSA_LONG").is_some() { 20_000 } else { 2000 }
}

const WORLDS: usize = 16;
/// Lanes are refilled every so often, but not together: each begins in another phase.
const EPISODE_STEPS: usize = 600;
/// The lane that loses a joint, and when.
const LOST: (usize, usize) = (3, 700);

/// Returns the instruction sets of this machine, and none.
fn all_instructions() -> impl Iterator<Item = Instructions> {
    Batch::instructions().chain([Instructions::Fallback])
}

/// Returns the number of the episode that begins in a lane before step `t`, if any.
fn begins(lane: usize, t: usize) -> Option<u32> {
    let shifted = t + 37 * lane;
    (t == 0 || shifted.is_multiple_of(EPISODE_STEPS)).then_some((lane + WORLDS * (shifted / EPISODE_STEPS)) as u32)
}

/// The state in which an episode begins: the first episodes of the lanes some way on, so that phases differ from the
/// first step.
fn beginning(robot: &Robot, world: &mut World<f32>, groups: &[Vec<ServoRange>; 9], episode: u32) -> (Vec<f32>, Babble) {
    start(robot, world, &mut Stream::new(5, Domain::Start, episode, 0, 0), episode as usize);
    let mut babble = Babble::new(5, episode);
    for _ in 0..13 * (episode as usize % 8) {
        drive(world, &commands(groups, babble.next()));
        world.step();
    }
    (world.state().to_vec(), babble)
}

fn digest(state: &[f32]) -> Digest {
    let mut d = Digest::new();
    d.add_f32s(state);
    d
}

/// Fingerprints of the state after every step of one lane, the last state, and the number of steps with hand contacts.
struct Truth {
    digests: Vec<Digest>,
    last: Vec<f32>,
    contacts: usize,
}

fn alone(robot: &Robot, model: &Model<f32>, groups: &[Vec<ServoRange>; 9], lane: usize) -> Truth {
    let mut world = World::new(model.clone());
    let mut other = world.clone();
    let mut babble = Babble::new(0, 0);
    let mut truth = Truth { digests: Vec::new(), last: Vec::new(), contacts: 0 };
    let table = robot.pair("sphere", "table").unwrap().index();
    let first = first_point(robot, model);
    let of_table: usize = first + 8 * (0..table).map(|p| points_of(robot, p)).sum::<usize>();
    let points: usize = (0..robot.pairs.len()).map(|p| points_of(robot, p)).sum();
    for t in 0..steps() {
        if let Some(episode) = begins(lane, t) {
            let (state, new) = beginning(robot, &mut other, groups, episode);
            world.state_mut().copy_from_slice(&state);
            world.finish_placement();
            babble = new;
        }
        if (lane, t) == LOST {
            world.state_mut()[4] = f32::NAN;
            world.finish_placement();
        }
        drive(&mut world, &commands(groups, babble.next()));
        world.step();
        let state = world.state();
        truth.digests.push(digest(state));
        let touch = |at: usize| state[at + 3] > 0.0;
        truth.contacts += usize::from((0..points).map(|p| first + 8 * p).any(|at| at != of_table && touch(at)));
    }
    truth.last = world.state().to_vec();
    truth
}

/// Steps a batch through what the worlds alone have gone through and compares every state word after every step.
fn together(name: &str, robot: &Robot, batch: &mut Batch, groups: &[Vec<ServoRange>; 9], truths: &[Truth]) {
    let mut other = World::new(batch.model().clone());
    let lanes = batch.lanes();
    let mut babbles = vec![Babble::new(0, 0); lanes];
    let mut own = vec![0.0; batch.model().state_len()];
    for t in 0..steps() {
        for lane in 0..lanes {
            let mut world = batch.lane(lane);
            if let Some(episode) = begins(lane, t) {
                let (start, new) = beginning(robot, &mut other, groups, episode);
                world.restore(&start);
                babbles[lane] = new;
            }
            if (lane, t) == LOST {
                world.save(&mut own);
                own[4] = f32::NAN;
                world.restore(&own);
            }
            drive(&mut world, &commands(groups, babbles[lane].next()));
        }
        batch.step();
        for lane in 0..lanes {
            batch.lane(lane).save(&mut own);
            assert!(digest(&own) == truths[lane].digests[t], "{name}: lane {lane} differs after step {t}");
        }
    }
    for lane in 0..lanes {
        let world = batch.lane(lane);
        world.save(&mut own);
        for (k, (x, truth)) in own.iter().zip(&truths[lane].last).enumerate() {
            assert!(x.to_bits() == truth.to_bits() || x.is_nan() && truth.is_nan(), "{name}: lane {lane} word {k}");
        }
        other.restore(&own);
        for body in 0..robot.segments.len() {
            let body = BodyId(body as u16);
            assert_eq!((world.pose(body), world.velocity(body)), (other.pose(body), other.velocity(body)), "{name}");
        }
    }
    println!("{name}: {lanes} lanes x {} control steps, equal bits", steps());
}

#[test]
fn every_lane_has_the_bits_of_the_world_alone() {
    let robot = scene();
    let model = model(&robot, Options { substeps: 2, path_error: Some(1e-4), ..Options::default() });
    let groups = ArmAndHand::default().servo_groups();
    let truths: Vec<Truth> = (0..WORLDS).map(|lane| alone(&robot, &model, &groups, lane)).collect();
    let contacts: Vec<usize> = truths.iter().map(|t| t.contacts).collect();
    println!("steps with contacts of the hand: {contacts:?}");
    assert!(contacts.iter().enumerate().all(|(lane, n)| lane == LOST.0 || *n > steps() / 20));
    // The failed lane is restored when it is refilled.
    assert!(truths[LOST.0].last.iter().all(|x| x.is_finite()));
    let mut ran = 0;
    for instructions in all_instructions() {
        for lanes in LANES {
            let mut batch = Batch::new(model.clone(), lanes, instructions).unwrap();
            let name = format!("{instructions:?}").split('(').next().unwrap().to_owned();
            together(&name, &robot, &mut batch, &groups, &truths);
            ran += lanes * steps();
        }
    }
    println!("{ran} control steps in lanes");
    assert!(ran >= 100_000 || Batch::instructions().count() < 3);
}

/// A step of an arm that pushes balls over the ground: every so often it begins again, and its motors get other speeds.
fn push<W>(world: &mut W, slides: &[JointId], stream: &mut Stream, step: usize)
where
    W: Arrange + Actuated + Handles<Joint = JointId, Actuator = ActuatorId> + ?Sized,
{
    if step.is_multiple_of(60) {
        world.clear();
        world.place_joint(JointId(0), stream.range(-1.3, 1.3), 0.0);
        world.place_joint(JointId(1), if stream.below(2) == 0 { 2.0 } else { -2.0 }, 0.0);
        for joint in slides {
            // Slow and fast: some rest at once, some slide on.
            world.place_joint(*joint, 0.0, stream.range(-0.5, 0.5));
        }
        world.finish_placement();
    }
    if step.is_multiple_of(12) {
        for motor in 0..2 {
            world.command(ActuatorId(motor), [stream.range(-4.0, 4.0).clamp(-1.0, 1.0), 0.0]);
        }
    }
}

/// Grounds, too, are the same in a lane and alone: balls that slide, come to rest, are pushed and push each other. So are
/// springs and dry friction of joints, in halved steps.
#[test]
fn sliding_balls_have_the_bits_of_the_world_alone() {
    for (turns, rubs) in [(false, false), (true, false), (true, true), (false, true)] {
        let mut robot = sliding::arm(turns);
        let mut soft = 0;
        let impedance = Some(Impedance { surface: 0.2, deep: 0.9, width: 0.003, midpoint: 0.4, power: 2 });
        if rubs {
            for segment in &mut robot.segments {
                segment.joint = segment.joint.clone().with_spring(0.2, 0.3).with_friction(0.05);
                if segment.joint.range.iter().any(|end| end.is_finite()) {
                    segment.joint.stop = Some(Stop { stiffness: 20.0, damping: 0.5, inertia: 0.01, impedance });
                    soft += 1;
                }
            }
        }
        assert!(!rubs || soft > 0);
        for pair in robot.pairs.iter_mut().filter(|_| rubs) {
            pair.soft =
                Some(SoftContact { inertia: 0.1, friction: [10.0, 0.1], margin: 0.002, is_pyramid: !turns, impedance });
        }
        let path_error = rubs.then_some(1e-4);
        let model = model(&robot, Options { time_step: 0.1, substeps: 5, path_error, ..Options::default() });
        let slides: Vec<JointId> = robot
            .joints()
            .filter(|joint| robot.segments[joint.index()].joint.kind == farsa_body::robot::JointKind::Prismatic)
            .collect();
        let of = |lane: usize| Stream::new(21, Domain::General, lane as u32, 0, 0);
        let mut touches = 0;
        let truths: Vec<Vec<Digest>> = (0..WORLDS)
            .map(|lane| {
                let (mut world, mut stream) = (World::new(model.clone()), of(lane));
                let mut step = |t: usize| {
                    push(&mut world, &slides, &mut stream, t);
                    world.step();
                    touches += (0..world.pairs()).filter(|p| world.touches(PairId(*p as u16))).count();
                    digest(world.state())
                };
                (0..300).map(&mut step).collect()
            })
            .collect();
        // Pyramids do not act before the surfaces overlap, and the balls bounce off.
        let least = if rubs && !turns { 20 } else { 150 };
        assert!(touches > least, "{touches} touches");
        for level in all_instructions() {
            for lanes in LANES {
                let mut batch = Batch::new(model.clone(), lanes, level).unwrap();
                let mut streams: Vec<Stream> = (0..lanes).map(of).collect();
                let mut own = vec![0.0; model.state_len()];
                for t in 0..300 {
                    for (lane, stream) in streams.iter_mut().enumerate() {
                        push(&mut batch.lane(lane), &slides, stream, t);
                    }
                    batch.step();
                    for (lane, truth) in truths.iter().enumerate().take(lanes) {
                        batch.lane(lane).save(&mut own);
                        assert!(digest(&own) == truth[t], "{level:?}: lane {lane} of {lanes} differs at step {t}");
                    }
                }
            }
        }
    }
}

/// A small box over the edge of a large one, with friction against rolling.
fn box_on_an_edge() -> (Robot, BodyId) {
    let mut robot = Robot::new("boxes");
    let half = [0.05; 3];
    let start = Joint::floating(Pose::at([0.0, 0.0, 2.0]));
    let small = robot.add_segment(Segment::new("small", None, start, MassProperties::cuboid(0.1, half)));
    let skin = Collider::new("small", Some(small), Shape::Box { half }, Pose::identity());
    let block = Collider::new("block", None, Shape::Box { half: [0.5; 3] }, Pose::identity());
    let pair = [skin, block].map(|collider| robot.add_collider(collider));
    robot.add_pair(pair, Surface { friction: 0.5, rolling_friction: 0.01, stiffness: 1e4, damping: 30.0 });
    (robot, small)
}

/// A box that is moved away from an edge, without [`Arrange::clear`], has no memory of the edge, whether a neighbor
/// still leans on that edge or not.
#[test]
fn a_box_moved_off_an_edge_forgets_how_it_rolled_there() {
    let (robot, small) = box_on_an_edge();
    let model = model(&robot, Options { time_step: 0.0025, substeps: 1, ..Options::default() });
    // Face to edge, an eighth of a turn about y, 1 mm deep, spinning and pressed against the edge.
    let (sine, cosine) = sin_cos(core::f32::consts::FRAC_PI_8);
    let out = 0.5 + 0.049 * core::f32::consts::FRAC_1_SQRT_2;
    let leaning = Pose { position: [out, 0.0, out], rotation: [0.0, sine, 0.0, cosine] };
    let spinning = Twist { linear: [-0.3, 0.0, -0.3], angular: [0.3, 0.5, 0.2] };
    // 3 mm over the top of the large box, far from its edges, but near enough to look at the pair.
    let moved = Pose::at([0.0, 0.0, 0.553]);
    let mut world = World::new(model.clone());
    world.place_body(small, leaning, spinning);
    world.finish_placement();
    world.step();
    // Three words for each of the pair's 13 points, behind all others.
    let rolling = |state: &[f32]| state[state.len() - 3 * 13..].to_vec();
    assert!(rolling(world.state()).iter().any(|x| *x != 0.0), "nothing rolls on the edge");
    world.place_body(small, moved, Twist::default());
    world.finish_placement();
    world.step();
    assert!(rolling(world.state()).iter().all(|x| *x == 0.0), "rolling impulses left: {:?}", rolling(world.state()));
    for level in all_instructions() {
        for lanes in LANES {
            let mut batch = Batch::new(model.clone(), lanes, level).unwrap();
            for lane in 0..lanes {
                let mut lane = batch.lane(lane);
                lane.place_body(small, leaning, spinning);
                lane.finish_placement();
            }
            batch.step();
            // The even lanes go, the odd ones stay at the edge.
            for lane in (0..lanes).step_by(2) {
                let mut lane = batch.lane(lane);
                lane.place_body(small, moved, Twist::default());
                lane.finish_placement();
            }
            batch.step();
            let mut own = vec![0.0; model.state_len()];
            for lane in (0..lanes).step_by(2) {
                batch.lane(lane).save(&mut own);
                assert!(digest(&own) == digest(world.state()), "{level:?}: lane {lane} of {lanes} differs");
            }
        }
    }
}

#[test]
fn a_number_of_lanes_that_there_is_not_is_refused() {
    let model = model(&scene(), Options::default());
    for (lanes, nearest) in [(0, 8), (1, 8), (9, 8), (13, 16), (64, 16)] {
        let error = Batch::new(model.clone(), lanes, Instructions::baseline()).unwrap_err();
        assert_eq!(error, ModelError::Lanes { lanes, nearest });
    }
}

/// One lane of a batch that is stepped with the lane, as a world for the conformance checks.
struct Alone {
    batch: RefCell<Batch>,
    lane: usize,
}

impl Alone {
    fn new(model: &Model<f32>, lane: usize) -> Self {
        Self { batch: RefCell::new(Batch::new(model.clone(), LANES[0], Instructions::detect()).unwrap()), lane }
    }
    fn with<T>(&self, ask: impl FnOnce(&mut Lane<'_>) -> T) -> T {
        ask(&mut self.batch.borrow_mut().lane(self.lane))
    }
}

impl Handles for Alone {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}

impl farsa_body::ports::World for Alone {
    fn step(&mut self) {
        self.batch.get_mut().step();
    }
    fn time_step(&self) -> f32 {
        0.01
    }
}

impl Kinematics for Alone {
    fn pose(&self, body: BodyId) -> Pose {
        self.with(|lane| lane.pose(body))
    }
    fn velocity(&self, body: BodyId) -> Twist {
        self.with(|lane| lane.velocity(body))
    }
}

impl Joints for Alone {
    fn position(&self, joint: JointId) -> f32 {
        self.with(|lane| lane.position(joint))
    }
    fn speed(&self, joint: JointId) -> f32 {
        self.with(|lane| lane.speed(joint))
    }
}

impl Actuated for Alone {
    fn command(&mut self, actuator: ActuatorId, value: [f32; 2]) {
        self.with(|lane| lane.command(actuator, value));
    }
}

impl Contacts for Alone {
    fn pairs(&self) -> usize {
        self.with(|lane| lane.pairs())
    }
    fn pair_bodies(&self, pair: PairId) -> [Option<BodyId>; 2] {
        self.with(|lane| lane.pair_bodies(pair))
    }
    fn pair_contact(&self, pair: PairId) -> PairContact {
        self.with(|lane| lane.pair_contact(pair))
    }
    fn touches(&self, pair: PairId) -> bool {
        self.with(|lane| lane.touches(pair))
    }
}

impl Rays for Alone {
    fn cast(&self, origin: [f32; 3], direction: [f32; 3], range: f32) -> Option<Hit<BodyId>> {
        self.with(|lane| lane.cast(origin, direction, range))
    }
}

impl Snapshot for Alone {
    fn snapshot_len(&self) -> usize {
        self.with(|lane| lane.snapshot_len())
    }
    fn save(&self, out: &mut [f32]) {
        self.with(|lane| lane.save(out));
    }
    fn restore(&mut self, from: &[f32]) {
        self.with(|lane| lane.restore(from));
    }
}

impl Arrange for Alone {
    fn clear(&mut self) {
        self.with(|lane| lane.clear());
    }
    fn place_joint(&mut self, joint: JointId, position: f32, speed: f32) {
        self.with(|lane| lane.place_joint(joint, position, speed));
    }
    fn place_body(&mut self, body: BodyId, pose: Pose, twist: Twist) {
        self.with(|lane| lane.place_body(body, pose, twist));
    }
    fn finish_placement(&mut self) {
        self.with(|lane| lane.finish_placement());
    }
}

#[test]
fn a_lane_conforms() {
    let robot = scene();
    let model = model(&robot, Options::default());
    let probe = Probe::for_robot(&robot);
    let make = || {
        let mut world = Alone::new(&model, 5);
        for (j, degrees) in common::POSES[0].into_iter().enumerate() {
            world.place_joint(JointId(j as u16), degrees.to_radians() as f32, 0.0);
        }
        world.finish_placement();
        world
    };
    assert_eq!(check_world(make, &probe), Ok(()));
    assert_eq!(check_rays(&make(), &probe.bodies, &[[0.1, -0.3, 0.3], [0.3, 0.0, 0.1]], 1.0), Ok(()));
    assert_eq!(check_arrange(|| Alone::new(&model, 7), &probe), Ok(()));
    let resting = || {
        let mut world = make();
        (0..10).for_each(|_| world.step());
        world
    };
    channels_conform(&robot, resting);
}

#[test]
fn a_cloned_batch_goes_on_with_the_same_bits() {
    let robot = scene();
    let mut batch = Batch::new(model(&robot, Options::default()), 8, Instructions::detect()).unwrap();
    for _ in 0..20 {
        batch.step();
    }
    let mut copy = batch.clone();
    for _ in 0..20 {
        batch.step();
        copy.step();
    }
    let [original, copy] = [&mut batch, &mut copy].map(|batch| {
        let mut words = vec![0.0; batch.model().state_len()];
        batch.lane(3).save(&mut words);
        words.into_iter().map(f32::to_bits).collect::<Vec<_>>()
    });
    assert_eq!(original, copy);
}
