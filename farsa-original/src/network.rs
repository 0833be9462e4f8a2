//! The network.

use crate::ini::Group;
use crate::remarks::Remarks;
use crate::written::{Written, number, numbers};

/// Most neurons of a network of the 2013 program.
pub(super) const MAX_NEURONS: u64 = 1000;

/// A perceptron if possible, else Evonet with the same flags.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Network {
    pub(super) hidden: u64,
    hidden_neurons: &'static str,
    /// Half the range of weights.
    range: f64,
    largest_bias: f64,
    /// Flags that are true, by their keys in the experiment file.
    flags: Vec<&'static str>,
    /// True if genotypes of the 2013 program mean the same network.
    pub(super) same_genes: bool,
}

/// Flags of the configuration and of the experiment file.
const FLAGS: [(&str, &str); 5] = [
    ("biasOnHiddenNeurons", "hidden_biases"),
    ("biasOnOutputNeurons", "output_biases"),
    ("recurrentHiddens", "recurrent_hidden"),
    ("recurrentOutputs", "recurrent_outputs"),
    ("inputOutputConnections", "direct"),
];

impl Network {
    /// Reads the group of a network, `Evonet`.
    pub(super) fn from_group(group: &Group, remarks: &mut Remarks) -> Self {
        let before = remarks.count_left();
        if let Some((name, entry)) = group.kind(remarks).filter(|(name, _)| name != "Evonet") {
            remarks.lost(group, entry, &format!("`{name}` is no `Evonet`; what it shares with that is read"));
        }
        if let Some(entry) = group.text("netFile", remarks).filter(|entry| !entry.value.is_empty()) {
            let why = "networks of `.net` files are to be named by hand (kind `evonet`, `file`); this one is of the keys beside it";
            remarks.lost(group, entry, why);
        }
        let hidden = group.whole("nHiddens", 0, 0..=MAX_NEURONS, remarks);
        let range = group.number("weightRange", 5.0, 1.0..=1e6, remarks);
        let largest_bias = group.number("biasRange", 5.0, 0.0..=1e6, remarks);
        let mut flags = Vec::new();
        for (key, word) in FLAGS {
            // Flags of hidden neurons have no effect without them.
            let idle = hidden == 0 && !["output_biases", "recurrent_outputs"].contains(&word);
            if group.flag(key, false, remarks) && !idle {
                flags.push(word);
            }
        }
        if neurons(group, ["outputNeuronType", "no_delta", "with_delta"], remarks) {
            flags.push("output_leaks");
        }
        let leaky = neurons(group, ["hiddenNeuronType", "logistic", "logistic+delta"], remarks);
        let binary = group.find("hiddenNeuronType").is_some_and(|entry| entry.value.eq_ignore_ascii_case("binary"));
        let hidden_neurons = match (leaky, binary) {
            (true, _) => "leaky",
            (_, true) => "binary",
            _ => "logistic",
        };
        group.lost(&[("inputNeuronType", "no_delta")], "inputs have no leaks here", remarks);
        group.idle(&["gainRange"], "no neuron of a network that is made of these keys has a gain", remarks);
        group.idle(&["showTeachingInput"], "is about a window", remarks);
        group.idle(&["inputsList", "outputsList"], "all sensors and motors of the robot are the network's", remarks);
        let same_genes = remarks.count_left() == before;
        Self { hidden, hidden_neurons, range, largest_bias, flags, same_genes }
    }

    pub(super) fn write(&self, out: &mut Written) {
        out.table("[network]");
        // The smallest gene is the largest weight.
        let weights = numbers(&[self.range, -self.range]);
        if self.is_perceptron() {
            out.word("kind", "perceptron");
            out.word("order", "outputs");
            out.set("weights", weights);
            return;
        }
        out.word("kind", "evonet");
        out.set("hidden", self.hidden);
        if self.hidden > 0 {
            out.word("hidden_neurons", self.hidden_neurons);
        }
        // Biases are the default of the experiment file.
        for word in ["hidden_biases", "output_biases"] {
            out.set(word, self.flags.contains(&word));
        }
        for word in self.flags.iter().filter(|word| !word.ends_with("biases")) {
            out.set(word, true);
        }
        out.set("weights", weights);
        out.set("largest_bias", number(self.largest_bias));
    }

    /// Returns true for one layer with biases in the range of the weights.
    fn is_perceptron(&self) -> bool {
        self.hidden == 0 && self.flags == ["output_biases"] && self.largest_bias == self.range
    }
}

/// Returns true for the second of two types of neurons.
fn neurons(group: &Group, [key, plain, leaky]: [&'static str; 3], remarks: &mut Remarks) -> bool {
    let Some(entry) = group.text(key, remarks) else { return false };
    match &*entry.value.to_ascii_lowercase() {
        word if word == leaky => return true,
        word if word == plain || (key == "hiddenNeuronType" && word == "binary") => {}
        "logistic_0.2" => remarks.lost(group, entry, "the slope of hidden neurons is 1 here"),
        _ => remarks.lost(group, entry, &format!("is no type of neurons of the original; taken for `{plain}`")),
    }
    false
}
