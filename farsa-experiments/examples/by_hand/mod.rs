//! Controllers of teams without evolution or memory, to compare evolved ones with. They read and write the channels of the
//! experiments.

use std::sync::Arc;

use farsa_body::robots::MobileRobot;
use farsa_experiments::Reflex;
use farsa_lab::{Error, Settings};

/// Infrared channels of every robot.
const EYES: usize = 8;
/// The part of the way that energy lasts for which a circle takes.
const CIRCLE: f64 = 0.85;

/// The directions of infrared channels: the sine, positive to the left, and whether it is within 60 degrees of ahead.
type Eyes = [(f32, bool); EYES];

/// The robot of a condition.
fn robot(condition: &str) -> MobileRobot {
    match condition {
        "e-puck" => MobileRobot::e_puck(),
        "khepera" => MobileRobot::khepera(),
        _ => MobileRobot::marxbot(),
    }
}

fn eyes(robot: &MobileRobot) -> Eyes {
    let angles = &robot.infrared.angles;
    std::array::from_fn(|eye| {
        let (sine, cosine) = farsa_num::sin_cos(angles[eye * angles.len() / EYES]);
        (sine as f32, cosine > 0.49)
    })
}

/// Returns the turn away from objects ahead \[0 right..1 left\], or `None` without any.
fn away(eyes: &Eyes, x: &[f32]) -> Option<f32> {
    let ahead = || eyes.iter().zip(x).filter(|((_, ahead), x)| *ahead && **x > 0.0);
    let left: f32 = ahead().map(|((left, _), x)| left * x).sum();
    ahead().next().map(|_| if left > 0.0 { 0.0 } else { 1.0 })
}

/// Returns a forager that drives circles which lead back to the nest before the energy is used up, and straight on through the
/// nest. The circles make a rosette around it. It turns away from objects in its infrared sensors.
///
/// # Errors
/// [`Error::Setting`] for the settings of another experiment than `foraging`.
pub(crate) fn homing_forager(condition: &str, settings: &Settings) -> Result<Reflex, Error> {
    let robot = robot(condition);
    let (cost, steps) = (settings.number("energy.cost")?, settings.count("trial.steps")? as f64);
    let steps = if cost > 0.0 { (1.0 / cost).min(steps) } else { steps };
    let way = steps * settings.number("world.time_step")? * settings.number("robot.speed")?;
    let radius = CIRCLE * way / std::f64::consts::TAU;
    let turn = (0.5 + 0.5 * (robot.track / (2.0 * radius)).min(1.0)) as f32;
    let eyes = eyes(&robot);
    Ok(Arc::new(move |x, y| {
        let in_nest = x[x.len() - 2] > 0.5;
        let [speed, turn] = match away(&eyes, x) {
            Some(turn) => [0.3, turn],
            None if in_nest => [1.0, 0.5],
            None => [1.0, turn],
        };
        y.copy_from_slice(&[speed, turn, 0.0, 0.0]);
    }))
}

/// Returns a robot of `aggregation` that stays on a nest and shines red there. Off a nest it steers to red light, else drives
/// straight on and turns away from objects in its infrared sensors.
pub(crate) fn beacon_seeker(condition: &str) -> Reflex {
    let eyes = eyes(&robot(condition));
    Arc::new(move |x, y| {
        // Two sectors of red and blue follow the infrared channels, and then the ground.
        let (left, right, on_nest) = (x[EYES], x[EYES + 2], x[x.len() - 1] > 0.5);
        y.copy_from_slice(&if on_nest {
            [0.0, 0.5, 1.0, 0.0]
        } else if let Some(turn) = away(&eyes, x) {
            [0.3, turn, 0.0, 0.0]
        } else if left + right > 0.0 {
            [1.0, 0.5 + 0.2 * (left - right) / (left + right), 0.0, 0.0]
        } else {
            [1.0, 0.5, 0.0, 0.0]
        });
    })
}

/// The reaction of a [`chaser`] to the other robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Aim {
    /// A predator steers to the other robot.
    To,
    /// A prey steers away from the other robot.
    From,
}

/// Returns a robot of `predator-prey` that steers to the other robot, or away from it, at full speed.
///
/// The bearing of the other is the mean of the camera's sectors by the share of it in each. A prey that has the other ahead turns
/// on the spot first, and keeps from walls.
///
/// # Errors
/// [`Error::Setting`] for the settings of another experiment than `predator-prey`.
pub(crate) fn chaser(aim: Aim, settings: &Settings) -> Result<Reflex, Error> {
    const QUARTER: f32 = std::f32::consts::FRAC_PI_2;
    let view = settings.number("camera.field_of_view")?.to_radians();
    let eyes = eyes(&MobileRobot::marxbot());
    Ok(Arc::new(move |x, y| {
        let [speed, turn] = match (bearing(&x[EYES..], view), aim) {
            (Some(angle), Aim::To) => [1.0, 0.5 + 0.5 * (angle / QUARTER).clamp(-1.0, 1.0)],
            (Some(angle), Aim::From) => match away(&eyes, x) {
                Some(turn) => [0.3, turn],
                // The opposite direction is half a turn away.
                None if angle.abs() < QUARTER => [0.5, if angle > 0.0 { 0.0 } else { 1.0 }],
                None => [1.0, 0.5 - 0.2 * angle.signum() * (2.0 - angle.abs() / QUARTER)],
            },
            (None, _) => [1.0, away(&eyes, x).unwrap_or(0.6)],
        };
        y.copy_from_slice(&[speed, turn]);
    }))
}

/// Returns the bearing of the other robot, counter-clockwise from ahead \[rad\], or `None` if it is not seen.
fn bearing(sectors: &[f32], view: f64) -> Option<f32> {
    let count = sectors.len() as f64;
    let mut sum = [0.0_f32; 2];
    for (sector, share) in sectors.iter().enumerate() {
        let middle = view * (0.5 - (sector as f64 + 0.5) / count);
        let (sine, cosine) = farsa_num::sin_cos(middle as f32);
        sum = [sum[0] + share * cosine, sum[1] + share * sine];
    }
    (sum != [0.0; 2]).then(|| farsa_num::atan2(sum[1], sum[0]))
}
