//! Whatever is read is written, and what is written is read as the same robot.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use farsa_body::Pose;
use farsa_body::actuators::{Law, Torque};
use farsa_body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape};
use farsa_models::mjcf::{self, MjcfOptions};
use farsa_models::urdf;
use proptest::prelude::*;

use crate::{message, read};

/// A robot by its names, because each format has its own order of parts.
#[derive(Debug, PartialEq)]
struct Named {
    segments: BTreeMap<String, (Option<String>, Joint, MassProperties)>,
    colliders: BTreeMap<String, (Option<String>, Shape, Pose<f64>)>,
    actuators: BTreeMap<String, (String, Law<f64>)>,
    pairs: BTreeSet<[String; 2]>,
}

impl Named {
    fn new(robot: &Robot) -> Self {
        let segment = |i: usize| robot.segments[i].name.clone();
        let collider = |i: usize| robot.colliders[i].name.clone();
        let segments = robot.segments.iter().map(|one| {
            (one.name.clone(), (one.parent.map(|i| segment(i.index())), one.joint.clone(), one.mass_properties()))
        });
        let colliders = robot
            .colliders
            .iter()
            .map(|one| (one.name.clone(), (one.body.map(|i| segment(i.index())), one.shape, one.placement)));
        let joint = |i: usize| robot.segments[i].joint.name.clone();
        Self {
            segments: segments.collect(),
            colliders: colliders.collect(),
            actuators: robot.actuators.iter().map(|a| (a.name.clone(), (joint(a.joint.index()), a.law))).collect(),
            pairs: robot.pairs.iter().map(|pair| pair.colliders.map(collider)).collect(),
        }
    }

    /// Without what an MJCF does not have: names of fixed joints, laws that are not MuJoCo's.
    fn of_mjcf(mut self) -> Self {
        for (_, joint, _) in self.segments.values_mut() {
            // Every limit of MuJoCo has numbers, from which a stop is computed again.
            joint.stop = None;
            if !joint.kind.is_single() {
                *joint = Joint { name: String::new(), kind: joint.kind, ..Joint::fixed(joint.placement) };
            }
        }
        for (_, law) in self.actuators.values_mut() {
            if let Law::Held(_) = law {
                *law = Law::Torque(Torque { limit: f64::INFINITY });
            }
        }
        self
    }

    /// Without what a URDF does not have: pairs, armatures, springs, laws, the length of axes, planes.
    fn of_urdf(mut self) -> Self {
        self.pairs.clear();
        let mut efforts: BTreeMap<String, f64> = BTreeMap::new();
        for (joint, law) in self.actuators.values() {
            *efforts.entry(joint.clone()).or_default() += match law {
                Law::Servo(servo) => servo.limit,
                Law::Torque(torque) => torque.limit,
                _ => f64::INFINITY,
            };
        }
        efforts.retain(|_, effort| *effort > 0.0);
        let limit = |effort: f64| if effort >= 1e9 { f64::INFINITY } else { effort };
        let motor = |effort| Law::Torque(Torque { limit: limit(effort) });
        self.actuators = efforts.into_iter().map(|(joint, effort)| (joint.clone(), (joint, motor(effort)))).collect();
        for (_, joint, _) in self.segments.values_mut() {
            (joint.armature, joint.stiffness, joint.rest, joint.stop) = (0.0, 0.0, 0.0, None);
            let length = joint.axis.iter().map(|x| x * x).sum::<f64>().sqrt();
            joint.axis = joint.axis.map(|x| x / length);
            if !joint.kind.is_single() {
                *joint = Joint { name: String::new(), kind: joint.kind, ..Joint::fixed(joint.placement) };
            }
        }
        for (_, shape, placement) in self.colliders.values_mut() {
            if *shape == Shape::Plane {
                *shape = Shape::Box { half: [50.0; 3] };
                *placement = placement.compose(&Pose::at([0.0, 0.0, -50.0]));
            }
        }
        self
    }

