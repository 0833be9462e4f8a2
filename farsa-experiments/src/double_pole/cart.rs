//! Equations of motion of a cart with two poles.

use farsa_num::sin_cos;

/// A pole attached to the cart by a hinge. It is modeled as a thin uniform rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pole {
    /// Half the length of the pole, l (in meters).
    pub half_length: f64,
    /// Mass of the pole, m (in kilograms).
    pub mass: f64,
    /// Coefficient of friction of the hinge (in N m s).
    pub friction: f64,
}

/// A cart that moves along a straight track and carries two poles. The poles do not collide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cart {
    /// Mass of the cart, M (in kilograms).
    pub mass: f64,
    /// Friction between the cart and the track in newtons. It does not depend on the speed.
    pub friction: f64,
    /// Acceleration of gravity (in m/s^2).
    pub gravity: f64,
    /// The two poles on the cart.
    pub poles: [Pole; 2],
}

/// The state of the cart and the poles at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CartState {
    /// Position of the cart on the track (in meters).
    pub position: f64,
    /// Velocity of the cart (in meters per second).
    pub velocity: f64,
    /// Angles of the poles from the upright position (in radians). Positive angles lean towards positive positions.
    pub angles: [f64; 2],
    /// Angular velocities of the poles (in radians per second).
    pub angular_velocities: [f64; 2],
}

impl CartState {
    /// This state after a time at constant rates.
    #[inline]
    fn moved(&self, rates: &Self, time: f64) -> Self {
        let of_both = |of: [f64; 2], rates: [f64; 2]| [of[0] + time * rates[0], of[1] + time * rates[1]];
        Self {
            position: self.position + time * rates.position,
            velocity: self.velocity + time * rates.velocity,
            angles: of_both(self.angles, rates.angles),
            angular_velocities: of_both(self.angular_velocities, rates.angular_velocities),
        }
    }
}

impl Default for Cart {
    /// Returns the values of \[Gomez2008\] appendix A. Since the acceleration of gravity is missing there, it is taken
    /// from \[Wieland1991\].
    fn default() -> Self {
        let pole = |half_length, mass| Pole { half_length, mass, friction: 0.000_002 };
        Self { mass: 1.0, friction: 0.0005, gravity: 9.8, poles: [pole(0.5, 0.1), pole(0.05, 0.01)] }
    }
}

impl Cart {
    /// Computes the accelerations of the cart (in m/s^2) and of the poles (in rad/s^2) when a force (in newtons) acts
    /// on the cart.
    ///
    /// Source: \[Wieland1991\], as printed in \[Gomez2008\] appendix A. Deviation: g is positive here.
    #[inline]
    pub fn accelerations(&self, state: &CartState, force: f64) -> (f64, [f64; 2]) {
        let CartState { velocity, angles, angular_velocities, .. } = *state;
        let sign = f64::from(i8::from(velocity > 0.0) - i8::from(velocity < 0.0));
        // a_cart = (F - mu_c sgn(v) + sum_i F_i) / (M + sum_i m_i'), with the poles' effective forces F_i and masses m_i'.
        let (mut push, mut mass) = (force - self.friction * sign, self.mass);
        let mut parts = [[0.0; 2]; 2];
        for (((pole, angle), speed), part) in self.poles.iter().zip(angles).zip(angular_velocities).zip(&mut parts) {
            let (sine, cosine) = sin_cos(angle);
            let (l, m) = (pole.half_length, pole.mass);
            // pull = mu_p w / (m l) - g sin, the part of gravity and of the hinge's friction along the pole's turn.
            let pull = pole.friction * speed / (m * l) - self.gravity * sine;
            // F_i = m l w^2 sin + 3/4 m cos pull, and m_i' = m (1 - 3/4 cos^2). The factor 3/4 is that of a uniform rod.
            push += m * l * speed * speed * sine + 0.75 * m * cosine * pull;
            mass += m * (1.0 - 0.75 * cosine * cosine);
            *part = [cosine, pull];
        }
        let cart = push / mass;
        // w' = -3 / (4 l) (a_cart cos + pull).
        let turn = |pole: &Pole, [cosine, pull]: [f64; 2]| -0.75 / pole.half_length * (cart * cosine + pull);
        (cart, [turn(&self.poles[0], parts[0]), turn(&self.poles[1], parts[1])])
    }

    /// The rate of change of a state under a force \[N\].
    #[inline]
    fn rates(&self, state: &CartState, force: f64) -> CartState {
        let (velocity, angular_velocities) = self.accelerations(state, force);
        CartState { position: state.velocity, velocity, angles: state.angular_velocities, angular_velocities }
    }

    /// Computes the state after a time step in seconds. The force in newtons is constant during the step. The
    /// integration uses the classical fourth-order Runge-Kutta method.
    pub fn step(&self, state: &CartState, force: f64, time_step: f64) -> CartState {
        // s + h/6 (k1 + 2 k2 + 2 k3 + k4), added term by term, so that the order of sums is fixed.
        let half = 0.5 * time_step;
        let first = self.rates(state, force);
        let second = self.rates(&state.moved(&first, half), force);
        let third = self.rates(&state.moved(&second, half), force);
        let fourth = self.rates(&state.moved(&third, time_step), force);
        let sixth = time_step / 6.0;
        state.moved(&first, sixth).moved(&second, 2.0 * sixth).moved(&third, 2.0 * sixth).moved(&fourth, sixth)
    }
}
