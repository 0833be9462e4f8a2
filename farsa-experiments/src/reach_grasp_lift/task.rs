//! The task of `reach-grasp-lift`. It runs and records episodes of evolved networks.

use std::sync::Arc;

use farsa_body::Recorder;
use farsa_body::ports::{Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, JointId, Joints, Kinematics};
use farsa_models::mjcf::MjcfOptions;
use farsa_nn::LeakyNetwork;

use crate::reach_grasp_lift::config::{LABELS, Labels, TRIALS};
use crate::reach_grasp_lift::episode::ReachEpisode;
use crate::reach_grasp_lift::fitness::Rewards;
use crate::reach_grasp_lift::parameters::Ranges;
use crate::reach_grasp_lift::scene::Scene;
use crate::reach_grasp_lift::schema::{EpisodeRecorder, NetworkEpisode};
use farsa_lab::advanced::{
    Anatomy, Behavior, ChannelGroup, Description, ExternalControl, Intervention, Interventions, NormalizedController,
    NotedBehavior, Protocol, Rollout, input_ranges,
};
use farsa_lab::exports::{ControllerExport, Exports, NetworkExport, StartExport};
use farsa_lab::{Combination, Episode, EpisodeId, Error, Evaluation, Note, Outcome, Task, TaskInfo};
use farsa_view::Schema;

/// Runs the trials of a network and defines the channels recorded.
#[derive(Clone)]
pub struct ReachTask {
    episode: NetworkEpisode,
    ranges: Ranges,
    episode_recorder: Arc<EpisodeRecorder>,
    interventions: Interventions,
}

impl ReachTask {
    /// Creates the task for a scene.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the network cannot be built.
    pub fn new(scene: Scene) -> Result<Self, Error> {
        let (config, layout) = (&scene.config, scene.config.layout());
        let ranges = Ranges::new(layout, config.leak, config.weight_range as f32)?;
        let (zeros, state) = (vec![0.0; layout.parameter_count()], vec![0.0; layout.state_len()]);
        let network = LeakyNetwork::new(layout, config.leak, zeros, state);
        let network = network.map_err(|error| Error::Other(format!("reach-grasp-lift: {error}")))?;
        let episode_recorder = Arc::new(EpisodeRecorder::new(&scene));
        let episode = ReachEpisode::new(Arc::new(scene), NormalizedController::new(network))?;
        let mut task = Self { episode, ranges, episode_recorder, interventions: Interventions::default() };
        task.interventions = task.interventions();
        Ok(task)
    }

    /// `start-positions` has every posture of the arm with every place of the sphere, of which four pairs were trained.
    /// `labels`, where there are any, has the right one, none, and those of another phase if they are given. Then come
    /// `lesions`.
    fn interventions(&self) -> Interventions {
        let config = &self.scene().config;
        let groups = self.description().sensors;
        let starts = Protocol::from_table(
            "start-positions",
            "every posture of the arm with every place of the sphere",
            (1..=TRIALS).map(|posture| format!("posture {posture}")),
            (1..=TRIALS).map(|place| format!("place {place}")),
        );
        let number = |name: &str| name.rsplit(' ').next().map(str::to_owned);
        let starts = starts.with_axes("arm", "sphere").with_held_out(|row, column| number(row) != number(column));
        let hidden = (0..config.layout().hidden()).map(|neuron| (format!("hidden neuron {}", neuron + 1), neuron));
        let mut interventions = Interventions::default().with_protocol(starts, Vec::new());
        if let Some((_, labels)) = input_ranges(&groups).find(|(name, _)| name == "label") {
            let given = config.labels == Labels::Given;
            let cases = &["as trained", "removed", "of the next phase"][..if given { 3 } else { 2 }];
            let about = if given {
                "the label of the phase is removed, or wrong"
            } else {
                "the labels of the network are removed"
            };
            let protocol = Protocol::from_list("labels", about, cases.iter().copied());
            let protocol = protocol.with_held_out(|row, _| row != cases[0]);
            interventions =
                interventions.with_protocol(protocol, vec![Intervention::default(), Intervention::cut(labels)]);
        }
        interventions.with_lesions(input_ranges(&groups), hidden)
    }

