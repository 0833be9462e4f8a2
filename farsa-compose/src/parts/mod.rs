//! Parts that experiments have in any world, built from a document.

/// Controlled robots: channels, copies of one network, rewards.
pub(crate) mod agents;
/// Objectives and measures of an individual in addition to its fitness.
pub(crate) mod behaviour;
/// Conditions that are formulas.
pub(crate) mod conditions;
/// Warning about a fitness that is the same for all individuals.
pub(crate) mod constant_fitness;
/// Sensors and motors of a robot.
pub(crate) mod equipment;
/// A sensor or motor in a wrapper.
pub(crate) mod filtered;
/// Groups of equal robots, and their populations.
pub(crate) mod groups;
/// Lesions and noise of the test protocols.
pub(crate) mod interventions;
/// Terms of a trial, with success and failure.
pub(crate) mod ledger;
/// Demonstrations from CSV files.
pub(crate) mod lessons;
/// A network of any kind.
pub(crate) mod network;
/// Channels of a robot, and the network between them.
pub(crate) mod network_spec;
/// Streams of the noise of wrappers.
pub(crate) mod noise_streams;
/// A sensor or motor with its wrappers.
pub(crate) mod part;
/// Functions that drive robots instead of networks.
pub(crate) mod reflex;
/// The rule of a placement.
pub(crate) mod rule_of;
/// Parameters of a search, and those of the network.
pub(crate) mod searched;
/// Checks of sizes by the limits of a reader.
pub(crate) mod sizes;
/// Total of a term in a trial.
pub(crate) mod tally;
/// A network that learns from demonstrations.
pub(crate) mod trainee;
/// Conditions of success and failure.
pub(crate) mod wanted;
/// Registered wrappers of sensors and motors.
pub(crate) mod wrapping;
