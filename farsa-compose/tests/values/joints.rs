//! Terms and sensors of robots with joints, in closed form.
//!
//! A step of a dynamics time step h adds g h to the speed and then v h to the place. After n of them from rest the
//! speed is g h n, and the way is g h^2 n (n + 1) / 2. A free body, a hinge and a rail follow this for a force, a torque
//! and gravity.

use std::fmt::Write as _;

use crate::{Trial, all_close, close, made, refused, yes};

/// A trunk that flies with a limb on a hinge and a sled on a rail. The center of mass of the limb is off its axis.
const GLIDER: &str = r#"<robot name="glider">
<link name="trunk"><inertial><origin xyz="0.02 0.05 0.01"/><mass value="2"/><inertia ixx="0.03" iyy="0.04" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><sphere radius="0.08"/></geometry></collision></link>
<link name="limb"><inertial><origin xyz="0.1 0 0.05"/><mass value="0.6"/><inertia ixx="0.01" iyy="0.02" izz="0.03" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0.2 -0.1 0.4"/><geometry><sphere radius="0.05"/></geometry></collision></link>
<link name="sled"><inertial><mass value="0.4"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="hinge" type="revolute"><parent link="trunk"/><child link="limb"/><origin xyz="0.3 0.1 0.05"/><axis xyz="0 1 0"/><limit lower="-2" upper="2.4" effort="4" velocity="9"/></joint>
<joint name="rail" type="prismatic"><parent link="trunk"/><child link="sled"/><origin xyz="-0.2 0.15 0.1"/><axis xyz="1 0 0"/><limit lower="-0.5" upper="0.7" effort="4" velocity="9"/></joint>
</robot>"#;

/// Gravity [m/s2], control step [s] with 5 steps of the dynamics, and places at the start [m, rad].
const GRAVITY: [f64; 3] = [0.7, -1.1, -2.3];
const TIME_STEP: f64 = 0.05;
const PLACE: [f64; 3] = [0.4, -0.3, 1.9];
const HEADING: f64 = 33.0;
const BEND: f64 = 0.7;
const MARK: [f64; 3] = [0.9, -0.1, 1.5];
const BALL: [f64; 3] = [0.8, 0.5, 1.6];
/// A point of the limb.
const TIP: [f64; 3] = [0.2, -0.1, 0.4];

pub(crate) type Vector = [f64; 3];

pub(crate) fn add(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] + b[k])
}

pub(crate) fn minus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn times(a: f64, b: Vector) -> Vector {
    b.map(|x| a * x)
}

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// Turns a vector about y, and one about z [rad].
fn about_y(angle: f64, [x, y, z]: Vector) -> Vector {
    let (s, c) = angle.sin_cos();
    [c * x + s * z, y, c * z - s * x]
}

pub(crate) fn about_z(angle: f64, [x, y, z]: Vector) -> Vector {
    let (s, c) = angle.sin_cos();
    [c * x - s * y, s * x + c * y, z]
}

/// Turns a vector of the limb into the axes of the world.
fn of_limb(vector: Vector) -> Vector {
    about_z(HEADING.to_radians(), about_y(BEND, vector))
}

/// Speed and way per unit of acceleration after a number of control steps.
fn fallen(steps: usize) -> [f64; 2] {
    let (h, n) = (TIME_STEP / 5.0, 5.0 * steps as f64);
    [h * n, h * h * n * (n + 1.0) / 2.0]
}

/// The glider after a number of steps.
pub(crate) struct Fall {
    number: usize,
    speed: Vector,
    way: Vector,
    last_way: Vector,
}

impl Fall {
    fn new(steps: usize) -> Self {
        let [speed, way] = fallen(steps);
        let before = fallen(steps.saturating_sub(1))[1];
        Self {
            number: steps,
            speed: times(speed, GRAVITY),
            way: times(way, GRAVITY),
            last_way: times(way - before, GRAVITY),
        }
    }

    fn limb(&self) -> Vector {
        add(add(PLACE, about_z(HEADING.to_radians(), [0.3, 0.1, 0.05])), self.way)
    }

