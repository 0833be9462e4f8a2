//! A lane of a batch of planar worlds is the world alone, bit for bit, at every instruction set of this machine.
#![cfg(feature = "lanes")]

use crate::channels::{every_motor, every_sensor};
use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, Hit, JointId, Joints, Kinematics, Lamp, NearbySurface,
    PairContact, PairId, Planar, PlanarHit, Rays, Sight, Snapshot, World as _,
};
use farsa_body::robots::MobileRobot;
use farsa_body::testing::{Probe, check_arrange, check_motor, check_planar, check_rays, check_sensor, check_world};
use farsa_body::{Pose, Twist};
use farsa_num::{Digest, Domain, Instructions, Stream};
use farsa_physics::arena::{
    Area, Arena, ArenaError, Batch, CollisionRule, Convex, Cylinder, FreePlace, Lane, Wall, World,
};

/// Control steps of every lane. Ten times as many with `FARSA_LONG=1`.
fn steps() -> usize {
    if std::env::var_os("FARSA_LONG").is_some() { 1_000_000 } else { 100_000 }
}

const WORLDS: usize = 16;
/// Lanes are refilled every so often, but not together.
const EPISODE_STEPS: usize = 700;
/// The lane whose commands are no numbers.
const LOST: usize = 3;

fn khepera() -> Arena {
    let mut arena = Arena::walled(0.4, 0.4);
    arena.add_cylinder(Cylinder::new([0.3, 0.3], 0.0125));
    arena.add_robot(MobileRobot::khepera(), [0.1, 0.2], 0.0);
    arena
}

/// Three robots, two of which can hold, in a small square.
fn three(collisions: CollisionRule) -> Arena {
    let mut arena = Arena { collisions, ..Arena::walled(0.7, 0.7) };
    arena.add_wall(Wall::segment([0.3, 0.3], [0.4, 0.35], 0.02));
    arena.add_cylinder(Cylinder::new([0.6, 0.6], 0.02));
    arena.add_robot(MobileRobot::e_puck(), [0.1, 0.6], 0.0);
    arena.add_robot(MobileRobot::marxbot(), [0.2, 0.2], 0.0);
    arena.add_robot(MobileRobot::marxbot(), [0.55, 0.3], 0.0);
    arena
}

/// Builds the world with convex obstacles, a hull among them where parry is enabled.
fn obstructed(collisions: CollisionRule) -> Arena {
    let mut arena = three(collisions);
    let hexagon: [[f64; 2]; 6] = core::array::from_fn(|i| {
        let (y, x) = farsa_num::sin_cos(std::f64::consts::TAU * i as f64 / 6.0);
        [0.04 * x, 0.02 * y]
    });
    arena.add_convex(Convex::prism(&hexagon, 0.1).placed([0.38, 0.58], 0.7));
    arena.add_convex(Convex::prism(&[[0.7, 0.0], [0.7, 0.1], [0.6, 0.0]], 0.1));
    if cfg!(feature = "parry") {
        let points = [[0.0, 0.0, 0.0], [0.05, 0.0, 0.0], [0.0, 0.05, 0.0], [0.01, 0.01, 0.1], [0.02, 0.02, 0.05]];
        arena.add_convex(Convex::hull(&points).placed([0.03, 0.4], -0.3));
    }
    arena
}

/// The actions in one lane before each step, equal alone and in a batch.
struct Script {
    lane: usize,
    stream: Stream,
    robots: Vec<(MobileRobot, usize)>,
    holds: bool,
}

impl Script {
    fn new(arena: &Arena, lane: usize, holds: bool) -> Self {
        let mut first = 0;
        let robots = arena.robots.iter().map(|placed| {
            first += placed.robot.actuators();
            (placed.robot.clone(), first - placed.robot.actuators())
        });
        let robots = robots.collect();
        Self { lane, stream: Stream::new(9, Domain::Motor, lane as u32, 0, 0), robots, holds }
    }

