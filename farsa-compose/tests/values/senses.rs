//! Sensors of robots on wheels, as they are read before each step.

use std::fmt::Write as _;

use crate::wheels::{HEADING, HULL, LAMP, LAMP_RADIUS, OUTPUTS, SPEED, START, TIME_STEP, TRACK, WHEEL, file, step};
use crate::{Trial, all_close, close, distance, refused, yes};

/// Directions of the infrared sensors of an e-puck [deg].
pub(crate) const RING: [f64; 8] = [90.0, 54.0, 18.0, -18.0, -54.0, -90.0, -150.0, 150.0];

/// Kinds with a value in this file, in `teams.rs` or in `wheels.rs`.
pub(crate) const SENSORS: &[&str] = &[
    "infrared",
    "light",
    "ground-color",
    "laser-distance",
    "camera",
    "wheel-speed",
    "traction",
    "signal",
    "attachment",
    "touch",
    "contact-force",
    "target-position",
    "body-pose",
    "body-velocity",
    "height",
    "joint-position",
    "joint-speed",
    "energy",
    "carried",
    "constant",
    "orientation",
    "up",
];

const STEPS: &str = "[[reward]]\nkind = \"steps\"\n";

pub(crate) fn along(angle: f64) -> [f64; 2] {
    [angle.cos(), angle.sin()]
}

pub(crate) fn ahead(from: [f64; 2], direction: [f64; 2], far: f64) -> [f64; 2] {
    [from[0] + far * direction[0], from[1] + far * direction[1]]
}

/// Turns a vector into the axes of a robot with this heading.
fn inward(heading: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    let (s, c) = heading.sin_cos();
    [c * x + s * y, c * y - s * x]
}

#[test]
fn sensors_of_motion_read_the_motion() {
    let sensors = "[[sensors]]\nkind = \"wheel-speed\"\n\
        [[sensors]]\nname = \"signed\"\nkind = \"wheel-speed\"\nsigned = true\n\
        [[sensors]]\nkind = \"target-position\"\ntarget = \"lamp\"\nscale = 4.0\n\
        [[sensors]]\nname = \"outside\"\nkind = \"target-position\"\ntarget = \"lamp\"\naxes = \"world\"\nscale = -0.5\n\
        [[sensors]]\nkind = \"body-pose\"\n[[sensors]]\nkind = \"body-velocity\"\n\
        [[sensors]]\nname = \"drift\"\nkind = \"body-velocity\"\naxes = \"world\"\n[[sensors]]\nkind = \"height\"\n\
        [[sensors]]\nkind = \"joint-position\"\nfrom = -1.0\nto = 4.0\n\
        [[sensors]]\nname = \"right\"\nkind = \"joint-position\"\njoints = [\"right-wheel\"]\nfrom = 3.0\nto = 1.0\n\
        [[sensors]]\nkind = \"joint-speed\"\njoints = [\"right-wheel\", \"left-wheel\"]\n\
        [[sensors]]\nkind = \"constant\"\nvalue = -0.45\n[[sensors]]\nkind = \"touch\"\n[[sensors]]\nkind = \"contact-force\"\n\
        [[sensors]]\nkind = \"traction\"\nlargest = 0.3\n\
        [[sensors]]\nkind = \"orientation\"\n[[sensors]]\nkind = \"up\"\n";
    let trial = Trial::new(&file(OUTPUTS, sensors, STEPS));
    // Shares 0.8 and 0.4 of the greatest speed.
    let [left, right] = [0.8, 0.4].map(|share| share * SPEED / WHEEL);
    for number in 1..=20_usize {
        let (robot, moves) = (step(number - 1), yes(number > 1));
        let sensor = |name: &str, wanted: &[f64]| {
            all_close(&trial.sensor(name, number), wanted, 1e-5, &format!("{name} in step {number}"));
        };
        sensor("wheel-speed", &[0.5 + 0.4 * moves, 0.5 + 0.2 * moves]);
        sensor("signed", &[0.8 * moves, 0.4 * moves]);
        let way = [LAMP[0] - robot.at[0], LAMP[1] - robot.at[1]];
        let [x, y] = inward(robot.heading, way);
        sensor("target-position", &[4.0 * x, 4.0 * y, 0.0]);
        sensor("outside", &[-0.5 * way[0], -0.5 * way[1], 0.0]);
        // The fourth part of the quaternion is not negative.
        let half = 0.5 * robot.heading;
        let sign = if half.cos() < 0.0 { -1.0 } else { 1.0 };
        sensor("body-pose", &[robot.at[0], robot.at[1], 0.0, 0.0, 0.0, sign * half.sin(), sign * half.cos()]);
        let (speed, turn) = (0.5 * (0.8 + 0.4) * SPEED * moves, (0.4 - 0.8) * SPEED / TRACK * moves);
        sensor("body-velocity", &[speed, 0.0, 0.0, 0.0, 0.0, turn]);
        let [u, v] = along(robot.heading);
        sensor("drift", &[speed * u, speed * v, 0.0, 0.0, 0.0, turn]);
        sensor("height", &[0.0]);
        let angles = [left, right].map(|speed| speed * TIME_STEP * (number - 1) as f64);
        sensor("joint-position", &angles.map(|angle| (angle + 1.0) / 5.0));
        sensor("right", &[(angles[1] - 3.0) / -2.0]);
        sensor("joint-speed", &[right * moves, left * moves]);
        sensor("constant", &[-0.45]);
        sensor("touch", &[0.0]);
        sensor("contact-force", &[0.0]);
        sensor("traction", &[0.0, 0.0]);
        sensor("orientation", &[0.0, 0.0, sign * half.sin(), sign * half.cos()]);
        sensor("up", &[0.0, 0.0, 1.0]);
    }
    assert!(
        refused(&file(OUTPUTS, "[[sensors]]\nkind = \"joint-position\"\n", STEPS)).contains("lacks the key `from`")
    );
}

