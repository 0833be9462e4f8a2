//! An episode of a composed experiment.

use farsa_body::{BodyId, Motor as _, Recorder, Sensor as _};
use farsa_evo::ObservationStatistics;
use farsa_lab::{
    ChannelGroup, Description, Episode, EpisodeId, Evaluation, NormalisedController, Outcome, Parameter, PlanarWorld,
    Rollout, Task, mean_of_trials, seconds,
};
use farsa_nn::Controller as _;
use farsa_num::{Domain, Scalar, Stream};
use farsa_view::{Channel, Links, NodeParameters, Schema};

use crate::composition::{Composition, NOISE};
use crate::document::{Ending, Trials};
use crate::parts::network::{AnyNetwork, Ends};
use crate::parts::term::{Numbers, Seen};

/// Robots, each with a copy of one network, in a trial.
#[derive(Clone, Debug)]
pub(crate) struct ComposedEpisode {
    composition: Composition,
    networks: Vec<NormalisedController<AnyNetwork>>,
    /// What each robot sensed and did last.
    x: Vec<f32>,
    y: Vec<f32>,
    /// Where each robot started and where it was a step before [m].
    started: Vec<[f64; 2]>,
    before: Vec<[f64; 2]>,
    /// What each term measured of all robots.
    sums: Vec<f64>,
    numbers: Numbers,
    steps: u32,
    failed: bool,
    succeeded: bool,
}

impl ComposedEpisode {
    /// A trial of a composition.
    pub(crate) fn new(composition: Composition) -> Self {
        let robots = composition.members.len();
        let networks = vec![NormalisedController::new(composition.network.clone()); robots];
        let robot = &composition.scene.robot;
        let numbers = Numbers {
            wheel_speed: robot.max_wheel_speed,
            radius: robot.radius,
            time_step: composition.document.world.time_step,
        };
        Self {
            x: vec![0.0; robots * composition.inputs.len()],
            y: vec![0.0; robots * composition.outputs.len()],
            started: vec![[0.0; 2]; robots],
            before: vec![[0.0; 2]; robots],
            sums: vec![0.0; composition.terms.len()],
            networks,
            numbers,
            steps: 0,
            failed: false,
            succeeded: false,
            composition,
        }
    }

    /// Puts everything in its place.
    ///
    /// # Errors
    /// [`farsa_physics::arena::ArenaError::NoFreePlace`] after a thousand tries.
    pub(crate) fn arrange<W: PlanarWorld>(
        &mut self,
        world: &mut W,
        id: EpisodeId,
    ) -> Result<(), farsa_physics::arena::ArenaError> {
        let mut stream = Stream::new(id.seed, Domain::Start, id.trial, id.individual, id.generation);
        self.composition.starting.arrange(world, &mut stream)
    }

    /// What the trial has earned so far.
    fn earned(&self) -> f64 {
        let Composition { terms, document, .. } = &self.composition;
        let terms = terms.iter().map(|term| term.earned(document.episode.steps));
        if document.fitness.product { terms.product() } else { terms.sum() }
    }

    fn measure<W: PlanarWorld>(&mut self, world: &W) {
        let Self { composition, x, y, started, before, sums, numbers, .. } = self;
        let Composition { members, terms, inputs, outputs, moving, .. } = composition;
        let (inputs, outputs) = (inputs.len(), outputs.len());
        if *moving {
            for term in terms.iter_mut() {
                term.locate(world);
            }
        }
        sums.fill(0.0);
        for (robot, member) in members.iter().enumerate() {
            let pose = world.pose(member.parts.body);
            let seen = Seen {
                parts: &member.parts,
                pose,
                x: &x[robot * inputs..(robot + 1) * inputs],
                y: &y[robot * outputs..(robot + 1) * outputs],
                start: started[robot],
                before: before[robot],
            };
            for (sum, term) in sums.iter_mut().zip(terms.iter()) {
                *sum += term.share(robot, term.value(world, &seen, *numbers));
            }
            before[robot] = [0, 1].map(|k| f64::from(pose.position[k]));
        }
        for (number, sum) in sums.iter().enumerate() {
            let (others, term) = terms.split_at_mut(number);
            let value = sum / term[0].robots(members.len());
            self.failed |= !value.is_finite();
            term[0].count(value, others);
        }
    }
}

