//! Any motor, with what is wrapped around it.

use farsa_body::{
    ActuatorId, AttachmentMotor, ChannelError, Channels, Leds, MobileParts, Motor, SignalMotor, SpeedAndTurn,
    WheelVelocity,
};
use farsa_lab::{Error, PlanarWorld};

use crate::check::places::Places;
use crate::document::{self, Led, MotorKind};
use crate::parts::scene::Scene;
use crate::parts::wrapping::{NoiseStreams, Reseed, Wrapped, around};

/// A motor of a robot in a plane.
#[derive(Clone, Debug)]
pub(crate) enum Driving {
    Wheels(WheelVelocity),
    SpeedAndTurn(SpeedAndTurn),
    Led(Leds<ActuatorId, 1>),
    TwoLeds(Leds<ActuatorId, 2>),
    Leds(Leds<ActuatorId, 3>),
    Signal(SignalMotor),
    Attachment(AttachmentMotor),
    Wrapped(Wrapped<Self>),
}

/// Calls a method of whatever motor it is.
macro_rules! motor {
    ($driving:expr, $motor:ident => $call:expr) => {
        match $driving {
            Driving::Wheels($motor) => $call,
            Driving::SpeedAndTurn($motor) => $call,
            Driving::Led($motor) => $call,
            Driving::TwoLeds($motor) => $call,
            Driving::Leds($motor) => $call,
            Driving::Signal($motor) => $call,
            Driving::Attachment($motor) => $call,
            Driving::Wrapped(wrapped) => around!(wrapped, $motor => $call),
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

impl<W: PlanarWorld> Motor<W> for Driving {
    #[inline]
    fn drive(&mut self, y: &[f32], world: &mut W) {
        motor!(self, motor => motor.drive(y, world));
    }
}

impl Reseed for Driving {
    fn reseed(&mut self, streams: &mut NoiseStreams) {
        if let Self::Wrapped(wrapped) = self {
            wrapped.reseed(streams);
        }
    }
}

/// A motor of robot number `robot`, which stands at a path of the document, with its wrappers.
///
/// # Errors
/// [`Error::Setting`] for what the robot does not have or cannot be wrapped so.
pub(crate) fn motor(
    motor: &document::Motor,
    scene: &Scene,
    robot: usize,
    path: &str,
    places: &Places,
) -> Result<Driving, Error> {
    let wrong = |why: String| places.wrong(path, why);
    let made = bare(&motor.kind, scene, &scene.parts(robot)).map_err(|error| wrong(error.to_string()))?;
    let mut made = made.map_err(|what| wrong(format!("needs {what}; the {} has none", scene.robot.name)))?;
    for (index, wrapper) in motor.wrappers.iter().enumerate() {
        let wrapped = Wrapped::new(made, wrapper);
        made = Driving::Wrapped(wrapped.map_err(|error| places.wrong(&format!("{path}/wrappers/{index}"), error))?);
    }
    Ok(made)
}

/// A motor without wrappers, or what the robot lacks for it.
fn bare(kind: &MotorKind, scene: &Scene, parts: &MobileParts) -> Result<Result<Driving, &'static str>, ChannelError> {
    let largest = scene.robot.max_wheel_speed as f32;
    Ok(match kind {
        MotorKind::Wheels {} => Ok(Driving::Wheels(WheelVelocity::new(parts.motors, largest)?)),
        MotorKind::SpeedAndTurn { forwards } => {
            let motor = SpeedAndTurn::new(parts.motors, largest)?;
            Ok(Driving::SpeedAndTurn(if *forwards { motor.forwards() } else { motor }))
        }
        MotorKind::Leds { colors } => parts.leds.ok_or("LEDs").and_then(|leds| {
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
    })
}
