//! Test protocols of `compositional-instructions`. Each case defines the instructions and the changes of the network.

use farsa_lab::advanced::{CaseId, Intervention, Protocol};
use farsa_nn::CtrnnParameter;
use farsa_nn::block::Span;

use crate::compositional_instructions::config::Config;
use crate::compositional_instructions::episode::TrialInstructions;
use crate::compositional_instructions::instruction::{Action, Color, Instruction};
use crate::compositional_instructions::network::{INNER, INNER_ONES, KINDS, LAYOUT, MOTOR_ONES, NEURONS};

/// Trials of a case.
const TRIALS: u32 = 84;
/// Standard deviations of the noise.
const NOISE: [f32; 5] = [0.0, 0.05, 0.1, 0.2, 0.4];
/// When the instruction changes, in parts of a trial that ends when it would have.
const TIMES: usize = 10;
/// The ordered pairs of two of three.
const PAIRS: [[usize; 2]; 6] = [[0, 1], [0, 2], [1, 0], [1, 2], [2, 0], [2, 1]];

/// A case of a protocol.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Probe {
    instructions: TrialInstructions,
    change: Intervention,
}

impl Probe {
    /// The instructions of the case.
    pub(crate) fn instructions(&self) -> TrialInstructions {
        self.instructions
    }

    /// The change of the network.
    pub(crate) fn change(&self) -> &Intervention {
        &self.change
    }
}

/// Cuts the links from one group of neurons to another.
fn cut(from: Span, to: Span) -> Intervention {
    let first = LAYOUT.range(CtrnnParameter::Weight).start;
    let of_source = |source: usize| (to.first..to.end()).map(move |target| first + source * NEURONS + target);
    Intervention::cut_links((from.first..from.end()).flat_map(of_source))
}

/// The protocols of a configuration, with what each case is.
#[derive(Clone, Debug)]
pub(crate) struct Protocols {
    protocols: Vec<Protocol>,
    probes: Vec<Vec<Probe>>,
}

impl Protocols {
    /// All protocols.
    pub(crate) fn new(config: &Config) -> Self {
        let mut protocols = Self { protocols: Vec::new(), probes: Vec::new() };
        protocols.add_instructions(config);
        protocols.add_transitions(config, true);
        protocols.add_transitions(config, false);
        protocols.add_decisions(config);
        protocols.add_lesions(config);
        protocols.add_noise(config);
        protocols
    }

    /// The protocols as the command shows them.
    pub(crate) fn list(&self) -> Vec<Protocol> {
        self.protocols.clone()
    }

    /// The case of a number, if there is one.
    pub(crate) fn probe(&self, case: CaseId) -> Option<&Probe> {
        self.probes.get(case.protocol)?.get(case.case)
    }

    fn add(&mut self, protocol: Protocol, probes: Vec<Probe>) {
        self.protocols.push(protocol.with_trials(TRIALS));
        self.probes.push(probes);
    }

    fn add_instructions(&mut self, config: &Config) {
        let condition = config.condition;
        let actions = condition.actions().map(Action::word);
        let summary = "every instruction, trained and held out, from fresh starts";
        let protocol = Protocol::from_table("instructions", summary, actions, Color::ALL.map(Color::word))
            .with_axes("action", "object")
            .with_states(INNER_ONES.first..INNER_ONES.end())
            .with_held_out(|action, object| is_held_out(config, &format!("{action} {object}")));
        let probes = condition.instructions().map(|first| whole(plain(config, first)));
        self.add(protocol, probes.to_vec());
    }

