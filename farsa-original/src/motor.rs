//! Motors.

use crate::channels::{Device, Part};
use crate::remarks::Remarks;

/// Returns the nearest motor of FARSA.
pub(super) fn motor(device: &Device<'_>, remarks: &mut Remarks) -> Option<Part> {
    let Device { group, entry, .. } = *device;
    group.idle(&["khepera", "epuck", "marxbot", "neuronsIterator"], "the robot has all motors", remarks);
    let mut lost = |why: &str| remarks.lost(group, entry, why);
    let part = match &*device.kind {
        "KheperaWheelVelocityMotor" | "EpuckWheelVelocityMotor" | "MarXbotWheelVelocityMotor" => Part::new("wheels", 2),
        "MarXbotWheelVelOrient" => {
            lost("`speed-and-turn` is nearest: there one wheel is slowed by the square of the turn");
            Part::new("speed-and-turn", 2)
        }
        "MarXbotColorMotor" => {
            let why = "`leds` is nearest: a green LED as bright as the output, in place of two colours of the hull";
            lost(why);
            let keys = ["onColor", "offColor", "onThreshold", "offThreshold"];
            group.idle(&keys, "is about what the motor's line tells", remarks);
            Part::new("leds", 1).with("colors", "[\"green\"]")
        }
        "MarXbotAttachmentDeviceMotor" => {
            lost("has one output here, above 1/2 it holds; there another one turns the device");
            group.idle(&["typeOfClosure", "noMotionRange"], "is about what the motor's line tells", remarks);
            Part::new("attachment", 1)
        }
        "FakeMotor" => {
            lost("its outputs go to the plugin's C++ code");
            let keys = ["additionalOutputs", "additionalOutputsResource", "additionalInputsResource"];
            group.idle(&keys, "its motor is left out", remarks);
            return None;
        }
        other => {
            lost(&format!("`{other}` is no motor of the original's wheeled robots; it is left out"));
            return None;
        }
    };
    Some(Part { name: device.name.clone(), wrappers: device.noisy_commands(), ..part })
}
