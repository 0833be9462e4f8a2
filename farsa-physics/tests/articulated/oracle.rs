//! The step against dense algebra: joints, actuators and stops without contacts. Impulses, their laws and their
//! response.

use crate::common;
use crate::common::{
    Babble, CLOSED, Wrist, close, commands, drive, first_point, ghost, hand_and_sphere, model, one_step, points_of,
    pose_hand, put_in_the_palm, scene, start, stream,
};
use farsa_body::actuators::Law;
use farsa_body::ports::{Arrange, BodyId, JointId, World as _};
use farsa_body::robot::{Robot, Shape};
use farsa_body::robots::{ArmAndHand, Tabletop};
use farsa_body::{Pose, Twist};
use farsa_physics::articulated::{Model, Options, Scratch, World, inverse_dynamics, jacobian, mass_matrix};
use nalgebra::{DMatrix, DVector, Vector3};

/// The matrix and the efforts of one implicit step: `M + h D + h^2 K`, and everything that accelerates.
struct Dense {
    matrix: DMatrix<f64>,
    effort: DVector<f64>,
    /// Stiffness of every joint's stop.
    stop: Vec<f64>,
    scratch: Scratch<f64>,
}

/// Stops have the stiffness I f^2 with I the joint's inertia at the description's start.
fn stop_stiffness(model: &Model<f64>, options: &Options) -> Vec<f64> {
    let mut scratch = Scratch::new((), model);
    scratch.forward_kinematics((), model, World::new(model.clone()).state());
    let n = model.dofs();
    let mut m = vec![0.0; n * n];
    mass_matrix((), model.links(), scratch.links(), &mut m);
    (0..n).map(|i| m[i * n + i] * options.limit_frequency * options.limit_frequency).collect()
}

fn dense(robot: &Robot, model: &Model<f64>, options: &Options, state: &[f64], stop: &[f64]) -> Dense {
    let (nq, n) = (model.positions(), model.dofs());
    let h = options.time_step;
    let mut scratch = Scratch::new((), model);
    scratch.forward_kinematics((), model, state);
    let mut m = vec![0.0; n * n];
    mass_matrix((), model.links(), scratch.links(), &mut m);
    let mut bias = vec![0.0; n];
    inverse_dynamics((), model.links(), model.gravity(), &vec![0.0; n], scratch.links(), &mut bias);
    let mut matrix = DMatrix::from_row_slice(n, n, &m);
    let mut effort = -DVector::from_vec(bias);
    for (i, segment) in robot.segments.iter().enumerate() {
        let Some((iq, iv)) = model.joint_index(JointId(i as u16)) else { continue };
        let (q, v) = (state[iq], state[nq + iv]);
        let joint = &segment.joint;
        let (mut damping, mut stiffness) = (joint.damping, joint.stiffness);
        let mut torque = -damping * v - stiffness * (q - joint.rest);
        let [low, high] = joint.range;
        let ahead = q + h * v;
        if ahead > high || ahead < low {
            let k = stop[iv];
            let b = 2.0 * options.limit_damping * k / options.limit_frequency;
            torque += -k * (q - if ahead > high { high } else { low }) - b * v;
            damping += b;
            stiffness += k;
        }
        for (a, actuator) in robot.actuators.iter().enumerate() {
            if actuator.joint.index() == i {
                let command = [state[nq + n + 2 * a], state[nq + n + 2 * a + 1]];
                let e = actuator.law.effort(q, v, command);
                torque += e.torque;
                damping += e.damping;
                stiffness += e.stiffness;
            }
        }
        effort[iv] += torque - h * stiffness * v;
        matrix[(iv, iv)] += h * damping + h * h * stiffness;
    }
    Dense { matrix, effort, stop: stop.to_vec(), scratch }
}

fn top(x: &DVector<f64>) -> f64 {
    x.iter().fold(0.0, |m, x| m.max(x.abs()))
}

