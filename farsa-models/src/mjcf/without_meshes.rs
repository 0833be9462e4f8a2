//! Meshes of an MJCF, replaced by shapes and by the inertias of their bodies.

use std::collections::BTreeSet;

use farsa_body::Pose;

use crate::context::Context;
use crate::error::ReadError;
use crate::mjcf::classes::Classes;
use crate::mjcf::compiler::{Compiler, ROTATIONS};
use crate::mjcf::geoms::{MeshAssets, geom};
use crate::mjcf::inertials::body_mass;
use crate::mjcf::items::{Item, items};
use crate::mjcf::write::kind_and_sizes;
use crate::xml::merge::Changes;
use crate::xml::tree::Element;
use crate::xml::write::numbers;

/// Returns the changes that replace each mesh that may touch something, and give each body an `inertial`. `None` without a
/// mesh.
pub(crate) fn without_meshes(model: Element<'_>, context: &mut Context<'_>) -> Result<Option<Changes>, ReadError> {
    if model.all("asset").all(|asset| asset.all("mesh").next().is_none()) {
        return Ok(None);
    }
    let compiler = Compiler::from_model(model, context)?;
    let classes = Classes::from_model(model, context.options.limits.defaults)?;
    let meshes = MeshAssets::from_model(model, &classes, &mut context.warnings)?;
    let pairs = model.all("contact").flat_map(|contact| contact.all("pair"));
    let paired: BTreeSet<&str> =
        pairs.flat_map(|pair| [pair.attribute("geom1"), pair.attribute("geom2")]).flatten().collect();
    let mut changes = Changes::default();
    let mut waiting: Vec<(Element<'_>, usize)> = model.all("worldbody").map(|world| (world, classes.main())).collect();
    while let Some((body, inherited)) = waiting.pop() {
        let class = body.attribute("childclass").map_or(Ok(inherited), |name| classes.find(body, name))?;
        let items = items(body, class, &compiler, &classes, context)?;
        if body.tag() == "body" {
            let given = items.iter().any(|(element, ..)| element.tag() == "inertial");
            if compiler.inertia_from_geom.unwrap_or(!given) {
                let mass = body_mass(body, &items, &compiler, &classes, &meshes, context)?;
                let inertials = items.iter().filter(|(element, ..)| element.tag() == "inertial");
                changes.replaced.extend(inertials.map(|(element, ..)| (element.index(), String::new())));
                let [centre, inertia] = [numbers(&mass.centre), numbers(&mass.inertia)];
                let line = format!("<inertial pos=\"{centre}\" mass=\"{:?}\" fullinertia=\"{inertia}\"/>", mass.mass);
                changes.added.extend((mass.mass > 0.0).then(|| (body.index(), line)));
            }
        }
        for item in items.iter().filter(|(element, ..)| element.tag() == "geom") {
            let shape = shaped(item, &paired, (&compiler, &classes, &meshes), context)?;
            changes.attributes.extend(shape.map(|attributes| (item.0.index(), attributes)));
        }
        waiting.extend(
            items.iter().filter(|(element, ..)| element.tag() == "body").map(|(body, _, class)| (*body, *class)),
        );
    }
    for element in model.all("compiler").filter(|element| element.attribute("inertiafromgeom").is_some()) {
        let others = element.attributes().iter().filter(|(name, _)| name != "inertiafromgeom").cloned().collect();
        changes.attributes.insert(element.index(), others);
    }
    changes.added.insert(model.index(), "<compiler inertiafromgeom=\"false\"/>".into());
    Ok(Some(changes))
}

/// Returns the attributes of the shape that replaces a mesh, or `None` for a geom that keeps its own.
fn shaped<'t>(
    (element, _, class): &Item<'t>,
    paired: &BTreeSet<&str>,
    (compiler, classes, meshes): (&Compiler, &Classes<'t>, &MeshAssets<'t, '_>),
    context: &mut Context<'_>,
) -> Result<Option<Vec<(String, String)>>, ReadError> {
    let classed = classes.with(*element, *class)?;
    if classed.text("mesh").is_none() {
        return Ok(None);
    }
    let bits = |name| Ok::<_, ReadError>(classed.number(name)?.unwrap_or(1.0) != 0.0);
    let touches = bits("contype")? | bits("conaffinity")?;
    if classed.text("type") == Some("mesh")
        && !touches
        && !element.attribute("name").is_some_and(|name| paired.contains(name))
    {
        return Ok(None);
    }
    let Some((solid, at)) = geom(&classed, &Pose::identity(), compiler, meshes, context)? else { return Ok(None) };
    let (shape, inner, _) = solid.shape(context.options);
    let Pose { position, rotation: [x, y, z, w] } = at.compose(&inner);
    let (kind, sizes) = kind_and_sizes(&shape);
    let own = ["mesh", "type", "size", "pos", "fromto", "fitscale"];
    let kept = element
        .attributes()
        .iter()
        .filter(|(name, _)| !own.contains(&name.as_str()) && !ROTATIONS.contains(&name.as_str()));
    let mut attributes: Vec<(String, String)> = kept.cloned().collect();
    let made = [
        ("type", kind.into()),
        ("size", numbers(&sizes)),
        ("pos", numbers(&position)),
        ("quat", numbers(&[w, x, y, z])),
    ];
    attributes.extend(made.map(|(name, value)| (name.to_owned(), value)));
    Ok(Some(attributes))
}
