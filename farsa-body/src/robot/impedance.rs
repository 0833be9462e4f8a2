//! Impedance of constraints over their depth.

/// Resistance of a contact or stop over its depth, MuJoCo's `solimp`.
///
/// Spring, damper and inertia of a contact or stop are those at full depth, with the impedance [`deep`](Self::deep). At
/// an impedance d, damper and inertia are smaller by the factor f = d (1 - `deep`) / (`deep` (1 - d)), and the spring by
/// f d / `deep`. Over the depth d rises from [`surface`](Self::surface) to `deep`, or falls.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Impedance {
    /// Impedance at the surface, above 0 and below 1.
    pub surface: f64,
    /// Impedance from the depth `width`, above 0 and below 1.
    pub deep: f64,
    /// Depth of the change (in meters or radians).
    pub width: f64,
    /// Share of the width at which the second part of the curve begins, above 0 and below 1.
    pub midpoint: f64,
    /// Power of the two parts: 1 or 2.
    pub power: u8,
}

impl Impedance {
    /// Returns the impedance at a depth (in meters or radians).
    pub fn at(&self, depth: f64) -> f64 {
        let x = (depth / self.width).clamp(0.0, 1.0);
        let y = match self.power {
            1 => x,
            _ if x <= self.midpoint => x * x / self.midpoint,
            _ => 1.0 - (1.0 - x) * (1.0 - x) / (1.0 - self.midpoint),
        };
        self.surface + (self.deep - self.surface) * y
    }
}