#[test]
fn without_contacts_the_step_is_the_dense_implicit_step() {
    let mut robot = ghost(&scene());
    for segment in robot.segments.iter_mut().take(12) {
        segment.joint = segment.joint.clone().with_spring(0.7, -0.2);
    }
    let groups = ArmAndHand::default().servo_groups();
    let (mut worst, mut stops, mut saturated) = (0.0_f64, 0, 0);
    for h in [5e-3, 2.5e-3, 1e-3, 1e-4] {
        let options = one_step(h);
        let model = model::<f64>(&robot, options);
        let stop = stop_stiffness(&model, &options);
        let mut world = World::new(model.clone());
        let (nq, n) = (model.positions(), model.dofs());
        for k in 0..200 {
            let mut s = stream(21, k);
            for j in 0..27 {
                let [low, high] = robot.segments[j].joint.range;
                let beyond = 0.05 * (high - low);
                world.place_joint(
                    JointId(j as u16),
                    s.range_f64(low - beyond, high + beyond) as f32,
                    s.range(-10.0, 10.0),
                );
            }
            let turn: [f32; 4] = core::array::from_fn(|_| s.range(-1.0, 1.0));
            let length = turn.iter().map(|x| x * x).sum::<f32>().sqrt();
            let pose = Pose { position: [0.1, 0.2, 0.3], rotation: turn.map(|x| x / length) };
            let any: [f32; 6] = core::array::from_fn(|_| s.range(-3.0, 3.0));
            let twist = Twist { linear: [any[0], any[1], any[2]], angular: [any[3], any[4], any[5]] };
            world.place_body(Tabletop::SPHERE, pose, twist);
            world.finish_placement();
            drive(&mut world, &commands(&groups, Babble::new(22, k).next()));
            let before = world.state().to_vec();
            let dense = dense(&robot, &model, &options, &before, &stop);
            let v = DVector::from_row_slice(&before[nq..nq + n]);
            let change = dense.matrix.clone().cholesky().unwrap().solve(&(dense.effort * h));
            world.step();
            let after = DVector::from_row_slice(world.velocities());
            worst = worst.max(top(&(&after - &v - &change)) / top(&change));
            for j in 0..27 {
                let [low, high] = robot.segments[j].joint.range;
                let ahead = before[j] + h * before[nq + j];
                stops += usize::from(ahead > high || ahead < low);
                assert!((world.positions()[j] - before[j] - h * after[j]).abs() <= 1e-14);
            }
            saturated += (7..27)
                .filter(|&a: &usize| (before[nq + n + 2 * a] - before[a] - 0.04 * before[nq + a]).abs() > 0.3)
                .count();
        }
    }
    println!(
        "800 states: {worst:.1e} of the change of velocity; {stops} stops, {saturated} saturated servos among them"
    );
    assert!(worst < 1e-9 && stops > 1000 && saturated > 1000);
}

/// The unit normal that pushes the first collider away, from the contact point, for balls and capsules first.
fn normal([shape, other]: [Shape; 2], index: usize, place: &Pose<f64>, point: [f64; 3]) -> Option<Vector3<f64>> {
    let local = place.transform_back(point);
    let core = match shape {
        Shape::Sphere { .. } => [0.0; 3],
        Shape::Capsule { half_length, .. } if order(other) == 1 => {
            [0.0, 0.0, local[2].clamp(-half_length, half_length)]
        }
        // The ends of a capsule.
        Shape::Capsule { half_length, .. } => [0.0, 0.0, if index == 0 { -half_length } else { half_length }],
        _ => return None,
    };
    let d = place.rotate([core[0] - local[0], core[1] - local[1], core[2] - local[2]]);
    Some(Vector3::from(d).normalize())
}

fn order(shape: Shape) -> u8 {
    match shape {
        Shape::Sphere { .. } => 0,
        Shape::Capsule { .. } => 1,
        Shape::Box { .. } => 2,
        Shape::Cylinder { .. } => 3,
        Shape::Plane => 4,
    }
}

