//! Curves of the tests of every n-th generation.

use crate::evaluation::generations::SampledTests;
use crate::figures::chart::Chart;
use crate::report::curves::curves;
use crate::report::moment::Moment;
use crate::report::page::{Block, Figure};
use crate::report::run::{Group, Run};

/// Returns figures of success and fitness of the best on fresh starts, nothing without such tests.
pub(crate) fn sampled(groups: &[Group<'_>]) -> Vec<Block> {
    let has_tests = |run: &&Run<'_>| run.sampled.is_some();
    let tested = groups.iter().filter_map(|group| {
        let runs: Vec<&Run<'_>> = group.runs.iter().copied().filter(has_tests).collect();
        (!runs.is_empty()).then(|| Group { label: group.label.clone(), runs })
    });
    let tested: Vec<Group<'_>> = tested.collect();
    let tests = || tested.iter().flat_map(|group| &group.runs).filter_map(|run| run.sampled.as_ref());
    let mut samplings: Vec<String> = tests()
        .map(|tests| format!("every {} generations in {} trials", tests.sampling.every, tests.sampling.trials))
        .collect();
    samplings.dedup();
    if samplings.is_empty() {
        return Vec::new();
    }
    let lines = if tested.iter().any(|group| group.runs.len() > 1) {
        " Thick: median of the runs; band: quartiles; thin: single runs."
    } else {
        ""
    };
    let across = Moment::common(&tested).axis(&tested);
    let figure = |title: &str, axis: &'static str, value: fn(&SampledTests, usize) -> f64| {
        let value =
            |run: &Run<'_>, generation: usize| run.sampled.as_ref().map_or(f64::NAN, |tests| value(tests, generation));
        let picture = Chart { title: title.into(), axis, across, curves: curves(&tested, across, &value) }.draw();
        let caption = format!(
            "{title}, tested {}, with equal starts. A value holds until the next test.{lines}",
            samplings.join(" or ")
        );
        Figure { kind: "tests", picture, caption }
    };
    let mut figures = Vec::new();
    if tests().any(SampledTests::has_success) {
        figures.push(figure("Success of the best on fresh starts", "share of the trials", SampledTests::success));
    }
    figures.push(figure("Fitness of the best on fresh starts", "fitness", SampledTests::fitness));
    vec![Block::Figures(figures)]
}