    fn tip(&self) -> Vector {
        add(self.limb(), of_limb(TIP))
    }

    fn to_mark(&self) -> f64 {
        length(minus(self.tip(), MARK))
    }
}

/// Component along (0.3, -0.9, 0.5).
fn along(vector: Vector) -> f64 {
    dot(vector, [0.3, -0.9, 0.5]) / f64::sqrt(0.09 + 0.81 + 0.25)
}

pub(crate) fn file(sensors: &str, terms: &str) -> String {
    format!(
        "world = {{ engine = \"articulated\", floor = false, time_step = {TIME_STEP}, substeps = 5, gravity = {GRAVITY:?} }}\n\
         robot = {{ kind = \"model\", file = \"glider.urdf\", floating = true }}\n\
         motors = [{{ kind = \"joint-torque\", largest = 3.0 }}]\n\
         network = {{ kind = \"wired\", bias = [0.5, 0.5], wires = [] }}\nepisode = {{ steps = 12, trials = 1 }}\n\
         [[objects]]\nname = \"mark\"\nkind = \"marker\"\nat = {MARK:?}\n\
         [[objects]]\nname = \"ball\"\nkind = \"ball\"\nradius = 0.06\nmass = 0.3\nat = {BALL:?}\n\
         [[start]]\nplace = \"robot\"\nat = \"fixed\"\npoint = {PLACE:?}\nheading = {HEADING}\n\
         [[start]]\nplace = \"hinge\"\nat = \"turned\"\nlow = {BEND}\nhigh = {BEND}\n\
         [[start]]\nplace = \"rail\"\nat = \"turned\"\nlow = 0.25\nhigh = 0.25\n\
         {sensors}{terms}[files]\n\"glider.urdf\" = '''{GLIDER}'''\n"
    )
}

pub(crate) const NOTHING: &str = "[[sensors]]\nkind = \"constant\"\nvalue = 0.3\n";

type Case = (&'static str, &'static str, fn(&Fall) -> f64);

/// The distance from the tip to the ball's surface, which falls with it.
fn to_ball() -> f64 {
    length(minus(Fall::new(0).tip(), BALL)) - 0.06
}

pub(crate) const TERMS: &[Case] = &[
    ("near", "object = \"mark\"\nbody = \"limb\"\npoint = [0.2, -0.1, 0.4]\nwithin = 0.55", |fall| {
        yes(fall.to_mark() < 0.55)
    }),
    ("distance", "object = \"mark\"\nbody = \"limb\"\npoint = [0.2, -0.1, 0.4]", Fall::to_mark),
    ("distance", "object = \"sled\"\nbody = \"limb\"", |_| length([0.3 + 0.2 - 0.25, 0.1 - 0.15, 0.05 - 0.1])),
    ("approach", "object = \"mark\"\nbody = \"limb\"\npoint = [0.2, -0.1, 0.4]", |fall| {
        Fall::new(0).to_mark() - fall.to_mark()
    }),
    ("displacement", "body = \"limb\"", |fall| length(fall.way)),
    ("moved", "object = \"ball\"", |fall| length(fall.way)),
    ("moved", "object = \"mark\"", |_| 0.0),
    ("speed", "body = \"limb\"", |fall| length(fall.speed)),
    ("forward", "body = \"limb\"", |fall| dot(fall.last_way, of_limb([1.0, 0.0, 0.0]))),
    ("progress", "along = [0.3, -0.9, 0.5]\nbody = \"limb\"", |fall| along(fall.last_way)),
    ("position", "along = [0.3, -0.9, 0.5]\nbody = \"limb\"\npoint = [0.2, -0.1, 0.4]", |fall| along(fall.tip())),
    ("height", "body = \"limb\"\npoint = [0.2, -0.1, 0.4]", |fall| fall.tip()[2]),
    ("upright", "body = \"limb\"", |_| BEND.cos()),
    ("joint-speed", "", |_| 0.0),
    ("sensor", "sensor = \"constant\"", |_| 0.3),
    ("effort", "", |_| 0.25),
    ("control", "", |_| 0.0),
    ("steps", "", |_| 1.0),
    ("step", "", |fall| fall.number as f64),
    ("time", "", |fall| TIME_STEP * fall.number as f64),
    ("joint-position", "joint = \"hinge\"", |_| BEND),
    ("joint-position", "joint = \"rail\"", |_| 0.25),
    ("joint-velocity", "joint = \"rail\"", |_| 0.0),
    ("contact", "object = \"ball\"", |_| 0.0),
    ("height", "body = \"ball\"", |fall| BALL[2] + fall.way[2]),
    ("height", "body = \"mark\"", |_| MARK[2]),
    ("position", "along = [0.3, -0.9, 0.5]\nbody = \"ball\"", |fall| along(add(BALL, fall.way))),
    ("speed", "body = \"ball\"", |fall| length(fall.speed)),
    ("formula", "formula = \"2 * height(ball) / 1 m\"", |fall| 2.0 * (BALL[2] + fall.way[2])),
    ("touch", "", |_| 0.0),
];