/// The deviation of impulses from their laws.
#[derive(Default, Debug)]
struct Misfit {
    /// Generalised impulse that no stored impulse explains, relative.
    response: f64,
    /// The deviation of the normal velocity from the law of spring and damper [m/s], the largest of every step.
    normal: Vec<f64>,
    /// Depth or approach at points that carry nothing [m].
    apart: f64,
    /// Tangential over largest friction, minus 1.
    cone: f64,
    /// Tangential velocity of a sticking point beyond the residual slip [m/s], largest of every step.
    stick: Vec<f64>,
    /// Sine of the angle between sliding velocity and friction, largest of every step.
    slide: Vec<f64>,
    /// Impulse of a stop that differs from its law, relative to the largest impulse.
    stop: f64,
    points: usize,
    sticking: usize,
    sliding: usize,
    stops: usize,
    rolling: usize,
}

struct Checker<'a> {
    robot: &'a Robot,
    model: &'a Model<f64>,
    options: Options,
    stop: Vec<f64>,
    free: World<f64>,
}

impl Checker<'_> {
    /// One step of `world`, and how well it keeps the laws.
    fn step(&mut self, world: &mut World<f64>, out: &mut Misfit) {
        let (robot, model, options) = (self.robot, self.model, self.options);
        let (nq, n, h) = (model.positions(), model.dofs(), options.time_step);
        let before = world.state().to_vec();
        let places: Vec<Pose<f64>> = robot
            .colliders
            .iter()
            .map(|c| c.body.map_or(Pose::identity(), |b| world.pose_of(b)).compose(&c.placement))
            .collect();
        let shared = nq + n + 2 * robot.actuators.len();
        self.free.state_mut().copy_from_slice(&before[..shared]);
        self.free.finish_placement();
        self.free.step();
        world.step();
        let after = DVector::from_row_slice(world.velocities());
        let free = DVector::from_row_slice(self.free.velocities());
        let mut dense = dense(robot, model, &options, &before, &self.stop);
        let total = &dense.matrix * (&after - &free);
        let mut left = total.clone();
        let mut row = vec![0.0; 6 * n];
        // The jacobian of a body's point: rows angular, linear.
        let scratch = &mut dense.scratch;
        let mut jacobian_at = |body: Option<BodyId>, point: [f64; 3]| {
            let Some(link) = body.and_then(|b| model.link_of(b)) else { return DMatrix::zeros(6, n) };
            jacobian((), model.links(), scratch.links(), link, point, &mut row);
            DMatrix::from_row_slice(6, n, &row)
        };
        let state = world.state();
        let (mut off_normal, mut off_stick, mut off_slide) = (0.0_f64, 0.0_f64, 0.0_f64);
        let (mut at, mut turn) = (first_point(robot, model), first_point(robot, model));
        turn += 8 * (0..robot.pairs.len()).map(|p| points_of(robot, p)).sum::<usize>();
        for (p, pair) in robot.pairs.iter().enumerate() {
            let [mut a, mut b] = pair.colliders;
            let [sa, sb] = [a, b].map(|c| robot.colliders[c].shape);
            let still = |c: usize| robot.colliders[c].body.is_none();
            if order(sa) > order(sb) || order(sa) == 2 && order(sb) == 2 && still(a) {
                (a, b) = (b, a);
            }
            let surface = pair.surface;
            for index in 0..points_of(robot, p) {
                let w = &state[at..at + 8];
                at += 8;
                let rolls = surface.rolling_friction > 0.0;
                let moment = rolls.then(|| Vector3::new(state[turn], state[turn + 1], state[turn + 2]));
                turn += if rolls { 3 } else { 0 };
                let impulse = Vector3::new(w[0], w[1], w[2]);
                let active = w[3] > 0.0;
                if !active && w[4..7] == [0.0; 3] {
                    // Not even watched.
                    assert!(impulse == Vector3::zeros());
                    out.apart = out.apart.max(-w[7]);
                    continue;
                }
                let point = [w[4], w[5], w[6]];
                let j = jacobian_at(robot.colliders[a].body, point) - jacobian_at(robot.colliders[b].body, point);
                left -= j.rows(3, 3).tr_mul(&impulse);
                if let Some(moment) = moment {
                    left -= j.rows(0, 3).tr_mul(&moment);
                    out.rolling += usize::from(moment.norm() > 0.0);
                    let limit = surface.rolling_friction * w[3];
                    out.cone = out.cone.max((moment.norm() - limit) / limit.max(1e-12));
                }
                // Between the ends of a capsule the place on its axis is searched, because the point gives it only
                // roughly.
                if index == 2 {
                    continue;
                }
                let Some(normal) = normal([a, b].map(|c| robot.colliders[c].shape), index, &places[a], point) else {
                    continue;
                };
                let u = j.rows(3, 3) * &after;
                let u = Vector3::new(u[0], u[1], u[2]);
                let (un, ut) = (u.dot(&normal), u - normal * u.dot(&normal));
                let (k, damping) = (surface.stiffness, surface.damping);
                if !active {
                    // An impulse would pull.
                    let gap = w[7] - h * un;
                    let rate = if gap <= 0.0 { damping } else { 0.0 };
                    out.apart = out.apart.max(-(w[7] + rate * un / k));
                    continue;
                }
                out.points += 1;
                let gap = w[7] - h * un;
                let rate = if gap <= 0.0 { damping } else { 0.0 };
                let asked = -h * (k * w[7] + rate * un);
                off_normal = off_normal.max((w[3] - asked).abs() / (h * (h * k + rate)));
                let across = impulse - normal * impulse.dot(&normal);
                assert!(
                    (impulse.dot(&normal) - w[3]).abs() <= 1e-9 * w[3].max(1e-6),
                    "the normal impulse is along the normal"
                );
                let limit = surface.friction * w[3];
                out.cone = out.cone.max((across.norm() - limit) / limit);
                if across.norm() < limit * (1.0 - 1e-9) {
                    out.sticking += 1;
                    off_stick = off_stick.max((ut + across * options.friction_compliance).norm());
                } else {
                    out.sliding += 1;
                    let w = ut + across * options.friction_compliance;
                    if w.norm() > 1e-3 {
                        off_slide = off_slide.max((w.normalize() + across.normalize()).norm());
                    }
                }
            }
        }
        out.normal.push(off_normal);
        out.stick.push(off_stick);
        out.slide.push(off_slide);
        let scale = top(&total).max(1e-9);
        for i in 0..27 {
            let Some((iq, iv)) = model.joint_index(JointId(i as u16)) else { continue };
            let [low, high] = robot.segments[i].joint.range;
            let q = world.positions()[iq];
            let law = h * dense.stop[iv] * ((low - q).max(0.0) - (q - high).max(0.0));
            if left[iv].abs() > 1e-9 * scale {
                // An impulse that no contact explains must be a stop's.
                out.stops += 1;
                out.stop = out.stop.max((left[iv] - law).abs() / scale);
                left[iv] = 0.0;
            }
        }
        out.response = out.response.max(top(&left) / scale);
    }
}

