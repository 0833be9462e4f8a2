//! Configurations and states that cannot be are refused with their numbers.

use crate::errors;
use farsa_evo::gradient::{
    Ars, ArsConfig, OpenAiEs, OpenAiEsConfig, Optimizer, Pgpe, PgpeConfig, Snes, SnesConfig, Xnes, XnesConfig,
};
use farsa_evo::{EvoError, Population, Snapshot, Strategy};

/// The name and the number of the setting that is refused.
fn setting<T: std::fmt::Debug>(made: Result<T, EvoError>) -> (&'static str, f64) {
    match made.unwrap_err() {
        EvoError::OutOfRange { field, value, .. } => (field, value),
        other => panic!("{other:?}"),
    }
}

#[test]
fn impossible_natural_evolution_strategies_are_refused() {
    let snes = |change: fn(&mut SnesConfig)| {
        let mut config = SnesConfig::new(vec![0.0; 3], 1.0);
        change(&mut config);
        Snes::new(config, 0)
    };
    assert_eq!(setting(snes(|c| c.mean[1] = 1e101)), ("mean", 1e101));
    assert_eq!(setting(snes(|c| c.sigma = 0.0)), ("sigma", 0.0));
    assert_eq!(setting(snes(|c| c.largest_step = 0.9)), ("largest_step", 0.9));
    assert_eq!(setting(snes(|c| c.population = 1)), ("population", 1.0));
    assert_eq!(setting(snes(|c| c.mean_learning_rate = -1.0)), ("mean_learning_rate", -1.0));
    assert_eq!(setting(snes(|c| c.sigma_learning_rate = f64::INFINITY)), ("sigma_learning_rate", f64::INFINITY));
    assert!(setting(snes(|c| c.sigma = f64::NAN)).1.is_nan());
    assert_eq!(snes(|c| c.mean.clear()).unwrap_err(), errors::no_genes());
    assert_eq!(Snes::new(SnesConfig::new(vec![], 1.0), 0).unwrap_err(), errors::no_genes());
    assert_eq!(snes(|c| c.population = 0).unwrap_err(), errors::no_individuals());
    let population = Population::MAX_GENES;
    assert_eq!(snes(|c| c.population = 1 << 28).unwrap_err(), errors::too_large(population, 3));

    let xnes = |change: fn(&mut XnesConfig)| {
        let mut config = XnesConfig::new(vec![0.0; 3], 1.0);
        change(&mut config);
        Xnes::new(config, 0)
    };
    assert_eq!(setting(xnes(|c| c.mean = vec![0.0; 1025])), ("genes", 1025.0));
    assert_eq!(setting(xnes(|c| c.mean[0] = f64::NEG_INFINITY)), ("mean", f64::NEG_INFINITY));
    assert_eq!(setting(xnes(|c| c.sigma = -1.0)), ("sigma", -1.0));
    assert_eq!(setting(xnes(|c| c.largest_step = f64::INFINITY)), ("largest_step", f64::INFINITY));
    assert_eq!(setting(xnes(|c| c.population = 1)), ("population", 1.0));
    assert_eq!(setting(xnes(|c| c.mean_learning_rate = 11.0)), ("mean_learning_rate", 11.0));
    assert_eq!(setting(xnes(|c| c.sigma_learning_rate = 11.0)), ("sigma_learning_rate", 11.0));
    assert_eq!(setting(xnes(|c| c.shape_learning_rate = 11.0)), ("shape_learning_rate", 11.0));
}

