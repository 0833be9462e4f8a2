//! Settings of an MJCF file's `compiler` and `option` elements, and the places that they give a meaning.

use farsa_body::Pose;
use farsa_num::sin_cos;

use crate::context::Context;
use crate::error::ReadError;
use crate::mesh::principal_axes::{rotation_of_axes, rotation_to};
use crate::mjcf::flags::Flags;
use crate::mjcf::reasons::{MUJOCO, SHOW};
use crate::options::Repair;
use crate::vector::{cross, norm};
use crate::xml::tree::Element;

/// Attributes for a rotation.
pub(crate) const ROTATIONS: [&str; 5] = ["quat", "axisangle", "euler", "xyaxes", "zaxis"];

/// Settings in `compiler` elements.
pub(crate) struct Compiler {
    /// Radians of the file's unit of angle.
    pub(crate) angle: f64,
    sequence: Vec<u8>,
    pub(crate) automatic_limits: bool,
    /// True if inertias come from geoms: always, never, or where there is no `inertial`.
    pub(crate) inertia_from_geom: Option<bool>,
    pub(crate) inertia_groups: [f64; 2],
    /// Bounds of every body, whether it moves or not.
    pub(crate) repair: Repair,
    pub(crate) total_mass: f64,
    pub(crate) mesh_folder: String,
    /// Fits primitives around the points of a mesh instead of to its moments.
    pub(crate) fit_around: bool,
    pub(crate) strip_path: bool,
    pub(crate) flags: Flags,
}

impl Compiler {
    pub(crate) fn from_model(model: Element<'_>, context: &mut Context<'_>) -> Result<Self, ReadError> {
        let mut settings = Self {
            angle: std::f64::consts::PI / 180.0,
            sequence: b"xyz".to_vec(),
            automatic_limits: true,
            inertia_from_geom: None,
            inertia_groups: [0.0, 5.0],
            repair: Repair::default(),
            total_mass: -1.0,
            mesh_folder: String::new(),
            fit_around: false,
            strip_path: false,
            flags: Flags::from_model(model, context)?,
        };
        for element in model.all("compiler") {
            settings.add(element, context)?;
        }
        Ok(settings)
    }

    fn add(&mut self, element: Element<'_>, context: &mut Context<'_>) -> Result<(), ReadError> {
        let read = [
            "angle",
            "coordinate",
            "eulerseq",
            "autolimits",
            "inertiafromgeom",
            "inertiagrouprange",
            "balanceinertia",
            "boundmass",
            "boundinertia",
            "settotalmass",
            "meshdir",
            "assetdir",
            "strippath",
            "fusestatic",
            "fitaabb",
        ];
        let ignored = [
            ("texturedir discardvisual passthrough", SHOW),
            (
                "alignfree conflict usethread saveinertial savecompiled savecanonical convexhull exactmeshinertia",
                MUJOCO,
            ),
        ];
        element.check(&read, &ignored, &mut context.warnings)?;
        element.check_children(&[], &[("lengthrange", MUJOCO)], &mut context.warnings)?;
        let truth = |name| Ok::<_, ReadError>(element.word(name, &["true", "false"])?.map(|word| word == "true"));
        match element.word("angle", &["degree", "radian"])? {
            Some("radian") => self.angle = 1.0,
            Some(_) => self.angle = std::f64::consts::PI / 180.0,
            None => {}
        }
        if element.word("coordinate", &["local", "global"])? == Some("global") {
            return Err(element.unsupported("global coordinates, which MuJoCo gave up in version 2.3.4"));
        }
        if let Some(sequence) = element.attribute("eulerseq") {
            if sequence.len() != 3 || !sequence.bytes().all(|axis| b"xyzXYZ".contains(&axis)) {
                return Err(element.wrong("eulerseq", sequence, "but must be three letters of xyzXYZ"));
            }
            self.sequence = sequence.as_bytes().to_vec();
        }
        self.automatic_limits = truth("autolimits")?.unwrap_or(self.automatic_limits);
        match element.word("inertiafromgeom", &["true", "false", "auto"])? {
            Some("auto") => self.inertia_from_geom = None,
            Some(word) => self.inertia_from_geom = Some(word == "true"),
            None => {}
        }
        self.inertia_groups = element.array("inertiagrouprange")?.unwrap_or(self.inertia_groups);
        self.repair.balance = truth("balanceinertia")?.unwrap_or(self.repair.balance);
        self.repair.least_mass = element.number("boundmass")?.unwrap_or(self.repair.least_mass);
        self.repair.least_inertia = element.number("boundinertia")?.unwrap_or(self.repair.least_inertia);
        self.total_mass = element.number("settotalmass")?.unwrap_or(self.total_mass);
        element.skip(&["assetdir"]);
        if let Some(folder) = element.attribute("meshdir").or_else(|| element.attribute("assetdir")) {
            self.mesh_folder = folder.into();
        }
        self.fit_around = truth("fitaabb")?.unwrap_or(self.fit_around);
        self.strip_path = truth("strippath")?.unwrap_or(self.strip_path);
        if truth("fusestatic")? == Some(true) {
            context.warnings.add(element.place(), "compiler `fusestatic`", "fixed bodies stay segments");
        }
        Ok(())
    }

