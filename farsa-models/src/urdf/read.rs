//! A robot from a URDF file.

use std::collections::BTreeMap;

use farsa_body::Pose;
use farsa_body::actuators::{Law, Torque};
use farsa_body::ports::{BodyId, JointId};
use farsa_body::robot::{Collider, Joint, JointKind, MassProperties, Robot, Segment};

use crate::bounds::{ENDLESS, range_from_file};
use crate::context::Context;
use crate::drawn::{DrawnMesh, bounded};
use crate::error::{ReadError, repeated};
use crate::frame::Frame;
use crate::repair::repair_masses;
use crate::urdf::elements::{NOTED, check_children, check_processed};
use crate::urdf::geometry::{Placed, joined, origin, solid};
use crate::urdf::visuals::{MeshCollider, collision_meshes, colors, visuals};
use crate::urdf::write::MAX_SPEED;
use crate::vector::norm;
use crate::xml::tree::{Element, Tree};

/// Name of a root link that is the world itself.
const WORLD: &str = "world";

/// Joint that carries each link, and the order in which links are made.
struct Links<'t> {
    names: BTreeMap<&'t str, usize>,
    elements: Vec<Element<'t>>,
    /// Joint of every link.
    joints: Vec<Option<Element<'t>>>,
    parents: Vec<Option<usize>>,
}

/// Robot, frames and drawn meshes of a model.
type Model = (Robot, Vec<Frame>, Vec<DrawnMesh>);

pub(crate) fn read(tree: &Tree, context: &mut Context<'_>) -> Result<Model, ReadError> {
    let root = tree.root();
    root.check_open(&["name", "version"], &mut context.warnings)?;
    check_processed(root)?;
    check_children(root, &["link", "joint", "material"], &NOTED, context)?;
    let colors = colors(root);
    let links = Links::from_model(root)?;
    let order = links.order()?;
    let mut robot = Robot::new(root.attribute("name").unwrap_or_default());
    let mut locations = Vec::new();
    let mut frames = Vec::new();
    let mut looks = Vec::new();
    let mut bodies: Vec<Option<BodyId>> = vec![None; links.elements.len()];
    for index in order {
        let link = links.elements[index];
        let name = link.needed("name")?;
        let (mass, given) = inertial(link, context)?;
        let joint = match (links.joints[index], links.parents[index]) {
            (Some(element), Some(parent)) => Some((joint(element, context)?, bodies[parent])),
            _ if name == WORLD && !given => None,
            _ if context.options.floating => Some((Joint::floating(Pose::identity()), None)),
            _ => Some((Joint::fixed(Pose::identity()), None)),
        };
        if let Some((joint, parent)) = joint {
            if joint.kind == JointKind::Floating && parent.is_some() {
                let element = links.joints[index].unwrap_or(link);
                return Err(element.unsupported("a floating joint on a link; only links on the world can float"));
            }
            bodies[index] = Some(robot.add_segment(Segment::new(name, parent, joint, mass)));
            locations.push(link.place());
            if let Some(id) = bodies[index] {
                motor(&mut robot, id, links.joints[index])?;
            }
        }
        frames.push(Frame { name: name.into(), body: bodies[index], placement: Pose::identity() });
        let touching = collisions(&mut robot, bodies[index], link, context)?;
        looks.push((bodies[index], link, touching));
    }
    names(&mut robot);
    let repair = context.options.repair;
    repair_masses(&mut robot, &locations, &repair, &mut context.warnings)?;
    // Meshes of visuals come last, so that their files leave the limits to those that the robot needs.
    let looks = looks.iter().flat_map(|(body, link, touching)| {
        let meshes = visuals(&mut robot, *body, *link, &colors, context);
        let looks_otherwise = meshes.iter().any(|mesh| !mesh.triangles.is_empty())
            || robot.visuals.iter().any(|visual| visual.body == *body);
        let touching = if looks_otherwise && body.is_some() { &[] } else { touching.as_slice() };
        [meshes, collision_meshes(*body, touching, context)].concat()
    });
    let meshes = bounded(looks.collect());
    Ok((robot, frames, meshes))
}

