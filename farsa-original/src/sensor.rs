//! Sensors.

use crate::channels::{Device, Part, Selection};
use crate::ini::Group;
use crate::remarks::Remarks;
use crate::robot::RobotKind;
use crate::written::{number, numbers};

/// Names of resources that connect devices.
const RESOURCES: [&str; 5] = ["khepera", "epuck", "marxbot", "neuronsIterator", "arena"];
/// Keys of drawings.
const DRAWN: [&str; 5] = ["drawCamera", "drawSensors", "drawRays", "drawRaysRange", "drawSensor"];
/// Range of a camera without limit [m].
const ENDLESS: f64 = 1000.0;

/// A converted sensor.
struct Made {
    part: Part,
    /// Least and greatest value.
    range: [f64; 2],
    /// Wrapper before the noise.
    scale: Option<String>,
    selection: Selection,
}

impl Made {
    fn new(part: Part) -> Self {
        Self { part, range: [0.0, 1.0], scale: None, selection: Selection::default() }
    }

    /// Inverts the values: 1 minus the reading.
    fn inverted(self) -> Self {
        Self { scale: Some("{ kind = \"scale\", gain = -1.0, offset = 1.0 }".into()), ..self }
    }
}

/// Returns the nearest sensor of FARSA.
pub(super) fn sensor(device: &Device<'_>, robot: RobotKind, remarks: &mut Remarks) -> Option<Part> {
    let Device { group, entry, .. } = *device;
    group.idle(&RESOURCES, "the sensors of a robot know it", remarks);
    let made = match &*device.kind {
        "KheperaProximityIRSensor" | "EpuckProximityIRSensor" | "MarXbotProximityIRSensor" => {
            infrared(device, robot, "rays", remarks)
        }
        "KheperaSampledProximityIRSensor" | "EpuckSampledProximityIRSensor" | "MarXbotSampledProximityIRSensor" => {
            let why = "the tables that were measured are to be named by hand (`tables`); without them `infrared` computes readings by a formula";
            remarks.lost(group, entry, why);
            group.idle(
                &["roundSamples", "smallSamples", "wallSamples"],
                "is about what the sensor's line tells",
                remarks,
            );
            let why = "means of neighbouring sensors have no words here; each reads for itself";
            group.lost(&[("averageNum", "0")], why, remarks);
            infrared(device, robot, "analytic", remarks)
        }
        "KheperaSampledLightSensor" => {
            let why = "tables that were measured have no words here; `light` computes readings by a formula";
            remarks.lost(group, entry, why);
            group.idle(&["lightSamples"], "is about what the sensor's line tells", remarks);
            let selection = Selection::from_group(group, [8, 0], remarks);
            Made { selection, ..Made::new(Part::new("light", robot.infrared())) }
        }
        // The reading is 1 above black.
        "KheperaGroundSensor" => Made::new(Part::new("ground-color", 1).with("first", 1)).inverted(),
        "EpuckGroundIRSensor" => Made::new(Part::new("ground-color", 3).with("first", 3)),
        "MarXbotGroundBottomIRSensor" => {
            let made = Made::new(Part::new("ground-color", 4).with("first", 4));
            if group.flag("invertActivation", false, remarks) { made.inverted() } else { made }
        }
        "MarXbotGroundAroundIRSensor" => {
            remarks.lost(
                group,
                entry,
                "`ground-color` has the four sensors within before the eight around; they read 0",
            );
            let selection = Selection { first: 0, silent: vec![[0, 3]] };
            Made { selection, ..Made::new(Part::new("ground-color", 12)) }
        }
        "KheperaWheelSpeedsSensor" | "MarXbotWheelSpeedsSensor" => {
            let why = "the difference from what was wanted has no word here; the speeds themselves are read";
            group.lost(&[("mode", "absolute")], why, remarks);
            Made { range: [-1.0, 1.0], ..Made::new(Part::new("wheel-speed", 2).with("signed", true)) }
        }
        "EpuckLinearCameraSensor" | "MarXbotLinearCameraSensor" | "MarXbotLinearCameraSensorNew" => {
            camera(device, remarks)
        }
        "MarXbotTractionSensor" => {
            let why = "`traction` is nearest: two signed differences of speed where there are four shares of a force";
            remarks.lost(group, entry, why);
            group.idle(&["maxForce", "minForce"], "is about what the sensor's line tells", remarks);
            Made { range: [-1.0, 1.0], ..Made::new(Part::new("traction", 2).with("largest", number(0.27))) }
        }
        "MarXbotAttachmentDeviceSensor" => {
            remarks.lost(group, entry, "`attachment` is nearest: whether something is held, and nothing else");
            let keys = ["enablePosition", "enableStatus", "enableAttached", "enableOtherAttached"];
            group.idle(&keys, "is about what the sensor's line tells", remarks);
            Made::new(Part::new("attachment", 1))
        }
        "MarXbotLaserFrontDistanceSensor" => {
            laser(group, 3, group.number("aperture", 60.0, 0.0..=360.0, remarks), remarks)
        }
        "MarXbotLaserOmniDistanceSensor" => {
            let why = "beams go from left to right here, from behind to behind; there the three in front come first";
            remarks.lost(group, entry, why);
            group.lost(&[("averageSensors", "false")], "each beam is read for itself", remarks);
            laser(group, 6, 300.0, remarks)
        }
        "FakeSensor" => {
            remarks.lost(group, entry, "its inputs come from the plugin's C++ code");
            group.idle(&["additionalInputs", "additionalInputsResource"], "its sensor is left out", remarks);
            return None;
        }
        other => {
            let why = format!("`{other}` is no sensor of the original's wheeled robots; it is left out");
            remarks.lost(group, entry, &why);
            return None;
        }
    };
    group.idle(&DRAWN, "is about what is drawn", remarks);
    let Made { part, range, scale, selection } = made;
    let noise = device.noisy_values(range);
    let wrappers = scale.into_iter().chain(noise).chain(selection.lesions()).collect();
    Some(Part { name: device.name.clone(), wrappers, ..part })
}

