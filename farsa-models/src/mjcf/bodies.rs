//! Bodies of an MJCF file: joints, inertias, geoms.

use std::collections::{BTreeMap, BTreeSet};

use farsa_body::Pose;
use farsa_body::ports::{BodyId, JointId};
use farsa_body::robot::{Collider, Joint, JointKind, MassProperties, Robot, RobotError, Segment, Visual};

use crate::context::Context;
use crate::drawn::DrawnMesh;
use crate::error::{ReadError, SourceLocation};
use crate::frame::Frame;
use crate::mesh::solid::scaled;
use crate::mjcf::classes::{Classed, Classes};
use crate::mjcf::compiler::{Compiler, ROTATIONS};
use crate::mjcf::drawn::{MeshGeom, drawn};
use crate::mjcf::geoms::{CONDITIONAL, MeshAssets, check_geom, geom};
use crate::mjcf::inertials::{body_mass, bounded};
use crate::mjcf::inverse_weight::inverse_weights;
use crate::mjcf::items::{Item, items};
use crate::mjcf::joints::{BodyJoint, check_joint, joint};
use crate::mjcf::limits::Limits;
use crate::mjcf::names::Names;
use crate::mjcf::reasons::SHOW;
use crate::repair::CHANGED;
use crate::warnings::Warnings;
use crate::xml::tree::Element;

/// One body of the file. The first is the world.
pub(crate) struct Body {
    pub(crate) segment: Option<BodyId>,
    pub(crate) parent: usize,
    /// Body whose motion it shares: itself, or the first above that moves, or the world.
    pub(crate) carrier: usize,
}

/// A geom that became a collider.
pub(crate) struct Geom<'t, 'c> {
    pub(crate) classed: Classed<'t, 'c>,
    pub(crate) body: usize,
    pub(crate) collider: usize,
}

/// Sources of the bodies, and lookups for other sections.
pub(crate) struct Bodies<'t, 'c> {
    model: Element<'t>,
    compiler: &'c Compiler,
    classes: &'c Classes<'t>,
    meshes: MeshAssets<'t, 'c>,
    pub(crate) names: Names,
    pub(crate) frames: Vec<Frame>,
    pub(crate) list: Vec<Body>,
    pub(crate) by_name: BTreeMap<String, usize>,
    pub(crate) joints: BTreeMap<String, JointId>,
    /// Segments of each body with several joints, with their origins in the body's frame.
    chains: Vec<Vec<(BodyId, [f64; 3])>>,
    /// Largest efforts of joints.
    pub(crate) efforts: Vec<(JointId, f64, SourceLocation)>,
    /// Joints whose position in the configuration of the file is not 0.
    pub(crate) references: Vec<(BodyId, f64)>,
    /// Numbers of the limits of joints.
    limits: Vec<(BodyId, Limits)>,
    pub(crate) geoms: Vec<Geom<'t, 'c>>,
    /// Geoms of meshes that may be drawn.
    mesh_geoms: Vec<MeshGeom<'t>>,
    /// Geoms that pairs name.
    paired: BTreeSet<&'t str>,
    joint_number: usize,
    geom_number: usize,
}

/// A body that is yet to be read.
struct Waiting<'t> {
    element: Element<'t>,
    parent: usize,
    class: usize,
    /// Enclosing frame, in the parent's.
    within: Pose<f64>,
}

/// A body that is about to become segments.
struct Piece<'n, 't> {
    element: Element<'t>,
    name: &'n str,
    /// Segment that it hangs on.
    carrying: Option<BodyId>,
    /// Frame in that segment's frame.
    placement: Pose<f64>,
    mass: MassProperties,
}

impl<'t, 'c> Bodies<'t, 'c> {
    pub(crate) fn new(
        model: Element<'t>,
        compiler: &'c Compiler,
        classes: &'c Classes<'t>,
        context: &mut Context<'_>,
    ) -> Result<Self, ReadError> {
        for element in classes.elements() {
            match element.tag() {
                "joint" => check_joint(element, &mut context.warnings)?,
                "geom" => check_geom(element, &mut context.warnings)?,
                _ => {}
            }
        }
        let pairs = model.all("contact").flat_map(|contact| contact.all("pair"));
        let paired = pairs.flat_map(|pair| [pair.attribute("geom1"), pair.attribute("geom2")]).flatten().collect();
        Ok(Self {
            model,
            compiler,
            classes,
            meshes: MeshAssets::from_model(model, classes, &mut context.warnings)?,
            names: Names::default(),
            frames: Vec::new(),
            list: vec![Body { segment: None, parent: 0, carrier: 0 }],
            by_name: BTreeMap::from([("world".to_owned(), 0)]),
            joints: BTreeMap::new(),
            chains: Vec::new(),
            efforts: Vec::new(),
            references: Vec::new(),
            limits: Vec::new(),
            geoms: Vec::new(),
            mesh_geoms: Vec::new(),
            paired,
            joint_number: 0,
            geom_number: 0,
        })
    }

