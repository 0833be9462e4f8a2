//! Checks for worlds with external forces.

use alloc::format;

use crate::ports::{Actuated, Contacts, ExternalForces, Joints, Kinematics, Snapshot, World};
use crate::testing::probe::Probe;
use crate::testing::promise::{ConformanceError, Promise, ensure};
use crate::testing::trace::{Instant, parting, saved, trace};

/// Checks the port [`ExternalForces`] of a world. The closure `make` must always create the same world.
///
/// A force on one of the bodies in `pushed`, upwards and to the side, must accelerate the body in this direction during
/// the next step only. Several forces on a body are added. A zero force must
/// not change any bit, and neither must a force on `missing`, a body that does not exist. A world that was restored has
/// no pending forces.
///
/// # Errors
/// Returns the first promise violated.
pub fn check_external_forces<W>(
    make: impl Fn() -> W,
    probe: &Probe<W::Body, W::Joint, W::Actuator>,
    pushed: &[W::Body],
    missing: W::Body,
) -> Result<(), ConformanceError>
where
    W: World + Joints + Kinematics + Actuated + Contacts + Snapshot + ExternalForces,
    W::Body: PartialEq,
{
    let broken = |detail| Err(ConformanceError { promise: Promise::ForceActs, detail });
    let force = [0.25, 0.125, 0.5];
    // The world one step later, after `apply`, and its reports in the following steps.
    let after = |apply: &dyn Fn(&mut W)| {
        let mut world = make();
        apply(&mut world);
        world.step();
        (Instant::from_world(&world, probe), world)
    };
    let (plain, still) = after(&|_| ());
    for (index, &body) in pushed.iter().enumerate() {
        let at = make().origin(body);
        let (pushed, world) = after(&|world| world.apply_force(body, at, force));
        let [now, before] = [&world, &still].map(|world| world.velocity(body).linear);
        let change: f32 = (0..3).map(|k| force[k] * (now[k] - before[k])).sum();
        ensure(change > 0.0, Promise::ForceActs, || {
            format!("body {index}: pushed, it moves from {before:?} to {now:?}")
        })?;
        // Half of it twice is the whole: both are exact in binary.
        let half = force.map(|x| 0.5 * x);
        let (twice, _) = after(&|world| (0..2).for_each(|_| world.apply_force(body, at, half)));
        if let Some(detail) = pushed.difference(&twice) {
            return broken(format!("body {index}: two halves of a force are not the whole: {detail}"));
        }
        // Later steps equal those of a world in the same state without a push.
        let (mut world, mut restored) = (world, make());
        let state = saved(&world);
        world.restore(&state);
        let (_, mut pushed) = after(&|world| world.apply_force(body, at, force));
        restored.apply_force(body, at, force);
        restored.restore(&state);
        let [a, b, c] = [&mut world, &mut pushed, &mut restored].map(|world| trace(world, probe, 1..4, false));
        for other in [b, c] {
            if let Some(detail) = parting(&a, &other) {
                return broken(format!("body {index}: a force lasts longer than a step: {detail}"));
            }
        }
    }
    for (what, body) in
        probe.bodies.iter().map(|body| ("no force", *body)).chain([("a body that does not exist", missing)])
    {
        let push = if body == missing { force } else { [0.0; 3] };
        let (other, _) = after(&|world| world.apply_force(body, [0.1, 0.2, 0.3], push));
        if let Some(detail) = plain.difference(&other) {
            return broken(format!("{what} changes what happens: {detail}"));
        }
    }
    Ok(())
}