impl<W: PlanarWorld> Episode<W> for ComposedEpisode {
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.failed = self.arrange(world, id).is_err();
        (self.steps, self.succeeded) = (0, false);
        self.networks.iter_mut().for_each(farsa_nn::Controller::reset);
        let Composition { members, terms, document, .. } = &mut self.composition;
        let streams = NOISE.map(|domain| Stream::new(id.seed, domain, id.trial, id.individual, id.generation));
        Composition::reseed(members, streams, document.episode.steps);
        for (robot, member) in members.iter_mut().enumerate() {
            member.sensors.iter_mut().for_each(farsa_body::Channels::reset);
            member.motors.iter_mut().for_each(farsa_body::Channels::reset);
            let [x, y, _] = world.pose(member.parts.body).position;
            self.started[robot] = [x, y].map(f64::from);
            self.before[robot] = self.started[robot];
        }
        for term in terms {
            term.reset();
            term.locate(world);
        }
    }

    fn has_started(&self) -> bool {
        !self.failed
    }

    /// All sense before any acts.
    #[inline]
    fn act(&mut self, world: &mut W) {
        let Self { composition, networks, x, y, .. } = self;
        let (inputs, outputs) = (composition.inputs.len(), composition.outputs.len());
        for (member, x) in composition.members.iter_mut().zip(x.chunks_exact_mut(inputs)) {
            member.sensors[..].read(world, x);
        }
        let rows = x.chunks_exact(inputs).zip(y.chunks_exact_mut(outputs));
        for ((member, network), (x, y)) in composition.members.iter_mut().zip(networks).zip(rows) {
            network.step(x, y);
            member.motors[..].drive(y, world);
        }
    }

    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.steps += 1;
        self.measure(world);
        let Composition { document, members, terms, success, .. } = &self.composition;
        self.succeeded = !success.is_empty() && success.iter().all(|wanted| wanted.holds(terms));
        let collided = || members.iter().any(|member| world.touches(farsa_body::PairId(member.parts.body.0)));
        let ends = |ending: &Ending| match ending {
            Ending::Collision => collided(),
            Ending::Success => self.succeeded,
        };
        let over = self.failed || document.episode.ends.iter().any(ends) || self.steps >= document.episode.steps;
        over.then(|| if self.failed { f64::NAN } else { self.earned() })
    }

    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        let Composition { scene, members, terms, document, inputs, outputs, .. } = &self.composition;
        recorder.sensors(&self.x[..inputs.len()]);
        recorder.neurons(self.networks[0].controller().neurons());
        recorder.outputs(&self.y[..outputs.len()]);
        (0..scene.bodies()).map(BodyId).for_each(|body| recorder.pose(body, world.pose(body)));
        let pose = world.pose(members[0].parts.body);
        let [x, y, _] = pose.position.map(f64::from);
        let mut scalars = vec![x, y, f64::from(pose.heading())];
        scalars.extend(terms.iter().map(|term| term.last));
        scalars.push(self.earned());
        recorder.scalars(&scalars);
        recorder.tick(seconds(self.steps, document.world.time_step));
    }
}

impl Task for ComposedEpisode {
    fn parameters(&self) -> Vec<Parameter> {
        let Composition { network, document, inputs, outputs, .. } = &self.composition;
        network.parameters(&document.network, Ends { inputs, outputs })
    }

    fn trials(&self) -> usize {
        self.composition.document.episode.trials as usize
    }

    fn terms(&self) -> Vec<String> {
        self.composition.terms.iter().map(|term| term.name.clone()).collect()
    }

    fn observations(&self) -> usize {
        self.composition.inputs.len()
    }

