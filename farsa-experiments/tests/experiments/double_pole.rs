//! `double-pole`: its equations of motion compared with others, its constants, its trials.

use farsa_experiments::double_pole::{Cart, CartEpisode, CartState, Config, DoublePole, Pole, layout};
use farsa_lab::advanced::Value;
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment as _, Settings};
use farsa_view::Recording;
use proptest::prelude::*;

fn evaluator(condition: &str, changes: &[(&str, Value)]) -> Box<dyn Evaluator> {
    let mut settings = Settings::new(DoublePole.settings(condition)).unwrap();
    for (key, value) in changes {
        settings.set("", key, value.clone()).unwrap();
    }
    DoublePole.prepare(condition, &settings).unwrap()
}

/// The accelerations from the mass matrix of Lagrange's equations in cart position and angles, solved by elimination.
#[allow(clippy::disallowed_methods)]
fn lagrange(cart: &Cart, state: &CartState, force: f64) -> [f64; 3] {
    let mut rows = [[0.0; 4]; 3];
    rows[0][0] = cart.mass;
    rows[0][3] = force - if state.velocity == 0.0 { 0.0 } else { cart.friction * state.velocity.signum() };
    for (i, pole) in cart.poles.iter().enumerate() {
        let (m, l, angle, speed) = (pole.mass, pole.half_length, state.angles[i], state.angular_velocities[i]);
        rows[0][0] += m;
        rows[0][3] += m * l * speed * speed * angle.sin();
        rows[0][i + 1] = m * l * angle.cos();
        rows[i + 1][0] = m * l * angle.cos();
        // A thin rod about its end.
        rows[i + 1][i + 1] = 4.0 / 3.0 * m * l * l;
        rows[i + 1][3] = m * cart.gravity * l * angle.sin() - pole.friction * speed;
    }
    for pivot in 0..3 {
        for row in 0..3 {
            if row != pivot {
                let factor = rows[row][pivot] / rows[pivot][pivot];
                let from = rows[pivot];
                rows[row].iter_mut().zip(from).for_each(|(x, from)| *x -= factor * from);
            }
        }
    }
    [rows[0][3] / rows[0][0], rows[1][3] / rows[1][1], rows[2][3] / rows[2][2]]
}

fn as_row(state: &CartState) -> [f64; 6] {
    let CartState { position, velocity, angles, angular_velocities } = *state;
    [position, velocity, angles[0], angular_velocities[0], angles[1], angular_velocities[1]]
}

fn of_row(row: [f64; 6]) -> CartState {
    let [position, velocity, a, b, c, d] = row;
    CartState { position, velocity, angles: [a, c], angular_velocities: [b, d] }
}

/// A step of the mid-point method, whose error is of another order and kind than Runge-Kutta's.
fn midpoint(cart: &Cart, row: [f64; 6], force: f64, time: f64) -> [f64; 6] {
    let rates = |row: [f64; 6]| {
        let [cart, first, second] = lagrange(cart, &of_row(row), force);
        [row[1], cart, row[3], first, row[5], second]
    };
    let by = |rates: [f64; 6], time: f64| core::array::from_fn(|i| row[i] + time * rates[i]);
    by(rates(by(rates(row), 0.5 * time)), time)
}

/// Kinetic and potential energy of cart and rods, from the velocities of their centers of mass [J].
#[allow(clippy::disallowed_methods)]
fn energy(cart: &Cart, state: &CartState) -> f64 {
    let mut energy = 0.5 * cart.mass * state.velocity * state.velocity;
    for (i, Pole { half_length: l, mass: m, .. }) in cart.poles.into_iter().enumerate() {
        let (angle, speed) = (state.angles[i], state.angular_velocities[i]);
        let across = state.velocity + l * speed * angle.cos();
        let down = l * speed * angle.sin();
        // A thin rod about its middle.
        let turning = m * (2.0 * l) * (2.0 * l) / 12.0;
        energy += 0.5 * m * (across * across + down * down) + 0.5 * turning * speed * speed;
        energy += m * cart.gravity * l * angle.cos();
    }
    energy
}

