//! Changes of controllers by name, in every experiment that has a controller.

use farsa_body::Recorder;
use farsa_lab::advanced::{Anatomy, CaseId, Genotype, Intervention, Lanes, Value};
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment, Outcome, Settings};
use farsa_num::{Domain, Instructions, Stream};
use farsa_view::Schema;

const ID: EpisodeId = EpisodeId { seed: 1 << 63 | 5, generation: 1, individual: 0, trial: 0 };

/// The recording of an episode.
#[derive(Default, PartialEq, Debug)]
struct Seen {
    parameters: Vec<f32>,
    sensors: Vec<Vec<f32>>,
    neurons: Vec<Vec<f32>>,
    outputs: Vec<Vec<f32>>,
}

impl Recorder for Seen {
    fn parameters(&mut self, values: &[f32]) {
        self.parameters = values.into();
    }
    fn sensors(&mut self, values: &[f32]) {
        self.sensors.push(values.into());
    }
    fn neurons(&mut self, values: &[f32]) {
        self.neurons.push(values.into());
    }
    fn outputs(&mut self, values: &[f32]) {
        self.outputs.push(values.into());
    }
    fn tick(&mut self, _: f64) {}
}

/// An experiment's evaluator, with its parts by name.
struct Subject {
    name: &'static str,
    evaluator: Box<dyn Evaluator>,
    parameters: Vec<f32>,
    schema: Schema,
    anatomy: Anatomy,
}

impl Subject {
    /// An experiment under its first condition, in short trials, or `None` without a controller.
    fn new(experiment: &dyn Experiment) -> Option<Self> {
        let condition = experiment.conditions().first().copied().unwrap_or_default();
        let mut settings = Settings::new(experiment.settings(condition)).unwrap();
        // Not all have so short trials.
        let _ = settings.set("", "trial.steps", Value::Whole(25));
        let evaluator = experiment.prepare(condition, &settings).unwrap();
        let anatomy = evaluator.info().anatomy?;
        // The wires of vehicles and the links of layers have no names that tests can change.
        if ["braitenberg", "ant-omni"].contains(&experiment.name()) {
            return None;
        }
        let mut stream = Stream::new(6, Domain::InitialGenome, 0, 0, 0);
        let genotype = Genotype::new(&evaluator.info().parameters, 16);
        // In the middle of their ranges, where neurons are not saturated.
        let genes = evaluator.info().parameters.into_iter().map(|_| (24_576 + stream.below(16_384)) as u16);
        let genes: Vec<u16> = genes.collect();
        let (parameters, schema) = (genotype.decode(&genes).unwrap(), evaluator.info().schema);
        Some(Self { name: experiment.name(), evaluator, parameters, schema, anatomy })
    }

    /// The result of these changes.
    fn with(&mut self, list: &str) -> (Outcome, Seen) {
        let (change, mut seen) = (self.change(list), Seen::default());
        let evaluation = Evaluation { intervention: Some(&change), ..Evaluation::new(&self.parameters, ID) };
        let outcome = self.evaluator.evaluate(evaluation, Some(&mut seen));
        assert!(outcome.steps > 0 && !seen.sensors.is_empty(), "{}: {list}: {outcome:?}", self.name);
        (outcome, seen)
    }

    fn change(&self, list: &str) -> Intervention {
        if list.is_empty() { Intervention::default() } else { self.anatomy.intervention(list).unwrap() }
    }

    /// A node by its number in the schema, as a list names it.
    fn node(&self, number: usize) -> String {
        let (sensors, neurons) = (self.schema.sensors.len(), self.schema.neurons.len());
        match number.checked_sub(sensors) {
            None => format!("sensor {}", self.schema.sensors[number].name),
            Some(neuron) if neuron < neurons => format!("neuron {}", self.schema.neurons[neuron].name),
            Some(output) => format!("output {}", self.schema.outputs[output - neurons].name),
        }
    }
}

fn subjects() -> Vec<Subject> {
    let all: Vec<Subject> = farsa_experiments::all().into_iter().filter_map(Subject::new).collect();
    let names: Vec<&str> = all.iter().map(|subject| subject.name).collect();
    assert_eq!(
        names,
        [
            "reach-grasp-lift",
            "compositional-instructions",
            "icub-reach",
            "icub-reach-grasp",
            "kinesthetic-grasp",
            "discrimination",
            "discrimination-cylinders",
            "minimal-cognition",
            "double-pole",
            "foraging",
            "aggregation",
            "predator-prey",
            "push-box",
            "hopper",
            "walker2d",
            "half-cheetah",
            "ant",
            "humanoid",
            "go1-joystick",
            "g1-walk",
        ]
    );
    all
}

#[test]
fn a_parameter_that_is_named_is_the_one_that_changes() {
    for mut subject in subjects() {
        let name = subject.name;
        let (_, intact) = subject.with("");
        assert!(!subject.schema.links.is_empty(), "{name}");
        let mut wanted = Vec::new();
        for links in subject.schema.links.clone() {
            let (sources, targets) = (links.from[1] - links.from[0], links.to[1] - links.to[0]);
            for [from, to] in [[0, 0], [0, targets - 1], [sources - 1, 0], [sources / 2, targets / 2]] {
                let [source, target] = [links.from[0] + from, links.to[0] + to].map(|node| subject.node(node));
                wanted.push((format!("link:{source}-{target}=0.375"), links.first + from * targets + to));
            }
        }
        for parameters in subject.schema.node_parameters.clone() {
            let [first, end] = parameters.nodes;
            for node in [first, end - 1] {
                let change = format!("{}:{}=0.375", parameters.name, subject.node(node));
                wanted.push((change, parameters.first + node - first));
            }
        }
        for (change, index) in wanted {
            let (_, seen) = subject.with(&change);
            let mut expected = intact.parameters.clone();
            expected[index] = 0.375;
            assert_eq!(seen.parameters, expected, "{name}: {change}");
        }
    }
}

