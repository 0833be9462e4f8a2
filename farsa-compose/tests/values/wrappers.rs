//! Wrappers of sensors, on channels with computed values.

use farsa_num::{Domain, Stream};

use crate::{Trial, all_close, close};

pub(crate) const WRAPPERS: &[&str] =
    &["uniform-noise", "normal-noise", "delay", "scale", "saturate", "threshold", "lesion", "stuck", "drawn", "wave"];

const STEPS: u32 = 12;

/// A robot whose sensor reads the position and quaternion of its straight way: x = 0.6 + 0.01 n in step n + 1, y = 0.9.
fn file(wheels: bool, wrappers: &str) -> String {
    let rest = "[[reward]]\nkind = \"steps\"\n";
    let sensor = format!("[[sensors]]\nkind = \"body-pose\"\nwrappers = [{wrappers}]\n");
    if wheels {
        return format!(
            "world = {{ size = [3.1, 2.3], time_step = 0.1 }}\nrobot = {{ kind = \"e-puck\", speed = 0.2 }}\n\
             motors = [{{ kind = \"wheels\" }}]\nnetwork = {{ kind = \"wired\", bias = [0.75, 0.75], wires = [] }}\n\
             episode = {{ steps = {STEPS}, trials = 1 }}\n\
             start = [{{ place = \"robot\", at = \"fixed\", point = [0.6, 0.9] }}]\n{sensor}{rest}"
        );
    }
    // A sled that a stiff motor moves at 0.1 m/s from its first step on.
    let sled = r#"<robot name="s"><link name="base"/><link name="sled"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="rail" type="prismatic"><parent link="base"/><child link="sled"/><axis xyz="1 0 0"/><limit lower="-5" upper="5" effort="4" velocity="9"/></joint></robot>"#;
    let sensor = sensor.replace("kind = \"body-pose\"", "kind = \"body-pose\"\nbody = \"sled\"");
    format!(
        "world = {{ engine = \"articulated\", floor = false, gravity = [0, 0, 0], time_step = 0.1, substeps = 1 }}\n\
         robot = {{ kind = \"model\", file = \"s.urdf\", base = [0.6, 0.9, 0.0] }}\n\
         motors = [{{ kind = \"joint-velocity\", largest = 0.2, gain = 1e7 }}]\n\
         network = {{ kind = \"wired\", bias = [0.75], wires = [] }}\nepisode = {{ steps = {STEPS}, trials = 1 }}\n\
         {sensor}{rest}[files]\n\"s.urdf\" = '''{sled}'''\n"
    )
}

/// The bare channels in a step, from 1.
fn bare(step: usize) -> [f64; 7] {
    [0.6 + 0.01 * (step - 1) as f64, 0.9, 0.0, 0.0, 0.0, 0.0, 1.0]
}

fn check(wrappers: &str, wanted: &dyn Fn(usize) -> [f64; 7]) {
    for wheels in [true, false] {
        let trial = Trial::new(&file(wheels, wrappers));
        for step in 1..=STEPS as usize {
            let what = format!("{wrappers} in step {step}, on wheels: {wheels}");
            all_close(&trial.sensor("body-pose", step), &wanted(step), 2e-6, &what);
        }
    }
}

#[test]
fn each_wrapper_changes_the_values_of_a_sensor() {
    check("", &bare);
    check("{ kind = \"scale\", gain = -2.0, offset = 0.3 }", &|step| bare(step).map(|x| 0.3 - 2.0 * x));
    check("{ kind = \"saturate\", low = 0.2, high = 0.65 }", &|step| bare(step).map(|x| x.clamp(0.2, 0.65)));
    check("{ kind = \"threshold\", above = 0.655 }", &|step| bare(step).map(|x| f64::from(u8::from(x > 0.655))));
    check("{ kind = \"lesion\" }", &|_| [0.0; 7]);
    check("{ kind = \"lesion\", channels = [1, 4] }", &|step| {
        let [x, _, _, _, _, a, b] = bare(step);
        [x, 0.0, 0.0, 0.0, 0.0, a, b]
    });
    // The first value is repeated until the delay is over.
    check("{ kind = \"delay\", steps = 3 }", &|step| bare(step.saturating_sub(3).max(1)));
    // After four steps the last value is held.
    check("{ kind = \"stuck\", channels = [0, 2], after = 4 }", &|step| bare(step.min(4)));
    check("{ kind = \"stuck\", channels = [0, 1], value = 0.35, after = 4 }", &|step| {
        let [x, y, rest @ ..] = bare(step);
        let [a, b, c, d, e] = rest;
        if step > 4 { [0.35, 0.35, a, b, c, d, e] } else { [x, y, a, b, c, d, e] }
    });
    check("{ kind = \"stuck\" }", &|_| bare(1));
    // The first is applied first: (x - 0.5) * 2, and then a limit of 0.2.
    let order = "{ kind = \"scale\", gain = 2.0, offset = -1.0 }, { kind = \"saturate\", low = -5.0, high = 0.2 }";
    check(order, &|step| bare(step).map(|x| (2.0 * x - 1.0).min(0.2)));
}

