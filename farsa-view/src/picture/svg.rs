//! Pictures as SVG, with flat outlines from back to front.

use std::fmt::Write as _;

use crate::picture::camera::{Camera, Window};
use crate::picture::draw_order::back_to_front;
use crate::picture::lit_scene::{BACKGROUND, LitScene, Seen, Solid, encoded};
use crate::picture::marks;
use crate::picture::moment::Picture;
use crate::picture::outline::{Point2, framed, hull};
use crate::picture::svg_data::{apart, digits, escaped, hex, path};
use crate::shape::appearance::{Color, Role};
use crate::shape::geometry::{Geometry, Sight};
use crate::shape::vector::{Vector, add, dot, length, scale, sub};

/// Margin around the frame at which shapes are clipped [pixels].
const MARGIN: f64 = 20.0;
/// Number of layers of a shadow, one for each part of the lamp, and the darkness of each.
const SHADOWS: usize = 4;
const SHADOW: f64 = 0.12;
/// Width of the line that separates shapes of equal color.
const CONTOUR: &str = "stroke=\"#1b2733\" stroke-opacity=\".4\" stroke-width=\".8\"";

/// Returns a picture in a frame of width and height [pixels] as an SVG element.
///
/// All ids start with `prefix`, so that one document can contain several pictures. It must be valid in an XML name.
pub(crate) fn svg(picture: &Picture, camera: Camera, size: [u32; 2], prefix: &str) -> String {
    let view = picture.window(camera, size);
    let scene = LitScene::new(picture, &view);
    let mut drawing =
        Drawing { scene: &scene, view: &view, prefix, defs: String::new(), body: String::new(), gridded: false };
    let outlines: Vec<Vec<Point2>> = scene.solids.iter().map(|solid| outline(solid, &view)).collect();
    for i in back_to_front(&scene, &view, &outlines) {
        drawing.solid(i, &outlines[i]);
    }
    drawing.marks(picture);
    drawing.words(picture);
    let Drawing { defs, body, .. } = drawing;
    let [width, height] = view.size;
    let title = escaped(picture.caption.as_deref().unwrap_or("A moment of a simulation"));
    let paper = hex(BACKGROUND);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         role=\"img\" font-family=\"sans-serif\" stroke-linejoin=\"round\">\n<title>{title}</title>\n\
         <defs>\n<clipPath id=\"{prefix}f\"><path d=\"M0,0h{width}v{height}h-{width}z\"/></clipPath>\n{defs}</defs>\n\
         <g clip-path=\"url(#{prefix}f)\">\n<path d=\"M0,0h{width}v{height}h-{width}z\" fill=\"{paper}\"/>\n{body}</g>\n\
         </svg>\n"
    )
}

/// Returns the outline of a solid, clipped to the frame, or nothing for an invisible solid.
pub(crate) fn outline(solid: &Solid, view: &Window) -> Vec<Point2> {
    let places = |points: Vec<Vector>| -> Vec<Point2> {
        points.into_iter().filter_map(|point| view.project(solid.pose.transform(point))).collect()
    };
    let flat = matches!(solid.geometry, Geometry::Box { .. } | Geometry::Rectangle { .. } | Geometry::Disc { .. });
    let hull = if flat {
        // Faces are clipped in front of the eye. The hull of the clipped faces is that of the clipped solid.
        let faces = solid.geometry.faces(48).into_iter().flat_map(|(_, corners)| {
            let corners: Vec<_> = corners.into_iter().map(|corner| solid.pose.transform(corner)).collect();
            view.before(&corners)
        });
        hull(&faces.filter_map(|point| view.project(point)).collect::<Vec<_>>())
    } else {
        // Circles have enough corners to look round.
        hull(&places(solid.geometry.rim(solid.sight(view), roundness(solid, view, 0.12))))
    };
    framed(&hull, view.size, MARGIN)
}

