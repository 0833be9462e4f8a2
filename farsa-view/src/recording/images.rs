//! Camera images, with two bytes per pixel and none for a repeated image.

use std::iter;
use std::ops::Range;

use crate::recording::schema::ImageChannel;

/// Most pixels of a recording, 8 MB or 5461 different images of 32 x 24 pixels.
const MAX_PIXELS: usize = 1 << 22;
/// Largest counts of red, green and blue.
const MAX_COUNTS: [f32; 3] = [31.0, 63.0, 31.0];
/// First bit of red, green and blue in a pixel.
const SHIFT: [u32; 3] = [11, 5, 0];

/// Images of a recording, including those of the current tick.
#[derive(Clone, Debug, Default)]
pub(crate) struct Images {
    /// Number of images.
    count: usize,
    /// Range of each image among the pixels of a tick.
    ranges: Vec<Range<usize>>,
    /// All images of the current tick, and true for those with a pixel.
    now: Vec<u16>,
    told: Vec<bool>,
    /// Stored pixels.
    pixels: Vec<u16>,
    /// First stored pixel of each image, ticks x images.
    starts: Vec<Option<u32>>,
    /// First pixel of the last stored image of each.
    last: Vec<Option<u32>>,
}

impl Images {
    /// Creates an empty recording of images.
    pub(crate) fn new(channels: &[ImageChannel]) -> Self {
        let mut end = 0_usize;
        let ranges: Vec<Range<usize>> = channels
            .iter()
            .map(|channel| {
                // An image above the limit is never stored, and images on the ground are stored as changes.
                let begin = end;
                let kept = |pixels: &usize| channel.ground.is_none() && *pixels <= MAX_PIXELS;
                end += Some(channel.pixels()).filter(kept).unwrap_or(0);
                begin..end
            })
            .collect();
        let count = channels.len();
        let (told, last) = (vec![false; count], vec![None; count]);
        Self { count, ranges, now: vec![0; end], told, last, ..Self::default() }
    }

    /// Records a pixel of the current tick.
    pub(crate) fn pixel(&mut self, image: usize, pixel: usize, color: [f32; 3]) {
        let Some(range) = self.ranges.get(image) else { return };
        if let Some(to) = self.now[range.clone()].get_mut(pixel) {
            *to = packed(color);
            self.told[image] = true;
        }
    }

    /// Ends the tick.
    pub(crate) fn tick(&mut self) {
        for (image, range) in self.ranges.iter().enumerate() {
            let seen = &self.now[range.clone()];
            let like_last = |start: &u32| {
                self.pixels.get(*start as usize..*start as usize + seen.len()).is_some_and(|last| last == seen)
            };
            let start = if !self.told[image] {
                None
            } else if let Some(start) = self.last[image].filter(like_last) {
                Some(start)
            } else if self.pixels.len() + seen.len() <= MAX_PIXELS {
                let start = Some(self.pixels.len() as u32);
                self.pixels.extend_from_slice(seen);
                self.last[image] = start;
                start
            } else {
                None
            };
            self.starts.push(start);
        }
        self.now.fill(0);
        self.told.fill(false);
    }

    /// Returns an image at a tick.
    pub(crate) fn at(&self, tick: usize, image: usize) -> Option<impl Iterator<Item = [f32; 3]> + '_> {
        let range = self.ranges.get(image)?;
        let start = (*self.starts.get(tick * self.count + image)?)? as usize;
        let pixels = self.pixels.get(start..start + range.len())?;
        Some(pixels.iter().map(|pixel| unpacked(*pixel)))
    }

    /// Iterates over the first pixel of an image at each tick, `u32::MAX` without an image.
    pub(crate) fn starts(&self, image: usize) -> impl Iterator<Item = u32> + '_ {
        let of_image = self.starts.iter().skip(image).step_by(self.count.max(1));
        of_image.map(|start| start.unwrap_or(u32::MAX))
    }

    /// Returns all stored pixels.
    pub(crate) fn pixels(&self) -> &[u16] {
        &self.pixels
    }
}

/// Converts a color to counts of 5, 6 and 5 bits. NaN becomes 0.
pub(super) fn packed(color: [f32; 3]) -> u16 {
    let counts =
        iter::zip(color, MAX_COUNTS).map(|(shade, largest)| (shade * largest).round().clamp(0.0, largest) as u16);
    iter::zip(counts, SHIFT).fold(0, |pixel, (count, shift)| pixel | count << shift)
}

pub(super) fn unpacked(pixel: u16) -> [f32; 3] {
    core::array::from_fn(|k| f32::from((pixel >> SHIFT[k]) & MAX_COUNTS[k] as u16) / MAX_COUNTS[k])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn image(images: &Images, tick: usize, image: usize) -> Option<Vec<[f32; 3]>> {
        images.at(tick, image).map(Iterator::collect)
    }

    #[test]
    fn images_come_back_and_equal_ones_take_no_room() {
        let channels = [ImageChannel::new("left", [2, 1]), ImageChannel::new("right", [1, 3])];
        let mut images = Images::new(&channels);
        let (red, blue, black) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
        images.pixel(0, 1, red);
        images.pixel(1, 0, blue);
        // These pixels do not belong to an image.
        images.pixel(0, 2, red);
        images.pixel(2, 0, red);
        images.tick();
        images.pixel(0, 1, red);
        images.tick();
        images.pixel(0, 0, red);
        images.tick();
        assert_eq!(image(&images, 0, 0), Some(vec![black, red]));
        assert_eq!(image(&images, 0, 1), Some(vec![blue, black, black]));
        assert_eq!(image(&images, 1, 0), Some(vec![black, red]));
        assert_eq!((image(&images, 1, 1), image(&images, 3, 0), image(&images, 0, 2)), (None, None, None));
        assert_eq!(image(&images, 2, 0), Some(vec![red, black]));
        assert_eq!(images.pixels().len(), 2 + 3 + 2);
        assert_eq!(images.starts(0).collect::<Vec<_>>(), [0, 0, 5]);
        assert_eq!(images.starts(1).collect::<Vec<_>>(), [2, u32::MAX, u32::MAX]);
    }

    #[test]
    fn no_more_than_the_most_is_kept() {
        let mut images =
            Images::new(&[ImageChannel::new("eye", [1 << 10, 1 << 10]), ImageChannel::new("vast", [1 << 20, 1 << 20])]);
        for tick in 0..6 {
            images.pixel(0, tick, [1.0; 3]);
            images.pixel(1, 0, [1.0; 3]);
            images.tick();
        }
        assert_eq!(images.pixels().len(), MAX_PIXELS);
        let kept: Vec<bool> = (0..6).map(|tick| images.at(tick, 0).is_some()).collect();
        assert_eq!(kept, [true, true, true, true, false, false]);
        assert!((0..6).all(|tick| images.at(tick, 1).is_none()));
    }

    proptest! {
        #[test]
        fn a_colour_is_kept_within_half_a_count(color in proptest::array::uniform3(0.0_f32..=1.0)) {
            let read = unpacked(packed(color));
            for k in 0..3 {
                prop_assert!((read[k] - color[k]).abs() <= 0.5001 / MAX_COUNTS[k], "{color:?} {read:?}");
            }
            prop_assert_eq!(packed(read), packed(color));
        }
    }
}
