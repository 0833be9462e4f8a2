//! A recorded episode in memory.

use std::ops::Range;

use farsa_body::ports::{BodyId, Contacts, Kinematics, PairContact, PairId};
use farsa_body::{Pose, Recorder, record_world};

use crate::recording::ground_images::GroundImages;
use crate::recording::images::Images;
use crate::recording::schema::Schema;

/// Length of a pose: position and rotation.
const POSE: usize = 7;
/// Initial capacity [ticks].
const TICKS: usize = 1024;

/// A contact of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touching {
    /// Pair of shapes that touch.
    pub pair: PairId,
    /// Point of contact, in world coordinates \[m\].
    pub point: [f32; 3],
    /// Force on the first body of the pair \[N\].
    pub force: [f32; 3],
}

/// A ray of a sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CastRay {
    /// Start of the ray \[m\].
    pub from: [f32; 3],
    /// End of the ray \[m\].
    pub to: [f32; 3],
    /// This is `true` if the ray hit something at its end.
    pub met: bool,
}

/// A recorded episode, tick by tick, for a [`Page`](crate::Page) or for analysis.
///
/// Note that values without a name in the schema are silently dropped. If a value is in the schema but was not recorded,
/// it is NaN.
///
/// ```
/// use farsa_body::Recorder;
/// use farsa_body::ports::{JointId, Sensor, World as _};
/// use farsa_body::robots::{ArmAndHand, Tabletop};
/// use farsa_body::sensors::JointPosition;
/// use farsa_physics::articulated::{Model, Options, World};
/// use farsa_view::{Page, Recording, Schema};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let robot = Tabletop::default().scene(&ArmAndHand::default())?;
/// let mut world = World::new(Model::<f32>::new(&robot, &Options::default())?);
/// let mut elbow = JointPosition::new(JointId(3), -2.0, 0.0)?;
/// let mut x = [0.0];
///
/// let mut recording = Recording::new(Schema::from_robot(&robot).with_sensors(["elbow"]));
/// for tick in 0..50 {
///     elbow.read(&world, &mut x);
///     world.step();
///     recording.world(&world).sensors(&x);
///     recording.tick(0.01 * f64::from(tick + 1));
/// }
/// let html = Page::new("A fall").with("free", recording).html();
/// # assert!(html.len() > 10_000);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, Default)]
pub struct Recording {
    schema: Schema,
    parameters: Vec<f32>,
    times: Vec<f64>,
    /// Ticks x bodies x 7, including the current tick, as in the next three fields.
    poses: Vec<f32>,
    points: Vec<f32>,
    /// Sensors, neurons, outputs.
    values: Vec<f32>,
    scalars: Vec<f64>,
    /// NaN, as many as the widest field has per tick.
    blank: Vec<f32>,
    contacts: Vec<Touching>,
    /// Number of contacts up to the end of each tick.
    contact_ends: Vec<usize>,
    rays: Vec<CastRay>,
    ray_ends: Vec<usize>,
    images: Images,
    grounds: GroundImages,
    /// Most bytes of ticks, if limited.
    room: Option<usize>,
    cut: bool,
}

impl Recording {
    /// Creates an empty recording. Memory for 1024 ticks is reserved in advance.
    pub fn new(schema: Schema) -> Self {
        let (images, grounds) = (Images::new(&schema.images), GroundImages::new(&schema.images));
        let mut recording = Self { schema, images, grounds, ..Self::default() };
        let widest = [POSE * recording.bodies(), 3 * recording.schema.points.len(), recording.width()];
        recording.blank = vec![f32::NAN; widest.into_iter().max().unwrap_or(0)];
        // Most episodes are shorter, and longer ones grow.
        recording.poses.reserve(TICKS * POSE * recording.bodies());
        recording.points.reserve(TICKS * 3 * recording.schema.points.len());
        recording.values.reserve(TICKS * recording.width());
        recording.scalars.reserve(TICKS * recording.schema.scalars.len());
        recording.open();
        recording
    }