#[test]
fn each_term_of_a_falling_robot_has_its_value() {
    let mut terms = String::new();
    for (number, (kind, keys, _)) in TERMS.iter().enumerate() {
        let _ = writeln!(terms, "[[reward]]\nname = \"v{number}\"\nkind = \"{kind}\"\n{keys}");
    }
    let trial = Trial::new(&file(NOTHING, &terms));
    for number in 1..=12 {
        for (index, (kind, keys, value)) in TERMS.iter().enumerate() {
            let found = trial.column(&format!("v{index}"))[number - 1];
            close(found, value(&Fall::new(number)), 2e-5, &format!("{kind} {keys} after step {number}"));
        }
    }
    let near: f64 = trial.column("v0").iter().sum();
    assert!((1.0..12.0).contains(&near), "the threshold lies within the fall: {near}");
}

/// The reach of a ball is part of the distance, from both sides of the limit.
#[test]
fn nearness_is_measured_from_the_surface() {
    for (within, wanted) in [(to_ball() + 0.01, 1.0), (to_ball() - 0.01, 0.0)] {
        let keys = format!("object = \"ball\"\nbody = \"limb\"\npoint = {TIP:?}\nwithin = {within}");
        let text = file(NOTHING, &format!("[[reward]]\nkind = \"near\"\n{keys}\n"));
        assert_eq!(Trial::new(&text).column("near"), [wanted; 12], "within {within} m");
    }
}

pub(crate) const SENSORS: &[&str] = &[
    "joint-position",
    "joint-speed",
    "target-position",
    "body-pose",
    "body-velocity",
    "height",
    "constant",
    "orientation",
    "up",
];

