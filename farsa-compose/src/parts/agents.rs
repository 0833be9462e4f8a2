//! Controlled robots: channels, copies of one network, rewards.

use std::sync::Arc;

use farsa_evo::ObservationStatistics;
use farsa_lab::advanced::{Anatomy, ChannelGroup, Description, Interventions, NormalizedController};
use farsa_lab::{Evaluation, Outcome};
use farsa_nn::{CtrnnLayout, CtrnnParameter};
use farsa_view::{Channel, Links, NodeParameters, Schema};

use crate::check::registry::Registry;
use crate::document::Document;
use crate::parts::groups::Groups;
use crate::parts::interventions::{TEAM_SIZE, first_output, interventions, team_sizes};
use crate::parts::ledger::Ledger;
use crate::parts::network::AnyNetwork;
use crate::parts::network_spec::NetworkSpec;
use crate::parts::tally::Tally;
use crate::parts::trainee::Trainee;

/// Robots of a document in any world. Copies share the document and the test protocols.
#[derive(Clone, Debug)]
pub(crate) struct Agents {
    pub(crate) document: Arc<Document>,
    pub(crate) spec: NetworkSpec,
    pub(crate) ledger: Ledger,
    pub(crate) groups: Groups,
    pub(crate) registry: Registry,
    /// Test protocols.
    pub(crate) interventions: Arc<Interventions>,
    /// Individuals of each population, if there are several.
    pub(crate) size: usize,
    /// Evolving robots of this trial, from the first up to the one after the last.
    pub(crate) evolving: [usize; 2],
    /// Robots of this trial: all, or the first ones.
    pub(crate) present: usize,
    /// Recorded robot.
    pub(crate) watched: usize,
    pub(crate) networks: Vec<NormalizedController<AnyNetwork>>,
    /// Learner from demonstrations, if any.
    pub(crate) trainee: Option<Trainee>,
    /// Last sensor and motor values of all robots.
    pub(crate) x: Vec<f32>,
    pub(crate) y: Vec<f32>,
}

impl Agents {
    /// Creates robots at rest.
    pub(crate) fn new(
        document: Document,
        spec: NetworkSpec,
        ledger: Ledger,
        groups: Groups,
        registry: &Registry,
    ) -> Self {
        let robots = groups.robots();
        let networks = vec![NormalizedController::new(spec.network.clone()); robots];
        let (x, y) = (vec![0.0; robots * spec.inputs.len()], vec![0.0; robots * spec.outputs.len()]);
        let interventions = Arc::new(interventions(&document, &spec, robots));
        let document = Arc::new(document);
        let (evolving, present, watched, size) = ([0, robots], robots, 0, 1);
        Self {
            document,
            spec,
            ledger,
            groups,
            registry: registry.clone(),
            interventions,
            size,
            evolving,
            present,
            watched,
            networks,
            trainee: None,
            x,
            y,
        }
    }

    /// Begins a trial. `arranged` is false if something had no place.
    pub(crate) fn begin(&mut self, arranged: bool) {
        self.ledger.begin(arranged);
        self.networks.iter_mut().for_each(farsa_nn::Controller::reset);
    }

    /// Loads the network of each population, and applies the test case to the evolving robots. Returns false for
    /// another number of parameters.
    pub(crate) fn load(&mut self, evaluation: &Evaluation<'_>) -> bool {
        let Evaluation { parameters, opponents, normalisation, id, case, watched, .. } = *evaluation;
        let ranges = self.groups.ranges();
        let tested = if ranges.len() > 1 { id.population(self.size).min(ranges.len() - 1) } else { 0 };
        let robots = self.groups.robots();
        let case = self.interventions.named(case).filter(|(name, _)| *name == TEAM_SIZE);
        let size = case.and_then(|(_, case)| team_sizes(robots).get(case).copied());
        self.present = size.unwrap_or(robots);
        // A smaller team lacks its last robots, which may be evolving ones.
        self.evolving = [ranges[tested][0], ranges[tested][1].min(self.present)];
        self.watched = watched.map_or(self.evolving[0], |robot| (robot as usize).min(robots - 1));
        self.ledger.evolve(self.evolving);
        let mut others = opponents.iter().copied();
        let mut loaded = ranges.into_iter().enumerate().all(|(population, [first, end])| {
            // Without opponents, the tested parameters also control the other populations.
            let given = if population == tested { parameters } else { others.next().unwrap_or(parameters) };
            let Some(all) = self.spec.searched.all(given) else { return false };
            let mut networks = self.networks[first..end].iter_mut();
            networks.all(|network| network.load(normalisation) && network.controller_mut().load(all))
        });
        let (change, [first, end]) = (self.interventions.applied(evaluation), self.evolving);
        for (robot, network) in self.networks.iter_mut().enumerate().take(end).skip(first) {
            network.intervene(&change, id, robot as u32);
            loaded = loaded && network.controller_mut().edit(&change);
        }
        loaded
    }

    /// Builds the outcome of a trial.
    pub(crate) fn outcome(&self) -> Outcome {
        if self.ledger.failed {
            return self.ledger.failure();
        }
        let [first, end] = self.evolving;
        let mut observed = self.networks[first..end].iter().filter_map(NormalizedController::observed);
        let first = observed.next().cloned();
        let merged = first.and_then(|first| {
            let merge = |mut all: ObservationStatistics, own| all.merge(own).ok().map(|()| all);
            observed.try_fold(first, merge)
        });
        Outcome { observed: merged, ..self.ledger.outcome() }
    }

