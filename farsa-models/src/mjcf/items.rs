//! Elements of a body, as if there were no `frame`s around them.

use farsa_body::Pose;

use crate::context::Context;
use crate::error::ReadError;
use crate::mjcf::classes::Classes;
use crate::mjcf::compiler::{Compiler, ROTATIONS};
use crate::xml::tree::Element;

/// An element of a body, with the frame and class that the `frame`s around it give.
pub(crate) type Item<'t> = (Element<'t>, Pose<f64>, usize);

/// Gets the elements of a body, those in frames in the frames' places.
pub(crate) fn items<'t>(
    body: Element<'t>,
    class: usize,
    compiler: &Compiler,
    classes: &Classes<'t>,
    context: &mut Context<'_>,
) -> Result<Vec<Item<'t>>, ReadError> {
    let mut items = Vec::new();
    let mut open: Vec<Item<'t>> = vec![(body, Pose::identity(), class)];
    let mut first = true;
    while let Some((element, within, class)) = open.pop() {
        let (mut inner, mut inherited) = (within, class);
        if first {
            first = false;
        } else if element.tag() == "frame" {
            let read = [&["name", "pos", "childclass"][..], &ROTATIONS].concat();
            element.check(&read, &[], &mut context.warnings)?;
            inner = within.compose(&compiler.pose(Some(element), Some(element))?);
            if let Some(name) = element.attribute("childclass") {
                inherited = classes.find(element, name)?;
            }
        } else {
            items.push((element, within, class));
            continue;
        }
        let ignored = [("site camera light", "frames and lamps are not described"), ("plugin", "plugins are MuJoCo's")];
        let read =
            ["body", "frame", "joint", "freejoint", "geom", "inertial", "attach", "replicate", "composite", "flexcomp"];
        element.check_children(&read, &ignored, &mut context.warnings)?;
        let children: Vec<_> = element.children().filter(|child| read.contains(&child.tag())).collect();
        open.extend(children.into_iter().rev().map(|child| (child, inner, inherited)));
    }
    let other = |(element, ..): &&Item<'t>| ["attach", "replicate", "composite", "flexcomp"].contains(&element.tag());
    match items.iter().find(other) {
        Some((element, ..)) => Err(element.unsupported(
            "makes bodies by MuJoCo's rules; let MuJoCo write the model out (mj_saveLastXML) and read that",
        )),
        None => Ok(items),
    }
}
