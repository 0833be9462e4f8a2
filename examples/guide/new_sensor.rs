//! A custom sensor and motor: a robot steers around an obstacle to a goal by its bearing.

use std::error::Error;

use farsa::body::ports::{Actuated, Channels, Kinematics, Motor, Sensor, World as _};
use farsa::body::robots::{ArmAndHand, MobileRobot, Tabletop};
use farsa::body::sensors::infrared::InfraredRays;
use farsa::body::testing::{check_motor, check_sensor};
use farsa::body::wrappers::{Delayed, Noise, Noisy};
use farsa::num::{Domain, Stream};
use farsa::physics::arena::{Arena, Cylinder, World};
use farsa::physics::articulated;

/// The direction from the first body to the second in the first one's x and y, of length 1, in two channels.
struct Bearing<B>(B, B);

impl<B> Channels for Bearing<B> {
    fn channels(&self) -> usize {
        2
    }
}

impl<B: Copy, W: Kinematics<Body = B> + ?Sized> Sensor<W> for Bearing<B> {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let [x, y, _] = world.pose(self.0).transform_back(world.pose(self.1).position);
        let distance = (x * x + y * y).sqrt().max(1e-6);
        out.iter_mut().zip([x, y]).for_each(|(o, x)| *o = x / distance);
    }
}

/// Steers two wheels, left and right, with one channel: 0 is right, 1/2 straight, 1 left. The faster wheel turns at this speed [rad/s].
struct Steer<A>([A; 2], f32);

impl<A> Channels for Steer<A> {
    fn channels(&self) -> usize {
        1
    }
}

impl<A: Copy, W: Actuated<Actuator = A> + ?Sized> Motor<W> for Steer<A> {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        if let Some(&y) = y.first() {
            let left = if y.is_nan() { 0.5 } else { y.clamp(0.0, 1.0) };
            for (wheel, share) in self.0.into_iter().zip([2.0 - 2.0 * left, 2.0 * left]) {
                world.command(wheel, [self.1 * share.min(1.0), 0.0]);
            }
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let e_puck = MobileRobot::e_puck();
    let mut arena = Arena::walled(1.5, 1.0);
    arena.add_robot(e_puck.clone(), [0.2, 0.5], 1.6);
    arena.add_cylinder(Cylinder::new([1.3, 0.5], 0.03));
    arena.add_cylinder(Cylinder::new([0.7, 0.45], 0.06));
    let (parts, goal) = (arena.parts(0), arena.cylinder(0));
    let start = World::new(&arena)?;

    // The promises of every sensor and motor, in any world with the port.
    check_sensor(&mut Bearing(parts.body, goal), &start)?;
    check_motor(&mut Steer(parts.motors, 5.0), || start.clone())?;
    let scene = Tabletop::default().scene(&ArmAndHand::default())?;
    let table = articulated::World::new(articulated::Model::<f32>::new(&scene, &articulated::Options::default())?);
    check_sensor(&mut Bearing(ArmAndHand::PALM, Tabletop::SPHERE), &table)?;
    println!("the promises are kept");

    for (name, ticks, deviation) in [("plain", 0, 0.0), ("late", 10, 0.0), ("late and noisy", 10, 0.3)] {
        let noise = Stream::new(1, Domain::Sensor, 0, 0, 0);
        let bearing = Delayed::new(Bearing(parts.body, goal), ticks);
        let mut sensors = (
            Noisy::new(bearing, Noise::Normal(deviation), noise)?,
            InfraredRays::for_robot(&e_puck, parts.body)?, // left to right: 54 degrees is number 1, -54 degrees number 4
        );
        let mut motor = Steer(parts.motors, 5.0);
        let (mut x, mut y) = ([0.0; 10], [0.0; 1]);
        assert_eq!((sensors.channels(), motor.channels()), (x.len(), y.len()));

        let mut world = start.clone();
        let mut seconds = 0.0;
        let away = loop {
            sensors.read(&world, &mut x);
            let [_, to_left, eyes @ ..] = x;
            let [left, right] = [eyes[1] + eyes[2], eyes[3] + eyes[4]];
            y[0] = 0.5 + 0.5 * to_left - left + right;
            motor.drive(&y, &mut world);
            world.step();
            seconds += world.time_step();
            let [dx, dy] = [0, 1].map(|k| world.pose(goal).position[k] - world.pose(parts.body).position[k]);
            let away = (dx * dx + dy * dy).sqrt();
            if away < 0.1 || seconds > 60.0 {
                break away;
            }
        };
        println!("{name}: {away:.3} m from the goal after {seconds:.1} s");
        assert!(away < 0.1, "it did not get there");
    }
    Ok(())
}
