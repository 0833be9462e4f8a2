//! Infrared sensors based on measured tables, for planar worlds.

use alloc::vec::Vec;
use core::borrow::Borrow;

use farsa_num::atan2;

use crate::channel::{ChannelError, groups, positive};
use crate::ports::{BodyId, Channels, Kinematics, NearbySurface, Sensor, Sight};
use crate::sensors::infrared::table::InfraredTable;
use crate::sensors::stance::Stance;

/// Measured tables for walls and for round bodies of different radii.
#[derive(Clone, Debug, PartialEq)]
pub struct InfraredTables {
    walls: InfraredTable,
    bodies: Vec<(f32, InfraredTable)>,
}

impl InfraredTables {
    /// Combines a table for walls with tables for round bodies. Each of the latter is given with the radius (in meters)
    /// at which it was measured.
    ///
    /// A body uses the table with the most similar radius, and the earlier one of two equally similar tables. If there
    /// are no tables for bodies, the table of the walls is used.
    ///
    /// # Errors
    /// Returns [`ChannelError::Groups`] if the numbers of sensors differ, or [`ChannelError::Value`] if a radius is not
    /// a finite number > 0.
    pub fn new(walls: InfraredTable, bodies: Vec<(f32, InfraredTable)>) -> Result<Self, ChannelError> {
        for (radius, table) in &bodies {
            positive("radius of a table", *radius)?;
            if table.sensors() != walls.sensors() {
                let (count, size) = (table.sensors(), walls.sensors());
                return Err(ChannelError::Groups { field: "sensors of a table", count, size });
            }
        }
        Ok(Self { walls, bodies })
    }

    /// Returns the number of sensors.
    pub fn sensors(&self) -> usize {
        self.walls.sensors()
    }

    /// Returns the distance from the hull at which all responses end (in meters).
    pub fn range(&self) -> f32 {
        self.bodies.iter().map(|(_, table)| table.range()).fold(self.walls.range(), farsa_num::Scalar::max)
    }

    /// Returns the table for a round body with the given radius (in meters). A radius of 0 selects the table for walls.
    pub fn table(&self, radius: f32) -> &InfraredTable {
        let mut nearest = (f32::INFINITY, &self.walls);
        if radius > 0.0 {
            for (measured, table) in &self.bodies {
                let gap = (measured - radius).abs();
                if gap < nearest.0 {
                    nearest = (gap, table);
                }
            }
        }
        nearest.1
    }
}

/// A ring of infrared sensors simulated with measured tables. Each sensor has one channel in [0, 1].
///
/// The tables provide the response to each wall and each other body. It depends on the distance between the hull and
/// the nearest point of the object, and on the bearing of this point from the center of the robot. The responses are
/// added and limited to 1, and objects do not hide each other. The nearest point of a wall is the foot of the
/// perpendicular or the nearer end of the wall. In a corner, both walls respond separately.
///
/// The tables can be owned, borrowed, or shared by an `Rc` or `Arc`. Wrap the sensor in [`crate::wrappers::Noisy`] to
/// add noise. See [`crate::sensors::infrared::InfraredRays`] for an example.
///
/// ```
/// use farsa_body::ports::Sensor;
/// use farsa_body::robots::MobileRobot;
/// use farsa_body::sensors::infrared::{InfraredTable, InfraredTables, SampledInfrared};
/// use farsa_body::testing::PlaneWorld;
///
/// // Two sensors, four angles, one distance; measured at a wall only.
/// let walls = InfraredTable::parse("2 4 1 0 50\nTURN 0\n512 512\n0 256\n0 0\n256 0\nEND\n").unwrap();
/// let tables = InfraredTables::new(walls, Vec::new())?;
/// let mut world = PlaneWorld::new();
/// let parts = world.add_robot(&MobileRobot::khepera(), [0.0, 0.0], 0.1);
/// world.add_wall([[0.07, -1.0], [0.07, 1.0]], [1.0; 3]);
/// let mut sensor = SampledInfrared::new(parts.body, 0.035, &tables)?;
/// let mut x = [0.0; 2];
/// sensor.read(&world, &mut x);
/// assert_eq!(x, [0.5, 0.5]);
/// # Ok::<(), farsa_body::ChannelError>(())
/// ```
#[doc(alias = "proximity")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledInfrared<T, B = BodyId> {
    body: B,
    radius: f32,
    tables: T,
    channels: usize,
}

impl<T: Borrow<InfraredTables>, B> SampledInfrared<T, B> {
    /// Creates a ring with all sensors of the tables on the round hull of `body`. The `radius` is given in meters.
    ///
    /// # Errors
    /// Returns [`ChannelError::Value`] if `radius` is not a finite number > 0.
    pub fn new(body: B, radius: f32, tables: T) -> Result<Self, ChannelError> {
        let channels = tables.borrow().sensors();
        Ok(Self { body, radius: positive("radius", radius)?, tables, channels })
    }

    /// Limits the ring to the first sensors. This is useful for the Khepera, where the first six of eight sensors are
    /// at the front.
    ///
    /// # Errors
    /// Returns [`ChannelError::Selection`] if there are fewer sensors, or [`ChannelError::Groups`] if the number is 0.
    pub fn first(self, sensors: usize) -> Result<Self, ChannelError> {
        groups("sensors", sensors, 1)?;
        let channels = self.tables.borrow().sensors();
        if sensors > channels {
            return Err(ChannelError::Selection { start: 0, end: sensors, channels });
        }
        Ok(Self { channels: sensors, ..self })
    }
}

impl<T, B> Channels for SampledInfrared<T, B> {
    fn channels(&self) -> usize {
        self.channels
    }
}

impl<T, B, W> Sensor<W> for SampledInfrared<T, B>
where
    T: Borrow<InfraredTables>,
    B: Copy + PartialEq,
    W: Sight<Body = B> + Kinematics + ?Sized,
{
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let (stance, tables) = (Stance::from_world(world, self.body), self.tables.borrow());
        let channels = self.channels.min(out.len());
        let out = &mut out[..channels];
        out.fill(0.0);
        world.query_near(stance.at, self.radius + tables.range(), &mut |near: NearbySurface<B>| {
            if near.body != Some(self.body) {
                let [x, y] = stance.bearing(&near);
                let response = tables.table(near.radius).response(near.distance - self.radius, atan2(y, x));
                for (o, reading) in out.iter_mut().zip(response.unwrap_or_default()) {
                    *o += reading;
                }
            }
        });
        for o in out {
            *o = farsa_num::Scalar::min(*o, 1.0);
        }
    }
}
