//! What every strategy tells of itself: the seed that it was given, and whose best its champion is.

use farsa_evo::{
    Ars, ArsConfig, CholeskyCmaEs, CmaEs, CmaEsConfig, CmaEsRestarts, CmaEsRestartsConfig, Coevolution, Cosyne,
    CosyneConfig, EvolutionStrategy, EvolutionStrategyConfig, GaConfig, GeneralistCoevolution, GeneralistConfig,
    GridCells, MapElites, MapElitesConfig, NoveltyConfig, NoveltySearch, Nsga2, Nsga2Config, OnePlusOne,
    OnePlusOneConfig, OpenAiEs, OpenAiEsConfig, Pgpe, PgpeConfig, RandomSearch, RealGa, RealGaConfig, RestartSchedule,
    SeparableCmaEs, SeparableCmaEsConfig, SideBySide, Snes, SnesConfig, SteadyState, SteadyStateConfig, Strategy,
    TruncationGa, Xnes, XnesConfig,
};

#[test]
fn the_seed_is_the_one_that_was_given() {
    let (mean, bounds) = (vec![0.0; 3], vec![[-1.0, 1.0]; 3]);
    let cells = GridCells::new(vec![[0.0, 1.0]], vec![4]).unwrap();
    let restarts = CmaEsRestartsConfig::new(CmaEsConfig::new(mean.clone(), 0.5), RestartSchedule::Ipop);
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
            Ars::new(ArsConfig::new(mean.clone(), 4), seed).unwrap().seed(),
            OpenAiEs::new(OpenAiEsConfig::new(mean.clone(), 4), seed).unwrap().seed(),
            MapElites::new(MapElitesConfig::new(bounds.clone()), cells.clone(), seed).unwrap().seed(),
            CmaEsRestarts::new(restarts.clone(), seed).unwrap().seed(),
        ];
        assert_eq!(told, [seed; 19]);
        let inner = TruncationGa::new(GaConfig::new(3), 5).unwrap();
        assert_eq!(NoveltySearch::new(NoveltyConfig::new(2), inner, seed).unwrap().seed(), seed);
    }
}

#[test]
fn who_keeps_an_archive_or_only_guesses_keeps_its_champion() {
    let bounds = vec![[-1.0, 1.0]; 3];
    let cells = GridCells::new(vec![[0.0, 1.0]], vec![4]).unwrap();
    let guesses = |seed| RandomSearch::new(3, 4, seed);
    let novel = NoveltyConfig::new(2);
    let (alone, two) = (TruncationGa::new(GaConfig::new(3), 5).unwrap(), Coevolution::new(&[GaConfig::new(3); 2], 5));
    let told = [
        TruncationGa::new(GaConfig::new(3), 5).unwrap().keeps_champion(),
        CmaEs::new(CmaEsConfig::new(vec![0.0; 3], 0.5), 5).unwrap().keeps_champion(),
        Nsga2::new(Nsga2Config::new(bounds.clone(), 2), 5).unwrap().keeps_champion(),
        MapElites::new(MapElitesConfig::new(bounds), cells, 5).unwrap().keeps_champion(),
        guesses(5).unwrap().keeps_champion(),
        NoveltySearch::new(novel, alone, 5).unwrap().keeps_champion(),
        // Where populations may meet, fitness of one generation is not that of another.
        SideBySide::new(2, 5, guesses).unwrap().keeps_champion(),
        NoveltySearch::new(novel, two.unwrap(), 5).unwrap().keeps_champion(),
    ];
    assert_eq!(told, [false, false, true, true, true, true, false, false]);
}