    fn schema(&self) -> Schema {
        let Composition { scene, terms, inputs, outputs, network, .. } = &self.composition;
        let arena = farsa_physics::arena::Arena { size: Some(scene.size), ..scene.arena.clone() };
        let mut schema = Schema::from_arena(&arena).with_sensors(inputs).with_outputs(outputs);
        schema.outputs.iter_mut().for_each(|output| output.range = Some([0.0, 1.0]));
        let (x, y) = (inputs.len(), inputs.len() + outputs.len());
        schema = match network {
            AnyNetwork::Leaky(leaky) => schema.with_network(&leaky.layout()),
            AnyNetwork::Perceptron(..) => Schema {
                links: vec![Links { from: [0, x], to: [x, y], first: 0 }],
                node_parameters: vec![NodeParameters { name: "bias".into(), nodes: [x, y], first: x * (y - x) }],
                ..schema
            },
            _ => {
                let neurons =
                    (1..=network.neurons().len()).map(|neuron| Channel::new(&neuron.to_string()).group("neuron"));
                Schema { neurons: neurons.collect(), ..schema }
            }
        };
        let in_group = |group: &'static str| move |name: &str| Channel::new(name).group(group);
        let places = ["x [m]", "y [m]", "heading [rad]"].map(in_group("place"));
        let terms = terms.iter().map(|term| in_group("term")(&term.name));
        let scalars = places.into_iter().chain(terms).chain([in_group("fitness")("fitness so far")]);
        Schema { scalars: scalars.collect(), ..schema }
    }

    fn description(&self) -> Description {
        let Composition { document, sensors, motors, network, about, .. } = &self.composition;
        let group = |((name, [first, end]), about): (&(String, [usize; 2]), &String)| {
            ChannelGroup::new(name, end - first, about)
        };
        let (of_sensors, of_motors) = about.split_at(sensors.len().min(about.len()));
        Description {
            sensors: sensors.iter().zip(of_sensors).map(group).collect(),
            motors: motors.iter().zip(of_motors).map(group).collect(),
            network: network.summary(),
            parameters: self.parameters().len(),
            steps: document.episode.steps as usize,
            step_seconds: document.world.time_step,
        }
    }

    fn fitness(&self, trials: &[Outcome]) -> f64 {
        let document = &self.composition.document;
        if !document.fitness.product && document.fitness.trials == Trials::Mean {
            return mean_of_trials(trials);
        }
        let of_trial = |outcome: &Outcome| -> f64 {
            if document.fitness.product { outcome.terms.iter().product() } else { outcome.terms.iter().sum() }
        };
        let each = trials.iter().map(of_trial);
        match document.fitness.trials {
            Trials::Mean => each.sum::<f64>() / trials.len().max(1) as f64,
            Trials::Sum => each.sum(),
            // NaN is the worst.
            Trials::Worst => each.fold(f64::INFINITY, |worst, own| {
                if own.is_nan() || worst.is_nan() { f64::NAN } else { Scalar::min(worst, own) }
            }),
        }
    }
}

impl Rollout for ComposedEpisode {
    /// Gives all robots the network.
    fn load(&mut self, evaluation: &Evaluation<'_>) -> bool {
        self.networks.iter_mut().all(|network| {
            network.load(evaluation.normalisation) && network.controller_mut().load(evaluation.parameters)
        })
    }

    fn record_parameters(&self, recorder: &mut dyn Recorder) {
        recorder.parameters(self.networks[0].controller().own_parameters());
    }

    fn outcome(&self) -> Outcome {
        if self.failed {
            return Outcome::failed();
        }
        let Composition { terms, document, .. } = &self.composition;
        let mut observed = self.networks.iter().filter_map(NormalisedController::observed);
        let first = observed.next().cloned();
        let merged = first.and_then(|first| {
            let merge = |mut all: ObservationStatistics, own| all.merge(own).ok().map(|()| all);
            observed.try_fold(first, merge)
        });
        Outcome {
            terms: terms.iter().map(|term| term.earned(document.episode.steps)).collect(),
            steps: self.steps,
            success: self.succeeded,
            observed: merged,
            ..Outcome::default()
        }
    }
}