impl<'t> Links<'t> {
    fn from_model(root: Element<'t>) -> Result<Self, ReadError> {
        let links: Vec<Element<'t>> = root.all("link").collect();
        if links.is_empty() {
            return Err(root.missing("link"));
        }
        let mut names: BTreeMap<&str, usize> = BTreeMap::new();
        for (i, link) in links.iter().enumerate() {
            if let Some(first) = names.insert(link.needed("name")?, i) {
                return Err(twice("link", link, &links[first]));
            }
        }
        let mut joints: Vec<Option<Element<'t>>> = vec![None; links.len()];
        let mut parents = vec![None; links.len()];
        let mut links_by_name: BTreeMap<&str, Element<'t>> = BTreeMap::new();
        for joint in root.all("joint") {
            if let Some(first) = links_by_name.insert(joint.needed("name")?, joint) {
                return Err(twice("joint", &joint, &first));
            }
            let [parent, child] = ["parent", "child"].map(|end| -> Result<usize, ReadError> {
                let element = joint.one(end)?.ok_or_else(|| joint.missing(end))?;
                let name = element.needed("link")?;
                names.get(name).copied().ok_or_else(|| element.unknown("link", name, names.keys().copied()))
            });
            let (parent, child) = (parent?, child?);
            if let Some(first) = joints[child].replace(joint) {
                return Err(twice("joint that carries the same link as", &joint, &first));
            }
            parents[child] = Some(parent);
        }
        let roots: Vec<usize> = (0..links.len()).filter(|link| parents[*link].is_none()).collect();
        let tree = Self { names, elements: links, joints, parents };
        match roots.as_slice() {
            [] => Err(tree.cycle(0)),
            [_] => Ok(tree),
            [_, second, ..] => {
                let names: Vec<_> = roots.iter().map(|root| tree.name(*root)).collect();
                let why =
                    format!("{} links hang on nothing ({}); a robot has one root", names.len(), first_names(&names));
                Err(ReadError::Malformed { place: tree.elements[*second].place(), why })
            }
        }
    }

    fn name(&self, link: usize) -> String {
        self.elements[link].attribute("name").unwrap_or_default().into()
    }

    /// The loop that going from a link to its parents ends in.
    fn cycle(&self, from: usize) -> ReadError {
        let mut seen = vec![false; self.elements.len()];
        let mut link = from;
        while !seen[link] {
            seen[link] = true;
            link = self.parents[link].unwrap_or(link);
        }
        let first = link;
        let mut names = vec![self.name(first)];
        while let Some(parent) = self.parents[link].filter(|parent| *parent != first) {
            names.push(self.name(parent));
            link = parent;
        }
        let why = format!("links carry each other: {}", first_names(&names));
        ReadError::Malformed { place: self.elements[first].place(), why }
    }

    /// Gets the links in the file's order, but parents before their children.
    fn order(&self) -> Result<Vec<usize>, ReadError> {
        debug_assert_eq!(self.names.len(), self.elements.len());
        let mut order = Vec::with_capacity(self.elements.len());
        let mut placed = vec![false; self.elements.len()];
        let mut path = Vec::new();
        for link in 0..self.elements.len() {
            let mut next = Some(link).filter(|link| !placed[*link]);
            while let Some(current) = next {
                // More links on the way up than there are: some came twice.
                if path.len() > self.elements.len() {
                    return Err(self.cycle(link));
                }
                path.push(current);
                next = self.parents[current].filter(|parent| !placed[*parent]);
            }
            while let Some(current) = path.pop() {
                placed[current] = true;
                order.push(current);
            }
        }
        Ok(order)
    }
}

/// Formats the first names of a list.
fn first_names(names: &[String]) -> String {
    let shown: Vec<&str> = names.iter().take(8).map(String::as_str).collect();
    let rest = if names.len() > shown.len() { ", ..." } else { "" };
    format!("{}{rest}", shown.join(", "))
}

fn twice(what: &str, second: &Element<'_>, first: &Element<'_>) -> ReadError {
    repeated(second.place(), what, first.attribute("name").unwrap_or_default(), first.place().line)
}

