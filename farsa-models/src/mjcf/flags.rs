//! Settings of an MJCF file's `option` elements that change the robot.

use crate::context::Context;
use crate::error::ReadError;
use crate::mjcf::reasons::MUJOCO;
use crate::mjcf::surface::Override;
use crate::xml::tree::Element;

const WORLD: &str = "steps and solvers are the world's";

/// Settings of `option` elements and their flags.
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of MuJoCo's file")]
pub(crate) struct Flags {
    /// Gravity [m/s2], if the file sets it.
    pub(crate) gravity: Option<[f64; 3]>,
    pub(crate) contact: bool,
    pub(crate) limit: bool,
    pub(crate) equality: bool,
    /// Dry friction of joints.
    pub(crate) friction_loss: bool,
    pub(crate) spring: bool,
    pub(crate) damper: bool,
    pub(crate) actuation: bool,
    /// Groups of actuators that do not act.
    pub(crate) passive_groups: Vec<f64>,
    /// True if `ctrlrange` limits commands.
    pub(crate) clamp_control: bool,
    /// True if bodies do not touch their parents.
    pub(crate) filter_parent: bool,
    /// Numbers that replace those of all contacts.
    pub(crate) contacts: Option<Override>,
    /// True for pyramidal friction cones.
    pub(crate) pyramids: bool,
    /// Stiffness of friction relative to that of the normal, `impratio`.
    pub(crate) ratio: f64,
}

impl Flags {
    pub(crate) fn from_model(model: Element<'_>, context: &mut Context<'_>) -> Result<Self, ReadError> {
        let mut flags = Self {
            gravity: None,
            contact: true,
            limit: true,
            equality: true,
            friction_loss: true,
            spring: true,
            damper: true,
            actuation: true,
            passive_groups: Vec::new(),
            clamp_control: true,
            filter_parent: true,
            contacts: None,
            pyramids: true,
            ratio: 1.0,
        };
        let [mut gravity, mut constraint, mut passive, mut replaced] = [true, true, true, false];
        let mut contacts = Override::default();
        for option in model.all("option") {
            check_option(option, context)?;
            flags.gravity = option.array("gravity")?.or(flags.gravity);
            flags.passive_groups = option.list("actuatorgroupdisable", 0, 31)?.unwrap_or(flags.passive_groups);
            contacts.read(option)?;
            let cone = option.word("cone", &["pyramidal", "elliptic"])?;
            flags.pyramids = cone.map_or(flags.pyramids, |cone| cone == "pyramidal");
            flags.ratio = option.number("impratio")?.unwrap_or(flags.ratio);
            if !(flags.ratio > 0.0 && flags.ratio.is_finite()) {
                return Err(option.wrong(
                    "impratio",
                    option.attribute("impratio").unwrap_or_default(),
                    "but must be positive",
                ));
            }
            for flag in option.all("flag") {
                check_flag(flag, context)?;
                let set = |name, value: &mut bool| {
                    *value = flag.word(name, &["enable", "disable"])?.map_or(*value, |word| word == "enable");
                    Ok::<_, ReadError>(())
                };
                set("gravity", &mut gravity)?;
                set("constraint", &mut constraint)?;
                set("override", &mut replaced)?;
                set("passive", &mut passive)?;
                for (name, value) in flags.named() {
                    set(name, value)?;
                }
            }
        }
        // Earlier versions of MuJoCo have one flag for springs and dampers.
        flags.spring &= passive;
        flags.damper &= passive;
        if !gravity {
            flags.gravity = Some([0.0; 3]);
        }
        if !constraint {
            (flags.contact, flags.limit, flags.equality, flags.friction_loss) = (false, false, false, false);
        }
        flags.contacts = replaced.then_some(contacts);
        Ok(flags)
    }

    /// Flags by their names in a file.
    fn named(&mut self) -> [(&'static str, &mut bool); 9] {
        [
            ("contact", &mut self.contact),
            ("limit", &mut self.limit),
            ("equality", &mut self.equality),
            ("frictionloss", &mut self.friction_loss),
            ("spring", &mut self.spring),
            ("damper", &mut self.damper),
            ("actuation", &mut self.actuation),
            ("clampctrl", &mut self.clamp_control),
            ("filterparent", &mut self.filter_parent),
        ]
    }
}

fn check_option(option: Element<'_>, context: &mut Context<'_>) -> Result<(), ReadError> {
    let read =
        ["gravity", "actuatorgroupdisable", "o_solref", "o_solimp", "o_friction", "o_margin", "cone", "impratio"];
    let ignored = [
        ("density viscosity wind", "a description has no fluid"),
        (
            "timestep integrator jacobian solver iterations tolerance ls_iterations ls_tolerance \
             noslip_iterations noslip_tolerance mpr_iterations mpr_tolerance ccd_iterations ccd_tolerance \
             sdf_iterations sdf_initpoints sleep_tolerance collision",
            WORLD,
        ),
        ("magnetic", MUJOCO),
    ];
    option.check(&read, &ignored, &mut context.warnings)?;
    option.check_children(&["flag"], &[], &mut context.warnings)
}

fn check_flag(flag: Element<'_>, context: &mut Context<'_>) -> Result<(), ReadError> {
    let read = [
        "contact",
        "constraint",
        "limit",
        "equality",
        "frictionloss",
        "passive",
        "spring",
        "damper",
        "actuation",
        "clampctrl",
        "filterparent",
        "gravity",
        "override",
    ];
    let ignored = [(
        "warmstart refsafe sensor midphase nativeccd multiccd island eulerdamp autoreset energy fwdinv invdiscrete \
         sensornoise sleep diagexact speculative ipc",
        MUJOCO,
    )];
    flag.check(&read, &ignored, &mut context.warnings)
}
