//! Motors of robots in an arena.

use crate::arena::ArenaWorld;
use farsa_body::ChannelError;
use farsa_body::motors::{AttachmentMotor, Leds, SignalMotor, SpeedAndTurn, WheelVelocity};
use farsa_body::ports::{ActuatorId, Channels, Motor};
use farsa_body::robots::{MobileParts, MobileRobot};
use farsa_lab::Error;

use crate::arena::registered::{self, PartOfPlanar, RegisteredMotor};
use crate::arena::scene::Scene;
use crate::check::source::Source;
use crate::document::{Led, MotorKind};

/// A motor of a robot in a plane.
#[derive(Clone, Debug)]
pub(crate) enum Driving {
    Wheels(WheelVelocity),
    /// The flag forbids driving backwards.
    SpeedAndTurn(SpeedAndTurn, bool),
    Led(Leds<ActuatorId, 1>),
    TwoLeds(Leds<ActuatorId, 2>),
    Leds(Leds<ActuatorId, 3>),
    Signal(SignalMotor),
    Attachment(AttachmentMotor),
    Nothing(Nothing),
    Registered(RegisteredMotor),
}

/// Calls a method of the motor of any kind.
macro_rules! motor {
    ($driving:expr, $motor:ident => $call:expr) => {
        match $driving {
            Driving::Wheels($motor) => $call,
            Driving::SpeedAndTurn($motor, _) => $call,
            Driving::Led($motor) => $call,
            Driving::TwoLeds($motor) => $call,
            Driving::Leds($motor) => $call,
            Driving::Signal($motor) => $call,
            Driving::Attachment($motor) => $call,
            Driving::Nothing($motor) => $call,
            Driving::Registered($motor) => $call,
        }
    };
}

impl Channels for Driving {
    fn channels(&self) -> usize {
        motor!(self, motor => motor.channels())
    }

    fn reset(&mut self) {
        motor!(self, motor => motor.reset());
    }
}

impl<W: ArenaWorld> Motor<W> for Driving {
    /// Drives wheels inline, because most experiments have no other motor.
    #[inline(always)]
    fn drive(&mut self, y: &[f32], world: &mut W) {
        if let Self::Wheels(wheels) = self {
            wheels.drive(y, world);
        } else {
            self.drive_other(y, world);
        }
    }
}

impl Driving {
    #[inline(never)]
    fn drive_other<W: ArenaWorld>(&mut self, y: &[f32], world: &mut W) {
        motor!(self, motor => motor.drive(y, world));
    }

    /// Stops the motor and writes the corresponding values [its channels].
    pub(crate) fn rest<W: ArenaWorld>(&mut self, y: &mut [f32], world: &mut W) {
        match self {
            // Channels for speeds of both signs rest at 1/2, and those for forward speeds at 0.
            Self::Wheels(_) => y.fill(0.5),
            Self::SpeedAndTurn(_, forwards) => {
                y.fill(0.5);
                if let (Some(speed), true) = (y.first_mut(), *forwards) {
                    *speed = 0.0;
                }
            }
            _ => y.fill(0.0),
        }
        self.drive(y, world);
    }
}

/// Outputs without effect.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nothing(usize);

impl Channels for Nothing {
    fn channels(&self) -> usize {
        self.0
    }
}

impl<W: ?Sized> Motor<W> for Nothing {
    fn drive(&mut self, _: &[f32], _: &mut W) {}
}

/// Builds the motor at a path of the document for robot number `robot`.
pub(crate) fn motor(
    kind: &MotorKind,
    scene: &Scene,
    robot: usize,
    path: &str,
    source: &Source,
) -> Result<Driving, Error> {
    let wrong = |why: String| source.wrong(path, why);
    if let MotorKind::Registered { kind, keys } = kind {
        return registered::motor(kind, keys, PartOfPlanar { scene, robot, path, source }).map(Driving::Registered);
    }
    let made = bare(kind, &scene.robots[robot], &scene.parts(robot)).map_err(|error| wrong(error.to_string()))?;
    made.map_err(|what| wrong(format!("needs {what}; the {} has none", scene.robots[robot].name)))
}

/// Builds a motor, or returns the part that the robot lacks.
fn bare(
    kind: &MotorKind,
    robot: &MobileRobot,
    parts: &MobileParts,
) -> Result<Result<Driving, &'static str>, ChannelError> {
    let largest = robot.max_wheel_speed as f32;
    Ok(match kind {
        MotorKind::Wheels {} => Ok(Driving::Wheels(WheelVelocity::new(parts.motors, largest)?)),
        MotorKind::SpeedAndTurn { forwards } => {
            let motor = SpeedAndTurn::new(parts.motors, largest)?;
            Ok(Driving::SpeedAndTurn(if *forwards { motor.forwards() } else { motor }, *forwards))
        }
        MotorKind::Leds { colors, optional: true } if parts.leds.is_none() => {
            Ok(Driving::Nothing(Nothing(colors.len())))
        }
        MotorKind::Leds { colors, .. } => parts.leds.ok_or("LEDs").and_then(|leds| {
            let led = |color: &Led| leds[*color as usize];
            match colors.as_slice() {
                [a] => Ok(Driving::Led(Leds::new([led(a)]))),
                [a, b] => Ok(Driving::TwoLeds(Leds::new([led(a), led(b)]))),
                [a, b, c] => Ok(Driving::Leds(Leds::new([led(a), led(b), led(c)]))),
                _ => Err("one to three colours of LEDs"),
            }
        }),
        MotorKind::Signal {} => parts.signal.map(|it| Driving::Signal(SignalMotor::new(it))).ok_or("a signal"),
        MotorKind::Attachment {} => {
            parts.attachment.map(|it| Driving::Attachment(AttachmentMotor::new(it))).ok_or("an attachment device")
        }
        _ => Err("joints"),
    })
}
