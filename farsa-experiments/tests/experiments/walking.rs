//! Walkers: their energy, what counts as a step, the walking model's gait in a rigid body, and evolved bodies.

#[cfg(feature = "rapier")]
use farsa_body::ports::Contacts as _;
use farsa_body::ports::{Arrange as _, Joints as _, World as _};
use farsa_experiments::walking::body_evolution::BodyEvolution;
#[cfg(feature = "rapier")]
use farsa_experiments::walking::passive_walker::Pace;
use farsa_experiments::walking::passive_walker::PassiveWalker;
use farsa_experiments::walking::passive_walker::{
    Config, End, Gait, Launch, Legs, Posture, Rules, Walk, Walker, WalkerEpisode, WalkerParts,
};
use farsa_lab::advanced::{Genotype, Value, run_episode, run_in_lanes};
use farsa_lab::{Episode, EpisodeId, Error, Evaluation, Evaluator, Experiment, Outcome, Settings};
use farsa_num::{Domain, Instructions, Stream};
use farsa_physics::articulated::{Batch, Model, World};

/// Two different pairs of legs.
fn uneven() -> Walker {
    let legs = [
        Legs { length: 0.8, mass: 1.5, foot_mass: 0.4, foot_radius: 0.12 },
        Legs { length: 0.85, mass: 0.9, foot_mass: 0.7, foot_radius: 0.2 },
    ];
    Walker { legs, hip_mass: 6.0, stiffness: 5e4, damping_ratio: 3.0, ..Walker::default() }
}

fn config(walker: Walker, slope: f64) -> Config {
    Config { substeps: 4, walk: Walk { slope, ..Config::default().walk }, walker, ..Config::default() }
}

fn posture(seed: u64) -> Posture {
    let mut stream = Stream::new(seed, Domain::Start, 0, 0, 0);
    let mut two = |size: f64| [0, 1].map(|_| stream.range_f64(-size, size));
    Posture { hip: two(3.0), velocity: two(2.0), angles: two(0.7), rates: two(4.0) }
}

#[test]
fn energy_is_that_of_the_world() {
    let config = config(uneven(), 0.05);
    let (model, parts) = config.model::<f64>().unwrap();
    let gravity = Walker::gravity(9.81, 0.05);
    let mut world = World::new(model);
    for seed in 0..50 {
        posture(seed).place(&mut world, &parts);
        world.finish_placement();
        let [kinetic, potential] = world.energy();
        let found = config.walker.energy(&Posture::from_world(&world, &parts), gravity);
        // The ports speak f32.
        let bound = 1e-5 * (kinetic.abs() + potential.abs());
        assert!((found - kinetic - potential).abs() < bound, "{seed}: {found} {kinetic} {potential}");
    }
}

#[test]
fn the_foot_of_a_standing_posture_rests_on_the_ground() {
    let walker = uneven();
    let (robot, parts) = walker.robot();
    let mut world = World::new(Model::<f64>::new(&robot, &farsa_physics::articulated::Options::default()).unwrap());
    for stance in [0, 1] {
        let posture = Posture::standing(&walker, stance, [0.3, -0.2], [-0.9, 0.4]);
        posture.place(&mut world, &parts);
        world.finish_placement();
        let legs = walker.legs[stance];
        let pose = world.pose_of(parts.legs[stance]);
        let centre = pose.transform([0.0, 0.0, legs.foot_radius - legs.length]);
        assert!((centre[2] - legs.foot_radius).abs() < 1e-6 && centre[0].abs() < 1e-6, "{centre:?}");
        let twist = world.velocity_of(parts.legs[stance]);
        let arm = [0, 1, 2].map(|k: usize| [centre[0], 0.0, 0.0][k] - pose.position[k]);
        let [_, turn, _] = twist.angular;
        let at_rest = [twist.linear[0] + turn * arm[2], twist.linear[2] - turn * arm[0]];
        assert!(at_rest.iter().all(|v| v.abs() < 1e-6), "{at_rest:?}");
        // And the walking model's angle leans the leg back: the hip is behind the foot and goes ahead.
        assert!(posture.hip[0] < 0.0 && posture.velocity[0] > 0.0);
    }
}