/// An intensity of 0.7 cos(a) (0.06 / d)^2 from the place of each sensor on the hull.
#[test]
fn light_falls_with_distance_and_angle() {
    let trial = Trial::new(&file(OUTPUTS, "[[sensors]]\nkind = \"light\"\nreference = 0.06\n", STEPS));
    let mut brightest: f64 = 0.0;
    for number in 1..=20 {
        let robot = step(number - 1);
        let wanted = RING.map(|degrees| {
            let axis = along(robot.heading + degrees.to_radians());
            let place = ahead(robot.at, axis, HULL);
            let far = distance(place, LAMP);
            let cosine = ((LAMP[0] - place[0]) * axis[0] + (LAMP[1] - place[1]) * axis[1]) / far;
            0.7 * cosine.max(0.0) * (0.06 / far) * (0.06 / far)
        });
        brightest = wanted.iter().copied().fold(brightest, f64::max);
        all_close(&trial.sensor("light", number), &wanted, 1e-5, &format!("light in step {number}"));
    }
    assert!((0.2..1.0).contains(&brightest), "{brightest}");
}

/// The yard, the pond and the rest of the ground have three colors of which no two have an equal part or mean.
#[test]
fn the_ground_is_read_at_each_place() {
    let sensors = "[[sensors]]\nkind = \"ground-color\"\n[[sensors]]\nname = \"rgb\"\nkind = \"ground-color\"\nrgb = true\nfirst = 2\n\
        [[sensors]]\nname = \"middle\"\nkind = \"ground-color\"\nmiddle = true\n";
    let trial = Trial::new(&file(OUTPUTS, sensors, STEPS));
    let color = |[x, y]: [f64; 2]| {
        let [u, v] = inward(25_f64.to_radians(), [x - 0.9, y - 0.58]);
        if u.abs() <= 0.11 && v.abs() <= 0.03 {
            [0.1, 0.3, 0.8]
        } else if distance([x, y], [0.95, 0.5]) <= 0.05 {
            [0.4, 0.6, 0.3]
        } else {
            [0.9, 0.7, 0.2]
        }
    };
    let gray = |color: [f64; 3]| color.iter().sum::<f64>() / 3.0;
    let mut differ = 0;
    for number in 1..=20 {
        let robot = step(number - 1);
        let place = |y: f64| {
            let (front, left) = (along(robot.heading), along(robot.heading + 0.5 * std::f64::consts::PI));
            ahead(ahead(robot.at, front, 0.03), left, y)
        };
        let places = [0.01, 0.0, -0.01].map(|y| color(place(y)));
        differ += usize::from(places[0] != places[1]) + usize::from(places[1] != places[2]);
        let what = |name: &str| format!("{name} in step {number}");
        all_close(&trial.sensor("ground-color", number), &places.map(gray), 1e-6, &what("ground-color"));
        let [[a, b, c], [d, e, f], _] = places;
        all_close(&trial.sensor("rgb", number), &[a, b, c, d, e, f], 1e-6, &what("rgb"));
        all_close(&trial.sensor("middle", number), &[gray(color(robot.at))], 1e-6, &what("middle"));
    }
    assert!(differ > 1, "places have different colors: {differ}");
}

