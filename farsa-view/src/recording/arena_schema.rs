//! Schema of a planar arena.

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_num::{Scalar, atan2, sin_cos};
use farsa_physics::arena::{Area, AreaShape, Arena, Convex, Cylinder, Wall};

use crate::recording::schema::Schema;
use crate::recording::view::View;
use crate::recording::wheeled_look::{self, Part};
use crate::shape::appearance::{Color, OKABE_ITO, Role};
use crate::shape::geometry::Geometry;
use crate::shape::scene_object::{SceneObject, screen_color};

/// Color of walls without one, dark so that trails along them are visible.
const WALL: Color = [84, 90, 99];
/// Ground around a lamp.
const GLOW: Color = [255, 238, 170];
/// Thickness of the drawn sides of a convex obstacle [m].
const SIDE: f64 = 2e-3;
/// Height of an area above the one below [m].
const LAYER: f64 = 1e-4;
/// Number of robots above which only hulls are shown.
const MAX_WITH_PARTS: usize = 50;

/// Returns a frame on the ground, turned around the vertical.
fn standing([x, y]: [f64; 2], z: f64, heading: f64) -> Pose<f64> {
    let (sine, cosine) = sin_cos(0.5 * heading);
    Pose { position: [x, y, z], rotation: [0.0, 0.0, sine, cosine] }
}

/// Returns `name` for a single item, otherwise `name 1`, `name 2` and so on.
fn numbered(names: &[&str]) -> Vec<String> {
    let mut counted: Vec<(&str, usize)> = Vec::new();
    names
        .iter()
        .map(|name| {
            let at = counted.iter().position(|(known, _)| known == name).unwrap_or_else(|| {
                counted.push((name, 0));
                counted.len() - 1
            });
            counted[at].1 += 1;
            if names.iter().filter(|other| *other == name).nth(1).is_some() {
                format!("{name} {}", counted[at].1)
            } else {
                (*name).into()
            }
        })
        .collect()
}

/// Returns the ground of an arena, endless without a size.
fn ground(arena: &Arena) -> SceneObject {
    let (geometry, middle) = match arena.size {
        Some(size) => (Geometry::Rectangle { half: size.map(|x| 0.5 * x) }, size.map(|x| 0.5 * x)),
        None => (Geometry::Plane, [0.0; 2]),
    };
    SceneObject::new("ground", geometry, standing(middle, 0.0, 0.0), Role::Ground)
        .with_color(screen_color(arena.ground))
}

fn wall(number: usize, wall: &Wall) -> SceneObject {
    let [length, thickness] = wall.size;
    let up = 0.5 * wall.height;
    let geometry = Geometry::Box { half: [0.5 * length, 0.5 * thickness, up] };
    let color = if wall.color == Wall::COLOR { WALL } else { screen_color(wall.color) };
    let name = format!("wall {}", number + 1);
    SceneObject::new(&name, geometry, standing(wall.centre, up, wall.heading), Role::Ground).with_color(color)
}

/// Returns a convex obstacle as thin walls along its outline, on the inside.
fn convex(number: usize, convex: &Convex) -> Vec<SceneObject> {
    let corners = convex.outline();
    let color = if convex.color == Wall::COLOR { WALL } else { screen_color(convex.color) };
    let up = 0.5 * convex.height();
    let side = |i: usize| {
        let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
        let [x, y] = [b[0] - a[0], b[1] - a[1]];
        let length = Scalar::sqrt(x * x + y * y);
        // The outline is counterclockwise, so the inside is on the left.
        let inwards = 0.5 * SIDE / length;
        let middle = [0.5 * (a[0] + b[0]) - inwards * y, 0.5 * (a[1] + b[1]) + inwards * x];
        let geometry = Geometry::Box { half: [0.5 * length, 0.5 * SIDE, up] };
        let name = format!("obstacle {} side {}", number + 1, i + 1);
        SceneObject::new(&name, geometry, standing(middle, up, atan2(y, x)), Role::Ground).with_color(color)
    };
    (0..corners.len()).map(side).collect()
}

fn area(number: usize, area: &Area) -> SceneObject {
    let geometry = match area.shape {
        AreaShape::Circle { radius } => Geometry::Disc { radius },
        AreaShape::Rectangle { size } => Geometry::Rectangle { half: size.map(|x| 0.5 * x) },
    };
    // Where areas overlap, the last one is visible.
    let place = standing([0.0; 2], LAYER * (number + 1) as f64, 0.0);
    SceneObject::new("area", geometry, place, Role::Area).with_color(screen_color(area.color))
}