    /// Another action for the same object, or another object for the same action, when the time of a trial is over:
    /// then as much time again.
    fn add_transitions(&mut self, config: &Config, of_action: bool) {
        let actions = config.condition.actions();
        let (name, summary, rows, columns, axes) = if of_action {
            let rows = PAIRS.map(|[a, b]| format!("{} to {}", actions[a].word(), actions[b].word()));
            let summary = "the action word changes in mid-trial, and the second instruction is judged";
            ("action-transition", summary, rows, Color::ALL.map(Color::word), ["actions", "object"])
        } else {
            let rows = PAIRS.map(|[a, b]| format!("{} to {}", Color::ALL[a].word(), Color::ALL[b].word()));
            let summary = "the object word changes in mid-trial, and the second instruction is judged";
            ("object-transition", summary, rows, actions.map(Action::word), ["objects", "action"])
        };
        let pair = |row: usize, column: usize| {
            let [a, b] = PAIRS[row];
            if of_action {
                [a, b].map(|action| Instruction { action: actions[action], color: Color::ALL[column] })
            } else {
                [a, b].map(|color| Instruction { action: actions[column], color: Color::ALL[color] })
            }
        };
        let mut protocol = Protocol::from_table(name, summary, rows, columns).with_axes(axes[0], axes[1]);
        let mut probes = Vec::new();
        for (number, case) in protocol.cases.iter_mut().enumerate() {
            let [first, then] = pair(number / 3, number % 3);
            case.held_out = config.held_out.contains(&first) || config.held_out.contains(&then);
            let steps = config.steps;
            probes.push(whole(TrialInstructions { first, change: Some((steps, then)), steps: 2 * steps, noise: 0.0 }));
        }
        self.add(protocol, probes);
    }

    /// The instruction changes ever later in a trial of the usual length: until when is it followed all the same?
    fn add_decisions(&mut self, config: &Config) {
        let actions = config.condition.actions();
        let time = |part: usize| (config.steps as usize * part / TIMES) as u32;
        let rows = (0..TIMES).map(|part| format!("{:.1} s", f64::from(time(part)) * config.time_step));
        let summary =
            "one word changes at these times, and the trial ends at its own: until when is the new word followed";
        let protocol = Protocol::from_table("decision", summary, rows, ["object changes", "action changes"])
            .with_axes("time of the change", "which word");
        // TOUCH red, which is trained: before, another object or another action.
        let then = Instruction { action: actions[1], color: Color::Red };
        let probes = (0..2 * TIMES).map(|number| {
            let (part, of_action) = (number / 2, number % 2 == 1);
            let first = if of_action {
                Instruction { action: actions[0], ..then }
            } else {
                Instruction { color: Color::Blue, ..then }
            };
            let change = Some((time(part), then));
            whole(TrialInstructions { first, change, steps: config.steps, noise: 0.0 })
        });
        let probes = probes.collect();
        self.add(protocol, probes);
    }

    fn add_lesions(&mut self, config: &Config) {
        let mut cuts = vec![("intact".to_owned(), Intervention::default())];
        cuts.extend(
            (0..INNER).map(|i| (format!("inner neuron {}", i + 1), Intervention::lesion(INNER_ONES.first + i))),
        );
        cuts.extend(KINDS.map(|(kind, span)| (format!("links from {kind}"), cut(span, INNER_ONES))));
        cuts.push(("links between inner neurons".into(), cut(INNER_ONES, INNER_ONES)));
        for (joint, name) in ["J1", "J2"].into_iter().enumerate() {
            let motors = Span::new(MOTOR_ONES.first + 2 * joint, 2);
            cuts.push((format!("links to {name}"), cut(INNER_ONES, motors)));
        }
        let instructions = config.condition.instructions();
        let rows = cuts.iter().map(|(name, _)| name.clone());
        let summary = "without each inner neuron and each group of links, every instruction";
        let protocol =
            Protocol::from_table("lesions", summary, rows, instructions.map(|instruction| instruction.to_string()))
                .with_axes("without", "instruction")
                .with_held_out(|_, instruction| is_held_out(config, instruction));
        let probes = cuts.iter().flat_map(|(_, cut)| {
            instructions.map(|first| Probe { instructions: plain(config, first), change: cut.clone() })
        });
        let probes = probes.collect();
        self.add(protocol, probes);
    }

