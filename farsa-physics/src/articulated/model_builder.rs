//! Construction of models from descriptions.

use alloc::vec;
use alloc::vec::Vec;

use farsa_body::robot::{JointKind, PairFault, Robot, RobotError, Shape, Stop};
use farsa_num::{Real, Scalar};

use crate::articulated::boxes::BOX_POINTS;
use crate::articulated::group::{groups_of, is_plane};
use crate::articulated::impedance::Curve;
use crate::articulated::link::{Link, Motion, WORLD};
use crate::articulated::links::{
    IDENTITY, cast_links, cast_mount, choose_references, compose, frame, least_ratio, links_of, set_limits, unit,
};
use crate::articulated::model::{
    Actuator, Collider, Geometry, Ground, JointLaw, Model, ModelError, Mount, Options, Pair, Reach, Soft, StopPath,
};

fn check(options: &Options) -> Result<(), ModelError> {
    let bad = |name, value: f64| Err(ModelError::Option { name, value });
    for (name, value, low, high) in [
        ("time_step", options.time_step, 1e-6, 1.0),
        ("substeps", f64::from(options.substeps), 1.0, 1e6),
        ("sweeps", f64::from(options.sweeps), 1.0, 1e4),
        ("settled", options.settled, 0.0, 1e3),
        ("path_error", options.path_error.unwrap_or(1.0), 1e-9, 1e3),
        ("friction_compliance", options.friction_compliance, 0.0, 1e6),
        ("limit_frequency", options.limit_frequency, 1.0, 1e6),
        ("limit_damping", options.limit_damping, 0.0, 1e3),
        ("margin", options.margin, 0.0, 0.1),
        ("sight_height", options.sight_height, -1e6, 1e6),
        ("gravity x", options.gravity[0], -1e4, 1e4),
        ("gravity y", options.gravity[1], -1e4, 1e4),
        ("gravity z", options.gravity[2], -1e4, 1e4),
    ] {
        if !(low..=high).contains(&value) {
            return bad(name, value);
        }
    }
    Ok(())
}

fn geometry_of(shape: Shape) -> (Geometry<f64>, f64, u8) {
    match shape {
        Shape::Sphere { radius } => (Geometry::Ball { radius }, radius, 0),
        Shape::Capsule { radius, half_length } => (Geometry::Capsule { radius, half_length }, radius + half_length, 1),
        Shape::Box { half } => {
            (Geometry::Block { half }, Scalar::sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]), 2)
        }
        Shape::Cylinder { radius, half_length } => {
            let bound = Scalar::sqrt(radius * radius + half_length * half_length);
            (Geometry::Cylinder { radius, half_length }, bound, 3)
        }
        Shape::Plane => (Geometry::Plane, 0.0, 4),
    }
}

/// Contact points of a pair of geometries, in their canonical order.
fn points_of(a: &Geometry<f64>, b: &Geometry<f64>) -> Option<usize> {
    match (a, b) {
        (Geometry::Ball { .. }, _) | (Geometry::Capsule { .. }, Geometry::Capsule { .. }) => Some(1),
        (Geometry::Capsule { .. }, Geometry::Plane) => Some(2),
        (Geometry::Capsule { .. }, Geometry::Block { .. } | Geometry::Cylinder { .. }) => Some(3),
        (Geometry::Cylinder { .. }, Geometry::Plane) => Some(4),
        (Geometry::Block { .. }, Geometry::Plane) => Some(8),
        (Geometry::Block { .. }, Geometry::Block { .. }) => Some(BOX_POINTS),
        _ => None,
    }
}

/// Returns true for a joint with a stop of the world.
fn has_stop(link: &Link<f64>) -> bool {
    link.motion != Motion::Floating && !link.has_own_stop && (link.lower.is_finite() || link.upper.is_finite())
}

fn reach_of(links: &[Link<f64>], a: u16, b: u16) -> Reach {
    let path = |mut link: u16| {
        let mut p = Vec::new();
        while link != WORLD {
            p.push(link);
            link = links[usize::from(link)].parent;
        }
        p
    };
    let first = path(a);
    let mut second = path(b);
    let meet = first.iter().position(|l| second.contains(l)).unwrap_or(first.len());
    if let Some(common) = first.get(meet) {
        second.truncate(second.iter().position(|l| l == common).unwrap_or(0));
    }
    let mut dofs = Vec::new();
    for &l in first.iter().chain(&second) {
        let link = &links[usize::from(l)];
        let n = if link.motion == Motion::Floating { 6 } else { 1 };
        dofs.extend((0..n).map(|k| link.dof + k));
    }
    Reach { first, second, meet, dofs }
}

