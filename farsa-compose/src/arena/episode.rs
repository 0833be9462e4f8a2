//! An episode of robots in an arena.

use crate::arena::ArenaWorld;
use farsa_body::ports::BodyId;
use farsa_body::robot::Robot;
use farsa_body::{Pose, Recorder};
use farsa_lab::advanced::{ExternalControl, seconds};
use farsa_lab::{Episode, EpisodeId};
use farsa_nn::Controller as _;
use farsa_num::{Domain, Stream};
use farsa_view::{Channel, Schema};

use crate::arena::field::Field;
use crate::arena::registered::PartOfPlanar;
use crate::arena::scene::Scene;
use crate::arena::setup::Setup;
use crate::arena::term::Term;
use crate::check::source::Source;
use crate::composed_task::Body;
use crate::document::Document;
use crate::part::moment::Stock;
use crate::part::{Moment, PartScene};
use crate::parts::agents::Agents;
use crate::parts::network_spec::NetworkSpec;
use crate::parts::noise_streams::NoiseStreams;
use crate::parts::tally::Tally;
use crate::sensors::infrared::InfraredSensor;

/// Robots in a trial, each with a copy of one network.
#[derive(Clone, Debug)]
pub(crate) struct ArenaEpisode {
    setup: Setup,
    agents: Agents,
    /// Current poses.
    poses: Vec<Pose>,
    /// True if a term has a state that each step updates.
    has_state: bool,
    /// Terms of each step, and terms of the last step only.
    measured: [Vec<usize>; 2],
}

impl ArenaEpisode {
    pub(crate) fn new(setup: Setup, agents: Agents) -> Self {
        let robots = setup.members.len();
        let of_time = |late| {
            let tallies = agents.ledger.tallies.iter().enumerate();
            tallies.filter(|(_, tally)| tally.late == late).map(|(number, _)| number).collect()
        };
        Self {
            measured: [false, true].map(of_time),
            poses: vec![Pose::planar([0.0; 2], 0.0); robots],
            has_state: setup.terms.iter().any(Term::has_state),
            setup,
            agents,
        }
    }

    pub(crate) fn scene(&self) -> &Scene {
        &self.setup.scene
    }

    /// Returns the path of the last placement of these bodies in the document, or of a thing or robot of this name.
    pub(crate) fn path_of(&self, bodies: impl Iterator<Item = BodyId>, name: &str) -> String {
        let document = &self.agents.document;
        let placed = bodies.filter_map(|body| self.setup.starting.rule_of(body));
        // Robots without a placement have one that the document does not list.
        if let Some(rule) = placed.filter(|rule| *rule < document.start.len()).max() {
            return format!("/start/{rule}");
        }
        let object = document.objects.iter().position(|object| object.name == name);
        object.map_or_else(|| "/start".into(), |index| format!("/objects/{index}"))
    }

    /// Places everything at its start.
    pub(crate) fn arrange<W: ArenaWorld>(
        &mut self,
        world: &mut W,
        id: EpisodeId,
    ) -> Result<(), farsa_physics::arena::ArenaError> {
        let Agents { document, size, present, .. } = &self.agents;
        let individual =
            if document.team.common_starts { id.individual % (*size).max(1) as u32 } else { id.individual };
        let mut stream = Stream::new(id.seed, Domain::Start, id.trial, individual, id.generation);
        self.setup.starting.arrange(world, &mut stream, *present)
    }

    /// Measures the terms of each step, or the late ones.
    #[inline(always)]
    fn measure<W: ArenaWorld>(&mut self, world: &W, late: bool) {
        let Self { setup: Setup { terms, foraging, members, .. }, agents, poses, measured, .. } = self;
        let Agents { document, spec, ledger, x, y, present, .. } = agents;
        let now = moment(document, spec, ledger.steps, [x, y], foraging.as_ref(), &poses[..*present]);
        for number in &measured[usize::from(late)] {
            let term = &terms[*number];
            // The mean of one robot is its value.
            let value = if members.len() == 1 {
                term.value(world, &now, 0)
            } else {
                mean(world, term, &ledger.tallies[*number], &now)
            };
            ledger.count(*number, value);
        }
    }

