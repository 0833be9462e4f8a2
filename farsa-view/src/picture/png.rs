//! Pictures as PNG, traced ray by ray.

use std::thread;

use crate::error::Error;
use crate::picture::camera::{Camera, Window};
use crate::picture::lit_scene::{BACKGROUND, LitScene, encoded, linear};
use crate::picture::marks::{self, Stroke};
use crate::picture::moment::Picture;
use crate::picture::outline::bounds;
use crate::shape::appearance::Color;
use crate::shape::vector::{Vector, add, mix, scale};

/// Number of rays along each side of a pixel at an edge.
const FINE: usize = 4;
/// Difference of colors of two corners above which there is an edge between them.
const EDGE: u8 = 5;

/// Returns a picture of `size` [pixels] as a PNG file, with equal bytes on every machine.
///
/// # Errors
/// [`Error::Size`] for an invalid size.
pub(crate) fn png(picture: &Picture, camera: Camera, size: [u32; 2]) -> Result<Vec<u8>, Error> {
    encode(std::slice::from_ref(picture), &picture.window(camera, size), size, None)
}

/// Returns the pixels of a picture of `size` [pixels], row by row from the upper left corner.
pub(crate) fn rgb(picture: &Picture, camera: Camera, size: [u32; 2]) -> Vec<u8> {
    pixels(picture, &picture.window(camera, size), size).as_flattened().to_vec()
}

/// Encodes pictures through one window, as an animation if each is shown for the given time [ms].
pub(super) fn encode(
    pictures: &[Picture],
    window: &Window,
    size: [u32; 2],
    milliseconds: Option<u16>,
) -> Result<Vec<u8>, Error> {
    let wrong = |error: png::EncodingError| Error::Size { size, why: error.to_string() };
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    if let Some(milliseconds) = milliseconds {
        encoder.set_animated(pictures.len() as u32, 0).map_err(wrong)?;
        encoder.set_frame_delay(milliseconds, 1000).map_err(wrong)?;
    }
    let mut writer = encoder.write_header().map_err(wrong)?;
    for picture in pictures {
        writer.write_image_data(pixels(picture, window, size).as_flattened()).map_err(wrong)?;
    }
    writer.finish().map_err(wrong)?;
    Ok(bytes)
}

/// Returns all pixels, row by row from the upper left corner.
fn pixels(picture: &Picture, view: &Window, size: [u32; 2]) -> Vec<Color> {
    let [width, height] = size.map(|x| x as usize);
    let scene = LitScene::new(picture, view);
    let canvas = Canvas { scene: &scene, view, boxes: boxes(&scene, view) };
    let mut pixels = vec![[0; 3]; width * height];
    // Bands of rows are drawn by any free thread. Pixels are independent, so the result does not depend on threads.
    let threads = thread::available_parallelism().map_or(1, usize::from).min(8);
    let bands: Vec<_> = pixels.chunks_mut((16 * width).max(1)).enumerate().collect();
    let bands = std::sync::Mutex::new(bands.into_iter());
    let work = || {
        loop {
            let band = bands.lock().map_or(None, |mut bands| bands.next());
            let Some((i, band)) = band else { break };
            canvas.draw(band, 16 * i, width);
        }
    };
    thread::scope(|scope| {
        for _ in 1..threads {
            scope.spawn(work);
        }
        work();
    });
    for stroke in marks::strokes(picture, &scene, view) {
        paint(&mut pixels, size, &stroke);
    }
    pixels
}

/// Lists the bounds of each solid in the picture, `[low, high]`.
fn boxes(scene: &LitScene, view: &Window) -> Vec<[[f64; 2]; 2]> {
    let everywhere = [[f64::NEG_INFINITY; 2], [f64::INFINITY; 2]];
    let place = |solid: &crate::picture::lit_scene::Solid| {
        let rim = solid.geometry.rim(solid.sight(view), 32);
        let places: Option<Vec<_>> = rim.into_iter().map(|p| view.project(solid.pose.transform(p))).collect();
        let [low, high] = bounds(&places.filter(|places| !places.is_empty())?);
        // The circle exceeds its polygon by less than 1/200 of its radius.
        let spare = [0, 1].map(|i| 2.0 + 0.01 * (high[i] - low[i]));
        Some([[low[0] - spare[0], low[1] - spare[1]], [high[0] + spare[0], high[1] + spare[1]]])
    };
    scene.solids.iter().map(|solid| place(solid).unwrap_or(everywhere)).collect()
}

