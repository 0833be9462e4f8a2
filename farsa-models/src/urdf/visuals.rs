//! Visuals of a URDF's links.

use std::collections::BTreeMap;

use farsa_body::ports::BodyId;
use farsa_body::robot::{Robot, Visual};

use crate::context::Context;
use crate::error::ReadError;
use crate::urdf::geometry::{Placed, joined, origin, solid};
use crate::xml::tree::Element;

/// The colors of the materials that have one, by name, red, green and blue [0..1].
pub(super) fn colors(model: Element<'_>) -> BTreeMap<&str, [f64; 3]> {
    model.all("material").filter_map(|material| Some((material.attribute("name")?, own_color(material)?))).collect()
}

fn own_color(material: Element<'_>) -> Option<[f64; 3]> {
    let [red, green, blue, _] = material.one("color").ok()??.array::<4>("rgba").ok()??;
    Some([red, green, blue].map(|shade| shade.clamp(0.0, 1.0)))
}

/// Adds the visuals of a link, unless one of them is a mesh or not to be read: half of its looks would be none.
///
/// Nothing depends on them, so that none is an error.
pub(super) fn visuals(
    robot: &mut Robot,
    body: Option<BodyId>,
    link: Element<'_>,
    colors: &BTreeMap<&str, [f64; 3]>,
    context: &mut Context<'_>,
) {
    let (mut solids, mut shades) = (Vec::new(), Vec::new());
    for visual in link.all("visual") {
        let why = match placed(visual, context) {
            Ok(Some(placed)) => {
                solids.push(placed);
                let material = visual.all("material").next();
                let named = || colors.get(material?.attribute("name")?).copied();
                shades.push(material.and_then(own_color).or_else(named));
                continue;
            }
            Ok(None) => "those of a link with a mesh are left out".into(),
            Err(error) => format!("those of the link are left out: {error}"),
        };
        context.warnings.add(visual.place(), "visual", why);
        return;
    }
    // The color of the first of the three elements of a capsule counts.
    for (first, shape, placement) in joined(&solids, "visual", context) {
        let color = shades.get(first).copied().flatten();
        robot.add_visual(Visual { color, ..Visual::new(body, shape, placement) });
    }
}

/// A visual's solid and place, or `None` for a mesh.
fn placed(visual: Element<'_>, context: &mut Context<'_>) -> Result<Option<Placed>, ReadError> {
    let placement = origin(visual, context)?;
    let geometry = visual.one("geometry")?.ok_or_else(|| visual.missing("geometry"))?;
    if geometry.children().any(|shape| shape.tag() == "mesh") {
        return Ok(None);
    }
    Ok(solid(geometry, context)?.map(|solid| (String::new(), solid, placement, visual.place())))
}