/// Noise is the stream of the episode's sensors, wrapper by wrapper from the outer one, with 8 words for each step and
/// channel. The motors of an equal wrapper have another stream.
#[test]
fn noise_is_added_from_streams_of_its_own() {
    let outer = "{ kind = \"normal-noise\", deviation = 0.03 }";
    let inner = "{ kind = \"uniform-noise\", amplitude = 0.2 }";
    for wheels in [true, false] {
        let trial = Trial::new(&file(wheels, &format!("{inner}, {outer}")));
        let mut first = Stream::new(0, Domain::Sensor, 0, 0, 0);
        let mut second = first;
        second.seek(8 * u64::from(STEPS) * 7);
        for step in 1..=STEPS as usize {
            let wanted = bare(step).map(|x| {
                let (normal, uniform) = (f64::from(first.normal()), f64::from(second.uniform()));
                x + 0.2 * (2.0 * uniform - 1.0) + 0.03 * normal
            });
            all_close(&trial.sensor("body-pose", step), &wanted, 3e-6, &format!("noise in step {step}"));
        }
    }
}

/// Over many draws, uniform noise has the mean 0 and the variance a^2 / 3, and normal noise that of its deviation.
#[test]
fn noise_has_its_spread() {
    for (wrapper, variance, largest) in [
        ("{ kind = \"uniform-noise\", amplitude = 0.3 }", 0.03, 0.3),
        ("{ kind = \"normal-noise\", deviation = 0.3 }", 0.09, 2.0),
    ] {
        let text = file(true, wrapper).replace(&format!("steps = {STEPS}"), "steps = 4000");
        let trial = Trial::new(&text.replace("[0.75, 0.75]", "[0.5, 0.5]"));
        let off: Vec<f64> = (1..=4000).flat_map(|step| trial.sensor("body-pose", step)).collect();
        let off: Vec<f64> = off.iter().zip(bare(1).iter().cycle()).map(|(found, bare)| found - bare).collect();
        let count = off.len() as f64;
        // Five standard errors of the mean, and about as much of the variance.
        let mean = off.iter().sum::<f64>() / count;
        close(mean, 0.0, 5.0 * (variance / count).sqrt(), "mean");
        close(off.iter().map(|x| x * x).sum::<f64>() / count, variance, 0.05 * variance, "variance");
        assert!(off.iter().all(|x| x.abs() <= largest + 1e-6), "{wrapper}");
    }
}

/// Noise of a motor changes the speed of the wheels, by the stream of motors.
#[test]
fn noise_of_motors_has_another_stream() {
    let noisy = "{ kind = \"wheels\", wrappers = [{ kind = \"uniform-noise\", amplitude = 0.2 }] }";
    let text = file(true, "")
        .replace("{ kind = \"wheels\" }", noisy)
        .replace("kind = \"body-pose\"", "kind = \"wheel-speed\"");
    let trial = Trial::new(&text);
    let mut stream = Stream::new(0, Domain::Motor, 0, 0, 0);
    for step in 2..=STEPS as usize {
        let wanted = [0, 1].map(|_| 0.75 + 0.2 * (2.0 * f64::from(stream.uniform()) - 1.0));
        all_close(&trial.sensor("wheel-speed", step), &wanted, 1e-5, &format!("wheels in step {step}"));
    }
}
