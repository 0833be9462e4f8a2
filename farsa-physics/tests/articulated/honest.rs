//! Contacts are honest: what one side gains the other loses, nothing gains energy, what is held rests.

use crate::common;
use crate::common::{CLOSED, Wrist, close, ghost, hand_and_sphere, put_in_the_palm, touching, world};
use farsa_body::actuators::{Held, Law, Servo, Torque};
use farsa_body::ports::{Actuated, ActuatorId, Arrange, Contacts, JointId, PairId, World as _};
use farsa_body::robot::{Robot, Surface};
use farsa_body::robots::{ArmAndHand, Tabletop};
use farsa_body::{Pose, Twist};
use farsa_num::{Domain, Stream};
use farsa_physics::articulated::{Options, World};

fn steps(time: f64, h: f64) -> usize {
    (time / h).round() as usize
}

/// The dynamics steps that a control step of 10 ms may be divided into [s].
const STEPS: [f64; 4] = [5e-3, 2.5e-3, 2e-3, 1e-3];

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The hand has closed on the sphere without gravity. Then gravity sets in.
fn held(h: f64) -> World<f64> {
    let arm = ArmAndHand::default();
    let robot = hand_and_sphere(Wrist::Fixed, arm.surface, Some(Law::Servo(arm.servo)));
    let mut weightless = world(&robot, h, 0.0);
    put_in_the_palm(&mut weightless, 0.0005);
    weightless.finish_placement();
    close(&mut weightless, &CLOSED);
    for _ in 0..steps(0.6, h) {
        weightless.step();
    }
    let mut heavy = world(&robot, h, 9.81);
    heavy.state_mut().copy_from_slice(weightless.state());
    heavy.finish_placement();
    heavy
}

#[test]
fn a_held_sphere_rests() {
    for h in STEPS {
        let mut w = held(h);
        let before = w.pose_of(Tabletop::SPHERE).position;
        for _ in 0..steps(1.0, h) {
            w.step();
        }
        let at = w.pose_of(Tabletop::SPHERE).position;
        let n = steps(1.0, h);
        let (mut sum, mut turns) = (0.0, 0);
        let left = Options::default().settled * h;
        let mut last = [0.0; 3];
        for _ in 0..n {
            w.step();
            let v = w.velocity_of(Tabletop::SPHERE).linear;
            sum += v.iter().map(|x| x * x).sum::<f64>();
            turns += (0..3).filter(|&k: &usize| v[k] * last[k] < 0.0 && v[k].abs() > left).count();
            last = v;
        }
        let end = w.pose_of(Tabletop::SPHERE).position;
        let d = |a: [f64; 3], b: [f64; 3]| norm(&[a[0] - b[0], a[1] - b[1], a[2] - b[2]]);
        let touching = touching(&w);
        let rms = (sum / n as f64).sqrt();
        println!(
            "h {h}: settles by {:.3} mm, then {rms:.2e} m/s RMS, moves {:.2e} m in 1 s; {turns} sign changes in {}; {touching} pairs",
            1e3 * d(before, at),
            d(at, end),
            3 * n
        );
        assert!(rms < 1e-3 && touching >= 4);
        assert!(turns < n / 100, "the velocity alternates");
    }
}

/// Linear momentum of everything if positions `q` had the velocities `v` [N s].
fn momentum(probe: &mut World<f64>, q: &[f64], v: &[f64]) -> [f64; 3] {
    let state = probe.state_mut();
    state[..q.len()].copy_from_slice(q);
    state[q.len()..q.len() + v.len()].copy_from_slice(v);
    probe.finish_placement();
    probe.momentum()
}

