//! Random commands to all sixty joints: nothing explodes, nothing passes through anything that it may touch.

use farsa_body::ports::{Contacts as _, Joints as _, PairId, World as _};
use farsa_body::robot::Robot;
use farsa_body::robots::{Chain, Icub, JointControl};
use farsa_physics::articulated::{Options, World};

use crate::common::{half_thickness, model};
use crate::random::{Babble, SPEED, start};

const EPISODE_STEPS: usize = 600;

/// Which colliders a pair is of.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// An arm with waist, chest or head.
    Trunk,
    /// One arm with the other.
    Arms,
    /// Palm and phalanges of a hand.
    Hand,
}

impl Kind {
    const ALL: [Self; 3] = [Self::Trunk, Self::Arms, Self::Hand];

    fn of(robot: &Robot, pair: usize) -> Self {
        let names = robot.pairs[pair].colliders.map(|i| robot.colliders[i].name.as_str());
        match names.map(|name| name.get(..2)) {
            [Some("l_"), Some("l_")] | [Some("r_"), Some("r_")] => Self::Hand,
            [Some("l_"), Some("r_")] => Self::Arms,
            _ => Self::Trunk,
        }
    }
}

/// A largest value and where it was seen.
#[derive(Clone, Debug)]
struct Worst {
    value: f64,
    at: String,
}

impl Worst {
    fn new() -> Self {
        Self { value: f64::NEG_INFINITY, at: String::new() }
    }

    fn see(&mut self, value: f64, at: impl FnOnce() -> String) {
        // A NaN is the worst of all.
        if value.is_nan() || value > self.value {
            *self = Self { value, at: at() };
        }
    }
}

#[derive(Clone, Debug)]
struct Figures {
    /// Steps in which a pair of each kind touches.
    touching: [usize; 3],
    /// The speeds of torso, neck and arms, and of hands [rad/s].
    speed: [Worst; 2],
    /// The overshoot of a joint's limits [rad].
    beyond: [Worst; 2],
    /// The depth of the pairs of each kind [m].
    depth: [Worst; 3],
    /// Depth of a pair whose force is below 20 N [m].
    gentle: Worst,
    /// Depth as a share of half the thinner body, of each kind.
    share: [Worst; 3],
}

impl Figures {
    fn new() -> Self {
        Self {
            touching: [0; 3],
            speed: [(); 2].map(|()| Worst::new()),
            beyond: [(); 2].map(|()| Worst::new()),
            depth: [(); 3].map(|()| Worst::new()),
            gentle: Worst::new(),
            share: [(); 3].map(|()| Worst::new()),
        }
    }

    fn check(&mut self, robot: &Robot, pairs: &[(Kind, f64)], world: &World<f32>, at: &str) {
        assert!(world.is_finite(), "not finite: {at}");
        for joint in robot.joints() {
            let name = &robot.segments[joint.index()].joint.name;
            let hand = usize::from(joint.index() >= Chain::LeftHand.bodies().start);
            self.speed[hand].see(f64::from(world.speed(joint).abs()), || format!("{name} {at}"));
            let [low, high] = robot.segments[joint.index()].joint.range;
            let q = f64::from(world.position(joint));
            self.beyond[hand].see((low - q).max(q - high), || format!("{name} {at}"));
        }
        let mut touching = [false; 3];
        for (p, (kind, thin)) in pairs.iter().enumerate() {
            let contact = world.pair_contact(PairId(p as u16));
            if contact.points == 0 {
                continue;
            }
            let kind = *kind as usize;
            touching[kind] = true;
            let here = || {
                let names = robot.pairs[p].colliders.map(|i| robot.colliders[i].name.as_str());
                format!("{} {:.1} N {at}", names.join(" - "), contact.normal_force)
            };
            let depth = f64::from(contact.depth);
            self.depth[kind].see(depth, here);
            self.share[kind].see(depth / thin, here);
            if contact.normal_force < 20.0 {
                self.gentle.see(depth, here);
            }
        }
        for (sum, touches) in self.touching.iter_mut().zip(touching) {
            *sum += usize::from(touches);
        }
    }