    /// Reads all bodies into the robot. `locations` gets the line of each segment.
    pub(crate) fn read(
        &mut self,
        robot: &mut Robot,
        locations: &mut Vec<SourceLocation>,
        context: &mut Context<'_>,
    ) -> Result<(), ReadError> {
        let worlds: Vec<Element<'t>> = self.model.all("worldbody").collect();
        self.take_names(&worlds)?;
        for world in worlds {
            world.check(&[], &[], &mut context.warnings)?;
            let items = items(world, self.classes.main(), self.compiler, self.classes, context)?;
            self.colliders(robot, 0, &Pose::identity(), &items, context)?;
            if let Some((joint, ..)) =
                items.iter().find(|(e, ..)| ["joint", "freejoint", "inertial"].contains(&e.tag()))
            {
                return Err(joint.unsupported("the world neither moves nor has a mass"));
            }
            // A stack and no recursion: bodies may be nested as deep as the limits allow. The first child is on top, so
            // that segments come in the file's order, parents before their children.
            let mut waiting = Self::waiting(0, &items);
            while let Some(next) = waiting.pop() {
                let (index, items) = self.body(robot, locations, &next, context)?;
                waiting.extend(Self::waiting(index, &items));
            }
        }
        Ok(())
    }

    /// Takes all names that the file declares, so that no generated one is a name that comes later.
    fn take_names(&mut self, worlds: &[Element<'t>]) -> Result<(), ReadError> {
        let mut open = worlds.to_vec();
        while let Some(element) = open.pop() {
            let kind = match element.tag() {
                "body" => Some("body"),
                "joint" | "freejoint" => Some("joint"),
                "geom" => Some("geom"),
                _ => None,
            };
            if let Some(kind) = kind {
                self.names.declare(kind, element)?;
            }
            // The top of the stack is the next element, so children are pushed in reverse.
            let children: Vec<_> = element.children().collect();
            open.extend(children.into_iter().rev());
        }
        Ok(())
    }

    /// Gets the bodies among the items, the first last.
    fn waiting(parent: usize, items: &[Item<'t>]) -> Vec<Waiting<'t>> {
        let bodies = items.iter().rev().filter(|(element, ..)| element.tag() == "body");
        bodies.map(|&(element, within, class)| Waiting { element, parent, class, within }).collect()
    }

    /// Reads one body and returns its number and items.
    fn body(
        &mut self,
        robot: &mut Robot,
        locations: &mut Vec<SourceLocation>,
        next: &Waiting<'t>,
        context: &mut Context<'_>,
    ) -> Result<(usize, Vec<Item<'t>>), ReadError> {
        let Waiting { element, parent, within, .. } = *next;
        check_body(element, &mut context.warnings)?;
        let class = match element.attribute("childclass") {
            Some(name) => self.classes.find(element, name)?,
            None => next.class,
        };
        let items = items(element, class, self.compiler, self.classes, context)?;
        let index = self.list.len();
        let name = element.attribute("name").filter(|name| !name.is_empty()).map(str::to_owned);
        let name = name.unwrap_or_else(|| self.names.generate("body", format!("body{index}")));

        let (carrying, carrying_frame) = self.frames_of(parent);
        let placed = within.compose(&self.compiler.pose(Some(element), Some(element))?);
        let placement = carrying_frame.compose(&placed);
        let mut mass = body_mass(element, &items, self.compiler, self.classes, &self.meshes, context)?;
        if let Some(changed) = bounded(&mass, &self.compiler.repair, placed.position) {
            mass = changed;
            context.warnings.add(element.place(), "mass or inertia", CHANGED);
        }
        let joints = self.joints_of(element, &items, context)?;
        check_free(element, parent, &joints)?;

        let moves = !joints.is_empty();
        let piece = Piece { element, name: &name, carrying, placement, mass };
        let (segment, frame) = if moves {
            self.jointed(robot, locations, &piece, joints, context)
        } else {
            let fixed = Segment::new(&name, carrying, Joint::fixed(placement), mass);
            locations.push(element.place());
            (Some(robot.add_segment(fixed)), Pose::identity())
        };

        let carrier = if moves { index } else { self.list[parent].carrier };
        self.list.push(Body { segment, parent, carrier });
        self.by_name.insert(name.clone(), index);
        self.frames.push(Frame { name, body: segment, placement: frame });
        self.colliders(robot, index, &frame, &items, context)?;
        Ok((index, items))
    }

    /// Adds a segment for each joint of a body. Returns the last segment, and the body's frame in it.
    ///
    /// A MuJoCo body may have several joints, which act one after the other. A description has one joint a segment, so
    /// all joints except the last carry a segment without a body of the file. It gets a small share of the mass,
    /// because a moving segment must have one.
    fn jointed(
        &mut self,
        robot: &mut Robot,
        locations: &mut Vec<SourceLocation>,
        piece: &Piece<'_, 't>,
        joints: Vec<BodyJoint>,
        context: &mut Context<'_>,
    ) -> (Option<BodyId>, Pose<f64>) {
        let Piece { element, name, carrying, placement, mass } = *piece;
        let (count, share) = (joints.len(), context.options.between);
        // The body's frame in that of the last segment. Before the first joint it is the body's place.
        let (mut last, mut frame, mut chain) = (carrying, placement, Vec::with_capacity(count));
        for (i, BodyJoint { joint, anchor, reference, effort, limits }) in joints.into_iter().enumerate() {
            // A segment's frame is at its joint: the anchor is the origin, and the body's frame is off by minus the anchor.
            let at_anchor = frame.compose(&Pose::at(anchor));
            let joint = Joint { placement: at_anchor.compose(&joint.placement), ..joint };
            frame = Pose::at(anchor.map(|x| -x));
            let is_last = i + 1 == count;
            let (segment, part) = if is_last {
                (name.to_owned(), 1.0 - share * (count - 1) as f64)
            } else {
                (self.names.generate("body", format!("{name}_{}", joint.name)), share)
            };
            let part = scaled(&mass, part);
            let part = MassProperties { centre: [0, 1, 2].map(|k| part.centre[k] - anchor[k]), ..part };
            let single = joint.kind.is_single().then(|| joint.name.clone());
            let id = robot.add_segment(Segment::new(&segment, last, joint, part));
            if let Some(joint) = single {
                self.joints.insert(joint, JointId(id.0));
                self.efforts.extend(effort.map(|(largest, place)| (JointId(id.0), largest, place)));
                self.limits.extend(limits.map(|limits| (id, limits)));
                self.references.extend((reference != 0.0).then_some((id, reference)));
            }
            locations.push(element.place());
            chain.push((id, anchor));
            last = Some(id);
        }
        if count > 1 {
            context.warnings.add(
                element.place(),
                "body with several joints",
                "got segments with a share of its mass between",
            );
            self.chains.push(chain);
        }
        (last, frame)
    }

    /// Gives joints with limits the stops that their inverse weights make of MuJoCo's numbers.
    pub(crate) fn set_stops(&self, robot: &mut Robot) -> Result<(), RobotError> {
        if self.limits.is_empty() {
            return Ok(());
        }
        let weights = inverse_weights(robot)?.joints;
        for (id, limits) in &self.limits {
            robot.segments[id.index()].joint.stop = Some(limits.stop(weights[id.index()]));
        }
        Ok(())
    }

    /// Gives segments between the joints of a body their share of the mass that the body took over from others.
    pub(crate) fn share_masses(&self, robot: &mut Robot, share: f64) {
        let put = |segment: &mut Segment, mass: &MassProperties, origin: [f64; 3]| {
            (segment.mass, segment.inertia) = (mass.mass, mass.inertia);
            segment.centre = [0, 1, 2].map(|k| mass.centre[k] - origin[k]);
        };
        for chain in &self.chains {
            let [between @ .., (last, origin)] = chain.as_slice() else { continue };
            let back = Pose::at(*origin);
            let mass = robot.segments[last.index()].mass_properties().placed(&back);
            if mass.mass == 0.0 || between.iter().any(|(id, _)| robot.segments[id.index()].mass > 0.0) {
                continue;
            }
            put(&mut robot.segments[last.index()], &scaled(&mass, 1.0 - share * between.len() as f64), *origin);
            for (id, anchor) in between {
                put(&mut robot.segments[id.index()], &scaled(&mass, share), *anchor);
            }
        }
    }

    /// Reads the meshes that views draw.
    pub(crate) fn drawn(&self, robot: &Robot, context: &mut Context<'_>) -> Vec<DrawnMesh> {
        drawn(&self.mesh_geoms, robot, (&self.meshes, self.compiler), context)
    }

    /// The segment of a body and where its frame is in it.
    fn frames_of(&self, body: usize) -> (Option<BodyId>, Pose<f64>) {
        match body.checked_sub(1) {
            None => (None, Pose::identity()),
            Some(i) => (self.frames[i].body, self.frames[i].placement),
        }
    }

    /// Gets the joints of a body, each with its placement from where the last left the frame, and its anchor.
    fn joints_of(
        &mut self,
        body: Element<'t>,
        items: &[Item<'t>],
        context: &mut Context<'_>,
    ) -> Result<Vec<BodyJoint>, ReadError> {
        let mut joints = Vec::new();
        for (element, within, class) in items {
            let number = self.joint_number;
            let made = match element.tag() {
                "freejoint" => {
                    element.check(&["name"], &[("align group", "how MuJoCo computes")], &mut context.warnings)?;
                    BodyJoint::free(*element)
                }
                "joint" => {
                    check_joint(*element, &mut context.warnings)?;
                    let classed = self.classes.with(*element, *class)?;
                    let name = element.attribute("name").filter(|name| !name.is_empty()).map(str::to_owned);
                    let name = name.unwrap_or_else(|| self.names.generate("joint", format!("joint{number}")));
                    joint(&classed, &name, within, self.compiler, context)?
                }
                _ => continue,
            };
            self.joint_number += 1;
            joints.push(made);
        }
        if joints.len() > 6 {
            return Err(body.unsupported("more than six joints"));
        }
        Ok(joints)
    }

    /// Makes colliders of the geoms of a body, whose frame is at `frame` in its segment's.
    fn colliders(
        &mut self,
        robot: &mut Robot,
        body: usize,
        frame: &Pose<f64>,
        items: &[Item<'t>],
        context: &mut Context<'_>,
    ) -> Result<(), ReadError> {
        for (element, within, class) in items.iter().filter(|(element, ..)| element.tag() == "geom") {
            check_geom(*element, &mut context.warnings)?;
            let classed = self.classes.with(*element, *class)?;
            let number = self.geom_number;
            self.geom_number += 1;
            element.skip(&CONDITIONAL);
            // The checks of a geom's numbers come with its pairs. Here any bit will do.
            let bits = |name| Ok::<_, ReadError>(classed.number(name)?.unwrap_or(1.0) != 0.0);
            let touches = bits("contype")? | bits("conaffinity")?;
            let own = element.attribute("name").filter(|name| !name.is_empty());
            let named = own.is_some_and(|name| self.paired.contains(name));
            let segment = self.list[body].segment;
            let placed = |collider| {
                let of_file = (&classed, self.compiler, self.model);
                MeshGeom::new(of_file, (segment, &frame.compose(within)), collider)
            };
            if classed.text("type") == Some("mesh") && !touches && !named {
                match placed(None) {
                    Some(geom) => self.mesh_geoms.push(geom),
                    None => context.warnings.add(element.place(), "geom of a mesh that touches nothing", SHOW),
                }
                element.leave();
                continue;
            }
            let Some((solid, at)) = geom(&classed, within, self.compiler, &self.meshes, context)? else {
                element.leave();
                continue;
            };
            let (shape, inner, why) = solid.shape(context.options);
            if let Some(why) = why {
                context.warnings.add(element.place(), format!("geom {}", solid.label()), why);
            }
            let placement = frame.compose(&at).compose(&inner);
            // As models have it: what is drawn only touches nothing and is of group 1 or 2.
            let group = classed.number("group")?;
            if !touches && !named && (group == Some(1.0) || group == Some(2.0)) {
                let color =
                    classed.list("rgba", 4, 4)?.map(|rgba| [rgba[0], rgba[1], rgba[2]].map(|x| x.clamp(0.0, 1.0)));
                robot.add_visual(Visual { color, ..Visual::new(segment, shape, placement) });
                continue;
            }
            if element.attribute("rgba").is_some() {
                context.warnings.add(element.place(), "geom `rgba`", SHOW);
            }
            let name = own.map(str::to_owned);
            let name = name.unwrap_or_else(|| self.names.generate("geom", format!("geom{number}")));
            let collider = robot.add_collider(Collider::new(&name, segment, shape, placement));
            self.mesh_geoms.extend(placed(Some(collider)));
            self.geoms.push(Geom { classed, body, collider });
        }
        Ok(())
    }
}

fn check_body(element: Element<'_>, warnings: &mut Warnings) -> Result<(), ReadError> {
    let read = [&["name", "pos", "childclass"][..], &ROTATIONS].concat();
    let ignored = [
        ("mocap", "the body stands fixed"),
        ("gravcomp", "weights are not compensated"),
        ("user simple fuse sleep", "how MuJoCo computes"),
    ];
    element.check(&read, &ignored, warnings)
}

/// Refuses a free joint on a body within another or next to other joints, which MuJoCo's format excludes.
fn check_free(body: Element<'_>, parent: usize, joints: &[BodyJoint]) -> Result<(), ReadError> {
    if joints.iter().any(|BodyJoint { joint, .. }| joint.kind == JointKind::Floating) {
        if parent != 0 {
            return Err(body.unsupported("a free joint on a body; only bodies in the world can be free"));
        }
        if joints.len() > 1 {
            return Err(body.unsupported("a free joint beside others"));
        }
    }
    Ok(())
}
