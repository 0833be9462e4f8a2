//! Infrared sensors simulated by rays and combined in groups of neighbors.

use alloc::{vec, vec::Vec};

use farsa_num::Scalar;

use crate::channel::{ChannelError, groups};
use crate::ports::{BodyId, Channels, Kinematics, Rays, Sensor, Sight};
use crate::robots::mobile::MobileRobot;
use crate::sensors::beam::Beam;
use crate::sensors::infrared::rays::InfraredRays;

/// A ring of [`InfraredRays`] whose sensors are divided into groups of neighbors. Each group has one channel in [0, 1],
/// which is the largest reading of its sensors.
///
/// The middle of group i is the sensor with index i * size. To save time, rays that cannot reach any nearby surface are
/// not cast. This does not change the readings.
#[derive(Clone, Debug)]
pub struct InfraredGroups<B = BodyId> {
    body: B,
    rays: InfraredRays<Vec<Beam>, B>,
    groups: usize,
    /// Readings of all sensors of the ring.
    ring: Vec<f32>,
    /// Near surfaces, up to the available room.
    obstacles: Vec<Obstacle>,
    /// From the middle of the robot to where its sensors see [m].
    reach: f32,
}

/// The nearest point of a wall or another convex thing with the unit vector to it, or a body's middle and radius [m].
#[derive(Clone, Copy, Debug)]
enum Obstacle {
    Convex { point: [f32; 2], out: [f32; 2] },
    Round { centre: [f32; 2], radius: f32 },
}

/// Obstacles that are looked at one by one. Among more all rays are cast.
const ROOM: usize = 64;

/// For rounding [m].
const HAIR: f32 = 1e-4;

/// The distance of the nearest point from the robot's middle below which its direction is undefined, so that all rays
/// are cast [m].
const CLOSE: f32 = 0.01;

impl Obstacle {
    /// Returns whether some of it may lie on a way from one place to another. Sometimes also if none does.
    fn meets(&self, from: [f32; 2], to: [f32; 2]) -> bool {
        match self {
            // All of it lies beyond its nearest point.
            Self::Convex { point, out } => {
                let beyond = |at: [f32; 2]| (at[0] - point[0]) * out[0] + (at[1] - point[1]) * out[1] >= -HAIR;
                beyond(from) || beyond(to)
            }
            Self::Round { centre, radius } => {
                let [u, v] = [to[0] - from[0], to[1] - from[1]];
                let [x, y] = [centre[0] - from[0], centre[1] - from[1]];
                let share = Scalar::clamp((x * u + y * v) / (u * u + v * v), 0.0, 1.0);
                let ([x, y], far) = ([x - share * u, y - share * v], radius + HAIR);
                x * x + y * y <= far * far
            }
        }
    }
}

impl<B: Copy> InfraredGroups<B> {
    /// Creates the sensors of a robot and divides them into `count` groups.
    ///
    /// # Errors
    /// Returns [`ChannelError::Groups`] if the ring cannot be divided into groups of equal size, and the errors of
    /// [`InfraredRays::for_robot`].
    pub fn for_robot(robot: &MobileRobot, body: B, count: usize) -> Result<Self, ChannelError> {
        let sensors = robot.infrared.angles.len();
        groups("infrared sensors", sensors, count)?;
        Ok(Self {
            body,
            rays: InfraredRays::for_robot(robot, body)?,
            groups: count,
            ring: vec![0.0; sensors],
            obstacles: Vec::with_capacity(ROOM),
            reach: (robot.radius + robot.infrared.range) as f32,
        })
    }
}

impl<B> InfraredGroups<B> {
    /// Gets the latest readings of all sensors, in the order of [`crate::robots::InfraredRing::angles`].
    pub fn ring(&self) -> &[f32] {
        &self.ring
    }
}

impl<B> Channels for InfraredGroups<B> {
    fn channels(&self) -> usize {
        self.groups
    }
}

impl<B, W> Sensor<W> for InfraredGroups<B>
where
    B: Copy + PartialEq,
    W: Sight<Body = B> + Rays<Body = B> + Kinematics<Body = B> + ?Sized,
{
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let Self { body, rays, groups, ring, obstacles, reach } = self;
        let [x, y, _] = world.pose(*body).position;
        let mut crowded = false;
        obstacles.clear();
        world.query_near([x, y], *reach, &mut |near| {
            let [u, v] = [near.point[0] - x, near.point[1] - y];
            let away = near.distance.max(f32::MIN_POSITIVE);
            let out = [u / away, v / away];
            if near.body == Some(*body) {
                return;
            }
            crowded |= near.distance < CLOSE;
            let found = match near.body {
                Some(_) if near.radius > 0.0 => {
                    let far = near.distance + near.radius;
                    Obstacle::Round { centre: [x + far * out[0], y + far * out[1]], radius: near.radius }
                }
                _ => Obstacle::Convex { point: near.point, out },
            };
            crowded |= obstacles.len() == ROOM;
            if !crowded {
                obstacles.push(found);
            }
        });
        if obstacles.is_empty() && !crowded {
            // Rays would read 0, too, because nothing is within their range.
            ring.fill(0.0);
        } else {
            rays.read_where(world, ring, |[x, y, _], [u, v, _]| {
                crowded || obstacles.iter().any(|obstacle| obstacle.meets([x, y], [u, v]))
            });
        }
        let (size, count) = (ring.len() / *groups, ring.len());
        for (first, o) in out.iter_mut().take(*groups).enumerate() {
            let of_group = (0..size).map(|k| (first * size + k + count - size / 2) % count);
            *o = of_group.fold(0.0, |most, sensor| Scalar::max(most, ring[sensor]));
        }
    }
}