#[test]
fn each_sensor_of_a_falling_robot_has_its_value() {
    let sensors = "[[sensors]]\nkind = \"joint-position\"\n\
        [[sensors]]\nname = \"some\"\nkind = \"joint-position\"\njoints = [\"rail\"]\nfrom = 0.4\nto = -0.2\n\
        [[sensors]]\nkind = \"joint-speed\"\n\
        [[sensors]]\nname = \"mark\"\nkind = \"target-position\"\ntarget = \"mark\"\nbody = \"limb\"\npoint = [0.2, -0.1, 0.4]\nscale = 3.0\n\
        [[sensors]]\nname = \"outside\"\nkind = \"target-position\"\ntarget = \"mark\"\nbody = \"limb\"\naxes = \"world\"\nscale = -2.0\n\
        [[sensors]]\nname = \"ball\"\nkind = \"target-position\"\ntarget = \"ball\"\nbody = \"limb\"\npoint = [0.2, -0.1, 0.4]\n\
        [[sensors]]\nkind = \"body-pose\"\nbody = \"limb\"\n\
        [[sensors]]\nkind = \"body-velocity\"\nbody = \"limb\"\n\
        [[sensors]]\nname = \"drift\"\nkind = \"body-velocity\"\nbody = \"limb\"\naxes = \"world\"\n\
        [[sensors]]\nkind = \"height\"\nbody = \"limb\"\npoint = [0.2, -0.1, 0.4]\n\
        [[sensors]]\nkind = \"constant\"\nvalue = -0.45\n";
    let trial = Trial::new(&file(sensors, "[[reward]]\nkind = \"steps\"\n"));
    let inward = |vector| about_y(-BEND, about_z(-HEADING.to_radians(), vector));
    let (z, y) = ((0.5 * HEADING.to_radians()).sin_cos(), (0.5 * BEND).sin_cos());
    // The product of a turn about z and one about y.
    let turn = [-z.0 * y.0, z.1 * y.0, z.0 * y.1, z.1 * y.1];
    for number in 1..=12_usize {
        let fall = Fall::new(number - 1);
        let sensor = |name: &str, wanted: &[f64]| {
            all_close(&trial.sensor(name, number), wanted, 2e-5, &format!("{name} in step {number}"));
        };
        sensor("joint-position", &[(0.7 + 2.0) / 4.4, (0.25 + 0.5) / 1.2]);
        sensor("some", &[(0.25 - 0.4) / -0.6]);
        sensor("joint-speed", &[0.0, 0.0]);
        sensor("mark", &times(3.0, inward(minus(MARK, fall.tip()))));
        sensor("outside", &times(-2.0, minus(MARK, fall.limb())));
        sensor("ball", &inward(minus(add(BALL, fall.way), fall.tip())));
        let [a, b, c] = fall.limb();
        sensor("body-pose", &[a, b, c, turn[0], turn[1], turn[2], turn[3]]);
        let ([u, v, w], [x, y, z]) = (inward(fall.speed), fall.speed);
        sensor("body-velocity", &[u, v, w, 0.0, 0.0, 0.0]);
        sensor("drift", &[x, y, z, 0.0, 0.0, 0.0]);
        sensor("height", &[fall.tip()[2]]);
        sensor("constant", &[-0.45]);
    }
}

/// A hinge of 0.02 + 0.8 * 0.5^2 = 0.22 kg m2 about the vertical, and a rail of 1.5 kg, next to each other.
const PAIR: &str = r#"<robot name="pair"><link name="base"/>
<link name="bar"><inertial><origin xyz="0.5 0 0"/><mass value="0.8"/><inertia ixx="0.01" iyy="0.01" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0.9 0 0"/><geometry><sphere radius="0.1"/></geometry></collision></link>
<link name="sled"><inertial><mass value="1.5"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="hinge" type="revolute"><parent link="base"/><child link="bar"/><origin xyz="0 0 0.7"/><axis xyz="0 0 1"/><limit lower="-2" upper="2.4" effort="4" velocity="9"/></joint>
<joint name="rail" type="prismatic"><parent link="base"/><child link="sled"/><origin xyz="0 -0.3 0.2"/><axis xyz="0 1 0"/><limit lower="-0.5" upper="0.7" effort="5" velocity="9"/></joint>
</robot>"#;
const INERTIAS: [f64; 2] = [0.22, 1.5];

pub(crate) fn pair(motor: &str, bias: &[f64], steps: u32, rest: &str) -> String {
    format!(
        "world = {{ engine = \"articulated\", floor = false, time_step = {TIME_STEP}, substeps = 5, gravity = [0, 0, 0], stiffness = 10.0 }}\n\
         robot = {{ kind = \"model\", file = \"pair.urdf\", base = [0.2, -0.3, 0.1] }}\nmotors = [{{ {motor} }}]\n\
         network = {{ kind = \"wired\", bias = {bias:?}, wires = [] }}\nepisode = {{ steps = {steps}, trials = 1 }}\n\
         [[sensors]]\nkind = \"joint-speed\"\n\
         [[sensors]]\nkind = \"joint-position\"\njoints = [\"rail\", \"hinge\"]\nfrom = -0.25\nto = 1.75\n\
         {rest}[files]\n\"pair.urdf\" = '''{PAIR}'''\n"
    )
}

