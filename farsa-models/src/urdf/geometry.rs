//! Places and shapes in elements of a URDF.

use farsa_body::Pose;
use farsa_body::robot::Shape;
use farsa_num::sin_cos;

use crate::bounds::{MAX_SIZE, has_size};
use crate::context::Context;
use crate::error::{ReadError, SourceLocation};
use crate::files::NamedFile;
use crate::mesh::mass::MeshInertia;
use crate::mesh::solid::{MeshFit, Solid};
use crate::mesh::triangles::Mesh;
use crate::options::Meshes;
use crate::vector::norm;
use crate::xml::tree::Element;

/// Reads the place in an `origin` element.
pub(super) fn origin(within: Element<'_>, context: &mut Context<'_>) -> Result<Pose<f64>, ReadError> {
    let Some(origin) = within.one("origin")? else { return Ok(Pose::identity()) };
    origin.check_open(&["xyz", "rpy"], &mut context.warnings)?;
    let position = origin.array::<3>("xyz")?.unwrap_or([0.0; 3]);
    let [roll, pitch, yaw] = origin.array::<3>("rpy")?.unwrap_or([0.0; 3]);
    let about = |axis: usize, angle: f64| {
        let (sine, cosine) = sin_cos(angle / 2.0);
        let mut rotation = [0.0, 0.0, 0.0, cosine];
        rotation[axis] = sine;
        Pose { rotation, ..Pose::identity() }
    };
    // Angles about the fixed axes, x first: the matrix is Rz Ry Rx.
    let turn = about(2, yaw).compose(&about(1, pitch)).compose(&about(0, roll));
    let length = norm(&turn.rotation);
    if !length.is_finite() {
        return Err(origin.wrong(
            "rpy",
            origin.needed("rpy")?,
            "but must be of angles below 3.5e13, which have a direction",
        ));
    }
    Ok(Pose { position, rotation: turn.rotation.map(|x| x / length) })
}

/// A solid with its name and the place and line that it has.
pub(super) type Placed = (String, Solid, Pose<f64>, SourceLocation);

/// Our shapes for solids, each with the index of its first solid and its place. A cylinder and two balls at its ends
/// are one capsule.
pub(super) fn joined(solids: &[Placed], kind: &str, context: &mut Context<'_>) -> Vec<(usize, Shape, Pose<f64>)> {
    let mut shapes = Vec::new();
    let mut next = 0;
    while let Some((_, solid, placement, place)) = solids.get(next) {
        let first = next;
        let capsule = solids.get(first + 1..first + 3).and_then(|ends| capsule(solid, placement, &ends[0], &ends[1]));
        next += if capsule.is_some() { 3 } else { 1 };
        let (shape, at, why) =
            capsule.map_or_else(|| solid.shape(context.options), |shape| (shape, Pose::identity(), None));
        if let Some(why) = why {
            context.warnings.add(place.clone(), format!("{} in {kind}", solid.label()), why);
        }
        shapes.push((first, shape, placement.compose(&at)));
    }
    shapes
}

/// Finds the capsule that a cylinder makes with two balls at its ends.
fn capsule(tube: &Solid, at: &Pose<f64>, a: &Placed, b: &Placed) -> Option<Shape> {
    let Solid::Cylinder { radius, half_length } = *tube else { return None };
    // Far from the origin positions have fewer digits.
    let far = at.position.iter().fold(half_length, |far, x| far.max(x.abs()));
    let end = |(_, solid, place, _): &Placed, z: f64| {
        let point = at.transform_back(place.position);
        let off = norm(&[point[0], point[1], point[2] - z]);
        *solid == Solid::Native(Shape::Sphere { radius }) && off <= 1e-9 * (1.0 + far)
    };
    let pair = (end(a, -half_length) && end(b, half_length)) || (end(a, half_length) && end(b, -half_length));
    pair.then_some(Shape::Capsule { radius, half_length })
}