    /// Returns it with the inertias of `other` where they are close, because flat and least inertias are written as principal
    /// moments.
    fn weighed_as(mut self, other: &Self) -> Self {
        for (name, (_, _, mass)) in &mut self.segments {
            let Some((_, _, theirs)) = other.segments.get(name) else { continue };
            let largest = theirs.inertia.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
            if mass.inertia.iter().zip(theirs.inertia).all(|(a, b)| (a - b).abs() <= 1e-12 * largest) {
                mass.inertia = theirs.inertia;
            }
        }
        self
    }

    /// Returns it but for angles and directions, which a URDF has as other numbers: those of `other` where they are
    /// close.
    fn turned_as(mut self, other: &Self) -> Self {
        let same = |a: &mut Pose<f64>, b: &Pose<f64>| {
            let along: f64 = a.rotation.iter().zip(b.rotation).map(|(a, b)| a * b).sum();
            if (along.abs() - 1.0).abs() < 1e-14 {
                a.rotation = b.rotation;
            }
        };
        for (name, (_, joint, _)) in &mut self.segments {
            let Some((_, theirs, _)) = other.segments.get(name) else { continue };
            same(&mut joint.placement, &theirs.placement);
            if (0..3).all(|k| (joint.axis[k] - theirs.axis[k]).abs() < 1e-15) {
                joint.axis = theirs.axis;
            }
        }
        for (name, (_, _, placement)) in &mut self.colliders {
            let Some((_, _, theirs)) = other.colliders.get(name) else { continue };
            same(placement, theirs);
        }
        self
    }
}

/// Writes and reads a robot through both formats, and returns the first difference.
pub(crate) fn lost(robot: &Robot) -> Result<(), String> {
    let read_again = |kind: &str, text: &str| {
        let back = read(text).map_err(|error| format!("{kind}: {error}\n{text}"))?.robot;
        if back.name == robot.name { Ok(Named::new(&back)) } else { Err(format!("{kind}: called {}", back.name)) }
    };
    let compared = |kind: &str, found: &Named, expected: &Named| {
        if found == expected { Ok(()) } else { Err(format!("{kind}: {found:#?}\ninstead of {expected:#?}")) }
    };
    let text = mjcf::write(robot, &MjcfOptions::default()).map_err(|error| error.to_string())?;
    let expected = Named::new(robot).of_mjcf();
    compared("MJCF", &read_again("MJCF", &text)?.of_mjcf().weighed_as(&expected), &expected)?;
    let text = urdf::write(robot).map_err(|error| error.to_string())?;
    let expected = Named::new(robot).of_urdf();
    compared("URDF", &read_again("URDF", &text)?.of_urdf().turned_as(&expected), &expected)
}

/// A number of any sign whose power of ten is in this range.
fn sized(powers: std::ops::Range<i32>) -> impl Strategy<Value = f64> {
    let number = |(digits, power): (f64, i32)| format!("{digits}e{power}").parse().unwrap();
    (prop_oneof![1.0..10.0_f64, -10.0..-1.0_f64], powers).prop_map(number)
}

/// Now and then any float, otherwise one that is likely accepted.
fn or_any(likely: impl Strategy<Value = f64>) -> impl Strategy<Value = f64> {
    let special = vec![0.0, 5e-324, 1e-9, 1e9, 2e9, 999_999_999.0, 1_999_999_998.0, f64::MAX, f64::INFINITY];
    prop_oneof![60 => likely, 1 => any::<f64>(), 1 => prop::sample::select(special)]
}

fn positive(powers: std::ops::Range<i32>) -> impl Strategy<Value = f64> {
    or_any(sized(powers).prop_map(f64::abs))
}

