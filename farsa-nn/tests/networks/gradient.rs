//! Gradients against finite differences, the run against the network, optimizers against their formulas, and what is learned.
#![cfg(feature = "alloc")]

use farsa_nn::fault::{ParameterFault, Slice};
use farsa_nn::learning::{Adam, Demonstration, Gradient, Learner, Loss, Momentum, Optimizer};
use farsa_nn::{Controller, Error, Leak, LeakyLayout, LeakyNetwork, LeakyParameter};
use farsa_num::{Digest, Domain, Stream};
use proptest::prelude::*;

const LOSSES: [Loss; 2] = [Loss::SquaredError, Loss::CrossEntropy];

#[derive(Clone, Debug)]
struct Case {
    layout: LeakyLayout,
    parameters: Vec<f64>,
    x: Vec<f32>,
    wanted: Vec<f32>,
}

impl Case {
    fn demonstration(&self) -> Demonstration<'_> {
        Demonstration { x: &self.x, wanted: &self.wanted }
    }
}

prop_compose! {
    fn any_case()(n in 0..5_usize, h in 0..6_usize, o in 1..5_usize, ticks in 0..9_usize, slope in 0.1_f32..1.5)(
        parameters in prop::collection::vec(0.0_f64..1.0, LeakyLayout::new(n, h, o).parameter_count()),
        x in prop::collection::vec(-3.0_f32..3.0, n * ticks),
        wanted in prop::collection::vec(0.0_f32..=1.0, o * ticks),
        layout in Just(LeakyLayout::new(n, h, o).with_slope(slope)),
    ) -> Case {
        let parameters = parameters.iter().zip(layout.kinds());
        let decoded = parameters.map(|(p, kind)| if kind == LeakyParameter::Leak { *p } else { 6.0 * p - 3.0 });
        Case { layout, parameters: decoded.collect(), x, wanted }
    }
}

