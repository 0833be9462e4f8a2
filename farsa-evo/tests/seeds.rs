//! Every strategy tells the seed that it was given.

#![allow(clippy::unwrap_used)]

use farsa_evo::{
    CholeskyCmaEs, CmaEs, CmaEsConfig, Coevolution, Cosyne, CosyneConfig, EvolutionStrategy, EvolutionStrategyConfig,
    GaConfig, GeneralistCoevolution, GeneralistConfig, NoveltyConfig, NoveltySearch, Nsga2, Nsga2Config, OnePlusOne,
    OnePlusOneConfig, Pgpe, PgpeConfig, RealGa, RealGaConfig, SeparableCmaEs, SeparableCmaEsConfig, Snes, SnesConfig,
    SteadyState, SteadyStateConfig, TruncationGa, Xnes, XnesConfig,
};

#[test]
fn the_seed_is_the_one_that_was_given() {
    let (mean, bounds) = (vec![0.0; 3], vec![[-1.0, 1.0]; 3]);
    for seed in [0, 7, u64::MAX] {
        let told = [
            TruncationGa::new(GaConfig::new(3), seed).unwrap().seed(),
            OnePlusOne::new(OnePlusOneConfig::new(3), seed).unwrap().seed(),
            Coevolution::new(&[GaConfig::new(3); 2], seed).unwrap().seed(),
            RealGa::new(RealGaConfig::new(bounds.clone()), seed).unwrap().seed(),
            SteadyState::new(SteadyStateConfig::new(bounds.clone()), seed).unwrap().seed(),
            EvolutionStrategy::new(EvolutionStrategyConfig::new(mean.clone(), 0.5), seed).unwrap().seed(),
            CmaEs::new(CmaEsConfig::new(mean.clone(), 0.5), seed).unwrap().seed(),
            CholeskyCmaEs::new(CmaEsConfig::new(mean.clone(), 0.5), seed).unwrap().seed(),
            SeparableCmaEs::new(SeparableCmaEsConfig::new(mean.clone(), 0.5), seed).unwrap().seed(),
            Snes::new(SnesConfig::new(mean.clone(), 0.5), seed).unwrap().seed(),
            Xnes::new(XnesConfig::new(mean.clone(), 0.5), seed).unwrap().seed(),
            Pgpe::new(PgpeConfig::new(mean.clone(), 0.5, 4), seed).unwrap().seed(),
            Cosyne::new(CosyneConfig::new(3), seed).unwrap().seed(),
            GeneralistCoevolution::new(GeneralistConfig::new(3), seed).unwrap().seed(),
            Nsga2::new(Nsga2Config::new(bounds.clone(), 2), seed).unwrap().seed(),
        ];
        assert_eq!(told, [seed; 15]);
        let inner = TruncationGa::new(GaConfig::new(3), 5).unwrap();
        assert_eq!(NoveltySearch::new(NoveltyConfig::new(2), inner, seed).unwrap().seed(), seed);
    }
}
