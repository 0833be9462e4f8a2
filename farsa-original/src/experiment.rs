//! Steps, trials, arena and plugin.

use crate::ini::Group;
use crate::remarks::Remarks;
use crate::written::{Written, number, numbers};

/// The keys of a configuration except robots, networks and the search.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Experiment {
    pub(super) agents: u64,
    trials: u64,
    steps: u64,
    time_step: f64,
    /// Size of the arena, or of the area within its walls [m].
    size: [f64; 2],
    task: Task,
}

/// The task of a robot.
#[derive(Clone, Debug, PartialEq)]
enum Task {
    /// Finding a cylinder and staying near it, an experiment of \[FARSA2\] with published code.
    Discrimination {
        radius: f64,
        within: f64,
        cylinder_from_walls: f64,
        robot_from_cylinder: f64,
        robot_from_walls: f64,
    },
    /// The C++ code of a plugin.
    OfPlugin(String),
}

/// Largest length [m].
const MOST: f64 = 1000.0;
const PLUGIN: &str = "walls, objects, where things start, what ends a trial and what it earns are the plugin's C++ code; \
                      here are an empty arena with walls and a fitness of 0";

impl Experiment {
    /// Reads the groups of the experiment, its world and its arena.
    pub(super) fn from_groups(
        group: &Group,
        world: Option<&Group>,
        arena: Option<&Group>,
        remarks: &mut Remarks,
    ) -> Self {
        let kind = group.kind(remarks);
        let trials = group.whole("ntrials", 1, 1..=100_000, remarks);
        let steps = group.whole("nsteps", 1, 1..=1_000_000, remarks);
        let agents = group.whole("nagents", 1, 1..=1000, remarks);
        group.lost(&[("sameRandomSequence", "false")], "each individual has starts of its own", remarks);
        let time_step = world.map_or(0.05, |world| {
            let step = world.number("timestep", 0.05, 0.001..=0.2, remarks);
            let why = "the floor and the size of the simulated world are those of the arena";
            world.idle(&["floorType", "size", "isRealtime", "frictionModel"], why, remarks);
            step
        });
        let (plane, radius) = arena.map_or(([2.5; 2], 0.0125), |arena| read_arena(arena, remarks));
        let (name, entry) = kind.map_or((String::new(), None), |(name, entry)| (name, Some(entry)));
        if name == "KheperaDiscriminationExperiment" {
            let (task, size) = discrimination(group, radius, remarks);
            if let Some(arena) = arena {
                let why = "the robot stays between the walls of the playground";
                arena.idle(&["planeWidth", "planeHeight"], why, remarks);
            }
            return Self { agents, trials, steps, time_step, size, task };
        }
        remarks.lost_or_default(group, entry, ["type", ""], PLUGIN);
        if let Some(arena) = arena {
            let sizes = ["smallCylinderRadius", "bigCylinderRadius", "lightBulbRadius"];
            for entry in sizes.into_iter().filter_map(|key| arena.find(key)) {
                remarks.lost(arena, entry, "is about things that the plugin's C++ code makes");
            }
        }
        for entry in &group.entries {
            if !remarks.is_asked(group, &entry.key) {
                remarks.lost(group, entry, "is a key of the plugin, of which only its C++ code says what it means");
            }
        }
        Self { agents, trials, steps, time_step, size: plane, task: Task::OfPlugin(name) }
    }

    pub(super) fn write_world(&self, out: &mut Written) {
        out.table("[world]");
        out.set("size", numbers(&self.size));
        out.set("time_step", number(self.time_step));
        if let Task::Discrimination { radius, .. } = self.task {
            out.table("[[objects]]");
            out.word("name", "cylinder");
            out.word("kind", "cylinder");
            out.set("radius", number(radius));
        }
    }

    pub(super) fn write_task(&self, out: &mut Written) {
        out.table("[episode]");
        out.set("steps", self.steps);
        out.set("trials", self.trials);
        match &self.task {
            Task::Discrimination { within, cylinder_from_walls, robot_from_cylinder, robot_from_walls, .. } => {
                out.set("ends", "[\"collision\"]");
                place(out, "cylinder", *cylinder_from_walls, None);
                place(out, "robot", *robot_from_walls, Some(*robot_from_cylinder));
                out.table("[[reward]]");
                out.word("kind", "near");
                out.word("object", "cylinder");
                out.set("within", number(*within));
                out.table("[[reward]]");
                out.word("name", "collision");
                out.word("kind", "touch");
                out.set("weight", number(0.0));
                for (term, end, value) in [("near", "above", 0.5), ("collision", "below", 0.5)] {
                    out.table("[[success]]");
                    out.word("term", term);
                    out.set(end, number(value));
                }
            }
            Task::OfPlugin(name) => {
                out.space();
                out.comment(&format!(
                    "The fitness of `{name}` is C++ code of its plugin: write its terms in place of this."
                ));
                out.comment("`farsa schema` lists them, docs/guide/experiment-file.md tells of them.");
                out.head("[[reward]]");
                out.word("kind", "steps");
                out.set("weight", number(0.0));
            }
        }
    }
}

/// Writes a placement anywhere, with these distances from walls and earlier things [m].
fn place(out: &mut Written, what: &str, walls: f64, apart: Option<f64>) {
    out.table("[[start]]");
    out.word("place", what);
    out.word("at", "anywhere");
    out.set("walls", number(walls));
    if let Some(apart) = apart {
        out.set("apart", number(apart));
    }
}

/// Size of the plane [m], and radius of small cylinders [m].
fn read_arena(arena: &Group, remarks: &mut Remarks) -> ([f64; 2], f64) {
    if let Some((name, entry)) = arena.kind(remarks).filter(|(name, _)| name != "Arena") {
        remarks.lost(arena, entry, &format!("`{name}` is no `Arena`; what it shares with that is read"));
    }
    let size = ["planeWidth", "planeHeight"].map(|key| arena.number(key, 2.5, 0.05..=MOST, remarks));
    let radius = arena.number("smallCylinderRadius", 0.0125, 0.0001..=100.0, remarks);
    let _ = (
        arena.number("bigCylinderRadius", 0.027, 0.0001..=100.0, remarks),
        arena.number("lightBulbRadius", 0.01, 0.0001..=100.0, remarks),
    );
    let why = "a robot here that would run into something stays where it was; nothing is pushed aside";
    arena.lost(&[("collisionHandler", "SimpleCollisions")], why, remarks);
    arena.lost(&[("z", "0")], "the ground here is at height 0", remarks);
    (size, radius)
}

/// Reads the discrimination experiment and the size of its playground [m].
fn discrimination(group: &Group, radius: f64, remarks: &mut Remarks) -> (Task, [f64; 2]) {
    let mut length = |key, default| group.number(key, default, 0.0..=MOST, remarks);
    let task = Task::Discrimination {
        radius,
        within: length("distanceThreshold", 0.1),
        cylinder_from_walls: length("minObjectDistanceFromWall", 0.05),
        robot_from_cylinder: length("minInitialRobotDistanceFromObject", 0.1),
        robot_from_walls: length("minInitialRobotDistanceFromWall", 0.1),
    };
    let size = ["playgroundWidth", "playgroundHeight"].map(|key| group.number(key, 0.5, 0.05..=MOST, remarks));
    (task, size)
}
