//! Internal states of a test protocol on their first two principal components.

use crate::experiment::protocol::{Case, Protocol};
use crate::figures::principal_components::PrincipalComponents;
use crate::figures::significant::percent;
use crate::figures::trajectories::{Panel, Trajectories};
use crate::report::page::{Block, Figure};
use crate::report::run::Run;
use crate::report::tested_protocol::TestedProtocol;

/// Draws the states of a run's champion in the first trials of each case, if recorded states differ.
pub(crate) fn states(run: &Run<'_>, tested: &TestedProtocol) -> Option<Block> {
    let states = tested.states.as_ref()?;
    let components = PrincipalComponents::of(states.points())?;
    let panel = |(number, case)| {
        let trials = states.trials.iter().filter(|trial| trial.case == number);
        let curve = |steps: &[(u32, Vec<f32>)]| steps.iter().map(|(_, states)| components.place(states)).collect();
        let curves = trials.map(|trial| curve(&trial.steps)).collect();
        let label = Case::name(case);
        Panel { label, curves, outlined: case.held_out }
    };
    let cases = tested.cases();
    let panels: Vec<Panel> =
        cases.iter().enumerate().map(panel).filter(|panel: &Panel| !panel.curves.is_empty()).collect();
    let [first, second] = components.shares.map(percent);
    let axes = [("first", first), ("second", second)];
    let axes = axes.map(|(which, share)| format!("{which} principal component, {share} of the variance"));
    let title = format!("{}: internal states", tested.protocol.name);
    let columns = Protocol::places(&cases, |case| &case.column).len();
    let picture = Trajectories { title: &title, axes, columns, panels: &panels }.draw()?;
    let trials = panels.iter().map(|panel| panel.curves.len()).max().unwrap_or(0);
    let neurons =
        format!("{} neurons, {} to {}", states.neurons.len(), states.neurons.first()?, states.neurons.last()?);
    let caption = format!(
        "{}: the states of {neurons}, in the first {trials} trials of each case, from the circle to the dot. Pale curves are those of all cases.",
        run.name()
    );
    Some(Block::Figures(vec![Figure { kind: "states", picture, caption }]))
}
