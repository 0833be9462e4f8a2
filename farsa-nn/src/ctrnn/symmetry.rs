//! Bilateral symmetry, in which each gene determines all parameters that are equal.

use crate::block::description::Span;
use crate::ctrnn::layout::{CtrnnLayout, CtrnnParameter};
use crate::error::Error;
use crate::fault::{LayoutFault, Slice};

/// A mapping from a small number of genes to all parameters of a mirror-symmetric [`Ctrnn`](crate::Ctrnn).
///
/// The weight from `j` to `i` equals the weight from the mirror image of `j` to the mirror image of `i`. Biases, gains
/// and time constants equal those of the mirror image. In addition, neurons can be alike and links can be absent. Genes
/// are ordered by the first parameter that they determine.
///
/// ```
/// use farsa_nn::block::Span;
/// use farsa_nn::{CtrnnLayout, CtrnnSymmetry};
///
/// // Beer's agent: seven alike ray neurons, five inner ones, two motors. Each layer is mirrored on itself.
/// const LAYOUT: CtrnnLayout = CtrnnLayout::new(7, 14, 2).with_direct_inputs(0);
/// const RAYS: Span = Span::new(0, 7);
/// const INNER: Span = Span::new(7, 5);
/// const MOTORS: Span = Span::new(12, 2);
/// let symmetry = CtrnnSymmetry::new(LAYOUT, &[], &[6, 5, 4, 3, 2, 1, 0, 11, 10, 9, 8, 7, 13, 12])?
///     .with_links(&[(RAYS, INNER), (INNER, INNER), (INNER, MOTORS)])?
///     .with_alike(&[RAYS])?
///     .with_gains(&[RAYS])?;
/// assert_eq!(symmetry.gene_count(), 47);
/// let mut parameters = [0.0; LAYOUT.parameter_count()];
/// symmetry.expand(&[1.5; 47], &mut parameters)?;
/// assert_eq!(LAYOUT.split(&parameters).gains[6..8], [1.5, 1.0]);
/// # Ok::<(), farsa_nn::Error>(())
/// ```
///
/// Source: `[Beer1996]`. It reports the number of genes of its agent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CtrnnSymmetry<'a> {
    layout: CtrnnLayout,
    inputs: &'a [usize],
    neurons: &'a [usize],
    /// `None` for all.
    links: Option<&'a [(Span, Span)]>,
    alike: &'a [Span],
    /// `None` for all.
    gains: Option<&'a [Span]>,
}

/// The origin of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Origin {
    /// Its own gene.
    Gene,
    /// Parameter at this lower index.
    Parameter(usize),
    Constant(f32),
}

impl<'a> CtrnnSymmetry<'a> {
    /// Creates a symmetry. The slices contain the mirror image of each input and of each neuron. The list of inputs is
    /// empty if inputs are direct. An element in the middle is its own mirror image.
    ///
    /// # Errors
    /// Returns [`Error::Length`], or [`Error::Layout`] if a mirror image does not exist or has a different mirror
    /// image.
    pub fn new(layout: CtrnnLayout, inputs: &'a [usize], neurons: &'a [usize]) -> Result<Self, Error> {
        let weighted = if layout.direct_inputs().is_some() { 0 } else { layout.inputs() };
        for (images, expected) in [(inputs, weighted), (neurons, layout.neurons())] {
            Slice::MirrorImages.check(expected, images.len())?;
            let asymmetric = |(index, image): &(usize, &usize)| images.get(**image) != Some(index);
            if let Some((index, &image)) = images.iter().enumerate().find(asymmetric) {
                return Err(LayoutFault::Mirror { index, image }.into());
            }
        }
        Ok(Self { layout, inputs, neurons, links: None, alike: &[], gains: None })
    }

    /// Restricts the links to the given pairs of spans and to their mirror images. All neurons of the first span are
    /// connected to all neurons of the second one. All other weights between neurons are zero.
    ///
    /// # Errors
    /// Returns [`Error::Layout`] if a span contains neurons that do not exist.
    pub fn with_links(self, links: &'a [(Span, Span)]) -> Result<Self, Error> {
        links.iter().try_for_each(|(sources, targets)| self.check(*sources).and(self.check(*targets)))?;
        Ok(Self { links: Some(links), ..self })
    }

