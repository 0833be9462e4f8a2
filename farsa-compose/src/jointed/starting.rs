//! Initial placements of joints and things.

use farsa_body::Twist;
use farsa_body::ports::{BodyId, JointId};
use farsa_body::robot::JointKind;
use farsa_lab::Error;
use farsa_num::Stream;

use crate::check::source::Source;
use crate::document::Document;
use crate::jointed::SpatialWorld;
use crate::jointed::registered::{self, PartOfSpatial};
use crate::jointed::scene::{ROBOT, Scene};
use crate::jointed::things::What;
use crate::part::object::SpatialStart;
use crate::part::spot::Spot;
use crate::parts::rule_of::RuleOf;

/// A placement with its part.
#[derive(Clone, Debug)]
struct Rule {
    what: Placed,
    /// Greatest distance of the surface from the center [m].
    reach: f64,
    start: Box<dyn SpatialStart>,
}

/// A part that a trial places.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Placed {
    Joint(JointId),
    Body(BodyId),
    Marker(usize),
}

/// Placements of a trial.
#[derive(Clone, Debug)]
pub(crate) struct Starting {
    rules: Vec<Rule>,
    /// Positions of markers without a rule.
    markers: Vec<[f32; 3]>,
    /// Positions placed earlier, with their reach [m].
    before: Vec<([f32; 3], f64)>,
    /// Numbers of the chosen points, by rule.
    chosen: Vec<usize>,
}

impl Starting {
    /// Reads the placements of a document.
    pub(crate) fn new(document: &Document, scene: &Scene, source: &Source) -> Result<Self, Error> {
        let mut rules: Vec<Rule> = Vec::new();
        for (index, start) in document.start.iter().enumerate() {
            let path = format!("/start/{index}");
            let (what, reach) = named(&start.place, scene, &path, source)?;
            let is_joint = matches!(what, Placed::Joint(_));
            let is_of_joints = source.registry.start(&start.how).is_some_and(|start| start.is_of_joints());
            if is_of_joints != is_joint {
                let why = if is_joint { "is for things; a joint is `turned`" } else { "is for joints; this is none" };
                return Err(source.wrong(&format!("{path}/at"), why));
            }
            let rule = Some(RuleOf { document, number: index, placed: &[] });
            let part = PartOfSpatial { scene, wiring: None, rule, sensors: &[], path: &path, source };
            let made = registered::start(&start.how, part)?;
            if rules.iter().any(|other| other.what == what) {
                return Err(source.wrong(&format!("{path}/place"), format!("`{}` is placed twice", start.place)));
            }
            rules.push(Rule { what, reach, start: made });
        }
        for (index, (object, thing)) in document.objects.iter().zip(&scene.things).enumerate() {
            let what = match thing.what {
                What::Body(body) => Some(Placed::Body(body)),
                What::Marker(number) => Some(Placed::Marker(number)),
                What::Wall => None,
            };
            let path = format!("/objects/{index}");
            if object.at.is_none() && what.is_none() {
                return Err(source.wrong(&path, "lacks the key `at`: no trial places walls"));
            }
            if object.at.is_none() && !rules.iter().any(|rule| Some(rule.what) == what) {
                return Err(source.wrong(&path, "lacks the key `at`, and no `[[start]]` places it"));
            }
        }
        let markers = scene.markers.iter().map(|marker| marker.at.map(|x| x as f32)).collect();
        let (before, chosen) = (Vec::with_capacity(rules.len()), vec![0; rules.len()]);
        Ok(Self { rules, markers, before, chosen })
    }

    /// Places all parts, by draws in the order of the rules. Returns false if one finds no place.
    pub(crate) fn arrange<W: SpatialWorld>(
        &mut self,
        world: &mut W,
        markers: &mut [[f32; 3]],
        stream: &mut Stream,
    ) -> bool {
        let Self { rules, markers: resting, before, chosen } = self;
        world.clear();
        markers.copy_from_slice(resting);
        before.clear();
        for (number, Rule { what, reach, start }) in rules.iter().enumerate() {
            if let Placed::Joint(joint) = what {
                let Some(position) = world.draw_position(&**start, stream) else { return false };
                // A joint takes no room, so no later rule keeps a distance from it.
                world.place_joint(*joint, position, 0.0);
                continue;
            }
            // A placement may depend on everything placed earlier.
            world.finish_placement();
            let mut spot = Spot {
                number: 0,
                radius: *reach,
                edge: *reach,
                solid: true,
                turns: false,
                size: [0.0; 2],
                others: &mut [],
                areas: &[],
                earlier: before,
                chosen,
                choice: None,
                lacks: None,
            };
            let Some(pose) = world.draw(&**start, &mut spot, stream) else { return false };
            if let Some(choice) = spot.choice {
                chosen[number] = choice;
            }
            match what {
                Placed::Body(body) => world.place_body(*body, pose, Twist::default()),
                Placed::Marker(number) => markers[*number] = pose.position,
                Placed::Joint(_) => {}
            }
            before.push((pose.position, *reach));
        }
        world.finish_placement();
        true
    }
}

/// Returns a named part and its reach.
fn named(name: &String, scene: &Scene, path: &str, source: &Source) -> Result<(Placed, f64), Error> {
    let path = format!("{path}/place");
    if name == ROBOT {
        let root = scene.robot.segments.first().filter(|root| root.joint.kind == JointKind::Floating);
        let why = "`robot` stands in the world; only one whose first body floats is placed, and others have `base`";
        return root.map(|_| (Placed::Body(BodyId(0)), 0.0)).ok_or_else(|| source.wrong(&path, why));
    }
    if let Some(thing) = scene.things.iter().find(|thing| thing.name == *name) {
        return match thing.what {
            What::Body(body) => Ok((Placed::Body(body), thing.reach)),
            What::Marker(number) => Ok((Placed::Marker(number), 0.0)),
            What::Wall => Err(source.wrong(&path, format!("`{name}` is a wall, which stands where `at` says"))),
        };
    }
    let joints = || scene.robot.joints().filter(|joint| joint.index() < scene.own_bodies());
    let joint = joints().find(|joint| scene.joint_name(*joint) == name);
    let names = joints().map(|joint| scene.joint_name(joint)).chain([ROBOT]);
    let names = names.chain(scene.things.iter().map(|thing| thing.name.as_str()));
    let joint = joint.ok_or_else(|| Error::unknown(&source.of(&path), "joint or object", name, names))?;
    Ok((Placed::Joint(joint), 0.0))
}
