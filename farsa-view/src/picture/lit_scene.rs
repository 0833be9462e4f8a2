//! Shapes of a picture under its lamp, for rays and colors.

use farsa_body::Pose;
use farsa_num::acos;

use crate::picture::camera::Window;
use crate::picture::moment::Picture;
use crate::shape::appearance::{Color, Instance, Role};
use crate::shape::geometry::{Geometry, Meeting, Sight};
use crate::shape::vector::{Vector, add, along, cross, dot, length, mix, scale, sub, unit};

/// The amount of light of a screen color. Screens use about its square root, as here, so that only `sqrt` is needed.
pub(crate) fn linear(color: Color) -> Vector {
    color.map(|x| (f64::from(x) / 255.0) * (f64::from(x) / 255.0))
}

/// Returns the screen color of an amount of light, the inverse of [`linear`].
pub(crate) fn encoded(light: Vector) -> Color {
    light.map(|x| (255.0 * x.clamp(0.0, 1.0).sqrt() + 0.5) as u8)
}

/// Background.
pub(crate) const BACKGROUND: Color = [255, 255, 255];
/// Possible distances of grid lines [m]. Every second line is stronger.
const STEPS: [f64; 5] = [0.01, 0.05, 0.25, 1.0, 5.0];
/// Number of sampled points of the lamp.
const LIGHTS: usize = 48;
/// Light from the lamp and ambient light.
const KEY: f64 = 0.70;
const FILL: f64 = 0.52;

/// A shape prepared for rays.
#[derive(Clone, Debug)]
pub(crate) struct Solid {
    /// Its geometry.
    pub(crate) geometry: Geometry,
    /// Its frame in the world.
    pub(crate) pose: Pose<f64>,
    /// Its role.
    pub(crate) role: Role,
    /// True if its upper faces show the grid.
    pub(crate) grid: bool,
    /// Axes of its frame in the world.
    axes: [Vector; 3],
    reach: f64,
    albedo: Vector,
    /// Outward normals and corners of the faces of its bounding box, in its own frame.
    faces: Vec<(Vector, Vec<Vector>)>,
}

/// Hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Seen {
    /// Index of the solid.
    pub(crate) solid: usize,
    /// Place in the world [m].
    pub(crate) point: Vector,
    /// Unit normal on the side of the eye, in the world's axes.
    pub(crate) normal: Vector,
    /// Distance from the start of the ray [m].
    pub(crate) distance: f64,
}

/// All solids with the lamp.
#[derive(Clone, Debug)]
pub(crate) struct LitScene {
    /// Solids. A plane is replaced by a piece of ground.
    pub(crate) solids: Vec<Solid>,
    /// Indices of solids that can hide the sky, and of those that can hide the lamp.
    hiders: Vec<usize>,
    shaders: Vec<usize>,
    /// Direction from the scene to the center of the lamp.
    pub(crate) key: Vector,
    /// Distance of grid lines [m].
    pub(crate) step: f64,
    lights: Vec<Vector>,
    /// Cosine of the lamp's half width, reduced a little, and its sine.
    cone: [f64; 2],
}

