//! An episode of robots in an arena.

use farsa_body::ports::{BodyId, PairId};
use farsa_body::robot::Robot;
use farsa_body::{Pose, Recorder};
use farsa_lab::{Episode, EpisodeId, PlanarWorld, seconds};
use farsa_nn::Controller as _;
use farsa_num::{Domain, Stream};
use farsa_view::{Channel, Schema};

use crate::arena::composition::Composition;
use crate::arena::meaning::{driven, sensed};
use crate::arena::term::{Numbers, Rows, Term};
use crate::composed::Embodied;
use crate::document::{Ending, MotorKind, SensorKind};
use crate::parts::agents::Agents;
use crate::parts::meaning::Meaning;
use crate::parts::tally::Tally;
use crate::parts::wiring::Wiring;
use crate::parts::wrapping::NOISE;

/// Robots, each with a copy of one network, in a trial.
#[derive(Clone, Debug)]
pub(crate) struct ArenaEpisode {
    composition: Composition,
    agents: Agents,
    /// Where each robot started, and where it was a step before [m].
    started: Vec<Pose>,
    before: Vec<[f64; 2]>,
    /// Where each is.
    poses: Vec<Pose>,
    /// Whether a term asks where robots were a step before.
    looks_back: bool,
    numbers: Vec<Numbers>,
}

