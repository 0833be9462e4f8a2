//! An episode of a robot with joints.

use farsa_body::ports::BodyId;
use farsa_body::robot::{Joint, JointKind, MassProperties, Robot, Segment};
use farsa_body::{Pose, Recorder};
use farsa_lab::advanced::{ExternalControl, seconds};
use farsa_lab::{Episode, EpisodeId};
use farsa_models::mjcf::MjcfOptions;
use farsa_nn::Controller as _;
use farsa_num::{Domain, Stream};
use farsa_view::shape::{Geometry, Role, SceneObject, screen_color};
use farsa_view::{Channel, Schema};

use crate::check::source::Source;
use crate::composed_task::Body;
use crate::jointed::SpatialWorld;
use crate::jointed::registered::PartOfSpatial;
use crate::jointed::scene::Scene;
use crate::jointed::setup::Setup;
use crate::jointed::term::Term;
use crate::part::{Moment, PartScene};
use crate::parts::agents::Agents;
use crate::parts::noise_streams::NoiseStreams;
use crate::sensors::eye::camera_of;

/// A robot with its network in a trial.
#[derive(Clone, Debug)]
pub(crate) struct JointedEpisode {
    setup: Setup,
    agents: Agents,
    /// Positions of the markers [m].
    markers: Vec<[f32; 3]>,
    /// Schema of the drawing, and the bodies that move in it.
    drawn: Schema,
    shown: Vec<BodyId>,
    /// True if a term has a state that each step updates.
    has_state: bool,
}

/// Speed that shows a failure of the dynamics [rad/s or m/s].
const FASTEST: f32 = 1000.0;

impl JointedEpisode {
    pub(crate) fn new(setup: Setup, agents: Agents) -> Self {
        let markers = vec![[0.0; 3]; setup.scene.markers.len()];
        let drawn = drawn(&setup, &agents.spec.sensors);
        let bodies = setup.scene.robot.segments.len();
        let shown = drawn.shown().filter(|body| body.index() < bodies).collect();
        let has_state = setup.terms.iter().any(Term::has_state);
        Self { setup, agents, markers, drawn, shown, has_state }
    }

    pub(crate) fn scene(&self) -> &Scene {
        &self.setup.scene
    }

    /// Places everything at its start. Returns false if something finds no place.
    pub(crate) fn arrange<W: SpatialWorld>(&mut self, world: &mut W, id: EpisodeId) -> bool {
        let mut stream = Stream::new(id.seed, Domain::Start, id.trial, id.individual, id.generation);
        self.setup.starting.arrange(world, &mut self.markers, &mut stream)
    }

    /// Measures the terms of each step, or the late ones.
    fn measure<W: SpatialWorld>(&mut self, world: &W, late: bool) {
        for (number, term) in self.setup.terms.iter().enumerate() {
            if self.agents.ledger.tallies[number].late != late {
                continue;
            }
            let value = term.value(world, &moment(&self.agents, &self.markers));
            self.agents.ledger.count(number, value);
        }
    }

    /// Returns true after an event that ends the trial early.
    fn has_event<W: SpatialWorld>(&self, world: &W) -> bool {
        let now = moment(&self.agents, &self.markers);
        let success = self.setup.ends_with_success && self.agents.ledger.would_succeed();
        self.setup.ends.iter().any(|end| world.ends(&**end, &now, success))
    }

    /// Returns false after NaN or at impossible speeds.
    fn is_sane<W: SpatialWorld>(&self, world: &W) -> bool {
        let Setup { joints, floating, .. } = &self.setup;
        // A comparison with NaN is false.
        joints.iter().all(|joint| world.speed(*joint).abs() < FASTEST && world.position(*joint).is_finite())
            && floating.iter().all(|body| {
                let twist = world.velocity(*body);
                twist.linear.iter().chain(&twist.angular).all(|speed| speed.abs() < FASTEST)
            })
    }
}

/// Builds the schema: robot, colored things, markers as bodies after all others, images of sensors.
fn drawn(setup: &Setup, sensors: &[(String, [usize; 2])]) -> Schema {
    let scene = &setup.scene;
    let mut robot = scene.alone();
    let mut objects = scene.drawn.clone();
    for marker in &scene.markers {
        let nothing = MassProperties::sphere(0.0, marker.radius);
        // A marker has no body in the world. Its body in the drawing is massless and has a number above all others.
        let floating = Joint::floating(Pose::identity());
        let body = robot.add_segment(Segment::new(&marker.name, None, floating, nothing));
        let ball = Geometry::Sphere { radius: marker.radius };
        let object = SceneObject::new(&marker.name, ball, Pose::identity(), Role::Object);
        objects.push(object.on_body(body).with_color(screen_color(marker.color)));
    }
    let mut schema = Schema { objects, meshes: scene.meshes.clone(), ..Schema::from_robot(&robot) };
    for (sensor, (name, _)) in setup.equipment.sensors.iter().zip(sensors) {
        if let Some(camera) = camera_of(&*sensor.kind().0) {
            schema = schema.with_image(name, camera.size());
        }
    }
    schema
}

/// Returns the values that terms read.
fn moment<'m>(agents: &'m Agents, markers: &'m [[f32; 3]]) -> Moment<'m> {
    Moment {
        steps: agents.ledger.steps,
        longest: agents.document.episode.steps,
        time_step: agents.document.world.time_step,
        poses: &[],
        x: &agents.x,
        y: &agents.y,
        inputs: agents.spec.inputs.len(),
        outputs: agents.spec.outputs.len(),
        markers,
        stock: None,
    }
}