    fn scene(&self) -> &Scene {
        self.episode.judge().scene()
    }
}

impl<W> Episode<W> for ReachTask
where
    W: Kinematics
        + Joints
        + Actuated
        + Contacts
        + Arrange
        + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>,
{
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.episode.start(world, id);
    }

    fn act(&mut self, world: &mut W) {
        self.episode.act(world);
    }

    fn judge(&mut self, world: &mut W) -> Option<f64> {
        Episode::judge(&mut self.episode, world)
    }

    fn external(&mut self) -> Result<&mut dyn ExternalControl<W>, String> {
        Ok(self)
    }

    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        self.episode_recorder.record(world, &self.episode, recorder);
    }
}

/// The fitness so far is that of this trial alone, within the caps of an individual.
impl<W> ExternalControl<W> for ReachTask
where
    W: Kinematics
        + Joints
        + Actuated
        + Contacts
        + Arrange
        + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>,
{
    fn channels(&self) -> [usize; 2] {
        [self.episode.sensed().len(), self.episode.done().len()]
    }

    fn observe(&mut self, world: &W) {
        self.episode.sense(world);
    }

    fn observation(&self) -> &[f32] {
        self.episode.sensed()
    }

    fn actuate(&mut self, action: &[f32], world: &mut W) {
        self.episode.actuate(action, world);
    }

    fn earned(&self) -> f64 {
        self.episode.judge().trial().rewards.total()
    }

    fn is_truncated(&self, _: &W) -> bool {
        !self.episode.judge().trial().fallen
    }
}

impl Rollout for ReachTask {
    fn load(&mut self, evaluation: &Evaluation<'_>) -> bool {
        let parameters = self.ranges.to_network(evaluation.parameters);
        let named = self.interventions.named(evaluation.case);
        let starts =
            named.filter(|(name, _)| *name == "start-positions").map(|(_, case)| [case / TRIALS, case % TRIALS]);
        self.episode.change(starts, named == Some(("labels", 2)));
        let (network, change) = (self.episode.controller_mut(), self.interventions.applied(evaluation));
        if !network.load(evaluation.normalisation) {
            return false;
        }
        network.intervene(&change, evaluation.id, 0);
        network.controller_mut().copy_parameters(&change.edited(&parameters)).is_ok()
    }

    fn record_parameters(&self, recorder: &mut dyn Recorder) {
        recorder.parameters(self.episode.controller().controller().parameters());
    }

    fn outcome(&self) -> Outcome {
        let judge = self.episode.judge();
        let time_step = judge.scene().config.time_step;
        let trial = judge.trial();
        let Rewards { reach, grasp, lift, bonus } = trial.rewards;
        let second = judge.scene().config.steps_per_second();
        // Success by the printed reward alone: any height will do.
        let lifted = trial.lifted >= second && !trial.fallen;
        Outcome {
            terms: vec![reach, grasp, lift, bonus],
            steps: trial.steps,
            success: judge.succeeds(),
            notes: vec![
                ("phase", Note::from(trial.phase.name())),
                ("end", Note::from(if trial.fallen { "sphere fell" } else { "time" })),
                ("lifted for 1 s", Note::from(if lifted { "true" } else { "false" })),
                ("held [s]", Note::from(f64::from(trial.held) * time_step)),
                ("height [cm]", Note::from(judge.seen().height)),
                ("highest [cm]", Note::from(trial.highest)),
            ],
            observed: self.episode.controller().observed().cloned(),
            ..Outcome::default()
        }
    }
}

/// Objectives and measures of an individual, for strategies that use more than its fitness.
static BEHAVIOUR: NotedBehavior = NotedBehavior {
    objectives: &[("held [s]", 1.0), ("highest [cm]", 1.0)],
    measures: &[("held [s]", [0.0, 6.0]), ("highest [cm]", [0.0, 60.0])],
};

