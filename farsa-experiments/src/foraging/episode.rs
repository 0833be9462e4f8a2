//! An episode of `foraging`: robots carry food from a field to their nest, and must return to survive.

use farsa_body::ports::BodyId;
use farsa_body::sensors::ColorBand;
use farsa_body::{Pose, Recorder, Twist};
use farsa_compose::Field;
use farsa_nn::Controller;
use farsa_num::{Domain, Stream};
use farsa_physics::arena::{Arena, ArenaError};

use crate::foraging::config::ForagingConfig;
use crate::team::config::TeamConfig;
use crate::team::episode::{Moment, Scenario, TeamEpisode};
use crate::team::nest::{COLORS, on_nest};
use crate::team::robots::{OUTPUTS, Team};
use crate::team::task::{eye_groups, eye_names};
use farsa_lab::advanced::{
    Behavior, ChannelGroup, Intervention, Interventions, NotedBehavior, PlanarWorld, Protocol, input_ranges,
};
use farsa_lab::{EpisodeId, Error, Note, Outcome};
use farsa_view::{Channel, Schema};

/// Robots that forage, with a controller each, and the record of their food and energy.
///
/// A controller reads 8 infrared channels, the camera's (for each sector red, then blue), 1 in the nest or 0, and its energy. Its
/// outputs are those of [`Team`]. The dead rest in the dark.
pub type ForagingEpisode<C> = TeamEpisode<ForagingScenario, C>;

impl<C: Controller> ForagingEpisode<C> {
    /// An episode with these controllers, one for each robot.
    ///
    /// # Errors
    /// The errors of [`Team::new`].
    pub fn new(config: ForagingConfig, controllers: Vec<C>) -> Result<Self, Error> {
        Self::from_scenario(ForagingScenario::new(config), controllers)
    }
}

/// A field with food and a nest, and the record of what each robot has.
#[derive(Clone, Debug)]
pub struct ForagingScenario {
    config: ForagingConfig,
    field: Field,
    nest: BodyId,
    /// Robots that take part: all but in the cases of `team-size`.
    present: usize,
}

impl ForagingScenario {
    /// A field of a configuration.
    pub fn new(config: ForagingConfig) -> Self {
        let TeamConfig { size, robots, .. } = config.team;
        let field = Field::new([size; 2], config.cells, config.cost, config.nest_radius, robots);
        Self { field, nest: config.arena().area(0), present: robots, config }
    }

    /// The configuration.
    pub fn config(&self) -> &ForagingConfig {
        &self.config
    }

    /// The sizes of a team that are tested: 1, 2, 4 and so on up to all.
    fn sizes(&self) -> Vec<usize> {
        let robots = self.config.team.robots;
        let doubled = std::iter::successors(Some(1_usize), |size| size.checked_mul(2));
        doubled.take_while(|size| *size < robots).chain([robots]).collect()
    }

    /// The record of food and energy.
    pub fn field(&self) -> &Field {
        &self.field
    }
}

/// Objectives and measures of an individual, for strategies that use more than its fitness.
static BEHAVIOUR: NotedBehavior = NotedBehavior {
    objectives: &[("energy at the end", 1.0)],
    descriptors: &[("energy at the end", [0.0, 1.0]), ("deaths", [0.0, 4.0])],
};

impl Scenario for ForagingScenario {
    fn robots(&self) -> &TeamConfig {
        &self.config.team
    }

    fn arena(&self) -> Arena {
        self.config.arena()
    }

    fn shape(&self) -> [usize; 2] {
        [self.config.inputs(), OUTPUTS]
    }

