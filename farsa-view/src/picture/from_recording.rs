//! Pictures of a tick of a recording.

use farsa_body::Pose;
use farsa_body::ports::BodyId;

use crate::picture::moment::{Beam, Picture, Push};
use crate::recording::memory::Recording;
use crate::recording::schema::Channel;
use crate::recording::view::View;
use crate::shape::appearance::{Color, Instance, OKABE_ITO, Role, as_screens_take_it};
use crate::shape::geometry::Geometry;
use crate::shape::scene_object::{SceneObject, ShownWhile, screen_color};
use crate::shape::vector::{Vector, length, sub};

/// Height of trails above the ground [m].
const TRAIL: f64 = 1e-3;
/// Radius of marks of images on the ground, relative to the side of a pixel, and their height above areas [m].
const MARK: f64 = 0.15;
const MARK_ABOVE: f64 = 5e-4;
/// Colors of trails, those of best contrast to the ground first.
const TRAILS: [usize; 6] = [4, 5, 2, 6, 0, 1];
/// Color of the trails of points.
const PENCIL: Color = [96, 96, 96];

impl Recording {
    /// Creates the picture of a tick, in the same way as `farsa draw`.
    ///
    /// If the tick does not exist, or if the schema has no bodies, this returns `None`. A view from above also shows
    /// trails up to this tick, for robots, colored things and points.
    pub fn picture(&self, tick: usize) -> Option<Picture> {
        let schema = self.schema();
        if tick >= self.times().len() || (schema.robot.is_none() && schema.objects.is_empty()) {
            return None;
        }
        let mut picture = Picture::default();
        let pose = |body| self.pose_at(tick, body).map_or_else(Pose::identity, |pose| pose.cast());
        if let Some(robot) = &schema.robot {
            picture.add_robot(robot, pose);
        }
        let place = |object: &SceneObject| object.placed(&object.body.map_or_else(Pose::identity, pose));
        let seen = conditions(self, tick);
        picture.shapes.extend(schema.objects.iter().filter(|object| seen(object)).map(place));
        picture.shapes.extend(lying(self, tick));
        if schema.view == View::Top {
            picture.trails = trails(self, tick);
            // The frame contains fixed objects, so that an arena is complete.
            let walls = picture.shapes.iter().filter(|placed| matches!(placed.geometry, Geometry::Box { .. }));
            let corners = |placed: &Instance| {
                placed.geometry.hull().into_iter().map(|(corner, _)| placed.pose.transform(corner)).collect::<Vec<_>>()
            };
            picture.frame = walls.flat_map(corners).collect();
        }
        let f64_of = |position: [f32; 3]| position.map(f64::from);
        picture.contacts = (self.contacts_at(tick).iter())
            .map(|contact| Push { point: f64_of(contact.point), force: f64_of(contact.force) })
            .collect();
        picture.rays = (self.rays_at(tick).iter())
            .map(|ray| Beam { from: f64_of(ray.from), to: f64_of(ray.to), hit: ray.met })
            .collect();
        let point = |(index, name): (usize, &String)| {
            let position = self.point_at(tick, index)?;
            position.iter().all(|x| x.is_finite()).then(|| (name.clone(), f64_of(position)))
        };
        picture.points = schema.points.iter().enumerate().filter_map(point).collect();
        Some(picture)
    }
}

impl Recording {
    /// Returns the words of a tick, of all scalars that have words, such as the phase or an instruction.
    pub fn words(&self, tick: usize) -> Vec<String> {
        let values = if tick < self.times().len() { self.row(tick).collect() } else { Vec::new() };
        let word = |(channel, value): (&Channel, &f64)| {
            (*value >= 0.0).then(|| channel.words.get(*value as usize).cloned()).flatten()
        };
        self.schema().scalars.iter().zip(&values).filter_map(word).collect()
    }
}

/// Returns the visible objects of a tick.
fn conditions(recording: &Recording, tick: usize) -> impl Fn(&SceneObject) -> bool {
    let columns = recording.schema().columns();
    let values: Vec<f64> = recording.row(tick).collect();
    move |object| {
        let Some(ShownWhile { channel, low, high }) = &object.shown else { return true };
        let value = columns.iter().zip(&values).find(|(column, _)| *column == channel);
        value.is_some_and(|(_, value)| (low..=high).contains(&value))
    }
}