fn any_state() -> impl Strategy<Value = CartState> {
    let around = |most: f64| -most..most;
    (around(2.4), around(5.0), [around(1.5), around(1.5)], [around(10.0), around(10.0)]).prop_map(
        |(position, velocity, angles, angular_velocities)| CartState { position, velocity, angles, angular_velocities },
    )
}

fn any_cart() -> impl Strategy<Value = Cart> {
    let pole = || (0.05..1.0_f64, 0.01..0.5_f64, 0.0..0.01_f64);
    (0.2..3.0_f64, 0.0..0.1_f64, [pole(), pole()]).prop_map(|(mass, friction, poles)| {
        let poles = poles.map(|(half_length, mass, friction)| Pole { half_length, mass, friction });
        Cart { mass, friction, poles, ..Cart::default() }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn accelerations_are_those_of_lagranges_equations(cart in any_cart(), state in any_state(), force in -20.0..20.0_f64) {
        let (along, turning) = cart.accelerations(&state, force);
        let want = lagrange(&cart, &state, force);
        for (found, want) in [along, turning[0], turning[1]].into_iter().zip(want) {
            prop_assert!((found - want).abs() <= 1e-9 * want.abs().max(1.0), "{found} {want}");
        }
    }

    #[test]
    fn left_and_right_are_alike(state in any_state(), force in -20.0..20.0_f64) {
        let mirror = |state: CartState| of_row(as_row(&state).map(|x| -x));
        let cart = Cart::default();
        prop_assert_eq!(cart.step(&mirror(state), -force, 0.01), mirror(cart.step(&state, force, 0.01)));
    }

    #[test]
    fn without_friction_energy_is_the_work_of_the_force(state in any_state(), force in -10.0..10.0_f64) {
        let mut cart = Cart { friction: 0.0, ..Cart::default() };
        cart.poles.iter_mut().for_each(|pole| pole.friction = 0.0);
        let mut now = state;
        for _ in 0..2000 {
            now = cart.step(&now, force, 0.0005);
        }
        let gained = energy(&cart, &now) - energy(&cart, &state);
        let work = force * (now.position - state.position);
        prop_assert!((gained - work).abs() < 1e-6 * energy(&cart, &state).abs().max(1.0), "{gained} {work}");
    }
}

#[test]
fn a_trajectory_is_that_of_finer_steps_of_another_method() {
    let cart = Cart { friction: 0.0, ..Cart::default() };
    let start = CartState { angles: [0.07, -0.03], angular_velocities: [0.1, -0.2], velocity: 0.3, position: 0.1 };
    let (mut found, mut want) = (start, as_row(&start));
    for step in 0..15_u32 {
        let force = if step % 7 < 3 { 8.0 } else { -7.0 };
        found = cart.step(&found, force, 0.01);
        for _ in 0..1000 {
            want = midpoint(&cart, want, force, 1e-5);
        }
        let apart =
            as_row(&found).into_iter().zip(want).map(|(a, b)| (a - b).abs() / b.abs().max(1.0)).fold(0.0, f64::max);
        assert!(apart < 1e-4, "after {step} steps: {apart}, {found:?}");
    }
}

/// An error of the fourth order: half the step, a sixteenth of the error.
#[test]
fn halving_the_step_divides_the_error_by_sixteen() {
    let cart = Cart { friction: 0.0, ..Cart::default() };
    let start = CartState { angles: [0.3, 0.2], ..CartState::default() };
    let end = |steps: u32| {
        let mut state = start;
        (0..steps).for_each(|_| state = cart.step(&state, 5.0, 0.2 / f64::from(steps)));
        as_row(&state)
    };
    let exact = end(4096);
    let error = |steps| end(steps).into_iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let ratio = error(16) / error(32);
    assert!((13.0..19.0).contains(&ratio), "{ratio}");
}

#[test]
fn constants_are_those_published() {
    let Config { cart, time_step, substeps, steps, angle, most_angle, most_position, force, least_force, .. } =
        Config::new(true);
    assert_eq!((cart.mass, cart.friction, cart.gravity), (1.0, 0.0005, 9.8));
    let [long, short] = cart.poles;
    assert_eq!((long.half_length, long.mass, long.friction), (0.5, 0.1, 0.000_002));
    assert_eq!((short.half_length, short.mass, short.friction), (0.05, 0.01, 0.000_002));
    assert_eq!((time_step, substeps, steps), (0.01, 2, 100_000));
    assert_eq!((angle, most_angle, most_position, force, least_force), (4.0, 36.0, 2.4, 10.0, 0.0390625));
    for (condition, damping, inputs) in [("velocities", false, 6), ("no-velocities", true, 3)] {
        let settings = Settings::new(DoublePole.settings(condition)).unwrap();
        let velocities = condition == "velocities";
        let config = Config::read(velocities, &settings).unwrap();
        assert_eq!(config, Config { damping, ..Config::new(velocities) });
        let evaluator = evaluator(condition, &[]);
        assert_eq!(evaluator.info().parameters.len(), 2 * (inputs + 2));
        let description = evaluator.info().description;
        assert_eq!((description.steps, description.step_seconds), (100_000, 0.02));
    }
}

/// Left alone a pole falls as an inverted pendulum on a cart does: with small angles, as a hyperbolic cosine.
#[test]
#[allow(clippy::disallowed_methods)]
fn a_pole_that_is_left_alone_falls() {
    let mut cart = Cart { mass: 1e9, friction: 0.0, ..Cart::default() };
    cart.poles.iter_mut().for_each(|pole| pole.friction = 0.0);
    let mut state = CartState { angles: [1e-4, 1e-4], ..CartState::default() };
    (0..20).for_each(|_| state = cart.step(&state, 0.0, 0.01));
    for (angle, pole) in state.angles.into_iter().zip(cart.poles) {
        let want = 1e-4 * (0.2 * (0.75 * 9.8 / pole.half_length).sqrt()).cosh();
        assert!((angle / want - 1.0).abs() < 1e-4, "{angle} {want}");
    }
}

/// Weights of the output of a network without hidden neurons, with which it balances both poles.
const BALANCES: [f32; 7] = [-0.297, -3.755, 2.153, -2.036, -6.874, 1.465, 2.093];

fn outcome(evaluator: &mut dyn Evaluator, parameters: &[f32]) -> farsa_lab::Outcome {
    evaluator.evaluate(Evaluation::new(parameters, EpisodeId::default()), None)
}

#[test]
fn a_known_network_balances_both_poles() {
    let mut evaluator = evaluator("velocities", &[("net.hidden", Value::Whole(0))]);
    let outcome = outcome(evaluator.as_mut(), &BALANCES);
    assert!(outcome.success, "{outcome:?}");
    assert_eq!((outcome.steps, outcome.terms.as_slice()), (100_000, &[100_000.0][..]));
    // And from other starts.
    let config = Config { hidden: 0, steps: 1000, ..Config::new(true) };
    let mut episode = CartEpisode::new(config, BALANCES.to_vec()).unwrap();
    let mut balances = |start| {
        episode.place(start);
        while !episode.ended() {
            episode.step();
        }
        episode.succeeded()
    };
    let count = Config::generalization_starts().filter(|start| balances(*start)).count();
    assert!(count >= 200, "{count}");
}

#[test]
fn a_network_without_weights_pushes_least_and_fails() {
    for condition in ["velocities", "no-velocities"] {
        let mut evaluator = evaluator(condition, &[]);
        let parameters = vec![0.0; evaluator.info().parameters.len()];
        let outcome = outcome(evaluator.as_mut(), &parameters);
        assert!(!outcome.success && outcome.steps < 100, "{outcome:?}");
        if condition == "no-velocities" {
            assert_eq!(outcome.terms, [0.1 * f64::from(outcome.steps) / 1000.0, 0.0]);
        } else {
            assert_eq!(outcome.terms, [f64::from(outcome.steps)]);
        }
    }
    let mut episode = CartEpisode::new(Config::new(true), vec![0.0; 16]).unwrap();
    episode.step();
    assert_eq!(episode.force(), 10.0 / 256.0);
}

/// The damping fitness from its definition, over the states of the first 1000 steps.
#[test]
fn the_damping_fitness_is_that_of_its_definition() {
    let config = Config { hidden: 0, damping: true, ..Config::new(true) };
    let mut episode = CartEpisode::new(config, BALANCES.to_vec()).unwrap();
    let mut unrest: Vec<f64> = Vec::new();
    for step in 1..=1500_u32 {
        episode.step();
        let row = as_row(episode.state());
        unrest.push(row[..4].iter().map(|x| x.abs()).sum());
        let t = step.min(1000) as usize;
        let rest = if t < 100 { 0.0 } else { 0.9 * 0.75 / unrest[t - 100..t].iter().sum::<f64>() };
        let [balance, found] = episode.damping();
        assert!((balance - 0.1 * t as f64 / 1000.0).abs() < 1e-12);
        assert!((found - rest).abs() <= 1e-9 * rest, "{step}: {found} {rest}");
    }
}

#[test]
fn starts_of_the_generalization_test_are_spread() {
    let starts: Vec<[f64; 6]> = Config::generalization_starts().map(|start| as_row(&start)).collect();
    assert_eq!(starts.len(), 625);
    for (i, most) in [(0, 1.944), (1, 1.215), (2, 0.9 * 3.6_f64.to_radians()), (3, 0.9 * 8.6_f64.to_radians())] {
        let mut values: Vec<f64> = starts.iter().map(|start| start[i]).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        assert_eq!(values.len(), 5);
        assert!((values[4] - most).abs() < 1e-12 && (values[0] + most).abs() < 1e-12 && values[2].abs() < 1e-12);
    }
    assert!(starts.iter().all(|start| start[4..] == [0.0; 2]));
}

#[test]
fn a_recorded_trial_is_the_same_and_has_what_the_stage_names() {
    for hidden in [0, 3] {
        let mut evaluator = evaluator("no-velocities", &[("net.hidden", Value::Whole(hidden))]);
        let count = evaluator.info().parameters.len();
        assert_eq!(count, layout(false, hidden as u32).parameter_count());
        let parameters: Vec<f32> = (0..count).map(|i| (i % 5) as f32 - 1.5).collect();
        let plain = outcome(evaluator.as_mut(), &parameters);
        let schema = evaluator.info().schema;
        let mut recording = Recording::new(schema.clone());
        let evaluation = Evaluation::new(&parameters, EpisodeId::default());
        assert_eq!(evaluator.evaluate(evaluation, Some(&mut recording)), plain);
        // The step in which a pole falls is recorded, too.
        let ticks = recording.times().len();
        assert_eq!(ticks, plain.steps as usize + 1);
        assert!((recording.times()[ticks - 1] - 0.02 * ticks as f64).abs() < 1e-9);
        let links = schema.links.iter().map(|links| (links.from[1] - links.from[0]) * (links.to[1] - links.to[0]));
        assert_eq!(recording.controller_parameters().len(), links.sum::<usize>());
        for tick in [0, ticks / 2, ticks - 1] {
            let row: Vec<f64> = recording.row(tick).collect();
            assert_eq!(row.len(), schema.columns().len());
            assert!(row.iter().all(|x| x.is_finite()), "{row:?}");
        }
    }
}

#[test]
fn what_does_not_go_together_is_refused_by_name() {
    let refused = |key: &str, value: Value| {
        let mut settings = Settings::new(DoublePole.settings("velocities")).unwrap();
        settings.set("", key, value).unwrap();
        DoublePole.prepare("velocities", &settings).err().unwrap().to_string()
    };
    let found = refused("cart.least_force", Value::Number(11.0));
    assert!(found.contains("`cart.least_force`") && found.contains("10"), "{found}");
    let found = refused("poles.angle", Value::Number(-40.0));
    assert!(found.contains("`poles.angle`") && found.contains("36"), "{found}");
    assert!(CartEpisode::new(Config::new(true), vec![0.0; 15]).is_err());
}
