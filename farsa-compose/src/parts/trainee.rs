//! A network that learns from the demonstrations of a file.

use std::ops::Range;
use std::sync::Arc;

use farsa_lab::advanced::{Iteration, Learner as LabLearner, OwnedNetwork};
use farsa_lab::{Error, Parameter};
use farsa_nn::block::BlockParameter;
use farsa_nn::learning::{Adam, Differentiable, Gradient, Learner, Loss};
use farsa_nn::{CtrnnParameter, LeakyParameter, Network};
use farsa_num::{Domain, Scalar, Stream};

use crate::check::source::Source;
use crate::document::{Document, Learning, LossName};
use crate::networks::blocks::BlocksNetwork;
use crate::networks::ctrnn::CtrnnNetwork;
use crate::networks::perceptron::PerceptronNetwork;
use crate::parts::lessons::{Lesson, lessons};
use crate::parts::network::AnyNetwork;
use crate::parts::network_spec::NetworkSpec;

/// A network with its demonstrations.
#[derive(Clone, Debug)]
pub(crate) struct Trainee {
    learning: Learning,
    lessons: Arc<[Lesson]>,
    network: AnyNetwork,
    /// Searched parameters.
    parameters: Arc<[Parameter]>,
    /// Largest magnitude of a weight.
    limit: f64,
}

/// Least and greatest first value of a leak: smaller ones make errors fade within few steps.
const FIRST_LEAKS: [f32; 2] = [0.2, 1.0];

/// Root mean squared error of motor values up to which a demonstration counts as reproduced.
const NEAR: f64 = 0.1;

/// A learner of any kind of network.
trait AnyLearner {
    fn state(&self) -> Vec<f64>;
    fn set_state(&mut self, state: &[f64]) -> Option<()>;
    /// Performs a gradient step.
    fn learn(&mut self, lessons: &[&Lesson]) -> Option<()>;
    /// Computes the root mean squared error of motor values, and the share of demonstrations with one of at most
    /// [`NEAR`].
    fn errors(&mut self, lessons: &[Lesson]) -> Option<(f64, f64)>;
}

struct OfKind<M> {
    learner: Learner<f64, Adam, M>,
    squares: Gradient<f64, M>,
}

impl<M: Differentiable> AnyLearner for OfKind<M> {
    fn state(&self) -> Vec<f64> {
        self.learner.state().collect()
    }

    fn set_state(&mut self, state: &[f64]) -> Option<()> {
        self.learner.set_state(state).ok()
    }

    fn learn(&mut self, lessons: &[&Lesson]) -> Option<()> {
        self.learner.learn(lessons.iter().map(|lesson| lesson.demonstration())).ok().map(|_| ())
    }

    fn errors(&mut self, lessons: &[Lesson]) -> Option<(f64, f64)> {
        let (mut sum, mut values, mut near) = (0.0, 0, 0_u32);
        for lesson in lessons {
            let squares = self.squares.cost(self.learner.parameters(), lesson.demonstration()).ok()?;
            near += u32::from(squares <= NEAR * NEAR * lesson.values() as f64);
            (sum, values) = (sum + squares, values + lesson.values());
        }
        Some((Scalar::sqrt(sum / values.max(1) as f64), f64::from(near) / lessons.len().max(1) as f64))
    }
}

impl Trainee {
    /// Builds the learner of a document, if it has the table `learning`.
    pub(crate) fn new(document: &Document, spec: &NetworkSpec, source: &Source) -> Result<Option<Self>, Error> {
        let Some(learning) = &document.learning else { return Ok(None) };
        if document.strategy.get("name").is_none_or(|name| name != "learning") {
            return Err(source.wrong("/learning", "is for the strategy `learning`"));
        }
        if !document.network.fixed.is_empty() || !document.network.shared.is_empty() {
            return Err(source.wrong("/network", "has fixed or shared parameters, which cannot be learned"));
        }
        let lessons = lessons(learning, &document.files, spec, source)?.into();
        let [low, high] = document.network.weights;
        let trainee = Self {
            learning: learning.clone(),
            lessons,
            network: spec.network.clone(),
            parameters: spec.searched.parameters().into(),
            limit: Scalar::max(low.abs(), high.abs()),
        };
        trainee.learner(0).map_err(|why| source.wrong("/learning", why))?;
        Ok(Some(trainee))
    }