#[test]
fn impulses_on_sphere_and_hand_are_equal_and_opposite_in_every_step() {
    let arm = ArmAndHand::default();
    let robot = hand_and_sphere(Wrist::Sliding, arm.surface, Some(Law::Servo(arm.servo)));
    let m = 0.05;
    for h in [5e-3, 2e-3, 1e-3] {
        let mut w = world(&robot, h, 9.81);
        let mut free = world(&ghost(&robot), h, 9.81);
        let mut probe = free.clone();
        let shared = w.model().positions() + w.model().dofs() + 2 * robot.actuators.len();
        let (nq, nv) = (w.model().positions(), w.model().dofs());
        put_in_the_palm(&mut w, 0.0);
        common::pose_hand(&mut w, &CLOSED.map(|x| 0.5 * x));
        w.finish_placement();
        let mut stream = common::stream(3, 0);
        let (mut worst, mut words, mut largest, mut contacts) = (0.0_f64, 0.0_f64, 0.0_f64, 0);
        for t in 0..steps(2.0, h) {
            if t == 0 || t % steps(0.25, h) == 0 {
                // Squeezes and lets go at random, but mostly squeezes.
                close(&mut w, &CLOSED.map(|x| (x + 0.3 * (stream.uniform() - 0.4)).clamp(0.0, 1.0)));
            }
            free.state_mut().copy_from_slice(&w.state()[..shared]);
            free.finish_placement();
            free.step();
            let q = w.positions().to_vec();
            w.step();
            let (with, without) = (w.velocities().to_vec(), free.velocities().to_vec());
            let on_sphere = [0, 1, 2].map(|k: usize| m * (with[nv - 3 + k] - without[nv - 3 + k]));
            let (a, b) = (momentum(&mut probe, &q[..nq], &with), momentum(&mut probe, &q[..nq], &without));
            let on_hand = [0, 1, 2].map(|k: usize| a[k] - b[k] - on_sphere[k]);
            let mut of_pairs = [0.0; 3];
            for p in 0..w.pairs() {
                let p = PairId(p as u16);
                let sign = match w.pair_bodies(p) {
                    [Some(Tabletop::SPHERE), _] => 1.0,
                    [_, Some(Tabletop::SPHERE)] => -1.0,
                    _ => continue,
                };
                let c = w.pair_contact(p);
                contacts += usize::from(c.points > 0);
                for k in 0..3 {
                    of_pairs[k] += sign * h * f64::from(c.force[k]);
                }
            }
            let sum = |a: [f64; 3], b: [f64; 3]| norm(&[a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
            worst = worst.max(sum(on_hand, on_sphere));
            // The ports report forces in single precision.
            words = words.max(sum(of_pairs, on_sphere.map(|x| -x)));
            largest = largest.max(norm(&on_sphere));
        }
        println!(
            "h {h}: hand + sphere {:.1e}, sphere - pairs {:.1e} of the largest impulse {largest:.2e} N s; {contacts} contacts",
            worst / largest,
            words / largest
        );
        assert!(contacts > 1000);
        assert!(worst <= 1e-5 * largest && words <= 1e-5 * largest);
    }
}

/// A weightless hand on slides about to close on a sphere, by servos of this damping.
fn closing(h: f64, damping: f64) -> (Robot, World<f64>) {
    let arm = ArmAndHand::default();
    let robot = hand_and_sphere(Wrist::Sliding, arm.surface, Some(Law::Servo(Servo { damping, ..arm.servo })));
    let mut w = world(&robot, h, 0.0);
    put_in_the_palm(&mut w, 0.0);
    common::pose_hand(&mut w, &CLOSED.map(|x| 0.5 * x));
    w.finish_placement();
    close(&mut w, &CLOSED);
    (robot, w)
}

/// The slow servos that the momentum is looked at with, and the experiment's own, ten times as fast.
const DAMPINGS: [f64; 2] = [0.5, 0.04];

/// Largest total momentum while the hand closes, and the largest momentum of the sphere [N s].
fn drift(h: f64, damping: f64) -> (f64, f64, usize) {
    let (_, mut w) = closing(h, damping);
    let nv = w.model().dofs();
    let (mut total, mut exchanged) = (0.0_f64, 0.0_f64);
    for _ in 0..steps(1.0, h) {
        w.step();
        total = total.max(norm(&w.momentum()));
        exchanged = exchanged.max(0.05 * norm(&w.velocities()[nv - 3..]));
    }
    let touching = touching(&w);
    (total, exchanged, touching)
}

#[test]
fn a_closing_hand_and_its_sphere_keep_their_momentum_to_first_order() {
    for damping in DAMPINGS {
        let shares = [0, 1, 2, 3, 4, 5, 6, 7].map(|halvings| {
            let h = 2e-3 / f64::from(1 << halvings);
            let (total, exchanged, touching) = drift(h, damping);
            let share = total / exchanged;
            println!(
                "servo damping {damping}, h {:.2} us: total momentum {total:.2e} of {exchanged:.2e} N s exchanged: {share:.2e}; {touching} pairs",
                1e6 * h
            );
            assert!(touching >= 4);
            share
        });
        let ratios: Vec<f64> = shares.windows(2).map(|pair| pair[0] / pair[1]).collect();
        println!("error by halving the step: {ratios:.3?}");
        // Six halvings from 1 ms on: what is left at any step is the integration's, not the contacts'.
        assert!(ratios[1..].iter().all(|ratio| (1.9..2.1).contains(ratio)), "of first order");
        if damping == DAMPINGS[0] {
            assert!(shares[7] < 1e-4);
        }
    }
}

#[test]
fn only_the_integration_of_positions_moves_the_total_momentum() {
    // With p = A(q) v, dynamics and contacts together owe A(q) (v' - v) = -h A'(q. V) v in every step of any length, A'
    // being the derivative along v. The rest of p' - p is (A(q') - A(q)) v' - h A'(q. V) v: the positions' step.
    for damping in DAMPINGS {
        for h in [5e-3, 2e-3, 1e-3] {
            let (robot, mut w) = closing(h, damping);
            let mut probe = world(&ghost(&robot), h, 0.0);
            // The sphere comes last, and its momentum does not depend on where it is.
            let joints = w.model().dofs() - 6;
            let (mut worst, mut drifted, mut exchanged) = (0.0_f64, 0.0_f64, 0.0_f64);
            for _ in 0..steps(1.0, h) {
                let (q, v) = (w.positions().to_vec(), w.velocities().to_vec());
                w.step();
                let new = w.velocities().to_vec();
                let (old, after) = (momentum(&mut probe, &q, &v), momentum(&mut probe, &q, &new));
                let mut ahead = |time: f64| {
                    let mut q = q.clone();
                    (0..joints).for_each(|i| q[i] += time * v[i]);
                    momentum(&mut probe, &q, &v)
                };
                let (plus, minus) = (ahead(1e-6), ahead(-1e-6));
                let owed = [0, 1, 2].map(|k: usize| -h * (plus[k] - minus[k]) / 2e-6);
                worst = worst.max(norm(&[0, 1, 2].map(|k: usize| after[k] - old[k] - owed[k])));
                drifted = drifted.max(norm(&w.momentum()));
                exchanged = exchanged.max(0.05 * norm(&new[joints + 3..]));
            }
            println!(
                "servo damping {damping}, h {h}: {:.1e} of {exchanged:.2e} N s in the worst step; total momentum {:.1e}",
                worst / exchanged,
                drifted / exchanged
            );
            assert!(worst <= 1e-9 * exchanged);
        }
    }
}

/// Throws the sphere at a hand without motors. Returns the largest energy of all above the initial one, as a share of
/// the sphere's, whether they touched, and when.
fn throw(robot: &Robot, h: f64, gravity: f64, number: u32) -> (f64, bool, String) {
    let mut stream = Stream::new(11, Domain::Start, number, 0, 0);
    let mut uniform = |low: f64, high: f64| stream.range_f64(low, high);
    let mut w = world(robot, h, gravity);
    w.place_body(Tabletop::SPHERE, Pose::at([9.0, 9.0, 9.0]), Twist::default());
    // A posture in which no finger is within another.
    loop {
        for j in robot.joints() {
            let [low, high] = robot.segments[j.index()].joint.range;
            let inner = [0.95 * low + 0.05 * high, 0.05 * low + 0.95 * high];
            w.place_joint(j, if j.index() < 7 { 0.0 } else { uniform(inner[0], inner[1]) as f32 }, 0.0);
        }
        w.finish_placement();
        let mut look = w.clone();
        look.step();
        if (0..w.pairs()).all(|p| look.pair_contact(PairId(p as u16)).depth < 0.0) {
            break;
        }
    }
    // From a shell around the hand's middle to a point near the hand.
    let hand = [common::WRIST[0] + 0.08, common::WRIST[1], common::WRIST[2] - 0.02];
    let direction = loop {
        let d: [f64; 3] = core::array::from_fn(|_| uniform(-1.0, 1.0));
        let n = norm(&d);
        if n < 1.0 && n > 0.1 {
            break d.map(|x| x / n);
        }
    };
    let from = [0, 1, 2].map(|k: usize| hand[k] + 0.16 * direction[k]);
    let to = hand.map(|x| x + uniform(-0.04, 0.04));
    let (speed, way) = (uniform(0.3, 3.0), norm(&[to[0] - from[0], to[1] - from[1], to[2] - from[2]]));
    let linear = [0, 1, 2].map(|k: usize| (speed * (to[k] - from[k]) / way) as f32);
    let angular: [f32; 3] = core::array::from_fn(|_| uniform(-30.0, 30.0) as f32);
    w.place_body(Tabletop::SPHERE, Pose::at(from.map(|x| x as f32)), Twist { linear, angular });
    w.finish_placement();
    let e = w.energy();
    let (start, own) = (e[0] + e[1], e[0]);
    let (mut gain, mut touched, mut at) = (f64::NEG_INFINITY, false, 0);
    for t in 0..steps(0.6, h) {
        w.step();
        let e = w.energy();
        let g = (e[0] + e[1] - start) / own;
        if g.is_nan() || g > gain {
            gain = g;
            at = t;
        }
        touched |= touching(&w) > 0;
    }
    (gain, touched, format!("throw {number}, {speed:.2} m/s, at {:.1} ms", 1e3 * h * at as f64))
}

#[test]
fn a_sphere_thrown_at_a_passive_hand_never_gains_energy() {
    let surface = ArmAndHand::default().surface;
    let n = 100;
    for (name, wrist) in [("fixed palm", Wrist::Fixed), ("limp arm", Wrist::Limp)] {
        let robot = hand_and_sphere(wrist, surface, None);
        for gravity in [0.0, 9.81] {
            for h in STEPS {
                let throws: Vec<_> = (0..n).map(|k| throw(&robot, h, gravity, k)).collect();
                let hits = throws.iter().filter(|t| t.1).count();
                let worst = throws.iter().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
                println!(
                    "{name}, gravity {gravity}, h {h}: {hits} of {n} hit; largest gain {:.1e} of the sphere's energy ({})",
                    worst.0, worst.2
                );
                assert!(hits > n as usize / 2 && worst.0 < 1e-3);
            }
        }
    }
}

/// Returns the fall of the sphere in two seconds between thumb and index, whose first flexion joints exert a constant
/// torque [m], and its final speed [m/s].
fn pinch(mu: f64, torque: f64, h: f64) -> (f64, f64) {
    let surface = Surface { friction: mu, ..ArmAndHand::default().surface };
    let mut robot = hand_and_sphere(Wrist::Fixed, surface, Some(Law::Torque(Torque { limit: 1.0 })));
    // Opposition and abduction stay where they are. The outer joints lie against their stops.
    let [thumb_base, index_base] = [8, 12].map(|n: usize| n - 8);
    for a in [thumb_base, index_base] {
        robot.actuators[a].law = Law::Held(Held { stiffness: 100.0, damping: 0.5 });
    }
    let mut w = world(&robot, h, 9.81);
    let right = -90.0_f32.to_radians();
    w.place_joint(JointId(7), right, 0.0);
    w.place_joint(JointId(12), -75.0_f32.to_radians(), 0.0);
    w.command(ActuatorId(thumb_base as u16), [0.0, right]);
    // Next to the thumb, which points straight down 28 mm from the wrist.
    let [x, y, z] = common::WRIST;
    w.place_body(
        Tabletop::SPHERE,
        Pose::at([x + 0.028 + 0.006 + 0.025, y + 0.0225, z - 0.045].map(|x| x as f32)),
        Twist::default(),
    );
    w.finish_placement();
    w.command(ActuatorId(1), [-torque as f32, 0.0]);
    w.command(ActuatorId(5), [-torque as f32, 0.0]);
    let mut z0 = 0.0;
    for t in 0..steps(3.0, h) {
        if t == steps(1.0, h) {
            z0 = w.pose_of(Tabletop::SPHERE).position[2];
        }
        w.step();
    }
    (z0 - w.pose_of(Tabletop::SPHERE).position[2], norm(&w.velocity_of(Tabletop::SPHERE).linear))
}

#[test]
fn a_pinch_holds_with_friction_and_drops_without() {
    for h in STEPS {
        for mu in [0.0, 0.5, 0.7, 1.0, 1.5] {
            let (fall, speed) = pinch(mu, 0.15, h);
            println!("h {h}, friction {mu}: falls {:.4} mm in 2 s, {speed:.2e} m/s", 1e3 * fall);
            if mu == 0.0 {
                assert!(fall > 0.1);
            } else {
                assert!(fall.abs() < 2e-4 && speed < 1e-3);
            }
        }
    }
}
