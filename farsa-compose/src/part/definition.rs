//! Definitions of parts by name and kind.

use farsa_body::robot::Robot;
use farsa_body::robots::MobileRobot;
use farsa_lab::Error;
use farsa_lab::advanced::Part;
use schemars::Schema;
use schemars::generate::SchemaSettings;
use serde_json::{Map, Value};

use crate::document::Object;
use crate::part::keys::Keys;
use crate::part::motor::AnyMotor;
use crate::part::network::AnyNetworkPart;
use crate::part::object::{
    PlanarEnd, PlanarMotor, PlanarSensor, PlanarStart, PlanarTerm, SpatialEnd, SpatialMotor, SpatialSensor,
    SpatialStart, SpatialTerm,
};
use crate::part::scene::PartScene;
use crate::part::sensor::AnySensor;
use crate::part::start::AnyStart;
use crate::part::term::AnyTerm;
use crate::part::wrapper::AnyWrapper;

/// Keys of a part, as the file has them.
pub(crate) type Given = Map<String, Value>;
/// Reads a part from its keys.
type Reading<T> = fn(&Given) -> Result<Box<T>, Error>;
/// Builds a part from its keys and further arguments.
type Composing = fn(&Given, &Object) -> Result<Vec<Object>, Error>;

/// A part under its name.
#[derive(Clone, Debug)]
pub(crate) struct Definition {
    pub(crate) name: &'static str,
    /// Description of a robot. Other parts have one in their schema.
    pub(crate) about: &'static str,
    /// Generates the schema of the keys.
    pub(crate) schema: fn() -> Schema,
    /// Adds the defaults of keys.
    pub(crate) complete: fn(&Given) -> Result<Given, String>,
    pub(crate) build: Build,
}

/// Builds a part from its keys.
type Building<T> = fn(&Given, &PartScene<'_>) -> Result<T, Error>;
/// Builds a part for robots on wheels and for robots with joints, if it is for them.
type InWorlds<P, S> = (Option<Building<Box<P>>>, Option<Building<Box<S>>>);

/// Functions that build a part, by its kind.
#[derive(Clone, Debug)]
pub(crate) enum Build {
    Sensor(InWorlds<dyn PlanarSensor, dyn SpatialSensor>, Reading<dyn AnySensor>),
    Motor(InWorlds<dyn PlanarMotor, dyn SpatialMotor>, Reading<dyn AnyMotor>),
    Term(InWorlds<dyn PlanarTerm, dyn SpatialTerm>, Reading<dyn AnyTerm>),
    Start(InWorlds<dyn PlanarStart, dyn SpatialStart>, Reading<dyn AnyStart>),
    /// An end of a trial, true if it depends on success.
    End(InWorlds<dyn PlanarEnd, dyn SpatialEnd>, bool),
    Wrapper(Reading<dyn AnyWrapper>),
    Network(Reading<dyn AnyNetworkPart>),
    Thing(Composing),
    Robot(Maker),
}

/// Where a robot comes from.
#[derive(Clone, Debug)]
pub(crate) enum Maker {
    Wheels(Box<MobileRobot>),
    Joints(Box<Robot>),
    /// A robot with joints from a file.
    File,
}

impl Definition {
    /// Defines a part with the keys of `K`.
    pub(crate) fn part<K: Keys>(name: &'static str, build: Build) -> Part {
        Part::new(Self { name, about: "", schema: schema::<K>, complete: complete::<K>, build })
    }

    /// Defines a robot, which has no further keys.
    pub(crate) fn robot(name: &'static str, about: &'static str, maker: Maker) -> Part {
        let (schema, complete) = (|| Schema::default(), |keys: &Given| Ok(keys.clone()));
        Part::new(Self { name, about, schema, complete, build: Build::Robot(maker) })
    }
}

fn schema<K: Keys>() -> Schema {
    SchemaSettings::draft2020_12().into_generator().into_root_schema_for::<K>()
}

/// Reads the keys of a part.
pub(crate) fn keys<K: Keys>(keys: &Given) -> Result<K, Error> {
    serde_json::from_value(Value::Object(keys.clone())).map_err(|error| Error::Other(error.to_string()))
}

fn complete<K: Keys>(given: &Given) -> Result<Given, String> {
    let typed: K = keys(given).map_err(|error| error.to_string())?;
    match serde_json::to_value(typed) {
        Ok(Value::Object(map)) => Ok(map),
        Ok(Value::Null) => Ok(Map::new()),
        Ok(_) => Err("has settings that are no struct with named fields".into()),
        Err(error) => Err(error.to_string()),
    }
}
