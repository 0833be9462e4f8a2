//! Joints and masses of the torso, the neck and the right arm from the file `icub.urdf` [Gepetto2025].
//!
//! All axes, positions and inertias are given in the axes of the world at joint position 0, which are those of the file
//! after a rotation by pi about z. The angles in the file have six digits. Before the conversion they were replaced by
//! the nearest multiples of 15 degrees. Links that are rigidly connected in the file are combined. These are
//! `shoulder_3`, the force sensor and the upper arm, and the chest with the base of the neck (0.1 kg). Limits are
//! converted from radians to degrees.

use crate::robot::mass_properties::MassProperties;
use crate::robots::hand::deg;

/// Where a segment's inertia comes from.
#[derive(Clone, Copy, Debug)]
pub(super) enum Source {
    /// The file: about the center of mass [xx, yy, zz, xy, xz, yz, kg m2].
    File([f64; 6]),
    /// A ball of this radius [m]: the file has no inertia there.
    Chosen(f64),
}

/// A segment with the joint that carries it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// The joint's name, without the prefix of an arm.
    pub(super) joint: &'static str,
    /// The segment's name, without the prefix of an arm.
    pub(super) segment: &'static str,
    /// The joint's axis.
    pub(super) axis: [f64; 3],
    /// Where the axis is in the parent [m].
    pub(super) at: [f64; 3],
    /// The joint's limits [rad].
    pub(super) range: [f64; 2],
    /// Largest torque [N m].
    pub(super) effort: f64,
    /// Mass [kg].
    mass: f64,
    /// Center of mass [m].
    centre: [f64; 3],
    /// Inertia about it.
    inertia: Source,
}

impl Part {
    /// Mass, center of mass and inertia.
    pub(super) fn body(&self) -> MassProperties {
        let inertia = match self.inertia {
            Source::File(inertia) => inertia,
            Source::Chosen(radius) => MassProperties::sphere(self.mass, radius).inertia,
        };
        MassProperties { mass: self.mass, centre: self.centre, inertia }
    }
}

/// Sine and cosine of the 15 degrees by which the axes of the shoulder are turned.
const SHOULDER: [f64; 2] = [0.258_819_045_102_520_74, 0.965_925_826_289_068_3];

/// Pitch, roll and yaw of the trunk (in radians). The first is in the world.
pub(super) const TORSO: [Part; 3] = [
    Part {
        joint: "torso_pitch",
        segment: "torso_1",
        axis: [0.0, 1.0, 0.0],
        at: [0.0, 0.0, 0.0],
        range: [deg(-22.0), deg(84.0)],
        effort: 36.0,
        mass: 0.1,
        centre: [0.0; 3],
        inertia: Source::File([0.001236, 0.001141, 0.0004544, 0.0, 3.889e-08, -4.263e-05]),
    },
    Part {
        joint: "torso_roll",
        segment: "torso_2",
        axis: [-1.0, 0.0, 0.0],
        at: [0.0, 0.0, 0.032],
        range: [deg(-39.0), deg(39.0)],
        effort: 80.0,
        mass: 0.1,
        centre: [0.0; 3],
        inertia: Source::File([0.002031, 0.0005308, 0.001803, -1.923e-06, -3.849e-07, 5.095e-05]),
    },
    Part {
        joint: "torso_yaw",
        segment: "chest",
        axis: [0.0, 0.0, -1.0],
        at: [0.0055, 0.0, 0.0],
        range: [deg(-59.0), deg(59.0)],
        effort: 80.0,
        mass: 4.91,
        centre: [0.002230630102, 0.0, 0.077409368635],
        inertia: Source::File([0.076090986169, 0.014430986812, 0.081450000643, 4.705e-05, -4.538946e-06, -0.004567]),
    },
];

