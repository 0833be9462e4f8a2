//! The eyes of a robot of a team.

use farsa_body::ports::{BodyId, Sensor as _};
use farsa_body::robots::{MobileParts, MobileRobot};
use farsa_body::sensors::infrared::{InfraredDrawing, InfraredGroups};
use farsa_body::sensors::{Beam, ColorBand, LinearCamera};
use farsa_body::{ChannelError, Recorder};

use crate::team::config::{EYES, TeamConfig};
use farsa_lab::advanced::PlanarWorld;

/// Everything that shines red, with or without other colors.
pub(crate) const RED: ColorBand = ColorBand { low: [0.5, 0.0, 0.0], high: [1.0, 0.3, 1.0] };
/// Everything that shines blue, with or without other colors.
pub(crate) const BLUE: ColorBand = ColorBand { low: [0.0, 0.0, 0.5], high: [1.0, 0.3, 1.0] };

/// Eight infrared channels and a camera of a robot, all read from the world's ports.
///
/// A ring of more than eight sensors is read in eight groups of neighbors, each of which gives its largest value.
#[derive(Clone, Debug)]
pub struct RobotEyes {
    body: BodyId,
    infrared: InfraredGroups,
    camera: LinearCamera<Vec<Beam>, Vec<ColorBand>>,
    rays: InfraredDrawing,
}

impl RobotEyes {
    /// The eyes of a robot of the team, with a camera for these colors.
    ///
    /// # Errors
    /// [`ChannelError`] for a robot without eight sensors or a multiple of eight, and for a camera that cannot be.
    pub fn new(config: &TeamConfig, parts: &MobileParts, colors: &[ColorBand]) -> Result<Self, ChannelError> {
        let robot = &config.robot;
        // Farther than the arena's diagonal nothing is to be seen.
        let (range, view) = (1.5 * config.size as f32, config.field_of_view);
        Ok(Self {
            body: parts.body,
            infrared: InfraredGroups::for_robot(robot, parts.body, EYES)?,
            camera: LinearCamera::for_view(parts.body, view, config.sectors, config.rays, colors.to_vec(), range)?,
            rays: InfraredDrawing::for_robot(robot, robot.infrared.angles.len()),
        })
    }

    /// Reads the infrared channels and then the camera's \[8 + sectors x colors\].
    pub fn read<W: PlanarWorld>(&mut self, world: &W, out: &mut [f32]) {
        let (near, seen) = out.split_at_mut(EYES);
        self.infrared.read(world, near);
        self.camera.read(world, seen);
    }

    /// Records a ray for each infrared sensor of the robot that read `x` last in the same world. With `met` it records only those
    /// that read something.
    ///
    /// One that did not read because its robot is dead records none.
    pub(crate) fn record<W: PlanarWorld>(&self, world: &W, x: &[f32], met: bool, recorder: &mut dyn Recorder) {
        let near = x.get(..EYES).unwrap_or_default();
        let pose = world.pose(self.body);
        if near.iter().all(|x| x.is_finite()) {
            self.rays.record(pose, self.infrared.ring(), met, recorder);
        }
    }
}

/// Where the infrared channels of a robot look, counter-clockwise from ahead \[rad\].
pub(crate) fn eye_angles(robot: &MobileRobot) -> [f64; EYES] {
    let angles = &robot.infrared.angles;
    let group = (angles.len() / EYES).max(1);
    core::array::from_fn(|eye| angles.get(eye * group).copied().unwrap_or(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_body::ports::Arrange as _;
    use farsa_body::sensors::infrared::InfraredRays;
    use farsa_body::{Pose, Twist};
    use farsa_physics::arena::World;

    #[test]
    fn the_shortcut_reads_what_the_rays_read_and_groups_their_largest() {
        for condition in crate::team::config::ROBOTS {
            let config = TeamConfig { robots: 2, ..TeamConfig::for_condition(condition) };
            let arena = farsa_physics::arena::Arena { size: None, ..config.arena() };
            let mut world = World::new(&arena).unwrap();
            let mut eyes = RobotEyes::new(&config, &world.parts(0), &[RED, BLUE]).unwrap();
            let mut ring = InfraredRays::for_robot(&config.robot, BodyId(0)).unwrap();
            let (mut all, mut x) = (vec![0.0; config.robot.infrared.angles.len()], vec![0.0; config.seen(2)]);
            let (mut lit, r) = (0, config.robot.radius as f32);
            for i in 0..200_u16 {
                let t = f32::from(i);
                let at = [r * 1.1 + 0.3 * r * (t % 7.0), 1.0 + 0.1 * (t % 5.0)];
                let beside = [at[0] + r * (2.05 + 0.2 * (t % 11.0)), at[1]];
                world.place_body(BodyId(0), Pose::planar(at, t), Twist::default());
                world.place_body(BodyId(1), Pose::planar(beside, 0.0), Twist::default());
                world.finish_placement();
                eyes.read(&world, &mut x);
                ring.read(&world, &mut all);
                let count = all.len();
                for eye in 0..EYES {
                    let group = count / EYES;
                    let neighbours =
                        if group == 1 { vec![eye] } else { vec![3 * eye, 3 * eye + 1, (3 * eye + count - 1) % count] };
                    let largest = neighbours.iter().map(|&k| all[k]).fold(0.0, f32::max);
                    assert_eq!(x[eye], largest, "{condition} {i} {eye}");
                    lit += u32::from(largest > 0.0);
                }
            }
            assert!(lit > 100, "{condition}: {lit}");
        }
    }

    #[test]
    fn other_rings_are_refused() {
        let mut config = TeamConfig::for_condition("khepera");
        config.robot.infrared.angles.pop();
        let parts = config.arena().parts(0);
        let error = RobotEyes::new(&config, &parts, &[RED]).unwrap_err();
        assert_eq!(error, ChannelError::Groups { field: "infrared sensors", count: 7, size: 8 });
    }
}
