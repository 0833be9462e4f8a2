//! Food and foragers in recordings and animations.

use farsa_body::ports::BodyId;
use farsa_body::robots::MobileRobot;
use farsa_body::{Pose, Recorder};
use farsa_view::shape::{Color, Geometry, OKABE_ITO, Role, SceneObject};
use farsa_view::{Channel, ImageChannel, Schema};

use crate::arena::field::Field;

/// Most cells along a side of a field that is drawn. Smaller food would be invisible.
const MAX_CELLS: usize = 64;
/// Most robots with drawn marks of death and load.
const MAX_ROBOTS: usize = 50;
/// Color of food, on the ground and on robots.
const FOOD: Color = OKABE_ITO[2];
/// Colors of the cover of a dead robot and of the bar across it.
const COVER: Color = [22, 22, 25];
const BAR: Color = [235, 235, 230];
/// Size of the cover relative to the robot.
const AROUND: f64 = 1.02;

fn energy(robot: usize) -> String {
    format!("energy {}", robot + 1)
}

fn carried(robot: usize) -> String {
    format!("carried {}", robot + 1)
}

impl Field {
    /// Lists the channels of [`scalars`](Self::scalars): the energy of each robot, `energy 1`..., and its food,
    /// `carried 1`...
    pub(crate) fn channels(&self) -> Vec<Channel> {
        let of_robot = |robot| {
            [Channel::new(&energy(robot)).group("energy").range(0.0, 1.0), Channel::new(&carried(robot)).group("food")]
        };
        (0..self.robots().len()).flat_map(of_robot).collect()
    }

    /// Iterates over the energy and the food load of each robot.
    pub(crate) fn scalars(&self) -> impl Iterator<Item = f64> + '_ {
        self.robots().iter().flat_map(|forager| [forager.energy, f64::from(forager.carried)])
    }

    /// Adds the food to a schema as its last image, on the ground. The schema has or will have these
    /// [`channels`](Self::channels).
    ///
    /// A ball marks a robot with food, and a dark cover with a bar a dead one. `robots` are the first bodies. Fields
    /// with more than 64 cells along a side are not drawn, nor are marks of more than 50 robots.
    #[must_use]
    pub(crate) fn shown_in(&self, mut schema: Schema, robots: &[&MobileRobot]) -> Schema {
        if let Some(cells) = self.shown_cells() {
            schema.images.push(ImageChannel::new("food", [cells; 2]).on_ground([0.0; 2], self.size()));
        }
        if robots.len() <= MAX_ROBOTS {
            for (number, robot) in robots.iter().enumerate() {
                let name = schema.bodies.get(number).cloned().unwrap_or_default();
                schema.objects.extend(marks(number, robot, &name));
            }
        }
        schema
    }

    /// Records the food as the image of this number, which [`shown_in`](Self::shown_in) added to the schema.
    pub(crate) fn record(&self, image: usize, recorder: &mut dyn Recorder) {
        if self.shown_cells().is_none() {
            return;
        }
        let color = FOOD.map(|shade| f32::from(shade) / 255.0);
        for (cell, food) in self.food().iter().enumerate() {
            recorder.pixel(image, cell, if *food { color } else { [0.0; 3] });
        }
    }

    /// Returns the cells along a side of a drawn field.
    fn shown_cells(&self) -> Option<usize> {
        Some(self.cells()).filter(|cells| (1..=MAX_CELLS).contains(cells))
    }
}