/// Pitch, roll and yaw of the head (in radians). The first is on the chest.
pub(super) const NECK: [Part; 3] = [
    Part {
        joint: "neck_pitch",
        segment: "neck_1",
        axis: [0.0, -1.0, 0.0],
        at: [0.00231, 0.0, 0.1933],
        range: [deg(-40.0), deg(30.0)],
        effort: 20.0,
        mass: 0.1,
        centre: [0.0; 3],
        inertia: Source::Chosen(0.03),
    },
    Part {
        joint: "neck_roll",
        segment: "neck_2",
        axis: [1.0, 0.0, 0.0],
        at: [0.0, 0.0, 0.0095],
        range: [deg(-70.0), deg(60.0)],
        effort: 20.0,
        mass: 0.1,
        centre: [0.0; 3],
        inertia: Source::Chosen(0.03),
    },
    Part {
        joint: "neck_yaw",
        segment: "head",
        axis: [0.0, 0.0, 1.0],
        at: [0.0, 0.0, 0.0],
        range: [deg(-55.0), deg(55.0)],
        effort: 20.0,
        mass: 1.33687,
        centre: [-0.0185, 0.0, 0.1108],
        inertia: Source::Chosen(0.09),
    },
];

/// The right arm. Its first joint is on the chest. The last segment is the palm of [`crate::robots::Hand`], so its mass
/// here, that of the file's whole hand, is not used.
pub(super) const ARM: [Part; 7] = [
    Part {
        joint: "shoulder_pitch",
        segment: "shoulder_1",
        axis: [-SHOULDER[0], SHOULDER[1], 0.0],
        at: [0.00525, -0.11026, 0.1433],
        range: [deg(-95.0), deg(5.0)],
        effort: 84.0,
        mass: 0.189,
        centre: [-0.005989367877, 0.017754818288, 5e-06],
        inertia: Source::File([0.000109174925, 2.8225075e-05, 0.000123, 1.8495373e-05, -4.469e-09, 2.0543e-08]),
    },
    Part {
        joint: "shoulder_roll",
        segment: "shoulder_2",
        axis: [-SHOULDER[1], -SHOULDER[0], 0.0],
        at: [0.0, 0.0, 0.0],
        range: [deg(0.0), deg(160.8)],
        effort: 84.0,
        mass: 0.179,
        centre: [-0.006080683921, -0.001531998385, -0.0166],
        inertia: Source::File([8.6390814e-05, 0.000133609186, 9.93e-05, -1.310769e-05, 2.0047205e-05, 5.161471e-06]),
    },
    Part {
        joint: "shoulder_yaw",
        segment: "upper_arm",
        axis: [0.0, 0.0, 1.0],
        at: [0.0, 0.0, 0.0],
        range: [deg(-37.0), deg(100.0)],
        effort: 34.0,
        mass: 0.884,
        centre: [0.013209999842, -6.4000034e-05, -0.089380015498],
        inertia: Source::File([0.000743000851, 0.000735000781, 0.000335999992, 8.51e-07, 6.390009e-05, -3.61e-06]),
    },
    Part {
        joint: "elbow",
        segment: "elbow_1",
        axis: [0.0, -1.0, 0.0],
        at: [0.015, 0.0, -0.15228],
        range: [deg(5.5), deg(106.0)],
        effort: 20.0,
        mass: 0.074,
        centre: [-0.0013, 0.00371, 0.00105],
        inertia: Source::File([2.84e-05, 9.24e-06, 2.99e-05, -5.02e-07, 3.99e-07, 3.71e-07]),
    },
    Part {
        joint: "wrist_prosup",
        segment: "forearm",
        axis: [0.0, 0.0, 1.0],
        at: [-0.015, 0.0, 0.0],
        range: [deg(-50.0), deg(50.0)],
        effort: 0.45,
        mass: 0.525,
        centre: [-0.00476, -0.000347, -0.066],
        inertia: Source::File([0.000699, 0.000766, 0.000164, 1.4e-06, 1.82e-05, 5.66e-06]),
    },
    Part {
        joint: "wrist_pitch",
        segment: "wrist_1",
        axis: [1.0, 0.0, 0.0],
        at: [0.0, 0.0, -0.1373],
        range: [deg(-65.0), deg(10.0)],
        effort: 0.65,
        mass: 0.1,
        centre: [0.0; 3],
        inertia: Source::Chosen(0.02),
    },
    Part {
        joint: "wrist_yaw",
        segment: "palm",
        axis: [0.0, 1.0, 0.0],
        at: [0.0, 0.0, 0.0],
        range: [deg(-25.0), deg(25.0)],
        effort: 0.65,
        mass: 0.213,
        centre: [0.00805, 0.007, -0.07023],
        inertia: Source::File([0.00025, 0.000378, 0.000154, -1.76e-05, 1.26e-05, 6.08e-06]),
    },
];