struct Canvas<'a> {
    scene: &'a LitScene,
    view: &'a Window,
    boxes: Vec<[[f64; 2]; 2]>,
}

/// Light through a point of the picture and its solid.
#[derive(Clone, Copy)]
struct Sample {
    solid: Option<usize>,
    light: Vector,
}

impl Canvas<'_> {
    /// Returns the light of a place, from the solids of its band.
    fn sample(&self, x: f64, y: f64, solids: &[usize]) -> Sample {
        let (origin, direction) = self.view.ray([x, y]);
        let here = |i: &usize| {
            let [low, high] = self.boxes[*i];
            x >= low[0] && x <= high[0] && y >= low[1] && y <= high[1]
        };
        let seen = self.scene.see(origin, direction, solids.iter().copied().filter(here));
        match seen {
            Some(seen) => Sample { solid: Some(seen.solid), light: self.scene.shade(self.view, &seen, true) },
            None => Sample { solid: None, light: linear(BACKGROUND) },
        }
    }

    /// Draws a band of rows from `top`, with a ray through every corner and more rays at edges.
    fn draw(&self, band: &mut [Color], top: usize, width: usize) {
        let [first, last] = [top, top + band.len() / width.max(1)].map(|y| y as f64);
        let near = |i: &usize| self.boxes[*i][0][1] <= last && self.boxes[*i][1][1] >= first;
        let solids: Vec<usize> = (0..self.boxes.len()).filter(near).collect();
        let corners =
            |y: usize| -> Vec<Sample> { (0..=width).map(|x| self.sample(x as f64, y as f64, &solids)).collect() };
        let mut above = corners(top);
        for (row, pixels) in band.chunks_mut(width.max(1)).enumerate() {
            let y = top + row;
            let below = corners(y + 1);
            for (x, pixel) in pixels.iter_mut().enumerate() {
                let four = [above[x], above[x + 1], below[x], below[x + 1]];
                let light = if edge(&four) {
                    self.fine(x, y, &solids)
                } else {
                    scale(four.iter().fold([0.0; 3], |sum, corner| add(sum, clamped(corner.light))), 0.25)
                };
                *pixel = encoded(light);
            }
            above = below;
        }
    }

    fn fine(&self, x: usize, y: usize, solids: &[usize]) -> Vector {
        let at = |i: usize, k: usize| i as f64 + (k as f64 + 0.5) / FINE as f64;
        let mut sum = [0.0; 3];
        for k in 0..FINE * FINE {
            sum = add(sum, clamped(self.sample(at(x, k % FINE), at(y, k / FINE), solids).light));
        }
        scale(sum, 1.0 / (FINE * FINE) as f64)
    }
}

/// Limits light to the range of a screen, so that a bright highlight has no jagged edge.
fn clamped(light: Vector) -> Vector {
    light.map(|x| x.clamp(0.0, 1.0))
}

fn edge(corners: &[Sample; 4]) -> bool {
    let colors = corners.map(|corner| encoded(corner.light));
    let range = |channel: usize| {
        let values = colors.iter().map(|color| color[channel]);
        values.clone().max().unwrap_or(0) - values.min().unwrap_or(0)
    };
    corners.iter().any(|corner| corner.solid != corners[0].solid) || (0..3).any(|channel| range(channel) > EDGE)
}

