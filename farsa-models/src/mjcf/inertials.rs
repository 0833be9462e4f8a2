//! Masses of an MJCF file's bodies: given by an `inertial`, or those of the geoms.

use farsa_body::Pose;
use farsa_body::robot::{MassProperties, Shape};

use crate::context::Context;
use crate::error::ReadError;
use crate::mesh::solid::{MeshFit, Solid};
use crate::mjcf::classes::Classes;
use crate::mjcf::compiler::{Compiler, ROTATIONS};
use crate::mjcf::geoms::{MeshAssets, geom};
use crate::mjcf::items::Item;
use crate::options::Repair;
use crate::repair::repaired;
use crate::xml::tree::Element;

/// Gets the mass of a body in its frame.
pub(crate) fn body_mass<'t>(
    body: Element<'t>,
    items: &[Item<'t>],
    compiler: &Compiler,
    classes: &Classes<'t>,
    meshes: &MeshAssets<'t, '_>,
    context: &mut Context<'_>,
) -> Result<MassProperties, ReadError> {
    let mut given = items.iter().filter(|(element, ..)| element.tag() == "inertial");
    let inertial = given.next();
    if let (Some((first, ..)), Some((second, ..))) = (inertial, given.next()) {
        return Err(body.second("inertial", second.place(), first.place().line));
    }
    let none = MassProperties { mass: 0.0, centre: [0.0; 3], inertia: [0.0; 6] };
    // `inertiafromgeom`: "true" overrides an `inertial`, "false" makes do with it, "auto" infers what is not given.
    match (inertial, compiler.inertia_from_geom) {
        (Some((element, within, _)), None | Some(false)) => given_mass(*element, within, compiler, context),
        (None, Some(false)) => Ok(none),
        _ => {
            if let Some((element, ..)) = inertial {
                element.leave();
            }
            let mut sum = none;
            for (element, within, class) in items.iter().filter(|(element, ..)| element.tag() == "geom") {
                let classed = classes.with(*element, *class)?;
                // `inertiagrouprange` selects by group. A geom of no mass is for collisions only.
                let group = classed.number("group")?.unwrap_or(0.0);
                let [low, high] = compiler.inertia_groups;
                let mass = classed.not_negative("mass")?;
                let density = classed.not_negative("density")?.unwrap_or(1000.0);
                if !(low..=high).contains(&group) || mass == Some(0.0) || (mass.is_none() && density == 0.0) {
                    continue;
                }
                if classed.word("shellinertia", &["true", "false"])? == Some("true") {
                    context.warnings.add(element.place(), "geom `shellinertia`", "counted as solid");
                }
                match geom(&classed, within, compiler, meshes, context)? {
                    None | Some((Solid::Native(Shape::Plane), _)) => {}
                    Some((Solid::Mesh(MeshFit { mass: Err(why), .. }), _)) => {
                        let path = classed.text("mesh").unwrap_or_default().to_owned();
                        return Err(ReadError::Mesh { place: element.place(), path, why: why.into() });
                    }
                    Some((solid, at)) => sum = sum.with(&solid.mass_properties(mass, density).placed(&at)),
                }
            }
            Ok(sum)
        }
    }
}

/// Applies the file's bounds to a body, or returns `None` if nothing changes.
///
/// MuJoCo repeats the body's `position` in its parent as the center of a body without mass.
pub(crate) fn bounded(mass: &MassProperties, bounds: &Repair, position: [f64; 3]) -> Option<MassProperties> {
    let empty = mass.mass == 0.0 && mass.inertia == [0.0; 6];
    let centre = if empty { position } else { mass.centre };
    repaired(&MassProperties { centre, ..*mass }, true, bounds)
}

/// Reads the mass that an `inertial` gives, in the body's frame.
fn given_mass(
    element: Element<'_>,
    within: &Pose<f64>,
    compiler: &Compiler,
    context: &mut Context<'_>,
) -> Result<MassProperties, ReadError> {
    let read = [&["pos", "mass", "diaginertia", "fullinertia"][..], &ROTATIONS].concat();
    element.check(&read, &[], &mut context.warnings)?;
    let mass = element.number("mass")?.ok_or_else(|| element.missing("mass"))?;
    if mass < 0.0 {
        return Err(element.wrong("mass", element.needed("mass")?, "but must not be negative"));
    }
    let inertia = match (element.array::<3>("diaginertia")?, element.array::<6>("fullinertia")?) {
        (Some([xx, yy, zz]), None) => [xx, yy, zz, 0.0, 0.0, 0.0],
        (None, Some(full)) => full,
        (Some(_), Some(_)) => {
            return Err(element.wrong("fullinertia", element.needed("fullinertia")?, "but there is diaginertia"));
        }
        (None, None) => return Err(element.missing("diaginertia or fullinertia")),
    };
    let pose = within.compose(&compiler.pose(Some(element), Some(element))?);
    let body = MassProperties { mass, centre: [0.0; 3], inertia };
    let turned = pose.rotation != Pose::identity().rotation;
    Ok(if turned { body.placed(&pose) } else { MassProperties { centre: pose.position, ..body } })
}