    fn colors(&self, _: usize) -> &'static [ColorBand] {
        &COLORS
    }

    fn crowded(&self) -> &'static str {
        "team.robots"
    }

    /// Puts the nest and then the robots somewhere, from the stream of [`Domain::Start`] of the id's trial, individual and
    /// generation.
    fn arrange<C: Controller, W: PlanarWorld>(
        &mut self,
        team: &Team<C>,
        world: &mut W,
        id: EpisodeId,
    ) -> Result<(), ArenaError> {
        let Self { config, field, nest, present } = self;
        let mut stream = Stream::new(id.seed, Domain::Start, id.trial, id.individual, id.generation);
        world.clear();
        let [low, high] = [config.nest_to_wall, config.team.size - config.nest_to_wall].map(|x| x as f32);
        let at = [0; 2].map(|_| stream.range(low, high.max(low)));
        world.place_body(*nest, Pose::planar(at, 0.0), Twist::default());
        world.finish_placement();
        field.begin(at.map(f64::from));
        team.scatter_some(world, Some((at, config.start_within as f32)), &mut stream, *present)
    }

    fn sense<W: PlanarWorld>(&self, world: &W, robot: usize, at: [f32; 2], rest: &mut [f32]) -> bool {
        if robot >= self.present {
            return false;
        }
        let forager = &self.field.robots()[robot];
        rest.copy_from_slice(&[on_nest(world, at), forager.energy as f32]);
        forager.alive
    }

    fn judge<W: PlanarWorld>(&mut self, _: &W, moment: Moment<'_>) -> bool {
        for (robot, at) in moment.places.iter().enumerate().take(self.present) {
            self.field.step(robot, at.map(f64::from));
        }
        // Nothing changes any more when all are dead.
        self.field.deaths() == self.present
    }

    /// `team-size` has fewer robots than evolved together, `senses` and `lesions` lack one of the senses or one hidden neuron,
    /// `noise` changes inputs.
    fn interventions(&self) -> Interventions {
        let trained = self.config.team.robots.to_string();
        let summary = "fewer robots than evolved together, without the others";
        let mut sizes = Protocol::from_list("team-size", summary, self.sizes().iter().map(ToString::to_string));
        sizes = sizes.with_axes("robots", "").with_held_out(|robots, _| robots != trained);
        let hidden = (0..self.config.team.hidden).map(|neuron| (format!("hidden neuron {}", neuron + 1), neuron));
        let senses = self.inputs();
        let cut = |(name, inputs)| (format!("no {name}"), Intervention::cut(inputs));
        Interventions::default()
            .with_protocol(sizes, Vec::new())
            .with_cases("senses", "one of the senses is cut", input_ranges(&senses).map(cut))
            .with_lesions(input_ranges(&senses), hidden)
            .with_noise(&[0.0, 0.05, 0.1, 0.2, 0.4])
    }

    fn begin_case(&mut self, case: Option<(&str, usize)>) {
        let size = case.filter(|(name, _)| *name == "team-size").and_then(|(_, case)| self.sizes().get(case).copied());
        self.present = size.unwrap_or(self.config.team.robots);
    }

    /// Pieces of food that the team carried to the nest.
    fn reward(&self, _: usize, _: Moment<'_>) -> f64 {
        f64::from(self.field.collected())
    }

    fn terms(&self) -> Vec<String> {
        vec!["food".into()]
    }

    fn outcome(&self, own: usize, moment: Moment<'_>) -> Outcome {
        let field = &self.field;
        let robots = self.present.max(1) as f64;
        let energy: f64 = field.robots().iter().take(self.present).map(|forager| forager.energy).sum();
        Outcome {
            terms: vec![self.reward(own, moment)],
            steps: moment.steps,
            success: field.deaths() == 0,
            notes: vec![
                ("food collected", Note::from(f64::from(field.collected()))),
                ("food carried at the end", Note::from(f64::from(field.carried()))),
                ("food lost with the dead", Note::from(f64::from(field.lost()))),
                ("deaths", Note::from(field.deaths() as f64)),
                ("energy at the end", Note::from(energy / robots)),
            ],
            ..Outcome::default()
        }
    }

    fn behavior(&self) -> Option<&dyn Behavior> {
        Some(&BEHAVIOUR)
    }

    fn input_names(&self) -> Vec<String> {
        let names = eye_names(self.config.team.sectors, &["red", "blue"]);
        names.into_iter().chain(["nest", "energy"].map(String::from)).collect()
    }

    fn inputs(&self) -> Vec<ChannelGroup> {
        let mut groups = eye_groups(&self.config.team, "red and blue", COLORS.len());
        groups.push(ChannelGroup::new("ground", 1, "1 in the nest, else 0"));
        groups.push(ChannelGroup::new("energy", 1, "1 in the nest .. 0 dead"));
        groups
    }

    fn channels(&self) -> Vec<Channel> {
        let food = ["collected", "lost", "left"].map(|name| Channel::new(name).group("fitness"));
        self.field.channels().into_iter().chain(food).collect()
    }

    fn scalars(&self, _: Moment<'_>) -> Vec<f64> {
        let field = &self.field;
        let food = [f64::from(field.collected()), f64::from(field.lost()), field.left() as f64];
        field.scalars().chain(food).collect()
    }

    fn shown_in(&self, schema: Schema) -> Schema {
        let arena = self.arena();
        self.field.shown_in(schema, &arena.robots.iter().map(|placed| &placed.robot).collect::<Vec<_>>())
    }

    fn record(&self, recorder: &mut dyn Recorder) {
        self.field.record(0, recorder);
    }
}