/// Converts infrared sensors.
fn infrared(device: &Device<'_>, robot: RobotKind, model: &str, remarks: &mut Remarks) -> Made {
    let (count, turn) = (robot.infrared(), robot.first_infrared());
    if turn > 0 {
        let why =
            "the sensors are counted from ahead here and from the left there, where each is half a step farther on";
        remarks.lost(device.group, device.entry, why);
    }
    let selection = Selection::from_group(device.group, [count, turn], remarks);
    let channels = selection.first;
    let mut part = Part::new("infrared", channels);
    if model != "analytic" {
        part = part.with("model", format!("\"{model}\""));
    }
    if channels < count {
        part = part.with("first", channels);
    }
    Made { selection, ..Made::new(part) }
}

/// Converts a camera with up to three colors.
fn camera(device: &Device<'_>, remarks: &mut Remarks) -> Made {
    let Device { group, entry, .. } = *device;
    let why = "a channel of `camera` is the share of a sector in a colour, sector by sector; there it is a mean brightness, \
               colour by colour";
    remarks.lost(group, entry, why);
    let receptors = group.whole("numReceptors", 8, 1..=300, remarks);
    let view = group.number("aperture", 360.0, 1.0..=360.0, remarks);
    let range = match group.find("maxDistance").map(|entry| &*entry.value) {
        Some("inf" | "+inf") => {
            group.idle(&["maxDistance"], "is the original's default, and so it is here", remarks);
            ENDLESS
        }
        _ => group.number("maxDistance", ENDLESS, 0.001..=ENDLESS, remarks),
    };
    group.lost(&[("receptorsRanges", "")], "sectors here are alike, from left to right", remarks);
    group.lost(&[("ignoreWalls", "false")], "cameras here see walls", remarks);
    let mut colors = Vec::new();
    let of_epuck = device.kind == "EpuckLinearCameraSensor";
    for (channel, (key, name)) in
        [("useRedChannel", "red"), ("useGreenChannel", "green"), ("useBlueChannel", "blue")].into_iter().enumerate()
    {
        if of_epuck || group.flag(key, true, remarks) {
            let low = [0, 1, 2].map(|other| if other == channel { 0.5 } else { 0.0 });
            colors.push(format!("{{ name = \"{name}\", low = {}, high = [1.0, 1.0, 1.0] }}", numbers(&low)));
        }
    }
    let channels = receptors * colors.len() as u64;
    let part = Part::new("camera", channels)
        .with("field_of_view", number(view))
        .with("sectors", receptors)
        .with("range", number(range))
        .with("colors", format!("[{}]", colors.join(", ")));
    Made::new(part)
}

/// Converts laser range finders, which read 1 at the hull.
fn laser(group: &Group, beams: u64, view: f64, remarks: &mut Remarks) -> Made {
    let range = group.number("maxDistance", 1.0, 0.001..=1000.0, remarks);
    let part = Part::new("laser-distance", beams)
        .with("beams", beams)
        .with("field_of_view", number(view))
        .with("range", number(range));
    Made::new(part).inverted()
}
