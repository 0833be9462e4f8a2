//! Random commands from random starts: nothing explodes, nothing sinks in.
#![allow(missing_docs, clippy::unwrap_used)]

mod common;

use common::{Babble, commands, drive, first_point, half_thickness, model, points_of, start};
use farsa_body::motors::ServoRange;
use farsa_body::ports::World as _;
use farsa_body::robot::Robot;
use farsa_body::robots::{ArmAndHand, Tabletop};
use farsa_num::{Domain, Stream};
use farsa_physics::articulated::{Model, Options, World};

const EPISODE_STEPS: usize = 600;

/// A largest value and where it was seen.
#[derive(Clone, Debug)]
struct Worst {
    value: f64,
    at: String,
}

impl Default for Worst {
    fn default() -> Self {
        Self { value: f64::NEG_INFINITY, at: String::new() }
    }
}

impl Worst {
    fn see(&mut self, value: f64, at: impl FnOnce() -> String) {
        // A NaN is the worst of all.
        if value.is_nan() || value > self.value {
            self.value = value;
            self.at = at();
        }
    }
}

#[derive(Clone, Debug, Default)]
struct Figures {
    steps: usize,
    falls: usize,
    /// Steps in which something but the sphere on the table touches.
    touching: usize,
    finite: bool,
    joint_speed: Worst,
    sphere_speed: Worst,
    over_limit: Worst,
    /// Depth of a pair's contact whose force is below 20 N [m].
    gentle_depth: Worst,
    /// Depth as a share of half the thinner body.
    share_of_body: Worst,
    depth: Worst,
    /// The depth of the sphere's center below the table's top inside its outline [m].
    sunk: Worst,
}

struct Checked<'a> {
    robot: &'a Robot,
    model: &'a Model<f32>,
    table: Tabletop,
    /// Dynamics step [s].
    h: f64,
    point: usize,
    /// Name, first point, points, half thickness of the thinner body.
    pairs: Vec<(String, usize, usize, f64)>,
}

impl<'a> Checked<'a> {
    fn new(robot: &'a Robot, model: &'a Model<f32>, table: Tabletop, h: f64) -> Self {
        let mut first = 0;
        let pairs = (0..robot.pairs.len())
            .map(|p| {
                let colliders = robot.pairs[p].colliders.map(|c| &robot.colliders[c]);
                let thin = half_thickness(colliders[0].shape).min(half_thickness(colliders[1].shape));
                let n = points_of(robot, p);
                first += n;
                (format!("{} - {}", colliders[0].name, colliders[1].name), first - n, n, thin)
            })
            .collect();
        Self { robot, model, table, h, point: first_point(robot, model), pairs }
    }

    fn check(&self, state: &[f32], f: &mut Figures, at: &str) {
        let positions = self.model.positions();
        let (q, v) = (&state[..positions], &state[positions..positions + self.model.dofs()]);
        f.steps += 1;
        f.finite &= state.iter().all(|x| x.is_finite());
        for j in 0..27 {
            f.joint_speed.see(f64::from(v[j].abs()), || format!("J{} {at}", j + 1));
            let [low, high] = self.robot.segments[j].joint.range;
            let x = f64::from(q[j]);
            f.over_limit.see((low - x).max(x - high), || format!("J{} {at}", j + 1));
        }
        let speed = v[30..33].iter().map(|x| f64::from(*x) * f64::from(*x)).sum::<f64>().sqrt();
        f.sphere_speed.see(speed, || at.to_string());
        let [x, y, z] = [27, 28, 29].map(|k: usize| f64::from(q[k]));
        let inside = |x: f64, [low, high]: [f64; 2]| x > low && x < high;
        if inside(x, self.table.table_x) && inside(y, self.table.table_y) {
            f.sunk.see(-z, || format!("({x:.3} {y:.3} {z:.3}) {at}"));
        }
        let h = self.h;
        let mut touching = false;
        for (name, first, n, thin) in &self.pairs {
            let words = &state[self.point + 8 * first..self.point + 8 * (first + n)];
            let (mut force, mut depth) = (0.0, f64::NEG_INFINITY);
            for w in words.chunks_exact(8) {
                force += f64::from(w[3]) / h;
                depth = f64::max(depth, -f64::from(w[7]));
            }
            touching |= force > 0.0 && *name != "sphere - table";
            if force > 0.0 && depth > 0.0 {
                let here = || format!("{name} {force:.1} N {at}");
                f.depth.see(depth, here);
                f.share_of_body.see(depth / thin, here);
                if force < 20.0 {
                    f.gentle_depth.see(depth, here);
                }
            }
        }
        f.touching += usize::from(touching);
    }
}

