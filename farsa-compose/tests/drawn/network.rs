//! Networks between the sensors and motors of a file.

use std::fmt::Write as _;

use super::Draw;

/// The parts of a list of a text: what each is called, and its own lines.
fn parts<'t>(text: &'t str, list: &str) -> Vec<(String, &'t str)> {
    let mut found: Vec<(String, &str)> = Vec::new();
    for part in text.split("[[").filter_map(|part| part.strip_prefix(list)?.strip_prefix("]]\n")) {
        let kind = part.strip_prefix("kind = \"").and_then(|rest| rest.split('"').next()).expect("a kind first");
        let taken = |name: &str| found.iter().any(|(known, _)| known == name);
        let numbered = || (2..100).map(|number| format!("{kind}-{number}")).find(|name| !taken(name));
        let name = if taken(kind) { numbered().expect("a free number") } else { kind.to_owned() };
        found.push((name, part));
    }
    found
}

/// An input of a sensor of a robot on wheels.
fn input((name, part): &(String, &str)) -> String {
    let alone = ["energy", "carried", "attachment", "touch", "contact-force", "height", "joint-speed", "constant"];
    let one =
        alone.iter().any(|kind| part.starts_with(&format!("kind = \"{kind}\""))) || part.contains("middle = true");
    if one { name.clone() } else { format!("{name} 1") }
}

/// The outputs of a motor of a robot on wheels.
fn outputs((name, part): &(String, &str)) -> Vec<String> {
    let ends: &[&str] = match () {
        () if part.starts_with("kind = \"wheels\"") => &[" left", " right"],
        () if part.starts_with("kind = \"speed-and-turn\"") => &[" speed", " turn"],
        () if part.starts_with("kind = \"leds\"") => &[" 1", " 2"],
        () => &[""],
    };
    ends.iter().map(|end| format!("{name}{end}")).collect()
}

impl Draw {
    /// A network for the sensors and motors of a text.
    pub(super) fn network(&mut self, text: &str) -> String {
        match self.stream.below(12) {
            0 => "[network]\nkind = \"perceptron\"\n".into(),
            1 => "[network]\nkind = \"leaky\"\nhidden = 3\n".into(),
            2 => "[network]\nkind = \"ctrnn\"\nneurons = 15\ntime_constants = [0.1, 1.0]\n".into(),
            3 => "[network]\nkind = \"feed-forward\"\nhidden = 3\n".into(),
            4 => "[network]\nkind = \"elman\"\nhidden = 3\n".into(),
            5 => "[network]\nkind = \"jordan\"\nhidden = 3\n".into(),
            6 => "[network]\nkind = \"fully-recurrent\"\nhidden = 2\n".into(),
            7 => {
                "[network]\nkind = \"evonet\"\nhidden = 3\nhidden_neurons = \"leaky\"\ndirect = true\nrecurrent_hidden = true\n".into()
            }
            // The joints' channels have other names.
            8 | 9 if text.contains("\"speed-and-turn\"") || text.contains("\"wheels\"") => self.wired(text),
            _ => self.blocks(text),
        }
    }

    fn wired(&mut self, text: &str) -> String {
        let inputs: Vec<String> = parts(text, "sensors").iter().map(input).collect();
        let outputs: Vec<String> = parts(text, "motors").iter().flat_map(outputs).collect();
        let biases: Vec<String> = outputs.iter().map(|_| format!("{:.2}", self.stream.range(-1.0, 1.0))).collect();
        let mut made = format!("[network]\nkind = \"wired\"\nbias = [{}]\n", biases.join(", "));
        let _ = writeln!(made, "search_bias = {}", self.often(0.5));
        let _ = writeln!(made, "activation = \"{}\"", self.one(&["clamp", "logistic"]));
        for number in 0..=self.stream.below(6) {
            let pick = |draw: &mut Self, list: &[String]| list[draw.stream.below(list.len() as u32) as usize].clone();
            let mut from = pick(self, &inputs);
            if self.often(0.3) {
                let _ = write!(from, "\", \"{}", pick(self, &inputs));
            }
            let to = pick(self, &outputs);
            let weight = self.stream.range(-3.0, 3.0);
            let _ = write!(made, "[[network.wires]]\nfrom = [\"{from}\"]\nto = \"{to}\"\nweight = {weight:.2}\n");
            let _ = writeln!(made, "searched = {}", number == 0 || self.often(0.5));
        }
        made
    }

    /// Draws clusters, and links between drawn ends. Links that an earlier one contains are left out.
    fn blocks(&mut self, text: &str) -> String {
        let mut made = String::from("[network]\nkind = \"blocks\"\n");
        let _ = writeln!(made, "output_biases = {}\noutput_leaks = {}", self.often(0.5), self.often(0.3));
        let (sensors, motors) = (parts(text, "sensors"), parts(text, "motors"));
        let own = |name: &String, other: &[(String, &str)]| other.iter().all(|(known, _)| known != name);
        let mut from = vec!["sensors".to_owned()];
        from.extend(sensors.iter().map(|(name, _)| name.clone()).filter(|name| own(name, &motors)));
        let mut to = vec!["motors".to_owned()];
        to.extend(motors.iter().map(|(name, _)| name.clone()));
        // A sensor with the name of a motor takes from both what links call them.
        if from.len() == sensors.len() + 1 {
            from.extend(to.clone());
        }
        for number in 0..self.stream.below(4) {
            let name = format!("cluster-{number}");
            let neurons = 1 + self.stream.below(3);
            let _ = writeln!(made, "[[network.clusters]]\nname = \"{name}\"\nneurons = {neurons}");
            let _ = writeln!(made, "activation = \"{}\"", self.one(&["logistic", "tanh", "step"]));
            let _ = writeln!(made, "slope = {:.2}", self.stream.range(0.2, 3.0));
            let _ = writeln!(made, "biases = {}\nleaks = {}", self.often(0.7), self.often(0.4));
            from.push(name.clone());
            to.push(name);
        }
        // The whole and its parts overlap, unless the delays differ.
        let mut known: Vec<[usize; 3]> = Vec::new();
        let part = |list: &[(String, &str)], name: &str| list.iter().any(|(known, _)| known == name);
        let within = |whole: &str, name: &str| match whole {
            "sensors" => part(&sensors, name),
            "motors" => part(&motors, name),
            _ => false,
        };
        let meet =
            |list: &[String], a: usize, b: usize| a == b || within(&list[a], &list[b]) || within(&list[b], &list[a]);
        for number in 0..3 + self.stream.below(6) {
            // The first leads from what is sensed to what is done.
            let all = |list: &[String], draw: &mut Self| draw.stream.below(list.len() as u32) as usize;
            let [a, b] = if number == 0 { [0, 0] } else { [all(&from, self), all(&to, self)] };
            let delay = if number > 0 && self.often(0.3) { self.stream.below(4) as usize } else { 0 };
            if known.iter().any(|[x, y, z]| meet(&from, *x, a) && meet(&to, *y, b) && *z == delay) {
                continue;
            }
            known.push([a, b, delay]);
            let _ = write!(made, "[[network.links]]\nfrom = \"{}\"\nto = \"{}\"\ndelay = {delay}\n", from[a], to[b]);
        }
        made
    }
}