proptest! {
    #[test]
    fn equals_finite_differences(case in any_case()) {
        const STEP: f64 = 1e-5;
        for (leak, loss) in Leak::ALL.into_iter().flat_map(|leak| LOSSES.map(|loss| (leak, loss))) {
            let mut gradient = Gradient::<f64>::new(case.layout, leak, loss)?;
            let cost = gradient.add(&case.parameters, case.demonstration())?;
            prop_assert!(cost >= -1e-12);
            prop_assert_eq!(gradient.cost(&case.parameters, case.demonstration())?, cost);
            let exact = gradient.sum().to_vec();
            for (index, exact) in exact.iter().enumerate() {
                let mut cost_at = |by: f64| {
                    let mut parameters = case.parameters.clone();
                    parameters[index] += by;
                    gradient.cost(&parameters, case.demonstration())
                };
                let difference = (cost_at(STEP)? - cost_at(-STEP)?) / (2.0 * STEP);
                let kind = case.layout.kind(index);
                prop_assert!((difference - exact).abs() < 1e-5, "{} {:?} {:?}: {} is not {}", leak, loss, kind, exact, difference);
            }
        }
    }

    /// The forward run has the bits of the network, and single precision is near double.
    #[test]
    fn costs_what_the_network_does(case in any_case()) {
        let single: Vec<f32> = case.parameters.iter().map(|p| *p as f32).collect();
        for leak in Leak::ALL {
            let mut network = LeakyNetwork::new(case.layout, leak, &single, vec![0.0; case.layout.state_len()])?;
            let (n, o) = (case.layout.sensors(), case.layout.outputs());
            let mut expected = 0.0_f32;
            let mut y = vec![0.0; o];
            for (tick, wanted) in case.wanted.chunks(o).enumerate() {
                network.step(&case.x[n * tick..n * (tick + 1)], &mut y);
                y.iter().zip(wanted).for_each(|(y, wanted)| expected += (y - wanted) * (y - wanted));
            }
            let mut gradient = Gradient::<f32>::new(case.layout, leak, Loss::SquaredError)?;
            let cost = gradient.add(&single, case.demonstration())?;
            prop_assert_eq!(cost.to_bits(), expected.to_bits());
            let mut double = Gradient::<f64>::new(case.layout, leak, Loss::SquaredError)?;
            double.add(&single.iter().map(|p| f64::from(*p)).collect::<Vec<_>>(), case.demonstration())?;
            for (a, b) in gradient.sum().iter().zip(double.sum()) {
                prop_assert!((f64::from(*a) - b).abs() < 1e-4, "{} is not {}", a, b);
            }
        }
    }

    /// Demonstrations add up, and each starts at rest.
    #[test]
    fn demonstrations_add_up(case in any_case()) {
        let mut twice = Gradient::<f64>::new(case.layout, Leak::Filter, Loss::SquaredError)?;
        let mut once = twice.clone();
        let cost = once.add(&case.parameters, case.demonstration())?;
        twice.add(&case.parameters, case.demonstration())?;
        twice.add(&case.parameters, case.demonstration())?;
        prop_assert!(once.sum().iter().zip(twice.sum()).all(|(a, b)| (2.0 * a - b).abs() < 1e-12));
        prop_assert!((twice.mean_cost() - once.mean_cost()).abs() < 1e-12);
        prop_assert!((once.mean_cost() * case.wanted.len() as f64 - cost).abs() < 1e-12);
        once.clear();
        prop_assert!(once.sum().iter().all(|g| *g == 0.0) && once.mean_cost() == 0.0 && once.ticks() == 0);
    }

    /// Adam and momentum against their sources' formulas with powers.
    #[test]
    fn optimizers_follow_their_formulas(gradients in prop::collection::vec(-2.0_f64..2.0, 1..9)) {
        let adam = Adam { rate: 0.01, decays: [0.8, 0.95], epsilon: 1e-8 };
        let (mut p, mut memory) = ([1.0], vec![0.0; Optimizer::<f64>::memory_len(&adam, 1)]);
        let (mut m, mut v, mut expected) = (0.0, 0.0, 1.0);
        let plain = Momentum { rate: 0.1, momentum: 0.7 };
        let (mut q, mut velocity) = ([1.0], [0.0]);
        for (t, g) in gradients.iter().enumerate() {
            adam.step(&[*g], &mut p, &mut memory);
            m = 0.8 * m + 0.2 * g;
            v = 0.95 * v + 0.05 * g * g;
            let power = |beta: f64| (0..=t).fold(1.0, |power, _| power * beta);
            expected -= 0.01 * (m / (1.0 - power(0.8))) / ((v / (1.0 - power(0.95))).sqrt() + 1e-8);
            prop_assert!((p[0] - expected).abs() < 1e-9, "{} is not {}", p[0], expected);
            plain.step(&[*g], &mut q, &mut velocity);
        }
        // Every gradient counts with all powers of the momentum since.
        let late = |t: usize| (0..gradients.len() - t).fold((0.0, 1.0), |(sum, power), _| (sum + power, power * 0.7)).0;
        let moved: f64 = gradients.iter().enumerate().map(|(t, g)| 0.1 * g * late(t)).sum();
        prop_assert!((q[0] - (1.0 - moved)).abs() < 1e-9);
    }
}

/// A flag is visible for one tick and required later, so the network needs memory.
fn flags() -> Vec<(Vec<f32>, Vec<f32>)> {
    let flag = |shown: f32, ticks: usize| {
        let x = (0..ticks).flat_map(|tick| [if tick == 0 { shown } else { 0.0 }, 1.0]).collect();
        (x, vec![shown; ticks])
    };
    [(0.0, 12), (1.0, 12), (0.0, 7), (1.0, 7)].map(|(shown, ticks)| flag(shown, ticks)).to_vec()
}

