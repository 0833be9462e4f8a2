//! Registration of parts under names.

use farsa_body::robot::Robot;
use farsa_body::robots::MobileRobot;
use farsa_lab::Error;
use farsa_lab::advanced::Part;

use crate::document::Object;
use crate::part::definition::{Build, Definition, Given, Maker, keys};
use crate::part::end::EndPart;
use crate::part::motor::{AnyMotor, MotorPart};
use crate::part::network::{AnyNetworkPart, NetworkPart};
use crate::part::object::{
    PlanarEnd, PlanarMotor, PlanarSensor, PlanarStart, PlanarTerm, SpatialEnd, SpatialMotor, SpatialSensor,
    SpatialStart, SpatialTerm,
};
use crate::part::scene::PartScene;
use crate::part::sensor::{AnySensor, SensorPart};
use crate::part::start::{AnyStart, StartPart};
use crate::part::term::{AnyTerm, TermPart};
use crate::part::thing::ThingPart;
use crate::part::wrapper::{AnyWrapper, WrapperPart};

/// Builds parts of a kind in a world from their keys.
macro_rules! building {
    ($name:ident, $part:ident, $made:ident, $method:ident, $object:ident) => {
        fn $name<P: $part<$made: $object>>(given: &Given, scene: &PartScene<'_>) -> Result<Box<dyn $object>, Error> {
            Ok(keys::<P>(given)?.$method(scene)?.boxed())
        }
    };
}
building!(planar_sensor_of, SensorPart, Sensor, sensor, PlanarSensor);
building!(spatial_sensor_of, SensorPart, Sensor, sensor, SpatialSensor);
building!(planar_motor_of, MotorPart, Motor, motor, PlanarMotor);
building!(spatial_motor_of, MotorPart, Motor, motor, SpatialMotor);
building!(planar_term_of, TermPart, Term, term, PlanarTerm);
building!(spatial_term_of, TermPart, Term, term, SpatialTerm);
building!(planar_start_of, StartPart, Start, start, PlanarStart);
building!(spatial_start_of, StartPart, Start, start, SpatialStart);
building!(planar_end_of, EndPart, End, end, PlanarEnd);
building!(spatial_end_of, EndPart, End, end, SpatialEnd);

fn any_sensor<P: SensorPart>(given: &Given) -> Result<Box<dyn AnySensor>, Error> {
    Ok(Box::new(keys::<P>(given)?))
}

fn any_start<P: StartPart>(given: &Given) -> Result<Box<dyn AnyStart>, Error> {
    Ok(Box::new(keys::<P>(given)?))
}

fn any_term<P: TermPart>(given: &Given) -> Result<Box<dyn AnyTerm>, Error> {
    Ok(Box::new(keys::<P>(given)?))
}

fn any_motor<P: MotorPart>(given: &Given) -> Result<Box<dyn AnyMotor>, Error> {
    Ok(Box::new(keys::<P>(given)?))
}

