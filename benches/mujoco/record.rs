//! The recording of phases: our own world, driven by scripts whose commands are recorded.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use farsa::body::ports::{Arrange, Motor as _, World as _};
use farsa::body::robots::{ArmAndHand, Tabletop};
use farsa::body::{Pose, Twist};
use farsa::num::{Domain, Stream, sin_cos};
use farsa_experiments::reach_grasp_lift::{Scene, ScriptEpisode, Statics, Timetable};
use farsa_lab::{Episode, EpisodeId};

use crate::drive::{Press, Sink, hold};
use crate::phase::{Failure, MUSCLES, Phase, STEPS, WORDS, command, world};

/// The script of the experiment from its first start: reaching, and later holding.
fn scripted(scene: &Arc<Scene>) -> Result<[Phase; 2], Failure> {
    let mut world = world::<f32>(scene, scene.config.substeps, true)?;
    let mut script = ScriptEpisode::new(Arc::clone(scene), Timetable::default())?;
    let motors = scene.motors()?;
    script.start(&mut world, EpisodeId::default());
    let mut phases = [Phase::at(&world), Phase::at(&world)];
    // Lifted since 4.4 s.
    let lifted = 600 - 150;
    for tick in 0..600 {
        if tick == lifted {
            phases[1] = Phase::at(&world);
        }
        script.act(&mut world);
        let mut sink = Sink::default();
        motors.clone().drive(script.done(), &mut sink);
        if tick < STEPS {
            phases[0].commands.push(sink.words());
        } else if tick >= lifted {
            phases[1].commands.push(sink.words());
        }
        world.step();
        Episode::judge(&mut script, &mut world);
    }
    if script.judge().succeeds() { Ok(phases) } else { Err("the script does not hold the sphere".into()) }
}

/// The open hand on the table, pressed down with 4 to 16 N once a second, the sphere far away.
fn on_table(scene: &Scene) -> Result<Phase, Failure> {
    let statics = Statics::new(scene)?;
    let wanted = statics.above([0.24, -0.18], 0.02)?;
    let mut world = world::<f32>(scene, scene.config.substeps, true)?;
    for (joint, q) in ArmAndHand::joints().into_iter().zip(&wanted) {
        world.place_joint(joint, *q as f32, 0.0);
    }
    let at = [0.35, 0.15, scene.config.sphere_radius as f32];
    world.place_body(Tabletop::SPHERE, Pose::at(at), Twist::default());
    world.finish_placement();
    let mut phase = Phase::at(&world);
    let settle = 200;
    for tick in 0..settle + STEPS {
        if tick == settle {
            phase = Phase::at(&world);
        }
        let force = 10.0 + 6.0 * sin_cos(core::f64::consts::TAU * 0.01 * tick as f64).0;
        let press = Press { body: ArmAndHand::PALM, point: scene.arm.palm_centre, force };
        let words = hold(&statics, &world, &wanted, &press);
        if tick >= settle {
            phase.commands.push(words);
        }
        command(&mut world, &words);
        world.step();
    }
    Ok(phase)
}

/// Quick motion: every muscle follows a separate sine between 0.5 and 2 Hz, and nothing touches.
fn waves(scene: &Scene) -> Result<Phase, Failure> {
    let mut world = world::<f32>(scene, scene.config.substeps, false)?;
    scene.arrange(&mut world, EpisodeId::default());
    let mut phase = Phase { contacts: false, ..Phase::at(&world) };
    let mut stream = Stream::new(1, Domain::Motor, 0, 0, 0);
    let waves: [[f64; 2]; 2 * MUSCLES] =
        core::array::from_fn(|_| [0.5 + 1.5 * stream.uniform_f64(), stream.uniform_f64()]);
    for step in 0..STEPS {
        let mut words = [0.0; WORDS];
        for (word, [hertz, shift]) in words.iter_mut().zip(waves) {
            let turns = hertz * 0.01 * step as f64 + shift;
            *word = (0.5 + 0.4 * sin_cos(core::f64::consts::TAU * turns).0) as f32;
        }
        phase.commands.push(words);
    }
    Ok(phase)
}

/// Writes every phase as a file.
pub(crate) fn record(scene: &Arc<Scene>, folder: &Path) -> Result<(), Failure> {
    let [free, grasp] = scripted(scene)?;
    let phases = [("free", free), ("waves", waves(scene)?), ("table", on_table(scene)?), ("grasp", grasp)];
    for (name, phase) in phases {
        fs::write(folder.join(format!("{name}.txt")), phase.text(scene))?;
    }
    Ok(())
}