fn learner<O: Optimizer<f64>>(leak: Leak, optimizer: O) -> Learner<f64, O> {
    const LAYOUT: LeakyLayout = LeakyLayout::new(2, 5, 1).with_slope(1.0);
    let mut draw = Stream::new(5, Domain::InitialGenome, 0, 0, 0);
    let start =
        LAYOUT.kinds().map(|kind| if kind == LeakyParameter::Leak { 0.5 } else { f64::from(draw.range(-1.0, 1.0)) });
    Learner::new(LAYOUT, leak, Loss::CrossEntropy, start.collect(), optimizer).expect("valid")
}

fn learn<O: Optimizer<f64>>(learner: &mut Learner<f64, O>, steps: usize) -> f64 {
    let flags = flags();
    let mut cost = f64::NAN;
    for _ in 0..steps {
        let all = flags.iter().map(|(x, wanted)| Demonstration { x, wanted });
        cost = learner.learn(all).expect("whole ticks");
    }
    cost
}

#[test]
fn a_memory_is_learned_by_every_reading_and_both_optimizers() {
    for leak in Leak::ALL {
        let mut adam = learner(leak, Adam::new(0.03)).with_limit(8.0).with_max_gradient_norm(1.0);
        let (first, last) = (learn(&mut adam, 1), learn(&mut adam, 1500));
        let mut momentum =
            learner(leak, Momentum { rate: 0.5, momentum: 0.9 }).with_limit(8.0).with_max_gradient_norm(1.0);
        let plain = learn(&mut momentum, 1500);
        println!("{leak:>8}: {first:.3} falls to {last:.5} by Adam, to {plain:.5} by momentum");
        assert!(first > 0.5 && last < 0.02 && plain < 0.02, "{leak}: {first} {last} {plain}");
        // The network itself does it, from the rounded parameters.
        let single: Vec<f32> = adam.parameters().iter().map(|p| *p as f32).collect();
        let layout = LeakyLayout::new(2, 5, 1).with_slope(1.0);
        let mut network =
            LeakyNetwork::new(layout, leak, single, vec![0.0; layout.state_len()]).expect("leaks in [0, 1]");
        for (x, wanted) in flags() {
            network.reset();
            let mut y = [0.0];
            x.chunks(2).for_each(|x| network.step(x, &mut y));
            assert!((y[0] - wanted[0]).abs() < 0.2, "{leak}: {} for {}", y[0], wanted[0]);
        }
    }
}

/// The divergence of targets and outputs, zero where both are the same.
#[test]
fn cross_entropy_costs_the_divergence_from_what_is_wanted() {
    let layout = LeakyLayout::new(0, 0, 1).with_slope(1.0);
    let mut gradient = Gradient::<f64>::new(layout, Leak::Filter, Loss::CrossEntropy).expect("valid");
    for bias in [-1.5_f32, 0.0, 0.7] {
        let parameters = vec![bias; layout.parameter_count()];
        let mut network =
            LeakyNetwork::new(layout, Leak::Filter, &parameters[..], vec![0.0; layout.state_len()]).expect("valid");
        let mut y = [0.0];
        network.step(&[], &mut y);
        let motor = f64::from(y[0]);
        for wanted in [0.0, 0.25, y[0], 1.0] {
            let parameters: Vec<f64> = parameters.iter().map(|p| f64::from(*p)).collect();
            let cost = gradient.cost(&parameters, Demonstration { x: &[], wanted: &[wanted] }).expect("a tick");
            let part = |p: f64, q: f64| if p > 0.0 { p * farsa_num::ln(p / q) } else { 0.0 };
            let p = f64::from(wanted);
            let expected = part(p, motor) + part(1.0 - p, 1.0 - motor);
            assert!((cost - expected).abs() < 1e-6, "{bias} {wanted}: {cost} is not {expected}");
        }
    }
}