    /// Ends the trial and returns its reward.
    #[cold]
    fn conclude<W: ArenaWorld>(&mut self, world: &W) -> f64 {
        self.measure(world, true);
        self.agents.ledger.conclude()
    }

    /// Computes the current value of a late term.
    fn late_value<W: ArenaWorld>(&self, world: &W, number: usize) -> f64 {
        let Self { setup: Setup { terms, foraging, .. }, agents, poses, .. } = self;
        let Agents { document, spec, ledger, x, y, present, .. } = agents;
        let now = moment(document, spec, ledger.steps, [x, y], foraging.as_ref(), &poses[..*present]);
        let (term, tally) = (&terms[number], &ledger.tallies[number]);
        if term.is_of_team() {
            return term.value(world, &now, 0);
        }
        (0..*present).map(|robot| tally.share(robot, term.value(world, &now, robot))).sum::<f64>() / tally.robots()
    }

    /// Returns true for a robot that takes part and is not dead.
    fn is_alive(&self, robot: usize) -> bool {
        let field = self.setup.foraging.as_ref().map(|(_, field)| field);
        robot < self.agents.present && field.is_none_or(|field| field.robots()[robot].alive)
    }

    /// Returns true after an event that ends the trial early.
    #[inline(always)]
    fn has_event<W: ArenaWorld>(&self, world: &W) -> bool {
        let Self { setup: Setup { ends, ends_with_success, foraging, .. }, agents, poses, .. } = self;
        if ends.is_empty() {
            return false;
        }
        let Agents { document, spec, ledger, x, y, present, .. } = agents;
        let now = moment(document, spec, ledger.steps, [x, y], foraging.as_ref(), &poses[..*present]);
        let success = *ends_with_success && ledger.would_succeed();
        ends.iter().any(|end| world.ends(&**end, &now, success))
    }

    /// Reads all sensors before any motor acts. Dead robots do neither.
    #[inline(never)]
    fn act_as_team<W: ArenaWorld>(&mut self, world: &mut W) {
        let Setup { members, foraging, .. } = &mut self.setup;
        let Agents { spec: NetworkSpec { sensors, motors, inputs, outputs, .. }, networks, x, y, present, .. } =
            &mut self.agents;
        let (inputs, outputs) = (inputs.len(), outputs.len());
        let foragers = foraging.as_ref().map(|(_, field)| field.robots());
        let alive = |robot: usize| robot < *present && foragers.is_none_or(|foragers| foragers[robot].alive);
        for (robot, (member, x)) in members.iter_mut().zip(x.chunks_exact_mut(inputs)).enumerate() {
            if let Some(foragers) = foragers {
                let sensors = member.equipment.sensors.iter_mut();
                sensors.for_each(|sensor| sensor.kind_mut().feel(&foragers[robot]));
            }
            if alive(robot) {
                member.equipment.sense(sensors, world, x);
            } else {
                x.fill(0.0);
            }
        }
        let rows = x.chunks_exact(inputs).zip(y.chunks_exact_mut(outputs));
        for (robot, ((member, network), (x, y))) in members.iter_mut().zip(networks).zip(rows).enumerate() {
            if alive(robot) {
                network.step(x, y);
                member.equipment.drive(motors, y, world);
            } else {
                member.rest(motors, y, world);
            }
        }
    }
}

/// Returns the values that terms read.
#[inline(always)]
fn moment<'m>(
    document: &Document,
    spec: &NetworkSpec,
    steps: u32,
    [x, y]: [&'m [f32]; 2],
    foraging: Option<&'m (BodyId, Field)>,
    poses: &'m [Pose],
) -> Moment<'m> {
    Moment {
        steps,
        longest: document.episode.steps,
        time_step: document.world.time_step,
        poses,
        x,
        y,
        inputs: spec.inputs.len(),
        outputs: spec.outputs.len(),
        markers: &[],
        stock: foraging.map(|(_, field)| field as &dyn Stock),
    }
}