/// A walker let go: how it ends, and how many steps it has made.
fn walk(config: &Config, launch: Launch, ticks: u32) -> (Option<End>, u32, f64) {
    let (model, parts) = config.model::<f32>().unwrap();
    let mut world = World::new(model);
    let mut episode = WalkerEpisode::new(config.walker, parts, Walk { steps: ticks, ..config.walk }, launch, None);
    let fitness = run_episode(&mut episode, &mut world, EpisodeId::default(), None);
    (episode.gait().end(), episode.gait().steps(), fitness)
}

#[test]
fn falling_sliding_and_rolling_are_no_steps() {
    let fall = config(uneven(), 0.03);
    let still = Launch { angles: [0.3, -0.3], rates: [0.0; 2] };
    assert_eq!(walk(&fall, still, 5000), (Some(End::Fell), 0, 0.0));
    // A push on ice: the stance foot leaves its place.
    let mut ice = fall;
    ice.walker.friction = 0.0;
    let push = Launch { angles: [0.2, -0.2], rates: [-1.5, 0.0] };
    let (end, steps, _) = walk(&ice, push, 5000);
    assert_eq!((end, steps), (Some(End::Slid), 0));
    // Both legs side by side on soles as long as the legs: a wheel, which rolls and never steps.
    let mut wheel = config(Walker::default(), 0.03);
    wheel.walker = Walker { stiffness: 5e4, damping_ratio: 3.0, ..wheel.walker };
    for legs in &mut wheel.walker.legs {
        *legs = Legs { length: 0.5, mass: 1.0, foot_mass: 1.0, foot_radius: 0.499 };
    }
    let (_, steps, fitness) = walk(&wheel, Launch { angles: [0.0; 2], rates: [-1.0; 2] }, 500);
    assert_eq!((steps, fitness), (0, 0.0));
}

#[test]
fn lost_numbers_break_a_walk() {
    let config = config(uneven(), 0.03);
    let (model, parts) = config.model::<f32>().unwrap();
    let mut world = World::new(model);
    let mut gait = Gait::new(config.walker, parts, Rules::default(), Walker::gravity(9.81, 0.03), 0.002);
    gait.start(&mut world, 0, &Posture::standing(&config.walker, 0, [0.2, -0.2], [-0.8, 0.0]));
    world.place_joint(parts.hinges[0], f32::NAN, 0.0);
    world.finish_placement();
    world.step();
    assert_eq!(gait.judge(&mut world, 0.0), Some(End::Broken));
}

#[test]
fn a_kick_is_energy_from_nowhere_and_a_motor_pays_for_its_own() {
    let config = config(uneven(), 0.03);
    let (model, parts) = config.model::<f32>().unwrap();
    let start = Posture::standing(&config.walker, 0, [0.2, -0.2], [-0.8, 0.0]);
    for (work, end) in [(0.0, Some(End::Gained)), (100.0, None)] {
        let mut world = World::new(model.clone());
        let mut gait = Gait::new(config.walker, parts, Rules::default(), Walker::gravity(9.81, 0.03), 0.002);
        gait.start(&mut world, 0, &start);
        world.step();
        assert_eq!(gait.judge(&mut world, 0.0), None);
        let angle = world.position(parts.hinges[1]);
        world.place_joint(parts.hinges[1], angle, 6.0);
        world.finish_placement();
        world.step();
        assert_eq!(gait.judge(&mut world, work), end, "{work}");
    }
}

/// Feet of a thousandth of the hip's mass in units of legs, hips and gravity.
fn light() -> Config {
    let stiffness = 3e4;
    let legs = Legs { length: 1.0, mass: 0.0, foot_mass: 1e-3, foot_radius: 1e-5 };
    let rules = Rules { settling: 0.06, ..Rules::default() };
    Config {
        substeps: 1,
        walk: Walk { gravity: 1.0, time_step: 1.5e-4, steps: u32::MAX, noise: 0.0, rules, ..Config::default().walk },
        walker: Walker {
            legs: [legs; 2],
            hip_mass: 1.0,
            friction: 2.0,
            stiffness,
            damping_ratio: 10.0,
            ..Walker::default()
        },
        ..Config::default()
    }
}