/// Positions of hinge and rail, from the sensor that reads the rail first: 2 x - 0.25.
fn positions(trial: &Trial, step: usize) -> [f64; 2] {
    let read = trial.sensor("joint-position", step);
    [2.0 * read[1] - 0.25, 2.0 * read[0] - 0.25]
}

pub(crate) const MOTORS: &[&str] = &["joint-torque", "joint-velocity", "servo", "muscles"];

/// Constant efforts of hinge and rail, by motor, outputs and torques [N m, N].
#[test]
fn joints_accelerate_by_their_efforts() {
    for (motor, outputs, efforts) in [
        // 2 y - 1 of the largest effort: 0.6 and -0.3 of 2, and of the model's own 4 and 5.
        ("kind = \"joint-torque\", largest = 2.0", [0.8, 0.35], [1.2, -0.6]),
        ("kind = \"joint-torque\"", [0.8, 0.35], [2.4, -1.5]),
        // Far from the target speed and position, the limit acts.
        ("kind = \"joint-velocity\", largest = 900000.0, gain = 100.0, limit = 1.3", [0.8, 0.35], [1.3, -1.3]),
        (
            "kind = \"servo\", from = 40.0, to = -60.0, stiffness = 100.0, damping = 0.1, limit = 0.9",
            [0.8, 0.35],
            [-0.9, 0.9],
        ),
    ] {
        let terms = "[[reward]]\nkind = \"joint-speed\"\n[[reward]]\nname = \"bar\"\nkind = \"joint-speed\"\njoints = [\"hinge\"]\n\
            [[reward]]\nkind = \"effort\"\n[[reward]]\nkind = \"control\"\n";
        let trial = Trial::new(&pair(motor, &outputs, 9, terms));
        let rates = [efforts[0] / INERTIAS[0], efforts[1] / INERTIAS[1]];
        for number in 1..=9_usize {
            let [speed, _] = fallen(number);
            let what = |word: &str| format!("{word} of {motor} in step {number}");
            let speeds = rates.map(|rate| rate * speed);
            let found = trial.column("joint-speed")[number - 1];
            close(found, 0.5 * (speeds[0].abs() + speeds[1].abs()), 2e-5, &what("mean speed"));
            close(trial.column("bar")[number - 1], speeds[0].abs(), 2e-5, &what("speed"));
            close(trial.column("effort")[number - 1], 0.5 * (0.64 + 0.35 * 0.35), 1e-6, &what("effort"));
            close(trial.column("control")[number - 1], 0.5 * (0.36 + 0.09), 1e-6, &what("control"));
            let [speed, way] = fallen(number - 1);
            all_close(&trial.sensor("joint-speed", number), &rates.map(|rate| rate * speed), 2e-5, &what("sensor"));
            all_close(&positions(&trial, number), &rates.map(|rate| rate * way), 2e-5, &what("position"));
        }
    }
}

/// Pages show the joints of a model by their names, whatever the channels are called.
#[test]
fn channels_of_joints_are_labelled_by_the_names_of_the_model() {
    for (motor, outputs, labels) in [
        ("kind = \"joint-torque\"", &[0.5, 0.5][..], ["torque of hinge", "torque of rail"]),
        ("kind = \"servo\", stiffness = 10.0", &[0.5, 0.5], ["position of hinge", "position of rail"]),
        ("kind = \"joint-torque\", channels = [\"a\", \"b\"]", &[0.5, 0.5], ["", ""]),
    ] {
        let evaluator = made(&pair(motor, outputs, 2, "[[reward]]\nkind = \"steps\"\n")).expect("an experiment");
        let schema = evaluator.info().schema;
        let label = |channel: &farsa_lab::advanced::Channel| channel.label.clone();
        let sensors: Vec<String> = schema.sensors.iter().map(label).collect();
        assert_eq!(sensors, ["speed of hinge", "speed of rail", "position of rail", "position of hinge"]);
        assert_eq!(schema.outputs.iter().map(label).collect::<Vec<_>>(), labels, "{motor}");
        assert!(schema.outputs.iter().all(|output| output.about.contains("hinge") || output.about.contains("rail")));
        assert_eq!(schema.sensors[0].name, "joint-speed 1");
    }
}