#[test]
fn neurons_and_outputs_are_held() {
    for mut subject in subjects() {
        let name = subject.name;
        let (neurons, outputs) = (subject.schema.neurons.len(), subject.schema.outputs.len());
        for neuron in 0..neurons {
            let of = subject.schema.neurons[neuron].name.clone();
            let (_, seen) = subject.with(&format!("neuron:{of}=0.625"));
            assert!(seen.neurons.iter().all(|states| states[neuron] == 0.625), "{name}: {of}");
        }
        for output in 0..outputs {
            let of = subject.schema.outputs[output].name.clone();
            let (_, seen) = subject.with(&format!("output:{of}=0.625"));
            assert!(seen.outputs.iter().all(|values| values[output] == 0.625), "{name}: {of}");
        }
    }
}

#[test]
fn what_is_not_heard_changes_the_course_and_lanes_do_not() {
    for mut subject in subjects() {
        let name = subject.name;
        let group = subject.evaluator.info().description.sensors[0].name.clone();
        let (_, intact) = subject.with("");
        // All inputs at another value than they have: some answer differs.
        let held: Vec<String> = subject.schema.sensors.iter().map(|s| format!("sensor:{}=0.8125", s.name)).collect();
        let (_, deaf) = subject.with(&held.join(","));
        assert!(deaf.outputs != intact.outputs, "{name}");
        // With inputs held, noise that comes before changes nothing.
        assert!(subject.with(&format!("noise:0.5,{}", held.join(","))).1 == deaf, "{name}");
        assert!(subject.with("noise:0.5").1.outputs != intact.outputs, "{name}");

        let last = subject.schema.outputs.last().unwrap().name.clone();
        let changes = [String::new(), format!("sensor:{group}"), "noise:0.25".into(), format!("output:{last}=0.25")];
        let changes = changes.map(|list| subject.change(&list));
        let Subject { mut evaluator, parameters, .. } = subject;
        let plain = Evaluation::new(&parameters, ID);
        let all = (0..12).map(|number| Evaluation { number, intervention: Some(&changes[number % 4]), ..plain });
        let all: Vec<Evaluation<'_>> = all.collect();
        let alone: Vec<Outcome> = all.iter().map(|evaluation| evaluator.evaluate(*evaluation, None)).collect();
        // A change ends with its evaluation.
        assert!((0..12).all(|number| alone[number] == alone[number % 4]), "{name}");
        if let Some(lanes) = evaluator.in_lanes() {
            lanes.use_lanes(Lanes::new(8, Instructions::detect()).unwrap()).unwrap();
            let (mut rest, mut found) = (all.iter().copied(), vec![None; all.len()]);
            lanes.run_in_lanes(&mut || rest.next(), &mut |number, outcome| found[number] = Some(outcome));
            assert!(found.into_iter().eq(alone.into_iter().map(Some)), "{name}");
        }
    }
}

#[test]
fn lists_do_what_cases_of_protocols_do() {
    for (experiment, row, list) in [
        ("minimal-cognition", "no inner neuron 3", "neuron:inner 3"),
        ("minimal-cognition", "no ray 2", "sensor:ray 2"),
        ("reach-grasp-lift", "no hidden neuron 5", "neuron:5"),
        ("reach-grasp-lift", "no sphere position", "sensor:sphere position"),
        ("icub-reach", "no hidden neuron 2", "neuron:hidden 2"),
        (
            "icub-reach",
            "no links to torso_pitch",
            "link:hidden 1-torso_pitch,link:hidden 2-torso_pitch,link:hidden 3-torso_pitch,link:hidden 4-torso_pitch",
        ),
        ("double-pole", "no hidden 1", "neuron:hidden 1"),
        ("push-box", "0.1", "noise:0.1"),
        ("discrimination", "0.2", "noise:0.2"),
        ("foraging", "no neuron 2", "neuron:2"),
    ] {
        let mut subject = subjects().into_iter().find(|subject| subject.name == experiment).unwrap();
        let by_name = subject.with(list);
        let (_, intact) = subject.with("");
        let kind = if list.starts_with("noise") { "noise" } else { "lesions" };
        let protocols = subject.evaluator.info().protocols;
        let protocol = protocols.iter().position(|protocol| protocol.name == kind).unwrap();
        let rows: Vec<&str> = protocols[protocol].cases.iter().map(|case| case.row.as_str()).collect();
        let case = rows.iter().position(|found| *found == row).unwrap_or_else(|| panic!("{experiment}: {rows:?}"));
        let plain = Evaluation::new(&subject.parameters, ID);
        let case = Some(CaseId { protocol, case });
        let mut seen = Seen::default();
        let outcome = subject.evaluator.evaluate(Evaluation { case, ..plain }, Some(&mut seen));
        assert!(by_name == (outcome, seen), "{experiment}: {row}");
        assert!(by_name.1.outputs != intact.outputs, "{experiment}: {row}");
    }
}