impl ReachTask {
    fn schema(&self) -> Schema {
        EpisodeRecorder::schema(&self.episode)
    }

    fn description(&self) -> Description {
        let config = &self.episode.judge().scene().config;
        let saturation = config.touch_saturation;
        let mut sensors = vec![
            ChannelGroup::new("arm joints", 7, "J1..J7, 0 at the lower and 1 at the upper limit"),
            ChannelGroup::new(
                "hand joints",
                10,
                "J8 J9 J10 J13 J14 J17 J18 J21 J22, 0 extended and 1 flexed; J16, 0 at the lower and 1 at the upper limit",
            ),
            ChannelGroup::new(
                "touch",
                6,
                &format!("thumb, index, middle, ring, little finger, palm: touching pairs / {saturation}, at most 1"),
            ),
            ChannelGroup::new("sphere position", 3, "sphere's center relative to the palm's, x, y, z [cm]"),
        ];
        let amplitude = config.label_amplitude;
        let label = match config.labels {
            Labels::Given => Some(format!("{amplitude} for the present phase (reach, grasp, lift), else 0")),
            Labels::None => None,
            Labels::Own => {
                Some(format!("{amplitude} times the outputs `next label` of the previous step, 0 in the first"))
            }
        };
        sensors.extend(label.map(|meaning| ChannelGroup::new("label", LABELS, &meaning)));
        let mut motors = vec![
            ChannelGroup::new("muscles", 14, "activation of agonist and antagonist of J1..J7, 0..1"),
            ChannelGroup::new(
                "servo groups",
                9,
                "J8; J9; J10 J11; J13; J14 J15; J17; J18 J19; abduction J12 J16 J20 J24; J21-J23 J25-J27: 0 extended or \
                 together, 1 flexed or spread",
            ),
        ];
        if config.labels == Labels::Own {
            motors.push(ChannelGroup::new("next label", LABELS, "labels of the next step, 0..1, which move nothing"));
        }
        let layout = config.layout();
        let leak = config.leak.name();
        Description {
            sensors,
            motors,
            network: format!(
                "{}-{}-{}, recurrent hidden layer, leak {leak}",
                layout.sensors(),
                layout.hidden(),
                layout.outputs()
            ),
            parameters: layout.parameter_count(),
            steps: config.steps as usize,
            step_seconds: config.time_step,
        }
    }
}

impl Task for ReachTask {
    fn info(&self) -> TaskInfo {
        TaskInfo {
            combination: Some(Combination::Sum),
            description: self.description(),
            trials: TRIALS,
            terms: ["reach", "grasp", "lift", "bonus"].map(String::from).to_vec(),
            observations: self.episode.sensed().len(),
            protocols: self.interventions.protocols(),
            anatomy: Some(Anatomy::new(&self.schema(), &self.description())),
            ..TaskInfo::new(self.ranges.parameters(), self.schema())
        }
    }

    fn behavior(&self) -> Option<&dyn Behavior> {
        Some(&BEHAVIOUR)
    }

    /// The sum of the rewards, each part within the individual's cap.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        let mut sum = Rewards::default();
        for outcome in trials {
            let [reach, grasp, lift, bonus] = outcome.terms[..] else { return f64::NAN };
            sum.add(&Rewards { reach, grasp, lift, bonus });
        }
        sum.total()
    }

    fn exports(&self) -> Option<&dyn Exports> {
        Some(self)
    }
}

impl Exports for ReachTask {
    fn mjcf_options(&self) -> Option<MjcfOptions> {
        Some(self.scene().mjcf_options())
    }

    fn controller(&self, parameters: &[f32]) -> Option<ControllerExport> {
        let config = &self.scene().config;
        let parameters = self.ranges.to_network(parameters);
        let network = NetworkExport::leaky(&config.layout(), config.leak, &parameters);
        let outputs = self.scene().output_names(self.episode.motors());
        Some(self.scene().controller(network, self.episode.senses().names(), outputs))
    }

    fn start(&self, id: EpisodeId) -> Option<StartExport> {
        Some(self.scene().start_by_name(id))
    }
}