/// A link or body: what carries it, the kinds of its joint and shape, and all numbers.
#[derive(Clone, Debug)]
struct Part {
    parent: prop::sample::Index,
    kinds: [u8; 2],
    at: [f64; 3],
    angles: [f64; 3],
    axis: [f64; 3],
    /// Mass and moment.
    body: [f64; 2],
    sizes: [f64; 3],
    range: [f64; 2],
    /// Damping, armature, effort, friction, and the time constant and impedance of a contact.
    joint: [f64; 6],
}

fn part() -> impl Strategy<Value = Part> {
    let ends = prop::array::uniform2(or_any(sized(-300..12)));
    let any_positive = || positive(-320..308);
    let numbers = (any_positive(), any_positive(), any_positive(), positive(-9..9), positive(-200..200), 0.0..1.0);
    (
        (any::<prop::sample::Index>(), any::<[u8; 2]>()),
        prop::array::uniform3(or_any(sized(-320..308))),
        prop::array::uniform3(or_any(sized(-9..13))),
        prop::array::uniform3(or_any(sized(-3..3))),
        (positive(-300..300), positive(-90..90)).prop_map(|(mass, moment)| [mass, moment]),
        prop::array::uniform3(positive(-323..9)),
        ends.prop_map(|[a, b]| if a <= b { [a, b] } else { [b, a] }),
        numbers.prop_map(|(a, b, c, d, e, f)| [a, b, c, d, e, f]),
    )
        .prop_map(|((parent, kinds), at, angles, axis, body, sizes, range, joint)| Part {
            parent,
            kinds,
            at,
            angles,
            axis,
            body,
            sizes,
            range,
            joint,
        })
}

fn list(numbers: &[f64]) -> String {
    numbers.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(" ")
}

fn as_urdf(parts: &[Part]) -> String {
    let mut text = String::from("<robot name='r'><link name='base'/>");
    for (i, part) in parts.iter().enumerate() {
        let [a, b, c] = part.sizes;
        let shape = match part.kinds[1] % 4 {
            0 => format!("<sphere radius='{a:?}'/>"),
            1 => format!("<box size='{}'/>", list(&part.sizes)),
            2 => format!("<capsule radius='{a:?}' length='{b:?}'/>"),
            _ => format!("<cylinder radius='{a:?}' length='{c:?}'/>"),
        };
        let (origin, [mass, moment]) =
            (format!("<origin xyz='{}' rpy='{}'/>", list(&part.at), list(&part.angles)), part.body);
        // A fixed segment may have an inertia and no mass.
        let mass = if part.kinds[0].is_multiple_of(8) { 0.0 } else { mass };
        let moments = format!("ixx='{moment:?}' iyy='{moment:?}' izz='{moment:?}' ixy='0' ixz='0' iyz='0'");
        let kind = ["fixed", "revolute", "continuous", "prismatic"][usize::from(part.kinds[0] % 4)];
        let [low, high] = part.range;
        let parent = match part.parent.index(i + 1) {
            0 => "base".to_owned(),
            parent => format!("l{}", parent - 1),
        };
        let _ = write!(
            text,
            "<link name='l{i}'><inertial><mass value='{mass:?}'/><inertia {moments}/></inertial>\
             <collision>{origin}<geometry>{shape}</geometry></collision></link>\
             <joint name='j{i}' type='{kind}'>{origin}<parent link='{parent}'/><child link='l{i}'/><axis xyz='{}'/>\
             <limit lower='{low:?}' upper='{high:?}' effort='{:?}'/><dynamics damping='{:?}' friction='{:?}'/></joint>",
            list(&part.axis),
            part.joint[2],
            part.joint[0],
            part.joint[3]
        );
    }
    text + "</robot>"
}

