//! Files put together at random: each builds, its trials end with finite numbers, and lanes and threads change no bit.

use std::fmt::Write as _;

use farsa_compose::ComposedExperiment;
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment as _, Lanes, Outcome, Settings};
use farsa_num::{Domain, Stream};

/// Draws parts of files.
struct Draw(Stream);

impl Draw {
    fn one<'w>(&mut self, words: &[&'w str]) -> &'w str {
        words[self.0.below(words.len() as u32) as usize]
    }

    fn often(&mut self, share: f32) -> bool {
        self.0.uniform() < share
    }

    fn wrappers(&mut self, channels: u32) -> String {
        let mut list = Vec::new();
        while list.len() < 3 && self.often(0.3) {
            list.push(match self.0.below(6) {
                0 => format!("{{ kind = \"uniform-noise\", amplitude = {:.3} }}", self.0.range(0.0, 0.2)),
                1 => format!("{{ kind = \"normal-noise\", deviation = {:.3} }}", self.0.range(0.0, 0.2)),
                2 => format!("{{ kind = \"delay\", steps = {} }}", self.0.below(5)),
                3 => "{ kind = \"scale\", gain = 0.5, offset = 0.1 }".into(),
                4 => "{ kind = \"saturate\", low = 0.1, high = 0.9 }".into(),
                _ if self.often(0.5) => format!("{{ kind = \"lesion\", channels = [0, {}] }}", channels - 1),
                _ => "{ kind = \"stuck\", channels = [0, 0], after = 20 }".into(),
            });
        }
        format!("wrappers = [{}]\n", list.join(", "))
    }

    /// A file that is right.
    fn file(&mut self) -> String {
        let robot = self.one(&["khepera", "e-puck", "marxbot"]);
        let robots = 1 + self.0.below(4);
        let mut text = format!(
            "[world]\nsize = [2.0, 1.5]\n[robot]\nkind = \"{robot}\"\ncount = {robots}\n[episode]\nsteps = 100\ntrials = 2\n"
        );
        let _ = writeln!(text, "ends = [{}]", if self.often(0.3) { "\"collision\"" } else { "" });
        text += "[[objects]]\nname = \"lamp\"\nkind = \"cylinder\"\nradius = 0.03\nlamp = 1.0\n";
        text +=
            "[[objects]]\nname = \"nest\"\nkind = \"disc\"\nradius = 0.3\ncolor = [0.2, 0.2, 0.2]\nat = [1.0, 0.7]\n";
        text += "[[objects]]\nname = \"block\"\nkind = \"wall\"\nsize = [0.2, 0.05]\nat = [0.3, 0.3]\nheading = 30\n";
        text += "[[start]]\nplace = \"lamp\"\nat = \"anywhere\"\nwalls = 0.1\n";
        if self.often(0.5) {
            text += "[[start]]\nplace = \"robot\"\nat = \"anywhere\"\nwalls = 0.02\napart = 0.02\n";
        }
        for _ in 0..=self.0.below(4) {
            let (sensor, channels) = match self.0.below(18) {
                0 => ("kind = \"infrared\"", 6),
                1 => ("kind = \"infrared\"\nmodel = \"rays\"", 6),
                2 => ("kind = \"light\"", 6),
                3 => ("kind = \"ground-color\"\nrgb = true", 3),
                4 => ("kind = \"laser-distance\"\nbeams = 5\nfield_of_view = 180\nrange = 1.0", 5),
                5 => (
                    "kind = \"camera\"\nfield_of_view = 72\nsectors = 2\nrange = 3\ncolors = [{ name = \"grey\", low = [0.4, 0.4, 0.4], high = [0.6, 0.6, 0.6] }]",
                    2,
                ),
                6 => ("kind = \"wheel-speed\"", 2),
                7 => ("kind = \"traction\"\nlargest = 0.5", 2),
                8 => ("kind = \"signal\"\nrange = 1.0\nsectors = 4", 4),
                9 => ("kind = \"attachment\"", 1),
                10 => ("kind = \"touch\"", 1),
                11 => ("kind = \"contact-force\"", 1),
                12 => ("kind = \"target-position\"\ntarget = \"lamp\"", 3),
                13 => ("kind = \"body-pose\"", 7),
                14 => ("kind = \"body-velocity\"", 6),
                15 => ("kind = \"height\"", 1),
                16 => ("kind = \"joint-speed\"\njoint = 1", 1),
                _ => ("kind = \"constant\"\nvalue = 0.7", 1),
            };
            let _ = write!(text, "[[sensors]]\n{sensor}\n{}", self.wrappers(channels));
        }
        let wheels = self.one(&["wheels", "speed-and-turn"]);
        let _ = write!(text, "[[motors]]\nkind = \"{wheels}\"\n{}", self.wrappers(2));
        if robot != "khepera" && self.often(0.5) {
            text += "[[motors]]\nkind = \"leds\"\ncolors = [\"red\", \"blue\"]\n[[motors]]\nkind = \"signal\"\n";
        }
        if robot == "marxbot" && self.often(0.5) {
            text += "[[motors]]\nkind = \"attachment\"\n";
        }
        text += match self.0.below(7) {
            0 => "[network]\nkind = \"perceptron\"\n",
            1 => "[network]\nkind = \"leaky\"\nhidden = 3\n",
            2 => "[network]\nkind = \"ctrnn\"\nneurons = 7\ntime_constants = [0.1, 1.0]\n",
            3 => "[network]\nkind = \"feed-forward\"\nhidden = 3\n",
            4 => "[network]\nkind = \"elman\"\nhidden = 3\n",
            5 => "[network]\nkind = \"jordan\"\nhidden = 3\n",
            _ => "[network]\nkind = \"fully-recurrent\"\nhidden = 2\n",
        };
        let rewards = [
            "kind = \"near\"\nobject = \"lamp\"\nwithin = 0.2",
            "kind = \"distance\"\nobject = \"lamp\"\nweight = -1.0",
            "kind = \"approach\"\nobject = \"nest\"\nover = \"end\"",
            "kind = \"angle\"\nobject = \"lamp\"",
            "kind = \"touch\"\nweight = -0.5",
            "kind = \"displacement\"\nover = \"most\"",
            "kind = \"speed\"\nclip = [0.0, 0.1]",
            "kind = \"forward\"\nover = \"sum\"",
            "kind = \"wheel-speed\"",
            "kind = \"straight-on\"",
            "kind = \"in-area\"\narea = \"nest\"",
            "kind = \"held\"",
            "kind = \"effort\"",
            "kind = \"steps\"",
        ];
        let first = self.0.below(rewards.len() as u32) as usize;
        for number in 0..=(self.0.below(3) as usize) {
            let _ = writeln!(text, "[[reward]]\n{}", rewards[(first + 5 * number) % rewards.len()]);
        }
        text
    }
}