    /// Limits the memory of ticks [bytes].
    ///
    /// Once the limit is exceeded, further ticks are not stored. Use [`is_cut`](Self::is_cut) to check for this.
    ///
    /// ```
    /// use farsa_body::Recorder;
    /// use farsa_view::{Recording, Schema};
    ///
    /// let mut recording = Recording::new(Schema::from_scalars(["energy"])).with_room(10_000);
    /// (0..1000).for_each(|tick| recording.tick(0.01 * f64::from(tick)));
    /// assert!(recording.is_cut() && recording.times().len() < 1000);
    /// ```
    #[must_use]
    pub fn with_room(self, bytes: usize) -> Self {
        Self { room: Some(bytes), ..self }
    }

    /// Checks whether ticks are missing because of the limit set by [`with_room`](Self::with_room).
    pub fn is_cut(&self) -> bool {
        self.cut
    }

    /// Computes the memory of all ticks [bytes]. This does not include images.
    pub fn bytes(&self) -> usize {
        let singles = self.poses.len() + self.points.len() + self.values.len();
        let doubles = self.scalars.len() + self.times.len();
        let ends = size_of::<usize>() * (self.contact_ends.len() + self.ray_ends.len());
        let seen = size_of::<Touching>() * self.contacts.len() + size_of::<CastRay>() * self.rays.len();
        4 * singles + 8 * doubles + ends + seen
    }

    /// Appends a tick of NaN.
    fn open(&mut self) {
        // Copying a row of NaN is faster than filling each.
        let Self { blank, poses, points, values, scalars, schema, .. } = self;
        let count = |per_tick: usize| blank.get(..per_tick).unwrap_or(&[]);
        poses.extend_from_slice(count(POSE * schema.body_count()));
        points.extend_from_slice(count(3 * schema.points.len()));
        values.extend_from_slice(count(schema.sensors.len() + schema.neurons.len() + schema.outputs.len()));
        scalars.resize(scalars.len() + schema.scalars.len(), f64::NAN);
    }

    fn bodies(&self) -> usize {
        self.schema.body_count()
    }

    fn width(&self) -> usize {
        self.schema.sensors.len() + self.schema.neurons.len() + self.schema.outputs.len()
    }

    /// Records the poses of all bodies with a shape, and all contacts.
    ///
    /// This belongs to the current tick, so call it before [`tick`](Recorder::tick).
    pub fn world<W>(&mut self, world: &W) -> &mut Self
    where
        W: Kinematics<Body = BodyId> + Contacts + ?Sized,
    {
        let shown: Vec<BodyId> = self.schema.shown().collect();
        record_world(world, shown, self);
        self
    }

    /// Gets the schema of this recording.
    pub fn schema(&self) -> &Schema {
        &self.schema
    }

    /// Gets the parameters of the controller. This is empty if they were not recorded.
    pub fn controller_parameters(&self) -> &[f32] {
        &self.parameters
    }

    /// Gets the time of each stored tick \[s\].
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Gets the pose of a body at a tick.
    ///
    /// If the body or the tick does not exist, this returns `None`. A pose that was not recorded is NaN.
    pub fn pose_at(&self, tick: usize, body: BodyId) -> Option<Pose> {
        let at = POSE * (tick * self.bodies() + body.index());
        if tick >= self.times.len() || body.index() >= self.bodies() {
            return None;
        }
        let words = self.poses.get(at..at + POSE)?;
        Some(Pose { position: [words[0], words[1], words[2]], rotation: [words[3], words[4], words[5], words[6]] })
    }

    /// Gets the position of a point at a tick, or `None` if there is no such point or tick.
    pub fn point_at(&self, tick: usize, point: usize) -> Option<[f32; 3]> {
        let at = 3 * (tick * self.schema.points.len() + point);
        if tick >= self.times.len() || point >= self.schema.points.len() {
            return None;
        }
        self.points.get(at..at + 3).map(|words| [words[0], words[1], words[2]])
    }

    /// Gets the contacts of a tick. If there is no such tick, the slice is empty.
    pub fn contacts_at(&self, tick: usize) -> &[Touching] {
        self.contacts.get(ended(&self.contact_ends, tick)).unwrap_or(&[])
    }

    /// Gets the rays of a tick. If there is no such tick, the slice is empty.
    pub fn rays_at(&self, tick: usize) -> &[CastRay] {
        self.rays.get(ended(&self.ray_ends, tick)).unwrap_or(&[])
    }

