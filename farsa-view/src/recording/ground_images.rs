//! Images on the ground, stored as changes.

use std::ops::Range;

use crate::recording::images::{packed, unpacked};
use crate::recording::schema::ImageChannel;

/// Most pixels of an image, because pages number them in 16 bits.
const MAX_PIXELS: usize = u16::MAX as usize;
/// Most changes of a recording, 8 MB.
const MAX_CHANGES: usize = 1 << 21;

/// A pixel with another color than at the previous tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Change {
    /// Index of the pixel, row by row.
    pub(crate) pixel: u16,
    /// Color, with 5 bits red, 6 green and 5 blue from the highest bit.
    pub(crate) shade: u16,
}

/// An image on the ground.
#[derive(Clone, Debug, Default)]
struct GroundImage {
    /// Image of the current tick, and true if it has a pixel.
    now: Vec<u16>,
    told: bool,
    /// Last stored image.
    last: Vec<u16>,
    changes: Vec<Change>,
    /// End of the changes of each tick, and the first tick of the image.
    ends: Vec<usize>,
    first: Option<usize>,
}

impl GroundImage {
    /// Ends the tick with at most the given number of changes, and returns their number.
    fn tick(&mut self, room: usize) -> usize {
        let Self { now, told, last, changes, ends, first } = self;
        let before = changes.len();
        if *told {
            let differs = now.iter().zip(&mut *last).zip(0..).filter(|((now, last), _)| **now != **last);
            for ((now, last), pixel) in differs.take(room) {
                *last = *now;
                changes.push(Change { pixel, shade: *now });
            }
            first.get_or_insert(ends.len());
        }
        ends.push(changes.len());
        now.fill(0);
        *told = false;
        changes.len() - before
    }

    fn of_tick(&self, tick: usize) -> Range<usize> {
        let begin = tick.checked_sub(1).and_then(|before| self.ends.get(before)).copied().unwrap_or(0);
        begin..self.ends.get(tick).copied().unwrap_or(begin)
    }
}

/// All images on the ground, by their index in the schema.
#[derive(Clone, Debug, Default)]
pub(crate) struct GroundImages {
    images: Vec<Option<GroundImage>>,
    changes: usize,
}

impl GroundImages {
    /// Creates black images for those of the schema that are on the ground.
    pub(crate) fn new(channels: &[ImageChannel]) -> Self {
        let image = |channel: &ImageChannel| {
            let black = vec![0; Some(channel.pixels()).filter(|pixels| *pixels <= MAX_PIXELS)?];
            channel.ground.map(|_| GroundImage { now: black.clone(), last: black, ..GroundImage::default() })
        };
        Self { images: channels.iter().map(image).collect(), changes: 0 }
    }

    fn image(&self, image: usize) -> Option<&GroundImage> {
        self.images.get(image)?.as_ref()
    }

    /// Records a pixel of the current tick.
    pub(crate) fn pixel(&mut self, image: usize, pixel: usize, color: [f32; 3]) {
        let Some(Some(image)) = self.images.get_mut(image) else { return };
        if let Some(to) = image.now.get_mut(pixel) {
            *to = packed(color);
            image.told = true;
        }
    }

    /// Ends the tick.
    pub(crate) fn tick(&mut self) {
        for image in self.images.iter_mut().flatten() {
            self.changes += image.tick(MAX_CHANGES - self.changes);
        }
    }

    /// Returns the changes of an image at a tick, or the pixels that are not black at the first.
    pub(crate) fn changes(&self, tick: usize, image: usize) -> &[Change] {
        let Some(image) = self.image(image) else { return &[] };
        image.changes.get(image.of_tick(tick)).unwrap_or(&[])
    }

