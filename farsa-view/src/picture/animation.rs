//! Animated PNG.

use crate::error::Error;
use crate::picture::camera::Camera;
use crate::picture::moment::Picture;
use crate::picture::png::encode;

/// Most pictures of an animation.
const MAX_PICTURES: usize = 1000;

/// Returns an endless animated PNG of pictures of `size` [pixels], each shown for the given time [ms].
///
/// All pictures share one view that contains all of them.
///
/// # Errors
/// [`Error::Size`] for an invalid size, and for no picture or more than a thousand.
pub(crate) fn animation(
    pictures: &[Picture],
    camera: Camera,
    size: [u32; 2],
    milliseconds: u16,
) -> Result<Vec<u8>, Error> {
    if pictures.is_empty() || pictures.len() > MAX_PICTURES {
        return Err(Error::Size {
            size,
            why: format!("{} pictures; an animation has 1 to {MAX_PICTURES}", pictures.len()),
        });
    }
    let window = camera.fit(pictures.iter().flat_map(|picture| picture.interest(camera.is_close())).collect(), size);
    encode(pictures, &window, size, Some(milliseconds))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::appearance::{Instance, Role};
    use crate::shape::geometry::Geometry;
    use farsa_body::Pose;

    #[test]
    fn all_pictures_are_seen_through_one_window() {
        let at = |x: f64| {
            let ball = Instance::new(Geometry::Sphere { radius: 0.1 }, Pose::at([x, 0.0, 0.0]), Role::Object);
            Picture { shapes: vec![ball], ..Picture::default() }
        };
        let pictures = [at(0.0), at(0.5), at(1.0)];
        let camera = Camera::named("top").unwrap();
        let bytes = animation(&pictures, camera, [60, 40], 40).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes[..])).read_info().unwrap();
        assert_eq!(
            reader.info().animation_control().map(|control| (control.num_frames, control.num_plays)),
            Some((3, 0))
        );
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        let mut balls = Vec::new();
        for _ in 0..3 {
            reader.next_frame(&mut data).unwrap();
            let frame = reader.info().frame_control().unwrap();
            assert_eq!((frame.delay_num, frame.delay_den), (40, 1000));
            // The number and the mean place of pixels that are redder than the background.
            let red: Vec<usize> = data
                .as_chunks::<3>()
                .0
                .iter()
                .enumerate()
                .filter(|(_, c)| c[0] > c[2].saturating_add(60))
                .map(|(i, _)| i)
                .collect();
            assert!(red.len() > 20, "{}", red.len());
            let middle = |of: fn(usize) -> usize| red.iter().map(|i| of(*i) as f64).sum::<f64>() / red.len() as f64;
            balls.push((red.len() as f64, [middle(|i| i % 60), middle(|i| i / 60)]));
        }
        // The ball keeps its size and moves in equal steps.
        let way = |a: usize| [0, 1].map(|i| balls[a + 1].1[i] - balls[a].1[i]);
        let length = |[x, y]: [f64; 2]| x.hypot(y);
        assert!(balls.iter().all(|(count, _)| (count / balls[0].0 - 1.0).abs() < 0.2), "{balls:?}");
        assert!(length(way(0)) > 8.0 && length([way(0)[0] - way(1)[0], way(0)[1] - way(1)[1]]) < 1.0, "{balls:?}");
        assert!(animation(&[], camera, [60, 40], 40).is_err());
        assert!(animation(&vec![at(0.0); MAX_PICTURES + 1], camera, [60, 40], 40).is_err());
    }
}
