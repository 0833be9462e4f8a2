//! Forces, rays, points and trails, as flat strokes on top of a picture.

use crate::picture::camera::Window;
use crate::picture::lit_scene::LitScene;
use crate::picture::moment::Picture;
use crate::picture::outline::Point2;
use crate::shape::appearance::{Color, OKABE_ITO};
use crate::shape::vector::{Vector, along, length, mix};

/// A line of even width.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stroke {
    /// Its corners [pixels].
    pub(crate) places: Vec<Point2>,
    /// Its width [pixels].
    pub(crate) width: f64,
    /// Its colour.
    pub(crate) color: Color,
    /// Its opacity [0..1].
    pub(crate) opacity: f64,
}

const FORCE: Color = [178, 24, 43];
const POINT: Color = OKABE_ITO[2];
const HIT: Color = OKABE_ITO[6];
const MISS: Color = [120, 120, 120];
const WHITE: Color = [255, 255, 255];
/// Opacity of hidden marks, which show through shapes.
const HIDDEN: f64 = 0.30;

/// Computes the length of a force of 1 N [m], `None` without forces.
pub(crate) fn metres_per_newton(picture: &Picture, view: &Window) -> Option<f64> {
    let largest = picture.contacts.iter().map(|push| length(push.force)).fold(0.0, f64::max);
    // The largest arrow has a seventh of the shorter edge.
    let [width, height] = view.size.map(f64::from);
    let longest = width.min(height) / 7.0 * view.pixel(view.centre);
    (largest > 0.0 && largest.is_finite()).then(|| longest / largest)
}

/// Returns all marks of a picture in drawing order.
pub(crate) fn strokes(picture: &Picture, scene: &LitScene, view: &Window) -> Vec<Stroke> {
    let [width, height] = view.size.map(f64::from);
    // Widths are for a picture 800 pixels high.
    let unit = width.min(height) / 800.0;
    let mut marks = Marks { scene, view, unit, strokes: Vec::new() };
    for ray in &picture.rays {
        let color = if ray.hit { HIT } else { MISS };
        marks.way(&[ray.from, ray.to], 1.6, color);
        if ray.hit {
            marks.dot(ray.to, 5.0, color);
        }
    }
    for (trail, color) in &picture.trails {
        marks.way(trail, 2.4, *color);
    }
    for (_, point) in &picture.points {
        marks.cross(*point);
    }
    if let Some(scale) = metres_per_newton(picture, view) {
        for push in &picture.contacts {
            marks.arrow(push.point, along(push.point, push.force, scale));
        }
    }
    marks.strokes
}

struct Marks<'a> {
    scene: &'a LitScene,
    view: &'a Window,
    unit: f64,
    strokes: Vec<Stroke>,
}

impl Marks<'_> {
    fn push(&mut self, places: Vec<Point2>, width: f64, color: Color, opacity: f64) {
        self.strokes.push(Stroke { places, width: width * self.unit, color, opacity });
    }

    /// Draws a trail in pieces of some pixels, faint where it is hidden.
    fn way(&mut self, points: &[Vector], width: f64, color: Color) {
        let mut piece: Vec<Point2> = Vec::new();
        let mut shown = true;
        for ends in points.windows(2) {
            let (Some(a), Some(b)) = (self.view.project(ends[0]), self.view.project(ends[1])) else {
                self.end(&mut piece, width, color, shown);
                continue;
            };
            let far = length([b[0] - a[0], b[1] - a[1], 0.0]);
            let pieces = (far / (4.0 * self.unit)).ceil().clamp(1.0, 1000.0) as usize;
            for i in 0..pieces {
                let at = |i: usize| mix(ends[0], ends[1], i as f64 / pieces as f64);
                let visible = self.scene.is_visible(self.view, mix(at(i), at(i + 1), 0.5));
                if visible != shown {
                    self.end(&mut piece, width, color, shown);
                    shown = visible;
                }
                if piece.is_empty() {
                    piece.extend(self.view.project(at(i)));
                }
                piece.extend(self.view.project(at(i + 1)));
            }
        }
        self.end(&mut piece, width, color, shown);
    }

    fn end(&mut self, piece: &mut Vec<Point2>, width: f64, color: Color, shown: bool) {
        if piece.len() > 1 {
            let places = thinned(piece, 0.25);
            self.push(places, width, color, if shown { 1.0 } else { HIDDEN });
        }
        piece.clear();
    }

    fn dot(&mut self, point: Vector, width: f64, color: Color) {
        let opacity = if self.scene.is_visible(self.view, point) { 1.0 } else { HIDDEN };
        if let Some(place) = self.view.project(point) {
            self.push(vec![place, place], width, color, opacity);
        }
    }

    fn cross(&mut self, point: Vector) {
        let Some([x, y]) = self.view.project(point) else { return };
        let opacity = if self.scene.is_visible(self.view, point) { 1.0 } else { 0.6 };
        let arm = 7.0 * self.unit;
        for (width, color) in [(4.6, WHITE), (2.2, POINT)] {
            self.push(vec![[x - arm, y], [x + arm, y]], width, color, opacity);
            self.push(vec![[x, y - arm], [x, y + arm]], width, color, opacity);
        }
    }

    /// Draws an arrow on top, because the source of a force is usually hidden by its target.
    fn arrow(&mut self, from: Vector, to: Vector) {
        let (Some(a), Some(b)) = (self.view.project(from), self.view.project(to)) else { return };
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        let far = length([x, y, 0.0]);
        let head = (11.0 * self.unit).min(0.6 * far);
        let mut parts = vec![vec![a, b]];
        if far > 2.0 * self.unit {
            let (x, y) = (x / far * head, y / far * head);
            let barb = |side: f64| [b[0] - x - side * 0.5 * y, b[1] - y + side * 0.5 * x];
            parts.push(vec![barb(1.0), b, barb(-1.0)]);
        } else {
            // It points toward the viewer or away.
            parts = vec![vec![a, a]];
        }
        for (width, color, opacity) in [(6.2, WHITE, 0.85), (3.0, FORCE, 1.0)] {
            for part in &parts {
                self.push(part.clone(), width, color, opacity);
            }
        }
    }
}