    /// Uses a common bias, gain and time constant for all neurons of a span.
    ///
    /// # Errors
    /// Returns [`Error::Layout`] if neurons do not exist or if spans overlap. The same error is returned if the mirror
    /// images of a span are not exactly the neurons of another or the same span.
    pub fn with_alike(self, alike: &'a [Span]) -> Result<Self, Error> {
        for (index, span) in alike.iter().enumerate() {
            self.check(*span)?;
            let shares = |other: &Span| span.first.max(other.first) < span.end().min(other.end());
            let opposite = |neuron| alike.iter().find(|other| other.contains(image(self.neurons, neuron)));
            let mirrored = opposite(span.first).is_some_and(|other| other.count == span.count)
                && (span.first..span.end()).all(|neuron| opposite(neuron) == opposite(span.first));
            if alike[..index].iter().any(shares) || span.count > 0 && !mirrored {
                return Err(LayoutFault::Alike { first: span.first, count: span.count }.into());
            }
        }
        Ok(Self { alike, ..self })
    }

    /// Restricts the genes for gains to the given neurons and to their mirror images. All other gains are 1. If neurons
    /// are alike, the first of them determines if there is a gene.
    ///
    /// # Errors
    /// Returns [`Error::Layout`] if a span contains neurons that do not exist.
    pub fn with_gains(self, gains: &'a [Span]) -> Result<Self, Error> {
        gains.iter().try_for_each(|span| self.check(*span))?;
        Ok(Self { gains: Some(gains), ..self })
    }

    fn check(&self, span: Span) -> Result<(), Error> {
        let (Span { first, count }, neurons) = (span, self.layout.neurons());
        if span.end() > neurons { Err(LayoutFault::Neurons { first, count, neurons }.into()) } else { Ok(()) }
    }

    /// Returns the number of genes.
    pub fn gene_count(&self) -> usize {
        self.kinds().count()
    }

    /// Returns an iterator over the kinds of all genes. This is useful for decoding a genome.
    pub fn kinds(&self) -> impl Iterator<Item = CtrnnParameter> + use<'a> {
        let symmetry = *self;
        let genes = symmetry.layout.kinds().enumerate();
        genes.filter(move |(index, kind)| symmetry.origin(*kind, *index) == Origin::Gene).map(|(_, kind)| kind)
    }

    /// Computes all parameters from decoded genes. The slices must have the lengths
    /// [`parameter_count`](CtrnnLayout::parameter_count) and [`gene_count`](Self::gene_count).
    ///
    /// # Errors
    /// Returns [`Error::Length`] if a slice has a different length. In this case the parameters are unchanged.
    pub fn expand(&self, genes: &[f32], parameters: &mut [f32]) -> Result<(), Error> {
        Slice::Parameters.check(self.gene_count(), genes.len())?;
        Slice::Parameters.check(self.layout.parameter_count(), parameters.len())?;
        let mut genes = genes.iter();
        for (index, kind) in self.layout.kinds().enumerate() {
            let value = match self.origin(kind, index) {
                Origin::Gene => genes.next().copied(),
                Origin::Parameter(first) => parameters.get(first).copied(),
                Origin::Constant(value) => Some(value),
            };
            if let (Some(to), Some(value)) = (parameters.get_mut(index), value) {
                *to = value;
            }
        }
        Ok(())
    }

    fn origin(&self, kind: CtrnnParameter, index: usize) -> Origin {
        let start = self.layout.range(kind).start;
        let place = index - start;
        let neurons = self.layout.neurons().max(1);
        let (from, to) = (place / neurons, place % neurons);
        let mirrored = image(self.neurons, to);
        let first = match kind {
            CtrnnParameter::Weight if !self.linked(from, to) => return Origin::Constant(0.0),
            CtrnnParameter::Weight => place.min(image(self.neurons, from) * neurons + mirrored),
            CtrnnParameter::InputWeight => place.min(image(self.inputs, from) * neurons + mirrored),
            _ => self.first_alike(place).min(self.first_alike(mirrored)),
        };
        if kind == CtrnnParameter::Gain && !self.has_gain(first) {
            return Origin::Constant(1.0);
        }
        if first == place { Origin::Gene } else { Origin::Parameter(start + first) }
    }

    /// Reports that the link or its mirror image exists.
    fn linked(&self, from: usize, to: usize) -> bool {
        let images = [from, to].map(|neuron| image(self.neurons, neuron));
        self.links.is_none_or(|links| {
            let has = |a, b| links.iter().any(|(sources, targets)| sources.contains(a) && targets.contains(b));
            has(from, to) || has(images[0], images[1])
        })
    }

    /// Reports that the gain of the neuron or of its mirror image is a gene.
    fn has_gain(&self, neuron: usize) -> bool {
        let mirrored = image(self.neurons, neuron);
        self.gains.is_none_or(|spans| spans.iter().any(|span| span.contains(neuron) || span.contains(mirrored)))
    }

    fn first_alike(&self, neuron: usize) -> usize {
        self.alike.iter().find(|span| span.contains(neuron)).map_or(neuron, |span| span.first)
    }
}

/// The mirror image of an input or a neuron.
fn image(images: &[usize], index: usize) -> usize {
    images.get(index).copied().unwrap_or(index)
}
