//! The parts that experiments have in any world, made of what a document names.
//!
//! - `agents`: robots as they are controlled
//! - `wiring`: channels, and the network between them
//! - `groups`: which robots are alike
//! - `ledger`: what a trial has earned
//! - `tally`: what a term has come to
//! - `meaning`: what a channel stands for
//! - `behaviour`: what there is to say of an individual beside its fitness
//! - `files`: what is made of files that a document names
//! - `wired`: a network that is wired by hand
//! - `ends`: what a network is between
//! - `searched`: which parameters of a network are searched for
//! - `network`: any network
//! - `blocks`: networks of clusters and links
//! - `interventions`: what the test protocols do to a network
//! - `bounded`: the sizes of networks
//! - `choice`: choices among points, of which one may follow another
//! - `eye`: a camera of the document as the sensor that it is
//! - `evonet`: the network of the original, with genes in its order
//! - `kept`: layouts of networks of blocks, which borrow theirs
//! - `wanted`: when a trial has succeeded
//! - `wrapping`: what is wrapped around sensors and motors alike

pub(crate) mod agents;
pub(crate) mod behaviour;
pub(crate) mod blocks;
pub(crate) mod bounded;
pub(crate) mod choice;
pub(crate) mod ends;
pub(crate) mod evonet;
pub(crate) mod eye;
pub(crate) mod files;
pub(crate) mod groups;
pub(crate) mod interventions;
pub(crate) mod kept;
pub(crate) mod ledger;
pub(crate) mod meaning;
pub(crate) mod network;
pub(crate) mod searched;
pub(crate) mod tally;
pub(crate) mod wanted;
pub(crate) mod wired;
pub(crate) mod wiring;
pub(crate) mod wrapping;