/// A checker and the world it steps, with contacts solved in this many sweeps.
fn check(robot: &Robot, options: Options, run: impl FnOnce(&mut Checker, &mut World<f64>, &mut Misfit)) -> Misfit {
    let model = model::<f64>(robot, options);
    let free = World::new(common::model(&ghost(robot), options));
    let stop = stop_stiffness(&model, &options);
    let mut world = World::new(model.clone());
    let mut misfit = Misfit::default();
    run(&mut Checker { robot, model: &model, options, stop, free }, &mut world, &mut misfit);
    misfit
}

/// The default sweeps, which may end earlier, or another number, of which all are made.
fn swept(sweeps: u32) -> Options {
    let default = one_step(2.5e-3);
    if sweeps == default.sweeps { default } else { Options { sweeps, settled: 0.0, ..default } }
}

/// Random episodes of the whole scene: the hand hits the table and presses on it, kicks the sphere.
fn babble(sweeps: u32) -> Misfit {
    let robot = scene();
    let groups = ArmAndHand::default().servo_groups();
    check(&robot, swept(sweeps), |checker, world, misfit| {
        for episode in 0..12 {
            start(&robot, world, &mut stream(31, episode), episode as usize);
            // Held commands.
            let mut babble = Babble::new(32, 2 + episode % 4);
            for t in 0..400 {
                if t % 4 == 0 {
                    drive(world, &commands(&groups, babble.next()));
                }
                // Most steps only carry the scene on.
                if t % 8 == 0 { checker.step(world, misfit) } else { world.step() }
            }
        }
    })
}