/// A damper g (w - v) is integrated implicitly. The missing speed shrinks by 1 / (1 + g h / I) in each step.
#[test]
fn joint_speeds_approach_the_wanted_ones() {
    let motor = "kind = \"joint-velocity\", largest = 3.0, gain = 1.7";
    let trial = Trial::new(&pair(motor, &[0.9, 0.3], 12, "[[reward]]\nkind = \"steps\"\n"));
    for number in 1..=12_usize {
        let wanted = [0, 1].map(|joint| {
            let speed = 3.0 * [0.8, -0.4][joint];
            let left = f64::powf(1.0 + 1.7 * 0.01 / INERTIAS[joint], -5.0 * (number as f64 - 1.0));
            speed * (1.0 - left)
        });
        all_close(&trial.sensor("joint-speed", number), &wanted, 2e-5, &format!("speeds in step {number}"));
    }
}

/// Servos rest where `from` + (`to` - `from`) y is, each by its own channel, by one for both, and by their ranges.
#[test]
fn servos_rest_at_their_places() {
    let law = "stiffness = 40.0, damping = 9.0";
    for (keys, bias, wanted) in [
        (
            format!("kind = \"servo\", from = 0.3, to = -0.4, {law}"),
            &[0.65, 0.2][..],
            [0.3 - 0.7 * 0.65, 0.3 - 0.7 * 0.2],
        ),
        (format!("kind = \"servo\", from = 0.3, to = -0.4, together = true, {law}"), &[0.65], [0.3 - 0.7 * 0.65; 2]),
        (format!("kind = \"servo\", {law}"), &[0.65, 0.2], [-2.0 + 4.4 * 0.65, -0.5 + 1.2 * 0.2]),
        (
            format!("kind = \"servo\", joints = [\"rail\", \"hinge\"], {law}"),
            &[0.65, 0.2],
            [-2.0 + 4.4 * 0.2, -0.5 + 1.2 * 0.65],
        ),
    ] {
        let trial = Trial::new(&pair(&keys, bias, 240, "[[reward]]\nkind = \"steps\"\n"));
        all_close(&positions(&trial, 240), &wanted, 1e-4, &keys);
    }
}

/// Equal activations hold the middle of the range. With activations a and b and k = 3, the torque at the place e in half
/// ranges is T r ((b - a) (1 - e^2) + (e^(-k e) - e^(k e)) / (e^k - 1)). The joint rests where it vanishes.
#[test]
fn muscles_balance_where_their_tensions_are_equal() {
    for (bias, difference) in [([0.4, 0.4], 0.0), ([0.7, 0.2], -0.5), ([0.1, 0.4], 0.3)] {
        let motor = "kind = \"muscles\", joints = [\"hinge\"], tension = 60.0, moment_arm = 0.05";
        let trial = Trial::new(&pair(motor, &bias, 3000, "[[reward]]\nkind = \"steps\"\n"));
        let torque = |e: f64| difference * (1.0 - e * e) + ((-3.0 * e).exp() - (3.0 * e).exp()) / (3_f64.exp() - 1.0);
        let (mut low, mut high) = (-1.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if torque(middle) > 0.0 { low = middle } else { high = middle }
        }
        let wanted = 0.2 + 2.2 * low;
        close(positions(&trial, 3000)[0], wanted, 5e-3, &format!("hinge of muscles {bias:?}"));
        assert_eq!(yes(wanted > 0.2 + 1e-9), yes(difference > 0.0));
    }
}