impl Solid {
    fn new(placed: &Instance, view: &Window, step: f64) -> Self {
        let (mut geometry, mut pose) = (placed.geometry, placed.pose);
        if geometry == Geometry::Plane {
            // A piece around the center of the picture, from grid line to grid line.
            let middle = pose.transform_back(view.centre);
            let edge =
                |x: f64, out: f64| ((x + out * 1.35 * view.radius) / (2.0 * step) + 0.5 * out).round() * 2.0 * step;
            let [low, high] = [-1.0, 1.0].map(|out| [0, 1].map(|i| edge(middle[i], out)));
            geometry = Geometry::Rectangle { half: [0, 1].map(|i| (high[i] - low[i]) / 2.0) };
            let at = [f64::midpoint(low[0], high[0]), f64::midpoint(low[1], high[1]), 0.0];
            pose = pose.compose(&Pose::at(at));
        }
        let least = match geometry {
            Geometry::Box { half } => half[0].min(half[1]),
            Geometry::Rectangle { half } => half[0].min(half[1]),
            Geometry::Disc { radius } => radius,
            _ => 0.0,
        };
        let blocks = match geometry {
            Geometry::Box { half } => Some(half),
            // The largest inner box, so that no sampled point is inside.
            Geometry::Cylinder { radius, half_length } => Some([0.707 * radius, 0.707 * radius, half_length]),
            _ => None,
        };
        Self {
            geometry,
            pose,
            faces: blocks.map_or_else(Vec::new, |half| Geometry::Box { half }.faces(0)),
            role: placed.role,
            grid: placed.role == Role::Ground && least > 2.0 * step,
            axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| pose.rotate(axis)),
            reach: geometry.reach(),
            albedo: linear(placed.color()),
        }
    }

    /// Returns the view of the eye in the frame of the solid.
    pub(crate) fn sight(&self, view: &Window) -> Sight {
        if view.parallel {
            Sight::Along(self.pose.rotate_back(view.axes[2]))
        } else {
            Sight::Eye(self.pose.transform_back(view.eye))
        }
    }

    /// Finds the hit of a ray, in the world.
    pub(crate) fn meet(&self, origin: Vector, direction: Vector) -> Option<Meeting> {
        let from = sub(origin, self.pose.position);
        let towards = dot(from, direction);
        let aside = dot(from, from) - towards * towards;
        // Half a millionth more than its ball, because squares cancel far away.
        if aside > self.reach * self.reach * 1.000_001 {
            return None;
        }
        let local = |v: Vector| self.axes.map(|axis| dot(axis, v));
        let Meeting { distance, normal } = self.geometry.meet(local(from), local(direction))?;
        Some(Meeting { distance, normal: self.turned(normal) })
    }

    fn turned(&self, v: Vector) -> Vector {
        add(add(scale(self.axes[0], v[0]), scale(self.axes[1], v[1])), scale(self.axes[2], v[2]))
    }

    /// Estimates the share of the sky over a surface that the solid hides from a point.
    fn hides(&self, point: Vector, normal: Vector) -> f64 {
        let towards = sub(self.pose.position, point);
        let far = 5.0 * self.reach;
        if self.role == Role::Ground || dot(towards, towards) > far * far || dot(towards, normal) < -self.reach {
            return 0.0;
        }
        let ball = |centre: Vector, radius: f64| {
            let towards = sub(centre, point);
            let square = dot(towards, towards).max(radius * radius);
            (dot(towards, normal) / length(towards).max(1e-9)).max(0.0) * radius * radius / square
        };
        match self.geometry {
            Geometry::Sphere { radius } => ball(self.pose.position, radius),
            Geometry::Capsule { radius, half_length } => {
                let along_axis = (-dot(towards, self.axes[2])).clamp(-half_length, half_length);
                let nearest = along(self.pose.position, self.axes[2], along_axis);
                // A rod hides more than its inner ball.
                (ball(nearest, radius) * (1.0 + 0.4 * (half_length / radius).min(1.0))).min(1.0)
            }
            Geometry::Cylinder { .. } | Geometry::Box { .. } => self.box_hides(point, normal),
            Geometry::Plane | Geometry::Disc { .. } | Geometry::Rectangle { .. } => 0.0,
        }
    }

    /// Returns the form factor of a box, of its faces toward the point and above the horizon, by Lambert's formula for polygons.
    fn box_hides(&self, point: Vector, normal: Vector) -> f64 {
        let local = |v: Vector| self.axes.map(|axis| dot(axis, v));
        let (point, normal) = (local(sub(point, self.pose.position)), local(normal));
        let mut sum = 0.0;
        for (outwards, corners) in &self.faces {
            if dot(*outwards, sub(point, corners[0])) <= 1e-6 {
                continue;
            }
            let factor = |seen: &[Vector]| {
                let edge = |i: usize| {
                    let (a, b) = (unit(seen[i]), unit(seen[(i + 1) % seen.len()]));
                    let normal_of_edge = unit(cross(a, b));
                    acos(dot(a, b).clamp(-1.0, 1.0)) * dot(normal_of_edge, normal)
                };
                (0..seen.len()).map(edge).sum::<f64>().abs()
            };
            let seen = [0, 1, 2, 3].map(|i| sub(corners[i], point));
            let above = seen.map(|v| dot(v, normal) >= 0.0);
            sum += match above {
                [true, true, true, true] => factor(&seen),
                [false, false, false, false] => 0.0,
                _ => factor(&crate::picture::outline::clip(&seen, |v| dot(*v, normal), mix)),
            };
        }
        (sum / (2.0 * core::f64::consts::PI)).min(1.0)
    }
}

