//! A network learns a delay by back-propagation through time: its output is to be its input of two ticks before.

use farsa::nn::block::{Architecture, BlockNetwork};
use farsa::nn::learning::{Adam, Demonstration, Learner, Loss};
use farsa::nn::{Error, Leak};
use farsa::num::Stream;

fn main() -> Result<(), Error> {
    let plan = Architecture::elman(1, 6, 1).plan();
    let mut stream = Stream::from_seed(1);
    let parameters: Vec<f32> = (0..plan.layout().parameter_count()).map(|_| stream.range(-1.0, 1.0)).collect();
    let network = BlockNetwork::new(plan.layout(), Leak::Filter, parameters, vec![0.0; plan.layout().state_len()])?;
    let mut learner: Learner<f64, _, _> = Learner::of(&network, Loss::CrossEntropy, Adam::new(0.02))?;
    let mut cost = f64::INFINITY;
    for step in 0..=2000 {
        let x: Vec<f32> = (0..40).map(|_| stream.below(2) as f32).collect();
        let wanted: Vec<f32> = [0.0, 0.0].iter().chain(&x).copied().take(40).collect();
        cost = learner.learn([Demonstration { x: &x, wanted: &wanted }])?;
        if step % 500 == 0 {
            println!("step {step}: cross entropy {cost:.4} per tick");
        }
    }
    assert!(cost < 0.01, "it has not learned");
    Ok(())
}
