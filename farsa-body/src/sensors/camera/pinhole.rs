//! A pinhole camera, with the geometry of its pixels and its projection.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Scalar, sin_cos};

use crate::channel::{ChannelError, positive};
use crate::ports::{BodyId, Kinematics, Seen, Vision};
use crate::pose::Pose;
use crate::recorder::Recorder;

/// More pixels than this are not needed, and a mistake could run out of memory.
const MAX_PIXELS: usize = 1 << 20;

/// A pinhole camera attached to a body. In its frame, x is the viewing direction, y points to the left and z up. Pixels
/// are square and numbered row by row, starting at the upper left corner.
///
/// A point (x, y, z) in this frame is projected to (y, z) / (x w) in the image, where w is the tangent of half the
/// field of view. The left edge of the image is at 1 and the right edge at -1. The vertical axis has the same scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera<B = BodyId> {
    body: B,
    placement: Pose,
    size: [usize; 2],
    /// Tangent of half the field of view, w.
    tangent: f32,
    range: f32,
    /// Unit vectors of the pixels in the camera's frame, and in the world when it looked last.
    own: Vec<[f32; 3]>,
    rays: Vec<[f32; 3]>,
    seen: Vec<Option<Seen<B>>>,
}

impl<B: Copy> Camera<B> {
    /// Creates a camera on `body`, at `placement` in the frame of the body. The `size` contains the number of columns
    /// and rows. The horizontal field of view is given in radians and the `range` in meters.
    ///
    /// # Errors
    /// Returns [`ChannelError::Groups`] if the image has no pixels or more than 2^20. Returns [`ChannelError::Value`]
    /// if the field of view is outside (0, pi), if `range` is not a finite number > 0, or if the placement is not
    /// finite or not normalized.
    pub fn new(
        body: B,
        placement: Pose,
        size: [usize; 2],
        field_of_view: f64,
        range: f32,
    ) -> Result<Self, ChannelError> {
        let [columns, rows] = size;
        let pixels = columns.saturating_mul(rows);
        if pixels == 0 || pixels > MAX_PIXELS {
            return Err(ChannelError::Groups { field: "pixels", count: pixels, size: columns });
        }
        if !(field_of_view > 0.0 && field_of_view < core::f64::consts::PI) {
            return Err(ChannelError::Value { field: "field of view", value: field_of_view as f32 });
        }
        let length = placement.rotation.iter().fold(0.0, |sum, x| sum + x * x);
        if !length.is_finite() || (length - 1.0).abs() > 1e-3 {
            return Err(ChannelError::Value { field: "length of the rotation", value: length });
        }
        if let Some(value) = placement.position.into_iter().find(|x| !x.is_finite()) {
            return Err(ChannelError::Value { field: "place", value });
        }
        let (sine, cosine) = sin_cos(0.5 * field_of_view);
        let tangent = sine / cosine;
        let mut own = Vec::with_capacity(pixels);
        for row in 0..rows {
            for column in 0..columns {
                // The middle of the pixel. Pixels are square, so rows count in columns' widths.
                let left = tangent * (columns as f64 - 1.0 - 2.0 * column as f64) / columns as f64;
                let up = tangent * (rows as f64 - 1.0 - 2.0 * row as f64) / columns as f64;
                let length = Scalar::sqrt(1.0 + left * left + up * up);
                own.push([1.0, left, up].map(|x| (x / length) as f32));
            }
        }
        let (rays, seen) = (own.clone(), vec![None; pixels]);
        let (tangent, range) = (tangent as f32, positive("range", range)?);
        Ok(Self { body, placement, size, tangent, range, own, rays, seen })
    }

    /// Gets the body to which the camera is attached.
    pub fn body(&self) -> B {
        self.body
    }

    /// Gets the number of columns and rows of the image.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Returns the pose of the camera in the world.
    pub fn pose<W: Kinematics<Body = B> + ?Sized>(&self, world: &W) -> Pose {
        world.pose(self.body).compose(&self.placement)
    }

    /// Casts a ray for each pixel and returns the first surface on it. The pixel at the upper left corner comes first.
    /// The body to which the camera is attached is invisible.
    pub fn look<W: Kinematics<Body = B> + Vision + ?Sized>(&mut self, world: &W) -> &[Option<Seen<B>>] {
        let pose = self.pose(world);
        for (ray, own) in self.rays.iter_mut().zip(&self.own) {
            *ray = pose.rotate(*own);
        }
        world.look(pose.position, &self.rays, self.range, Some(self.body), &mut self.seen);
        &self.seen
    }

    /// Returns the colors of all pixels in the latest image, starting at the upper left corner.
    pub fn colors(&self) -> impl Iterator<Item = Option<[f32; 3]>> {
        self.seen.iter().map(|seen| seen.as_ref().and_then(|seen| seen.color))
    }

    /// Passes the latest image to a recorder under the number `image`. Pixels without a surface or without a color are
    /// black.
    pub fn record<R: Recorder + ?Sized>(&self, image: usize, recorder: &mut R) {
        for (pixel, color) in self.colors().enumerate() {
            recorder.pixel(image, pixel, color.unwrap_or_default());
        }
    }

    /// Returns the position of a pixel's center in the image, to the left and upwards in units of half the width.
    pub fn pixel(&self, index: usize) -> [f32; 2] {
        let [columns, rows] = self.size.map(|count| count as f32);
        let (column, row) = ((index % self.size[0]) as f32, (index / self.size[0]) as f32);
        [(columns - 1.0 - 2.0 * column) / columns, (rows - 1.0 - 2.0 * row) / columns]
    }

    /// Projects a point of the world (in meters) to the image. The result is the position to the left and upwards in
    /// units of half the width. Its magnitude exceeds 1 outside the image. If the point is not in
    /// front of the camera, the result is `None`.
    pub fn project(&self, pose: &Pose, place: [f32; 3]) -> Option<[f32; 2]> {
        let [ahead, left, up] = pose.transform_back(place);
        (ahead > 0.0).then(|| [left, up].map(|x| x / (ahead * self.tangent)))
    }
}