impl LitScene {
    /// Prepares the shapes of a picture for a view.
    pub(crate) fn new(picture: &Picture, view: &Window) -> Self {
        // Enough lines to count, few enough to remain distinct.
        let step = STEPS.into_iter().find(|step| view.radius < 20.0 * step).unwrap_or(25.0);
        let solids: Vec<Solid> = picture.shapes.iter().map(|placed| Solid::new(placed, view, step)).collect();
        let with = |wanted: fn(&Solid) -> bool| (0..solids.len()).filter(|i| wanted(&solids[*i])).collect();
        let shaders = with(|solid| !matches!(solid.geometry, Geometry::Disc { .. } | Geometry::Rectangle { .. }));
        let hiders = with(|solid| {
            let flat = matches!(solid.geometry, Geometry::Plane | Geometry::Disc { .. } | Geometry::Rectangle { .. });
            solid.role != Role::Ground && !flat
        });
        let (key, lights) = (view.key_light(), view.lights(LIGHTS));
        let narrow = lights.iter().map(|light| dot(*light, key)).fold(1.0, f64::min);
        let cone = [narrow, (1.0 - narrow * narrow).max(0.0).sqrt()];
        Self { solids, hiders, shaders, key, step, lights, cone }
    }

    /// Finds the first hit of a ray among the given solids.
    pub(crate) fn see(
        &self,
        origin: Vector,
        direction: Vector,
        candidates: impl IntoIterator<Item = usize>,
    ) -> Option<Seen> {
        let mut seen: Option<Seen> = None;
        let mut nearest = f64::INFINITY;
        for solid in candidates {
            let Some(Meeting { distance, normal }) = self.solids[solid].meet(origin, direction) else { continue };
            // A mark is on the ground, not in it.
            let order = if self.solids[solid].role == Role::Area { distance - 1e-4 } else { distance };
            if order < nearest {
                nearest = order;
                seen = Some(Seen { solid, point: along(origin, direction, distance), normal, distance });
            }
        }
        seen
    }

    /// Checks if nothing is between the eye and a point.
    pub(crate) fn is_visible(&self, view: &Window, point: Vector) -> bool {
        let direction = view.sight(point);
        let origin = if view.parallel { along(point, direction, -view.depth(point)) } else { view.eye };
        let distance = length(sub(point, origin));
        self.see(origin, direction, 0..self.solids.len())
            .is_none_or(|seen| seen.distance > distance - 2e-3 * view.radius)
    }

    /// Computes the share of the lamp that is visible from a point.
    fn lamp(&self, point: Vector, normal: Vector) -> f64 {
        let origin = along(point, normal, 1e-5);
        let [cosine, sine] = self.cone;
        let mut shades: [usize; 64] = [0; 64];
        let mut count = 0;
        for &i in &self.shaders {
            let solid = &self.solids[i];
            let from = sub(solid.pose.position, origin);
            let ahead = dot(from, self.key);
            let square = dot(from, from);
            // The cone of the lamp, widened by the solid's ball.
            let aside = (square - ahead * ahead).max(0.0).sqrt();
            let near = ahead > -solid.reach && aside * cosine - ahead.max(0.0) * sine <= solid.reach;
            if near && count < shades.len() {
                shades[count] = i;
                count += 1;
            }
        }
        if count == 0 {
            return 1.0;
        }
        let shades = &mut shades[..count];
        let mut free = |light: &&Vector| {
            let hider = shades.iter().position(|i| self.solids[*i].meet(origin, **light).is_some());
            // The solid that hid one part of the lamp likely hides the next.
            shades.swap(0, hider.unwrap_or(0));
            hider.is_none()
        };
        // A few spread samples usually show that the lamp is completely hidden or visible.
        let part = self.lights.iter().step_by(6);
        let (asked, seen) = (part.len(), part.filter(&mut free).count());
        if seen == 0 || seen == asked {
            return if seen == 0 { 0.0 } else { 1.0 };
        }
        self.lights.iter().filter(&mut free).count() as f64 / self.lights.len() as f64
    }