/// `examples/walking.rs` makes the whole table. Here is one row, with soft ground and few steps.
#[test]
fn a_rigid_body_with_light_feet_walks_as_the_model() {
    let config = light();
    let model = config.gait().unwrap();
    let (world, parts) = config.model::<f64>().unwrap();
    let mut world = World::new(world);
    let mut episode = WalkerEpisode::new(config.walker, parts, config.walk, config.launch(&model), None);
    episode.start(&mut world, EpisodeId::default());
    let mut energies = Vec::new();
    while episode.gait().steps() < 13 {
        let steps = episode.gait().steps();
        world.step();
        assert_eq!(episode.judge(&mut world), None);
        if episode.gait().steps() > steps {
            energies.push(episode.gait().energies()[1]);
        }
    }
    let pace = episode.pace().unwrap();
    for (found, known) in [(pace.angle, model.angle), (pace.rate, model.rate), (pace.period, model.period)] {
        println!("{found} where the model has {known}");
        assert!((found / known - 1.0).abs() < 0.01, "{found} where the model has {known}");
    }
    // Footfalls take what the slope gives, and nothing gives more.
    assert!(energies.windows(2).all(|pair| pair[1] < pair[0]), "{energies:?}");
    let a_step = (energies[12] - energies[2]) / 10.0;
    let fall = pace.length * 0.009;
    assert!((a_step / -fall - 1.0).abs() < 0.02, "{a_step} {fall}");
}

/// An episode and the number of its trial.
struct Numbered(WalkerEpisode, u32);

impl<W> Episode<W> for Numbered
where
    WalkerEpisode: Episode<W>,
{
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.0.start(world, id);
    }
    fn act(&mut self, world: &mut W) {
        self.0.act(world);
    }
    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.0.judge(world)
    }
}

#[test]
fn walks_in_lanes_are_those_alone() {
    let mut config = config(uneven(), 0.03);
    config.walker.legs[1].length = 0.8;
    config.walk = Walk { steps: 800, noise: 0.3, ..config.walk };
    let launch = Launch { angles: [0.3, -0.3], rates: [-1.2, 0.0] };
    let (model, parts): (Model<f32>, WalkerParts) = config.model().unwrap();
    let episode = || WalkerEpisode::new(config.walker, parts, config.walk, launch, None);
    let id = |trial| EpisodeId { seed: 4, trial, ..EpisodeId::default() };
    let mut world = World::new(model.clone());
    let mut one = episode();
    let mut steps = 0;
    let alone: Vec<u64> = (0..20)
        .map(|trial| {
            let fitness = run_episode(&mut one, &mut world, id(trial), None);
            steps += one.gait().steps();
            fitness.to_bits()
        })
        .collect();
    assert!(steps > 10, "{steps} steps in all: feet should change places");
    let mut batch = Batch::new(model, 8, Instructions::detect()).unwrap();
    let mut episodes: Vec<Numbered> = (0..8).map(|_| Numbered(episode(), 0)).collect();
    let (mut next, mut found) = (0..20, vec![0; 20]);
    run_in_lanes(
        &mut episodes,
        &mut batch,
        |episode| {
            episode.1 = next.next()?;
            Some(id(episode.1))
        },
        |episode, fitness| found[episode.1 as usize] = fitness.to_bits(),
    );
    assert_eq!(found, alone);
}

fn prepared(
    experiment: &dyn Experiment,
    condition: &str,
    changes: &[(&str, Value)],
) -> Result<Box<dyn Evaluator>, Error> {
    let mut settings = Settings::new(experiment.settings(condition))?;
    for (key, value) in changes {
        settings.set("", key, value.clone())?;
    }
    experiment.prepare(condition, &settings)
}