/// Removes corners that are less than `near` pixels off the line between their neighbors.
fn thinned(places: &[Point2], near: f64) -> Vec<Point2> {
    // The algorithm of Ramer, Douglas and Peucker, with a list of remaining pieces.
    let mut keep = vec![false; places.len()];
    let last = places.len().saturating_sub(1);
    (keep[0], keep[last]) = (true, true);
    let mut pieces = vec![(0, last)];
    while let Some((from, to)) = pieces.pop() {
        let mut farthest = (near, None);
        for i in from + 1..to {
            let off = distance(places[i], places[from], places[to]);
            if off > farthest.0 {
                farthest = (off, Some(i));
            }
        }
        if let (_, Some(i)) = farthest {
            keep[i] = true;
            pieces.extend([(from, i), (i, to)]);
        }
    }
    places.iter().zip(keep).filter(|(_, keep)| *keep).map(|(place, _)| *place).collect()
}

/// Computes the distance of a place from the line between two others.
pub(crate) fn distance(place: Point2, a: Point2, b: Point2) -> f64 {
    let ([x, y], [u, v]) = ([place[0] - a[0], place[1] - a[1]], [b[0] - a[0], b[1] - a[1]]);
    let square = u * u + v * v;
    let share = if square > 0.0 { ((x * u + y * v) / square).clamp(0.0, 1.0) } else { 0.0 };
    length([x - share * u, y - share * v, 0.0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::camera::Camera;
    use crate::picture::moment::{Beam, Push};
    use crate::shape::appearance::{Instance, Role};
    use crate::shape::geometry::Geometry;
    use farsa_body::Pose;

    #[test]
    fn straight_ways_need_two_corners() {
        let line: Vec<Point2> = (0..50).map(|i| [f64::from(i), 2.0 * f64::from(i)]).collect();
        assert_eq!(thinned(&line, 0.1), [[0.0, 0.0], [49.0, 98.0]]);
        let corner = [[0.0, 0.0], [5.0, 0.01], [10.0, 0.0], [10.0, 10.0]];
        assert_eq!(thinned(&corner, 0.1), [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]]);
    }

    #[test]
    fn what_is_hidden_is_faint() {
        let picture = Picture {
            shapes: vec![Instance::new(Geometry::Sphere { radius: 0.1 }, Pose::identity(), Role::Object)],
            rays: vec![Beam { from: [-1.0, 0.0, 0.0], to: [1.0, 0.0, 0.0], hit: false }],
            ..Picture::default()
        };
        let view = picture.window(Camera::named("side").unwrap(), [800, 400]);
        let strokes = strokes(&picture, &LitScene::new(&picture, &view), &view);
        let opacities: Vec<f64> = strokes.iter().map(|stroke| stroke.opacity).collect();
        assert_eq!(opacities, [1.0, HIDDEN, 1.0]);
    }

    #[test]
    fn forces_are_drawn_in_proportion() {
        let push = |x: f64, force: f64| Push { point: [x, 0.0, 0.0], force: [0.0, 0.0, force] };
        let picture = Picture { contacts: vec![push(0.0, 2.0), push(1.0, 6.0)], ..Picture::default() };
        let view = picture.window(Camera::named("front").unwrap(), [400, 400]);
        let scale = metres_per_newton(&picture, &view).unwrap();
        assert!((6.0 * scale / view.pixel(view.centre) - 400.0 / 7.0).abs() < 1e-9);
        assert_eq!(metres_per_newton(&Picture::default(), &view), None);
    }
}