/// Lists the marks of a robot's load and death.
fn marks(number: usize, robot: &MobileRobot, name: &str) -> Vec<SceneObject> {
    let (body, above) = (BodyId(number as u16), AROUND * robot.height);
    let on = |what: &str, geometry, placement, color| {
        let mark = SceneObject::new(&format!("{name} {what}"), geometry, placement, Role::Robot);
        mark.on_body(body).with_color(color)
    };
    let ball = 0.35 * robot.radius;
    let load = on("load", Geometry::Sphere { radius: ball }, Pose::at([0.0, 0.0, robot.height + ball]), FOOD);
    let cover = Geometry::Cylinder { radius: AROUND * robot.radius, half_length: 0.5 * above };
    let thick = 0.01 * robot.height;
    let bar = Geometry::Box { half: [0.16 * robot.radius, 0.75 * robot.radius, thick] };
    let dead = [
        on("dead", cover, Pose::at([0.0, 0.0, 0.5 * above]), COVER),
        on("dead", bar, Pose::at([0.0, 0.0, above + thick]), BAR),
    ];
    // A dead robot has exactly the energy 0, and a robot in action has more.
    let dead = dead.map(|mark| mark.shown_while(&energy(number), 0.0, 0.0));
    // Any load shows the ball. The upper bound of 1e9 is no limit in practice.
    [load.shown_while(&carried(number), 1.0, 1e9)].into_iter().chain(dead).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_view::Recording;

    #[test]
    fn food_loads_and_deaths_are_seen_when_they_are_there() {
        let robot = MobileRobot::e_puck();
        let mut field = Field::new([2.0, 1.0], 4, 0.25, 0.1, 2);
        field.begin([0.1, 0.1]);
        let bodies = vec!["e-puck 1".into(), "e-puck 2".into()];
        let schema = Schema { bodies, scalars: field.channels(), ..Schema::default() };
        let mut recording = Recording::new(field.shown_in(schema, &[&robot, &robot]));
        // The first robot takes food and dies with it. The second delivers it.
        for (number, source) in [[[0.6, 0.4], [1.9, 0.9]], [[0.7, 0.4], [1.9, 0.9]], [[1.2, 0.4], [0.1, 0.1]]]
            .into_iter()
            .chain([[[1.2, 0.4], [0.1, 0.1]]])
            .enumerate()
        {
            for (robot, at) in source.into_iter().enumerate() {
                field.step(robot, at);
                recording.pose(BodyId(robot as u16), Pose::planar(at.map(|x| x as f32), 0.3));
            }
            field.record(0, &mut recording);
            recording.scalars(&field.scalars().collect::<Vec<_>>());
            recording.tick(number as f64);
        }
        let lit = |tick| recording.image_at(tick, 0).unwrap().filter(|color| color[1] > 0.5).count();
        assert_eq!([0, 1, 2, 3].map(lit), [14, 14, 12, 12]);
        let cell = recording.image_at(0, 0).unwrap().position(|color| color == [0.0; 3]);
        assert_eq!(cell, Some(1 + 4));
        // Balls and bars on the robots in each step.
        let seen = |tick: usize, robot: usize, what: fn(&Geometry) -> bool| {
            let at = recording.pose_at(tick, BodyId(robot as u16)).unwrap().position;
            let picture = recording.picture(tick).unwrap();
            let here = |place: &[f64; 3]| [0, 1].iter().all(|&k| (place[k] - f64::from(at[k])).abs() < 1e-6);
            picture.shapes.iter().filter(|shape| here(&shape.pose.position) && what(&shape.geometry)).count()
        };
        let is_load = |geometry: &Geometry| matches!(geometry, Geometry::Sphere { .. });
        let is_bar = |geometry: &Geometry| matches!(geometry, Geometry::Box { .. });
        assert_eq!([0, 1, 2, 3].map(|tick| seen(tick, 0, is_load)), [1, 1, 1, 0]);
        assert_eq!([0, 1, 2, 3].map(|tick| seen(tick, 1, is_load)), [1, 1, 0, 0]);
        assert_eq!([0, 1, 2, 3].map(|tick| seen(tick, 0, is_bar)), [0, 0, 0, 1]);
        assert_eq!([0, 1, 2, 3].map(|tick| seen(tick, 1, is_bar)), [0; 4]);
    }

    /// An e-puck has a radius of 0.035 m and a height of 0.05 m. Its load is a ball of 0.35 radii on top, and the cover of a
    /// dead one is 2 % larger, with a bar of 1 % of the height on it.
    #[test]
    fn marks_have_the_sizes_of_their_robots() {
        let found = marks(1, &MobileRobot::e_puck(), "e-puck 2");
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} where {b} is wanted");
        let [load, cover, bar] = &found[..] else { panic!("{found:?}") };
        let Geometry::Sphere { radius } = load.geometry else { panic!("{load:?}") };
        close(radius, 0.01225);
        let Geometry::Cylinder { radius, half_length } = cover.geometry else { panic!("{cover:?}") };
        close(radius, 0.0357);
        close(half_length, 0.0255);
        let Geometry::Box { half } = bar.geometry else { panic!("{bar:?}") };
        half.into_iter().zip([0.0056, 0.02625, 0.0005]).for_each(|(a, b)| close(a, b));
        for (mark, name, height, color, shown) in [
            (load, "e-puck 2 load", 0.06225, [0, 158, 115], ("carried 2", 1.0, 1e9)),
            (cover, "e-puck 2 dead", 0.0255, [22, 22, 25], ("energy 2", 0.0, 0.0)),
            (bar, "e-puck 2 dead", 0.0515, [235, 235, 230], ("energy 2", 0.0, 0.0)),
        ] {
            assert_eq!((&*mark.name, mark.body, mark.color), (name, Some(BodyId(1)), Some(color)));
            mark.placement.position.into_iter().zip([0.0, 0.0, height]).for_each(|(a, b)| close(a, b));
            let condition = mark.shown.as_ref().expect("a condition");
            assert_eq!((&*condition.channel, condition.low, condition.high), shown, "{name}");
        }
        let field = Field::new([2.0, 1.0], 4, 0.25, 0.1, 2);
        let channels: Vec<_> = field.channels().into_iter().map(|channel| (channel.name, channel.range)).collect();
        let (energy, food) = (Some([0.0, 1.0]), None);
        let wanted = [("energy 1", energy), ("carried 1", food), ("energy 2", energy), ("carried 2", food)];
        assert_eq!(channels, wanted.map(|(name, range)| (name.to_owned(), range)));
        let schema = field.shown_in(Schema::default(), &[]);
        let [image] = &schema.images[..] else { panic!("{:?}", schema.images) };
        assert_eq!((image.size, image.ground), ([4, 4], Some([[0.0, 0.0], [2.0, 1.0]])));
        let mut recording = Recording::new(schema);
        field.record(0, &mut recording);
        recording.tick(0.0);
        let color = recording.image_at(0, 0).and_then(|mut pixels| pixels.next()).expect("a pixel");
        color.into_iter().zip([0.0, 158.0, 115.0]).for_each(|(a, b)| assert!((255.0 * a - b).abs() < 1.0, "{color:?}"));
    }

    #[test]
    fn what_nobody_could_tell_apart_is_not_shown() {
        let robot = MobileRobot::khepera();
        let shown = |cells, robots: usize| {
            let field = Field::new([1.0; 2], cells, 0.01, 0.1, robots);
            let schema = field.shown_in(Schema::default(), &vec![&robot; robots]);
            let mut recording = Recording::new(schema.clone());
            field.record(0, &mut recording);
            recording.tick(0.0);
            (schema.images.len(), recording.image_at(0, 0).is_some(), schema.objects.len())
        };
        assert_eq!(shown(64, 50), (1, true, 150));
        assert_eq!(shown(65, 51), (0, false, 0));
        assert_eq!(shown(0, 1), (0, false, 3));
    }
}
