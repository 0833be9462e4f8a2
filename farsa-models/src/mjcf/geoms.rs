//! Geoms of an MJCF file and the meshes they are of.

use std::cell::Cell;
use std::collections::BTreeMap;

use farsa_body::Pose;
use farsa_body::robot::Shape;

use crate::bounds::MAX_SIZE;
use crate::context::Context;
use crate::error::{ReadError, repeated};
use crate::files::NamedFile;
use crate::mesh::fitted::Boxes;
use crate::mesh::mass::MeshInertia;
use crate::mesh::principal_axes::rotation_to;
use crate::mesh::solid::{MeshFit, Solid};
use crate::mesh::triangles::Mesh;
use crate::mjcf::classes::{Classed, Classes};
use crate::mjcf::compiler::{Compiler, ROTATIONS};
use crate::mjcf::reasons::SHOW;
use crate::options::Meshes;
use crate::vector::norm;
use crate::warnings::Warnings;
use crate::xml::tree::Element;

/// Meshes in `asset` elements, by name.
pub(crate) struct MeshAssets<'t, 'c> {
    all: BTreeMap<String, MeshAsset<'t, 'c>>,
}

/// A mesh, which is read when the first geom requests it.
struct MeshAsset<'t, 'c> {
    classed: Classed<'t, 'c>,
    fit: Cell<Option<(MeshFit, Option<Boxes>)>>,
}

impl<'t, 'c> MeshAssets<'t, 'c> {
    pub(crate) fn from_model(
        model: Element<'t>,
        classes: &'c Classes<'t>,
        warnings: &mut Warnings,
    ) -> Result<Self, ReadError> {
        let mut all: BTreeMap<String, MeshAsset<'t, 'c>> = BTreeMap::new();
        for asset in model.all("asset") {
            let ignored =
                [("texture material", SHOW), ("hfield skin model", "height fields and skins are not described")];
            asset.check_children(&["mesh"], &ignored, warnings)?;
            for element in asset.all("mesh") {
                let read = ["name", "class", "file", "scale", "vertex", "face", "refpos", "refquat", "inertia"];
                let ignored = [
                    ("material normal texcoord smoothnormal content_type", SHOW),
                    ("maxhullvert builtin params", "meshes are fitted by rules of our own"),
                ];
                element.check(&read, &ignored, warnings)?;
                let file = element.attribute("file").map(|file| {
                    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
                    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
                });
                let name = element.attribute("name").or(file).ok_or_else(|| element.missing("name or file"))?;
                let asset = MeshAsset { classed: classes.with(element, classes.main())?, fit: Cell::new(None) };
                if let Some(first) = all.insert(name.into(), asset) {
                    let (place, first) = (element.place(), first.classed.element.place().line);
                    return Err(repeated(place, "mesh", name, first));
                }
            }
        }
        Ok(Self { all })
    }

    /// Reads the mesh that a geom names, in the frame of its file.
    fn fit(
        &self,
        geom: Element<'t>,
        name: &str,
        compiler: &Compiler,
        context: &mut Context<'_>,
    ) -> Result<(MeshFit, Option<Boxes>), ReadError> {
        let known = self.all.get(name);
        let asset = known.ok_or_else(|| geom.unknown("mesh", name, self.all.keys().map(String::as_str)))?;
        if let Some(fit) = asset.fit.get() {
            return Ok(fit);
        }
        let mesh = asset.load(compiler, context)?;
        let place = asset.classed.element.place();
        let rule = MeshInertia::from_word(asset.classed.word("inertia", &MeshInertia::WORDS)?);
        let fit = MeshFit::new(&mesh, rule).map_err(|why| ReadError::Mesh { place, path: name.into(), why })?;
        let both = (fit, fit.mass.ok().map(|mass| Boxes::new(&mesh, &mass)));
        asset.fit.set(Some(both));
        Ok(both)
    }
}

impl<'t> MeshAssets<'t, '_> {
    /// Reads the triangles of a mesh that a geom names, in the frame of its file.
    pub(crate) fn read(
        &self,
        geom: Element<'t>,
        name: &str,
        compiler: &Compiler,
        context: &mut Context<'_>,
    ) -> Result<Mesh, ReadError> {
        let unknown = || geom.unknown("mesh", name, self.all.keys().map(String::as_str));
        self.all.get(name).ok_or_else(unknown)?.load(compiler, context)
    }
}

