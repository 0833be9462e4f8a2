//! A custom wheeled robot finds its way out of a corner.

use std::error::Error;
use std::fs;

use farsa::body::Recorder as _;
use farsa::body::motors::WheelVelocity;
use farsa::body::ports::{Channels as _, Contacts as _, Kinematics as _, Motor as _, PairId, Sensor as _, World as _};
use farsa::body::robots::{InfraredRing, MobileRobot};
use farsa::body::sensors::infrared::InfraredRays;
use farsa::physics::arena::{Arena, Cylinder, World};
use farsa_view::{Camera, Recording, Schema};

fn main() -> Result<(), Box<dyn Error>> {
    let angles = [1.2, 0.6, 0.0, -0.6, -1.2]; // counter-clockwise from ahead
    let cart = MobileRobot {
        name: "cart".into(),
        radius: 0.08,
        track: 0.12,
        wheel_radius: 0.03,
        max_wheel_speed: 10.0,
        infrared: InfraredRing { angles: angles.into(), range: 0.25, aperture: 0.2, rays: 5 },
        ..MobileRobot::khepera()
    };
    let mut arena = Arena::walled(2.0, 1.5);
    arena.add_cylinder(Cylinder::new([1.2, 0.5], 0.1));
    arena.add_robot(cart.clone(), [0.3, 0.3], -2.4);
    let parts = arena.parts(0);
    let mut world = World::new(&arena)?;

    let mut sensors = InfraredRays::for_robot(&cart, parts.body)?;
    let mut wheels = WheelVelocity::new(parts.motors, cart.max_wheel_speed as f32)?;
    let (mut x, mut y) = ([0.0; 5], [0.0; 2]);
    assert_eq!((sensors.channels(), wheels.channels()), (x.len(), y.len()));

    let mut recording = Recording::new(Schema::from_arena(&arena).with_sensors(["1", "2", "3", "4", "5"]));
    let mut bumps = 0;
    for tick in 1..=600_u32 {
        sensors.read(&world, &mut x);
        // Each side slows the other side's wheel. An obstacle straight ahead turns the robot to the left.
        y = [0.9 - x[4] - x[3] - 1.5 * x[2], 0.9 - x[0] - x[1]];
        wheels.drive(&y, &mut world);
        world.step(); // 50 ms
        bumps += u32::from(world.touches(PairId(0))); // each robot has one pair, its own with whatever it met
        recording.world(&world).sensors(&x);
        recording.tick(0.05 * f64::from(tick));
    }
    let [x, y, _] = world.pose(parts.body).position;
    println!("after 30 s: at ({x:.2}, {y:.2}) m, {bumps} ticks against something");
    assert_eq!(bumps, 0, "it bumped into something");
    let picture = recording.picture(599).ok_or("nothing to see")?;
    fs::write("cart.svg", picture.svg(Camera::named("top")?, [600, 450], "cart-"))?;
    Ok(())
}