    /// Iterates over the pixels of an image at a tick, as red, green and blue.
    ///
    /// Pixels start at the upper left and are accurate within 1/62. If the image was not recorded, or after 2^22 stored
    /// pixels, this returns `None`. Repeating an image takes no memory. For an image on the ground, you get the last
    /// recorded one.
    pub fn image_at(&self, tick: usize, image: usize) -> Option<impl Iterator<Item = [f32; 3]> + '_> {
        let of_camera = self.images.at(tick, image);
        let of_ground = self.grounds.at(tick, image);
        let seen = of_camera.is_some() || of_ground.is_some();
        seen.then(|| of_camera.into_iter().flatten().chain(of_ground.into_iter().flatten()))
    }

    /// Gets the stored images on the ground.
    pub(crate) fn grounds(&self) -> &GroundImages {
        &self.grounds
    }

    /// Gets the stored images of cameras.
    pub(crate) fn images(&self) -> &Images {
        &self.images
    }

    /// Iterates over all values of a tick, in the order of [`Schema::columns`].
    pub fn row(&self, tick: usize) -> impl Iterator<Item = f64> + '_ {
        fn of_tick<T>(values: &[T], tick: usize, width: usize) -> &[T] {
            values.get(tick * width..(tick + 1) * width).unwrap_or(&[])
        }
        let scalars = of_tick(&self.scalars, tick, self.schema.scalars.len());
        let values = of_tick(&self.values, tick, self.width());
        scalars.iter().copied().chain(values.iter().copied().map(f64::from))
    }

    fn keep(&mut self, first: usize, count: usize, values: &[f32]) {
        let at = self.times.len() * self.width() + first;
        if let Some(to) = self.values.get_mut(at..at + count) {
            to.iter_mut().zip(values).for_each(|(to, value)| *to = *value);
        }
    }
}

/// Returns the items between the ends of the previous and of this tick.
fn ended(ends: &[usize], tick: usize) -> Range<usize> {
    let begin = tick.checked_sub(1).and_then(|before| ends.get(before)).copied().unwrap_or(0);
    begin..ends.get(tick).copied().unwrap_or(begin)
}

impl Recorder for Recording {
    fn parameters(&mut self, parameters: &[f32]) {
        self.parameters = parameters.to_vec();
    }

    fn pose(&mut self, body: BodyId, pose: Pose) {
        let at = POSE * (self.times.len() * self.bodies() + body.index());
        if let Some(words) = self.poses.get_mut(at..at + POSE) {
            words[..3].copy_from_slice(&pose.position);
            words[3..].copy_from_slice(&pose.rotation);
        }
    }

    fn contact(&mut self, pair: PairId, contact: &PairContact) {
        self.contacts.push(Touching { pair, point: contact.point, force: contact.force });
    }

    fn ray(&mut self, from: [f32; 3], to: [f32; 3], met: bool) {
        self.rays.push(CastRay { from, to, met });
    }

    fn point(&mut self, point: usize, position: [f32; 3]) {
        let at = 3 * (self.times.len() * self.schema.points.len() + point);
        if point < self.schema.points.len()
            && let Some(words) = self.points.get_mut(at..at + 3)
        {
            words.copy_from_slice(&position);
        }
    }

    fn pixel(&mut self, image: usize, pixel: usize, color: [f32; 3]) {
        self.images.pixel(image, pixel, color);
        self.grounds.pixel(image, pixel, color);
    }

    fn sensors(&mut self, x: &[f32]) {
        self.keep(0, self.schema.sensors.len(), x);
    }

    fn neurons(&mut self, states: &[f32]) {
        self.keep(self.schema.sensors.len(), self.schema.neurons.len(), states);
    }

    fn outputs(&mut self, y: &[f32]) {
        self.keep(self.schema.sensors.len() + self.schema.neurons.len(), self.schema.outputs.len(), y);
    }

    fn scalars(&mut self, values: &[f64]) {
        let count = self.schema.scalars.len();
        let at = self.times.len() * count;
        if let Some(to) = self.scalars.get_mut(at..at + count) {
            to.iter_mut().zip(values).for_each(|(to, value)| *to = *value);
        }
    }

