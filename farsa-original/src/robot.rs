//! The robot.

use farsa_lab::Error;

use crate::ini::Group;
use crate::remarks::Remarks;
use crate::written::Written;

/// Wheeled robots of the 2013 program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RobotKind {
    Khepera,
    EPuck,
    MarXbot,
}

impl RobotKind {
    /// Returns the kind in the experiment file.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Khepera => "khepera",
            Self::EPuck => "e-puck",
            Self::MarXbot => "marxbot",
        }
    }

    /// Returns the number of infrared sensors.
    pub(super) fn infrared(self) -> u64 {
        match self {
            Self::Khepera | Self::EPuck => 8,
            Self::MarXbot => 24,
        }
    }

    /// Returns the number of the infrared sensor that is the first one in the 2013 program.
    pub(super) fn first_infrared(self) -> u64 {
        match self {
            Self::Khepera | Self::EPuck => 0,
            // The program's first is at 97.5 degrees, and number 6 is at 90.
            Self::MarXbot => 6,
        }
    }

    /// Reads the group of a robot.
    ///
    /// # Errors
    /// [`Error::Setting`] and [`Error::Usage`] for a robot without wheels.
    pub(super) fn from_group(file: &str, group: &Group, remarks: &mut Remarks) -> Result<Self, Error> {
        const KNOWN: [&str; 3] = ["Khepera", "Epuck", "MarXbot"];
        let Some((name, entry)) = group.kind(remarks) else {
            return Err(Error::Usage(format!("{file} line {}: [{}] has no `type`", group.line, group.path)));
        };
        // Version 1 has each robot with and without dynamics.
        let robot = match name.strip_prefix("Phy").unwrap_or(&name) {
            "Khepera" => Self::Khepera,
            "Epuck" => Self::EPuck,
            "MarXbot" => Self::MarXbot,
            _ => return Err(Error::unknown(&format!("{file} line {}", entry.line), "wheeled robot", &name, KNOWN)),
        };
        if !group.flag("kinematicRobot", false, remarks) {
            let why = "robots move as kinematics says here, without forces";
            remarks.lost_or_default(group, group.find("kinematicRobot"), ["kinematicRobot", "false"], why);
        }
        group.lost(&[("enableWheels", "true")], "wheels here turn", remarks);
        group.lost(&[("transformation", "")], "a robot stands here where `start` puts it", remarks);
        group.lost(&[("color", "#FFFFFF"), ("ledColors", "")], "hulls here have the colours of their robots", remarks);
        let parts = [
            "enableProximityIR",
            "enableGroundIR",
            "enableGroundBottomIR",
            "enableGroundAroundIR",
            "enableAttachmentDevice",
        ];
        group.idle(&parts, "a robot here has what its sensors and motors ask for", remarks);
        let drawn = [
            "drawProximityIR",
            "drawGroundIR",
            "drawGroundBottomIR",
            "drawGroundAroundIR",
            "drawIRRays",
            "drawIRRaysRange",
        ];
        group.idle(&drawn, "is about what is drawn", remarks);
        group.idle(&["name"], "is a name for the original's code", remarks);
        Ok(robot)
    }

    pub(super) fn write(self, count: u64, out: &mut Written) {
        out.table("[robot]");
        out.word("kind", self.word());
        if count > 1 {
            out.set("count", count);
        }
    }
}