/// The bar's tip overlaps a ball that does not move, and the other robot parts do not.
#[test]
fn touch_is_of_the_named_bodies_and_things() {
    let objects = "[[objects]]\nname = \"ball\"\nkind = \"ball\"\nradius = 0.1\nmass = 50.0\nat = [1.1, -0.13, 0.8]\n\
        [[objects]]\nname = \"far\"\nkind = \"ball\"\nradius = 0.1\nmass = 0.3\nat = [-1.1, 0.2, 0.8]\n";
    let keys = ["", "with = \"ball\"", "with = \"far\"", "bodies = [\"bar\"]"];
    let mut terms = String::new();
    let mut sensors = String::new();
    for (number, keys) in keys.iter().enumerate() {
        let _ = writeln!(terms, "[[reward]]\nname = \"v{number}\"\nkind = \"touch\"\n{keys}");
        let _ = writeln!(sensors, "[[sensors]]\nname = \"s{number}\"\nkind = \"touch\"\n{keys}");
        let _ = writeln!(sensors, "[[sensors]]\nname = \"f{number}\"\nkind = \"contact-force\"\n{keys}");
    }
    let motor = "kind = \"joint-torque\"";
    let trial = Trial::new(&pair(motor, &[0.5, 0.5], 2, &format!("{objects}{sensors}{terms}")));
    for (number, wanted) in [1.0, 1.0, 0.0, 1.0].into_iter().enumerate() {
        assert_eq!(trial.column(&format!("v{number}"))[0], wanted, "{}", keys[number]);
        // Sensors of the second step read the contacts of the first.
        assert_eq!(trial.sensor(&format!("s{number}"), 2), [wanted], "{}", keys[number]);
        assert_eq!(trial.sensor(&format!("f{number}"), 2)[0] > 0.0, wanted > 0.0, "{}", keys[number]);
    }
    let text = pair(motor, &[0.5, 0.5], 2, &format!("{objects}{terms}"));
    assert!(refused(&text.replace("bodies = [\"bar\"]", "bodies = [\"sled\"]")).contains("can touch nothing"));
}

/// A ball of 2 kg rests on the floor: its weight is m g = 2 * 3.7 N.
#[test]
fn a_resting_body_presses_with_its_weight() {
    let model = r#"<robot name="r"><link name="ball"><inertial><mass value="2"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><sphere radius="0.1"/></geometry></collision></link>
<link name="pin"><inertial><mass value="0.0001"/><inertia ixx="1e-6" iyy="1e-6" izz="1e-6" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="spin" type="continuous"><parent link="ball"/><child link="pin"/><axis xyz="0 0 1"/><limit effort="1" velocity="9"/></joint></robot>"#;
    let text = format!(
        "world = {{ engine = \"articulated\", gravity = [0, 0, -3.7] }}\n\
         robot = {{ kind = \"model\", file = \"r.urdf\", floating = true }}\nmotors = [{{ kind = \"joint-torque\" }}]\n\
         sensors = [{{ kind = \"contact-force\" }}, {{ name = \"floor\", kind = \"contact-force\", with = \"floor\" }}, \
         {{ kind = \"touch\" }}]\n\
         network = {{ kind = \"wired\", bias = [0.5], wires = [] }}\nepisode = {{ steps = 100, trials = 1 }}\n\
         start = [{{ place = \"robot\", at = \"fixed\", point = [0.3, 0.7, 0.1] }}]\nreward = [{{ kind = \"touch\" }}]\n\
         [files]\n\"r.urdf\" = '''{model}'''\n"
    );
    let trial = Trial::new(&text);
    for name in ["contact-force", "floor"] {
        close(trial.sensor(name, 100)[0], 2.0001 * 3.7, 5e-3, name);
    }
    assert_eq!((trial.sensor("touch", 100), trial.column("touch")[99]), (vec![1.0], 1.0));
    // The floor is no thing that a robot collides with.
    let ends = Trial::new(&text.replace("trials = 1", "trials = 1, ends = [\"collision\"]"));
    assert_eq!(ends.outcome.steps, 100);
}

