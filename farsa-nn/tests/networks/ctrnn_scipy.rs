//! The continuous-time network against scipy, see fixtures/README.md.

use farsa_nn::{Controller, Ctrnn, CtrnnLayout, Integrator};

/// The rows of this kind, in their order.
fn rows(kind: &str) -> Vec<Vec<f64>> {
    let text = include_str!("../fixtures/ctrnn.csv");
    let rows = text.lines().filter_map(|line| line.strip_prefix(kind)?.strip_prefix(','));
    rows.map(|row| row.split(',').map(|word| word.parse().expect("a number")).collect()).collect()
}

/// The largest distance from the states of the fixture.
fn distance(integrator: Integrator) -> f64 {
    let one = |kind: &str| rows(kind)[0][0];
    let neurons = one("neurons") as usize;
    let layout = CtrnnLayout::new(one("inputs") as usize, neurons, neurons).with_integrator(integrator);
    let parameters: Vec<f32> = rows("parameters")[0].iter().map(|p| *p as f32).collect();
    let mut network =
        Ctrnn::new(layout, one("time_step") as f32, parameters, vec![0.0; layout.state_len()]).expect("valid");
    let (mut outputs, mut most) = (vec![0.0; neurons], 0.0_f64);
    for (x, expected) in rows("x").into_iter().zip(rows("y")) {
        let x: Vec<f32> = x.into_iter().map(|x| x as f32).collect();
        for _ in 0..one("held") as usize {
            network.step(&x, &mut outputs);
        }
        for (y, expected) in network.states().iter().zip(expected) {
            most = most.max((f64::from(*y) - expected).abs());
        }
    }
    println!("{integrator}: {most:e}");
    most
}

#[test]
fn runge_kutta_is_where_scipy_is() {
    assert_eq!((rows("x").len(), rows("y").len()), (40, 40));
    assert!(distance(Integrator::RungeKutta4) <= 3e-6);
}

#[test]
fn the_first_order_is_near() {
    for integrator in [Integrator::Euler, Integrator::ExponentialEuler] {
        let distance = distance(integrator);
        assert!(distance > 1e-4 && distance < 2e-2, "{integrator}: {distance}");
    }
}
