//! The terms of the format.

use farsa_lab::advanced::Part;

use crate::part::{planar_term, spatial_term, term};

/// Angles to things.
mod angle;
/// Robots in areas.
mod areas;
/// Steps and time.
mod clock;
/// Gaps and collisions with things.
mod contact;
/// Spread and clusters of robots.
mod dispersion;
/// Distances from the start.
mod displacement;
/// Distances to things, and their decrease.
mod distance;
/// Motor values.
mod effort;
/// Exchanges of two areas.
mod exchanges;
/// Food and energy.
mod food;
/// Formulas.
mod formula;
/// Numbers of a gathering of robots.
mod gathering;
/// Attachment devices.
mod held;
/// Positions and speeds of joints.
mod joints;
/// Things within a distance.
mod near;
/// Places of things.
mod place;
/// Positions of points.
mod position;
/// Displacements of the last step.
mod progress;
/// Values of sensors.
mod sensor;
/// Speeds of robots.
mod speed;
/// Contacts.
mod touch;
/// Speeds of wheels.
mod wheels;

/// Lists them under their names.
pub(crate) fn terms() -> Vec<Part> {
    vec![
        term::<formula::Formula>("formula"),
        term::<near::Near>("near"),
        term::<distance::Distance>("distance"),
        term::<distance::Approach>("approach"),
        planar_term::<angle::Angle>("angle"),
        term::<touch::Touch>("touch"),
        term::<displacement::Displacement>("displacement"),
        term::<displacement::Moved>("moved"),
        term::<speed::Speed>("speed"),
        term::<progress::Forward>("forward"),
        term::<progress::Progress>("progress"),
        term::<position::Position>("position"),
        spatial_term::<position::Height>("height"),
        spatial_term::<position::Upright>("upright"),
        spatial_term::<joints::JointSpeed>("joint-speed"),
        spatial_term::<joints::JointPosition>("joint-position"),
        spatial_term::<joints::JointVelocity>("joint-velocity"),
        planar_term::<wheels::WheelSpeed>("wheel-speed"),
        planar_term::<wheels::WheelDifference>("wheel-difference"),
        planar_term::<wheels::StraightOn>("straight-on"),
        term::<sensor::Sensor>("sensor"),
        planar_term::<areas::InArea>("in-area"),
        planar_term::<areas::FullestArea>("fullest-area"),
        planar_term::<areas::RobotsInArea>("robots-in-area"),
        planar_term::<dispersion::Dispersion>("dispersion"),
        planar_term::<dispersion::Clusters>("clusters"),
        planar_term::<dispersion::LargestCluster>("largest-cluster"),
        planar_term::<dispersion::NearOthers>("near-others"),
        planar_term::<food::Food>("food"),
        planar_term::<food::CarriedFood>("carried-food"),
        planar_term::<food::LostFood>("lost-food"),
        planar_term::<food::Deaths>("deaths"),
        planar_term::<food::Energy>("energy"),
        planar_term::<food::Alive>("alive"),
        planar_term::<held::Held>("held"),
        term::<effort::Effort>("effort"),
        term::<effort::Control>("control"),
        term::<clock::Steps>("steps"),
        term::<clock::Step>("step"),
        term::<clock::Time>("time"),
        planar_term::<contact::Gap>("gap"),
        term::<contact::Contact>("contact"),
        planar_term::<clock::TimeLeft>("time-left"),
        planar_term::<exchanges::Exchanges>("exchanges"),
    ]
}