    /// Builds the schema of bodies with channels, network and terms. `scalars` come first among the scalars.
    pub(crate) fn schema(&self, bodies: Schema, scalars: Vec<Channel>) -> Schema {
        let NetworkSpec { inputs, outputs, network, .. } = &self.spec;
        let mut schema = bodies.with_sensors(inputs).with_outputs(outputs);
        schema.outputs.iter_mut().for_each(|output| output.range = Some([0.0, 1.0]));
        let (x, y) = (inputs.len(), inputs.len() + outputs.len());
        schema = match network {
            AnyNetwork::Leaky(leaky) => schema.with_network(&leaky.layout()),
            AnyNetwork::Perceptron(..) => Schema {
                links: vec![Links { from: [0, x], to: [x, y], first: 0 }],
                node_parameters: vec![NodeParameters { name: "bias".into(), nodes: [x, y], first: x * (y - x) }],
                ..schema
            },
            AnyNetwork::Ctrnn(ctrnn) => with_ctrnn(schema, &ctrnn.layout()),
            _ => {
                let neurons =
                    (1..=network.activations().len()).map(|neuron| Channel::new(&neuron.to_string()).group("neuron"));
                Schema { neurons: neurons.collect(), ..schema }
            }
        };
        // A recording has its own column of this name.
        let name = |tally: &Tally| if tally.label() == "time [s]" { tally.name.clone() } else { tally.label().into() };
        let terms = self.ledger.shown().iter().map(|tally| Channel::new(&name(tally)).group("term"));
        let fitness = Channel::new("fitness so far").group("fitness");
        Schema { scalars: scalars.into_iter().chain(terms).chain([fitness]).collect(), ..schema }
    }

    /// Builds the names for tests, for recordings with `schema`. Neurons are numbered as in the network.
    pub(crate) fn anatomy(&self, schema: &Schema) -> Anatomy {
        let NetworkSpec { network, outputs, .. } = &self.spec;
        Anatomy::new(schema, &self.description()).with_first(0, first_output(network, outputs.len()))
    }

    /// Describes sensors, motors and network.
    pub(crate) fn description(&self) -> Description {
        let Self { document, spec, .. } = self;
        let group = |((name, [first, end]), about): (&(String, [usize; 2]), &String)| {
            ChannelGroup::new(name, end - first, about)
        };
        let (of_sensors, of_motors) = spec.about.split_at(spec.sensors.len().min(spec.about.len()));
        Description {
            sensors: spec.sensors.iter().zip(of_sensors).map(group).collect(),
            motors: spec.motors.iter().zip(of_motors).map(group).collect(),
            network: spec.network.summary(),
            parameters: spec.searched.parameters().len(),
            steps: document.episode.steps as usize,
            step_seconds: document.world.time_step,
        }
    }
}

/// Sets the neurons and links of a network in continuous time. Every output is also a neuron.
fn with_ctrnn(schema: Schema, layout: &CtrnnLayout) -> Schema {
    let (inputs, neurons) = (layout.inputs(), layout.neurons());
    let nodes = [inputs, inputs + neurons];
    let first = |kind| layout.range(kind).start;
    let weighted = Links { from: [0, inputs], to: nodes, first: first(CtrnnParameter::InputWeight) };
    let recurrent = Links { from: nodes, to: nodes, first: first(CtrnnParameter::Weight) };
    let direct = layout.direct_inputs().into_iter().flatten().enumerate();
    let direct = direct.map(|(input, neuron)| [input, inputs + neuron]);
    let passed = layout.output_neurons().enumerate();
    let passed = passed.map(|(output, neuron)| [inputs + neuron, inputs + neurons + output]);
    let of_neurons = |name: &str, kind| NodeParameters { name: name.into(), nodes, first: first(kind) };
    let named = (1..=neurons).map(|neuron| Channel::new(&neuron.to_string()).group("neuron"));
    Schema {
        neurons: named.collect(),
        links: if layout.direct_inputs().is_some() { vec![recurrent] } else { vec![weighted, recurrent] },
        direct_links: direct.chain(passed).collect(),
        node_parameters: vec![
            of_neurons("bias", CtrnnParameter::Bias),
            of_neurons("gain", CtrnnParameter::Gain),
            of_neurons("time constant", CtrnnParameter::TimeConstant),
        ],
        ..schema
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_of_a_continuous_network_meet_every_parameter_once() {
        let plain = CtrnnLayout::new(3, 5, 2);
        for (layout, direct) in [(plain, 0), (plain.with_direct_inputs(1), 3)] {
            let bare = Schema::default().with_sensors(["a", "b", "c"]).with_outputs(["x", "y"]);
            let Schema { links, direct_links, node_parameters, neurons, .. } = with_ctrnn(bare, &layout);
            let mut seen = vec![0; layout.parameter_count()];
            for Links { from, to, first } in &links {
                (0..(from[1] - from[0]) * (to[1] - to[0])).for_each(|weight| seen[first + weight] += 1);
            }
            for NodeParameters { nodes, first, .. } in &node_parameters {
                (0..nodes[1] - nodes[0]).for_each(|node| seen[first + node] += 1);
            }
            assert_eq!((seen, neurons.len()), (vec![1; layout.parameter_count()], 5));
            // Inputs 0 to 2 go to the neurons 1 to 3, nodes 4 to 6. Outputs, nodes 8 and 9, are the last neurons.
            let inputs = [[0, 4], [1, 5], [2, 6]].into_iter().take(direct);
            assert_eq!(direct_links, inputs.chain([[6, 8], [7, 9]]).collect::<Vec<_>>());
        }
    }
}