/// A collider in its link's frame: where, which geometry, the radius of its bound, and its rank in the order of
/// geometries.
type Fitted = (Mount<f64>, Geometry<f64>, f64, u8);

fn colliders_of(robot: &Robot, mounts: &[Mount<f64>]) -> Vec<Fitted> {
    let fitted = robot.colliders.iter().map(|c| {
        let base = c.body.map_or(Mount { link: WORLD, rotation: IDENTITY, position: [0.0; 3] }, |b| mounts[b.index()]);
        let (geometry, bound, rank) = geometry_of(c.shape);
        (compose(&base, &frame(&c.placement)), geometry, bound, rank)
    });
    fitted.collect()
}

fn cast_collider<R: Real>((mount, geometry, bound, _): &Fitted) -> Collider<R> {
    Collider {
        mount: cast_mount(mount),
        geometry: match *geometry {
            Geometry::Ball { radius } => Geometry::Ball { radius: R::from_f64(radius) },
            Geometry::Capsule { radius, half_length } => {
                Geometry::Capsule { radius: R::from_f64(radius), half_length: R::from_f64(half_length) }
            }
            Geometry::Block { half } => Geometry::Block { half: half.map(R::from_f64) },
            Geometry::Cylinder { radius, half_length } => {
                Geometry::Cylinder { radius: R::from_f64(radius), half_length: R::from_f64(half_length) }
            }
            Geometry::Plane => Geometry::Plane,
        },
        bound: R::from_f64(*bound),
    }
}

/// The pairs, and how many points and entries of rows they have together.
struct Pairs<R> {
    list: Vec<Pair<R>>,
    points: usize,
    rolling: usize,
    row_entries: usize,
    rolling_entries: usize,
}

fn pairs_of<R: Real>(robot: &Robot, links: &[Link<f64>], colliders: &[Fitted]) -> Result<Pairs<R>, ModelError> {
    let mut pairs = Pairs {
        list: Vec::with_capacity(robot.pairs.len()),
        points: 0,
        rolling: 0,
        row_entries: 0,
        rolling_entries: 0,
    };
    for p in &robot.pairs {
        let [a, b] = p.colliders;
        let movable = |c: usize| colliders[c].0.link != WORLD;
        let rank = |c: usize| colliders[c].3;
        // The moving one of two boxes comes first, because the ball around the first one is compared with the other.
        let flipped = rank(a) > rank(b) || (rank(a) == 2 && rank(b) == 2 && !movable(a));
        let [a, b] = if flipped { [b, a] } else { [a, b] };
        let Some(count) = points_of(&colliders[a].1, &colliders[b].1) else {
            let names = [a, b].map(|c| robot.colliders[c].name.clone());
            return Err(RobotError::Pair { colliders: names, fault: PairFault::Shapes }.into());
        };
        let reach = reach_of(links, colliders[a].0.link, colliders[b].0.link);
        let rolls = p.surface.rolling_friction > 0.0;
        let entries = reach.dofs.len() * count;
        pairs.list.push(Pair {
            colliders: [a, b],
            flipped,
            point: pairs.points,
            points: count,
            row: pairs.row_entries,
            rolling_row: pairs.rolling_entries,
            rolling: rolls.then_some(pairs.rolling),
            friction: R::from_f64(p.surface.friction),
            rolling_friction: R::from_f64(p.surface.rolling_friction),
            stiffness: R::from_f64(p.surface.stiffness),
            damping: R::from_f64(p.surface.damping),
            soft: p.soft.map(|soft| Soft {
                inertia: R::from_f64(soft.inertia),
                friction: soft.friction.map(R::from_f64),
                margin: R::from_f64(soft.margin),
                curve: soft.impedance.as_ref().map(Curve::new),
            }),
            restitution: (p.restitution > 0.0).then(|| R::from_f64(p.restitution)),
            is_pyramid: p.soft.is_some_and(|soft| soft.is_pyramid),
            grounds: [None; 2],
            at_stops: reach.first.iter().chain(&reach.second).any(|l| has_stop(&links[usize::from(*l)])),
            reach,
        });
        pairs.points += count;
        pairs.row_entries += entries;
        if rolls {
            pairs.rolling += count;
            pairs.rolling_entries += entries;
        }
    }
    Ok(pairs)
}

/// Sweeps for each one of the options in a world of stacks. Impulses pass through one box of a stack per sweep, so small
/// changes do not show that the stack has settled.
const STACK_SWEEPS: u32 = 4;