/// Distance along a ray to a circle, if they intersect.
fn to_circle(from: [f64; 2], direction: [f64; 2], center: [f64; 2], radius: f64) -> Option<f64> {
    let way = [center[0] - from[0], center[1] - from[1]];
    let near = way[0] * direction[0] + way[1] * direction[1];
    let aside = way[0] * direction[1] - way[1] * direction[0];
    (near > 0.0 && aside.abs() < radius).then(|| near - (radius * radius - aside * aside).sqrt())
}

/// Beams from left to right: 75, 37.5, 0, -37.5 and -75 degrees.
#[test]
fn lasers_and_cameras_see_the_lamp_where_it_is() {
    let sensors = "[[sensors]]\nkind = \"laser-distance\"\nbeams = 5\nfield_of_view = 150\nrange = 0.22\n\
        [[sensors]]\nname = \"one\"\nkind = \"laser-distance\"\nbeams = 1\nfield_of_view = 90\nrange = 0.22\n\
        [[sensors]]\nkind = \"camera\"\nfield_of_view = 96\nsectors = 3\nrays = 7\nrange = 1.2\n\
        colors = [{ name = \"blue\", low = [0, 0, 0.5], high = [0.3, 0.3, 1] }, { name = \"red\", low = [0.7, 0.1, 0], high = [0.9, 0.3, 0.2] }]\n";
    let trial = Trial::new(&file(OUTPUTS, sensors, STEPS));
    let (mut hits, mut shares) = (0, 0.0);
    for number in 1..=20 {
        let robot = step(number - 1);
        let beam = |degrees: f64| {
            let direction = along(robot.heading + degrees.to_radians());
            let found = to_circle(ahead(robot.at, direction, HULL), direction, LAMP, LAMP_RADIUS);
            found.map_or(1.0, |far| (far / 0.22).min(1.0))
        };
        let wanted = [75.0, 37.5, 0.0, -37.5, -75.0].map(beam);
        hits += wanted.iter().filter(|far| **far < 1.0).count();
        all_close(&trial.sensor("laser-distance", number), &wanted, 2e-5, &format!("laser in step {number}"));
        all_close(&trial.sensor("one", number), &[wanted[2]], 2e-5, &format!("one laser in step {number}"));
        // 21 rays in the middles of parts of 96 / 21 degrees, and two colors for each sector.
        let mut camera = [0.0; 6];
        for ray in 0..21 {
            let degrees = 48.0 - 96.0 * (f64::from(ray) + 0.5) / 21.0;
            let seen = to_circle(robot.at, along(robot.heading + degrees.to_radians()), LAMP, LAMP_RADIUS).is_some();
            camera[2 * (ray as usize / 7) + 1] += yes(seen) / 7.0;
        }
        shares += camera.iter().sum::<f64>();
        all_close(&trial.sensor("camera", number), &camera, 1e-6, &format!("camera in step {number}"));
    }
    assert!(hits > 2 && shares > 1.0, "{hits} beams and {shares} of sectors");
}

