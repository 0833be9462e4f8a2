//! The robot.

use farsa_lab::Error;

use crate::ini::Group;
use crate::remarks::Remarks;
use crate::written::Written;

/// The original's wheeled robots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RobotKind {
    Khepera,
    EPuck,
    MarXbot,
}

impl RobotKind {
    /// Its word here.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Khepera => "khepera",
            Self::EPuck => "e-puck",
            Self::MarXbot => "marxbot",
        }
    }

    /// How many infrared sensors it has.
    pub(super) fn infrared(self) -> u64 {
        match self {
            Self::Khepera | Self::EPuck => 8,
            Self::MarXbot => 24,
        }
    }

    /// The number here of the infrared sensor that is the first one there.
    pub(super) fn first_infrared(self) -> u64 {
        match self {
            Self::Khepera | Self::EPuck => 0,
            // The original's is at 97.5 degrees, number 6 here at 90.
            Self::MarXbot => 6,
        }
    }

    /// Reads the group of a robot.
    ///
    /// # Errors
    /// [`Error::Unknown`] and [`Error::Usage`] for one that is none of the wheeled robots.
    pub(super) fn from_group(file: &str, group: &Group, remarks: &mut Remarks) -> Result<Self, Error> {
        const KNOWN: [&str; 3] = ["Khepera", "Epuck", "MarXbot"];
        let Some((name, entry)) = group.kind(remarks) else {
            return Err(Error::Usage(format!("{file} line {}: [{}] has no `type`", group.line, group.path)));
        };
        // Version 1 has each of them with and without the simulation of its body.
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