/// Lists the marks of images on the ground at a tick, a disc for each pixel that is not black.
fn lying(recording: &Recording, tick: usize) -> Vec<Instance> {
    let mut marks = Vec::new();
    for (number, image) in recording.schema().images.iter().enumerate() {
        let (Some([from, to]), [columns, rows]) = (image.ground, image.size) else { continue };
        let cell = [(to[0] - from[0]) / columns as f64, (to[1] - from[1]) / rows as f64];
        let geometry = Geometry::Disc { radius: MARK * cell[0].abs().min(cell[1].abs()) };
        for (pixel, color) in recording.image_at(tick, number).into_iter().flatten().enumerate() {
            if color == [0.0; 3] {
                continue;
            }
            let at = [pixel % columns, pixel / columns];
            let [x, y] = [0, 1].map(|k| from[k] + (at[k] as f64 + 0.5) * cell[k]);
            let mark = Instance::new(geometry, Pose::at([x, y, MARK_ABOVE]), Role::Area);
            marks.push(mark.with_color(screen_color(color.map(f64::from))));
        }
    }
    marks
}

/// Lists the trails of robots, colored things and points up to a tick, a little above the ground.
///
/// The trail of a robot has the color of its hull, that of a point a pencil color.
fn trails(recording: &Recording, tick: usize) -> Vec<(Vec<Vector>, Color)> {
    let schema = recording.schema();
    let bodies: Vec<BodyId> =
        schema.objects.iter().filter(|object| object.role == Role::Robot).filter_map(|object| object.body).collect();
    let mut seen = Vec::new();
    let mut trails = Vec::new();
    let mut add = |places: &mut dyn Iterator<Item = [f32; 3]>, color: Color| {
        let mut way: Vec<Vector> = Vec::new();
        for place in places.map(|place| place.map(f64::from)) {
            let place = [place[0], place[1], TRAIL];
            let moved = way.last().is_none_or(|last| length(sub(place, *last)) > 1e-4);
            if moved && place.iter().all(|x| x.is_finite()) {
                way.push(place);
            }
        }
        if way.len() > 1 {
            trails.push((way, color));
        }
    };
    let places = |body: BodyId| (0..=tick).filter_map(move |tick| Some(recording.pose_at(tick, body)?.position));
    for body in bodies {
        if !seen.contains(&body) {
            seen.push(body);
            add(&mut places(body), OKABE_ITO[TRAILS[(seen.len() - 1) % TRAILS.len()]]);
        }
    }
    for collider in schema.robot.iter().flat_map(|robot| &robot.colliders) {
        let Some((body, color)) = collider.body.zip(collider.color) else { continue };
        if schema.is_thing(body) && !seen.contains(&body) {
            seen.push(body);
            add(&mut places(body), as_screens_take_it(color));
        }
    }
    for point in 0..schema.points.len() {
        add(&mut (0..=tick).filter_map(|tick| recording.point_at(tick, point)), PENCIL);
    }
    trails
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::page::html::Page;
    use crate::picture::camera::Camera;
    use crate::recording::schema::{ImageChannel, Schema};
    use farsa_body::Recorder;
    use farsa_body::robots::ArmAndHand;

    fn recording(ticks: u32) -> Recording {
        let robot = ArmAndHand::default().robot().unwrap();
        let mut recording = Recording::new(Schema::from_robot(&robot));
        for tick in 1..=ticks {
            recording.pose(ArmAndHand::PALM, Pose::at([0.1 * tick as f32, 0.0, 0.0]));
            recording.tick(0.01 * f64::from(tick));
        }
        recording
    }

    #[test]
    fn only_bodies_can_be_drawn() {
        assert!(Recording::new(Schema::from_scalars(["x"])).picture(0).is_none());
        let recording = recording(2);
        let robot = recording.schema().robot.as_ref().unwrap();
        assert_eq!(recording.picture(1).unwrap().shapes.len(), robot.colliders.len());
        assert_eq!(recording.picture(2), None, "there are two ticks");
    }

    #[test]
    fn things_keep_their_colours_and_leave_trails_seen_from_above_as_points_do() {
        let mut robot = farsa_body::robot::Robot::new("one ball");
        let ball = farsa_body::robot::MassProperties::sphere(0.3, 0.06);
        let body = robot.add_sliding_body("ball", Pose::identity(), ball, false);
        let shape = farsa_body::robot::Shape::Sphere { radius: 0.06 };
        let collider = farsa_body::robot::Collider::new("ball", Some(body), shape, Pose::identity());
        robot.add_collider(collider.with_color([1.0, 0.0, 0.5]));
        let mut recording =
            Recording::new(Schema { view: View::Top, points: vec!["tip".into()], ..Schema::from_robot(&robot) });
        for tick in 0..4_u8 {
            recording.pose(body, Pose::at([0.1 * f32::from(tick), 0.0, 0.0]));
            recording.point(0, [0.0, f32::from(tick), 0.5]);
            recording.tick(f64::from(tick));
        }
        let picture = recording.picture(2).unwrap();
        assert_eq!((picture.shapes[0].color(), picture.shapes[0].role), ([255, 0, 128], Role::Object));
        let [(way, color), (of_point, pencil)] = &picture.trails[..] else { panic!("{:?}", picture.trails) };
        assert_eq!((way.len(), *color, of_point.len(), *pencil), (3, [255, 0, 128], 3, PENCIL));
        assert!((way[2][0] - 0.2).abs() < 1e-7 && of_point[2] == [0.0, 2.0, TRAIL]);
        assert!(Page::new("ball").with("a", recording).html().contains("\"color\":\"#ff0080\""));
    }

    #[test]
    fn what_is_shown_at_times_is_in_the_picture_and_in_the_page_then() {
        let ball = |name: &str| {
            SceneObject::new(name, Geometry::Sphere { radius: 0.1 }, Pose::identity(), Role::Robot).on_body(BodyId(0))
        };
        let mut schema = Schema::from_scalars(["energy [J]", "load"]).with_sensors(["load"]);
        schema.bodies = vec!["robot".into()];
        schema.objects = vec![
            ball("body"),
            ball("load").shown_while("load", 1.0, f64::INFINITY),
            ball("sensed").shown_while("sensor.load", 0.25, 0.5),
            ball("dead").shown_while("energy [J]", 0.0, 0.0),
            ball("never").shown_while("loads", f64::NEG_INFINITY, f64::INFINITY),
        ];
        let mut recording = Recording::new(schema);
        for (energy, load, sensed) in [(1.0, 0.0, 0.0), (0.5, 1.0, 0.25), (f64::NAN, 3.0, 0.5), (0.0, f64::NAN, 0.6)] {
            recording.scalars(&[energy, load]);
            recording.sensors(&[sensed]);
            recording.tick(0.0);
        }
        let shown = |tick| recording.picture(tick).unwrap().shapes.len();
        assert_eq!([0, 1, 2, 3].map(shown), [1, 3, 3, 2]);
        let html = Page::new("p").with("a", recording).html();
        for part in ["\"shown\":[1,1.0,1.79769", "\"shown\":[2,0.25,0.5]", "\"shown\":[0,0.0,0.0]"] {
            assert!(html.contains(part), "{part}");
        }
        assert!(html.matches("\"shown\":").count() == 3 && !html.contains("\"never\""));
    }

    #[test]
    fn words_of_a_tick_are_those_of_its_values() {
        let phase = Channel::new("phase").words(&["reach", "lift"]);
        let object = Channel::new("object").words(&["red", "green"]);
        let schema = Schema { scalars: vec![phase, Channel::new("x"), object], ..Schema::default() };
        let mut recording = Recording::new(schema);
        for values in [[0.0, 1.0, 1.0], [1.0, 0.0, f64::NAN], [2.0, 0.0, -1.0]] {
            recording.scalars(&values);
            recording.tick(0.0);
        }
        assert_eq!([0, 1, 2, 3].map(|tick| recording.words(tick).join(" ")), ["reach green", "lift", "", ""]);
    }

    #[test]
    fn pixels_that_are_not_black_are_marks_on_the_ground() {
        let mut recording = arena();
        let food = ImageChannel::new("food", [4, 2]).on_ground([-0.2, 0.1], [0.2, -0.1]);
        let schema = Schema { images: vec![ImageChannel::new("eye", [1, 1]), food], ..recording.schema().clone() };
        recording = Recording::new(schema);
        for tick in 0..3 {
            recording.pixel(0, 0, [1.0; 3]);
            (0..8).filter(|pixel| *pixel != 5).for_each(|pixel| recording.pixel(1, pixel, [0.0, 1.0, 0.0]));
            recording.pixel(1, tick, [0.0; 3]);
            recording.tick(0.0);
        }
        let marks = |tick| -> Vec<[f64; 2]> {
            let picture = recording.picture(tick).unwrap();
            let green = |shape: &&Instance| shape.color == Some([0, 255, 0]);
            assert!(picture.shapes.iter().filter(green).all(|shape| shape.role == Role::Area));
            let at = |shape: &Instance| [0, 1].map(|k| (1e6 * shape.pose.position[k]).round() / 1e6);
            picture.shapes.iter().filter(green).map(at).collect()
        };
        let row = |y: f64, columns: &[f64]| columns.iter().map(|&x| [x, y]).collect::<Vec<_>>();
        let second = row(-0.05, &[-0.15, 0.05, 0.15]);
        assert_eq!(marks(0), [row(0.05, &[-0.05, 0.05, 0.15]), second.clone()].concat());
        assert_eq!(marks(2), [row(0.05, &[-0.15, -0.05, 0.15]), second].concat());
    }

    /// A round robot on a quarter of a circle between walls, and a post.
    fn arena() -> Recording {
        let on_ground = |x: f64, y: f64, z: f64| Pose::at([x, y, z]);
        let (robot, post) = (BodyId(0), BodyId(1));
        let hull = Geometry::Cylinder { radius: 0.035, half_length: 0.015 };
        let wall = Geometry::Box { half: [0.2, 0.005, 0.02] };
        let schema = Schema {
            bodies: vec!["robot".into(), "post".into()],
            objects: vec![
                SceneObject::new("ground", Geometry::Rectangle { half: [0.2; 2] }, Pose::identity(), Role::Ground),
                SceneObject::new("nest", Geometry::Disc { radius: 0.05 }, on_ground(0.1, 0.1, 0.0), Role::Area),
                SceneObject::new("north", wall, on_ground(0.0, 0.205, 0.02), Role::Ground),
                SceneObject::new("south", wall, on_ground(0.0, -0.205, 0.02), Role::Ground),
                SceneObject::new("hull", hull, on_ground(0.0, 0.0, 0.015), Role::Robot).on_body(robot),
                SceneObject::new("post", hull, on_ground(0.0, 0.0, 0.015), Role::Object)
                    .on_body(post)
                    .with_color([200, 30, 30]),
            ],
            view: View::Top,
            ..Schema::default()
        };
        let mut recording = Recording::new(schema);
        for tick in 0..=20u8 {
            let (sine, cosine) = farsa_num::sin_cos(f32::from(tick) * 0.078);
            recording.pose(robot, Pose::at([0.1 * cosine - 0.1, 0.1 * sine, 0.0]));
            recording.pose(post, Pose::at([-0.1, -0.05, 0.0]));
            recording.ray([0.0; 3], [0.05, 0.0, 0.0], tick % 2 == 0);
            recording.tick(0.05 * f64::from(tick));
        }
        recording
    }

    #[test]
    fn an_arena_shows_its_props_and_the_way_of_its_robot() {
        let recording = arena();
        let picture = recording.picture(20).unwrap();
        assert_eq!((picture.shapes.len(), picture.trails.len(), picture.rays.len()), (6, 1, 1));
        assert_eq!(picture.trails[0].0.len(), 21);
        // The eight corners of each of two walls.
        assert_eq!(picture.frame.len(), 8 * 2);
        let place = picture.shapes[4].pose.position;
        let (_, cosine) = farsa_num::sin_cos(20.0_f64 * 0.078);
        assert!((place[0] - (0.1 * cosine - 0.1)).abs() < 1e-6 && place[2] == 0.015, "{place:?}");
        assert_eq!(picture.shapes[5].color(), [200, 30, 30]);
        let svg = picture.svg(Camera::for_view(View::Top), [600, 600], "p");
        assert!(svg.starts_with("<svg") && svg.contains("<title>"), "{svg}");
        let page = Page::new("arena").with("a", recording).html();
        for part in ["\"kind\":\"cylinder\"", "\"role\":\"area\"", "\"color\":\"#c81e1e\"", "\"robot\",\"post\""] {
            assert!(page.contains(part), "{part}");
        }
        if let Some(path) = std::env::var_os("FARSA_LOOK") {
            std::fs::write(std::path::Path::new(&path).join("arena.svg"), svg).unwrap();
            std::fs::write(std::path::Path::new(&path).join("arena.html"), page).unwrap();
        }
    }
}
