//! The constant part of an articulated world: links, colliders, pairs, actuators, options.

use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;
use core::fmt;

use farsa_body::{BodyId, JointKind, Law, Pose, Robot, RobotError, Shape};
use farsa_num::{Real, Scalar};

use crate::spatial::{Matrix, Vector, add, matrix_of, product, rotate, rotate_symmetric, sub};
use crate::tree::{Link, LinkWork, Motion, WORLD, mass_matrix, place};

/// How an articulated world is stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Control step [s].
    pub time_step: f64,
    /// Dynamics steps per control step.
    pub substeps: u32,
    /// Gravity [m/s2].
    pub gravity: [f64; 3],
    /// Sweeps over the contacts per dynamics step.
    pub sweeps: u32,
    /// Tangential velocity per friction impulse at a sticking contact [m/(s N s)]: what is left of creep.
    pub slip: f64,
    /// Natural frequency of a joint stop, from the joint's own inertia at position 0 [rad/s].
    pub limit_frequency: f64,
    /// Damping ratio of a joint stop.
    pub limit_damping: f64,
    /// Contacts are watched from this distance on [m].
    pub margin: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            time_step: 0.01,
            substeps: 4,
            gravity: [0.0, 0.0, -9.81],
            sweeps: 10,
            slip: 1e-3,
            limit_frequency: 1000.0,
            limit_damping: 1.0,
            margin: 5e-4,
        }
    }
}

/// Why a model cannot be made.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ModelError {
    /// The description is not valid.
    Robot(RobotError),
    /// An option is out of its range.
    Option {
        /// Its name.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A joint that nothing makes heavy: no mass beyond it about its axis and no armature.
    Weightless {
        /// The segment's name.
        segment: String,
    },
    /// More parts than 16 bits can number.
    TooMany {
        /// Which parts.
        what: &'static str,
        /// How many.
        count: usize,
    },
}

impl From<RobotError> for ModelError {
    fn from(e: RobotError) -> Self {
        Self::Robot(e)
    }
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Robot(e) => e.fmt(f),
            Self::Option { name, value } => write!(f, "option {name} is {value}"),
            Self::Weightless { segment } => write!(f, "segment {segment}: its joint moves no mass and has no armature"),
            Self::TooMany { what, count } => write!(f, "{count} {what}: at most 65534"),
        }
    }
}

impl core::error::Error for ModelError {}

/// Where a segment is: on which link, and its frame in the link's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mount<R> {
    pub(crate) link: u16,
    pub(crate) rotation: Matrix<R>,
    pub(crate) position: Vector<R>,
}

/// The form of a collider with its sizes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Form<R> {
    Ball { radius: R },
    Capsule { radius: R, half_length: R },
    Block { half: Vector<R> },
    Plane,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Collider<R> {
    pub(crate) mount: Mount<R>,
    pub(crate) form: Form<R>,
    /// Radius of the ball about its origin that holds it; none for a plane.
    pub(crate) bound: R,
}

/// The two sides of a contact in the joint space: which velocities its rows reach.
#[derive(Clone, Debug)]
pub(crate) struct Reach {
    /// Links from the first collider's up to the root.
    pub(crate) first: Vec<u16>,
    /// Links from the second collider's up to, but without, the first one that is also in `first`.
    pub(crate) second: Vec<u16>,
    /// Where in `first` the two meet; its length when they do not.
    pub(crate) meet: usize,
    /// The velocities of a row's entries, in the order in which they are written.
    pub(crate) dofs: Vec<u16>,
}

/// The velocities that a joint's own effort reaches, from the joint to the root, and where its row begins.
#[derive(Clone, Debug)]
pub(crate) struct StopPath {
    pub(crate) dofs: Vec<u16>,
    pub(crate) row: usize,
}

