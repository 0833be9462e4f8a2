//! Controlled robots: channels, copies of one network, rewards.

use std::sync::Arc;

use farsa_evo::ObservationStatistics;
use farsa_lab::advanced::{Anatomy, ChannelGroup, Description, Interventions, NormalizedController};
use farsa_lab::{Evaluation, Outcome};
use farsa_view::{Channel, Schema};

use crate::check::registry::Registry;
use crate::document::Document;
use crate::parts::groups::Groups;
use crate::parts::interventions::{TEAM_SIZE, interventions, team_sizes};
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

    /// Checks that actions can come from outside.
    ///
    /// # Errors
    /// Returns the reason if they cannot.
    pub(crate) fn check_external(&self) -> Result<(), String> {
        match self.networks.len() {
            1 => Ok(()),
            robots => Err(format!("it has {robots} robots, and an action is for one")),
        }
    }

    /// Stores an action within the range of a network's outputs, as if the network had computed it.
    pub(crate) fn choose(&mut self, action: &[f32]) {
        self.y.iter_mut().zip(action).for_each(|(y, action)| *y = action.clamp(0.0, 1.0));
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
        schema = network.part().drawn(schema);
        // A recording has its own column of this name.
        let name = |tally: &Tally| if tally.label() == "time [s]" { tally.name.clone() } else { tally.label().into() };
        let terms = self.ledger.shown().iter().map(|tally| Channel::new(&name(tally)).group("term"));
        let fitness = Channel::new("fitness so far").group("fitness");
        Schema { scalars: scalars.into_iter().chain(terms).chain([fitness]).collect(), ..schema }
    }

    /// Builds the names for tests, for recordings with `schema`. Neurons are numbered as in the network.
    pub(crate) fn anatomy(&self, schema: &Schema) -> Anatomy {
        let network = &self.spec.network;
        Anatomy::new(schema, &self.description()).with_first(0, network.part().first_output())
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