    fn act<W>(&mut self, world: &mut W, t: usize)
    where
        W: Planar<Body = BodyId> + Arrange<Joint = JointId> + Actuated<Actuator = ActuatorId>,
    {
        let shifted = t + 37 * self.lane;
        if t > 0 && shifted.is_multiple_of(EPISODE_STEPS) {
            world.clear();
            let mut placed: Vec<(BodyId, f32)> = Vec::new();
            // From the largest on, or there may be no room left.
            for i in (0..self.robots.len()).rev() {
                let size = if self.robots.len() == 1 { 0.4 } else { 0.7 };
                let radius = self.robots[i].0.radius as f32;
                let free = FreePlace { walls: 0.001, ..FreePlace::new([[0.0; 2], [size; 2]], radius) };
                if let Ok(at) = free.clear_of(&placed).find(world, &mut self.stream) {
                    let heading = self.stream.range(-3.0, 3.0);
                    world.place_body(BodyId(i as u16), Pose::planar(at, heading), Twist::default());
                    world.finish_placement();
                }
                placed.push((BodyId(i as u16), 0.001));
            }
        }
        if shifted.is_multiple_of(11) {
            for (robot, first) in &self.robots {
                for k in 0..robot.actuators() {
                    let most = if k < 2 { robot.max_wheel_speed as f32 } else { 1.0 };
                    let value = self.stream.range(-0.5 * most, most);
                    let device = robot.attachment.is_some() && k + 1 == robot.actuators();
                    let value = if device && !self.holds { 0.0 } else { value };
                    let value = if self.lane == LOST && t > 1000 { f32::NAN } else { value };
                    world.command(ActuatorId((first + k) as u16), [value, 0.0]);
                }
            }
        }
    }
}

fn digest(world: &impl Snapshot, words: &mut [f32]) -> Digest {
    world.save(words);
    let mut digest = Digest::new();
    digest.add_f32s(words);
    digest
}

fn equal(name: &str, arena: &Arena, steps: usize, holds: bool) {
    let mut truths = Vec::new();
    let (mut touches, mut held) = (0, 0);
    for lane in 0..WORLDS {
        let mut world = World::new(arena).unwrap();
        let mut script = Script::new(arena, lane, holds);
        let mut words = vec![0.0; world.snapshot_len()];
        let mut digests = Vec::new();
        for t in 0..steps {
            script.act(&mut world, t);
            world.step();
            digests.push(digest(&world, &mut words));
            touches += (0..world.pairs()).filter(|pair| world.touches(PairId(*pair as u16))).count();
            held += (0..world.robots()).filter(|r| world.attached(BodyId(*r as u16)).is_some()).count();
        }
        let mut rings = [[0.0_f32; 24]; 3];
        (0..world.robots()).for_each(|robot| world.infrared(robot, &mut rings[robot]));
        truths.push((digests, words, rings));
    }
    println!("{name}: {touches} touches, {held} held in {WORLDS} x {steps} steps");
    assert!(touches > steps / 2 && (held > 0) == holds);
    for instructions in Batch::instructions().chain([Instructions::Fallback]) {
        for lanes in [8, 16] {
            let mut batch = Batch::new(arena, lanes, instructions).unwrap();
            let mut scripts: Vec<Script> = (0..lanes).map(|lane| Script::new(arena, lane, holds)).collect();
            let mut own = truths[0].1.clone();
            for t in 0..steps {
                for (lane, script) in scripts.iter_mut().enumerate() {
                    script.act(&mut batch.lane(lane), t);
                }
                batch.step();
                for (lane, truth) in truths.iter().enumerate().take(lanes) {
                    let same = digest(&batch.lane(lane), &mut own) == truth.0[t];
                    assert!(same, "{name}, {lanes} lanes, {instructions:?}: lane {lane} differs after step {t}");
                }
            }
            for (robot, placed) in arena.robots.iter().enumerate() {
                let sensors = placed.robot.infrared.angles.len();
                let mut ring = vec![f32::NAN; sensors * lanes];
                batch.infrared(robot, &mut ring);
                for (lane, truth) in truths.iter().enumerate().take(lanes) {
                    for k in 0..sensors {
                        assert_eq!(
                            ring[k * lanes + lane].to_bits(),
                            truth.2[robot][k].to_bits(),
                            "{name} {instructions:?}"
                        );
                    }
                }
            }
            println!("{name}: {lanes} lanes of {instructions:?}, equal bits");
        }
    }
}