/// Paints a stroke over the pixels, with smooth edges.
fn paint(pixels: &mut [Color], size: [u32; 2], stroke: &Stroke) {
    let [width, height] = size.map(|x| x as usize);
    let [low, high] = bounds(&stroke.places);
    let margin = stroke.width / 2.0 + 1.0;
    let first = |x: f64| (x - margin).floor().max(0.0) as usize;
    let last = |x: f64, end: usize| ((x + margin).ceil().max(0.0) as usize).min(end);
    let (left, right) = (first(low[0]), last(high[0], width));
    let (top, bottom) = (first(low[1]), last(high[1], height));
    if left >= right || top >= bottom {
        return;
    }
    // The largest coverage of any piece, so that the ends of pieces are not covered twice.
    let mut covered = vec![0.0_f64; (right - left) * (bottom - top)];
    for ends in stroke.places.windows(2) {
        let [low, high] = bounds(ends);
        for y in first(low[1]).max(top)..last(high[1], bottom) {
            for x in first(low[0]).max(left)..last(high[0], right) {
                let off = marks::distance([x as f64 + 0.5, y as f64 + 0.5], ends[0], ends[1]);
                let share = (stroke.width / 2.0 + 0.5 - off).clamp(0.0, 1.0);
                let cell = &mut covered[(y - top) * (right - left) + x - left];
                *cell = cell.max(share);
            }
        }
    }
    let ink = linear(stroke.color);
    for y in top..bottom {
        for x in left..right {
            let share = covered[(y - top) * (right - left) + x - left] * stroke.opacity;
            if share > 0.0 {
                let pixel = &mut pixels[y * width + x];
                *pixel = encoded(mix(linear(*pixel), ink, share));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::appearance::{Instance, OKABE_ITO, Role};
    use crate::shape::geometry::Geometry;
    use farsa_body::Pose;

    fn ball(position: Vector) -> Instance {
        Instance::new(Geometry::Sphere { radius: 0.03 }, Pose::at(position), Role::Object)
    }

    #[test]
    fn the_sphere_is_where_it_is_projected() {
        let ground = Instance::new(Geometry::Plane, Pose::identity(), Role::Ground);
        let picture = Picture { shapes: vec![ball([0.1, -0.2, 0.03]), ground], ..Picture::default() };
        for name in Camera::NAMES {
            let camera = Camera::named(name).unwrap();
            let view = picture.window(camera, [90, 60]);
            let pixels = pixels(&picture, &view, [90, 60]);
            let [x, y] = view.project([0.1, -0.2, 0.03]).unwrap();
            let color = pixels[y as usize * 90 + x as usize].map(f64::from);
            // Equal hue: red, green and blue differ as in its own color.
            let role = OKABE_ITO[0].map(f64::from);
            let bright = color[0] / role[0];
            assert!((0.6..1.15).contains(&bright), "{name}: {color:?}");
            assert!((color[1] / role[1] / bright - 1.0).abs() < 0.2 && color[2] < 0.5 * color[0], "{name}: {color:?}");
        }
        let alone = Picture { shapes: vec![ball([0.0; 3])], ..Picture::default() };
        let pixels = pixels(&alone, &alone.window(Camera::default(), [90, 60]), [90, 60]);
        for corner in [0, 89, 59 * 90, 60 * 90 - 1] {
            assert_eq!(pixels[corner], BACKGROUND);
        }
    }

    #[test]
    fn the_nearer_box_hides_the_other() {
        let at = |x: f64, color| {
            let geometry = Geometry::Box { half: [0.1, 0.5, 0.5] };
            Instance::new(geometry, Pose::at([x, 0.0, 0.0]), Role::Object).with_color(color)
        };
        let [red, green] = [[200, 0, 0], [0, 200, 0]];
        for shapes in [[at(0.5, red), at(-0.5, green)], [at(-0.5, green), at(0.5, red)]] {
            let picture = Picture { shapes: shapes.to_vec(), ..Picture::default() };
            let camera = Camera::named("front").unwrap();
            let window = picture.window(camera, [80, 80]);
            let [x, y] = window.project([0.6, 0.0, 0.0]).unwrap();
            let [r, g, _] = pixels(&picture, &window, [80, 80])[y as usize * 80 + x as usize];
            assert!(r > 100 && g < 30, "{r} {g}");
        }
    }

    #[test]
    fn png_can_be_read_again() {
        let picture = Picture { shapes: vec![ball([0.0; 3])], ..Picture::default() };
        let bytes = png(&picture, Camera::default(), [33, 21]).unwrap();
        assert_eq!(bytes, png(&picture, Camera::default(), [33, 21]).unwrap());
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut data).unwrap();
        assert_eq!([info.width, info.height], [33, 21]);
        let window = picture.window(Camera::default(), [33, 21]);
        assert_eq!(data, pixels(&picture, &window, [33, 21]).as_flattened());
        assert!(png(&picture, Camera::default(), [0, 5]).is_err());
    }

    #[test]
    fn strokes_are_as_wide_as_they_say() {
        let mut pixels = vec![[255; 3]; 20 * 9];
        let line = Stroke { places: vec![[3.0, 4.5], [17.0, 4.5]], width: 3.0, color: [0; 3], opacity: 1.0 };
        paint(&mut pixels, [20, 9], &line);
        let column: Vec<u8> = (0..9).map(|y| pixels[y * 20 + 10][0]).collect();
        assert_eq!(column, [255, 255, 255, 0, 0, 0, 255, 255, 255]);
        let away = Stroke { places: vec![[-50.0, -4.0], [-30.0, 400.0]], ..line };
        paint(&mut pixels, [20, 9], &away);
    }
}
