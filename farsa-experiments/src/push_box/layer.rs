//! The neural layer of the pushing robot, with its recorded channels and its test protocols.

use farsa_body::Recorder;
use farsa_body::ports::{BodyId, Handles, Kinematics};
use farsa_lab::advanced::{Intervention, Interventions};
use farsa_lab::exports::MotorExport;
use farsa_lab::{Evaluation, Task};
use farsa_view::Schema;

/// Records what was sensed and done in a step, and where bodies are after it.
///
/// No contacts: their forces are nominal.
pub(super) fn record_step<W: Kinematics + Handles<Body = BodyId> + ?Sized>(
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
pub(super) fn place_and_heading<W: Kinematics + Handles<Body = BodyId> + ?Sized>(world: &W, body: BodyId) -> [f64; 3] {
    let pose = world.pose(body);
    let [x, y, _] = pose.position.map(f64::from);
    [x, y, f64::from(pose.heading())]
}

/// The speeds \[rad/s\] that outputs ask of wheels which turn at most at `largest` \[rad/s\].
pub(super) fn wheel_speeds(y: &[f32], largest: f64) -> impl Iterator<Item = f64> {
    y.iter().map(move |y| (2.0 * f64::from(*y) - 1.0) * largest)
}

/// The protocols of a layer without hidden neurons whose sensors are these: `lesions`, of each sensor alone, and
/// `noise`.
pub(super) fn layer_protocols(schema: &Schema) -> Interventions {
    let sensors = schema.sensors.iter().enumerate().map(|(number, sensor)| (&sensor.name, number..number + 1));
    Interventions::default().with_lesions(sensors, []).with_noise(&Interventions::NOISE)
}

/// The change of such a layer in an evaluation. Protocols are made only for a case.
pub(super) fn applied(task: &impl Task, evaluation: &Evaluation<'_>) -> Intervention {
    let protocols = evaluation.case.map(|_| layer_protocols(&task.info().schema)).unwrap_or_default();
    protocols.applied(evaluation).into_owned()
}

/// The left and the right wheel with this largest speed \[rad/s\], as another program drives them.
pub(super) fn wheel_exports(largest: f64) -> Vec<MotorExport> {
    let wheel = |side: &str| {
        MotorExport::quantity(
            format!("{side} wheel"),
            format!("speed of the {side} wheel"),
            "rad/s",
            [-largest, largest],
        )
    };
    ["left", "right"].map(wheel).into()
}