/// Returns a link's mass in its frame, and whether the file has one.
fn inertial(link: Element<'_>, context: &mut Context<'_>) -> Result<(MassProperties, bool), ReadError> {
    link.check_open(&["name"], &mut context.warnings)?;
    check_children(link, &["inertial", "collision", "visual"], &NOTED, context)?;
    let Some(inertial) = link.one("inertial")? else {
        return Ok((MassProperties { mass: 0.0, centre: [0.0; 3], inertia: [0.0; 6] }, false));
    };
    check_children(inertial, &["origin", "mass", "inertia"], &[], context)?;
    let element = inertial.one("mass")?.ok_or_else(|| inertial.missing("mass"))?;
    element.check_open(&["value"], &mut context.warnings)?;
    let mass = element.number("value")?.ok_or_else(|| element.missing("value"))?;
    if mass < 0.0 {
        return Err(element.wrong("value", element.needed("value")?, "but must not be negative"));
    }
    let element = inertial.one("inertia")?.ok_or_else(|| inertial.missing("inertia"))?;
    let parts = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"];
    element.check_open(&parts, &mut context.warnings)?;
    let mut inertia = [0.0; 6];
    for (to, part) in inertia.iter_mut().zip(parts) {
        *to = element.number(part)?.ok_or_else(|| element.missing(part))?;
    }
    let body = MassProperties { mass, centre: [0.0; 3], inertia };
    let origin = origin(inertial, context)?;
    // Without a turn the numbers stay as they are.
    let turned = origin.rotation != Pose::identity().rotation;
    let placed = if turned { body.placed(&origin) } else { MassProperties { centre: origin.position, ..body } };
    Ok((placed, mass > 0.0))
}

fn joint(element: Element<'_>, context: &mut Context<'_>) -> Result<Joint, ReadError> {
    element.check_open(&["name", "type"], &mut context.warnings)?;
    let ignored = [
        ("mimic", "joints do not follow each other: it moves on its own"),
        ("calibration", "of a real robot"),
        ("joint_properties", "an old element that other programs skip; `dynamics` gives damping"),
        ("safety_controller hardwareInterface", "of a real robot"),
    ];
    let read = ["origin", "parent", "child", "axis", "limit", "dynamics"];
    check_children(element, &read, &ignored, context)?;
    let placement = origin(element, context)?;
    let kinds = ["revolute", "continuous", "prismatic", "fixed", "floating", "planar", "spherical"];
    let kind = element.word("type", &kinds)?.ok_or_else(|| element.missing("type"))?;
    let name = element.needed("name")?;
    let single = match kind {
        "revolute" | "continuous" => JointKind::Revolute,
        "prismatic" => JointKind::Prismatic,
        "fixed" => return Ok(Joint { name: name.into(), ..Joint::fixed(placement) }),
        "floating" => return Ok(Joint { name: name.into(), ..Joint::floating(placement) }),
        _ => return Err(element.unsupported(format!("{kind} joints cannot be described; two or three joints can"))),
    };
    let mut axis = [1.0, 0.0, 0.0];
    if let Some(given) = element.one("axis")? {
        given.check_open(&["xyz"], &mut context.warnings)?;
        axis = given.array::<3>("xyz")?.ok_or_else(|| given.missing("xyz"))?;
        if norm(&axis) <= 1e-6 {
            return Err(given.wrong("xyz", given.needed("xyz")?, "but must be a direction"));
        }
    }
    let (mut range, mut speed_limit) = ([f64::NEG_INFINITY, f64::INFINITY], None);
    if let Some(limit) = element.one("limit")? {
        let read = ["lower", "upper", "effort", "velocity"];
        limit.check_open(&read, &mut context.warnings)?;
        if context.options.joint_speeds {
            speed_limit = largest_speed(limit)?;
        } else if limit.attribute("velocity").is_some() {
            context.warnings.add(limit.place(), "limit `velocity`", "is not read without the option `joint_speeds`");
        }
        if kind != "continuous" {
            let end = |name| Ok(limit.list(name, 1, 1)?.map_or(0.0, |list| list[0]));
            let [low, high] = [end("lower")?, end("upper")?];
            range = range_from_file([low, high]);
            if low > high {
                return Err(limit.wrong(
                    "upper",
                    limit.attribute("upper").unwrap_or("0"),
                    "but must not be below lower",
                ));
            }
        }
    } else if kind != "continuous" {
        return Err(element.missing("limit"));
    }
    let mut made = Joint { range, speed_limit, ..Joint::revolute(name, axis, placement, range) };
    made.kind = single;
    if let Some(dynamics) = element.one("dynamics")? {
        dynamics.check_open(&["damping", "friction"], &mut context.warnings)?;
        for (name, number) in [("damping", &mut made.damping), ("friction", &mut made.friction)] {
            *number = dynamics.number(name)?.unwrap_or(0.0);
            if *number < 0.0 {
                let value = dynamics.attribute(name).unwrap_or_default();
                return Err(dynamics.wrong(name, value, "but must not be negative"));
            }
        }
    }
    Ok(made)
}