#[test]
fn impossible_mirrored_strategies_are_refused() {
    let open_ai = |change: fn(&mut OpenAiEsConfig)| {
        let mut config = OpenAiEsConfig::new(vec![0.0; 3], 4);
        change(&mut config);
        OpenAiEs::new(config, 0)
    };
    assert_eq!(setting(open_ai(|c| c.sigma = 0.0)), ("sigma", 0.0));
    assert_eq!(setting(open_ai(|c| c.learning_rate = -0.1)), ("learning_rate", -0.1));
    assert_eq!(setting(open_ai(|c| c.weight_decay = -0.1)), ("weight_decay", -0.1));
    assert_eq!(setting(open_ai(|c| c.optimizer = Optimizer::Momentum { momentum: 1.0 })), ("momentum", 1.0));
    let adam = |first_decay, second_decay, epsilon| {
        let optimizer = Optimizer::Adam { first_decay, second_decay, epsilon };
        setting(OpenAiEs::new(OpenAiEsConfig { optimizer, ..OpenAiEsConfig::new(vec![0.0; 3], 4) }, 0))
    };
    assert_eq!(adam(1.0, 0.9, 1.0), ("first_decay", 1.0));
    assert_eq!(adam(0.9, -0.5, 1.0), ("second_decay", -0.5));
    assert_eq!(adam(0.9, 0.9, 0.0), ("epsilon", 0.0));
    assert_eq!(open_ai(|c| c.pairs = 0).unwrap_err(), errors::no_individuals());
    let population = usize::MAX;
    assert_eq!(open_ai(|c| c.pairs = usize::MAX).unwrap_err(), errors::too_large(population, 3));

    let pgpe = |change: fn(&mut PgpeConfig)| {
        let mut config = PgpeConfig::new(vec![0.0; 3], 1.0, 4);
        change(&mut config);
        Pgpe::new(config, 0)
    };
    assert_eq!(setting(pgpe(|c| c.sigma = 1e200)), ("sigma", 1e200));
    assert_eq!(setting(pgpe(|c| c.largest_step = 0.9)), ("largest_step", 0.9));
    assert_eq!(setting(pgpe(|c| c.step_size = 0.0)), ("step_size", 0.0));
    assert_eq!(setting(pgpe(|c| c.max_speed = 0.0)), ("max_speed", 0.0));
    assert_eq!(setting(pgpe(|c| c.momentum = 1.5)), ("momentum", 1.5));
    assert_eq!(setting(pgpe(|c| c.sigma_learning_rate = -1.0)), ("sigma_learning_rate", -1.0));
    assert_eq!(setting(pgpe(|c| c.sigma_max_change = 1.0)), ("sigma_max_change", 1.0));
    assert_eq!(pgpe(|c| c.pairs = 0).unwrap_err(), errors::no_individuals());

    let ars = |change: fn(&mut ArsConfig)| {
        let mut config = ArsConfig::new(vec![0.0; 3], 4);
        change(&mut config);
        Ars::new(config, 0)
    };
    assert_eq!(setting(ars(|c| c.top_directions = 0)), ("top_directions", 0.0));
    assert_eq!(setting(ars(|c| c.top_directions = 5)), ("top_directions", 5.0));
    assert_eq!(setting(ars(|c| c.step_size = 0.0)), ("step_size", 0.0));
    assert_eq!(setting(ars(|c| c.noise = 0.0)), ("noise", 0.0));
    assert_eq!(ars(|c| c.directions = 0).unwrap_err(), errors::no_individuals());
}

/// Puts a number in place of each of a state, and looks whether it is refused and nothing changed.
fn bent<S: Strategy<f64> + Snapshot + Clone + PartialEq + std::fmt::Debug>(mut strategy: S, wrong: f64) {
    let values: Vec<f64> = strategy.ask().iter().map(|x| x[0]).collect();
    strategy.tell_values(&values).unwrap();
    let state = strategy.save();
    let mut other = strategy.clone();
    for place in (4..state.len()).step_by(8) {
        let mut state = state.clone();
        state[place..place + 8].copy_from_slice(&wrong.to_le_bytes());
        assert!(matches!(other.restore(&state), Err(EvoError::State { .. })), "{place}: {wrong}");
        assert_eq!(other, strategy);
    }
    for length in [0, 3, state.len() - 1] {
        let expected = errors::state_length(state.len(), length);
        assert_eq!(other.restore(&state[..length]), Err(expected));
    }
    assert_eq!(other, strategy);
}

#[test]
fn altered_states_are_refused() {
    for wrong in [f64::NAN, f64::INFINITY, -1e300] {
        bent(Snes::new(SnesConfig::new(vec![0.0; 3], 1.0), 0).unwrap(), wrong);
        bent(Xnes::new(XnesConfig::new(vec![0.0; 3], 1.0), 0).unwrap(), wrong);
        bent(OpenAiEs::new(OpenAiEsConfig::new(vec![0.0; 3], 4), 0).unwrap(), wrong);
        bent(Pgpe::new(PgpeConfig::new(vec![0.0; 3], 1.0, 4), 0).unwrap(), wrong);
        bent(Ars::new(ArsConfig::new(vec![0.0; 3], 4), 0).unwrap(), wrong);
    }
}

/// Configurations are saved and read.
#[cfg(feature = "serde")]
#[test]
fn configurations_are_saved() {
    fn same<C: serde::Serialize + serde::de::DeserializeOwned + PartialEq + std::fmt::Debug>(config: &C) {
        assert_eq!(&postcard::from_bytes::<C>(&postcard::to_allocvec(config).unwrap()).unwrap(), config);
    }
    same(&SnesConfig::new(vec![1.0, 2.0], 0.5));
    same(&XnesConfig::new(vec![1.0, 2.0], 0.5));
    same(&OpenAiEsConfig::new(vec![1.0, 2.0], 5));
    same(&PgpeConfig::new(vec![1.0, 2.0], 0.5, 5));
    same(&ArsConfig::new(vec![1.0, 2.0], 5));
}