/// Computes the mean of a term over its robots.
fn mean<W: ArenaWorld>(world: &W, term: &Term, tally: &Tally, now: &Moment<'_>) -> f64 {
    if term.is_of_team() {
        return term.value(world, now, 0);
    }
    let mut value = 0.0;
    for robot in 0..now.poses.len() {
        let share = tally.share(robot, term.value(world, now, robot));
        // 0 + x would turn -0 into 0, so the sum starts with the first share.
        value = if robot == 0 { share } else { value + share };
    }
    // Shares outside the mean are 0, so the divisor is the number of robots in the mean.
    value / tally.robots()
}

impl Body for ArenaEpisode {
    fn agents(&self) -> &Agents {
        &self.agents
    }

    fn agents_mut(&mut self) -> &mut Agents {
        &mut self.agents
    }

    fn bodies(&self) -> Schema {
        let Setup { scene, foraging, .. } = &self.setup;
        let schema = Schema::from_arena(&farsa_physics::arena::Arena { size: Some(scene.size), ..scene.arena.clone() });
        match foraging {
            Some((_, field)) => field.shown_in(schema, &scene.robots.iter().collect::<Vec<_>>()),
            None => schema,
        }
    }

    /// Returns the pose channels of the recorded robot, and with food the energy and load of each robot.
    fn scalars(&self) -> Vec<Channel> {
        let foragers = self.setup.foraging.iter().flat_map(|(_, field)| field.channels());
        let pose = ["x [m]", "y [m]", "heading [rad]"].map(|name| Channel::new(name).group("place"));
        pose.into_iter().chain(foragers).collect()
    }

    fn robot(&self) -> Robot {
        self.setup.scene.robots[0].description()
    }

    fn in_scene(&self, robot: usize, call: &mut dyn FnMut(&PartScene<'_>)) {
        let source = Source::default();
        call(&PartScene::new(&PartOfPlanar {
            scene: &self.setup.scene,
            robot,
            files: None,
            rule: None,
            sensors: &[],
            path: "",
            source: &source,
        }));
    }
}

impl<W: ArenaWorld> Episode<W> for ArenaEpisode {
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        let arranged = self.arrange(world, id).is_ok();
        self.agents.begin(arranged);
        let Setup { members, terms, foraging, .. } = &mut self.setup;
        let mut streams = NoiseStreams::of_episode(id, self.agents.document.episode.steps);
        for (robot, member) in members.iter_mut().enumerate() {
            member.equipment.begin(&mut streams);
            self.poses[robot] = world.pose(member.parts.body);
        }
        if let Some((nest, field)) = foraging {
            let [x, y, _] = world.pose(*nest).position;
            field.begin([x, y].map(f64::from));
        }
        let Agents { document, spec, ledger, x, y, .. } = &self.agents;
        let now = moment(document, spec, ledger.steps, [x, y], foraging.as_ref(), &self.poses);
        for term in terms.iter_mut() {
            term.begin(world, &now);
        }
    }

    fn has_started(&self) -> bool {
        !self.agents.ledger.failed
    }

