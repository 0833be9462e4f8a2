//! Shapes of model files as ours, with the masses of the true ones.

use farsa_body::Pose;
use farsa_body::robot::{MassProperties, Shape};

use crate::bounds::{MAX_SIZE, has_size};
use crate::mesh::mass::MeshInertia;
use crate::mesh::triangles::{Mesh, z_to_axis};
use crate::options::ReadOptions;

/// Shape that replaces a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MeshFit {
    /// Shape that holds all points, and its place.
    shape: Shape,
    place: Pose<f64>,
    /// Mass of density 1, or the reason for its absence.
    pub(crate) mass: Result<MassProperties, &'static str>,
}

impl MeshFit {
    /// Fits a shape to a mesh, or returns the reason why none fits.
    pub(crate) fn new(mesh: &Mesh, rule: MeshInertia) -> Result<Self, String> {
        let (shape, place) = mesh.fitted();
        if !has_size(&shape) {
            return Err(format!("what holds it has sizes that are not below {MAX_SIZE:e}: {shape:?}"));
        }
        Ok(Self { shape, place, mass: mesh.mass(rule) })
    }
}

/// A shape of a model file, in its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Solid {
    /// One that a description has as well.
    Native(Shape),
    /// About z, with half the length.
    Cylinder {
        radius: f64,
        half_length: f64,
    },
    /// Half axes.
    Ellipsoid([f64; 3]),
    Mesh(MeshFit),
}

impl Solid {
    /// Our shape for it, its place in the solid's frame, and what became of it unless it is the same.
    pub(crate) fn shape(&self, options: &ReadOptions) -> (Shape, Pose<f64>, Option<&'static str>) {
        let here = Pose::identity();
        match self {
            Self::Native(shape) => (*shape, here, None),
            Self::Cylinder { radius, half_length } if options.cylinders => {
                (Shape::Cylinder { radius: *radius, half_length: *half_length }, here, None)
            }
            Self::Cylinder { radius, half_length } if half_length > radius => {
                let shape = Shape::Capsule { radius: *radius, half_length: half_length - radius };
                (shape, here, Some("a cylinder became the capsule of its radius and length"))
            }
            Self::Cylinder { radius, .. } => {
                (Shape::Sphere { radius: *radius }, here, Some("a flat cylinder became the ball of its radius"))
            }
            Self::Ellipsoid(axes) => {
                let long = (0..3).fold(0, |long, k| if axes[k] > axes[long] { k } else { long });
                let radius = axes[(long + 1) % 3].max(axes[(long + 2) % 3]);
                let rotation = z_to_axis(long);
                let shape = Shape::Capsule { radius, half_length: axes[long] - radius };
                let why = "an ellipsoid became the capsule along its longest axis with the radius of the next";
                (shape, Pose { rotation, ..here }, Some(why))
            }
            Self::Mesh(MeshFit { shape, place, .. }) => {
                let why = match shape {
                    Shape::Sphere { .. } => "a mesh became the ball that holds it",
                    Shape::Capsule { .. } => "a mesh became the capsule that holds it",
                    _ => "a mesh became the box that holds it",
                };
                (*shape, *place, Some(why))
            }
        }
    }

    fn volume(&self) -> f64 {
        let pi = std::f64::consts::PI;
        match self {
            Self::Native(Shape::Sphere { radius }) => 4.0 / 3.0 * pi * radius * radius * radius,
            Self::Native(Shape::Capsule { radius, half_length }) => {
                pi * radius * radius * (2.0 * half_length + 4.0 / 3.0 * radius)
            }
            Self::Native(Shape::Box { half }) => 8.0 * half[0] * half[1] * half[2],
            Self::Native(Shape::Plane) => 0.0,
            Self::Native(Shape::Cylinder { radius, half_length }) | Self::Cylinder { radius, half_length } => {
                2.0 * pi * radius * radius * half_length
            }
            Self::Ellipsoid([a, b, c]) => 4.0 / 3.0 * pi * a * b * c,
            Self::Mesh(mesh) => mesh.mass.map_or_else(|_| Self::Native(mesh.shape).volume(), |solid| solid.mass),
        }
    }

    /// Computes the mass properties of the true shape with `mass` [kg], or else of this `density` [kg/m3].
    pub(crate) fn mass_properties(&self, mass: Option<f64>, density: f64) -> MassProperties {
        let mass = mass.unwrap_or_else(|| density * self.volume());
        match self {
            Self::Native(shape) => MassProperties::from_shape(shape, mass),
            Self::Cylinder { radius, half_length } => MassProperties::cylinder(mass, *radius, *half_length),
            Self::Ellipsoid(axes) => {
                let [a, b, c] = axes.map(|x| x * x * mass / 5.0);
                MassProperties { mass, centre: [0.0; 3], inertia: [b + c, a + c, a + b, 0.0, 0.0, 0.0] }
            }
            Self::Mesh(MeshFit { mass: Ok(solid), .. }) => scaled(solid, mass / solid.mass),
            Self::Mesh(MeshFit { shape, place, .. }) => MassProperties::from_shape(shape, mass).placed(place),
        }
    }

    /// Formats the name for messages.
    pub(crate) fn label(&self) -> String {
        let name = match self {
            Self::Native(Shape::Sphere { .. }) => "sphere",
            Self::Native(Shape::Capsule { .. }) => "capsule",
            Self::Native(Shape::Box { .. }) => "box",
            Self::Native(Shape::Plane) => "plane",
            Self::Native(Shape::Cylinder { .. }) | Self::Cylinder { .. } => "cylinder",
            Self::Ellipsoid(_) => "ellipsoid",
            Self::Mesh(_) => "mesh",
        };
        name.into()
    }
}

/// Computes the body with mass and inertia times `by`.
pub(crate) fn scaled(body: &MassProperties, by: f64) -> MassProperties {
    MassProperties { mass: body.mass * by, centre: body.centre, inertia: body.inertia.map(|x| x * by) }
}