    fn tick(&mut self, time: f64) {
        if self.room.is_some_and(|room| self.bytes() > room) {
            self.cut = true;
            self.contacts.truncate(self.contact_ends.last().copied().unwrap_or(0));
            self.rays.truncate(self.ray_ends.last().copied().unwrap_or(0));
            return;
        }
        self.times.push(time);
        self.contact_ends.push(self.contacts.len());
        self.ray_ends.push(self.rays.len());
        self.images.tick();
        self.grounds.tick();
        self.open();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::schema::Channel;
    use farsa_body::robots::ArmAndHand;

    #[test]
    fn no_tick_is_kept_beyond_the_room() {
        let schema = || Schema::from_robot(&ArmAndHand::default().robot().unwrap()).with_sensors(["a"]);
        let tick_bytes = 4 * (POSE * schema().body_count() + 1) + 8 + 2 * size_of::<usize>();
        let fill = |recording: &mut Recording, ticks: u32| {
            for tick in 1..=ticks {
                recording.sensors(&[tick as f32]);
                for pair in 0..tick as u16 {
                    recording.contact(PairId(pair), &PairContact::default());
                }
                recording.tick(f64::from(tick));
            }
        };
        let mut whole = Recording::new(schema());
        fill(&mut whole, 9);
        let of_contacts = |ticks: usize| size_of::<Touching>() * ticks * (ticks + 1) / 2;
        let open = 4 * (POSE * schema().body_count() + 1);
        assert_eq!((whole.bytes(), whole.is_cut()), (9 * tick_bytes + open + of_contacts(9), false));
        // The current tick counts, with its contacts.
        let mut cut = Recording::new(schema()).with_room(5 * tick_bytes + open + of_contacts(6));
        fill(&mut cut, 9);
        assert!(cut.is_cut());
        assert_eq!((cut.times(), cut.contacts_at(5).len()), (&whole.times()[..6], 6));
        assert_eq!(cut.bytes(), 6 * tick_bytes + open + of_contacts(6));
        assert!(
            (0..6).all(|tick| cut.row(tick).eq(whole.row(tick)) && cut.contacts_at(tick) == whole.contacts_at(tick))
        );
    }

    #[test]
    fn what_was_told_is_there_and_the_rest_is_unknown() {
        let robot = ArmAndHand::default().robot().unwrap();
        let mut schema = Schema::from_robot(&robot).with_sensors(["a", "b"]).with_outputs(["c"]).with_scalars(["d"]);
        schema.neurons = vec![Channel::new("n")];
        schema.points = vec!["p".into(), "q".into()];
        let mut recording = Recording::new(schema);
        let contact = PairContact { points: 1, force: [1.0, 2.0, 3.0], ..PairContact::default() };
        recording.sensors(&[1.0, 2.0, 9.0]);
        recording.outputs(&[3.0]);
        recording.pose(BodyId(26), Pose::at([1.0, 0.0, 0.0]));
        recording.pose(BodyId(27), Pose::at([1.0, 0.0, 0.0]));
        recording.point(1, [4.0; 3]);
        recording.point(2, [5.0; 3]);
        recording.tick(0.5);
        recording.contact(PairId(7), &contact);
        recording.contact(PairId(8), &contact);
        recording.scalars(&[0.1]);
        recording.neurons(&[]);
        recording.tick(1.0);
        recording.ray([0.0; 3], [1.0; 3], false);
        recording.sensors(&[7.0, 7.0]);

        assert_eq!(recording.times(), [0.5, 1.0]);
        let rows: Vec<Vec<f64>> = (0..3).map(|tick| recording.row(tick).collect()).collect();
        assert_eq!(format!("{:?}", rows[0]), "[NaN, 1.0, 2.0, NaN, 3.0]");
        assert_eq!(format!("{:?}", rows[1]), "[0.1, NaN, NaN, NaN, NaN]");
        assert_eq!(recording.pose_at(0, BodyId(26)).unwrap(), Pose::at([1.0, 0.0, 0.0]));
        assert!(recording.pose_at(1, BodyId(26)).unwrap().position[0].is_nan());
        assert!(recording.pose_at(2, BodyId(26)).is_none() && recording.pose_at(0, BodyId(27)).is_none());
        assert_eq!(recording.point_at(0, 1), Some([4.0; 3]));
        assert_eq!(recording.point_at(0, 2), None);
        assert_eq!((recording.contacts_at(0).len(), recording.contacts_at(1).len()), (0, 2));
        assert_eq!(recording.contacts_at(1)[1].pair, PairId(8));
        // The current tick has not ended.
        assert!(recording.rays_at(1).is_empty() && recording.rays_at(2).is_empty());
    }
}