impl ArenaEpisode {
    /// A trial of a composition.
    pub(crate) fn new(composition: Composition, agents: Agents) -> Self {
        let robots = composition.members.len();
        let time_step = agents.document.world.time_step;
        let numbers = composition.scene.robots.iter();
        let numbers =
            numbers.map(|robot| Numbers { wheel_speed: robot.max_wheel_speed, radius: robot.radius, time_step });
        Self {
            started: vec![Pose::planar([0.0; 2], 0.0); robots],
            before: vec![[0.0; 2]; robots],
            poses: vec![Pose::planar([0.0; 2], 0.0); robots],
            looks_back: composition.terms.iter().any(Term::looks_back),
            numbers: numbers.collect(),
            composition,
            agents,
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

    /// Measures the terms that are asked for after each step, or the late ones.
    #[inline(always)]
    fn measure<W: PlanarWorld>(&mut self, world: &W, late: bool) {
        if self.composition.moving {
            self.composition.terms.iter_mut().for_each(|term| term.locate(world));
        }
        for number in 0..self.composition.terms.len() {
            let Composition { members, terms, .. } = &self.composition;
            let (term, tally) = (&terms[number], &self.agents.ledger.tallies[number]);
            if tally.late != late {
                continue;
            }
            // Of one robot it is the mean itself.
            let value = if let ([member], [pose], [numbers]) = (&members[..], &self.poses[..], &self.numbers[..]) {
                term.quick(world, &member.parts, pose, numbers).unwrap_or_else(|| self.value(world, term, 0))
            } else {
                self.mean(world, term, tally)
            };
            self.agents.ledger.count(number, value);
        }
        if self.looks_back && !late {
            for (before, pose) in self.before.iter_mut().zip(&self.poses) {
                *before = [0, 1].map(|k| f64::from(pose.position[k]));
            }
        }
    }

    /// What a term measures of the robots that it is about, in the mean.
    fn mean<W: PlanarWorld>(&self, world: &W, term: &Term, tally: &Tally) -> f64 {
        let mut value = 0.0;
        let robots = self.composition.members.iter().zip(&self.poses).zip(&self.numbers);
        for (robot, ((member, pose), numbers)) in robots.enumerate() {
            let quick = term.quick(world, &member.parts, pose, numbers);
            let own = quick.unwrap_or_else(|| self.value(world, term, robot));
            let own = tally.share(robot, own);
            value = if robot == 0 { own } else { value + own };
        }
        value / tally.robots()
    }

    /// The end of a trial, and what it earned.
    #[cold]
    fn conclude<W: PlanarWorld>(&mut self, world: &W) -> f64 {
        self.measure(world, true);
        self.agents.ledger.conclude()
    }

    /// What a term measures of a robot.
    #[inline(never)]
    fn value<W: PlanarWorld>(&self, world: &W, term: &Term, robot: usize) -> f64 {
        let Self { composition, agents, started, before, poses, numbers, .. } = self;
        let (inputs, outputs) = (agents.wiring.inputs.len(), agents.wiring.outputs.len());
        let field = composition.foraging.as_ref().map(|(_, field)| field);
        let rows = Rows { x: &agents.x, y: &agents.y, inputs, outputs, started, before, poses, field };
        term.value(world, &composition.members[robot].parts, (&rows, robot), &numbers[robot])
    }

    /// What a late term is at now.
    fn late_value<W: PlanarWorld>(&self, world: &W, number: usize) -> f64 {
        let (term, tally) = (&self.composition.terms[number], &self.agents.ledger.tallies[number]);
        let robots = self.composition.members.len();
        (0..robots).map(|robot| tally.share(robot, self.value(world, term, robot))).sum::<f64>() / tally.robots()
    }

    /// All sense before any acts; the dead do neither.
    fn act_as_team<W: PlanarWorld>(&mut self, world: &mut W) {
        let Composition { members, foraging, .. } = &mut self.composition;
        let Agents { wiring: Wiring { sensors, motors, inputs, outputs, .. }, networks, x, y, .. } = &mut self.agents;
        let (inputs, outputs) = (inputs.len(), outputs.len());
        let foragers = foraging.as_ref().map(|(_, field)| field.robots());
        let alive = |robot: usize| foragers.is_none_or(|foragers| foragers[robot].alive);
        for (robot, (member, x)) in members.iter_mut().zip(x.chunks_exact_mut(inputs)).enumerate() {
            if let Some(foragers) = foragers {
                member.sensors.iter_mut().for_each(|sensor| sensor.feel(&foragers[robot]));
            }
            if alive(robot) {
                member.sense(sensors, world, x);
            } else {
                x.fill(0.0);
            }
        }
        let rows = x.chunks_exact(inputs).zip(y.chunks_exact_mut(outputs));
        for (robot, ((member, network), (x, y))) in members.iter_mut().zip(networks).zip(rows).enumerate() {
            if alive(robot) {
                network.step(x, y);
                member.drive(motors, y, world);
            } else {
                member.rest(motors, y, world);
            }
        }
    }
}

impl Embodied for ArenaEpisode {
    fn agents(&self) -> &Agents {
        &self.agents
    }

    fn agents_mut(&mut self) -> &mut Agents {
        &mut self.agents
    }

    fn bodies(&self) -> Schema {
        let Composition { scene, foraging, .. } = &self.composition;
        let schema = Schema::from_arena(&farsa_physics::arena::Arena { size: Some(scene.size), ..scene.arena.clone() });
        match foraging {
            Some((_, field)) => field.shown_in(schema, &scene.robots.iter().collect::<Vec<_>>()),
            None => schema,
        }
    }

    /// The pose of the robot that is recorded and, where there is food, the energy and the load of each.
    fn places(&self) -> Vec<Channel> {
        let foragers = self.composition.foraging.iter().flat_map(|(_, field)| field.channels());
        let pose = ["x [m]", "y [m]", "heading [rad]"].map(|name| Channel::new(name).group("place"));
        pose.into_iter().chain(foragers).collect()
    }

    fn robot(&self) -> Robot {
        self.composition.scene.robots[0].description()
    }

    fn sensed(&self, kind: &SensorKind, channel: usize, robot: usize) -> Meaning {
        sensed(kind, channel, &self.composition.scene.robots[robot])
    }

    fn driven(&self, kind: &MotorKind, channel: usize, robot: usize) -> Meaning {
        driven(kind, channel, &self.composition.scene.robots[robot])
    }
}

impl<W: PlanarWorld> Episode<W> for ArenaEpisode {
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        let arranged = self.arrange(world, id).is_ok();
        self.agents.begin(arranged);
        let Composition { members, terms, foraging, .. } = &mut self.composition;
        let streams = NOISE.map(|domain| Stream::new(id.seed, domain, id.trial, id.individual, id.generation));
        Composition::reseed(members, streams, self.agents.document.episode.steps);
        for (robot, member) in members.iter_mut().enumerate() {
            member.sensors.iter_mut().for_each(farsa_body::ports::Channels::reset);
            member.motors.iter_mut().for_each(farsa_body::ports::Channels::reset);
            self.started[robot] = world.pose(member.parts.body);
            self.before[robot] = [0, 1].map(|k| f64::from(self.started[robot].position[k]));
        }
        for term in terms {
            term.begin(world);
        }
        if let Some((nest, field)) = foraging {
            let [x, y, _] = world.pose(*nest).position;
            field.begin([x, y].map(f64::from));
        }
    }

    fn has_started(&self) -> bool {
        !self.agents.ledger.failed
    }

    #[inline]
    fn act(&mut self, world: &mut W) {
        let Composition { members, foraging, .. } = &mut self.composition;
        let Agents { wiring, networks, x, y, .. } = &mut self.agents;
        if let ([member], [network], None) = (&mut members[..], &mut networks[..], foraging) {
            member.sense(&wiring.sensors, world, x);
            network.step(x, y);
            member.drive(&wiring.motors, y, world);
        } else {
            self.act_as_team(world);
        }
    }

    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.agents.ledger.steps += 1;
        let Self { composition, poses, .. } = self;
        for (robot, (pose, member)) in poses.iter_mut().zip(&composition.members).enumerate() {
            *pose = world.pose(member.parts.body);
            if let Some((_, field)) = &mut composition.foraging {
                field.step(robot, [0, 1].map(|k| f64::from(pose.position[k])));
            }
        }
        self.measure(world, false);
        let Composition { members, foraging, .. } = &self.composition;
        let Agents { document, ledger, .. } = &self.agents;
        let ends = |ending: &Ending| match ending {
            Ending::Collision => members.iter().any(|member| world.touches(PairId(member.parts.body.0))),
            Ending::Success => ledger.would_succeed(),
            Ending::Death => foraging.as_ref().is_some_and(|(_, field)| field.deaths() == members.len()),
        };
        if !ledger.is_over() && !document.episode.ends.iter().any(ends) {
            return None;
        }
        Some(self.conclude(world))
    }

