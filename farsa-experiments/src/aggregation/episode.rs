//! An episode of `aggregation`: robots look for nests, and for each other.

use farsa_body::ports::BodyId;
use farsa_body::sensors::ColorBand;
use farsa_body::{Pose, Twist};
use farsa_nn::Controller;
use farsa_num::{Domain, Stream};
use farsa_physics::arena::{Arena, ArenaError};

use crate::aggregation::config::AggregationConfig;
use crate::aggregation::measure::{Gathering, mean_distances};
use crate::team::config::TeamConfig;
use crate::team::episode::{Moment, Scenario, TeamEpisode};
use crate::team::nest::{COLORS, on_nest};
use crate::team::robots::{OUTPUTS, Team, distance};
use crate::team::task::{eye_groups, eye_names};
use farsa_lab::advanced::{Behavior, ChannelGroup, NotedBehavior, PlanarWorld};
use farsa_lab::{EpisodeId, Error, Note, Outcome};
use farsa_view::Channel;

/// Robots that aggregate, with a controller each.
///
/// A controller reads 8 infrared channels, the camera's (for each sector red, then blue), and 1 on a nest or 0. Its outputs are
/// those of [`Team`].
pub type AggregationEpisode<C> = TeamEpisode<AggregationScenario, C>;

impl<C: Controller> AggregationEpisode<C> {
    /// An episode with these controllers, one for each robot.
    ///
    /// # Errors
    /// The errors of [`Team::new`].
    pub fn new(config: AggregationConfig, controllers: Vec<C>) -> Result<Self, Error> {
        Self::from_scenario(AggregationScenario::new(config), controllers)
    }
}

/// Nests, and which robots are on them.
#[derive(Clone, Debug)]
pub struct AggregationScenario {
    config: AggregationConfig,
    nests: Vec<BodyId>,
    /// On which nest each robot is.
    homes: Vec<Option<usize>>,
}

impl AggregationScenario {
    /// The nests of a configuration.
    pub fn new(config: AggregationConfig) -> Self {
        let arena = config.arena();
        let nests = (0..config.nests).map(|nest| arena.area(nest)).collect();
        Self { nests, homes: vec![None; config.team.robots], config }
    }

    /// The rewards of the team now for being on nests and for being near each other, means over its robots.
    pub fn rewards(&self, moment: Moment<'_>) -> [f64; 2] {
        let Self { config, homes, .. } = self;
        let robots = moment.places.len().max(1) as f64;
        let home = homes.iter().flatten().count() as f64 / robots;
        let diagonal = farsa_num::Scalar::sqrt(2.0 * config.team.size * config.team.size);
        let near: f64 = mean_distances(moment.places, diagonal).iter().map(|far| 1.0 - far).sum::<f64>() / robots;
        [config.nest_reward * home, config.near_reward * near]
    }

    /// Spread and clusters of the robots.
    pub fn gathering(&self, moment: Moment<'_>) -> Gathering {
        Gathering::new(moment.places, self.config.team.robot.radius)
    }

    /// On which nest each robot is.
    pub fn homes(&self) -> &[Option<usize>] {
        &self.homes
    }

    /// The configuration.
    pub fn config(&self) -> &AggregationConfig {
        &self.config
    }
}

/// Objectives and measures of an individual, for strategies that use more than its fitness.
static BEHAVIOUR: NotedBehavior = NotedBehavior {
    objectives: &[("dispersion", -1.0)],
    descriptors: &[("share on the fullest nest", [0.0, 1.0]), ("share in the largest cluster", [0.0, 1.0])],
};

impl Scenario for AggregationScenario {
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

