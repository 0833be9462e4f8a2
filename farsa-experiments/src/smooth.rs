//! Smooth trajectories between postures, used by the scripts.

/// From 0 to 1 while `s` does, with speed and acceleration 0 at both ends.
pub(crate) fn smooth(s: f64) -> f64 {
    let s = s.clamp(0.0, 1.0);
    s * s * s * (10.0 + s * (6.0 * s - 15.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_begins_and_ends_at_rest() {
        let ends = [-1.0, 0.0, 0.5, 1.0, 2.0].map(smooth);
        assert_eq!(ends, [0.0, 0.0, 0.5, 1.0, 1.0]);
        // With speed and acceleration 0 there it grows by 10 h^3.
        let h = 1e-3;
        assert!((smooth(h) / (10.0 * h * h * h) - 1.0).abs() < 2.0 * h);
        assert!(((1.0 - smooth(1.0 - h)) / (10.0 * h * h * h) - 1.0).abs() < 2.0 * h);
    }
}