/// Returns a cylinder in its color, by default yellow for lamps and that of things for others.
fn cylinder(cylinder: &Cylinder) -> SceneObject {
    let up = 0.5 * cylinder.height;
    let geometry = Geometry::Cylinder { radius: cylinder.radius, half_length: up };
    let plain = SceneObject::new("cylinder", geometry, standing([0.0; 2], up, 0.0), Role::Object);
    match cylinder.color {
        color if color != Wall::COLOR => plain.with_color(screen_color(color)),
        _ if cylinder.lamp > 0.0 => plain.with_color(OKABE_ITO[3]),
        _ => plain,
    }
}

impl Schema {
    /// Creates the schema of a planar world from above, with its robots, cylinders and areas in their order.
    ///
    /// A convex obstacle is shown by thin walls along its outline, a lamp on a bright disc. A robot has its own color and a
    /// bright stripe that points ahead. Khepera, e-puck and `MarXbot` have their appearance, other robots are discs on wheels.
    /// More than 50 robots are shown as hulls only.
    ///
    /// ```
    /// use farsa_body::robots::MobileRobot;
    /// use farsa_physics::arena::{Arena, Cylinder};
    /// use farsa_view::Schema;
    ///
    /// let mut arena = Arena::walled(0.4, 0.4);
    /// arena.add_robot(MobileRobot::khepera(), [0.1, 0.2], 0.0);
    /// arena.add_cylinder(Cylinder::new([0.3, 0.2], 0.0125));
    /// let schema = Schema::from_arena(&arena).with_sensors(["front"]);
    /// assert_eq!(schema.bodies, ["Khepera", "cylinder"]);
    /// ```
    pub fn from_arena(arena: &Arena) -> Self {
        let robots = arena.robots.iter().map(|placed| placed.robot.name.as_str());
        let cylinders = arena.cylinders.iter().map(|cylinder| if cylinder.lamp > 0.0 { "lamp" } else { "cylinder" });
        let areas = arena.areas.iter().map(|_| "area");
        let bodies = numbered(&robots.chain(cylinders).chain(areas).collect::<Vec<_>>());
        let mut objects = vec![ground(arena)];
        objects.extend(arena.walls.iter().enumerate().map(|(number, it)| wall(number, it)));
        objects.extend(arena.convexes.iter().enumerate().flat_map(|(number, it)| convex(number, it)));
        let moving = |object: SceneObject, body: BodyId| {
            let name = bodies.get(body.index()).cloned().unwrap_or_default();
            SceneObject { name, ..object.on_body(body) }
        };
        objects.extend(arena.areas.iter().enumerate().map(|(i, it)| moving(area(i, it), arena.area(i))));
        for (i, it) in arena.cylinders.iter().enumerate() {
            let body = arena.cylinder(i);
            if it.lamp > 0.0 {
                let disc = Geometry::Disc { radius: 5.0 * it.radius };
                let place = standing([0.0; 2], LAYER * (arena.areas.len() + 1) as f64, 0.0);
                let glow = SceneObject::new("", disc, place, Role::Area).with_color(GLOW);
                objects.push(SceneObject { name: format!("{} light", bodies[body.index()]), ..glow.on_body(body) });
            }
            objects.push(moving(cylinder(it), body));
        }
        let look = if arena.robots.len() > MAX_WITH_PARTS { wheeled_look::hull } else { wheeled_look::parts };
        for (number, placed) in arena.robots.iter().enumerate() {
            for Part { name, geometry, place, color } in look(&placed.robot) {
                let name = format!("{} {name}", bodies[number]);
                let part = SceneObject::new(name.trim_end(), geometry, place, Role::Robot).with_color(color);
                objects.push(part.on_body(BodyId(number as u16)));
            }
        }
        Self { bodies, objects, view: View::Top, ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_body::Recorder as _;
    use farsa_body::ports::Kinematics;
    use farsa_body::robots::MobileRobot;
    use farsa_physics::arena::World;

    use crate::recording::memory::Recording;

    #[test]
    fn every_part_of_an_arena_is_seen_in_its_place() {
        let mut arena = Arena::walled(1.0, 0.5);
        arena.add_robot(MobileRobot::khepera(), [0.2, 0.2], 0.5);
        arena.add_robot(MobileRobot::khepera(), [0.4, 0.2], 0.0);
        arena.add_robot(MobileRobot::e_puck(), [0.6, 0.2], -1.0);
        arena.add_cylinder(Cylinder { lamp: 1.0, ..Cylinder::new([0.8, 0.2], 0.01) });
        arena.add_cylinder(Cylinder { color: [1.0, 0.0, 0.0], ..Cylinder::new([0.9, 0.4], 0.02) });
        arena.add_area(Area::circle([0.5, 0.4], 0.05, [0.0, 1.0, 0.0]));
        arena.add_area(Area::rectangle([0.1, 0.4], [0.1, 0.05], 0.3, [0.0, 0.0, 1.0]));
        let schema = Schema::from_arena(&arena);
        assert_eq!(schema.bodies, ["Khepera 1", "Khepera 2", "e-puck", "lamp", "cylinder", "area 1", "area 2"]);
        // The ground, four walls, two areas, two cylinders, a light, two Kheperas and an e-puck with their parts.
        let parts = |robot: &MobileRobot| wheeled_look::parts(robot).len();
        let robots = 2 * parts(&MobileRobot::khepera()) + parts(&MobileRobot::e_puck());
        assert_eq!(schema.objects.len(), 1 + 4 + 2 + 3 + robots);
        let world = World::new(&arena).unwrap();
        assert!(schema.shown().eq((0..7).map(BodyId)));
        for object in schema.objects.iter().filter(|object| object.role != Role::Ground) {
            let body = object.body.unwrap();
            assert!(object.name.starts_with(&schema.bodies[body.index()]), "{}", object.name);
            let at = world.pose(body).cast::<f64>().compose(&object.placement).position;
            let placed = arena.robots.get(body.index());
            let position = world.pose(body).position.map(f64::from);
            let reach = placed.map_or(0.0, |placed| placed.robot.radius);
            let off = [0, 1].map(|k| at[k] - position[k]);
            assert!(off[0].hypot(off[1]) <= reach, "{}", object.name);
            if let (Some(placed), true) = (placed, object.name.ends_with(" ahead")) {
                let (sine, cosine) = sin_cos(placed.heading);
                assert!(off[0] * cosine + off[1] * sine > 0.3 * reach, "{}", object.name);
            }
        }
        let inner: Vec<f64> = schema.objects[1..5]
            .iter()
            .map(|object| {
                let Geometry::Box { half } = object.geometry else { panic!("{object:?}") };
                let at = object.placement.position;
                if half[0] > half[1] { (at[1] - 0.25).abs() - half[1] } else { (at[0] - 0.5).abs() - half[0] }
            })
            .collect();
        assert!(inner.iter().zip([0.25, 0.25, 0.5, 0.5]).all(|(a, b)| (a - b).abs() < 1e-12), "{inner:?}");
        let mut recording = Recording::new(schema);
        (0..7).for_each(|body| recording.pose(BodyId(body), world.pose(BodyId(body))));
        recording.tick(0.0);
        assert!(crate::Page::new("x").with("y", recording).html().contains("Khepera 2 ahead"));
    }

    #[test]
    fn robots_of_every_kind_are_looked_at() {
        let mut arena = Arena::walled(0.5, 0.3);
        let cart = MobileRobot { name: "cart".into(), wheel_radius: 0.02, track: 0.06, ..MobileRobot::khepera() };
        let painted = MobileRobot { color: [0.85, 0.15, 0.1], ..MobileRobot::e_puck() };
        let [small, large] = [[0.06, 0.22], [0.4, 0.15]];
        arena.add_robot(MobileRobot::khepera(), small, 0.5);
        arena.add_robot(MobileRobot::e_puck(), [0.15, 0.22], 0.5);
        arena.add_robot(painted, [0.24, 0.22], 0.5);
        arena.add_robot(MobileRobot { height: 0.06, ..cart }, [0.06, 0.08], 0.5);
        arena.add_robot(MobileRobot { color: [0.1, 0.25, 0.85], ..MobileRobot::khepera() }, [0.15, 0.08], 2.5);
        arena.add_robot(MobileRobot::marxbot(), large, 0.5);
        let world = World::new(&arena).unwrap();
        let mut recording = Recording::new(Schema::from_arena(&arena));
        (0..6).for_each(|body| recording.pose(BodyId(body), world.pose(BodyId(body))));
        recording.tick(0.0);
        let picture = recording.picture(0).unwrap();
        assert_eq!(picture.shapes.len(), recording.schema().objects.len());
        if let Some(path) = std::env::var_os("FARSA_LOOK") {
            let file = |name: &str| std::path::Path::new(&path).join(name);
            for camera in ["top", "three-quarter"] {
                let camera_of = crate::Camera::named(camera).unwrap();
                std::fs::write(file(&format!("robots-{camera}.png")), picture.png(camera_of, [1000, 700]).unwrap())
                    .unwrap();
                std::fs::write(file(&format!("robots-{camera}.svg")), picture.svg(camera_of, [1000, 700], "p"))
                    .unwrap();
            }
            std::fs::write(file("robots.html"), crate::Page::new("robots").with("all", recording).html()).unwrap();
        }
    }

    #[test]
    fn a_convex_obstacle_is_seen_by_its_sides() {
        let mut arena = Arena::walled(0.6, 0.5);
        arena.add_robot(MobileRobot::khepera(), [0.1, 0.1], 0.9);
        let hexagon: [[f64; 2]; 6] = core::array::from_fn(|i| {
            let (y, x) = sin_cos(core::f64::consts::TAU * i as f64 / 6.0);
            [0.08 * x, 0.08 * y]
        });
        arena.add_convex(Convex::prism(&hexagon, 0.1).placed([0.3, 0.25], 0.3));
        arena.add_convex(Convex::prism(&[[0.6, 0.5], [0.5, 0.5], [0.6, 0.4]], 0.05).with_color([0.8, 0.2, 0.1]));
        let schema = Schema::from_arena(&arena);
        let sides: Vec<&SceneObject> =
            schema.objects.iter().filter(|object| object.name.starts_with("obstacle")).collect();
        assert_eq!((sides.len(), sides[8].color), (9, Some([204, 51, 26])));
        assert_eq!(schema.bodies, ["Khepera"]);
        // Outer edges are the sides, and both ends of each are corners.
        let corners: Vec<[f64; 2]> = arena.convexes.iter().flat_map(Convex::outline).collect();
        for object in &sides {
            let Geometry::Box { half } = object.geometry else { panic!("{object:?}") };
            for end in [-half[0], half[0]] {
                let [x, y, z] = object.placement.transform([end, -half[1], -half[2]]);
                let near = |corner: &[f64; 2]| (corner[0] - x).hypot(corner[1] - y) < 1e-12;
                assert!(corners.iter().any(near) && z.abs() < 1e-12, "{object:?}");
            }
        }
        if let Some(path) = std::env::var_os("FARSA_LOOK") {
            let mut picture = crate::picture::moment::Picture::default();
            picture.shapes.extend(schema.objects.iter().map(|object| {
                object.placed(&if object.body.is_some() {
                    standing([0.1, 0.1], 0.0, 0.9).cast()
                } else {
                    Pose::identity()
                })
            }));
            let corners = [[-0.03, -0.03, 0.0], [0.63, 0.53, 0.0]];
            picture.frame = corners.into();
            let path = std::path::Path::new(&path).join("obstacles.svg");
            std::fs::write(path, picture.svg(crate::picture::camera::Camera::for_view(View::Top), [600, 500], "p"))
                .unwrap();
        }
    }

    #[test]
    fn a_plane_without_end_has_ground_and_no_walls() {
        let mut arena = Arena::new();
        arena.add_robot(MobileRobot::marxbot(), [0.0, 0.0], 0.0);
        let schema = Schema::from_arena(&arena);
        assert_eq!(schema.objects[0].geometry, Geometry::Plane);
        assert_eq!(schema.bodies, ["MarXbot"]);
        assert_eq!(schema.objects.len(), 1 + wheeled_look::parts(&MobileRobot::marxbot()).len());
        // A hull and a stripe each.
        for _ in 0..50 {
            arena.add_robot(MobileRobot::marxbot(), [0.0, 0.0], 0.0);
        }
        assert_eq!(Schema::from_arena(&arena).objects.len(), 1 + 2 * 51);
    }
}