    /// Puts the nests and then the robots somewhere, from the stream of [`Domain::Start`] of the id's trial, individual and
    /// generation.
    fn arrange<C: Controller, W: PlanarWorld>(
        &mut self,
        team: &Team<C>,
        world: &mut W,
        id: EpisodeId,
    ) -> Result<(), ArenaError> {
        const TRIES: u32 = 1000;
        let Self { config, nests, .. } = self;
        let mut stream = Stream::new(id.seed, Domain::Start, id.trial, id.individual, id.generation);
        world.clear();
        let [low, high] = [config.nest_to_wall, config.team.size - config.nest_to_wall].map(|x| x as f32);
        let apart = (2.0 * config.nest_to_wall) as f32;
        let mut taken: Vec<[f32; 2]> = Vec::new();
        for &nest in nests.iter() {
            let mut short = f32::INFINITY;
            let at = (0..TRIES).find_map(|_| {
                let at = [0; 2].map(|_| stream.range(low, high.max(low)));
                let lacks = taken.iter().fold(f32::NEG_INFINITY, |most, other| most.max(apart - distance(at, *other)));
                short = short.min(lacks);
                (lacks <= 0.0).then_some(at)
            });
            let radius = config.nest_radius as f32;
            let at = at.ok_or(ArenaError::NoFreePlace { tries: TRIES, radius, short })?;
            world.place_body(nest, Pose::planar(at, 0.0), Twist::default());
            taken.push(at);
        }
        world.finish_placement();
        team.scatter(world, None, &mut stream)
    }

    fn sense<W: PlanarWorld>(&self, world: &W, _: usize, at: [f32; 2], rest: &mut [f32]) -> bool {
        rest.copy_from_slice(&[on_nest(world, at)]);
        true
    }

    fn judge<W: PlanarWorld>(&mut self, world: &W, moment: Moment<'_>) -> bool {
        let Self { config, nests, homes } = self;
        let centre = |nest: &BodyId| {
            let [x, y, _] = world.pose(*nest).position;
            [x, y]
        };
        for (place, home) in moment.places.iter().zip(homes) {
            let near = |nest: &BodyId| distance(*place, centre(nest)) <= config.nest_radius as f32;
            *home = nests.iter().position(near);
        }
        false
    }

    /// The reward of the team if the trial ended now, the mean over its robots.
    fn reward(&self, _: usize, moment: Moment<'_>) -> f64 {
        let [nest, near] = self.rewards(moment);
        nest + near
    }

    fn terms(&self) -> Vec<String> {
        ["on a nest", "near the others"].map(String::from).to_vec()
    }

    fn outcome(&self, _: usize, moment: Moment<'_>) -> Outcome {
        let gathering = self.gathering(moment);
        let robots = self.homes.len().max(1) as f64;
        let on = |nest: usize| self.homes.iter().filter(|home| **home == Some(nest)).count();
        let fullest = (0..self.config.nests).map(on).max().unwrap_or(0);
        let home = self.homes.iter().flatten().count();
        Outcome {
            terms: self.rewards(moment).to_vec(),
            steps: moment.steps,
            success: home == self.homes.len(),
            notes: vec![
                ("share on a nest", Note::from(home as f64 / robots)),
                ("share on the fullest nest", Note::from(fullest as f64 / robots)),
                ("dispersion", Note::from(gathering.dispersion)),
                ("clusters", Note::from(gathering.clusters as f64)),
                ("share in the largest cluster", Note::from(gathering.largest as f64 / robots)),
            ],
            ..Outcome::default()
        }
    }

    fn behavior(&self) -> Option<&dyn Behavior> {
        Some(&BEHAVIOUR)
    }

    fn input_names(&self) -> Vec<String> {
        let names = eye_names(self.config.team.sectors, &["red", "blue"]);
        names.into_iter().chain(["nest".into()]).collect()
    }

    fn inputs(&self) -> Vec<ChannelGroup> {
        let mut groups = eye_groups(&self.config.team, "red and blue", COLORS.len());
        groups.push(ChannelGroup::new("ground", 1, "1 on a nest, else 0"));
        groups
    }

    fn channels(&self) -> Vec<Channel> {
        let places = ["robots on a nest", "dispersion", "clusters", "largest cluster"];
        let places = places.map(|name| Channel::new(name).group("place"));
        places.into_iter().chain([Channel::new("fitness now").group("fitness")]).collect()
    }

    fn scalars(&self, moment: Moment<'_>) -> Vec<f64> {
        let Gathering { dispersion, clusters, largest } = self.gathering(moment);
        let home = self.homes.iter().flatten().count() as f64;
        vec![home, dispersion, clusters as f64, largest as f64, self.reward(0, moment)]
    }
}