    /// Creates a learner with first parameters of a seed, or explains why the network cannot learn.
    fn learner(&self, seed: u64) -> Result<Box<dyn AnyLearner>, String> {
        let mut draw = Stream::new(seed, Domain::InitialGenome, 0, 0, 0);
        let first = self.learning.first as f32;
        let mut weight = || draw.range(-first, first);
        let none = 0..0;
        if let Some(PerceptronNetwork { layer, .. }) = self.network.downcast() {
            let parameters = layer.parameters().iter().map(|_| weight()).collect();
            return self.of_kind(layer.clone(), parameters, none);
        }
        if let Some(network) = self.network.downcast::<OwnedNetwork>() {
            let kinds: Vec<LeakyParameter> = network.layout().kinds().collect();
            let mut parameters: Vec<f32> = kinds.iter().map(|_| weight()).collect();
            for (value, _) in parameters.iter_mut().zip(kinds).filter(|(_, kind)| *kind == LeakyParameter::Leak) {
                *value = draw.range(FIRST_LEAKS[0], FIRST_LEAKS[1]);
            }
            return self.of_kind(network.clone(), parameters, none);
        }
        if let Some(CtrnnNetwork { network, .. }) = self.network.downcast() {
            let layout = network.layout();
            let mut parameters: Vec<f32> = layout.kinds().map(|_| weight()).collect();
            parameters[layout.range(CtrnnParameter::Gain)].fill(1.0);
            // Gains are not searched, so time constants are the last searched parameters.
            let ends = self.parameters.last().map_or([1.0; 2], |parameter| parameter.ends);
            for value in &mut parameters[layout.range(CtrnnParameter::TimeConstant)] {
                *value = draw.range(ends[0] as f32, ends[1] as f32);
            }
            return self.of_kind(network.clone(), parameters, layout.range(CtrnnParameter::Gain));
        }
        if let Some(BlocksNetwork { network, .. }) = self.network.downcast() {
            let layout = network.layout();
            let mut parameters: Vec<f32> = layout.kinds().map(|_| weight()).collect();
            parameters[layout.range(BlockParameter::Gain)].fill(1.0);
            for value in &mut parameters[layout.range(BlockParameter::Leak)] {
                *value = draw.range(FIRST_LEAKS[0], FIRST_LEAKS[1]);
            }
            return self.of_kind(network.clone(), parameters, none);
        }
        Err("needs a network of the kinds perceptron, leaky, ctrnn, blocks or a layered one".into())
    }

    fn of_kind<M, S>(
        &self,
        mut network: Network<M, Vec<f32>, S>,
        parameters: Vec<f32>,
        frozen: Range<usize>,
    ) -> Result<Box<dyn AnyLearner>, String>
    where
        M: Differentiable + 'static,
        S: AsMut<[f32]>,
    {
        let wrong = |error: farsa_nn::Error| error.to_string();
        network.set_parameters(parameters).map_err(wrong)?;
        let loss = match self.learning.loss {
            LossName::SquaredError => Loss::SquaredError,
            LossName::CrossEntropy => Loss::CrossEntropy,
        };
        let learner = Learner::of(&network, loss, Adam::new(self.learning.rate)).map_err(wrong)?;
        let learner = learner.with_limit(self.limit).with_max_gradient_norm(1.0).with_frozen(frozen);
        let squares = Gradient::of(&network, Loss::SquaredError).map_err(wrong)?;
        Ok(Box::new(OfKind { learner, squares }))
    }
}

impl LabLearner for Trainee {
    fn initial_state(&self, seed: u64) -> Vec<f64> {
        self.learner(seed).map_or_else(|_| Vec::new(), |learner| learner.state())
    }

    fn iterate(&mut self, state: &mut [f64], seed: u64, generation: u32) -> Option<Iteration> {
        let mut learner = self.learner(seed).ok()?;
        learner.set_state(state)?;
        let (before, successes) = learner.errors(&self.lessons)?;
        let mut draw = Stream::new(seed, Domain::Network, 0, 0, generation);
        for _ in 0..self.learning.epochs {
            let mut order: Vec<&Lesson> = self.lessons.iter().collect();
            for end in (1..order.len()).rev() {
                // Fisher-Yates shuffle.
                order.swap(end, draw.below(end as u32 + 1) as usize);
            }
            for batch in order.chunks(self.learning.batch as usize) {
                learner.learn(batch)?;
            }
        }
        let (after, _) = learner.errors(&self.lessons)?;
        state.iter_mut().zip(learner.state()).for_each(|(value, new)| *value = new);
        Some(Iteration { before, after, successes })
    }

    fn learned(&self, state: &[f64]) -> Vec<f64> {
        let count = self.network.own_parameters().len().min(state.len());
        self.network.part().searched(&state[..count])
    }
}