#[derive(Clone, Debug)]
pub(crate) struct Pair<R> {
    /// Colliders in the order ball, capsule, block, plane.
    pub(crate) colliders: [usize; 2],
    /// Whether that is the other way round than in the description.
    pub(crate) flipped: bool,
    /// First contact point and their number.
    pub(crate) point: usize,
    pub(crate) points: usize,
    /// First entry of the first point's rows.
    pub(crate) row: usize,
    /// The same for the rolling rows.
    pub(crate) rolling_row: usize,
    /// Number of the first point's rolling impulse, where there is rolling friction.
    pub(crate) rolling: Option<usize>,
    pub(crate) friction: R,
    pub(crate) rolling_friction: R,
    pub(crate) stiffness: R,
    pub(crate) damping: R,
    /// Whether the pair can push a joint that has a stop.
    pub(crate) at_stops: bool,
    pub(crate) reach: Reach,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Actuator<R> {
    pub(crate) link: u16,
    pub(crate) law: Law<R>,
}

/// The constant part of an articulated world, each number rounded once from the description.
#[derive(Clone, Debug)]
pub struct Model<R> {
    pub(crate) links: Vec<Link<R>>,
    pub(crate) mounts: Vec<Mount<R>>,
    /// The description's body pairs, for the ports.
    pub(crate) pair_bodies: Vec<[Option<BodyId>; 2]>,
    pub(crate) joints: Vec<JointKind>,
    pub(crate) collider_bodies: Vec<Option<BodyId>>,
    pub(crate) colliders: Vec<Collider<R>>,
    pub(crate) pairs: Vec<Pair<R>>,
    pub(crate) actuators: Vec<Actuator<R>>,
    /// The state after [`farsa_body::Arrange::clear`].
    pub(crate) initial: Vec<R>,
    pub(crate) positions: usize,
    pub(crate) dofs: usize,
    pub(crate) points: usize,
    pub(crate) rolling: usize,
    pub(crate) row_entries: usize,
    pub(crate) rolling_entries: usize,
    /// Which links' joints have a stop, and the rows of them.
    pub(crate) stops: Vec<bool>,
    pub(crate) stop_paths: Vec<StopPath>,
    pub(crate) stop_entries: usize,
    pub(crate) roots: usize,
    pub(crate) gravity: [R; 3],
    /// Control step and dynamics step [s].
    pub(crate) time_step: R,
    pub(crate) h: R,
    pub(crate) substeps: u32,
    pub(crate) sweeps: u32,
    pub(crate) slip: R,
    pub(crate) margin: R,
}

/// Words of the state per contact point: impulse, normal impulse, point, gap.
pub(crate) const POINT_WORDS: usize = 8;

impl<R: Real> Model<R> {
    /// Number of positions: one per joint, seven per floating body (position, quaternion x, y, z, w).
    pub fn positions(&self) -> usize {
        self.positions
    }
    /// Number of velocities: one per joint, six per floating body (angular, then that of the centre of mass).
    pub fn dofs(&self) -> usize {
        self.dofs
    }
    /// The moving links in the order of their velocities, for the kernels.
    pub fn links(&self) -> &[Link<R>] {
        &self.links
    }
    /// Gravity [m/s2].
    pub fn gravity(&self) -> [R; 3] {
        self.gravity
    }
    /// Length of a state: positions, velocities, two commands per actuator, eight words per contact point, three per rolling point.
    pub fn state_len(&self) -> usize {
        self.positions + self.dofs + 2 * self.actuators.len() + POINT_WORDS * self.points + 3 * self.rolling
    }
    /// The link of a body's segment and the velocity it begins with; `None` for what is fixed to the world.
    pub fn link_of(&self, body: BodyId) -> Option<usize> {
        let mount = self.mounts.get(body.index())?;
        (mount.link != WORLD).then_some(usize::from(mount.link))
    }
    /// The index of a joint's position and velocity; `None` for fixed and floating joints.
    pub fn joint_index(&self, joint: farsa_body::JointId) -> Option<(usize, usize)> {
        match self.joints.get(joint.index())? {
            JointKind::Revolute | JointKind::Prismatic => {
                let link = &self.links[usize::from(self.mounts[joint.index()].link)];
                Some((usize::from(link.q), usize::from(link.dof)))
            }
            _ => None,
        }
    }
}

/// A rotation whose third column is the axis.
fn axis_frame(axis: Vector<f64>) -> Matrix<f64> {
    let length = Scalar::sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    let [x, y, z] = axis.map(|a| a / length);
    // For the coordinate axes a permutation, so that nothing is rounded.
    let u = if x.abs() > 0.9 {
        [0.0, 1.0, 0.0]
    } else if y.abs() > 0.9 {
        [0.0, 0.0, 1.0]
    } else {
        [1.0, 0.0, 0.0]
    };
    let along = u[0] * x + u[1] * y + u[2] * z;
    let u = [u[0] - along * x, u[1] - along * y, u[2] - along * z];
    let n = Scalar::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    let u = u.map(|a| a / n);
    let v = crate::spatial::cross([x, y, z], u);
    [[u[0], v[0], x], [u[1], v[1], y], [u[2], v[2], z]]
}

fn transpose(m: &Matrix<f64>) -> Matrix<f64> {
    [[m[0][0], m[1][0], m[2][0]], [m[0][1], m[1][1], m[2][1]], [m[0][2], m[1][2], m[2][2]]]
}

fn unit(q: [f64; 4]) -> [f64; 4] {
    let n = Scalar::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    q.map(|x| x / n)
}

fn frame(pose: &Pose<f64>) -> Mount<f64> {
    Mount { link: WORLD, rotation: matrix_of(unit(pose.rotation)), position: pose.position }
}

fn compose(outer: &Mount<f64>, inner: &Mount<f64>) -> Mount<f64> {
    Mount {
        link: outer.link,
        rotation: product(&outer.rotation, &inner.rotation),
        position: add(outer.position, rotate(&outer.rotation, inner.position)),
    }
}

const IDENTITY: Matrix<f64> = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl Link<f64> {
    /// Adds a body that is rigidly mounted on the link.
    fn carry(&mut self, mass: f64, centre: Vector<f64>, inertia: &[f64; 6], mount: &Mount<f64>) {
        let centre = add(mount.position, rotate(&mount.rotation, centre));
        let total = self.mass + mass;
        if total == 0.0 {
            return;
        }
        let (old, w) = (self.centre, mass / total);
        let joint = [0, 1, 2].map(|k: usize| old[k] * (1.0 - w) + centre[k] * w);
        let turned = rotate_symmetric(&mount.rotation, inertia);
        for k in 0..6 {
            self.inertia[k] += turned[k];
        }
        for (m, c) in [(self.mass, sub(old, joint)), (mass, sub(centre, joint))] {
            let [x, y, z] = c;
            for (k, e) in [y * y + z * z, x * x + z * z, x * x + y * y, -x * y, -x * z, -y * z].into_iter().enumerate()
            {
                self.inertia[k] += m * e;
            }
        }
        self.mass = total;
        self.centre = joint;
    }

    fn cast<R: Real>(&self) -> Link<R> {
        let r = R::of;
        Link {
            parent: self.parent,
            motion: self.motion,
            q: self.q,
            dof: self.dof,
            reference: self.reference,
            root: self.root,
            rotation: self.rotation.map(|row| row.map(r)),
            offset: self.offset.map(r),
            mass: r(self.mass),
            centre: self.centre.map(r),
            inertia: self.inertia.map(r),
            armature: r(self.armature),
            damping: r(self.damping),
            lower: r(self.lower),
            upper: r(self.upper),
            limit_stiffness: r(self.limit_stiffness),
            limit_damping: r(self.limit_damping),
        }
    }
}

fn cast_mount<R: Real>(m: &Mount<f64>) -> Mount<R> {
    Mount { link: m.link, rotation: m.rotation.map(|row| row.map(R::of)), position: m.position.map(R::of) }
}

fn check(options: &Options) -> Result<(), ModelError> {
    let bad = |name, value: f64| Err(ModelError::Option { name, value });
    for (name, value, low, high) in [
        ("time_step", options.time_step, 1e-6, 1.0),
        ("substeps", f64::from(options.substeps), 1.0, 1e6),
        ("sweeps", f64::from(options.sweeps), 1.0, 1e4),
        ("slip", options.slip, 0.0, 1e6),
        ("limit_frequency", options.limit_frequency, 1.0, 1e6),
        ("limit_damping", options.limit_damping, 0.0, 1e3),
        ("margin", options.margin, 0.0, 0.1),
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

/// The moving links, and where each segment is mounted.
fn links_of(robot: &Robot) -> (Vec<Link<f64>>, Vec<Mount<f64>>) {
    let mut links: Vec<Link<f64>> = Vec::new();
    let mut mounts: Vec<Mount<f64>> = Vec::new();
    let (mut q, mut dof, mut roots) = (0, 0, 0);
    for segment in &robot.segments {
        let joint = &segment.joint;
        let base = match segment.parent {
            Some(p) => mounts[p.index()],
            None => Mount { link: WORLD, rotation: IDENTITY, position: [0.0; 3] },
        };
        let at = compose(&base, &frame(&joint.placement));
        let motion = match joint.kind {
            JointKind::Fixed => {
                if let Some(link) = links.get_mut(usize::from(at.link)) {
                    link.carry(segment.mass, segment.centre, &segment.inertia, &at);
                }
                mounts.push(at);
                continue;
            }
            JointKind::Revolute => Motion::Revolute,
            JointKind::Prismatic => Motion::Prismatic,
            JointKind::Floating => Motion::Floating,
        };
        let own = if motion == Motion::Floating { IDENTITY } else { axis_frame(joint.axis) };
        let mount = Mount { link: links.len() as u16, rotation: transpose(&own), position: [0.0; 3] };
        let (nq, nv) = if motion == Motion::Floating { (7, 6) } else { (1, 1) };
        let mut link = Link {
            parent: at.link,
            motion,
            q,
            dof,
            reference: 0,
            root: roots,
            rotation: product(&at.rotation, &own),
            offset: at.position,
            mass: 0.0,
            centre: [0.0; 3],
            inertia: [0.0; 6],
            armature: joint.armature,
            damping: joint.damping,
            lower: joint.range[0],
            upper: joint.range[1],
            limit_stiffness: 0.0,
            limit_damping: 0.0,
        };
        link.carry(segment.mass, segment.centre, &segment.inertia, &mount);
        q += nq;
        dof += nv;
        roots += u16::from(motion == Motion::Floating);
        links.push(link);
        mounts.push(mount);
    }
    (links, mounts)
}

/// The reference link of each tree: a floating root, else the link with most children, else the last.
fn choose_references(links: &mut [Link<f64>]) {
    let n = links.len();
    let mut tree: Vec<usize> = (0..n).collect();
    let mut children = vec![0_usize; n];
    for i in 0..n {
        if links[i].parent != WORLD {
            tree[i] = tree[usize::from(links[i].parent)];
            children[usize::from(links[i].parent)] += 1;
        }
    }
    for root in 0..n {
        if tree[root] != root {
            continue;
        }
        let members = || (0..n).filter(|&i| tree[i] == root);
        let reference = if links[root].motion == Motion::Floating {
            root
        } else {
            let most = members().map(|i| children[i]).max().unwrap_or(0);
            if most > 1 {
                members().find(|&i| children[i] == most).unwrap_or(root)
            } else {
                members().next_back().unwrap_or(root)
            }
        };
        for i in 0..n {
            if tree[i] == root {
                links[i].reference = reference as u16;
            }
        }
    }
}

fn form_of(shape: Shape) -> (Form<f64>, f64, u8) {
    match shape {
        Shape::Sphere { radius } => (Form::Ball { radius }, radius, 0),
        Shape::Capsule { radius, half_length } => (Form::Capsule { radius, half_length }, radius + half_length, 1),
        Shape::Box { half } => {
            (Form::Block { half }, Scalar::sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]), 2)
        }
        Shape::Plane => (Form::Plane, 0.0, 3),
    }
}

/// Contact points of a pair of forms, in their canonical order.
fn points_of(a: &Form<f64>, b: &Form<f64>) -> Option<usize> {
    match (a, b) {
        (Form::Ball { .. }, _) | (Form::Capsule { .. }, Form::Capsule { .. }) => Some(1),
        (Form::Capsule { .. }, Form::Plane) => Some(2),
        (Form::Capsule { .. }, Form::Block { .. }) => Some(3),
        (Form::Block { .. }, Form::Plane) => Some(8),
        // Corners of the one in the other, edges of the other in the one.
        (Form::Block { .. }, Form::Block { .. }) => Some(20),
        _ => None,
    }
}

fn has_stop(link: &Link<f64>) -> bool {
    link.motion != Motion::Floating && (link.lower.is_finite() || link.upper.is_finite())
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

impl<R: Real> Model<R> {
    /// Builds the constant part of a world from a robot's (or a whole scene's) description.
    ///
    /// # Errors
    /// A description that is not valid, an option out of range, a joint without inertia, more than 65534 parts.
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
        let mut colliders = Vec::new();
        let mut kinds = Vec::new();
        for c in &robot.colliders {
            let base =
                c.body.map_or(Mount { link: WORLD, rotation: IDENTITY, position: [0.0; 3] }, |b| mounts[b.index()]);
            let (form, bound, kind) = form_of(c.shape);
            colliders.push((compose(&base, &frame(&c.placement)), form, bound));
            kinds.push(kind);
        }
        let mut pairs = Vec::new();
        let (mut points, mut rolling, mut row, mut rolling_row) = (0, 0, 0, 0);
        let mut pair_bodies = Vec::new();
        for p in &robot.pairs {
            let [a, b] = p.colliders;
            let movable = |c: usize| colliders[c].0.link != WORLD;
            // Of two boxes the moving one comes first: its corners and the still one's edges are looked at.
            let flipped = kinds[a] > kinds[b] || (kinds[a] == 2 && kinds[b] == 2 && !movable(a));
            let [a, b] = if flipped { [b, a] } else { [a, b] };
            let names = || [a, b].map(|c| robot.colliders[c].name.clone());
            let Some(count) = points_of(&colliders[a].1, &colliders[b].1) else {
                return Err(RobotError::Shapes { colliders: names() }.into());
            };
            let reach = reach_of(&links, colliders[a].0.link, colliders[b].0.link);
            let rolls = p.surface.rolling_friction > 0.0;
            pair_bodies.push(p.colliders.map(|c| robot.colliders[c].body));
            let entries = reach.dofs.len() * count;
            pairs.push(Pair {
                colliders: [a, b],
                flipped,
                point: points,
                points: count,
                row,
                rolling_row,
                rolling: rolls.then_some(rolling),
                friction: R::of(p.surface.friction),
                rolling_friction: R::of(p.surface.rolling_friction),
                stiffness: R::of(p.surface.stiffness),
                damping: R::of(p.surface.damping),
                at_stops: reach.first.iter().chain(&reach.second).any(|l| has_stop(&links[usize::from(*l)])),
                reach,
            });
            points += count;
            row += entries;
            if rolls {
                rolling += count;
                rolling_row += entries;
            }
        }
        let positions = links.iter().map(|l| if l.motion == Motion::Floating { 7 } else { 1 }).sum();
        let dofs = links.iter().map(|l| if l.motion == Motion::Floating { 6 } else { 1 }).sum();
        let mut initial = vec![0.0; positions + dofs];
        for (segment, mount) in robot.segments.iter().zip(&mounts) {
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
        set_limits(robot, &mounts, &mut links, &initial, dofs, options)?;
        let mut stop_row = 0;
        let stop_paths = (0..links.len())
            .map(|i| {
                let dofs = reach_of(&links, i as u16, WORLD).dofs;
                stop_row += dofs.len();
                StopPath { row: stop_row - dofs.len(), dofs }
            })
            .collect::<Vec<_>>();
        let mut model = Self {
            links: links.iter().map(Link::cast).collect(),
            mounts: mounts.iter().map(cast_mount).collect(),
            pair_bodies,
            joints: robot.segments.iter().map(|s| s.joint.kind).collect(),
            collider_bodies: robot.colliders.iter().map(|c| c.body).collect(),
            colliders: colliders
                .iter()
                .map(|(mount, form, bound)| Collider {
                    mount: cast_mount(mount),
                    form: match *form {
                        Form::Ball { radius } => Form::Ball { radius: R::of(radius) },
                        Form::Capsule { radius, half_length } => {
                            Form::Capsule { radius: R::of(radius), half_length: R::of(half_length) }
                        }
                        Form::Block { half } => Form::Block { half: half.map(R::of) },
                        Form::Plane => Form::Plane,
                    },
                    bound: R::of(*bound),
                })
                .collect(),
            pairs,
            actuators: robot
                .actuators
                .iter()
                .map(|a| Actuator { link: mounts[a.joint.index()].link, law: a.law.cast() })
                .collect(),
            initial: Vec::new(),
            positions,
            dofs,
            points,
            rolling,
            row_entries: row,
            rolling_entries: rolling_row,
            stops: links.iter().map(has_stop).collect(),
            stop_entries: stop_paths.iter().map(|p| p.dofs.len()).sum(),
            stop_paths,
            roots: links.iter().filter(|l| l.motion == Motion::Floating).count(),
            gravity: options.gravity.map(R::of),
            time_step: R::of(options.time_step),
            h: R::of(options.time_step / f64::from(options.substeps)),
            substeps: options.substeps,
            sweeps: options.sweeps,
            slip: R::of(options.slip),
            margin: R::of(options.margin),
        };
        model.initial = initial.into_iter().map(R::of).collect();
        model.initial.resize(model.state_len(), R::of(0.0));
        Ok(model)
    }
}

/// Stops scaled to each joint's own inertia, so that one frequency fits a shoulder and a finger.
fn set_limits(
    robot: &Robot,
    mounts: &[Mount<f64>],
    links: &mut [Link<f64>],
    initial: &[f64],
    dofs: usize,
    options: &Options,
) -> Result<(), ModelError> {
    let mut work = vec![LinkWork::<f64>::new(()); links.len()];
    let mut matrix = vec![0.0; dofs * dofs];
    let velocities = vec![0.0; dofs];
    place((), links, initial, &velocities, &mut work);
    mass_matrix((), links, &mut work, &mut matrix);
    for (segment, mount) in robot.segments.iter().zip(mounts) {
        let Some(link) = links.get_mut(usize::from(mount.link)) else { continue };
        if matches!(segment.joint.kind, JointKind::Fixed) {
            continue;
        }
        let at = usize::from(link.dof);
        let inertia = matrix[at * dofs + at];
        if inertia.is_nan() || inertia <= 0.0 {
            return Err(ModelError::Weightless { segment: segment.name.clone() });
        }
        link.limit_stiffness = inertia * options.limit_frequency * options.limit_frequency;
        link.limit_damping = 2.0 * options.limit_damping * inertia * options.limit_frequency;
    }
    Ok(())
}