impl MeshAsset<'_, '_> {
    /// Its points and triangles, scaled and placed.
    fn load(&self, compiler: &Compiler, context: &mut Context<'_>) -> Result<Mesh, ReadError> {
        let Self { classed, .. } = self;
        let element = classed.element;
        let place = element.place();
        let mesh = if let Some(file) = element.attribute("file") {
            let last = file.rsplit(['/', '\\']).next().unwrap_or(file);
            let file = if compiler.strip_path { last } else { file };
            let named = NamedFile { name: file, assets: &compiler.mesh_folder, folder: element.folder() };
            let bytes = context.files.content(&place, &named)?;
            Mesh::parse(file, &bytes).map_err(|why| ReadError::Mesh { place, path: file.into(), why })?
        } else {
            let limit = context.options.limits.bytes;
            let numbers = |name| Ok::<_, ReadError>(element.list(name, 3, limit)?.unwrap_or_default());
            let points: Vec<[f64; 3]> = numbers("vertex")?.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
            if points.is_empty() {
                return Err(element.unsupported("a mesh without file or vertices"));
            }
            if points.iter().flatten().any(|x| x.abs() >= MAX_SIZE) {
                return Err(element.wrong("vertex", "...", format!("but must be of numbers below {MAX_SIZE:e}")));
            }
            let corner = |x: f64| x as usize;
            let triangles =
                numbers("face")?.chunks_exact(3).map(|f| [corner(f[0]), corner(f[1]), corner(f[2])]).collect();
            Mesh { points, triangles }
        };
        // `refpos` and `refquat` are the origin of the mesh in its file, which is subtracted before scaling.
        let from = element.array::<3>("refpos")?.unwrap_or([0.0; 3]);
        let turn = match element.array::<4>("refquat")? {
            Some([w, x, y, z]) if norm(&[w, x, y, z]) > 1e-10 => {
                let n = norm(&[w, x, y, z]);
                Pose { position: from, rotation: [x / n, y / n, z / n, w / n] }
            }
            _ => Pose::at(from),
        };
        let scale = classed.array::<3>("scale")?.unwrap_or([1.0; 3]);
        let reflected = scale[0] * scale[1] * scale[2] < 0.0;
        let mesh = if reflected { mesh.turned_inside_out() } else { mesh };
        Ok(mesh.map(|point| {
            let point = turn.transform_back(point);
            [0, 1, 2].map(|k| point[k] * scale[k])
        }))
    }
}

/// Attributes of a geom without effect in MuJoCo, if it touches nothing or its body has an `inertial`.
pub(crate) const CONDITIONAL: [&str; 12] = [
    "contype",
    "conaffinity",
    "condim",
    "priority",
    "friction",
    "solref",
    "solimp",
    "margin",
    "solmix",
    "mass",
    "density",
    "shellinertia",
];

pub(crate) fn check_geom(element: Element<'_>, warnings: &mut Warnings) -> Result<(), ReadError> {
    let read = [
        &["name", "class", "type", "size", "fromto", "pos", "mesh", "group", "rgba", "fitscale"][..],
        &CONDITIONAL,
        &ROTATIONS,
    ]
    .concat();
    let ignored = [
        ("material castshadow user", SHOW),
        ("hfield", "height fields are not described"),
        ("gap adhesion surfacevel", "contacts begin at their margin, and do not pull or move"),
        ("fluidshape fluidcoef", "a description has no fluid"),
    ];
    element.check(&read, &ignored, warnings)
}