#[test]
fn a_khepera_in_a_lane_is_the_khepera_alone() {
    equal("one khepera", &khepera(), steps(), false);
}

#[test]
fn robots_that_meet_and_hold_in_a_lane_are_those_alone() {
    equal("undone", &three(CollisionRule::Revert), steps() / 10, false);
    equal("circles", &three(CollisionRule::Circles), steps() / 10, false);
    equal("holding", &three(CollisionRule::Revert), steps() / 20, true);
}

#[test]
fn robots_among_obstacles_in_a_lane_are_those_alone() {
    equal("undone, obstacles", &obstructed(CollisionRule::Revert), steps() / 10, false);
    equal("circles, obstacles", &obstructed(CollisionRule::Circles), steps() / 10, false);
    equal("holding, obstacles", &obstructed(CollisionRule::Revert), steps() / 20, true);
}

#[test]
fn readings_of_the_ring_are_the_models() {
    use farsa_body::sensors::infrared::InfraredModel;
    let arena = khepera();
    let mut world = World::new(&arena).unwrap();
    let mut stream = Stream::new(5, Domain::Start, 0, 0, 0);
    let mut seen = 0;
    for _ in 0..2000 {
        let at = [stream.range(0.036, 0.364), stream.range(0.036, 0.364)];
        let pose = Pose::planar(at, stream.range(-3.0, 3.0));
        if (at[0] - 0.3).hypot(at[1] - 0.3) < 0.05 {
            continue;
        }
        world.place_body(BodyId(0), pose, Twist::default());
        world.finish_placement();
        let mut ring = [0.0; 8];
        world.infrared(0, &mut ring);
        for (k, angle) in arena.robots[0].robot.infrared.angles.iter().enumerate() {
            let (sine, cosine) = farsa_num::sin_cos(pose.heading() + *angle as f32);
            let mut sum = 0.0;
            world.query_near(at, 0.1, &mut |near| {
                if near.body != Some(BodyId(0)) {
                    let [x, y] = [near.point[0] - at[0], near.point[1] - at[1]];
                    let toward = (x * cosine + y * sine) / (x * x + y * y).sqrt();
                    sum += InfraredModel::for_radius(near.radius).response(near.distance - 0.035, toward);
                }
            });
            assert!((ring[k] - sum.clamp(0.0, 1.0)).abs() < 1e-3, "{k}: {} {sum}", ring[k]);
            seen += usize::from(ring[k] > 0.0);
        }
    }
    assert!(seen > 1000, "{seen}");
}

#[test]
fn a_command_for_all_lanes_is_one_for_each() {
    let arena = khepera();
    let [mut all, mut each] = [(); 2].map(|()| Batch::new(&arena, 8, Instructions::detect()).unwrap());
    let values: Vec<f32> = (0..8).map(|i| i as f32 - 2.0).collect();
    all.command(ActuatorId(1), &values);
    all.command(ActuatorId(2), &values);
    for (lane, value) in values.iter().enumerate() {
        each.lane(lane).command(ActuatorId(1), [*value, 0.0]);
    }
    all.step();
    each.step();
    assert_eq!(format!("{all:?}"), format!("{each:?}"));
    assert_eq!(Batch::new(&arena, 12, Instructions::detect()).err(), Some(ArenaError::Lanes { lanes: 12, nearest: 8 }));
}

/// One lane of a batch as a world. Its neighbors do something else.
struct InLane(std::cell::RefCell<Batch>);

impl InLane {
    const LANE: usize = 5;