fn as_mjcf(parts: &[Part]) -> String {
    let mut text = String::from(
        "<mujoco model='r'><compiler angle='radian'/><default><geom contype='0' conaffinity='0'/></default>",
    );
    text += "<worldbody><geom name='floor' type='plane' size='1 1 1'/>";
    let (mut ends, mut rest) = (String::new(), String::new());
    for (i, part) in parts.iter().enumerate() {
        let kind = ["sphere", "box", "capsule", "cylinder", "ellipsoid"][usize::from(part.kinds[1] % 5)];
        let [damping, armature, effort, friction, time, impedance] = part.joint;
        let joint = format!(
            "axis='{}' range='{}' damping='{damping:?}' armature='{armature:?}' frictionloss='{friction:?}' stiffness='{effort:?}' \
             springref='{:?}'",
            list(&part.axis),
            list(&part.range),
            part.at[0]
        );
        let (place, [mass, moment]) = (format!("pos='{}' euler='{}'", list(&part.at), list(&part.angles)), part.body);
        // A chain, or bodies in the world, which alone may float.
        let inner = part.parent.index(2) == 0;
        let joint = match part.kinds[0] % 5 {
            0 => String::new(),
            1 => format!("<joint name='j{i}' type='slide' {joint}/>"),
            2 if !inner || i == 0 => "<freejoint/>".into(),
            _ => format!("<joint name='j{i}' {joint}/>"),
        };
        if !inner {
            text += &std::mem::take(&mut ends);
        }
        let _ = write!(
            text,
            "<body name='b{i}' {place}>{joint}<inertial pos='0 0 0' mass='{mass:?}' diaginertia='{moment:?} {moment:?} {moment:?}'/>\
             <geom name='g{i}' type='{kind}' size='{}' {place}/>",
            list(&part.sizes)
        );
        ends += "</body>";
        if joint.contains("name=") {
            let _ = match part.kinds[1] % 3 {
                0 => write!(rest, "<motor joint='j{i}' ctrlrange='-{effort:?} {effort:?}'/>"),
                1 => write!(
                    rest,
                    "<position joint='j{i}' kp='{armature:?}' kv='{damping:?}' forcerange='-{effort:?} {effort:?}'/>"
                ),
                _ => write!(rest, "<velocity joint='j{i}' kv='{damping:?}'/>"),
            };
        }
        let pair = format!("friction='{friction:?}' solref='{time:?} 1' solimp='0 {impedance:?}'");
        let _ = write!(rest, "</actuator><contact><pair geom1='floor' geom2='g{i}' {pair}/></contact><actuator>");
    }
    format!("{text}{ends}</worldbody><actuator>{rest}</actuator></mujoco>")
}

proptest! {
    #[test]
    fn whatever_is_read_is_written_and_read_back(parts in prop::collection::vec(part(), 1..4)) {
        let robots: Vec<Robot> = [as_urdf(&parts), as_mjcf(&parts)].iter().filter_map(|text| Some(read(text).ok()?.robot)).collect();
        for robot in robots {
            let found = lost(&robot);
            prop_assert!(found.is_ok(), "{}", found.unwrap_err());
        }
    }
}

#[test]
fn sizes_are_refused_where_they_are_read() {
    let urdf = |shape: &str| {
        format!("<robot name='r'><link name='a'>\n<collision><geometry>{shape}</geometry></collision></link></robot>")
    };
    for (shape, expected) in [
        ("<sphere radius='1e9'/>", "sphere: radius is \"1e9\", but must be positive, below 1e9"),
        ("<sphere radius='0'/>", "sphere: radius is \"0\", but must be positive, below 1e9"),
        ("<box size='1 2 2e9'/>", "box: size is \"1 2 2e9\", but must be positive, below 2e9"),
        ("<box size='1 2 5e-324'/>", "box: size is \"1 2 5e-324\", but must be positive, below 2e9"),
        (
            "<cylinder radius='1' length='1e300'/>",
            "cylinder: length is \"1e300\", but must not be negative, and below 2e9",
        ),
        ("<capsule radius='1e300' length='1'/>", "capsule: radius is \"1e300\", but must be positive, below 1e9"),
    ] {
        assert_eq!(message(&urdf(shape)), format!("text line 2: {expected}"));
    }
    for shape in
        ["<sphere radius='999999999'/>", "<box size='1 1999999999 1e-323'/>", "<capsule radius='1e-300' length='0'/>"]
    {
        lost(&read(&urdf(shape)).unwrap().robot).unwrap();
    }
    let mesh = "<mujoco><asset><mesh name='m' vertex='1 0 0 0 1 0 0 0 1' scale='1e300 1 1'/></asset><worldbody>\
        <geom type='mesh' mesh='m'/></worldbody></mujoco>";
    assert!(message(mesh).contains("sizes that are not below 1e9"), "{}", message(mesh));
    let turned = "<robot name='r'><link name='a'><collision>\n<origin rpy='0 1e300 0'/><geometry><sphere radius='1'/></geometry>\
        </collision></link></robot>";
    assert!(
        message(turned).starts_with("text line 2: origin: rpy is \"0 1e300 0\", but must be"),
        "{}",
        message(turned)
    );
}