impl Body for JointedEpisode {
    fn agents(&self) -> &Agents {
        &self.agents
    }

    fn agents_mut(&mut self) -> &mut Agents {
        &mut self.agents
    }

    fn bodies(&self) -> Schema {
        self.drawn.clone()
    }

    fn scalars(&self) -> Vec<Channel> {
        let scene = &self.setup.scene;
        let joint = |joint: &farsa_body::ports::JointId| {
            let segment = &scene.robot.segments[joint.index()];
            let unit = if segment.joint.kind == JointKind::Prismatic { "m" } else { "rad" };
            let channel = Channel::new(&format!("{} [{unit}]", segment.joint.name)).group("joint");
            let [low, high] = segment.joint.range;
            if low.is_finite() && high.is_finite() { channel.range(low, high) } else { channel }
        };
        self.setup.joints.iter().map(joint).collect()
    }

    fn robot(&self) -> Robot {
        self.setup.scene.robot.clone()
    }

    fn mjcf_options(&self) -> Option<MjcfOptions> {
        let world = &self.agents.document.world;
        // MuJoCo steps once per dynamics step, not once per control step.
        let time_step = world.time_step / f64::from(world.substeps);
        Some(MjcfOptions { time_step, gravity: world.gravity, ..MjcfOptions::default() })
    }

    fn in_scene(&self, _: usize, call: &mut dyn FnMut(&PartScene<'_>)) {
        let source = Source::default();
        call(&PartScene::new(&PartOfSpatial {
            scene: &self.setup.scene,
            wiring: None,
            rule: None,
            sensors: &[],
            path: "",
            source: &source,
        }));
    }
}

impl<W: SpatialWorld> Episode<W> for JointedEpisode {
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        let arranged = self.arrange(world, id);
        self.agents.begin(arranged);
        let mut streams = NoiseStreams::of_episode(id, self.agents.document.episode.steps);
        let Setup { equipment, terms, .. } = &mut self.setup;
        equipment.begin(&mut streams);
        equipment.sensors.iter_mut().for_each(|sensor| sensor.kind_mut().look(&self.markers));
        let now = moment(&self.agents, &self.markers);
        for term in terms.iter_mut() {
            term.begin(world, &now);
        }
    }

    fn has_started(&self) -> bool {
        !self.agents.ledger.failed
    }

    fn act(&mut self, world: &mut W) {
        let equipment = &mut self.setup.equipment;
        let Agents { spec, networks, x, y, .. } = &mut self.agents;
        equipment.sense(&spec.sensors, world, x);
        networks[0].step(x, y);
        equipment.drive(&spec.motors, y, world);
    }

    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.agents.ledger.steps += 1;
        if self.has_state {
            let now = moment(&self.agents, &self.markers);
            self.setup.terms.iter_mut().for_each(|term| term.step(world, &now));
        }
        self.measure(world, false);
        self.agents.ledger.count_conditions();
        // Terms may be finite in a world that is not, so the bodies are checked separately.
        self.agents.ledger.failed |= !self.is_sane(world);
        if !self.agents.ledger.is_over() && !self.has_event(world) {
            return None;
        }
        self.measure(world, true);
        Some(self.agents.ledger.conclude())
    }

    fn external(&mut self) -> Result<&mut dyn ExternalControl<W>, String> {
        self.agents.check_external()?;
        Ok(self)
    }

    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        let Agents { document, ledger, networks, x, y, .. } = &self.agents;
        recorder.sensors(x);
        for (number, camera) in
            self.setup.equipment.sensors.iter().filter_map(|sensor| camera_of(&*sensor.kind().0)).enumerate()
        {
            camera.record(number, recorder);
        }
        recorder.neurons(networks[0].controller().activations());
        recorder.outputs(y);
        for body in &self.shown {
            recorder.pose(*body, world.pose(*body));
        }
        let bodies = self.setup.scene.robot.segments.len();
        for (number, place) in self.markers.iter().enumerate() {
            recorder.pose(BodyId((bodies + number) as u16), Pose::at(*place));
        }
        let mut scalars: Vec<f64> = self.setup.joints.iter().map(|joint| f64::from(world.position(*joint))).collect();
        for (tally, term) in ledger.shown().iter().zip(&self.setup.terms) {
            scalars.push(if tally.late { term.value(world, &moment(&self.agents, &self.markers)) } else { tally.last });
        }
        scalars.push(ledger.earned());
        recorder.scalars(&scalars);
        recorder.tick(seconds(ledger.steps, document.world.time_step));
    }
}

impl<W: SpatialWorld> ExternalControl<W> for JointedEpisode {
    fn channels(&self) -> [usize; 2] {
        [self.agents.x.len(), self.agents.y.len()]
    }

    fn observe(&mut self, world: &W) {
        let Agents { spec, x, .. } = &mut self.agents;
        self.setup.equipment.sense(&spec.sensors, world, x);
    }

    fn observation(&self) -> &[f32] {
        &self.agents.x
    }

    fn actuate(&mut self, action: &[f32], world: &mut W) {
        self.agents.choose(action);
        self.setup.equipment.drive(&self.agents.spec.motors, &self.agents.y, world);
    }

    fn earned(&self) -> f64 {
        self.agents.ledger.earned()
    }

    fn is_truncated(&self, world: &W) -> bool {
        self.agents.ledger.is_truncated() && !self.has_event(world)
    }
}