/// Computes the number of corners that approximates the circles of a solid within a share of a pixel.
fn roundness(solid: &Solid, view: &Window, off: f64) -> usize {
    let radius = match solid.geometry {
        Geometry::Capsule { radius, .. } | Geometry::Cylinder { radius, .. } => radius,
        geometry => geometry.reach(),
    };
    // The height of the arc over an edge is r (1 - cos(pi / n)), about r pi^2 / 2 n^2.
    let count = 2.22 * (radius / view.pixel(solid.pose.position) / off).sqrt();
    (count.clamp(12.0, 120.0) as usize).next_multiple_of(4)
}

struct Drawing<'a> {
    scene: &'a LitScene,
    view: &'a Window,
    prefix: &'a str,
    defs: String,
    body: String,
    /// True if a grid line is visible.
    gridded: bool,
}

impl Drawing<'_> {
    fn path(&mut self, outlines: &[&[Point2]], attributes: &str) {
        let data: String = outlines.iter().map(|outline| path(outline, true)).collect();
        if !data.is_empty() {
            self.line(&format!("<path d=\"{data}\" {attributes}/>"));
        }
    }

    fn line(&mut self, element: &str) {
        self.body.push_str(element);
        self.body.push('\n');
    }

    fn solid(&mut self, i: usize, outline: &[Point2]) {
        let solid = &self.scene.solids[i];
        match solid.geometry {
            Geometry::Sphere { .. } => {
                let fill = self.radial(i, outline);
                self.path(&[outline], &format!("fill=\"{fill}\" {CONTOUR}"));
            }
            Geometry::Capsule { .. } => {
                let fill = self.rod(i, outline);
                self.path(&[outline], &format!("fill=\"{fill}\" {CONTOUR}"));
            }
            Geometry::Cylinder { .. } => {
                let fill = self.rod(i, outline);
                self.path(&[outline], &format!("fill=\"{fill}\" {CONTOUR}"));
                self.faces(i);
            }
            Geometry::Box { .. } | Geometry::Rectangle { .. } | Geometry::Disc { .. } | Geometry::Plane => {
                self.faces(i);
            }
        }
    }

    /// Draws the flat faces toward the eye, with grid and shadows on the ground.
    fn faces(&mut self, i: usize) {
        let solid = &self.scene.solids[i];
        let to_world = |(normal, corners): (Vector, Vec<Vector>)| {
            let corners: Vec<Vector> = corners.into_iter().map(|corner| solid.pose.transform(corner)).collect();
            (solid.pose.rotate(normal), corners)
        };
        for (normal, corners) in solid.geometry.faces(roundness(solid, self.view, 0.12)).into_iter().map(to_world) {
            let middle = scale(corners.iter().fold([0.0; 3], |sum, c| add(sum, *c)), 1.0 / corners.len() as f64);
            if dot(normal, self.view.sight(middle)) >= 0.0 {
                continue;
            }
            let places = self.places(&self.view.before(&corners));
            let places = framed(&places, self.view.size, MARGIN);
            let seen = Seen { solid: i, point: middle, normal, distance: 0.0 };
            let ground = solid.role == Role::Ground;
            // The ground has the light of unobstructed places, and shadows are drawn on top.
            let light = if ground { self.scene.plain(&seen) } else { self.scene.shade(self.view, &seen, false) };
            let color = hex(encoded(light));
            let opacity = if solid.role == Role::Area { " fill-opacity=\".8\"" } else { "" };
            // A hairline of the same color closes the seams of the ground.
            let edge = match solid.role {
                Role::Robot | Role::Object => CONTOUR.to_owned(),
                Role::Ground | Role::Area => format!("stroke=\"{color}\" stroke-width=\".5\""),
            };
            self.path(&[&places], &format!("fill=\"{color}\" {edge}{opacity}"));
            if ground && normal[2] > 0.99 {
                if solid.grid {
                    self.grid(&corners);
                }
                self.shadows(i, &corners);
            }
        }
    }

    fn places(&self, points: &[Vector]) -> Vec<Point2> {
        points.iter().filter_map(|point| self.view.project(*point)).collect()
    }

    /// Draws grid lines on a level face.
    fn grid(&mut self, corners: &[Vector]) {
        let step = self.scene.step;
        let height = corners[0][2];
        let mut data = [String::new(), String::new()];
        for axis in 0..2 {
            let across = |point: &Vector| point[axis];
            let low = corners.iter().map(across).fold(f64::INFINITY, f64::min);
            let high = corners.iter().map(across).fold(f64::NEG_INFINITY, f64::max);
            let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
            for line in first..=last.min(first + 400) {
                let at = line as f64 * step;
                let ends = crossings(corners, axis, at);
                let [Some(a), Some(b)] = ends else { continue };
                let ends = self.places(&self.view.before(&[[a[0], a[1], height], [b[0], b[1], height]]));
                // Clipping treats the line as a polygon of two edges.
                let ends = framed(&ends, self.view.size, MARGIN);
                if ends.len() > 1 {
                    data[usize::from(line % 2 == 0)].push_str(&path(&ends[..2], false));
                }
            }
        }
        for (data, opacity) in data.into_iter().zip([0.09, 0.18]) {
            if !data.is_empty() {
                self.gridded = true;
                self.line(&format!("<path d=\"{data}\" fill=\"none\" stroke=\"#000\" stroke-opacity=\"{opacity}\"/>"));
            }
        }
    }

    /// Draws the shadows of everything above a level face.
    fn shadows(&mut self, ground: usize, corners: &[Vector]) {
        let height = corners[0][2];
        let face = framed(&self.places(&self.view.before(corners)), self.view.size, MARGIN);
        let clip = format!("{}c{ground}", self.prefix);
        let mut layers = String::new();
        for light in self.view.lights(SHADOWS) {
            let mut data = String::new();
            for solid in &self.scene.solids {
                if matches!(solid.role, Role::Ground | Role::Area) || solid.pose.position[2] < height {
                    continue;
                }
                let rim =
                    solid.geometry.rim(Sight::Along(solid.pose.rotate_back(light)), roundness(solid, self.view, 0.6));
                let fallen = rim.into_iter().map(|point| {
                    let point = solid.pose.transform(point);
                    let fall = (point[2] - height).max(0.0) / light[2];
                    sub(point, scale(light, fall))
                });
                let places: Option<Vec<Point2>> = fallen.map(|point| self.view.project(point)).collect();
                let outline = hull(&places.unwrap_or_default());
                data.push_str(&path(&framed(&outline, self.view.size, MARGIN), true));
            }
            if !data.is_empty() {
                // All outlines have the same orientation, so that overlaps are not darker.
                let _ = writeln!(layers, "<path d=\"{data}\" fill-opacity=\"{SHADOW}\"/>");
            }
        }
        if !layers.is_empty() {
            let _ = writeln!(self.defs, "<clipPath id=\"{clip}\"><path d=\"{}\"/></clipPath>", path(&face, true));
            self.line(&format!("<g clip-path=\"url(#{clip})\" fill=\"#0b0f16\">\n{layers}</g>"));
        }
    }

    /// Returns the color of a solid at a place of the picture, or at the nearest place toward `inside`.
    fn color(&self, i: usize, place: Point2, inside: Point2) -> Color {
        let tries = [0.0, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0];
        let seen = tries.into_iter().find_map(|share| {
            let at = [0, 1].map(|k| place[k] + (inside[k] - place[k]) * share);
            let (origin, direction) = self.view.ray(at);
            self.scene.see(origin, direction, [i])
        });
        seen.map_or(BACKGROUND, |seen| encoded(self.scene.shade(self.view, &seen, false)))
    }

    fn gradient(&mut self, i: usize, kind: &str, coordinates: &str, stops: &[(f64, Color)]) -> String {
        let id = format!("{}g{i}", self.prefix);
        let _ = write!(self.defs, "<{kind} id=\"{id}\" gradientUnits=\"userSpaceOnUse\" {coordinates}>");
        for (offset, color) in stops {
            let _ = write!(self.defs, "<stop offset=\"{}\" stop-color=\"{}\"/>", digits(*offset, 100.0), hex(*color));
        }
        let _ = writeln!(self.defs, "</{kind}>");
        format!("url(#{id})")
    }

    /// Draws the fill of a ball, with rings around its brightest point.
    fn radial(&mut self, i: usize, outline: &[Point2]) -> String {
        let solid = &self.scene.solids[i];
        let centre = solid.pose.position;
        let (Some(middle), Some(bright)) = (
            self.view.project(centre),
            self.view.project(add(centre, scale(self.scene.key, 0.62 * solid.geometry.reach()))),
        ) else {
            return hex(BACKGROUND);
        };
        let away = [middle[0] - bright[0], middle[1] - bright[1]];
        let far = length([away[0], away[1], 0.0]).max(1e-9);
        let radius = outline.iter().map(|p| length([p[0] - bright[0], p[1] - bright[1], 0.0])).fold(0.0, f64::max);
        let stop = |share: f64| {
            let place = [0, 1].map(|k| bright[k] + away[k] / far * radius * share);
            (share, self.color(i, place, middle))
        };
        let stops = [0.0, 0.2, 0.4, 0.6, 0.8, 0.92, 0.99].map(stop);
        let [x, y, r] = [bright[0], bright[1], radius].map(|x| digits(x, 10.0));
        self.gradient(i, "radialGradient", &format!("cx=\"{x}\" cy=\"{y}\" r=\"{r}\""), &stops)
    }

    /// Draws the fill of a rod, with bands along its axis.
    fn rod(&mut self, i: usize, outline: &[Point2]) -> String {
        let solid = &self.scene.solids[i];
        let (half, radius) = match solid.geometry {
            Geometry::Capsule { radius, half_length } | Geometry::Cylinder { radius, half_length } => {
                (half_length, radius)
            }
            _ => (0.0, 0.0),
        };
        let ends = [-half, half].map(|z| self.view.project(solid.pose.transform([0.0, 0.0, z])));
        let [Some(a), Some(b)] = ends else { return hex(BACKGROUND) };
        let axis = [b[0] - a[0], b[1] - a[1]];
        let far = length([axis[0], axis[1], 0.0]);
        let wide = radius / self.view.pixel(solid.pose.position);
        if far < 0.5 * wide && matches!(solid.geometry, Geometry::Capsule { .. }) {
            return self.radial(i, outline);
        }
        let middle = [0, 1].map(|k| f64::midpoint(a[k], b[k]));
        let side = [-axis[1] / far.max(1e-9), axis[0] / far.max(1e-9)];
        let reach = outline.iter().map(|p| dot([p[0] - middle[0], p[1] - middle[1], 0.0], [side[0], side[1], 0.0]));
        let reach = reach.fold(wide, |most, x| most.max(x.abs()));
        let at = |share: f64| [0, 1].map(|k| middle[k] + side[k] * reach * share);
        let stop = |share: f64| (f64::midpoint(share, 1.0), self.color(i, at(share), middle));
        let stops = [-0.98, -0.8, -0.5, -0.1, 0.3, 0.6, 0.85, 0.98].map(stop);
        let [[x1, y1], [x2, y2]] = [at(-1.0), at(1.0)].map(|place| place.map(|x| digits(x, 10.0)));
        let coordinates = format!("x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\"");
        self.gradient(i, "linearGradient", &coordinates, &stops)
    }

    fn marks(&mut self, picture: &Picture) {
        let strokes = marks::strokes(picture, self.scene, self.view);
        if strokes.is_empty() {
            return;
        }
        self.line("<g fill=\"none\" stroke-linecap=\"round\">");
        for stroke in strokes {
            let opacity = match digits(stroke.opacity, 100.0).as_str() {
                "1" => String::new(),
                opacity => format!(" stroke-opacity=\"{opacity}\""),
            };
            let (color, width, data) = (hex(stroke.color), digits(stroke.width, 10.0), path(&stroke.places, false));
            self.line(&format!("<path d=\"{data}\" stroke=\"{color}\" stroke-width=\"{width}\"{opacity}/>"));
        }
        self.line("</g>");
    }

    /// Draws names of points, the caption and the scales.
    fn words(&mut self, picture: &Picture) {
        let [width, height] = self.view.size.map(f64::from);
        let unit = width.min(height) / 800.0;
        let letters = (15.0 * unit).max(9.0);
        let (font, halo) = (digits(letters, 10.0), digits(0.2 * letters, 10.0));
        self.line(&format!(
            "<g font-size=\"{font}\" fill=\"#333\" stroke=\"#fff\" stroke-width=\"{halo}\" paint-order=\"stroke\">"
        ));
        let text = |place: Point2, anchor: &str, words: &str| {
            let [x, y] = place.map(|x| digits(x, 10.0));
            format!("<text x=\"{x}\" y=\"{y}\"{anchor}>{}</text>", escaped(words))
        };
        let mut taken: Vec<(Point2, f64)> = Vec::new();
        for (name, point) in &picture.points {
            if let (Some([x, y]), false) = (self.view.project(*point), name.is_empty()) {
                let place = apart([x + 11.0 * unit, y - 7.0 * unit], letters, name, &mut taken);
                self.line(&text(place, "", name));
            }
        }
        let base = height - letters;
        if let Some(caption) = &picture.caption {
            self.line(&text([letters, base], "", caption));
        }
        let mut scales = Vec::new();
        if self.gridded {
            let centimetres = 100.0 * self.scene.step;
            let (step, unit) = if centimetres < 100.0 { (centimetres, "cm") } else { (self.scene.step, "m") };
            scales.push(format!("grid {} {unit}", digits(step, 10.0)));
        }
        let largest = picture.contacts.iter().map(|push| length(push.force)).fold(0.0, f64::max);
        if marks::metres_per_newton(picture, self.view).is_some() {
            scales.push(format!("longest arrow {} N", digits(largest, 100.0)));
        }
        if !scales.is_empty() {
            self.line(&text([width - letters, base], " text-anchor=\"end\"", &scales.join(", ")));
        }
        self.line("</g>");
    }
}