/// Returns the largest speed of a joint. A speed of 0 and the writer's number for a free joint are no limits.
fn largest_speed(limit: Element<'_>) -> Result<Option<f64>, ReadError> {
    let speed = limit.list("velocity", 1, 1)?.map_or(0.0, |list| list[0]);
    if speed < 0.0 {
        let text = limit.attribute("velocity").unwrap_or_default();
        return Err(limit.wrong("velocity", text, "but must not be negative"));
    }
    Ok(Some(speed).filter(|speed| *speed > 0.0 && *speed < MAX_SPEED))
}

/// A motor for a joint that has a largest effort.
fn motor(robot: &mut Robot, body: BodyId, element: Option<Element<'_>>) -> Result<(), ReadError> {
    let joint = &robot.segments[body.index()].joint;
    let Some(limit) = element.map(|joint| joint.one("limit")).transpose()?.flatten() else { return Ok(()) };
    let effort = limit.list("effort", 1, 1)?.map_or(0.0, |list| list[0]);
    if effort < 0.0 {
        return Err(limit.wrong("effort", limit.attribute("effort").unwrap_or_default(), "but must not be negative"));
    }
    if joint.kind.is_single() && effort > 0.0 {
        let name = joint.name.clone();
        let limit = if effort >= ENDLESS { f64::INFINITY } else { effort };
        robot.add_actuator(&name, JointId(body.0), Law::Torque(Torque { limit }));
    }
    Ok(())
}

/// Adds the colliders of a link, and returns those of meshes.
fn collisions<'t>(
    robot: &mut Robot,
    body: Option<BodyId>,
    link: Element<'t>,
    context: &mut Context<'_>,
) -> Result<Vec<MeshCollider<'t>>, ReadError> {
    let mut solids: Vec<Placed> = Vec::new();
    let mut elements = Vec::new();
    for collision in link.all("collision") {
        collision.check_open(&["name"], &mut context.warnings)?;
        check_children(collision, &["origin", "geometry"], &NOTED, context)?;
        let placement = origin(collision, context)?;
        let geometry = collision.one("geometry")?.ok_or_else(|| collision.missing("geometry"))?;
        if let Some(solid) = solid(geometry, context)? {
            let name = collision.attribute("name").unwrap_or_default().to_owned();
            solids.push((name, solid, placement, collision.place()));
            elements.push(geometry.all("mesh").next());
        }
    }
    let mut touching = Vec::new();
    for (first, shape, placement) in joined(&solids, "collision", context) {
        let collider = robot.add_collider(Collider::new(&solids[first].0, body, shape, placement));
        touching.extend(elements[first].map(|element| MeshCollider { element, collider, placement: solids[first].2 }));
    }
    Ok(touching)
}

/// Gives new names to colliders without a name, or with the name of another.
fn names(robot: &mut Robot) {
    // Each with how often it was desired.
    let mut taken: BTreeMap<String, usize> = BTreeMap::new();
    for i in 0..robot.colliders.len() {
        let collider = &robot.colliders[i];
        let segment = collider.body.map_or(WORLD, |body| robot.segments[body.index()].name.as_str());
        let wanted = if collider.name.is_empty() { format!("{segment}_collision") } else { collider.name.clone() };
        let mut name = wanted.clone();
        if let Some(count) = taken.get_mut(&wanted) {
            *count += 1;
            name = format!("{wanted}_{count}");
            while taken.contains_key(&name) {
                name.push('_');
            }
        }
        taken.insert(name.clone(), 1);
        robot.colliders[i].name = name;
    }
}
