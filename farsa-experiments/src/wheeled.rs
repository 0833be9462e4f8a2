//! What is recorded of wheeled robots in every experiment alike.

use farsa_body::{BodyId, Handles, Kinematics, Recorder};

/// Records what was sensed and done in a step, and where bodies are after it.
///
/// No contacts: their forces are nominal.
pub(crate) fn record_step<W: Kinematics + Handles<Body = BodyId> + ?Sized>(
    world: &W,
    x: &[f32],
    y: &[f32],
    bodies: impl IntoIterator<Item = BodyId>,
    recorder: &mut dyn Recorder,
) {
    recorder.sensors(x);
    recorder.outputs(y);
    bodies.into_iter().for_each(|body| recorder.pose(body, world.pose(body)));
}

/// Where a body is and where it points to: x, y \[m\] and heading \[rad\].
pub(crate) fn place_and_heading<W: Kinematics + Handles<Body = BodyId> + ?Sized>(world: &W, body: BodyId) -> [f64; 3] {
    let pose = world.pose(body);
    let [x, y, _] = pose.position.map(f64::from);
    [x, y, f64::from(pose.heading())]
}

/// The speeds \[rad/s\] that outputs ask of wheels which turn at most at `largest` \[rad/s\].
pub(crate) fn wheel_speeds(y: &[f32], largest: f64) -> impl Iterator<Item = f64> {
    y.iter().map(move |y| (2.0 * f64::from(*y) - 1.0) * largest)
}
