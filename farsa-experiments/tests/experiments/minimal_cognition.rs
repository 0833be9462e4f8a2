//! `minimal-cognition`: its trials, its symmetry, and the network compared with one written out.

use std::path::Path;

use farsa_experiments::minimal_cognition::{
    AgentEpisode, Config, INNER, MOTORS, MinimalCognition, NEURONS, Object, RAYS, Wiring,
};
use farsa_lab::advanced::{Genotype, Value, read_genotypes};
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment as _, Note, Outcome, Settings};
use farsa_num::{Domain, Stream, logistic};
use farsa_view::Recording;
use proptest::prelude::*;

fn genes(seed: u64) -> [u16; 47] {
    let mut stream = Stream::new(seed, Domain::InitialGenome, 0, 0, 0);
    core::array::from_fn(|_| stream.below(65_536) as u16)
}

/// Networks with short memory. With larger weights the sides may diverge by themselves, and then the last bit of a sum, which
/// differs between them, decides to which side.
fn calm() -> Config {
    Config { weight_range: 1.0, ..Config::default() }
}

/// The network's parameters of these genes.
fn decoded(config: &Config, genes: &[u16]) -> Vec<f32> {
    let wiring = Wiring::new(config).unwrap();
    let genotype = Genotype::new(wiring.parameters(), MinimalCognition.gene_bits());
    wiring.expand(&genotype.decode(genes).unwrap()).unwrap()
}

fn episode(config: Config, genes: &[u16]) -> AgentEpisode {
    let parameters = decoded(&config, genes);
    AgentEpisode::new(config, parameters).unwrap()
}

fn evaluator() -> Box<dyn Evaluator> {
    let settings = Settings::new(MinimalCognition.settings("")).unwrap();
    MinimalCognition.prepare("", &settings).unwrap()
}

/// The parameters of an evaluation of these genes.
fn of_genes(evaluator: &dyn Evaluator, genes: &[u16]) -> Vec<f32> {
    Genotype::new(&evaluator.info().parameters, MinimalCognition.gene_bits()).decode(genes).unwrap()
}

/// Where the agent is after every step of a trial.
fn way(episode: &mut AgentEpisode, object: Object, offset: f64) -> Vec<f64> {
    episode.place(object, offset);
    let mut way = Vec::new();
    while !episode.ended() {
        episode.step();
        way.push(episode.places()[1]);
    }
    way
}

/// The same in double precision, layer by layer, with the rays as the episode has them.
fn written_out(config: &Config, parameters: &[f32], object: Object, offset: f64) -> Vec<f64> {
    let p: Vec<f64> = parameters.iter().map(|p| f64::from(*p)).collect();
    let (weights, rest) = p.split_at(NEURONS * NEURONS);
    let (biases, rest) = rest.split_at(NEURONS);
    let (gains, time_constants) = rest.split_at(NEURONS);
    let mut eye = AgentEpisode::new(*config, parameters.to_vec()).unwrap();
    let (mut y, mut agent, mut way) = ([0.0; NEURONS], 0.0_f64, Vec::new());
    for step in 0..config.steps() {
        // Only the difference of the places counts for the rays.
        eye.place(object, offset - agent);
        let height = config.start_height - f64::from(step) * config.speed * config.time_step;
        let free = eye.free_at(height);
        let o: [f64; NEURONS] = core::array::from_fn(|i| logistic(gains[i] * (y[i] + biases[i])));
        for i in 0..NEURONS {
            let external = if i < RAYS { config.input_gain * (1.0 - free[i] / config.ray_length) } else { 0.0 };
            let layer = match i {
                i if i < RAYS => 0..0,
                i if i < RAYS + INNER => 0..RAYS + INNER,
                _ => RAYS..RAYS + INNER,
            };
            let sum: f64 = layer.map(|j| weights[j * NEURONS + i] * o[j]).sum();
            y[i] += config.time_step / time_constants[i] * (external + sum - y[i]);
        }
        let [right, left] = [NEURONS - MOTORS, NEURONS - 1].map(|i| logistic(y[i] + biases[i]));
        agent += config.time_step * config.velocity_gain * (right - left);
        agent = agent.clamp(-0.5 * config.width, 0.5 * config.width);
        way.push(agent);
    }
    way
}

