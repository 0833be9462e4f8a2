//! The sensors of the agent: the camera, touch, the joint angles and the two words.

use farsa_body::ports::{BodyId, Handles, JointId, Joints, Kinematics, Sight};
use farsa_body::sensors::{Beam, ColorBand, LinearCamera};
use farsa_body::{ChannelError, Pose};
use farsa_lab::Error;

use crate::compositional_instructions::config::Config;
use crate::compositional_instructions::fitness::Observation;
use crate::compositional_instructions::instruction::{Color, Condition, Instruction};
use crate::compositional_instructions::network::INPUTS;
use crate::compositional_instructions::scene::Scene;

/// A world that supports all sensors of the agent.
pub trait ArmWorld: Kinematics + Joints + Sight + Handles<Body = BodyId, Joint = JointId> {}

impl<W> ArmWorld for W where W: Kinematics + Joints + Sight + Handles<Body = BodyId, Joint = JointId> + ?Sized {}

/// The sensors of the agent. They have 20 channels.
///
/// The first nine channels are the red, green and blue values of the camera's sectors from left to right. The next
/// three channels measure touch on the left side, at the tip and on the right side of the second segment. They are
/// followed by the two joint angles, scaled from 0 at the lower limit to 1 at the upper limit. The action word and the
/// object word have three channels each.
#[derive(Clone, Debug)]
pub struct Senses {
    camera: LinearCamera<Vec<Beam>, Vec<ColorBand>>,
    condition: Condition,
    objects: [BodyId; 3],
    /// Half the range of each joint, doubled by the other side \[rad\].
    ranges: [f64; 2],
    /// Length of the second segment, and radius of an object \[m\].
    length: f64,
    radius: f64,
    /// Distance of an object's center from the second segment's axis below which they touch \[m\].
    reach: f64,
}

/// Returns the names of the channels.
pub fn channel_names(condition: Condition) -> Vec<String> {
    let sectors = ["left", "middle", "right"];
    let seen = sectors.into_iter().flat_map(|sector| Color::ALL.map(|color| format!("{} {sector}", color.word())));
    let words = condition.actions().map(|action| action.word().to_owned()).into_iter();
    let words = words.chain(Color::ALL.map(|color| color.word().to_owned()));
    let felt = ["touch left", "touch tip", "touch right", "J1", "J2"].map(String::from);
    seen.chain(felt).chain(words).collect()
}

impl Senses {
    /// Creates the sensors for a scene.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the camera is invalid.
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        let Config { arm, objects, camera, condition, touch_margin, .. } = &scene.config;
        let wrong = |error: ChannelError| Error::Other(format!("compositional-instructions: {error}"));
        let bands = Color::ALL.map(|color| ColorBand::around(color.rgb().map(|x| x as f32), 0.25)).to_vec();
        let (view, rays, range) = (camera.view.to_radians(), camera.rays as usize, camera.range as f32);
        Ok(Self {
            camera: LinearCamera::for_view(Scene::FIRST, view, 3, rays, bands, range).map_err(wrong)?,
            condition: *condition,
            objects: scene.objects,
            ranges: arm.ranges.map(f64::to_radians),
            length: arm.lengths[1],
            radius: objects.radius,
            reach: objects.radius + arm.radius + touch_margin,
        })
    }

    /// Reads all channels and returns the observation that determines the reward. The argument `places` contains the
    /// initial positions of the objects.
    pub fn read<W: ArmWorld + ?Sized>(
        &mut self,
        world: &W,
        instruction: Instruction,
        places: &[[f64; 2]; 3],
        x: &mut [f32; INPUTS],
    ) -> Observation {
        let mut now = Observation::default();
        let (first, second) = (world.pose(Scene::FIRST), world.pose(Scene::SECOND));
        self.camera.read_from(world, &first, &mut x[..9]);
        for (sector, values) in now.seen.iter_mut().zip(x.chunks_exact_mut(3)) {
            for (seen, value) in sector.iter_mut().zip(values) {
                *seen = *value > 0.0;
                *value = f32::from(u8::from(*seen));
            }
        }
        let mut sides = [false; 3];
        let tip = second.transform([self.length as f32, 0.0, 0.0]).map(f64::from);
        for (i, object) in self.objects.into_iter().enumerate() {
            let place = world.origin(object);
            let [ahead, left, _] = first.transform_back(place).map(f64::from);
            now.ahead[i] = [ahead, left];
            now.displaced[i] = Scene::distance([place[0], place[1]].map(f64::from), places[i]);
            now.tip[i] = Scene::distance([tip[0], tip[1]], [place[0], place[1]].map(f64::from)) - self.radius;
            if let Some(side) = self.side(&second, tip, place) {
                now.touched[i] = true;
                sides[side] = true;
            }
        }
        for (value, side) in x[9..12].iter_mut().zip(sides) {
            *value = f32::from(u8::from(side));
        }
        for ((value, joint), range) in x[12..14].iter_mut().zip(Scene::JOINTS).zip(self.ranges) {
            // (q + r) / (2 r) maps the range [-r, r] to [0, 1].
            *value = ((f64::from(world.position(joint)) + range) / (2.0 * range)) as f32;
        }
        self.write_words(instruction, x);
        now
    }

    /// Writes the channels of the two words and leaves the others unchanged.
    pub fn write_words(&self, instruction: Instruction, x: &mut [f32; INPUTS]) {
        let Instruction { action, color } = instruction;
        x[14..].fill(0.0);
        x[14 + self.condition.channel(action)] = 1.0;
        x[17 + color.index()] = 1.0;
    }

    /// With which side the second segment, whose tip is there, is on an object at a place: 0 the left one, 1 the tip, 2
    /// the right one.
    fn side(&self, second: &Pose, tip: [f64; 3], place: [f32; 3]) -> Option<usize> {
        // Twice the way from the segment's middle. An object that touches it is no further along any axis than half the length and
        // the reach, and a hundredth for rounding. This cheap test excludes most objects.
        let most = 1.01 * (self.length + 2.0 * self.reach);
        let beyond = |k: usize| (2.0 * f64::from(place[k]) - f64::from(second.position[k]) - tip[k]).abs() > most;
        if beyond(0) || beyond(1) {
            return None;
        }
        let [along, left, _] = second.transform_back(place).map(f64::from);
        // The nearest point on the axis of the segment. `reach` contains the radius of the segment.
        let near = along.clamp(0.0, self.length);
        let apart = Scene::distance([along, left], [near, 0.0]);
        if apart >= self.reach {
            return None;
        }
        // Past the end of the axis the contact is on the round tip.
        let beyond = along > self.length;
        Some(if beyond {
            1
        } else if left > 0.0 {
            0
        } else {
            2
        })
    }
}