    #[inline]
    fn act(&mut self, world: &mut W) {
        let Setup { members, foraging, .. } = &mut self.setup;
        let Agents { spec, networks, x, y, .. } = &mut self.agents;
        if let ([member], [network], None) = (&mut members[..], &mut networks[..], foraging) {
            member.equipment.sense(&spec.sensors, world, x);
            network.step(x, y);
            member.equipment.drive(&spec.motors, y, world);
        } else {
            self.act_as_team(world);
        }
    }

    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.agents.ledger.steps += 1;
        let Self { setup, agents, poses, .. } = self;
        for (robot, (pose, member)) in poses.iter_mut().zip(&setup.members).enumerate() {
            *pose = world.pose(member.parts.body);
            if let Some((_, field)) = setup.foraging.as_mut().filter(|_| robot < agents.present) {
                field.step(robot, [0, 1].map(|k| f64::from(pose.position[k])));
            }
        }
        if self.has_state {
            let Setup { terms, foraging, .. } = &mut self.setup;
            let Agents { document, spec, ledger, x, y, .. } = &self.agents;
            let now = moment(document, spec, ledger.steps, [x, y], foraging.as_ref(), &self.poses);
            for term in terms.iter_mut() {
                term.step(world, &now);
            }
        }
        // Food changes before the terms are measured, so a delivery counts in the same step.
        self.measure(world, false);
        self.agents.ledger.count_conditions();
        (self.agents.ledger.is_over() || self.has_event(world)).then(|| self.conclude(world))
    }

    fn external(&mut self) -> Result<&mut dyn ExternalControl<W>, String> {
        self.agents.check_external()?;
        Ok(self)
    }

    /// Records the infrared rays: all of the recorded robot, of the others those with a hit. Dead robots have none.
    fn record_action(&self, world: &W, recorder: &mut dyn Recorder) {
        let inputs = self.agents.spec.inputs.len();
        let robots = self.setup.members.iter().zip(self.agents.x.chunks_exact(inputs)).enumerate();
        for (robot, (member, x)) in robots.filter(|(robot, _)| self.is_alive(*robot)) {
            for ([number, first], drawing) in &member.drawn {
                // Sensors in groups have fewer channels than rays.
                let infrared = member.equipment.sensors[*number].kind().infrared();
                let ring = infrared.and_then(InfraredSensor::ring);
                let x = ring.unwrap_or_else(|| &x[*first..*first + drawing.count()]);
                drawing.record(world.pose(member.parts.body), x, robot != self.agents.watched, recorder);
            }
        }
    }

    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        let Agents { document, spec, ledger, networks, x, y, watched: shown, .. } = &self.agents;
        let row = |count: usize| shown * count..(shown + 1) * count;
        recorder.sensors(&x[row(spec.inputs.len())]);
        recorder.neurons(networks[*shown].controller().activations());
        recorder.outputs(&y[row(spec.outputs.len())]);
        (0..self.setup.scene.bodies()).map(BodyId).for_each(|body| recorder.pose(body, world.pose(body)));
        let pose = world.pose(self.setup.members[*shown].parts.body);
        let [x, y, _] = pose.position.map(f64::from);
        let mut scalars = vec![x, y, f64::from(pose.heading())];
        if let Some((_, field)) = &self.setup.foraging {
            scalars.extend(field.scalars());
            field.record(0, recorder);
        }
        let tallies = ledger.shown().iter().enumerate();
        scalars.extend(tallies.map(
            |(number, tally)| {
                if tally.late { self.late_value(world, number) } else { tally.last }
            },
        ));
        scalars.push(ledger.earned());
        recorder.scalars(&scalars);
        recorder.tick(seconds(ledger.steps, document.world.time_step));
    }
}

/// Control of the only robot. A dead robot senses nothing and rests.
impl<W: ArenaWorld> ExternalControl<W> for ArenaEpisode {
    fn channels(&self) -> [usize; 2] {
        [self.agents.x.len(), self.agents.y.len()]
    }

    fn observe(&mut self, world: &W) {
        let alive = self.is_alive(0);
        let Setup { members, foraging, .. } = &mut self.setup;
        let Agents { spec, x, .. } = &mut self.agents;
        let Some(member) = members.first_mut() else { return };
        if let Some((_, field)) = foraging {
            let sensors = member.equipment.sensors.iter_mut();
            sensors.for_each(|sensor| sensor.kind_mut().feel(&field.robots()[0]));
        }
        if alive {
            member.equipment.sense(&spec.sensors, world, x);
        } else {
            x.fill(0.0);
        }
    }

    fn observation(&self) -> &[f32] {
        &self.agents.x
    }

    fn actuate(&mut self, action: &[f32], world: &mut W) {
        let alive = self.is_alive(0);
        if alive {
            self.agents.choose(action);
        }
        let Agents { spec, y, .. } = &mut self.agents;
        let Some(member) = self.setup.members.first_mut() else { return };
        if alive {
            member.equipment.drive(&spec.motors, y, world);
        } else {
            member.rest(&spec.motors, y, world);
        }
    }

    fn earned(&self) -> f64 {
        self.agents.ledger.earned()
    }

    fn is_truncated(&self, world: &W) -> bool {
        self.agents.ledger.is_truncated() && !self.has_event(world)
    }
}