fn evaluator(text: &str) -> Box<dyn Evaluator> {
    let made = ComposedExperiment::from_text("drawn.toml", text, farsa_lab::strategies());
    let made = made.unwrap_or_else(|error| panic!("{error}\n{text}"));
    let settings = Settings::new(made.settings("")).unwrap_or_else(|error| panic!("{error}\n{text}"));
    made.prepare("", &settings).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

#[test]
fn drawn_files_live_and_lanes_change_no_bit() {
    let mut moved = 0;
    for file in 0..300 {
        let mut draw = Draw(Stream::new(20_261_123, Domain::General, 0, file, 0));
        let text = draw.file();
        let mut alone = evaluator(&text);
        let parameters: Vec<Vec<f32>> = (0..3)
            .map(|_| {
                let of_parameter = |ends: [f64; 2]| draw.0.range_f64(ends[0].min(ends[1]), ends[0].max(ends[1])) as f32;
                alone.parameters().iter().map(|parameter| parameter.ends).map(of_parameter).collect()
            })
            .collect();
        let jobs: Vec<Evaluation<'_>> = (0..6)
            .map(|number| {
                let (individual, trial) = (number as u32 / 2, number as u32 % 2);
                let id = EpisodeId { seed: 5, generation: 1, individual, trial };
                Evaluation { number, ..Evaluation::new(&parameters[number / 2], id) }
            })
            .collect();
        let expected: Vec<Outcome> = jobs.iter().map(|job| alone.evaluate(*job, None)).collect();
        for outcome in &expected {
            assert!(outcome.is_finite() && (1..=100).contains(&outcome.steps), "{outcome:?}\n{text}");
        }
        moved += usize::from(expected.windows(2).any(|pair| pair[0].terms != pair[1].terms));
        // Again, backwards: nothing is left of an episode.
        for (job, outcome) in jobs.iter().zip(&expected).rev() {
            assert_eq!(alone.evaluate(*job, None), *outcome, "{text}");
        }
        let mut lanes = evaluator(&text);
        let side_by_side = lanes.in_lanes().expect("the arena has lanes");
        side_by_side.use_lanes(Lanes::best()).expect("a batch");
        let (mut next, mut found) = (jobs.iter(), vec![None; jobs.len()]);
        side_by_side.evaluate_all(&mut || next.next().copied(), &mut |number, outcome| found[number] = Some(outcome));
        for (found, outcome) in found.into_iter().zip(&expected) {
            assert_eq!(found.as_ref(), Some(outcome), "{text}");
        }
    }
    assert!(moved > 250, "{moved} of 300 files tell their trials apart");
}