fn length(vector: &[f64; 3]) -> f64 {
    Scalar::sqrt(vector.iter().fold(0.0, |sum: f64, x| sum + x * x))
}

/// Dynamics steps of free fall after which an approach is fast enough to bounce.
const FALL_STEPS: f64 = 2.0;

/// Returns whether two free boxes can touch.
fn has_stacks<R>(pairs: &[Pair<R>], links: &[Link<f64>], colliders: &[Fitted]) -> bool {
    let free_box = |collider: usize| {
        let (mount, geometry, ..) = &colliders[collider];
        let free = links.get(usize::from(mount.link)).is_some_and(|link| link.motion == Motion::Floating);
        free && matches!(geometry, Geometry::Block { .. })
    };
    pairs.iter().any(|pair| pair.colliders.into_iter().all(free_box))
}

/// The positions at the start, and as many zeros as there are velocities.
fn start_of(robot: &Robot, links: &[Link<f64>], mounts: &[Mount<f64>], len: usize) -> Vec<f64> {
    let mut initial = vec![0.0; len];
    for (segment, mount) in robot.segments.iter().zip(mounts) {
        let Some(link) = links.get(usize::from(mount.link)) else { continue };
        let at = usize::from(link.q);
        match segment.joint.kind {
            JointKind::Floating => {
                let pose = segment.joint.placement;
                initial[at..at + 3].copy_from_slice(&pose.position);
                initial[at + 3..at + 7].copy_from_slice(&unit(pose.rotation));
            }
            JointKind::Fixed => {}
            _ => initial[at] = 0.0_f64.max(segment.joint.range[0]).min(segment.joint.range[1]),
        }
    }
    initial
}

fn stop_paths_of(links: &[Link<f64>]) -> Vec<StopPath> {
    let mut row = 0;
    let paths = (0..links.len()).map(|i| {
        let dofs = reach_of(links, i as u16, WORLD).dofs;
        row += dofs.len();
        StopPath { row: row - dofs.len(), dofs }
    });
    paths.collect()
}

/// The joints with dry friction, then those with soft stops and those with a largest speed.
fn joint_laws_of<R: Real>(robot: &Robot, mounts: &[Mount<f64>], h: f64) -> Vec<JointLaw<R>> {
    let single = || {
        let segments = robot.segments.iter().zip(mounts).map(|(segment, mount)| (&segment.joint, mount.link));
        segments.filter(|(joint, _)| joint.kind.is_single())
    };
    let r = R::from_f64;
    let rubbing = single().filter(|(joint, _)| joint.friction > 0.0);
    let frictions = rubbing.map(|(joint, link)| JointLaw::Friction { link, limit: r(joint.friction * h) });
    let stops = single().filter_map(|(joint, link)| {
        let Stop { stiffness, damping, inertia, impedance } = joint.stop?;
        let [stiffness, damping, inertia] = [stiffness, damping, inertia].map(r);
        let law = JointLaw::Stop { link, stiffness, damping, inertia, curve: impedance.as_ref().map(Curve::new) };
        joint.range.iter().any(|end| end.is_finite()).then_some(law)
    });
    let speeds = single().filter_map(|(joint, link)| Some(JointLaw::Speed { link, limit: r(joint.speed_limit?) }));
    frictions.chain(stops).chain(speeds).collect()
}

/// The grounds below bodies that slide, which pairs learn that have a shape above them.
fn grounds_of<R: Real>(
    robot: &Robot,
    mounts: &[Mount<f64>],
    colliders: &[Fitted],
    pairs: &mut [Pair<R>],
    h: f64,
) -> Vec<Ground<R>> {
    let link = |joint: farsa_body::ports::JointId| mounts[joint.index()].link;
    let found = robot.grounds.iter().filter_map(|ground| {
        let (sliders, turn) = robot.sliders(ground.body)?;
        let limit = ground.friction * ground.load * h;
        Some(Ground {
            sliders: sliders.map(link),
            turn: turn.map(link),
            limit: R::from_f64(limit),
            turning_limit: R::from_f64(limit * ground.radius),
        })
    });
    let grounds: Vec<Ground<R>> = found.collect();
    let above = |collider: usize| {
        let link = colliders[collider].0.link;
        grounds.iter().position(|ground| ground.turn.unwrap_or(ground.sliders[1]) == link).map(|number| number as u16)
    };
    for pair in pairs {
        pair.grounds = pair.colliders.map(above);
    }
    grounds
}