/// Returns the points at which the line of a coordinate `at` enters and leaves a convex polygon.
fn crossings(corners: &[Vector], axis: usize, at: f64) -> [Option<Point2>; 2] {
    let mut crossings = [None; 2];
    let mut count = 0;
    for (i, a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        if (a[axis] < at) != (b[axis] < at) && count < 2 {
            let share = (at - a[axis]) / (b[axis] - a[axis]);
            crossings[count] = Some([a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share]);
            count += 1;
        }
    }
    crossings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::moment::{Beam, Push};
    use crate::shape::appearance::Instance;
    use farsa_body::Pose;
    use farsa_body::kinematics::KinematicTree;
    use farsa_body::robots::{ArmAndHand, Tabletop};

    /// Lists the elements of a document by name with their attributes, and panics if it is not well-formed.
    fn elements(text: &str) -> Vec<(String, Vec<(String, String)>)> {
        let (mut open, mut found) = (Vec::new(), Vec::new());
        let mut rest = text;
        while let Some(start) = rest.find('<') {
            assert!(!rest[..start].contains('>') && (!open.is_empty() || rest[..start].trim().is_empty()));
            for part in rest[..start].split('&').skip(1) {
                assert!(["amp;", "lt;", "gt;", "quot;"].iter().any(|name| part.starts_with(name)), "&{part}");
            }
            let end = start + rest[start..].find('>').unwrap();
            let tag = &rest[start + 1..end];
            rest = &rest[end + 1..];
            if let Some(name) = tag.strip_prefix('/') {
                assert_eq!(open.pop().as_deref(), Some(name));
                continue;
            }
            let alone = tag.ends_with('/');
            let (name, attributes) = tag.trim_end_matches('/').split_once(' ').unwrap_or((tag, ""));
            let mut pairs: Vec<(String, String)> = Vec::new();
            let mut left = attributes.trim();
            while !left.is_empty() {
                let (key, value) = left.split_once("=\"").unwrap();
                let (value, after) = value.split_once('"').unwrap();
                assert!(pairs.iter().all(|(other, _)| other != key), "{key} twice in {tag}");
                assert!(!value.contains('<') && key.chars().all(|c| c.is_alphanumeric() || "-:".contains(c)), "{tag}");
                pairs.push((key.into(), value.into()));
                left = after.trim();
            }
            found.push((name.to_owned(), pairs));
            if !alone {
                open.push(name.to_owned());
            }
        }
        assert!(open.is_empty() && rest.trim().is_empty());
        found
    }

    fn scene() -> Picture {
        let robot = Tabletop::default().scene(&ArmAndHand::default()).unwrap();
        let tree = KinematicTree::new(&robot).unwrap();
        let poses = tree.poses(&tree.zero());
        let mut picture = Picture { caption: Some("a < b & c".into()), ..Picture::default() };
        picture.add_robot(&robot, |body| poses[body.index()]);
        picture.shapes.push(Instance::new(Geometry::Disc { radius: 0.05 }, Pose::at([0.2, -0.2, 0.0]), Role::Area));
        let wheel = Geometry::Cylinder { radius: 0.02, half_length: 0.01 };
        picture.shapes.push(Instance::new(wheel, Pose::at([0.2, -0.2, 0.02]), Role::Object));
        picture.contacts.push(Push { point: [0.1, -0.18, 0.05], force: [0.0, 1.0, -2.0] });
        picture.rays.push(Beam { from: [0.0, 0.0, 0.1], to: [0.4, 0.0, 0.1], hit: true });
        picture.points.push(("<target>".into(), [0.1, -0.18, 0.1]));
        picture.trails.push(((0..700).map(|i| [0.1, -0.3 + 5e-4 * f64::from(i), 0.1]).collect(), [0, 114, 178]));
        picture
    }

    #[test]
    fn every_camera_gives_small_well_formed_svg() {
        for name in Camera::NAMES {
            let camera = Camera::named(name).unwrap();
            let text = svg(&scene(), camera, [1200, 800], "p1-");
            assert_eq!(text, svg(&scene(), camera, [1200, 800], "p1-"));
            assert!(text.len() <= 60_000, "{} bytes", text.len());
            assert!(!text.contains("NaN") && !text.contains("inf"));
            assert!(text.contains("<title>a &lt; b &amp; c</title>") && text.contains("&lt;target&gt;"));
            let elements = elements(&text);
            let mut ids: Vec<&String> = Vec::new();
            for (name, attributes) in &elements {
                for (key, value) in attributes {
                    if key == "id" {
                        assert!(value.starts_with("p1-") && !ids.contains(&value), "{name} {value}");
                        ids.push(value);
                    }
                }
            }
            // Every reference has a target that is defined before it.
            for (_, attributes) in &elements {
                for id in attributes.iter().filter_map(|(_, value)| value.strip_prefix("url(#")) {
                    assert!(ids.contains(&&id.trim_end_matches(')').to_owned()), "{id}");
                }
            }
        }
    }

    #[test]
    fn nothing_can_be_drawn_too() {
        let plane = Instance::new(Geometry::Plane, Pose::identity(), Role::Ground);
        let inside = Instance::new(Geometry::Sphere { radius: 90.0 }, Pose::identity(), Role::Ground);
        for shapes in [vec![], vec![plane], vec![inside, plane]] {
            let picture = Picture { shapes, ..Picture::default() };
            for name in Camera::NAMES {
                elements(&svg(&picture, Camera::named(name).unwrap(), [30, 20], ""));
            }
        }
    }

    #[test]
    fn the_nearer_box_is_drawn_later() {
        let at = |x: f64, color| {
            let geometry = Geometry::Box { half: [0.1, 0.5, 0.5] };
            Instance::new(geometry, Pose::at([x, 0.0, 0.0]), Role::Area).with_color(color)
        };
        let front = Camera::named("front").unwrap();
        for shapes in [[at(0.5, [9, 0, 0]), at(-0.5, [0, 9, 0])], [at(-0.5, [0, 9, 0]), at(0.5, [9, 0, 0])]] {
            let text = svg(&Picture { shapes: shapes.to_vec(), ..Picture::default() }, front, [80, 80], "");
            let reddish = |line: &str| {
                let color = line.split("fill=\"#").nth(1).map(|rest| rest[..6].to_owned());
                color.map(|c| u8::from_str_radix(&c[..2], 16).unwrap() > u8::from_str_radix(&c[2..4], 16).unwrap())
            };
            let faces: Vec<bool> = text.lines().filter(|l| l.contains("fill-opacity")).filter_map(reddish).collect();
            assert!(!faces[0] && faces[faces.len() - 1], "{faces:?}");
        }
    }
}
