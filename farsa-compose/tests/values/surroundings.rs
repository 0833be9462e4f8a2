//! Surroundings of robots with joints: shapes, masses and contacts of things, and columns of recordings.

use farsa_body::ports::BodyId;
use farsa_body::robot::{Robot, Shape};

use crate::joints::{Vector, about_z, add, dot, minus, pair};
use crate::{Trial, all_close, close, made, refused};

/// A fixed base, a bar on a hinge and a sled on a rail, each with a shape. The masses are 0.8 and 1.5 kg.
const MODEL: &str = r#"<robot name="pair"><link name="base"><collision><origin xyz="-0.3 0 0.5"/><geometry><sphere radius="0.04"/></geometry></collision></link>
<link name="bar"><inertial><origin xyz="0.5 0 0"/><mass value="0.8"/><inertia ixx="0.01" iyy="0.01" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0.9 0 0"/><geometry><sphere radius="0.1"/></geometry></collision></link>
<link name="sled"><inertial><mass value="1.5"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><sphere radius="0.05"/></geometry></collision></link>
<joint name="hinge" type="revolute"><parent link="base"/><child link="bar"/><origin xyz="0 0 0.7"/><axis xyz="0 0 1"/><limit lower="-2" upper="2.4" effort="4" velocity="9"/></joint>
<joint name="rail" type="prismatic"><parent link="base"/><child link="sled"/><origin xyz="0 -0.3 0.2"/><axis xyz="0 1 0"/><limit lower="-0.5" upper="0.7" effort="5" velocity="9"/></joint>
</robot>"#;

const THINGS: &str = "[[objects]]\nname = \"fence\"\nkind = \"wall\"\nsize = [0.8, 0.2]\nheight = 0.5\nheading = 90\nat = [3.0, 1.0]\n\
    [[objects]]\nname = \"ball\"\nkind = \"ball\"\nradius = 0.1\nmass = 0.3\nfriction = 0.4\nat = [2.4, 0.2]\n\
    [[objects]]\nname = \"crate\"\nkind = \"block\"\nsize = [0.2, 0.3, 0.4]\nmass = 0.9\nfriction = 0.7\nheading = 30\nat = [2.0, -1.0]\n\
    [[objects]]\nname = \"mark\"\nkind = \"marker\"\nat = [1.1, 0.3, 0.2]\n\
    [[objects]]\nname = \"gate\"\nkind = \"wall\"\nsize = [0.6, 0.4]\nheight = 0.3\nat = [-3.0, 1.0, 0.7]\n";