impl<R: Real> Model<R> {
    /// Builds a model from the description of a robot or of a whole scene. This checks the description, so a model is
    /// always valid.
    ///
    /// # Errors
    /// A description that is not valid, an option out of range, a joint without inertia, a body too thin for the
    /// precision, more than 65534 parts.
    pub fn new(robot: &Robot, options: &Options) -> Result<Self, ModelError> {
        robot.validate()?;
        check(options)?;
        for (what, count) in [
            ("segments", robot.segments.len()),
            ("colliders", robot.colliders.len()),
            ("pairs", robot.pairs.len()),
            ("actuators", robot.actuators.len()),
        ] {
            if count >= usize::from(u16::MAX) / 8 {
                return Err(ModelError::TooMany { what, count });
            }
        }
        let (mut links, mounts) = links_of(robot);
        choose_references(&mut links);
        let colliders = colliders_of(robot, &mounts);
        let Pairs { list: mut pairs, points, rolling, row_entries, rolling_entries } =
            pairs_of(robot, &links, &colliders)?;
        let (groups, clusters) = groups_of(robot, &pairs, |collider| is_plane(&colliders[collider].1));
        let h = options.time_step / f64::from(options.substeps);
        // In a step, what turns at w and moves at v leaves its tangent by h^2 |w x v| / 2.
        let fast = options.path_error.map(|error| 2.0 * error / (h * h));
        let grounds = grounds_of(robot, &mounts, &colliders, &mut pairs, h);
        let positions = links.iter().map(|l| if l.motion == Motion::Floating { 7 } else { 1 }).sum();
        let dofs = links.iter().map(|l| if l.motion == Motion::Floating { 6 } else { 1 }).sum();
        let initial = start_of(robot, &links, &mounts, positions + dofs);
        set_limits(robot, &mounts, &mut links, &initial, dofs, options, least_ratio::<R>())?;
        let stop_paths = stop_paths_of(&links);
        let stacks = has_stacks(&pairs, &links, &colliders);
        let sweeps = if stacks { STACK_SWEEPS * options.sweeps } else { options.sweeps };
        let settled = if stacks || !grounds.is_empty() { 0.0 } else { options.settled };
        let widest = robot.pairs.iter().filter_map(|pair| pair.soft).map(|soft| soft.margin).fold(0.0, f64::max);
        let actuators =
            robot.actuators.iter().map(|a| Actuator { link: mounts[a.joint.index()].link, law: a.law.cast() });
        let ranged = |(i, actuator): (usize, &farsa_body::robot::Actuator)| {
            Some((positions + dofs + 2 * i, actuator.command_range?.map(R::from_f64)))
        };
        let bodies_of = |pair: &farsa_body::robot::Pair| pair.colliders.map(|c| robot.colliders[c].body);
        let colors = robot.colliders.iter().enumerate();
        let shown = colors.filter_map(|(i, c)| Some((i as u16, c.color?.map(|shade| shade as f32))));
        let mut model = Self {
            links: cast_links(&links),
            mounts: mounts.iter().map(cast_mount).collect(),
            pair_bodies: robot.pairs.iter().map(bodies_of).collect(),
            joints: robot.segments.iter().map(|s| s.joint.kind).collect(),
            collider_bodies: robot.colliders.iter().map(|c| c.body).collect(),
            colliders: colliders.iter().map(cast_collider).collect(),
            shown: shown.collect(),
            sight_height: R::from_f64(options.sight_height),
            pairs,
            groups,
            clusters,
            actuators: actuators.collect(),
            command_ranges: robot.actuators.iter().enumerate().filter_map(ranged).collect(),
            grounds,
            initial: Vec::new(),
            positions,
            dofs,
            points,
            rolling,
            row_entries,
            rolling_entries,
            stops: links.iter().map(has_stop).collect(),
            stop_entries: stop_paths.iter().map(|p| p.dofs.len()).sum(),
            stop_paths,
            joint_laws: joint_laws_of(robot, &mounts, h),
            roots: links.iter().filter(|l| l.motion == Motion::Floating).count(),
            gravity: options.gravity.map(R::from_f64),
            time_step: R::from_f64(options.time_step),
            h: R::from_f64(h),
            substeps: options.substeps,
            fast: fast.map(|product| R::from_f64(product * product)),
            sweeps,
            settled: R::from_f64(settled),
            friction_compliance: R::from_f64(options.friction_compliance),
            bounce: R::from_f64(FALL_STEPS * h * length(&options.gravity)),
            margin: R::from_f64(options.margin),
            reach: R::from_f64(options.margin + widest),
        };
        model.initial = initial.into_iter().map(R::from_f64).collect();
        model.initial.resize(model.state_len(), R::from_f64(0.0));
        Ok(model)
    }
}