/// The largest difference of two ways up to a step.
fn apart(one: &[f64], other: &[f64]) -> f64 {
    assert_eq!(one.len(), other.len());
    one.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn a_mirrored_trial_has_the_mirrored_way(seed in any::<u64>(), offset in 0.0..50.0_f64, diamond in any::<bool>()) {
        let config = calm();
        let object = if diamond { Object::diamond(config.side) } else { Object::circle(config.diameter) };
        let mut episode = episode(config, &genes(seed));
        let right = way(&mut episode, object, offset);
        let left: Vec<f64> = way(&mut episode, object, -offset).iter().map(|x| -x).collect();
        prop_assert!(apart(&right, &left) < 1e-3, "{}", apart(&right, &left));
    }

    #[test]
    fn the_network_is_the_one_written_out(seed in any::<u64>(), offset in -50.0..50.0_f64, diamond in any::<bool>()) {
        let config = calm();
        let object = if diamond { Object::diamond(config.side) } else { Object::circle(config.diameter) };
        let mut episode = episode(config, &genes(seed));
        let found = way(&mut episode, object, offset);
        let expected = written_out(&config, episode.parameters(), object, offset);
        prop_assert!(apart(&found, &expected) < 1e-3, "{}", apart(&found, &expected));
    }
}

#[test]
fn an_agent_that_stays_earns_what_the_offset_says() {
    // Without weights both motors put out the same.
    let config = Config { weight_range: 0.1, ..Config::default() };
    let middle = decoded(&config, &[32_768; 47]);
    let still = middle.iter().enumerate().map(|(i, p)| if i < NEURONS * NEURONS { 0.0 } else { *p }).collect();
    let mut episode = AgentEpisode::new(config, still).unwrap();
    for (object, catches) in [(Object::circle(30.0), true), (Object::diamond(30.0), false)] {
        for (offset, part) in [(0.0, 0.0), (-9.0, 0.2), (36.0, 0.8), (45.0, 1.0), (50.0, 1.0)] {
            assert!(way(&mut episode, object, offset).iter().all(|x| *x == 0.0));
            let expected = if catches { 1.0 - part } else { part };
            assert!((episode.score() - expected).abs() < 1e-12, "{object:?} {offset}: {}", episode.score());
            assert_eq!((episode.steps(), episode.distance()), (817, offset.abs()));
            assert!(episode.height() <= 30.0 && episode.height() > 29.7);
        }
    }
}

#[test]
fn starts_are_spread_over_the_range_and_the_same_for_all_individuals() {
    let mut episode = episode(Config::default(), &genes(1));
    let mut sides = 0;
    for generation in 0..50 {
        for trial in 0..24 {
            let id = |individual| EpisodeId { seed: 7, generation, individual, trial };
            episode.arrange(id(3));
            let (object, [at, agent]) = (episode.object(), episode.places());
            assert_eq!(agent, 0.0);
            assert_eq!(object.name(), ["circle", "diamond"][trial as usize % 2]);
            let part = 50.0 / 12.0 * f64::from(trial / 2);
            assert!((part..part + 50.0 / 12.0).contains(&at.abs()), "{trial}: {at}");
            sides += i32::from(at > 0.0);
            episode.arrange(id(8));
            assert_eq!((episode.object(), episode.places()[0]), (object, at));
        }
    }
    assert!((450..750).contains(&sides), "{sides} of 1200 to the right");
}

/// The champion of the run in docs/results/minimal-cognition.md.
fn champion() -> Vec<u16> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/minimal-cognition.gen");
    read_genotypes(&path, 47, 16).unwrap().remove(0)
}