/// A robot at rest 0.055 m from the wall x = 0, so its hull is 0.02 m away. The wall is 143 degrees to the left of ahead.
#[test]
fn infrared_sensors_read_a_wall() {
    let table = "8 4 1 0 50\nTURN 0\n512 64 512 64 512 64 0 0\n0 256 0 256 0 256 0 256\n\
        16 32 48 80 96 112 128 144\n256 0 256 0 256 0 256 0\nEND\n";
    let sensors = "[[sensors]]\nname = \"formula\"\nkind = \"infrared\"\n\
        [[sensors]]\nname = \"some\"\nkind = \"infrared\"\nfirst = 3\n\
        [[sensors]]\nname = \"rays\"\nkind = \"infrared\"\nmodel = \"rays\"\n\
        [[sensors]]\nname = \"groups\"\nkind = \"infrared\"\nmodel = \"rays\"\ngroups = 4\n\
        [[sensors]]\nname = \"tables\"\nkind = \"infrared\"\nmodel = \"tables\"\ntables = { walls = \"wall.sam\" }\n";
    let text = file([0.5, 0.5, 0.2], sensors, STEPS).replace(&format!("point = {START:?}"), "point = [0.055, 1.2]");
    let trial = Trial::new(&format!("{text}[files]\n\"wall.sam\" = '''{table}'''\n"));
    // (0.033 - 0.02) / (0.033 - 0.013) of the greatest response, and the square of the share of the cosine above that
    // of 50 degrees.
    let edge = 50_f64.to_radians().cos();
    let formula = RING.map(|degrees| {
        let cosine = (degrees - 143.0_f64).to_radians().cos();
        0.65 * ((cosine - edge) / (1.0 - edge)).max(0.0).powi(2)
    });
    all_close(&trial.sensor("formula", 1), &formula, 1e-5, "formula");
    assert!(formula.iter().filter(|x| **x > 0.01).count() >= 1);
    all_close(&trial.sensor("some", 1), &formula[..3], 1e-5, "the first three");
    // Five rays within 10 degrees, from one point of the hull. The nearest hit counts, up to 0.05 m.
    let rays = RING.map(|degrees| {
        let place = ahead([0.055, 1.2], along((HEADING + degrees).to_radians()), HULL);
        let hits = [-10.0, -5.0, 0.0, 5.0, 10.0].map(|off: f64| {
            let cosine = (HEADING + degrees + off).to_radians().cos();
            if cosine < 0.0 { place[0] / -cosine } else { f64::INFINITY }
        });
        1.0 - hits.into_iter().fold(0.05, f64::min) / 0.05
    });
    all_close(&trial.sensor("rays", 1), &rays, 1e-4, "rays");
    assert!(rays.iter().filter(|x| **x > 0.05).count() >= 2, "{rays:?}");
    // The middles of groups of two are the sensors 1, 3, 5 and 7. The other of a group is the one before.
    let groups = [[7, 0], [1, 2], [3, 4], [5, 6]].map(|[a, b]: [usize; 2]| rays[a].max(rays[b]));
    all_close(&trial.sensor("groups", 1), &groups, 1e-4, "groups");
    // 217 degrees clockwise are in the third of four rows. Readings are divided by 1024.
    let row = [16.0, 32.0, 48.0, 80.0, 96.0, 112.0, 128.0, 144.0].map(|x: f64| x / 1024.0);
    all_close(&trial.sensor("tables", 1), &row, 1e-6, "tables");
}

/// The strongest or mean signal of each sector: ahead, left, behind and right. A robot signals 0.1 + 0.3 x of its place.
#[test]
fn signals_are_heard_by_sector() {
    let text = |rest: &str| {
        format!(
            "world = {{ size = [3.1, 2.3] }}\nrobot = {{ kind = \"e-puck\", count = 4 }}\n\
             motors = [{{ kind = \"wheels\" }}, {{ kind = \"signal\" }}]\nepisode = {{ steps = 3, trials = 1 }}\n\
             [[sensors]]\nkind = \"body-pose\"\n\
             [[sensors]]\nname = \"four\"\nkind = \"signal\"\nrange = 0.8\n\
             [[sensors]]\nname = \"mean\"\nkind = \"signal\"\nrange = 0.8\nsectors = 2\nmean = true\n\
             [[sensors]]\nname = \"any\"\nkind = \"signal\"\nrange = 0.3\nsectors = 1\n\
             [[sensors]]\nname = \"eight\"\nkind = \"signal\"\nrange = 5.0\nsectors = 8\n\
             [network]\nkind = \"wired\"\nbias = [0.5, 0.5, 0.1]\n\
             wires = [{{ from = [\"body-pose 1\"], to = \"signal\", weight = 0.3 }}]\n{rest}{STEPS}"
        )
    };
    // By direction from the first robot, which heads at 37 degrees: 20 left of ahead, 50 left, and 150 left but far away.
    let at = [0.9, 0.8];
    let others = [(20.0, 0.5), (50.0, 0.28), (150.0, 0.9)];
    let places = others.map(|(degrees, far): (f64, f64)| ahead(at, along((HEADING + degrees).to_radians()), far));
    let mut starts = String::new();
    for (number, point) in [at, places[0], places[1], places[2]].iter().enumerate() {
        let _ = writeln!(
            starts,
            "[[start]]\nplace = \"robot-{}\"\nat = \"fixed\"\npoint = {point:?}\nheading = {HEADING}",
            number + 1
        );
    }
    let trial = Trial::new(&text(&starts));
    let signal = places.map(|[x, _]| 0.1 + 0.3 * x);
    // The hull of the third is 0.245 m from the middle of the first.
    all_close(&trial.sensor("four", 3), &[signal[0], signal[1], 0.0, 0.0], 1e-5, "four sectors");
    all_close(&trial.sensor("mean", 3), &[0.5 * (signal[0] + signal[1]), 0.0], 1e-5, "mean of halves");
    all_close(&trial.sensor("any", 3), &[signal[1]], 1e-5, "near");
    let eight = [signal[0], signal[1], 0.0, signal[2], 0.0, 0.0, 0.0, 0.0];
    all_close(&trial.sensor("eight", 3), &eight, 1e-5, "eighths");
    assert_eq!(trial.sensor("four", 1), [0.0; 4], "nothing is sent before the first step");
    close(trial.column("output.signal")[0], 0.1 + 0.3 * at[0], 1e-6, "own signal");
}