/// Gets the solid of a geom and its place in the body, or `None` if it is left out.
pub(crate) fn geom<'t>(
    classed: &Classed<'t, '_>,
    within: &Pose<f64>,
    compiler: &Compiler,
    meshes: &MeshAssets<'t, '_>,
    context: &mut Context<'_>,
) -> Result<Option<(Solid, Pose<f64>)>, ReadError> {
    let element = classed.element;
    let kinds = ["plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh", "sdf"];
    let kind = classed.word("type", &kinds)?.unwrap_or("sphere");
    if kind == "hfield" || kind == "sdf" {
        context.warnings.add(element.place(), format!("geom {kind}"), "left out: there is no such shape");
        return Ok(None);
    }
    let mut pose = compiler.pose(classed.source("pos"), classed.source_of(&ROTATIONS))?;
    let mesh = match classed.text("mesh") {
        Some(_) if context.options.meshes == Meshes::Leave => {
            context.warnings.add(element.place(), "geom of a mesh", "left out, as asked for");
            return Ok(None);
        }
        Some(name) => Some(meshes.fit(element, name, compiler, context)?),
        None if kind == "mesh" => return Err(element.missing("mesh")),
        None => None,
    };
    let mut fitted = None;
    match mesh {
        Some((mesh, _)) if kind == "mesh" => return Ok(Some((Solid::Mesh(mesh), within.compose(&pose)))),
        Some(_) if kind == "plane" => return Err(element.unsupported("a plane is not fitted to a mesh")),
        Some((mesh, boxes)) => {
            let path = classed.text("mesh").unwrap_or_default().to_owned();
            let why = mesh.mass.err().unwrap_or_default().to_owned();
            let boxes = boxes.ok_or_else(|| ReadError::Mesh { place: element.place(), path, why })?;
            let scale = classed.number("fitscale")?.unwrap_or(1.0);
            let (sizes, place) = boxes.primitive(kind, compiler.fit_around, scale);
            fitted = Some(sizes);
            pose = pose.compose(&place);
        }
        None => {}
    }
    let is_fitted = fitted.is_some();
    let mut sizes = fitted.map_or_else(|| Ok(classed.list("size", 1, 3)?.unwrap_or_default()), Ok::<_, ReadError>)?;
    let source = classed.source("size").unwrap_or(element);
    if let Some([a, b, c, d, e, f]) =
        classed.array::<6>("fromto")?.filter(|_| !is_fitted && !["sphere", "plane"].contains(&kind))
    {
        // MuJoCo turns z from the second point to the first. It matters for boxes, whose x and y follow from the turn.
        let along = [a - d, b - e, c - f];
        let length = norm(&along);
        if !(length > 1e-14 && length.is_finite()) {
            let source = classed.source("fromto").unwrap_or(element);
            let text = source.attribute("fromto").unwrap_or_default();
            return Err(source.wrong("fromto", text, "but must be two points"));
        }
        let position = [f64::midpoint(a, d), f64::midpoint(b, e), f64::midpoint(c, f)];
        pose = Pose { position, rotation: rotation_to(along) };
        sizes.truncate(1);
        if kind == "box" || kind == "ellipsoid" {
            sizes.extend(sizes.first().copied());
        }
        sizes.push(length / 2.0);
    }
    // The number of sizes of each kind. A plane's are for drawing only.
    let needed = match kind {
        "plane" => 0,
        "sphere" => 1,
        "capsule" | "cylinder" => 2,
        _ => 3,
    };
    if sizes.len() < needed {
        return Err(match classed.text("size") {
            None => element.missing("size"),
            Some(text) => source.wrong("size", text, format!("but a {kind} has {needed}")),
        });
    }
    // A capsule without length is a ball.
    let least = if kind == "capsule" { 1 } else { needed };
    if !sizes[..needed].iter().enumerate().all(|(i, x)| (*x > 0.0 || (i >= least && *x == 0.0)) && *x < MAX_SIZE) {
        let text = source.attribute("size").unwrap_or("fitted to the mesh");
        return Err(source.wrong("size", text, format!("but must be positive, below {MAX_SIZE:e}")));
    }
    let solid = match kind {
        "plane" => Solid::Native(Shape::Plane),
        "sphere" => Solid::Native(Shape::Sphere { radius: sizes[0] }),
        "capsule" => Solid::Native(Shape::Capsule { radius: sizes[0], half_length: sizes[1] }),
        "cylinder" => Solid::Cylinder { radius: sizes[0], half_length: sizes[1] },
        "box" => Solid::Native(Shape::Box { half: [sizes[0], sizes[1], sizes[2]] }),
        _ => Solid::Ellipsoid([sizes[0], sizes[1], sizes[2]]),
    };
    Ok(Some((solid, within.compose(&pose))))
}