    fn add_noise(&mut self, config: &Config) {
        let instructions = config.condition.instructions();
        let summary = "normal noise on camera, touch and joints, every instruction";
        let protocol = Protocol::from_table(
            "noise",
            summary,
            NOISE.map(|level| level.to_string()),
            instructions.map(|instruction| instruction.to_string()),
        )
        .with_axes("standard deviation", "instruction")
        .with_held_out(|_, instruction| is_held_out(config, instruction));
        let probes = NOISE
            .into_iter()
            .flat_map(|noise| instructions.map(|first| whole(TrialInstructions { noise, ..plain(config, first) })));
        let probes = probes.collect();
        self.add(protocol, probes);
    }
}

fn whole(instructions: TrialInstructions) -> Probe {
    Probe { instructions, change: Intervention::default() }
}

fn plain(config: &Config, first: Instruction) -> TrialInstructions {
    TrialInstructions { first, change: None, steps: config.steps, noise: 0.0 }
}

fn is_held_out(config: &Config, words: &str) -> bool {
    config.held_out.iter().any(|instruction| instruction.to_string() == words)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compositional_instructions::instruction::Condition;

    #[test]
    fn each_case_is_what_its_row_and_column_say() {
        for condition in [Condition::WithIndicate, Condition::WithIgnore] {
            let config = Config::for_condition(condition);
            let all = Protocols::new(&config);
            let list = all.list();
            let names: Vec<&str> = list.iter().map(|protocol| protocol.name.as_str()).collect();
            let expected = ["instructions", "action-transition", "object-transition", "decision", "lesions", "noise"];
            assert_eq!(names, expected);
            for (number, protocol) in list.iter().enumerate() {
                assert_eq!(protocol.cases.len(), all.probes[number].len(), "{}", protocol.name);
                assert_eq!(protocol.trials, TRIALS);
                for (case, found) in protocol.cases.iter().zip(&all.probes[number]) {
                    let instructions = found.instructions();
                    let words = instructions.first.to_string();
                    match protocol.name.as_str() {
                        "instructions" => assert_eq!(words, format!("{} {}", case.row, case.column)),
                        "lesions" | "noise" => assert_eq!(words, case.column),
                        "action-transition" => {
                            let (at, then) = instructions.change.unwrap();
                            assert_eq!((at, instructions.steps), (150, 300));
                            assert_eq!(
                                format!("{} to {}", instructions.first.action.word(), then.action.word()),
                                case.row
                            );
                            assert!(words.ends_with(&case.column) && then.color == instructions.first.color);
                        }
                        "object-transition" => {
                            let (_, then) = instructions.change.unwrap();
                            assert_eq!(
                                format!("{} to {}", instructions.first.color.word(), then.color.word()),
                                case.row
                            );
                            assert!(words.starts_with(&case.column) && then.action == instructions.first.action);
                        }
                        _ => {
                            let (at, then) = instructions.change.unwrap();
                            assert_eq!(format!("{:.1} s", f64::from(at) * 0.1), case.row);
                            assert_eq!((instructions.steps, then.to_string().as_str()), (150, "TOUCH red"));
                            let same =
                                [then.action == instructions.first.action, then.color == instructions.first.color];
                            assert_eq!(same, [case.column.starts_with("object"), case.column.starts_with("action")]);
                        }
                    }
                    if protocol.name != "decision" && !protocol.name.ends_with("transition") {
                        assert_eq!(case.held_out, config.held_out.contains(&instructions.first));
                    }
                }
            }
            assert!(all.probe(CaseId { protocol: 0, case: 9 }).is_none());
            // Without the links from the two joints, which are inputs 12 and 13, to inner neurons.
            let first = LAYOUT.range(CtrnnParameter::Weight).start;
            let weights = (12..14).flat_map(|from| (20..26).map(move |to| (first + 30 * from + to, 0.0)));
            assert_eq!(all.probes[4][9 * 9].change.parameters, weights.collect::<Vec<_>>());
        }
    }
}