/// The cost before the next step of learning. For demonstrations of several lengths it is the mean over all ticks.
#[test]
fn a_cost_is_computed_without_learning() {
    let flags = flags();
    let mut learner = learner(Leak::Filter, Adam::new(0.03));
    learn(&mut learner, 20);
    let before = learner.parameters().to_vec();
    let costs: Vec<f64> =
        flags.iter().map(|(x, wanted)| learner.cost([Demonstration { x, wanted }]).expect("whole ticks")).collect();
    let all = learner.cost(flags.iter().map(|(x, wanted)| Demonstration { x, wanted })).expect("whole ticks");
    let mean = (12.0 * (costs[0] + costs[1]) + 7.0 * (costs[2] + costs[3])) / 38.0;
    assert!(costs.iter().all(|cost| *cost > 0.0) && (all - mean).abs() < 1e-12, "{costs:?} {all}");
    assert_eq!((learner.cost([]), learner.parameters()), (Ok(0.0), &before[..]));
    assert!((learn(&mut learner, 1) - all).abs() < 1e-12);
}

#[test]
fn weights_and_biases_reach_their_limit_and_stay_within() {
    let largest = |learner: &Learner<f64, Adam>| {
        let leaks = LeakyLayout::new(2, 5, 1).range(LeakyParameter::Leak).start;
        learner.parameters()[..leaks].iter().fold(0.0, |most: f64, w| most.max(w.abs()))
    };
    for limit in [1.5, 3.0] {
        let mut free = learner(Leak::Filter, Adam::new(0.1));
        let mut kept = free.clone().with_limit(limit);
        let mut reached = false;
        for _ in 0..200 {
            learn(&mut kept, 1);
            assert!(largest(&kept) <= limit, "{} of {limit}", largest(&kept));
            reached |= largest(&kept) == limit;
        }
        learn(&mut free, 200);
        assert!(reached && largest(&free) > limit, "{limit}: {reached}, without it {}", largest(&free));
    }
}

/// A step of plain descent is the gradient itself.
#[test]
fn long_gradients_are_shortened_and_short_ones_are_not() {
    let descent = Momentum { rate: 1.0, momentum: 0.0 };
    let start = learner(Leak::Filter, descent);
    let step = |mut learner: Learner<f64, Momentum>| -> Vec<f64> {
        learn(&mut learner, 1);
        learner.parameters().iter().zip(start.parameters()).map(|(p, start)| p - start).collect()
    };
    let length = |step: &[f64]| step.iter().map(|d| d * d).sum::<f64>().sqrt();
    let free = step(start.clone());
    assert!(length(&free) > 0.02, "{}", length(&free));
    let shortened = step(start.clone().with_max_gradient_norm(0.01));
    assert!((length(&shortened) - 0.01).abs() < 1e-12, "{}", length(&shortened));
    for (short, long) in shortened.iter().zip(&free) {
        assert!((short - long * 0.01 / length(&free)).abs() < 1e-12, "{short} of {long}");
    }
    assert_eq!(step(start.clone().with_max_gradient_norm(1.01 * length(&free))), free);
}

#[test]
fn learning_goes_on_where_it_stopped() -> Result<(), Error> {
    let mut whole = learner(Leak::Filter, Adam::new(0.03));
    learn(&mut whole, 60);
    let mut first = learner(Leak::Filter, Adam::new(0.03));
    learn(&mut first, 25);
    let state: Vec<f64> = first.state().collect();
    let mut second = learner(Leak::Filter, Adam::new(0.03));
    assert_eq!(
        second.set_state(&state[1..]),
        Err(Error::Length { slice: Slice::State, expected: state.len(), found: state.len() - 1 })
    );
    let mut broken = state.clone();
    broken[3] = f64::NAN;
    assert_eq!(second.set_state(&broken), Err(Error::Parameter { index: 3, fault: ParameterFault::NotFinite }));
    second.set_state(&state)?;
    learn(&mut second, 35);
    assert!(whole.state().eq(second.state()));
    let mut digest = Digest::new();
    digest.add_f64s(whole.parameters());
    assert_eq!(digest.finish(), 0x5F88_50F8_9B84_51F9, "{:#018x}", digest.finish());
    Ok(())
}