#[test]
fn any_name_is_written() {
    let mut robot = Robot::new("\u{0}");
    let fixed = Joint::fixed(Pose::identity());
    let odd: Vec<String> =
        (0..0x300_u32).chain([0xFFFE, 0x10FFFF]).filter_map(char::from_u32).map(String::from).collect();
    for name in &odd {
        robot.add_segment(Segment::new(
            &format!("_{}_{name}", robot.segments.len()),
            None,
            fixed.clone(),
            MassProperties::sphere(1.0, 0.1),
        ));
    }
    let texts = [mjcf::write(&robot, &MjcfOptions::default()).unwrap(), urdf::write(&robot).unwrap()];
    for back in texts.iter().map(|text| read(text).unwrap().robot) {
        let kept = robot.segments.iter().zip(&back.segments).filter(|(a, b)| a.name == b.name).count();
        assert_eq!(kept, odd.len() - 30, "all but those that XML does not have");
    }
}

#[test]
fn shapes_that_are_not_read_are_not_written() {
    let mut robot = Robot::new("large");
    for (shape, size) in [
        (Shape::Sphere { radius: 1e9 }, 1e9),
        (Shape::Box { half: [1.0, 1e300, 2e9] }, 1e300),
        (Shape::Capsule { radius: 1.0, half_length: 3e9 }, 3e9),
    ] {
        robot.colliders = vec![Collider::new("it", None, shape, Pose::identity())];
        let expected = format!("it: size (in files below 1e9) is {size}");
        assert_eq!(mjcf::write(&robot, &MjcfOptions::default()).unwrap_err().to_string(), expected);
        assert_eq!(urdf::write(&robot).unwrap_err().to_string(), expected);
    }
}

#[test]
fn what_only_extremes_lost_is_kept() {
    let mass = "<inertial><origin xyz='1 2 3'/><mass value='0'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>";
    let far = "<collision><origin xyz='1e12 -1e12 0' rpy='1 1 1'/><geometry><capsule radius='0.1' length='1'/></geometry></collision>";
    let joint = |low: &str, high: &str| {
        format!(
            "<robot name='r'><link name='a'>{mass}{far}</link><link name='b'>{}</link><joint name='j' type='prismatic'>\
             <parent link='a'/><child link='b'/><limit lower='{low}' upper='{high}'/></joint></robot>",
            mass.replace("value='0'", "value='1'")
        )
    };
    for (low, high, range) in [
        ("2e9", "3e9", [2e9, f64::INFINITY]),
        ("-1e300", "-1e10", [f64::NEG_INFINITY, -1e10]),
        ("-1e9", "5", [f64::NEG_INFINITY, 5.0]),
    ] {
        let robot = read(&joint(low, high)).unwrap().robot;
        assert_eq!((robot.segments[0].inertia[0], robot.segments[1].joint.range), (1.0, range));
        lost(&robot).unwrap();
    }
}