/// A joint of an MJCF model may be anywhere on its body. Here the hinge is at (0.3, 0, 0.1) of a body at (0.5, 0.2, 0.4).
/// A torque of 1.2 N m acts on 0.31 + 0.7 * 0.01 kg m2 about the hinge. The origin of the body moves along a circle.
#[test]
fn bodies_are_measured_at_their_own_frames() {
    let model = r#"<mujoco><worldbody><body name="arm" pos="0.5 0.2 0.4"><joint name="hinge" pos="0.3 0 0.1" axis="0 0 1" range="-100 100"/>
<inertial pos="0.2 0 0.1" mass="0.7" diaginertia="0.2 0.3 0.31"/><geom type="sphere" size="0.05"/></body></worldbody>
<actuator><motor joint="hinge" ctrllimited="true" ctrlrange="-4 4"/></actuator></mujoco>"#;
    let text = format!(
        "world = {{ engine = \"articulated\", floor = false, gravity = [0, 0, 0], time_step = {TIME_STEP}, substeps = 5 }}\n\
         robot = {{ kind = \"model\", file = \"arm.xml\" }}\nmotors = [{{ kind = \"joint-torque\", largest = 2.0 }}]\n\
         sensors = [{{ kind = \"body-pose\", body = \"arm\" }}, {{ kind = \"body-velocity\", body = \"arm\", axes = \"world\" }}, \
         {{ name = \"own\", kind = \"body-velocity\", body = \"arm\" }}, {{ kind = \"height\", body = \"arm\" }}]\n\
         network = {{ kind = \"wired\", bias = [0.8], wires = [] }}\nepisode = {{ steps = 8, trials = 1 }}\n\
         reward = [{{ kind = \"speed\", body = \"arm\" }}, {{ kind = \"forward\", body = \"arm\" }}, \
         {{ kind = \"progress\", body = \"arm\", along = [0, 1, 0] }}, {{ kind = \"displacement\", body = \"arm\" }}, \
         {{ kind = \"height\", body = \"arm\" }}, {{ kind = \"upright\", body = \"arm\" }}]\n\
         [files]\n\"arm.xml\" = '''{model}'''\n"
    );
    let trial = Trial::new(&text);
    let rate = 1.2 / (0.31 + 0.7 * 0.01);
    // The origin is 0.3 m from the axis, in the direction of -x of the body.
    let place = |steps: usize| {
        let angle = rate * fallen(steps)[1];
        [0.8 - 0.3 * angle.cos(), 0.2 - 0.3 * angle.sin()]
    };
    for number in 1..=8_usize {
        let (now, before) = (place(number), place(number - 1));
        let [speed, angle] = fallen(number).map(|x| rate * x);
        let [x, y] = [now[0] - before[0], now[1] - before[1]];
        let wanted = [
            ("speed", 0.3 * speed),
            ("forward", x * angle.cos() + y * angle.sin()),
            ("progress", y),
            ("displacement", (now[0] - 0.5).hypot(now[1] - 0.2)),
            ("height", 0.4),
            ("upright", 1.0),
        ];
        for (kind, wanted) in wanted {
            close(trial.column(kind)[number - 1], wanted, 3e-5, &format!("{kind} after step {number}"));
        }
        let [speed, angle] = fallen(number - 1).map(|x| rate * x);
        let [sine, cosine] = <[f64; 2]>::from(angle.sin_cos());
        let half = (0.5 * angle).sin_cos();
        let pose = [before[0], before[1], 0.4, 0.0, 0.0, half.0, half.1];
        all_close(&trial.sensor("body-pose", number), &pose, 3e-5, &format!("pose in step {number}"));
        let velocity = [0.3 * speed * sine, -0.3 * speed * cosine, 0.0, 0.0, 0.0, speed];
        all_close(&trial.sensor("body-velocity", number), &velocity, 3e-5, &format!("velocity in step {number}"));
        let own = [0.0, -0.3 * speed, 0.0, 0.0, 0.0, speed];
        all_close(&trial.sensor("own", number), &own, 3e-5, &format!("own velocity in step {number}"));
        close(trial.sensor("height", number)[0], 0.4, 1e-6, "height");
    }
}