    /// Returns an image as last recorded up to a tick.
    pub(crate) fn at(&self, tick: usize, image: usize) -> Option<impl Iterator<Item = [f32; 3]> + use<>> {
        let image = self.image(image)?;
        let there = tick < image.ends.len() && tick >= image.first?;
        let mut pixels = vec![0; image.last.len()];
        for change in image.changes.get(..image.of_tick(tick).end)? {
            pixels[usize::from(change.pixel)] = change.shade;
        }
        there.then(|| pixels.into_iter().map(unpacked))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const GREEN: [f32; 3] = [0.0, 1.0, 0.0];

    fn lying(size: [usize; 2]) -> ImageChannel {
        ImageChannel::new("food", size).on_ground([0.0; 2], [1.0; 2])
    }

    #[test]
    fn what_changes_is_kept_and_stays_until_it_changes() {
        let channels = [ImageChannel::new("eye", [2, 2]), lying([2, 2]), lying([256, 256])];
        let mut grounds = GroundImages::new(&channels);
        grounds.tick();
        grounds.pixel(1, 0, GREEN);
        grounds.pixel(1, 3, GREEN);
        // These pixels do not belong to an image on the ground.
        for (image, pixel) in [(0, 0), (1, 4), (2, 0), (3, 0)] {
            grounds.pixel(image, pixel, GREEN);
        }
        grounds.tick();
        grounds.tick();
        grounds.pixel(1, 3, GREEN);
        grounds.tick();
        let seen = |tick| grounds.at(tick, 1).map(|pixels| pixels.map(|color| color[1]).collect::<Vec<_>>());
        let both = Some(vec![1.0, 0.0, 0.0, 1.0]);
        assert_eq!((seen(0), seen(1), seen(2)), (None, both.clone(), both));
        assert_eq!((seen(3), seen(4)), (Some(vec![0.0, 0.0, 0.0, 1.0]), None));
        assert_eq!(grounds.changes(3, 1), [Change { pixel: 0, shade: 0 }]);
        assert_eq!([0, 1, 2, 3, 4].map(|tick| grounds.changes(tick, 1).len()), [0, 2, 0, 1, 0]);
        assert!(grounds.at(1, 0).is_none() && grounds.at(1, 2).is_none() && grounds.at(1, 3).is_none());
    }

    #[test]
    fn no_more_than_the_most_is_kept() {
        let mut grounds = GroundImages::new(&[lying([255, 256])]);
        for tick in 0..60_u8 {
            (0..255 * 256).for_each(|pixel| grounds.pixel(0, pixel, [f32::from(tick % 2), 0.0, 1.0]));
            grounds.tick();
        }
        assert_eq!(grounds.changes, MAX_CHANGES);
        let counted: Vec<usize> = (0..60).map(|tick| grounds.changes(tick, 0).len()).collect();
        let full = MAX_CHANGES / (255 * 256);
        assert!(counted[..full].iter().all(|count| *count == 255 * 256) && counted[full + 1..].iter().all(|c| *c == 0));
        assert!(grounds.at(59, 0).is_some());
    }

    proptest! {
        /// Compares with complete images.
        #[test]
        fn every_image_comes_back(
            frames in prop::collection::vec(prop::option::of(prop::collection::vec(0_u8..3, 6)), 1..20),
        ) {
            let mut grounds = GroundImages::new(&[lying([3, 2])]);
            let mut whole = Vec::new();
            for frame in &frames {
                for (pixel, shade) in frame.iter().flatten().enumerate() {
                    grounds.pixel(0, pixel, [f32::from(*shade) / 31.0, 0.0, 1.0]);
                }
                grounds.tick();
                let color = |shade: &u8| [f32::from(*shade) / 31.0, 0.0, 1.0];
                let now = frame.as_ref().map(|frame| frame.iter().map(color).collect::<Vec<_>>());
                whole.push(now.or_else(|| whole.last().cloned().flatten()));
            }
            for (tick, expected) in whole.into_iter().enumerate() {
                prop_assert_eq!(grounds.at(tick, 0).map(Iterator::collect::<Vec<_>>), expected);
            }
        }
    }
}
