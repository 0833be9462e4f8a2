//! Files put together at random.

mod jointed;
mod network;

use std::fmt::Write as _;

use farsa_num::{Domain, Stream};

/// Draws parts of files.
pub(crate) struct Draw {
    #[allow(dead_code, reason = "not every test draws more than files")]
    pub(crate) stream: Stream,
}

impl Draw {
    /// The file of this number of a series.
    pub(crate) fn new(series: u64, file: u32) -> Self {
        Self { stream: Stream::new(series, Domain::General, 0, file, 0) }
    }

    fn one<'w>(&mut self, words: &[&'w str]) -> &'w str {
        words[self.stream.below(words.len() as u32) as usize]
    }

    fn often(&mut self, share: f32) -> bool {
        self.stream.uniform() < share
    }

    fn wrappers(&mut self, channels: u32) -> String {
        let mut list = Vec::new();
        while list.len() < 3 && self.often(0.3) {
            list.push(match self.stream.below(7) {
                0 => format!("{{ kind = \"uniform-noise\", amplitude = {:.3} }}", self.stream.range(0.0, 0.2)),
                1 => format!("{{ kind = \"normal-noise\", deviation = {:.3} }}", self.stream.range(0.0, 0.2)),
                2 => format!("{{ kind = \"delay\", steps = {} }}", self.stream.below(5)),
                3 => "{ kind = \"scale\", gain = 0.5, offset = 0.1 }".into(),
                5 => "{ kind = \"threshold\", above = 0.4 }".into(),
                4 => "{ kind = \"saturate\", low = 0.1, high = 0.9 }".into(),
                _ if self.often(0.5) => format!("{{ kind = \"lesion\", channels = [0, {}] }}", channels - 1),
                _ => "{ kind = \"stuck\", channels = [0, 0], after = 20 }".into(),
            });
        }
        format!("wrappers = [{}]\n", list.join(", "))
    }

    /// A file that is right: of robots on wheels, or of one with joints.
    pub(crate) fn file(&mut self) -> String {
        if self.often(0.3) { self.jointed() } else { self.wheeled() }
    }

    fn wheeled(&mut self) -> String {
        let robot = self.one(&["khepera", "e-puck", "marxbot"]);
        let robots = 1 + self.stream.below(4);
        let mut text = format!(
            "[world]\nsize = [2.0, 1.5]\n[robot]\nkind = \"{robot}\"\ncount = {robots}\n[episode]\nsteps = 100\ntrials = 2\n"
        );
        let _ = writeln!(text, "ends = [{}]", self.one(&["", "", "\"collision\"", "\"death\""]));
        text += "[[objects]]\nname = \"lamp\"\nkind = \"cylinder\"\nradius = 0.03\nlamp = 1.0\n";
        text +=
            "[[objects]]\nname = \"nest\"\nkind = \"disc\"\nradius = 0.3\ncolor = [0.2, 0.2, 0.2]\nat = [1.0, 0.7]\n";
        text += "[[objects]]\nname = \"block\"\nkind = \"wall\"\nsize = [0.2, 0.05]\nat = [0.3, 0.3]\nheading = 30\n";
        text += "[foraging]\nnest = \"nest\"\ncells = 8\n";
        let _ = writeln!(text, "cost = {}", self.one(&["0.0", "0.01", "0.05"]));
        text += "[[start]]\nplace = \"lamp\"\nat = \"anywhere\"\nwalls = 0.1\n";
        if self.often(0.5) {
            text += self.one(&[
                "[[start]]\nplace = \"robot\"\nat = \"anywhere\"\nwalls = 0.02\napart = 0.02\n",
                "[[start]]\nplace = \"robot\"\nat = \"near\"\nof = \"nest\"\nwithin = 0.6\n",
            ]);
        }
        for _ in 0..=self.stream.below(4) {
            let (sensor, channels) = match self.stream.below(21) {
                0 => ("kind = \"infrared\"", 6),
                1 => ("kind = \"infrared\"\nmodel = \"rays\"", 6),
                17 => ("kind = \"infrared\"\nmodel = \"rays\"\ngroups = 4", 4),
                18 => ("kind = \"energy\"", 1),
                19 => ("kind = \"carried\"", 1),
                20 => ("kind = \"ground-color\"\nmiddle = true", 1),
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
                16 => ("kind = \"joint-speed\"\njoints = [\"right-wheel\"]", 1),
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
        text += &self.network(&text);
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
            "kind = \"near-others\"",
            "kind = \"food\"\nover = \"end\"",
            "kind = \"energy\"",
            "kind = \"alive\"\nover = \"sum\"",
            "kind = \"moved\"\nobject = \"lamp\"",
            "kind = \"progress\"\nalong = [1.0, 0.5, 0.0]",
            "kind = \"position\"\nalong = [0.0, 1.0, 0.0]\nover = \"end\"",
            "kind = \"effort\"",
            "kind = \"steps\"",
        ];
        let first = self.stream.below(rewards.len() as u32) as usize;
        for number in 0..=(self.stream.below(3) as usize) {
            let _ = writeln!(text, "[[reward]]\n{}", rewards[(first + 5 * number) % rewards.len()]);
        }
        text
    }
}