/// A hand that squeezes the sphere.
fn grasp(sweeps: u32) -> Misfit {
    let arm = ArmAndHand::default();
    let robot = hand_and_sphere(Wrist::Fixed, arm.surface, Some(Law::Servo(arm.servo)));
    check(&robot, Options { gravity: [0.0; 3], ..swept(sweeps) }, |checker, world, misfit| {
        put_in_the_palm(world, 0.0);
        pose_hand(world, &CLOSED.map(|x| 0.5 * x));
        world.finish_placement();
        let mut stream = stream(33, 0);
        for t in 0..800 {
            if t % 50 == 0 {
                close(world, &CLOSED.map(|x| (x + 0.2 * (stream.uniform() - 0.3)).clamp(0.0, 1.0)));
            }
            if t % 4 == 0 { checker.step(world, misfit) } else { world.step() }
        }
    })
}

/// The middle one, the 95th of a hundred and the largest.
fn spread(x: &[f64]) -> [f64; 3] {
    let mut x = x.to_vec();
    x.sort_by(f64::total_cmp);
    [x[x.len() / 2], x[x.len() * 95 / 100], x[x.len() - 1]]
}

#[test]
fn impulses_explain_the_change_of_velocity_and_keep_their_laws() {
    for (name, run) in [("random episodes", babble as fn(u32) -> Misfit), ("a squeeze", grasp)] {
        for sweeps in [10, 200, 2000] {
            let m = run(sweeps);
            let text = |x: [f64; 3]| format!("{:.1e} {:.1e} {:.1e}", x[0], x[1], x[2]);
            let [normal, stick, slide] = [&m.normal, &m.stick, &m.slide].map(|x| spread(x));
            println!(
                "{name}, {sweeps} sweeps, {} points, {} sticking, {} sliding, {} stops: response {:.1e}, cone {:.1e}, stops {:.1e}; \
                 median, 95 % and worst: normal {} m/s, sticking {} m/s, sliding {} rad",
                m.points,
                m.sticking,
                m.sliding,
                m.stops,
                m.response,
                m.cone,
                m.stop,
                text(normal),
                text(stick),
                text(slide)
            );
            assert!(m.points > 500 && m.sticking > 300 && m.sliding > 20 && m.stops > 0, "too little happened");
            // These hold whether the sweeps have converged or not.
            assert!(m.response < 1e-9 && m.cone < 1e-9 && m.stop < if sweeps == 10 { 1e-8 } else { 1e-9 });
            match (name, sweeps) {
                // A finger closed onto the palm is a separate loop, which takes more than 200 sweeps to the last digit.
                ("random episodes", 200) => {
                    assert!(m.apart < 1e-9 && normal[1] < 1e-9 && stick[1] < 1e-9 && slide[1] < 1e-9);
                    assert!(normal[2] < 1e-5 && stick[2] < 1e-5 && slide[2] < 1e-4);
                }
                ("random episodes", 2000) => {
                    assert!(m.apart < 1e-9 && normal[2] < 1e-6 && stick[2] < 1e-5 && slide[2] < 1e-6);
                }
                // Fingers that work against each other through the sphere: slow, and once in hundreds of steps the sweeps go
                // in circles between sliding and sticking.
                ("a squeeze", 200) => {
                    assert!(normal[0] < 1e-3 && stick[0] < 2e-3 && normal[2] < 0.05 && stick[2] < 0.1);
                }
                ("a squeeze", 2000) => {
                    assert!(normal[0] < 1e-5 && stick[0] < 5e-5 && normal[1] < 5e-4 && stick[1] < 2e-3);
                }
                // The residual of the default: far below what ends the sweeps, 1e-4 m/s, in most steps, and 5 mm/s in the median
                // of a hard squeeze.
                ("random episodes", _) => {
                    assert!(
                        normal[0] < 1e-5 && stick[0] < 1e-9 && slide[0] < 1e-9 && normal[1] < 1e-3 && stick[1] < 1e-3
                    );
                }
                _ => assert!(normal[0] < 7e-3 && stick[0] < 2e-2 && normal[1] < 0.1 && stick[1] < 0.2),
            }
        }
    }
}