/// Against the sum over all steps, of which the latest counts 1 and each before it a factor of 1 - 1/steps less.
#[test]
fn a_mean_is_that_of_the_latest_steps() -> Result<(), Error> {
    let mut averaged = learner(Leak::Filter, Adam::new(0.03)).with_averaging(5);
    assert_eq!(averaged.mean(), averaged.parameters());
    let mut steps: Vec<Vec<f64>> = Vec::new();
    for _ in 0..40 {
        learn(&mut averaged, 1);
        steps.push(averaged.parameters().to_vec());
        for (index, mean) in averaged.mean().iter().enumerate() {
            let (mut sum, mut weights, mut weight) = (0.0, 0.0, 1.0);
            for step in steps.iter().rev() {
                sum += weight * step[index];
                weights += weight;
                weight *= 0.8;
            }
            assert!((mean - sum / weights).abs() < 1e-12, "{mean} is not {}", sum / weights);
        }
    }
    // It does not change learning, and resumes at the same state.
    let mut plain = learner(Leak::Filter, Adam::new(0.03));
    learn(&mut plain, 40);
    assert_eq!(plain.parameters(), averaged.parameters());
    assert_eq!(plain.mean(), plain.parameters());
    let state: Vec<f64> = averaged.state().collect();
    assert_eq!(
        plain.set_state(&state),
        Err(Error::Length { slice: Slice::State, expected: plain.state().count(), found: state.len() })
    );
    let mut second = learner(Leak::Filter, Adam::new(0.03)).with_averaging(5);
    second.set_state(&state)?;
    learn(&mut second, 3);
    learn(&mut averaged, 3);
    assert!(second.state().eq(averaged.state()));
    // A mean over one step is that step up to rounding. One over more steps than taken is the plain mean.
    let mut latest = learner(Leak::Filter, Adam::new(0.03)).with_averaging(0);
    learn(&mut latest, 40);
    assert!(latest.mean().iter().zip(latest.parameters()).all(|(mean, p)| (mean - p).abs() < 1e-15));
    let mut all = learner(Leak::Filter, Adam::new(0.03)).with_averaging(u32::MAX);
    learn(&mut all, 40);
    for (index, mean) in all.mean().iter().enumerate() {
        let plain = steps.iter().map(|step| step[index]).sum::<f64>() / 40.0;
        assert!((mean - plain).abs() < 1e-6, "{mean} is not {plain}");
    }
    Ok(())
}

#[test]
fn demonstrations_of_other_shapes_are_refused() -> Result<(), Error> {
    let layout = LeakyLayout::new(2, 1, 3);
    let mut gradient = Gradient::<f64>::new(layout, Leak::Filter, Loss::SquaredError)?;
    let parameters = vec![0.0; layout.parameter_count()];
    let shape = |values, wanted| Error::Demonstration { values, sensors: 2, wanted, outputs: 3 };
    for (values, wanted) in [(3, 3), (2, 2), (4, 3), (0, 3), (2, 0)] {
        let (x, w) = (vec![0.0; values], vec![0.0; wanted]);
        let refused = gradient.add(&parameters, Demonstration { x: &x, wanted: &w });
        assert_eq!(refused, Err(shape(values, wanted)));
    }
    let none = Demonstration { x: &[], wanted: &[] };
    assert_eq!(gradient.add(&parameters, none), Ok(0.0));
    assert_eq!(
        gradient.add(&parameters[1..], none),
        Err(Error::Length { slice: Slice::Parameters, expected: 8, found: 7 })
    );
    assert!(Gradient::<f64>::new(layout.with_slope(f32::NAN), Leak::Filter, Loss::SquaredError).is_err());
    let learner = Learner::new(layout, Leak::Filter, Loss::SquaredError, vec![2.0; 8], Adam::new(0.1));
    assert_eq!(learner.err(), Some(Error::Parameter { index: 7, fault: ParameterFault::Leak(2.0) }));
    Ok(())
}