#[test]
fn settings_that_do_not_go_together_are_refused_by_name() {
    let refused = |experiment: &dyn Experiment, key: &str, value: Value| {
        let error = prepared(experiment, experiment.conditions().first().unwrap_or(&""), &[(key, value)]);
        let error = error.err().unwrap().to_string();
        assert!(error.contains(key), "{key}: {error}");
    };
    refused(&PassiveWalker, "walker.foot_radius", Value::Number(2.0));
    refused(&BodyEvolution, "body.hip_mass", Value::Numbers(vec![3.0, 2.0]));
    refused(&BodyEvolution, "body.foot_radius", Value::Numbers(vec![0.1, 0.7]));
}

/// Trials of an evolved genome that no run has met.
fn trials(condition: &str, genes: &[u16]) -> Vec<Outcome> {
    let mut evaluator = prepared(&BodyEvolution, condition, &[]).unwrap();
    let parameters = Genotype::new(&evaluator.info().parameters, BodyEvolution.gene_bits()).decode(genes).unwrap();
    let id = |trial| EpisodeId { seed: 1 << 63, trial, ..EpisodeId::default() };
    let evaluation = |trial| Evaluation::new(&parameters, id(trial));
    (0..3).map(|trial| evaluator.evaluate(evaluation(trial), None)).collect()
}

#[test]
fn an_evolved_body_walks_ten_strides() {
    // The champion of generation 19 of seed 3 under the defaults.
    let genes = [49937, 32864, 34696, 8459, 1308, 65110, 12809, 23179, 35268, 61171];
    for outcome in trials("passive", &genes) {
        assert!(outcome.success && outcome.terms[0] > 15.0, "{outcome:?}");
    }
    // Legs of other lengths and a weak push: the same genes with two changed fall.
    let mut other = genes;
    (other[1], other[8]) = (0, 65535);
    assert!(trials("passive", &other).iter().all(|outcome| !outcome.success));
}

/// In rapier: how long neither foot was on the ground in the first footfall's tenth of a second \[s\], and the pace after some steps.
#[cfg(feature = "rapier")]
fn walk_in_rapier(speed_sweeps: u32, steps: u32) -> (f64, Option<Pace>) {
    let plain = Config::default();
    let config = Config { substeps: 1, walk: Walk { time_step: 5e-4, noise: 0.0, ..plain.walk }, ..plain };
    let (robot, parts) = config.walker.robot();
    let options = farsa_physics::rapier::Options { speed_sweeps, ..config.rapier_options() };
    let mut world = farsa_physics::rapier::World::new(&robot, &options).unwrap();
    let launch = config.launch(&config.gait().unwrap());
    let mut episode = WalkerEpisode::new(config.walker, parts, Walk { steps: u32::MAX, ..config.walk }, launch, None);
    episode.start(&mut world, EpisodeId::default());
    let (mut flown, mut since) = (0.0, 0);
    while since < 200 || episode.gait().steps() < steps {
        world.step();
        if episode.judge(&mut world).is_some() {
            break;
        }
        since += u32::from(episode.gait().steps() > 0);
        if since > 0 && since < 200 && parts.soles.iter().all(|sole| !world.touches(*sole)) {
            flown += config.walk.time_step;
        }
    }
    (flown, episode.pace())
}

/// One sweep for speeds, each step's begun with the last step's impulses, make a spring of a leg's normal force and friction.
#[cfg(feature = "rapier")]
#[test]
fn a_footfall_in_rapier_is_a_blow_and_no_spring() {
    let enough = Config::default().rapier_options().speed_sweeps;
    let [few, enough] = [1, enough].map(|sweeps| walk_in_rapier(sweeps, 1).0);
    assert!(few > 0.02 && enough == 0.0, "off the ground for {few} s, {enough} s");
}

#[cfg(feature = "rapier")]
#[test]
fn the_walker_walks_in_rapier_as_the_model() {
    let config = Config::default();
    let (_, pace) = walk_in_rapier(config.rapier_options().speed_sweeps, 12);
    let (pace, model) = (pace.unwrap(), config.gait().unwrap());
    let unit = (config.walker.legs[0].length / config.walk.gravity).sqrt();
    for (found, known) in
        [(pace.angle, model.angle), (pace.rate * unit, model.rate), (pace.period / unit, model.period)]
    {
        println!("{found} where the model has {known}");
        assert!((found / known - 1.0).abs() < 0.03, "{found} where the model has {known}");
    }
}