/// Beams 0.05 m high end at things of 0.1 m, and those 0.15 m high pass over them. The gaps are 0.2 m less half the size.
#[test]
fn beams_pass_over_low_things() {
    for (object, gap) in [
        ("kind = \"wall\"\nsize = [0.02, 0.4]\nheight = 0.1\n", 0.2 - 0.01 - HULL),
        ("kind = \"cylinder\"\nradius = 0.03\nheight = 0.1\n", 0.2 - 0.03 - HULL),
    ] {
        let sensor = |name: &str, height: f64| {
            format!(
                "[[sensors]]\nname = \"{name}\"\nkind = \"laser-distance\"\nbeams = 1\nfield_of_view = 10\nrange = 0.5\nheight = {height}\n"
            )
        };
        let text = format!(
            "world = {{ size = [3.1, 2.3] }}\nrobot = {{ kind = \"e-puck\" }}\nmotors = [{{ kind = \"wheels\" }}]\n\
             network = {{ kind = \"wired\", bias = [0.5, 0.5], wires = [] }}\nepisode = {{ steps = 1, trials = 1 }}\n\
             start = [{{ place = \"robot\", at = \"fixed\", point = [1.0, 1.0] }}]\n{STEPS}\
             [[objects]]\nname = \"bar\"\nat = [1.2, 1.0]\n{object}{}{}",
            sensor("low", 0.05),
            sensor("high", 0.15)
        );
        let trial = Trial::new(&text);
        close(trial.sensor("low", 1)[0], gap / 0.5, 1e-5, object);
        assert_eq!(trial.sensor("high", 1), [1.0], "{object}");
    }
}

/// A camera sees a robot by the color of its group, or else by its own.
#[test]
fn groups_have_their_colors() {
    let text = "world = { size = [3.1, 2.3] }\nmotors = [{ kind = \"wheels\" }]\n\
        robots = [{ name = \"a\", kind = \"e-puck\" }, { name = \"b\", kind = \"e-puck\", color = [0.6, 0.1, 0.8] }]\n\
        network = { kind = \"wired\", bias = [0.5, 0.5], wires = [] }\nepisode = { steps = 1, trials = 1 }\n\
        sensors = [{ kind = \"camera\", field_of_view = 6, sectors = 1, rays = 1, range = 1.0, colors = [\
        { name = \"own\", low = [0.05, 0.35, 0.05], high = [0.15, 0.45, 0.15] }, \
        { name = \"group\", low = [0.55, 0.05, 0.75], high = [0.65, 0.15, 0.85] }] }]\n\
        start = [{ place = \"a\", at = \"fixed\", point = [1.0, 1.0] }, { place = \"b\", at = \"fixed\", point = [1.3, 1.0], heading = 180 }]\n";
    let text = format!("{text}{STEPS}");
    assert_eq!(Trial::new(&text).sensor("camera", 1), [0.0, 1.0]);
    assert_eq!(Trial::new(&text.replace(", color = [0.6, 0.1, 0.8]", "")).sensor("camera", 1), [1.0, 0.0]);
}