/// The first of the trials that are reported there.
fn trials() -> impl Iterator<Item = EpisodeId> {
    (0..960).map(|trial| EpisodeId { seed: 1 | 1 << 63, generation: trial / 24, individual: 0, trial: trial % 24 })
}

#[test]
fn the_evolved_agent_tells_circles_from_diamonds() {
    let mut evaluator = evaluator();
    let parameters = of_genes(evaluator.as_ref(), &champion());
    let evaluation = |id| Evaluation::new(&parameters, id);
    let outcomes: Vec<_> = trials().map(|id| evaluator.evaluate(evaluation(id), None)).collect();
    let (circles, diamonds): (Vec<_>, Vec<_>) = outcomes.iter().partition(|outcome| {
        outcome.notes.iter().any(|(name, note)| *name == "object" && *note == Note::from("circle"))
    });
    let mean = |of: Vec<&Outcome>| evaluator.fitness(&of.into_iter().cloned().collect::<Vec<_>>());
    let (all, circles, diamonds) = (evaluator.fitness(&outcomes), mean(circles), mean(diamonds));
    assert!(all > 0.975 && circles > 0.985 && diamonds > 0.96, "{all} {circles} {diamonds}");
}

/// A network whose sides compete may earn its fitness by rounding, which decides between them: this one does not.
#[test]
fn the_evolved_agent_does_the_same_in_double_precision() {
    let config = Config::default();
    let mut episode = episode(config, &champion());
    for id in trials() {
        episode.arrange(id);
        let (object, [at, _]) = (episode.object(), episode.places());
        let expected = written_out(&config, episode.parameters(), object, at);
        let found = way(&mut episode, object, at);
        assert!(apart(&found, &expected) < 1e-3, "{object:?} at {at}: {}", apart(&found, &expected));
    }
}

#[test]
fn a_recorded_episode_is_the_same_and_has_what_the_stage_names() {
    let mut evaluator = evaluator();
    let parameters = of_genes(evaluator.as_ref(), &genes(2));
    let id = EpisodeId { seed: 5, trial: 3, ..EpisodeId::default() };
    let evaluation = Evaluation::new(&parameters, id);
    let plain = evaluator.evaluate(evaluation, None);
    let schema = evaluator.info().schema;
    let mut recording = Recording::new(schema.clone());
    assert_eq!(evaluator.evaluate(evaluation, Some(&mut recording)), plain);
    assert_eq!((recording.times().len(), recording.times()[816]), (817, 81.7));
    let links = schema.links.iter().map(|links| (links.from[1] - links.from[0]) * (links.to[1] - links.to[0]));
    let others = schema.node_parameters.iter().map(|parameter| parameter.nodes[1] - parameter.nodes[0]);
    assert_eq!(recording.controller_parameters().len(), links.sum::<usize>() + others.sum::<usize>());
    for tick in [0, 400, 816] {
        let row: Vec<f64> = recording.row(tick).collect();
        assert_eq!(row.len(), schema.columns().len());
        assert!(row.iter().all(|x| x.is_finite()), "{row:?}");
        assert_eq!(recording.rays_at(tick).len(), RAYS);
    }
    assert!(recording.rays_at(400).iter().any(|ray| ray.met) && recording.rays_at(0).iter().all(|ray| !ray.met));
}

#[test]
fn what_does_not_go_together_is_refused_by_name() {
    let refused = |key: &str, value: Value| {
        let mut settings = Settings::new(MinimalCognition.settings("")).unwrap();
        settings.set("", key, value).unwrap();
        MinimalCognition.prepare("", &settings).err().unwrap().to_string()
    };
    let found = refused("object.end_height", Value::Number(300.0));
    assert!(found.contains("`object.end_height`") && found.contains("275"), "{found}");
    let found = refused("net.time_constants", Value::Numbers(vec![0.01, 2.0]));
    assert!(found.contains("`net.time_constants`") && found.contains("0.05"), "{found}");
    let found = refused("net.gains", Value::Numbers(vec![3.0, 2.0]));
    assert!(found.contains("`net.gains`"), "{found}");
}