    /// Computes the share of the sky over a point that other solids do not hide.
    fn sky(&self, own: usize, point: Vector, normal: Vector) -> f64 {
        let others = self.hiders.iter().filter(|i| **i != own);
        others.map(|i| 1.0 - 0.85 * self.solids[*i].hides(point, normal)).product()
    }

    /// Returns the darkness of the grid at a point of the ground, for a direction of view and a `pixel` of this width [m].
    fn grid(&self, point: Vector, sight: Vector, pixel: f64) -> f64 {
        let level = unit([sight[0], sight[1], 0.0]);
        let slant = (sight[2] * sight[2]).max(1e-4);
        let mut dark: f64 = 0.0;
        for axis in 0..2 {
            // The area of a pixel is longer along the line of sight than across it.
            let ahead = level[axis] * level[axis];
            let pixel = pixel * (1.0 - ahead + ahead / slant).sqrt();
            for (step, width, depth) in [(self.step, 0.9, 0.16), (2.0 * self.step, 1.3, 0.30)] {
                let off = (point[axis] - (point[axis] / step).round() * step).abs();
                // The part of the pixel that a line of the given width [pixels] covers.
                let line = (width * pixel).max(0.006 * self.step) / 2.0;
                let covered = ((off + pixel / 2.0).min(line) - (off - pixel / 2.0).max(-line)).max(0.0) / pixel;
                // Very dense lines would flicker.
                let faint = (1.0 - pixel / (0.25 * step)).clamp(0.0, 1.0);
                dark = dark.max(covered.min(1.0) * depth * faint);
            }
        }
        dark
    }

    /// Computes the color of a solid's surface without light and shadow.
    fn albedo(&self, view: &Window, seen: &Seen) -> Vector {
        let solid = &self.solids[seen.solid];
        if solid.grid && seen.normal[2] > 0.99 {
            return scale(solid.albedo, 1.0 - self.grid(seen.point, view.sight(seen.point), view.pixel(seen.point)));
        }
        if solid.role == Role::Area {
            // The ground is visible through it.
            return mix([0.75; 3], solid.albedo, 0.6);
        }
        solid.albedo
    }

    /// Computes the light of unobstructed ground without the grid.
    pub(crate) fn plain(&self, seen: &Seen) -> Vector {
        let facing = dot(seen.normal, self.key).max(0.0);
        scale(self.solids[seen.solid].albedo, FILL * (0.78 + 0.22 * seen.normal[2]) + KEY * facing)
    }