/// Reads the file of a `mesh` element, whose triangles face inward if its scale reflects them.
pub(super) fn mesh(shape: Element<'_>, context: &mut Context<'_>) -> Result<Mesh, ReadError> {
    let name = shape.needed("filename")?;
    let scale = shape.array::<3>("scale")?.unwrap_or([1.0; 3]);
    let place = shape.place();
    let read = Mesh::parse(name, &context.files.content(&place, &NamedFile { name, assets: "", folder: None })?);
    let mesh = read.map_err(|why| ReadError::Mesh { place, path: name.into(), why })?;
    Ok(mesh.map(|point| [0, 1, 2].map(|k| point[k] * scale[k])))
}

/// Reads the file of a `mesh` element, with triangles that face outward despite a reflection.
pub(super) fn outward_mesh(shape: Element<'_>, context: &mut Context<'_>) -> Result<Mesh, ReadError> {
    let [x, y, z] = shape.array::<3>("scale")?.unwrap_or([1.0; 3]);
    let mesh = mesh(shape, context)?;
    Ok(if x * y * z < 0.0 { mesh.turned_inside_out() } else { mesh })
}

/// Reads the shape in a `geometry` element, or `None` if it is left out.
pub(super) fn solid(geometry: Element<'_>, context: &mut Context<'_>) -> Result<Option<Solid>, ReadError> {
    let kinds = ["box", "cylinder", "capsule", "sphere", "mesh"];
    let mut shapes = geometry.children();
    let (Some(shape), None) = (shapes.next(), shapes.next()) else {
        return Err(geometry.missing("shape, or has several"));
    };
    let positive = |name: &'static str| -> Result<f64, ReadError> {
        let value = shape.number(name)?.ok_or_else(|| shape.missing(name))?;
        let text = shape.attribute(name).unwrap_or_default();
        let wrong = || shape.wrong(name, text, format!("but must be positive, below {MAX_SIZE:e}"));
        if value > 0.0 && value < MAX_SIZE { Ok(value) } else { Err(wrong()) }
    };
    let solid = match shape.tag() {
        "sphere" => {
            shape.check_open(&["radius"], &mut context.warnings)?;
            Solid::Native(Shape::Sphere { radius: positive("radius")? })
        }
        "box" => {
            shape.check_open(&["size"], &mut context.warnings)?;
            let size = shape.array::<3>("size")?.ok_or_else(|| shape.missing("size"))?;
            let cuboid = Shape::Box { half: size.map(|x| x / 2.0) };
            if !has_size(&cuboid) {
                let why = format!("but must be positive, below {:e}", 2.0 * MAX_SIZE);
                return Err(shape.wrong("size", shape.needed("size")?, why));
            }
            Solid::Native(cuboid)
        }
        kind @ ("cylinder" | "capsule") => {
            shape.check_open(&["radius", "length"], &mut context.warnings)?;
            let (radius, length) =
                (positive("radius")?, shape.number("length")?.ok_or_else(|| shape.missing("length"))?);
            let half_length = length / 2.0;
            if !(0.0..MAX_SIZE).contains(&half_length) {
                let why = format!("but must not be negative, and below {:e}", 2.0 * MAX_SIZE);
                return Err(shape.wrong("length", shape.needed("length")?, why));
            }
            match kind {
                "capsule" => Solid::Native(Shape::Capsule { radius, half_length }),
                _ => Solid::Cylinder { radius, half_length },
            }
        }
        "mesh" => {
            shape.check_open(&["filename", "scale"], &mut context.warnings)?;
            let name = shape.needed("filename")?;
            if context.options.meshes == Meshes::Leave {
                context.warnings.add(shape.place(), "mesh", "left out, as asked for");
                return Ok(None);
            }
            // Its link has the mass.
            let fit = MeshFit::new(&mesh(shape, context)?, MeshInertia::Legacy);
            Solid::Mesh(fit.map_err(|why| ReadError::Mesh { place: shape.place(), path: name.into(), why })?)
        }
        other => return Err(shape.unknown("shape", other, kinds)),
    };
    Ok(Some(solid))
}