fn exported(world: &str) -> Robot {
    let text = format!(
        "world = {{ engine = \"articulated\", stiffness = 900.0, friction = 0.6{world} }}\n\
         robot = {{ kind = \"model\", file = \"pair.urdf\" }}\nmotors = [{{ kind = \"joint-torque\" }}]\n\
         sensors = [{{ kind = \"joint-speed\" }}]\nnetwork = {{ kind = \"perceptron\" }}\nreward = [{{ kind = \"steps\" }}]\n\
         {THINGS}[files]\n\"pair.urdf\" = '''{MODEL}'''\n"
    );
    let evaluator = made(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    evaluator.exports().and_then(|exports| exports.robot(None)).expect("a robot")
}

/// Damping is critical, 2 sqrt(k m), with the mass of the lighter partner. Between things the greater friction
/// counts. The robot has the friction of the world, and a thing on the floor its own. Two shapes that never move have
/// no contact.
#[test]
fn contacts_have_the_friction_and_damping_of_their_partners() {
    let robot = exported("");
    let (whole, ball, block) = (0.8 + 1.5, 0.3, 0.9);
    let wanted = [
        ("bar", "floor", 0.6, whole),
        ("sled", "floor", 0.6, whole),
        ("bar", "fence", 0.6, whole),
        ("sled", "fence", 0.6, whole),
        ("base", "ball", 0.6, ball),
        ("bar", "ball", 0.6, ball),
        ("sled", "ball", 0.6, ball),
        ("ball", "floor", 0.4, ball),
        ("fence", "ball", 0.4, ball),
        ("base", "crate", 0.6, block),
        ("bar", "crate", 0.6, block),
        ("sled", "crate", 0.6, block),
        ("crate", "floor", 0.7, block),
        ("fence", "crate", 0.7, block),
        ("ball", "crate", 0.7, ball),
        ("bar", "gate", 0.6, whole),
        ("sled", "gate", 0.6, whole),
        ("ball", "gate", 0.4, ball),
        ("crate", "gate", 0.7, block),
    ];
    let names = |robot: &Robot| -> Vec<[String; 2]> {
        let name = |collider: usize| {
            let name = &robot.colliders[collider].name;
            name.split([' ', '-', '_']).next().unwrap_or(name).to_owned()
        };
        robot.pairs.iter().map(|pair| pair.colliders.map(name)).collect()
    };
    let pairs: Vec<[String; 2]> = wanted.iter().map(|(a, b, ..)| [a, b].map(|name| (*name).to_owned())).collect();
    assert_eq!(names(&robot), pairs);
    for (pair, (a, b, friction, mass)) in robot.pairs.iter().zip(&wanted) {
        let what = format!("{a} and {b}");
        close(pair.surface.friction, *friction, 1e-12, &what);
        close(pair.surface.damping, 2.0 * f64::sqrt(900.0 * mass), 1e-9, &what);
        assert_eq!((pair.surface.stiffness, pair.surface.rolling_friction), (900.0, 0.0), "{what}");
    }
    let pairs: Vec<[String; 2]> = pairs.into_iter().filter(|[_, other]| other != "floor").collect();
    assert_eq!(names(&exported(", floor = false")), pairs);
}

/// The inertia of a ball is 2 m r^2 / 5, and that of a block m (b^2 + c^2) / 12. Without a height, things rest on the
/// floor.
#[test]
fn things_have_their_shapes_masses_and_places() {
    let robot = exported("");
    let segment = |name: &str| robot.segments.iter().find(|segment| segment.name == name).expect("a segment");
    let ball = segment("ball");
    close(ball.mass, 0.3, 1e-12, "ball");
    all_close(&ball.inertia, &[0.0012, 0.0012, 0.0012, 0.0, 0.0, 0.0], 1e-12, "inertia of the ball");
    all_close(&ball.joint.placement.position, &[2.4, 0.2, 0.1], 1e-12, "ball");
    let block = segment("crate");
    close(block.mass, 0.9, 1e-12, "crate");
    all_close(&block.inertia, &[0.01875, 0.015, 0.00975, 0.0, 0.0, 0.0], 1e-12, "inertia of the crate");
    all_close(&block.joint.placement.position, &[2.0, -1.0, 0.2], 1e-12, "crate");
    let half = 15_f64.to_radians();
    all_close(&block.joint.placement.rotation, &[0.0, 0.0, half.sin(), half.cos()], 1e-7, "heading of the crate");
    let diagonal = 45_f64.to_radians().sin();
    for (name, shape, position, rotation) in [
        ("ball", Shape::Sphere { radius: 0.1 }, [0.0; 3], [0.0, 0.0, 0.0, 1.0]),
        ("crate", Shape::Box { half: [0.1, 0.15, 0.2] }, [0.0; 3], [0.0, 0.0, 0.0, 1.0]),
        ("fence", Shape::Box { half: [0.4, 0.1, 0.25] }, [3.0, 1.0, 0.25], [0.0, 0.0, diagonal, diagonal]),
        ("gate", Shape::Box { half: [0.3, 0.2, 0.15] }, [-3.0, 1.0, 0.7], [0.0, 0.0, 0.0, 1.0]),
    ] {
        let collider = robot.colliders.iter().find(|collider| collider.name == name).expect("a shape");
        assert_eq!(collider.shape, shape, "{name}");
        all_close(&collider.placement.position, &position, 1e-7, name);
        all_close(&collider.placement.rotation, &rotation, 1e-7, name);
    }
}

/// The center of the sled is 1 m from that of the crate, whose corners are sqrt(0.01 + 0.0225 + 0.04) m from its center.
#[test]
fn a_block_is_near_by_its_corners() {
    let object =
        "[[objects]]\nname = \"crate\"\nkind = \"block\"\nsize = [0.2, 0.3, 0.4]\nmass = 0.9\nat = [1.2, -0.6, 0.3]\n";
    for (off, wanted) in [(0.001, 1.0), (-0.001, 0.0)] {
        let within = 1.0 - f64::sqrt(0.0725) + off;
        let rest =
            format!("{object}[[reward]]\nkind = \"near\"\nobject = \"crate\"\nbody = \"sled\"\nwithin = {within}\n");
        let trial = Trial::new(&pair("kind = \"joint-torque\"", &[0.5, 0.5], 3, &rest));
        assert_eq!(trial.column("near"), [wanted; 3], "within {within} m");
    }
}

/// A recording has a column of each joint, with its range and unit, and the poses of bodies and markers.
#[test]
fn recordings_have_joints_and_markers() {
    let mark = "[[objects]]\nname = \"ball\"\nkind = \"ball\"\nradius = 0.1\nmass = 0.3\nat = [5.0, 0.2, 0.8]\n\
        [[objects]]\nname = \"mark\"\nkind = \"marker\"\nat = [1.1, 0.3, 0.2]\n";
    let rest = format!(
        "{mark}[[reward]]\nname = \"last\"\nkind = \"distance\"\nobject = \"mark\"\nbody = \"sled\"\nover = \"end\"\n\
         [[reward]]\nname = \"each\"\nkind = \"distance\"\nobject = \"mark\"\nbody = \"sled\"\n"
    );
    let trial = Trial::new(&pair("kind = \"joint-torque\"", &[0.8, 0.35], 9, &rest));
    let scalars = &trial.recording.schema().scalars;
    let names: Vec<(&str, &str, &str, Option<[f64; 2]>)> =
        scalars.iter().map(|channel| (&*channel.name, &*channel.unit, &*channel.group, channel.range)).collect();
    let wanted = [
        ("hinge", "rad", "joint", Some([-2.0, 2.4])),
        ("rail", "m", "joint", Some([-0.5, 0.7])),
        ("last", "", "term", None),
        ("each", "", "term", None),
        ("fitness so far", "", "fitness", None),
    ];
    assert_eq!(names, wanted);
    // Sensors read before a step what a recording has after the step before.
    for number in 2..=9 {
        let read = trial.sensor("joint-position", number);
        let wanted = [trial.column("hinge [rad]")[number - 2], trial.column("rail [m]")[number - 2]];
        all_close(&[2.0 * read[1] - 0.25, 2.0 * read[0] - 0.25], &wanted, 1e-6, &format!("joints in step {number}"));
    }
    // A term of the end is recorded in each step, like others.
    assert_eq!(trial.column("last"), trial.column("each"));
    // The marker comes after the three bodies of the robot and the ball.
    let pose =
        |tick: usize, body: u16| trial.recording.pose_at(tick, BodyId(body)).expect("a pose").position.map(f64::from);
    all_close(&pose(8, 4), &[1.1, 0.3, 0.2], 1e-6, "marker");
    all_close(&pose(8, 3), &[5.0, 0.2, 0.8], 1e-6, "ball");
    // The bar turns about its hinge. The sled has no shape, so it is not shown.
    all_close(&pose(8, 1), &[0.2, -0.3, 0.8], 1e-6, "bar");
    let heading = trial.recording.pose_at(8, BodyId(1)).expect("a pose").heading();
    close(f64::from(heading), trial.column("hinge [rad]")[8], 1e-5, "heading of the bar");
    assert!(heading > 0.2 && trial.column("rail [m]")[8] < -0.02, "{heading}");
    // A joint without ends has no range.
    let turning = pair("kind = \"joint-torque\"", &[0.5, 0.5], 3, "[[reward]]\nkind = \"steps\"\n");
    let turning = Trial::new(&turning.replace("type=\"revolute\"", "type=\"continuous\""));
    assert_eq!(turning.recording.schema().scalars[0].range, None);
}

/// Turns a vector about the unit axis (1, 2, 2) / 3, by Rodrigues' formula.
fn about_axis(angle: f64, vector: Vector) -> Vector {
    const AXIS: Vector = [1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0];
    let (sine, cosine) = angle.sin_cos();
    let along = dot(AXIS, vector) * (1.0 - cosine);
    let across = cross(AXIS, vector);
    [0, 1, 2].map(|k| cosine * vector[k] + sine * across[k] + along * AXIS[k])
}

fn cross([a, b, c]: Vector, [x, y, z]: Vector) -> Vector {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// A body turned by 30 degrees about z, whose hinge is at (0.3, -0.2, 0.1) with the axis (1, 2, 2). A stiff motor turns
/// it at 0.4 rad/s from the first step on. Its frame is not the one of the hinge.
#[test]
fn bodies_about_skew_axes_are_measured_at_their_frames() {
    const RATE: f64 = 0.4;
    let model = r#"<mujoco><worldbody><body name="arm" pos="0.5 0.2 0.4" euler="0 0 30"><joint name="hinge" pos="0.3 -0.2 0.1" axis="1 2 2"/>
<inertial pos="0.2 0 0.1" mass="0.7" diaginertia="0.2 0.3 0.31"/><geom type="sphere" size="0.05"/></body></worldbody></mujoco>"#;
    let text = format!(
        "world = {{ engine = \"articulated\", floor = false, gravity = [0, 0, 0], time_step = 0.05, substeps = 5 }}\n\
         robot = {{ kind = \"model\", file = \"arm.xml\" }}\nmotors = [{{ kind = \"joint-velocity\", largest = 0.5, gain = 1e7 }}]\n\
         sensors = [{{ kind = \"body-pose\", body = \"arm\" }}, {{ kind = \"body-velocity\", body = \"arm\", axes = \"world\" }}, \
         {{ name = \"own\", kind = \"body-velocity\", body = \"arm\" }}, \
         {{ kind = \"target-position\", target = \"mark\", body = \"arm\", point = [0.1, 0.2, 0.3], scale = 1.5 }}]\n\
         network = {{ kind = \"wired\", bias = [0.9], wires = [] }}\nepisode = {{ steps = 30, trials = 1 }}\n\
         objects = [{{ name = \"mark\", kind = \"marker\", at = [0.9, -0.4, 0.8] }}]\n\
         reward = [{{ kind = \"speed\", body = \"arm\" }}, {{ kind = \"forward\", body = \"arm\" }}, \
         {{ kind = \"progress\", body = \"arm\", along = [0, 1, 0] }}, {{ kind = \"displacement\", body = \"arm\" }}, \
         {{ kind = \"height\", body = \"arm\", point = [0.1, 0.2, 0.3] }}, {{ kind = \"upright\", body = \"arm\" }}, \
         {{ kind = \"distance\", body = \"arm\", object = \"mark\", point = [0.1, 0.2, 0.3] }}]\n\
         [files]\n\"arm.xml\" = '''{model}'''\n"
    );
    let trial = Trial::new(&text);
    let start: Vector = [0.5, 0.2, 0.4];
    let hinge: Vector = [0.3, -0.2, 0.1];
    let outward = |vector| about_z(30_f64.to_radians(), vector);
    let turned = |step: usize, vector| outward(about_axis(RATE * 0.05 * step as f64, vector));
    let spin = [RATE / 3.0, 2.0 * RATE / 3.0, 2.0 * RATE / 3.0];
    // A point of the body after a step.
    let place = |step, point| add(add(start, outward(hinge)), turned(step, minus(point, hinge)));
    let length = |vector: Vector| dot(vector, vector).sqrt();
    let own = cross(spin, hinge.map(|x| -x));
    let (origin, point, mark) = ([0.0; 3], [0.1, 0.2, 0.3], [0.9, -0.4, 0.8]);
    for number in 1..=30_usize {
        let way = minus(place(number, origin), place(number - 1, origin));
        let wanted = [
            ("speed", length(own)),
            ("forward", dot(way, turned(number, [1.0, 0.0, 0.0]))),
            ("progress", way[1]),
            ("displacement", length(minus(place(number, origin), start))),
            ("height", place(number, point)[2]),
            ("upright", turned(number, [0.0, 0.0, 1.0])[2]),
            ("distance", length(minus(place(number, point), mark))),
        ];
        for (kind, wanted) in wanted {
            close(trial.column(kind)[number - 1], wanted, 3e-5, &format!("{kind} after step {number}"));
        }
        let before = number - 1;
        let pose = trial.sensor("body-pose", number);
        all_close(&pose[..3], &place(before, origin), 3e-5, &format!("place in step {number}"));
        // The product of a turn about z and one about the axis, with a positive last part.
        let (z, a) = (15_f64.to_radians().sin_cos(), (0.5 * RATE * 0.05 * before as f64).sin_cos());
        let [x, y, w] = [a.0 / 3.0, 2.0 * a.0 / 3.0, 2.0 * a.0 / 3.0];
        let quaternion = [z.1 * x - z.0 * y, z.1 * y + z.0 * x, z.1 * w + z.0 * a.1, z.1 * a.1 - z.0 * w];
        all_close(&pose[3..], &quaternion, 3e-5, &format!("orientation in step {number}"));
        if number > 1 {
            let (linear, angular) = (turned(before, own), outward(spin));
            let what = format!("velocity in step {number}");
            all_close(&trial.sensor("body-velocity", number), &[linear, angular].concat(), 5e-5, &what);
            all_close(&trial.sensor("own", number), &[own, spin].concat(), 5e-5, &what);
        }
        let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
            .map(|axis| 1.5 * dot(minus(mark, place(before, point)), turned(before, axis)));
        all_close(&trial.sensor("target-position", number), &[x, y, z], 5e-5, &format!("mark in step {number}"));
    }
}

/// The fixed geometry of a model is a floor, too, and is no thing with which the robot collides. A ball of 2 kg rests on it,
/// and one of another name does not touch it.
#[test]
fn fixed_geometry_of_a_model_is_a_floor() {
    let model = r#"<mujoco><worldbody><geom name="slab" type="box" size="2 2 0.1" pos="0 0 0.4"/>
<body name="ball" pos="0.3 0.2 0.599"><joint name="lift" type="slide" axis="0 0 1"/><geom type="sphere" size="0.1" mass="2"/></body>
<body name="high" pos="-0.3 0.2 3"><joint name="pull" type="slide" axis="0 0 1"/><geom type="sphere" size="0.1" mass="0.5"/></body>
</worldbody></mujoco>"#;
    let text = |with: &str| {
        format!(
            "world = {{ engine = \"articulated\", floor = false, gravity = [0, 0, -3.7] }}\nrobot = {{ kind = \"model\", file = \"slab.xml\" }}\n\
             motors = [{{ kind = \"joint-torque\", largest = 1.0 }}]\nsensors = [{{ kind = \"contact-force\", with = \"floor\" }}, \
             {{ name = \"own\", kind = \"contact-force\", bodies = [\"ball\"], with = \"floor\" }}, \
             {{ name = \"far\", kind = \"contact-force\", bodies = [\"high\"]{with} }}]\n\
             network = {{ kind = \"wired\", bias = [0.5, 0.5], wires = [] }}\nepisode = {{ steps = 8, trials = 1, ends = [\"collision\"] }}\n\
             reward = [{{ kind = \"touch\", with = \"floor\" }}, {{ name = \"far\", kind = \"touch\", bodies = [\"high\"], with = \"floor\" }}]\n\
             [files]\n\"slab.xml\" = '''{model}'''\n"
        )
    };
    let trial = Trial::new(&text(", with = \"floor\""));
    assert_eq!(trial.outcome.steps, 8);
    assert_eq!((trial.column("touch")[7], trial.column("far")[7]), (1.0, 0.0));
    assert!(trial.sensor("contact-force", 8)[0] > 1.0 && trial.sensor("own", 8) == trial.sensor("contact-force", 8));
    assert_eq!(trial.sensor("far", 8), [0.0]);
    assert!(refused(&text(", with = \"flour\"")).contains("unknown object `flour`; the nearest is `floor`"));
}

/// A ball falls in rapier by the gravity, control step and dynamics steps of the file: g h^2 n (n + 1) / 2 after n steps
/// of h = 0.01 s, up to single precision.
#[cfg(feature = "rapier")]
#[test]
fn rapier_has_the_steps_of_the_file() {
    let ball = "[[objects]]\nname = \"ball\"\nkind = \"ball\"\nradius = 0.1\nmass = 0.3\nat = [5.0, 0.2, 9.0]\n";
    let rest = format!("{ball}[[reward]]\nkind = \"moved\"\nobject = \"ball\"\n");
    let text = pair("kind = \"joint-torque\"", &[0.5, 0.5], 12, &rest)
        .replace("gravity = [0, 0, 0]", "gravity = [0.0, 1.2, -2.3]");
    for (engine, tolerance) in [("articulated", 1e-5), ("rapier", 1e-4)] {
        let trial = Trial::new(&text.replace("\"articulated\"", &format!("\"{engine}\"")));
        for step in 1..=12 {
            let n = 5.0 * f64::from(step);
            let wanted = f64::hypot(1.2, 2.3) * 1e-4 * n * (n + 1.0) / 2.0;
            close(trial.column("moved")[step as usize - 1], wanted, tolerance, &format!("{engine} after step {step}"));
        }
    }
}