    /// Computes the light from a point to the eye, optionally without `shadows` of the lamp.
    pub(crate) fn shade(&self, view: &Window, seen: &Seen, shadows: bool) -> Vector {
        let solid = &self.solids[seen.solid];
        let (normal, sight) = (seen.normal, view.sight(seen.point));
        let facing = dot(normal, self.key).max(0.0);
        let lamp = if facing > 0.0 && shadows { self.lamp(seen.point, normal) } else { 1.0 };
        let sky = self.sky(seen.solid, seen.point, normal);
        // More light comes from above than from the ground.
        let fill = FILL * sky * (0.78 + 0.22 * normal[2]);
        let light = scale(self.albedo(view, seen), fill + KEY * facing * lamp);
        if !matches!(solid.role, Role::Robot | Role::Object) {
            return light;
        }
        // A soft highlight, and darker rims that separate overlapping shapes.
        let half = dot(normal, unit(sub(self.key, sight))).max(0.0);
        let [h2, rim] = [half * half, 1.0 + dot(normal, sight).min(0.0)];
        let h8 = h2 * h2 * h2 * h2;
        let shine = 0.13 * h8 * h8 * h8 * lamp;
        let dark = 1.0 - 0.55 * rim * rim * rim * rim;
        add(scale(light, dark), [shine; 3])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::camera::Camera;
    use crate::shape::vector::across;
    use farsa_num::{Domain, Stream, sin_cos};

    fn lit(shapes: Vec<Instance>) -> LitScene {
        let picture = Picture { shapes, ..Picture::default() };
        LitScene::new(&picture, &picture.window(Camera::default(), [100, 100]))
    }

    /// Computes the share of a cosine-weighted hemisphere whose rays hit a solid.
    fn sampled(solid: &Solid, point: Vector, normal: Vector) -> f64 {
        let mut stream = Stream::new(1, Domain::Start, 0, 0, 0);
        let [u, v] = across(normal);
        let rays = 40_000;
        let met = (0..rays).filter(|_| {
            let (square, angle) = (stream.uniform_f64(), stream.uniform_f64() * 2.0 * core::f64::consts::PI);
            let (sine, cosine) = sin_cos(angle);
            let aside = add(scale(u, square.sqrt() * cosine), scale(v, square.sqrt() * sine));
            solid.meet(point, add(aside, scale(normal, (1.0 - square).sqrt()))).is_some()
        });
        met.count() as f64 / f64::from(rays)
    }

    #[test]
    fn the_sky_is_hidden_as_by_many_rays() {
        let turn = Pose { position: [0.0, 0.1, 0.5], rotation: [0.6, 0.0, 0.0, 0.8] };
        let scene = lit(vec![
            Instance::new(Geometry::Box { half: [0.3, 0.2, 0.1] }, turn, Role::Object),
            Instance::new(Geometry::Sphere { radius: 0.2 }, turn, Role::Object),
            Instance::new(Geometry::Capsule { radius: 0.1, half_length: 0.3 }, turn, Role::Object),
        ]);
        // A box is exact, also partly below the horizon. A ball is exact above the horizon, and a rod approximate.
        for normal in [[0.0, 0.0, 1.0], unit([1.0, 0.3, 0.2]), unit([0.0, -1.0, 0.4])] {
            for point in [[0.0, 0.0, 0.0], [0.3, -0.2, 0.1], [-0.6, 0.2, 0.4]] {
                let solid = &scene.solids[0];
                let (hidden, truth) = (solid.hides(point, normal), sampled(solid, point, normal));
                assert!((hidden - truth).abs() < 0.01, "{hidden} instead of {truth}");
            }
        }
        for (i, off) in [(1, 0.01), (2, 0.12)] {
            let solid = &scene.solids[i];
            let (hidden, truth) =
                (solid.hides([0.1, 0.0, 0.0], [0.0, 0.0, 1.0]), sampled(solid, [0.1, 0.0, 0.0], [0.0, 0.0, 1.0]));
            assert!((hidden - truth).abs() < off, "{hidden} instead of {truth}");
        }
    }

    #[test]
    fn things_throw_shadows() {
        let ball = Instance::new(Geometry::Sphere { radius: 0.1 }, Pose::at([0.0, 0.0, 0.5]), Role::Object);
        let scene = lit(vec![ball, Instance::new(Geometry::Plane, Pose::identity(), Role::Ground)]);
        let up = [0.0, 0.0, 1.0];
        let fallen = along([0.0, 0.0, 0.5], scene.key, -0.5 / scene.key[2]);
        assert_eq!(scene.lamp(fallen, up), 0.0);
        assert_eq!(scene.lamp([1.0, 1.0, 0.0], up), 1.0);
        // On the line past the edge of the ball to the center of the lamp, about half of the lamp is visible.
        let [side, _] = across(scene.key);
        let edge = along([0.0, 0.0, 0.5], side, 0.1);
        let edge = along(edge, scene.key, -edge[2] / scene.key[2]);
        assert!((0.3..0.7).contains(&scene.lamp(edge, up)));
    }

    #[test]
    fn screens_get_their_colours_back() {
        for x in 0..=255 {
            assert_eq!(encoded(linear([x, 0, 255])), [x, 0, 255]);
        }
        assert_eq!(encoded([-1.0, 2.0, f64::INFINITY]), [0, 255, 255]);
    }
}
