//! The kit passes a world of the plane that is right and names what is wrong.

use farsa_body::ports::{
    Actuated, ActuatorId, BodyId, Handles, JointId, Lamp, NearbySurface, Planar, PlanarHit, Sight,
};
use farsa_body::robots::MobileRobot;
use farsa_body::testing::{ConformanceError, PlaneWorld, Promise, check_planar, check_rays};

const PLACES: [[f32; 2]; 4] = [[0.0, 0.0], [0.3, -0.4], [-0.5, 0.5], [-0.6, 0.6]];
const RANGE: f32 = 0.7;

fn scene() -> PlaneWorld {
    let mut world = PlaneWorld::new();
    for (a, b) in [([-1.0, -1.0], [1.0, -1.0]), ([1.0, -1.0], [1.0, 1.0]), ([1.0, 1.0], [-1.0, 1.0])] {
        world.add_wall([a, b], [0.8, 0.9, 1.0]);
    }
    world.add_disc([0.2, 0.1], 0.1, [1.0, 0.0, 0.0]);
    world.add_disc([-0.6, 0.6], 0.2, [0.0, 1.0, 0.0]);
    world.add_lamp([0.5, 0.5], 0.02, 3.0);
    world.add_area([0.0, 0.0], 0.2, [0.5; 3]);
    let robot = world.add_robot(&MobileRobot::marxbot(), [0.2, -0.5], 1.0);
    for actuator in robot.leds.into_iter().flatten().chain(robot.signal) {
        world.command(actuator, [0.5, 0.0]);
    }
    world
}

fn bodies() -> Vec<BodyId> {
    (0..4).map(BodyId).collect()
}

/// The fault of a [`Broken`] world.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    ToldTooFar,
    WrongDistance,
    Untold,
    Stranger,
    WallWithRadius,
    Bright,
    Loud,
    SeesFarther,
    SeesThrough,
    Restless,
    SeesTheOneAskedNotTo,
    BlindToDiscs,
    OtherColor,
    GroundBeyond,
    NegativeLamp,
    Empty,
    Dark,
}

struct Broken(PlaneWorld, Fault);

impl Handles for Broken {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}

impl Sight for Broken {
    fn query_near(&self, from: [f32; 2], range: f32, tell: &mut dyn FnMut(NearbySurface<BodyId>)) {
        let range = if self.1 == Fault::ToldTooFar { 1.5 * range } else { range };
        if self.1 == Fault::Empty {
            return;
        }
        self.0.query_near(from, range, &mut |mut near| {
            match self.1 {
                Fault::WrongDistance => near.distance *= 0.9,
                Fault::Untold if near.body == Some(BodyId(0)) => return,
                Fault::Stranger => near.body = near.body.map(|_| BodyId(9)),
                Fault::WallWithRadius if near.body.is_none() => near.radius = 0.1,
                Fault::Bright => near.color[1] *= 2.0,
                Fault::Loud => near.signal = near.signal.map(|_| f32::NAN),
                _ => {}
            }
            tell(near);
        });
    }
    fn cast_planar(
        &self,
        from: [f32; 2],
        direction: [f32; 2],
        range: f32,
        but: Option<BodyId>,
    ) -> Option<PlanarHit<BodyId>> {
        let look = |range, but| self.0.cast_planar(from, direction, range, but);
        match self.1 {
            Fault::Dark => None,
            Fault::SeesFarther => look(1.5 * range, but),
            Fault::SeesThrough => look(range, but.or(Some(BodyId(0)))),
            Fault::Restless => look(range, but).map(|s| PlanarHit { distance: s.distance * (1.0 - 0.1 * range), ..s }),
            Fault::SeesTheOneAskedNotTo => look(range, None),
            Fault::BlindToDiscs => look(range, but).filter(|sight| sight.body.is_none()),
            Fault::OtherColor => look(range, but).map(|sight| PlanarHit { color: [0.1; 3], ..sight }),
            _ => look(range, but),
        }
    }
}

impl Planar for Broken {
    fn ground(&self, at: [f32; 2]) -> [f32; 3] {
        if self.1 == Fault::GroundBeyond { [-0.1; 3] } else { self.0.ground(at) }
    }
    fn lamps(&self, tell: &mut dyn FnMut(Lamp<BodyId>)) {
        let sign = if self.1 == Fault::NegativeLamp { -1.0 } else { 1.0 };
        self.0.lamps(&mut |lamp| tell(Lamp { intensity: sign * lamp.intensity, ..lamp }));
    }
}

#[test]
fn the_plane_world_keeps_its_promises() {
    let world = scene();
    assert_eq!(check_planar(&world, &bodies(), &PLACES, RANGE), Ok(()));
    let origins = PLACES.map(|[x, y]| [x, y, 0.1]);
    assert_eq!(check_rays(&world, &bodies(), &origins, RANGE), Ok(()));
}

#[test]
fn every_broken_promise_is_named() {
    for (fault, promise) in [
        (Fault::ToldTooFar, Promise::Near),
        (Fault::WrongDistance, Promise::Near),
        (Fault::Untold, Promise::Near),
        (Fault::Stranger, Promise::Near),
        (Fault::WallWithRadius, Promise::Near),
        (Fault::Bright, Promise::Shown),
        (Fault::Loud, Promise::Shown),
        (Fault::SeesFarther, Promise::Look),
        (Fault::SeesThrough, Promise::Look),
        (Fault::Restless, Promise::Look),
        (Fault::SeesTheOneAskedNotTo, Promise::Look),
        (Fault::BlindToDiscs, Promise::Look),
        (Fault::OtherColor, Promise::Near),
        (Fault::GroundBeyond, Promise::Shown),
        (Fault::NegativeLamp, Promise::Shown),
        (Fault::Empty, Promise::Near),
        (Fault::Dark, Promise::Look),
    ] {
        let result = check_planar(&Broken(scene(), fault), &bodies(), &PLACES, RANGE);
        assert!(matches!(&result, Err(ConformanceError { promise: p, .. }) if *p == promise), "{fault:?}: {result:?}");
    }
}
