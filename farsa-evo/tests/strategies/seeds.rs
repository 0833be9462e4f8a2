//! Every strategy returns its seed, and reports if its champion is the best ever.

use farsa_evo::Strategy;
use farsa_evo::archives::{GridCells, MapElites, MapElitesConfig, NoveltyConfig, NoveltySearch};
use farsa_evo::coevolution::{Cosyne, CosyneConfig, GeneralistCoevolution, GeneralistConfig, Populations};
use farsa_evo::covariance::{
    CholeskyCmaEs, CmaEs, CmaEsConfig, CmaEsRestarts, CmaEsRestartsConfig, RestartSchedule, SeparableCmaEs,
    SeparableCmaEsConfig,
};
use farsa_evo::gradient::{
    Ars, ArsConfig, OpenAiEs, OpenAiEsConfig, Pgpe, PgpeConfig, Snes, SnesConfig, Xnes, XnesConfig,
};
use farsa_evo::pareto::{Nsga2, Nsga2Config};
use farsa_evo::real::{
    EvolutionStrategy, EvolutionStrategyConfig, RealGa, RealGaConfig, SteadyState, SteadyStateConfig,
};
use farsa_evo::words::{GaConfig, OnePlusOne, OnePlusOneConfig, RandomSearch, TruncationGa};

#[test]
fn the_seed_is_the_one_that_was_given() {
    let (mean, bounds) = (vec![0.0; 3], vec![[-1.0, 1.0]; 3]);
    let cells = GridCells::new(vec![[0.0, 1.0]], vec![4]).unwrap();
    let restarts = CmaEsRestartsConfig::new(CmaEsConfig::new(mean.clone(), 0.5), RestartSchedule::Ipop);
    for seed in [0, 7, u64::MAX] {
        let seeds = [
            TruncationGa::new(GaConfig::new(3), seed).unwrap().seed(),
            OnePlusOne::new(OnePlusOneConfig::new(3), seed).unwrap().seed(),
            Populations::truncation(&[GaConfig::new(3); 2], seed).unwrap().seed(),
            RealGa::new(RealGaConfig::new(bounds.clone()), seed).unwrap().seed(),
            SteadyState::new(SteadyStateConfig::new(bounds.clone()), seed).unwrap().seed(),
            EvolutionStrategy::new(EvolutionStrategyConfig::new(mean.clone(), 0.5), seed).unwrap().seed(),
            CmaEs::new(CmaEsConfig::new(mean.clone(), 0.5), seed).unwrap().seed(),
            CholeskyCmaEs::with_covariance(CmaEsConfig::new(mean.clone(), 0.5), seed).unwrap().seed(),
            SeparableCmaEs::with_covariance(SeparableCmaEsConfig::new(mean.clone(), 0.5), seed).unwrap().seed(),
            Snes::new(SnesConfig::new(mean.clone(), 0.5), seed).unwrap().seed(),
            Xnes::new(XnesConfig::new(mean.clone(), 0.5), seed).unwrap().seed(),
            Pgpe::new(PgpeConfig::new(mean.clone(), 0.5, 4), seed).unwrap().seed(),
            Cosyne::new(CosyneConfig::new(3), seed).unwrap().seed(),
            GeneralistCoevolution::new(GeneralistConfig::new(3), seed).unwrap().seed(),
            Nsga2::new(Nsga2Config::new(bounds.clone(), 2), seed).unwrap().seed(),
            Ars::new(ArsConfig::new(mean.clone(), 4), seed).unwrap().seed(),
            OpenAiEs::new(OpenAiEsConfig::new(mean.clone(), 4), seed).unwrap().seed(),
            MapElites::new(MapElitesConfig::new(bounds.clone()), cells.clone(), seed).unwrap().seed(),
            CmaEsRestarts::new(restarts.clone(), seed).unwrap().seed(),
        ];
        assert_eq!(seeds, [seed; 19]);
        let inner = TruncationGa::new(GaConfig::new(3), 5).unwrap();
        assert_eq!(NoveltySearch::new(NoveltyConfig::new(2), inner, seed).unwrap().seed(), seed);
    }
}

#[test]
fn champions_are_the_best_ever_with_archives_and_random_search() {
    let bounds = vec![[-1.0, 1.0]; 3];
    let cells = GridCells::new(vec![[0.0, 1.0]], vec![4]).unwrap();
    let guesses = |seed| RandomSearch::new(3, 4, seed);
    let novel = NoveltyConfig::new(2);
    let (alone, two) =
        (TruncationGa::new(GaConfig::new(3), 5).unwrap(), Populations::truncation(&[GaConfig::new(3); 2], 5));
    let best_ever = [
        TruncationGa::new(GaConfig::new(3), 5).unwrap().champion_is_best_ever(),
        CmaEs::new(CmaEsConfig::new(vec![0.0; 3], 0.5), 5).unwrap().champion_is_best_ever(),
        Nsga2::new(Nsga2Config::new(bounds.clone(), 2), 5).unwrap().champion_is_best_ever(),
        MapElites::new(MapElitesConfig::new(bounds), cells, 5).unwrap().champion_is_best_ever(),
        guesses(5).unwrap().champion_is_best_ever(),
        NoveltySearch::new(novel, alone, 5).unwrap().champion_is_best_ever(),
        // With encounters between populations, fitness is not comparable between generations.
        Populations::new(2, 5, guesses).unwrap().champion_is_best_ever(),
        NoveltySearch::new(novel, two.unwrap(), 5).unwrap().champion_is_best_ever(),
    ];
    assert_eq!(best_ever, [false, false, true, true, true, true, false, false]);
}