    /// Records the infrared rays: all of the first robot that evolves, of the others those that met something.
    fn record_action(&self, world: &W, recorder: &mut dyn Recorder) {
        let inputs = self.agents.wiring.inputs.len();
        for (robot, (member, x)) in self.composition.members.iter().zip(self.agents.x.chunks_exact(inputs)).enumerate()
        {
            for (first, drawing) in &member.drawn {
                let x = &x[*first..*first + drawing.count()];
                drawing.record(world.pose(member.parts.body), x, robot != self.agents.evolving[0], recorder);
            }
        }
    }

    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        let Agents { document, wiring, ledger, networks, x, y, evolving: [shown, _], .. } = &self.agents;
        let row = |count: usize| shown * count..(shown + 1) * count;
        recorder.sensors(&x[row(wiring.inputs.len())]);
        recorder.neurons(networks[*shown].controller().activations());
        recorder.outputs(&y[row(wiring.outputs.len())]);
        (0..self.composition.scene.bodies()).map(BodyId).for_each(|body| recorder.pose(body, world.pose(body)));
        let pose = world.pose(self.composition.members[*shown].parts.body);
        let [x, y, _] = pose.position.map(f64::from);
        let mut scalars = vec![x, y, f64::from(pose.heading())];
        if let Some((_, field)) = &self.composition.foraging {
            scalars.extend(field.scalars());
            field.record(0, recorder);
        }
        let tallies = ledger.tallies.iter().enumerate();
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