/// Episodes of random commands, one after the other.
fn babble(checked: &Checked, groups: &[Vec<ServoRange>; 9], seed: u64, steps: usize, f: &mut Figures) {
    let model = checked.model;
    let mut world = World::new(model.clone());
    let mut episode = 0;
    let mut done = 0;
    while done < steps {
        let mut stream = Stream::new(seed, Domain::Start, episode, 0, 0);
        start(checked.robot, &mut world, &mut stream, episode as usize);
        let mut babble = Babble::new(seed, episode);
        for t in 1..=EPISODE_STEPS {
            drive(&mut world, &commands(groups, babble.next()));
            world.step();
            done += 1;
            checked.check(world.state(), f, &format!("episode {episode} step {t}"));
            // The sphere's height: it has fallen off the table.
            if world.state()[29] < 0.0 {
                f.falls += 1;
                break;
            }
        }
        episode += 1;
    }
}

fn run(robot: &Robot, options: Options, table: Tabletop, seed: u64, steps: usize) -> Figures {
    let model = model(robot, options);
    let checked = Checked::new(robot, &model, table, options.time_step / f64::from(options.substeps));
    let groups = ArmAndHand::default().servo_groups();
    let mut f = Figures { finite: true, ..Figures::default() };
    babble(&checked, &groups, seed, steps, &mut f);
    f
}

fn print(f: &Figures) {
    println!("{} control steps, {} with contact of the hand, {} falls", f.steps, f.touching, f.falls);
    for (name, w, unit, scale) in [
        ("joint speed", &f.joint_speed, "rad/s", 1.0),
        ("sphere speed", &f.sphere_speed, "m/s", 1.0),
        ("over a limit", &f.over_limit, "rad", 1.0),
        ("depth below 20 N", &f.gentle_depth, "mm", 1e3),
        ("depth", &f.depth, "mm", 1e3),
        ("share of half the thinner body", &f.share_of_body, "", 1.0),
        ("sphere's centre below the table", &f.sunk, "mm", 1e3),
    ] {
        println!("  {name}: {:.4} {unit} ({})", scale * w.value, w.at);
    }
}

/// A million control steps. Ten million where the environment has `FARSA_LONG`.
#[test]
fn random_commands_break_nothing() {
    let steps = if std::env::var_os("FARSA_LONG").is_some() { 10_000_000 } else { 1_000_000 };
    let table = Tabletop::default();
    let robot = table.scene(&ArmAndHand::default()).unwrap();
    // The steps of `reach-grasp-lift`.
    let f = run(&robot, Options { substeps: 2, path_error: Some(1e-4), ..Options::default() }, table, 1, steps);
    print(&f);
    assert!(f.steps >= steps && f.touching > steps / 10);
    assert!(f.finite, "a state is not finite");
    assert!(f.joint_speed.value < 100.0 && f.sphere_speed.value < 10.0);
    assert!(f.over_limit.value < 0.05, "{:?}", f.over_limit);
    assert!(f.gentle_depth.value < 2e-3, "{:?}", f.gentle_depth);
    assert!(f.share_of_body.value < 1.0, "{:?}", f.share_of_body);
    assert!(f.sunk.value < 0.0, "{:?}", f.sunk);
}
