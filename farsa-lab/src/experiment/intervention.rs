//! Changes of a controller in a test: silent neurons, cut inputs and links, noise.

use std::borrow::Cow;
use std::ops::Range;

use farsa_nn::Lesion;

use crate::experiment::outcome::ChannelGroup;

/// Change of a controller in a test. To get the change of an evaluation, use
/// [`Interventions::applied`](crate::advanced::Interventions::applied).
///
/// If you implement [`Rollout::load`](crate::advanced::Rollout::load), apply it in two steps. Use
/// [`edited`](Self::edited) for the parameters, and
/// [`NormalizedController::intervene`](crate::advanced::NormalizedController::intervene) for everything else.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Intervention {
    /// Neurons that are held at a fixed activation.
    pub lesions: Vec<Lesion>,
    /// Inputs that are held at a fixed value. If observations are normalized, 0 is their mean.
    pub inputs: Vec<(Range<usize>, f32)>,
    /// Amplitude of noise. At every step, a random number of at most this magnitude is added to each input.
    pub noise: f32,
    /// Parameters with fixed values, given by their index in the network.
    pub parameters: Vec<(usize, f32)>,
}

/// Nothing is done.
pub(crate) static NOTHING: Intervention =
    Intervention { lesions: Vec::new(), inputs: Vec::new(), noise: 0.0, parameters: Vec::new() };

impl Intervention {
    /// Silences a single neuron.
    pub fn lesion(neuron: usize) -> Self {
        Self { lesions: vec![Lesion::new(neuron)], ..Self::default() }
    }

    /// Cuts a range of inputs, so that they are 0.
    pub fn cut(inputs: Range<usize>) -> Self {
        Self { inputs: vec![(inputs, 0.0)], ..Self::default() }
    }

    /// Adds noise of up to `level` to every input.
    pub fn noise(level: f32) -> Self {
        Self { noise: level, ..Self::default() }
    }

    /// Cuts links, given by the index of their weight in the network.
    pub fn cut_links(weights: impl IntoIterator<Item = usize>) -> Self {
        Self { parameters: weights.into_iter().map(|weight| (weight, 0.0)).collect(), ..Self::default() }
    }

    /// Combines two changes. If both of them hold the same part or add noise, `other` takes precedence.
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        let mut both = self.clone();
        both.lesions.extend_from_slice(&other.lesions);
        both.inputs.extend_from_slice(&other.inputs);
        both.parameters.extend_from_slice(&other.parameters);
        both.noise = if other.noise > 0.0 { other.noise } else { both.noise };
        both
    }

    /// Applies the change to the parameters of a network. Indices beyond the network are ignored.
    pub fn edited<'p>(&self, parameters: &'p [f32]) -> Cow<'p, [f32]> {
        if self.parameters.is_empty() {
            return Cow::Borrowed(parameters);
        }
        let mut edited = parameters.to_vec();
        for (number, value) in &self.parameters {
            if let Some(parameter) = edited.get_mut(*number) {
                *parameter = *value;
            }
        }
        Cow::Owned(edited)
    }
}

/// Converts consecutive groups of inputs to ranges.
pub fn input_ranges<'g>(
    groups: impl IntoIterator<Item = &'g ChannelGroup>,
) -> impl Iterator<Item = (String, Range<usize>)> {
    groups.into_iter().scan(0, |first, group| {
        let range = *first..*first + group.count;
        *first = range.end;
        Some((group.name.clone(), range))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_are_done_and_of_the_same_part_the_second() {
        let groups = [ChannelGroup::new("eyes", 3, ""), ChannelGroup::new("skin", 2, "")];
        let ranges: Vec<_> = input_ranges(&groups).collect();
        assert_eq!(ranges, [("eyes".to_owned(), 0..3), ("skin".to_owned(), 3..5)]);
        let links = Intervention::cut_links([2, 1]);
        let both = Intervention::cut(0..3).and(&links).and(&Intervention::lesion(4));
        let (lesions, inputs) = (vec![Lesion::new(4)], vec![(0..3, 0.0)]);
        assert_eq!(both, Intervention { lesions, inputs, noise: 0.0, parameters: vec![(2, 0.0), (1, 0.0)] });
        let noisy = Intervention::noise(0.25);
        assert_eq!([noisy.and(&links).noise, noisy.and(&Intervention::noise(0.5)).noise], [0.25, 0.5]);
        // A parameter that there is not changes nothing.
        let edited = both.and(&Intervention { parameters: vec![(1, 0.5), (9, 1.0)], ..Intervention::default() });
        assert_eq!(*edited.edited(&[1.0, 2.0, 3.0]), [1.0, 0.5, 0.0]);
        assert!(matches!(Intervention::lesion(0).edited(&[1.0]), Cow::Borrowed([1.0])));
    }
}
