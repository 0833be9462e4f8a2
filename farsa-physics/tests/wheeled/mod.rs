//! The descriptions of wheeled robots as bodies: what any world with joints and contacts makes of them.

use farsa_body::ports::{Actuated, ActuatorId, Arrange, BodyId, Handles, JointId, Kinematics, World};
use farsa_body::robot::{MassProperties, Robot};
use farsa_body::robots::MobileRobot;
use farsa_body::{Pose, Twist};

/// The control step of the worlds that are tested [s].
const STEP: f64 = 0.01;

/// Control steps of a drive: half a second.
const STEPS: usize = 50;

pub(crate) fn robots() -> [MobileRobot; 3] {
    [MobileRobot::khepera(), MobileRobot::e_puck(), MobileRobot::marxbot()]
}

/// The tolerance between a world and the expectation.
pub(crate) struct Tolerance {
    /// Between the hull and its height at rest [m].
    pub(crate) height: f64,
    /// The tolerance of driven distances and angles, as a part of them.
    pub(crate) drive: f64,
}

/// A robot as a body on wheels, in closed form.
struct Vehicle {
    mass: f64,
    /// The inertia of all, about the vertical axis between the wheels.
    turning: f64,
    /// The inertia of a wheel, about its axle.
    wheel: f64,
    radius: f64,
    track: f64,
    /// The torque of each wheel's motor: a quarter of its largest [N m].
    torque: f64,
}

impl Vehicle {
    fn new(mobile: &MobileRobot, robot: &Robot) -> Self {
        // The hull's frame is the robot's, and nothing but the wheels has another and a mass.
        let placed = robot.segments.iter().enumerate().map(|(number, segment)| {
            let own = segment.mass_properties();
            if number == 0 { own } else { own.placed(&segment.joint.placement) }
        });
        let nothing = MassProperties { mass: 0.0, centre: [0.0; 3], inertia: [0.0; 6] };
        let all = placed.fold(nothing, |sum, one| sum.with(&one));
        assert!(all.centre[0].abs() < 1e-12 && all.centre[1].abs() < 1e-12, "{}: {:?}", mobile.name, all.centre);
        Self {
            mass: all.mass,
            turning: all.inertia[2],
            wheel: robot.segments[1].inertia[1],
            radius: mobile.wheel_radius,
            track: mobile.track,
            torque: 0.25 * 0.25 * 9.81 * mobile.mass() * mobile.wheel_radius,
        }
    }

    /// Returns the acceleration by both wheels' torques [m/s2], against its mass and the inertia of the wheels.
    fn ahead(&self) -> f64 {
        2.0 * self.torque / self.radius / (self.mass + 2.0 * self.wheel / (self.radius * self.radius))
    }

    /// Returns the turning acceleration by opposite torques [rad/s2].
    fn aside(&self) -> f64 {
        let across = self.track / self.radius;
        self.torque * across / (self.turning + 0.5 * self.wheel * across * across)
    }
}

/// Where the hull is: its place, its height above where it is built, and the sine of how far it tilts.
fn stance<W: Kinematics + Handles<Body = BodyId>>(world: &W) -> ([f64; 2], f64, f64) {
    let pose = world.pose(BodyId(0));
    let [x, y, z] = pose.position.map(f64::from);
    let up = pose.rotate([0.0, 0.0, 1.0]).map(f64::from);
    ([x, y], z, (up[0] * up[0] + up[1] * up[1]).sqrt())
}

/// Lets the robot come to rest, and drives it by these torques of the left and the right wheel. Returns its pose after
/// every step.
fn drive<W>(world: &mut W, torques: [f64; 2], mut look: impl FnMut(&W))
where
    W: World + Actuated + Arrange + Kinematics + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>,
{
    world.clear();
    world.place_body(BodyId(0), Pose::at([0.0, 0.0, 0.0]), Twist::default());
    world.finish_placement();
    for step in 0..2 * STEPS {
        let given = if step < STEPS { [0.0; 2] } else { torques };
        for (wheel, torque) in given.into_iter().enumerate() {
            world.command(ActuatorId(wheel as u16), [torque as f32, 0.0]);
        }
        world.step();
        look(world);
    }
}

/// The robot rests on its wheels (0.05 mm deep, as in MuJoCo 4.0.0), drives straight ahead by equal torques and turns
/// on the spot by opposite ones. Both agree with the closed form (0.8 % further in half a second, as in MuJoCo), and
/// the robot neither tips nor sinks.
pub(crate) fn check<W>(mut world: impl FnMut(&Robot) -> W, tolerance: &Tolerance)
where
    W: World + Actuated + Arrange + Kinematics + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>,
{
    // Semi-implicit steps are half a step ahead of t^2 / 2.
    let time = STEPS as f64 * STEP;
    let passed = 0.5 * time * time;
    for mobile in robots() {
        let (name, robot) = (&mobile.name, mobile.description());
        let vehicle = Vehicle::new(&mobile, &robot);
        let mut world = world(&robot);
        // Until a skid touches: it is 0.7 radii away, and 2 % of a wheel's radius above the ground.
        let most = 1.2 * (0.02 * mobile.wheel_radius / (0.7 * mobile.radius));
        let torque = vehicle.torque;

        for torques in [[0.0; 2], [torque; 2], [-torque; 2], [torque, -torque], [-torque, torque]] {
            let (mut heading, mut before) = (0.0, 0.0);
            drive(&mut world, torques, |world| {
                let (_, height, tilt) = stance(world);
                assert!(height.abs() < tolerance.height, "{name}, {torques:?}: {height} m above its place");
                assert!(tilt < most, "{name}, {torques:?}: tilts by {tilt} rad of {most}");
                let now = f64::from(world.pose(BodyId(0)).heading());
                let turned = now - before;
                heading += turned - std::f64::consts::TAU * (turned / std::f64::consts::TAU).round();
                before = now;
            });
            let ([x, y], _, _) = stance(&world);
            let [left, right] = torques.map(|torque| torque / vehicle.torque);
            let ahead = 0.5 * (left + right) * vehicle.ahead() * passed;
            let turned = 0.5 * (right - left) * vehicle.aside() * passed;
            println!("{name} {left} {right}: {x:.5} of {ahead:.5} m, aside {y:.1e} m, {heading:.4} of {turned:.4} rad");
            // The drift while it rests and tilts: less than a millimeter.
            let off = tolerance.drive * ahead.abs() + 1e-3;
            assert!((x - ahead).abs() < off && y.abs() < 1e-3, "{name}, {torques:?}: at {x}, {y}, not {ahead} m");
            let off = tolerance.drive * turned.abs() + 0.01;
            assert!((heading - turned).abs() < off, "{name}, {torques:?}: turned by {heading}, not {turned} rad");
        }
    }
}