    fn with<T>(&self, ask: impl FnOnce(&mut Lane<'_>) -> T) -> T {
        ask(&mut self.0.borrow_mut().lane(Self::LANE))
    }
}

impl Handles for InLane {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}
impl farsa_body::ports::World for InLane {
    fn step(&mut self) {
        let batch = self.0.get_mut();
        batch.lane(2).command(ActuatorId(0), [3.0, 0.0]);
        batch.step();
    }
    fn time_step(&self) -> f32 {
        0.05
    }
}
impl Kinematics for InLane {
    fn pose(&self, body: BodyId) -> Pose {
        self.with(|lane| lane.pose(body))
    }
    fn velocity(&self, body: BodyId) -> Twist {
        self.with(|lane| lane.velocity(body))
    }
}
impl Joints for InLane {
    fn position(&self, joint: JointId) -> f32 {
        self.with(|lane| lane.position(joint))
    }
    fn speed(&self, joint: JointId) -> f32 {
        self.with(|lane| lane.speed(joint))
    }
}
impl Actuated for InLane {
    fn command(&mut self, actuator: ActuatorId, value: [f32; 2]) {
        self.with(|lane| lane.command(actuator, value));
    }
}
impl Contacts for InLane {
    fn pairs(&self) -> usize {
        self.with(|lane| lane.pairs())
    }
    fn pair_bodies(&self, pair: PairId) -> [Option<BodyId>; 2] {
        self.with(|lane| lane.pair_bodies(pair))
    }
    fn pair_contact(&self, pair: PairId) -> PairContact {
        self.with(|lane| lane.pair_contact(pair))
    }
}
impl Rays for InLane {
    fn cast(&self, origin: [f32; 3], direction: [f32; 3], range: f32) -> Option<Hit<BodyId>> {
        self.with(|lane| lane.cast(origin, direction, range))
    }
}
impl Sight for InLane {
    fn query_near(&self, from: [f32; 2], range: f32, tell: &mut dyn FnMut(NearbySurface<BodyId>)) {
        // The callback may ask the lane again.
        let mut told = Vec::new();
        self.with(|lane| lane.query_near(from, range, &mut |near| told.push(near)));
        told.into_iter().for_each(tell);
    }
    fn cast_planar(
        &self,
        from: [f32; 2],
        direction: [f32; 2],
        range: f32,
        but: Option<BodyId>,
    ) -> Option<PlanarHit<BodyId>> {
        self.with(|lane| lane.cast_planar(from, direction, range, but))
    }
}

impl Planar for InLane {
    fn ground(&self, at: [f32; 2]) -> [f32; 3] {
        self.with(|lane| lane.ground(at))
    }
    fn lamps(&self, tell: &mut dyn FnMut(Lamp<BodyId>)) {
        let mut told = Vec::new();
        self.with(|lane| lane.lamps(&mut |lamp| told.push(lamp)));
        told.into_iter().for_each(tell);
    }
    fn attached(&self, robot: BodyId) -> Option<BodyId> {
        self.with(|lane| lane.attached(robot))
    }
}
impl Snapshot for InLane {
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
impl Arrange for InLane {
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
    let arena = three(CollisionRule::Revert);
    let bodies: Vec<BodyId> = (0..4).map(BodyId).collect();
    let motors = (0..3).flat_map(|robot| arena.parts(robot).motors.map(|motor| (motor, [[-6.0, 0.0], [6.0, 0.0]])));
    let probe = Probe {
        planar: bodies.clone(),
        joints: (0..6).map(|joint| (JointId(joint), [-3.0, 3.0])).collect(),
        actuators: motors.collect(),
        bodies,
        ..Probe::numbered(0, [[0.0; 2]; 2])
    };
    let make = || InLane(std::cell::RefCell::new(Batch::new(&arena, 8, Instructions::detect()).unwrap()));
    assert_eq!(check_world(make, &probe), Ok(()));
    assert_eq!(check_arrange(make, &probe), Ok(()));
    assert_eq!(check_rays(&make(), &probe.bodies, &[[0.1, 0.4, 0.05]], 1.0), Ok(()));
}

/// Something for every sensor: colors, a lamp, and a neighbor to hold, right ahead of the robot that senses.
fn lively() -> Arena {
    let mut arena = obstructed(CollisionRule::Revert);
    let reach = 2.0 * arena.robots[1].robot.radius + 0.005;
    arena.robots[2].at = [arena.robots[1].at[0] + reach, arena.robots[1].at[1]];
    arena.add_cylinder(Cylinder { lamp: 2.0, color: [1.0, 0.0, 0.0], ..Cylinder::new([0.55, 0.1], 0.02) });
    arena.add_area(Area::circle([0.2, 0.2], 0.15, [0.2, 0.5, 0.9]));
    arena
}

/// Commands of a step to a lane and to the world alone: wheels at random, LEDs and signals, devices that hold and let go.
fn stir(
    worlds: [&mut dyn Actuated<Body = BodyId, Joint = JointId, Actuator = ActuatorId>; 2],
    arena: &Arena,
    t: usize,
) {
    let mut stream = Stream::new(t as u64, Domain::Motor, 0, 0, 0);
    let mut commands = Vec::new();
    for (robot, placed) in arena.robots.iter().enumerate() {
        let parts = arena.parts(robot);
        let most = placed.robot.max_wheel_speed as f32;
        commands.extend(parts.motors.map(|motor| (motor, stream.range(-0.2 * most, most))));
        commands.extend(parts.leds.into_iter().flatten().chain(parts.signal).map(|x| (x, stream.uniform())));
        commands.extend(parts.attachment.map(|device| (device, if t % 30 < 15 { 1.0 } else { 0.0 })));
    }
    for world in worlds {
        for (actuator, value) in &commands {
            world.command(*actuator, [*value, 0.0]);
        }
    }
}

/// Steps in which sensors are looked at.
const STIRS: usize = 60;

#[test]
fn sensors_and_motors_conform_in_a_lane() {
    let arena = lively();
    let (robot, parts) = (&arena.robots[1].robot, arena.parts(1));
    for instructions in Batch::instructions().chain([Instructions::Fallback]) {
        for lanes in [8, 16] {
            let make = || InLane(std::cell::RefCell::new(Batch::new(&arena, lanes, instructions).unwrap()));
            let (mut lane, mut alone) = (make(), World::new(&arena).unwrap());
            let mut here = every_sensor::<InLane>(robot, &parts);
            let mut there = every_sensor::<World>(robot, &parts);
            let mut awake = vec![false; here.len()];
            for t in 0..STIRS {
                stir([&mut lane, &mut alone], &arena, t);
                alone.step();
                lane.step();
                for (((name, _, here), (_, _, there)), awake) in here.iter_mut().zip(&mut there).zip(&mut awake) {
                    let what = format!("{name}, {lanes} lanes of {instructions:?}, step {t}");
                    let [mut a, mut b] = [(); 2].map(|()| vec![f32::NAN; here.channels()]);
                    here.read(&lane, &mut a);
                    there.read(&alone, &mut b);
                    assert!(a.iter().zip(&b).all(|(a, b)| a.to_bits() == b.to_bits()), "{what}: {a:?} {b:?}");
                    *awake |= a.iter().any(|x| *x != 0.0);
                    if t % 10 == 9 {
                        assert_eq!(check_sensor(here.as_mut(), &lane), Ok(()), "{what}");
                    }
                }
            }
            assert_eq!(awake, vec![true; here.len()], "{lanes} lanes of {instructions:?}");
            let bodies: Vec<BodyId> = (0..5).map(BodyId).collect();
            for range in [0.2, 2.0] {
                let places = [[0.1, 0.4], [0.45, 0.45], [0.3, 0.1], [0.6, 0.5]];
                assert_eq!(check_planar(&lane, &bodies, &places, range), Ok(()), "{lanes} lanes of {instructions:?}");
            }
            for (i, motor) in every_motor::<InLane>(robot, &parts).iter_mut().enumerate() {
                assert_eq!(check_motor(motor.as_mut(), make), Ok(()), "motor {i}, {lanes} lanes of {instructions:?}");
            }
        }
    }
}
