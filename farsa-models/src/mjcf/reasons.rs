//! Reasons for which parts of a file are ignored. The attributes are those of MuJoCo's schema.

pub(crate) const SHOW: &str = "only for show";
pub(crate) const MUJOCO: &str = "how MuJoCo computes";
pub(crate) const FIT: &str = "meshes are fitted by rules of our own";