    /// Returns the place of an element: `pos` and one of the five forms of a rotation.
    pub(crate) fn pose(
        &self,
        position: Option<Element<'_>>,
        turn: Option<Element<'_>>,
    ) -> Result<Pose<f64>, ReadError> {
        let position = position.map_or(Ok(None), |element| element.array::<3>("pos"))?.unwrap_or([0.0; 3]);
        let rotation = turn.map_or(Ok(None), |element| self.rotation(element))?;
        Ok(Pose { position, rotation: rotation.unwrap_or(Pose::identity().rotation) })
    }

    fn rotation(&self, element: Element<'_>) -> Result<Option<[f64; 4]>, ReadError> {
        let given: Vec<&str> = ROTATIONS.into_iter().filter(|name| element.has(name)).collect();
        let &[name] = given.as_slice() else {
            return match given.as_slice() {
                [first, second, ..] => {
                    let value = element.attribute(second).unwrap_or_default();
                    Err(element.wrong(second, value, format!("but there is `{first}` already")))
                }
                _ => Ok(None),
            };
        };
        let none = || element.wrong(name, element.attribute(name).unwrap_or_default(), "but must be a direction");
        let unit = |q: [f64; 4]| {
            let n = norm(&q);
            // A unit quaternion keeps its digits.
            let q = if (n - 1.0).abs() <= 1e-12 { q } else { q.map(|x| x / n) };
            if n > 1e-10 && n.is_finite() { Ok(Some(q)) } else { Err(none()) }
        };
        let about = |axis: [f64; 3], angle: f64| {
            let (sine, cosine) = sin_cos(angle / 2.0);
            let [x, y, z] = axis.map(|part| part * sine);
            [x, y, z, cosine]
        };
        match name {
            // MuJoCo writes quaternions w first.
            "quat" => {
                let [w, x, y, z] = element.array("quat")?.unwrap_or([1.0, 0.0, 0.0, 0.0]);
                unit([x, y, z, w])
            }
            "axisangle" => {
                let [x, y, z, angle] = element.array("axisangle")?.unwrap_or([0.0; 4]);
                let n = norm(&[x, y, z]);
                if n <= 1e-10 {
                    return Err(none());
                }
                unit(about([x / n, y / n, z / n], angle * self.angle))
            }
            "euler" => {
                let angles = element.array::<3>("euler")?.unwrap_or([0.0; 3]);
                let mut turn = Pose::identity();
                for (letter, angle) in self.sequence.iter().zip(angles) {
                    let mut axis = [0.0; 3];
                    axis[usize::from(letter.to_ascii_lowercase() - b'x')] = 1.0;
                    let next = Pose { rotation: about(axis, angle * self.angle), ..Pose::identity() };
                    // Capital letters are about the axes of the parent, others about those turned so far.
                    turn = if letter.is_ascii_uppercase() { next.compose(&turn) } else { turn.compose(&next) };
                }
                unit(turn.rotation)
            }
            "xyaxes" => {
                let [a, b, c, d, e, f] = element.array("xyaxes")?.unwrap_or([0.0; 6]);
                let normal = |v: [f64; 3]| {
                    let n = norm(&v);
                    if n > 1e-10 { Ok(v.map(|x| x / n)) } else { Err(none()) }
                };
                // x as given, y made perpendicular to it, z their product.
                let x = normal([a, b, c])?;
                let along = x[0] * d + x[1] * e + x[2] * f;
                let y = normal([d - along * x[0], e - along * x[1], f - along * x[2]])?;
                unit(rotation_of_axes([x, y, cross(x, y)]))
            }
            _ => {
                let axis = element.array::<3>("zaxis")?.unwrap_or([0.0; 3]);
                if norm(&axis) <= 1e-10 {
                    return Err(none());
                }
                unit(rotation_to(axis))
            }
        }
    }
}