/// Registers a kind of sensor for all robots under a name.
pub fn sensor<P>(name: &'static str) -> Part
where
    P: SensorPart<Sensor: PlanarSensor + SpatialSensor>,
{
    Definition::part::<P>(
        name,
        Build::Sensor((Some(planar_sensor_of::<P>), Some(spatial_sensor_of::<P>)), any_sensor::<P>),
    )
}

/// Registers a kind of sensor for robots on wheels under a name.
pub fn planar_sensor<P: SensorPart<Sensor: PlanarSensor>>(name: &'static str) -> Part {
    Definition::part::<P>(name, Build::Sensor((Some(planar_sensor_of::<P>), None), any_sensor::<P>))
}

/// Registers a kind of sensor for robots with joints under a name.
pub fn spatial_sensor<P: SensorPart<Sensor: SpatialSensor>>(name: &'static str) -> Part {
    Definition::part::<P>(name, Build::Sensor((None, Some(spatial_sensor_of::<P>)), any_sensor::<P>))
}

/// Registers a kind of motor for all robots under a name.
pub fn motor<P>(name: &'static str) -> Part
where
    P: MotorPart<Motor: PlanarMotor + SpatialMotor>,
{
    Definition::part::<P>(name, Build::Motor((Some(planar_motor_of::<P>), Some(spatial_motor_of::<P>)), any_motor::<P>))
}

/// Registers a kind of motor for robots on wheels under a name.
pub fn planar_motor<P: MotorPart<Motor: PlanarMotor>>(name: &'static str) -> Part {
    Definition::part::<P>(name, Build::Motor((Some(planar_motor_of::<P>), None), any_motor::<P>))
}

/// Registers a kind of motor for robots with joints under a name.
pub fn spatial_motor<P: MotorPart<Motor: SpatialMotor>>(name: &'static str) -> Part {
    Definition::part::<P>(name, Build::Motor((None, Some(spatial_motor_of::<P>)), any_motor::<P>))
}

/// Registers a kind of term for all robots under a name.
pub fn term<P>(name: &'static str) -> Part
where
    P: TermPart<Term: PlanarTerm + SpatialTerm>,
{
    Definition::part::<P>(name, Build::Term((Some(planar_term_of::<P>), Some(spatial_term_of::<P>)), any_term::<P>))
}

/// Registers a kind of term for robots on wheels under a name.
pub fn planar_term<P: TermPart<Term: PlanarTerm>>(name: &'static str) -> Part {
    Definition::part::<P>(name, Build::Term((Some(planar_term_of::<P>), None), any_term::<P>))
}

/// Registers a kind of term for robots with joints under a name.
pub fn spatial_term<P: TermPart<Term: SpatialTerm>>(name: &'static str) -> Part {
    Definition::part::<P>(name, Build::Term((None, Some(spatial_term_of::<P>)), any_term::<P>))
}

/// Registers a kind of placement for all robots under a name.
pub fn start<P>(name: &'static str) -> Part
where
    P: StartPart<Start: PlanarStart + SpatialStart>,
{
    Definition::part::<P>(name, Build::Start((Some(planar_start_of::<P>), Some(spatial_start_of::<P>)), any_start::<P>))
}

/// Registers a kind of placement for robots on wheels under a name.
pub fn planar_start<P: StartPart<Start: PlanarStart>>(name: &'static str) -> Part {
    Definition::part::<P>(name, Build::Start((Some(planar_start_of::<P>), None), any_start::<P>))
}

/// Registers a kind of placement for robots with joints under a name.
pub fn spatial_start<P: StartPart<Start: SpatialStart>>(name: &'static str) -> Part {
    Definition::part::<P>(name, Build::Start((None, Some(spatial_start_of::<P>)), any_start::<P>))
}

/// Registers a kind of end for all robots under a name.
pub fn end<P>(name: &'static str) -> Part
where
    P: EndPart<End: PlanarEnd + SpatialEnd>,
{
    Definition::part::<P>(
        name,
        Build::End((Some(planar_end_of::<P>), Some(spatial_end_of::<P>)), P::DEPENDS_ON_SUCCESS),
    )
}

/// Registers a kind of end for robots on wheels under a name.
pub fn planar_end<P: EndPart<End: PlanarEnd>>(name: &'static str) -> Part {
    Definition::part::<P>(name, Build::End((Some(planar_end_of::<P>), None), P::DEPENDS_ON_SUCCESS))
}

/// Registers a kind of end for robots with joints under a name.
pub fn spatial_end<P: EndPart<End: SpatialEnd>>(name: &'static str) -> Part {
    Definition::part::<P>(name, Build::End((None, Some(spatial_end_of::<P>)), P::DEPENDS_ON_SUCCESS))
}

/// Registers a kind of wrapper under a name.
pub fn wrapper<P: WrapperPart>(name: &'static str) -> Part {
    fn wrapper<P: WrapperPart>(given: &Given) -> Result<Box<dyn AnyWrapper>, Error> {
        Ok(Box::new(keys::<P>(given)?))
    }
    Definition::part::<P>(name, Build::Wrapper(wrapper::<P>))
}

/// Registers a kind of network under a name.
pub fn network<P: NetworkPart>(name: &'static str) -> Part {
    fn network<P: NetworkPart>(given: &Given) -> Result<Box<dyn AnyNetworkPart>, Error> {
        Ok(Box::new(keys::<P>(given)?))
    }
    Definition::part::<P>(name, Build::Network(network::<P>))
}

/// Registers a kind of thing under a name.
pub fn thing<P: ThingPart>(name: &'static str) -> Part {
    fn things<P: ThingPart>(given: &Given, object: &Object) -> Result<Vec<Object>, Error> {
        keys::<P>(given)?.things(object)
    }
    Definition::part::<P>(name, Build::Thing(things::<P>))
}

/// Description of robots.
const OWN: &str = "A robot of the user's program.";

/// Registers a robot on wheels under a name, for the key `kind` of `robot`.
pub fn robot_on_wheels(name: &'static str, robot: MobileRobot) -> Part {
    Definition::robot(name, OWN, Maker::Wheels(Box::new(robot)))
}

/// Registers a robot with joints under a name, for the key `kind` of `robot`.
pub fn robot_with_joints(name: &'static str, robot: Robot) -> Part {
    Definition::robot(name, OWN, Maker::Joints(Box::new(robot)))
}