    fn print(&self, name: &str, steps: usize) {
        println!("{name}, {steps} control steps");
        let line = |name: &str, w: &Worst, unit: &str, scale: f64| {
            println!("  {name}: {:.4} {unit} ({})", scale * w.value, w.at);
        };
        line("speed of torso, neck, arms", &self.speed[0], "rad/s", 1.0);
        line("speed of hands", &self.speed[1], "rad/s", 1.0);
        line("beyond a limit of torso, neck, arms", &self.beyond[0], "rad", 1.0);
        line("beyond a limit of hands", &self.beyond[1], "rad", 1.0);
        line("depth below 20 N", &self.gentle, "mm", 1e3);
        for kind in Kind::ALL {
            let i = kind as usize;
            println!("  {kind:?} touches in {} steps", self.touching[i]);
            line("    depth", &self.depth[i], "mm", 1e3);
            line("    share of half the thinner body", &self.share[i], "", 1.0);
        }
    }
}

fn babble(control: JointControl, commanded: f64, steps: usize) -> Figures {
    let icub = Icub { control, ..Icub::default() };
    let robot = icub.robot().unwrap();
    assert_eq!(robot.actuators.len(), 60);
    let half = |collider: usize| half_thickness(robot.colliders[collider].shape);
    let pairs: Vec<_> = robot
        .pairs
        .iter()
        .enumerate()
        .map(|(p, pair)| (Kind::of(&robot, p), half(pair.colliders[0]).min(half(pair.colliders[1]))))
        .collect();
    let mut world = World::new(model::<f32>(&robot, Options::default()));
    let mut figures = Figures::new();
    for episode in 0..steps.div_ceil(EPISODE_STEPS) {
        start(&icub, &robot, &mut world, episode as u32, 0.1);
        let mut babble = Babble::new(&robot, 1, episode as u32, commanded);
        for step in 1..=EPISODE_STEPS.min(steps - episode * EPISODE_STEPS) {
            babble.drive(&mut world);
            world.step();
            figures.check(&robot, &pairs, &world, &format!("episode {episode} step {step}"));
        }
    }
    figures
}

/// The bounds for hands.
struct Bounds {
    /// [rad/s]
    speed: f64,
    /// Beyond the limits of their joints [rad].
    beyond: f64,
    /// Depth of a pair whose force is below 20 N [m].
    gentle: f64,
    /// Depth as a share of half the thinner body.
    share: f64,
}

/// The bounds for the arm and hand, which the other joints keep at any speed.
const BOUNDS: Bounds = Bounds { speed: 100.0, beyond: 0.05, gentle: 2e-3, share: 1.0 };

/// `speed` is the largest that is commanded to velocity motors [rad/s].
fn check_bounds(control: JointControl, speed: f64, bounds: &Bounds) {
    let steps = if is_long() { 1_000_000 } else { 50_000 };
    let f = babble(control, speed, steps);
    f.print(
        &if control == JointControl::Velocity { format!("speeds up to {speed} rad/s") } else { "positions".into() },
        steps,
    );
    assert!(f.touching.iter().all(|touching| *touching > steps / 1000), "{:?}", f.touching);
    assert!(f.speed[0].value < BOUNDS.speed && f.speed[1].value < bounds.speed, "{:?}", f.speed);
    assert!(f.beyond[0].value < BOUNDS.beyond && f.beyond[1].value < bounds.beyond, "{:?}", f.beyond);
    assert!(f.gentle.value < bounds.gentle, "{:?}", f.gentle);
    for (kind, share) in Kind::ALL.into_iter().zip(&f.share) {
        let most = if kind == Kind::Hand { bounds.share } else { BOUNDS.share };
        assert!(share.value < most, "{kind:?} {share:?}");
    }
}

/// A million control steps in place of fifty thousand.
fn is_long() -> bool {
    std::env::var_os("FARSA_LONG").is_some()
}

#[test]
fn random_positions_of_all_joints_break_nothing() {
    check_bounds(JointControl::Position, SPEED, &BOUNDS);
}

/// Up to the largest speed that `icub-reach` commands.
#[test]
fn random_speeds_of_all_joints_break_nothing() {
    check_bounds(JointControl::Velocity, 1.0, &BOUNDS);
}

/// At four times that speed two arms press fingers between them with a kilonewton and more. In 10^6 steps a tip sank
/// into its own palm by its radius, a third of the palm's thickness. Two fingers then sank by 2.1 mm, joints gave by
/// 0.07 rad, and one reached 113 rad/s.
#[test]
fn fast_arms_press_fingers_no_further_than_that() {
    let crushed = Bounds { speed: 150.0, beyond: 0.1, gentle: 3e-3, share: 1.5 };
    check_bounds(JointControl::Velocity, SPEED, if is_long() { &crushed } else { &BOUNDS });
}
